"""Stress below patches: a rough contact, or every patch centre of a plane.

The pressure between patch centres is the cubic convolution of its values there, q = f p. At a depth z the
field is then a discrete convolution of the nodal forces with the influence of one node, found in one of two
ways (d the patch, L the length over which the response of the solid decays, exp(-k L)):

- z >= 3 d. A node is a point force, tabulated for the layered solid: the lattice sum of a function of scale z
  differs from an integral by its aliases, exp(-2 pi z/d). Deeper down the forces are first gathered on
  lattices of spacing up to z/12.
- z < 3 d. In the first coating (or the uncoated solid) the closed forms of the homogeneous half-space of
  that material, and the rest of the response, which is smooth on the scale 2h - z >= h, from tables. In a
  deeper layer the whole response from tables of scale z >= h.

Patches of constant pressure would suffice below, but not near the surface: the steps of p change sigma_xx of
a sliding load by p' d even at the patch centres. With p continuous the field is smooth enough to be computed
below patch centres only, with cubic interpolation between them.

"Stress analysis of elastic coated solids in point contact", eqs. 1-4. Axes: z down; tension positive; SI.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.fft import irfft2, next_fast_len, rfft2

from . import halfspace
from .inputs import Body
from .interpolation_kernel import near_influence
from .nodal_convolution import (
    Influence,
    Lattice,
    at_points,
    between_sites,
    influence_table,
    nodal_forces,
    samples,
)
from .point_force import (
    PointForce,
    displacement_below,
    displacement_from_lines,
    stress_below,
    stress_from_lines,
)

__all__ = ["FieldPlane", "Tables", "displacement", "displacement_plane", "stress", "stress_plane", "tensor"]

Array = NDArray[Any]
Field = Callable[..., Array]
Tables = dict[tuple[bytes, int, float, bool], list[PointForce]]

SHALLOW = 3.0  # patches; above this depth a node is not yet a point force: aliases exp(-6 pi) = 7e-9
COARSE = 12.0  # depth over lattice spacing; interpolation through ten sites then errs by 1e-8 of p_h
CHEBYSHEV = 10  # shallow depths; more than these are interpolated, to 1e-6 three patches from the edge
KEPT = 64  # depths of which point-force tables are kept, half a megabyte each
SIX = ((0, 1, 2, 0, 0, 1), (0, 1, 2, 1, 2, 2))  # xx, yy, zz, xy, xz, yz


def stress(
    x: ArrayLike,
    y: ArrayLike,
    z: ArrayLike,
    layer: ArrayLike,
    *,
    grid_x: Array,
    pressure: Array,
    body: Body,
    kept: Tables | None = None,
    few_depths: bool = False,
) -> Array:
    """Stress at points (x, y, z) of the layers named, under pressure p with traction q = f p in +x.

    x, y, z : points [m], broadcast.  layer : integers, which pick the side of an interface, broadcast.
    pressure : mean of p over each patch [Pa], (n, n), centred at grid_x along both axes [m], which are
    uniform.
    kept : point-force tables of other calls for the same solid; those of this call are added.
    few_depths : interpolate between depths below three patches too, to 1e-3 of the largest stress.
    Returns xx, yy, zz, xy, xz, yz [Pa], (6,) + points.
    """
    response = _stress_response(body)
    if kept is not None:
        response = replace(response, below=partial(_kept, kept, response.below))
    return _evaluate(x, y, z, layer, nodal_forces(grid_x, grid_x, pressure), response, few_depths)


def tensor(components: Array) -> Array:
    """xx, yy, zz, xy, xz, yz as a symmetric tensor, shape (3, 3, ...)."""
    xx, yy, zz, xy, xz, yz = components
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


def displacement(
    x: ArrayLike,
    y: ArrayLike,
    z: ArrayLike,
    layer: ArrayLike,
    *,
    grid_x: Array,
    pressure: Array,
    body: Body,
) -> Array:
    """Displacement at points (x, y, z); arguments as in `stress`.

    Returns u[i, ...] [m], shape (3,) + points; u_z into the solid.
    """
    response = _displacement_response(body)
    return _evaluate(x, y, z, layer, nodal_forces(grid_x, grid_x, pressure), response)


@dataclass(frozen=True, eq=False)
class FieldPlane:
    """Six stresses or three displacements at one depth below every patch centre, for any pressure.

    spectrum : transformed influence of a node, (6 or 3, mx, my/2 + 1).  size : (mx, my).  shape : (nx, ny).
    """

    spectrum: Array
    size: tuple[int, int]
    shape: tuple[int, int]
    area: float

    def __call__(self, pressure: Array, *, threads: int = 1) -> Array:
        """Stresses xx, yy, zz, xy, xz, yz [Pa] or u_x, u_y, u_z [m], (n, nx, ny), by n + 1 FFTs.

        pressure : [Pa], (nx, ny).
        """
        if pressure.shape != self.shape:
            raise ValueError(f"pressure has shape {pressure.shape}; this plane was set up for {self.shape}")
        nx, ny = self.shape
        force = rfft2(samples(pressure) * self.area, self.size, workers=threads)
        out = np.empty((len(self.spectrum), nx, ny))
        for component, part in zip(out, self.spectrum, strict=True):
            component[:] = irfft2(part * force, self.size, workers=threads)[
                nx + 1 : 2 * nx + 1, ny + 1 : 2 * ny + 1
            ]
        return out


def stress_plane(
    z: float,
    layer: int,
    *,
    grid_x: Array,
    body: Body,
) -> FieldPlane:
    """Set up the convolution for all patch centres at depth z [m]; arguments as in `stress`."""
    return _plane(z, layer, grid_x, _stress_response(body))


def displacement_plane(
    z: float,
    layer: int,
    *,
    grid_x: Array,
    body: Body,
) -> FieldPlane:
    """Set up the convolution for all patch centres at depth z [m]; arguments as in `displacement`."""
    return _plane(z, layer, grid_x, _displacement_response(body))


def _plane(z: float, layer: int, grid_x: Array, response: "_Response") -> FieldPlane:
    nx = ny = len(grid_x)
    unit = nodal_forces(grid_x, grid_x, np.ones((nx, ny)))
    ((_, shallow, point),) = _tables(np.array([float(z)]), layer, max(unit.dx, unit.dy), response)
    influence = _near(point, layer == 0, z, unit, response) if shallow else _as_points(point, unit)
    # forces reach one patch beyond the grid, see `samples`
    table = influence_table(influence, np.arange(-nx, nx + 1), np.arange(-ny, ny + 1), response.odd_in_y)
    size = (next_fast_len(2 * nx + 1, real=True), next_fast_len(2 * ny + 1, real=True))
    return FieldPlane(rfft2(table, size), size, (nx, ny), unit.dx * unit.dy)


@dataclass(frozen=True, eq=False)
class _Response:
    """Response of the solid to unit forces, in stress or in displacement.

    below(z, layer, scale, excess=) : point-force tables at depths z.
    closed(X, Y, z, dx, dy) : field of unit forces on a rectangle, normal then tangential, (2, n, ...).
    from_lines : point-force table of the same away from the force.  odd_in_y : components odd in y.
    """

    body: Body
    below: Callable[..., list[PointForce]]
    closed: Field
    from_lines: Callable[..., PointForce]
    components: int
    odd_in_y: tuple[int, ...]


def _stress_response(body: Body) -> _Response:
    rectangle = halfspace.normal_stress, halfspace.tangential_stress
    return _Response(
        body,
        partial(stress_below, body=body),
        partial(_closed, rectangle, body.friction, body.materials[0][1:2], SIX),
        stress_from_lines,
        components=6,
        odd_in_y=(3, 5),
    )


def _displacement_response(body: Body) -> _Response:
    rectangle = halfspace.normal_displacement, halfspace.tangential_displacement
    return _Response(
        body,
        partial(displacement_below, body=body),
        partial(_closed, rectangle, body.friction, body.materials[0][:2], (...,)),
        displacement_from_lines,
        components=3,
        odd_in_y=(1,),
    )


def _closed(rectangle, friction, moduli, components, X, Y, z: float, dx: float, dy: float) -> Array:
    """Fields of unit forces on a rectangle of the uncoated solid, normal and tangential, (2, n, ...)."""
    used = rectangle if friction else rectangle[:1]
    fields = [field(X, Y, z, dx, dy, *moduli)[components] / (dx * dy) for field in used]
    return np.array(fields if friction else [*fields, np.zeros_like(fields[0])])


def _evaluate(x, y, z, layer, fine: Lattice, response: _Response, few_depths: bool = False) -> Array:
    """Field components (n,) + points, layer by layer and depth by depth."""
    x, y, z, layer = np.broadcast_arrays(*(np.asarray(v) for v in (x, y, z, layer)))
    shape = z.shape
    x, y, z, layer = (v.ravel() for v in (x, y, z, layer))
    lattices = [fine]
    while max(lattices[-1].force.shape) > 24:
        lattices.append(lattices[-1].coarser())
    shallow = z < SHALLOW * max(fine.dx, fine.dy)
    out = np.zeros((response.components, z.size))
    for number in np.unique(layer):
        for here in (
            np.flatnonzero((layer == number) & shallow),
            np.flatnonzero((layer == number) & ~shallow),
        ):
            depths, which = np.unique(z[here], return_inverse=True)
            near = bool(shallow[here].any())
            if (near or few_depths) and depths.size > CHEBYSHEV:
                depths, weights = _between_depths(z[here] if near else np.log(z[here]))
                depths = depths if near else np.exp(depths)
                points, at = np.unique(np.stack([x[here], y[here]]), axis=1, return_inverse=True)
                for i, field in enumerate(_fields(depths, int(number), lattices, response)):
                    out[:, here] += weights[:, i] * field(*points)[:, at.ravel()]
            else:
                for i, field in enumerate(_fields(depths, int(number), lattices, response)):
                    at = here[which == i]
                    out[:, at] = field(x[at], y[at])
    return out.reshape(response.components, *shape)


def _between_depths(z: Array) -> tuple[Array, Array]:
    """Chebyshev depths over the range of ``z``, and weights (k, depths) that interpolate to each of ``z``."""
    theta = np.pi * np.arange(CHEBYSHEV) / (CHEBYSHEV - 1)
    low, high = z.min(), z.max()
    s = (2 * z - low - high) / (high - low)
    # cardinal functions as sums of T_m(s) T_m(s_i), first and last terms halved
    m = np.arange(CHEBYSHEV)
    ends = np.where((m == 0) | (m == CHEBYSHEV - 1), 0.5, 1.0)
    T = np.cos(m * np.arccos(np.clip(s, -1, 1))[:, None]) * ends
    weights = 2 / (CHEBYSHEV - 1) * T @ np.cos(np.outer(m, theta)) * ends
    return (low + high + (high - low) * np.cos(theta)) / 2, weights


def _fields(
    depths: Array, layer: int, lattices: list[Lattice], response: _Response
) -> Iterator[Callable[..., Array]]:
    """For each depth of one layer, the field as a function of x and y, (k,) -> (components, k)."""
    fine = lattices[0]
    d = max(fine.dx, fine.dy)
    for z, shallow, table in _tables(depths, layer, d, response):
        if shallow:
            influence = _near(table, layer == 0, z, fine, response)
            yield partial(
                between_sites, lattice=fine, influence=influence, odd_in_y=response.odd_in_y, order=4
            )
        else:
            level = int(np.clip(np.log2(max(z / (COARSE * d), 1)), 0, len(lattices) - 1))
            assert table is not None
            yield partial(
                at_points, lattice=lattices[level], kernel=table, odd_in_y=response.odd_in_y, order=10
            )


def _tables(
    depths: Array, layer: int, d: float, response: _Response
) -> Iterator[tuple[float, bool, PointForce | None]]:
    """Each depth, whether it is shallow, and its point-force table; those of a run share their wavenumbers.

    Shallow in the first layer, the tables hold the difference to the homogeneous solid: None if uncoated.
    """
    coatings = response.body.coatings
    keys = []
    for z in depths:
        shallow = bool(z < SHALLOW * d)
        reach = z
        if shallow and layer == 0:
            reach = 2 * coatings[0][2] - z if coatings else d
        keys.append((2.0 ** np.floor(np.log2(reach)), shallow))
    start = 0
    while start < len(keys):
        scale, shallow = keys[start]
        stop = start + 1
        while stop < min(len(keys), start + 64) and keys[stop] == keys[start]:
            stop += 1
        run = depths[start:stop]
        excess = shallow and layer == 0
        tables: Sequence[PointForce | None] = [None] * run.size
        if coatings or not excess:
            tables = response.below(run, layer, scale, excess=excess)
        for z, table in zip(run, tables, strict=True):
            yield float(z), shallow, table
        start = stop


def _kept(
    kept: Tables, below: Callable[..., list[PointForce]], z: Array, layer: int, scale: float, *, excess: bool
) -> list[PointForce]:
    """Point-force tables from ``kept``, or by ``below`` and then kept, for at most ``KEPT`` depths in all."""
    key = (z.tobytes(), layer, scale, excess)
    if key not in kept:
        if z.size + sum(len(tables) for tables in kept.values()) > KEPT:
            kept.clear()
        kept[key] = below(z, layer, scale, excess=excess)
    return kept[key]


def _near(
    table: PointForce | None, first: bool, z: float, lattice: Lattice, response: _Response
) -> Influence:
    """Influence of a node of the grid at a shallow depth."""
    dx, dy = lattice.dx, lattice.dy

    def rectangle(X: Array, Y: Array) -> Array:
        normal, tangential = response.closed(X, Y, z, dx, dy)
        return normal + response.body.friction * tangential

    if not first:
        return near_influence(None, None, table, dx, dy, z, response.odd_in_y)
    # a rectangle of d/50 is a point from some patches on
    reach = 6 * max(dx, dy) * np.exp(np.arange(0, 8.5, 0.02))
    outside = response.from_lines(
        partial(response.closed, z=z, dx=dx / 50, dy=dy / 50), reach, response.body.friction
    )
    return near_influence(rectangle, outside, table, dx, dy, z, response.odd_in_y)


def _as_points(table: PointForce | None, lattice: Lattice) -> Influence:
    assert table is not None
    return lambda m, n: table(m * lattice.dx, n * lattice.dy)
