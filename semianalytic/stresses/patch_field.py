"""Stress below patches: a rough contact, or every patch centre of a plane.

The pressure between patch centres is the cubic convolution of Keys (1981) of its values there,

    p(x) = sum_i p_i B(x/d - i) in each direction,   B cubic on |t| < 1 and on 1 < |t| < 2,   q = f p,

so that the field at one depth is a discrete convolution of the nodal forces with the influence of one node.
More than ``NEAR`` patches away, or deeper than ``SHALLOW``, a node is a point force; nearer it is the field
of the pressure B B on rings (``subsurface``). B has the moments 1, 0, 0, 0, -3/10; with the fourth
subtracted as a fourth difference, both meet. Deeper down the forces are first gathered on lattices of spacing
up to z/12. Between patch centres the field is interpolated.

"Stress analysis of elastic coated solids in point contact", eqs. 1-4. Axes: z down; tension positive; SI.
R. G. Keys, IEEE Trans. Acoust. Speech Signal Process. 29 (1981) 1153-1160, eq. 15.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.fft import irfft2, next_fast_len, rfft2

from semianalytic.inputs import Body
from semianalytic.stresses import subsurface
from semianalytic.stresses.nodal_convolution import (
    GATHERED,
    WIDE,
    Influence,
    Lattice,
    at_points,
    between_sites,
    influence_table,
    near_and_far,
    nodal_forces,
    samples,
)
from semianalytic.stresses.rings import Node
from semianalytic.stresses.subsurface import DEPTHS, PointField, chebyshev, weights

Array = NDArray[Any]

SHALLOW = 3.0  # patches; above this depth a node is not yet a point force: aliases exp(-6 pi) = 7e-9
COARSE = 12.0  # depth over lattice spacing; interpolation through ten sites then errs by 1e-8 of p_h
NEAR = 6  # patches; beyond, the sixth moment of B contributes 1e-5 of the pressure
BLOCK = NEAR + 2  # offsets computed, two more for the fourth difference


def stress(
    x: ArrayLike, y: ArrayLike, z: ArrayLike, layer: ArrayLike, *, grid_x: Array, pressure: Array, body: Body
) -> Array:
    """Stress at points (x, y, z) of the layers named, under pressure p with traction q = f p in +x.

    x, y, z : points [m], broadcast.  layer : integers, which pick the side of an interface, broadcast.
    pressure : mean of p over each patch [Pa], (n, n), centred at grid_x along both axes [m], which are
    uniform.  Returns xx, yy, zz, xy, xz, yz [Pa], (6,) + points.
    """
    return _evaluate(x, y, z, layer, nodal_forces(grid_x, pressure), _stress_field(body))


def tensor(components: Array) -> Array:
    """xx, yy, zz, xy, xz, yz as a symmetric tensor, shape (3, 3, ...)."""
    xx, yy, zz, xy, xz, yz = components
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


def displacement(
    x: ArrayLike, y: ArrayLike, z: ArrayLike, layer: ArrayLike, *, grid_x: Array, pressure: Array, body: Body
) -> Array:
    """Displacement at points (x, y, z); arguments as in `stress`.

    Returns u[i, ...] [m], shape (3,) + points; u_z into the solid.
    """
    return _evaluate(x, y, z, layer, nodal_forces(grid_x, pressure), _displacement_field(body))


def stress_plane(z: float, layer: int, *, grid_x: Array, pressure: Array, body: Body) -> Array:
    """Stress below all patch centres at depth z [m], (6, n, n), by seven FFTs; arguments as in `stress`."""
    return _plane(z, layer, grid_x, pressure, _stress_field(body))


def displacement_plane(z: float, layer: int, *, grid_x: Array, pressure: Array, body: Body) -> Array:
    """Displacement below all patch centres, (3, n, n), by four FFTs; arguments as in `displacement`."""
    return _plane(z, layer, grid_x, pressure, _displacement_field(body))


def _plane(z: float, layer: int, grid_x: Array, pressure: Array, field: "_Field") -> Array:
    n, d = len(grid_x), float(grid_x[-1] - grid_x[0]) / (len(grid_x) - 1)
    ((influence, _),) = field.influences(np.array([float(z)]), layer, d)
    # forces reach one patch beyond the grid, see `samples`
    offsets = np.arange(-n, n + 1)
    size = (next_fast_len(2 * n + 1, real=True),) * 2
    force = rfft2(samples(pressure) * d**2, size)
    out = np.empty((field.components, n, n))
    table = influence_table(influence, offsets, offsets, field.odd_in_y)
    for component, part in zip(out, table, strict=True):
        component[:] = irfft2(rfft2(part, size) * force, size)[n + 1 : 2 * n + 1, n + 1 : 2 * n + 1]
    return out


@dataclass(frozen=True, eq=False)
class _Field:
    """Stress or displacement: near(x, y, z, layer, pressures=) on rings; point(z, layer) of unit forces.

    odd_in_y : components odd in y.
    """

    near: Callable[..., Array]
    point: Callable[[Array, int], PointField]
    components: int
    odd_in_y: tuple[int, ...]

    def influences(self, depths: Array, layer: int, d: float) -> list[tuple[Influence, Influence]]:
        """Influence of a node, of integer offsets, and of a point, at each of the ``depths`` [m] of one
        layer."""
        point = self.point(depths, layer)
        shallow = depths[depths < SHALLOW * d]
        near: list[Array | None] = [None] * depths.size
        if shallow.size:
            near[: shallow.size] = self._blocks(shallow, layer, d)
        return [
            (partial(_influence, point, z, d, block), partial(point, z=z))
            for z, block in zip(depths, near, strict=True)
        ]

    def _blocks(self, depths: Array, layer: int, d: float) -> Array:
        """Influence of a node at offsets up to ``NEAR``, (depths, components, 2 NEAR + 1, 2 NEAR + 1)."""
        m, n = np.meshgrid(np.arange(-BLOCK, BLOCK + 1), np.arange(BLOCK + 1), indexing="ij")
        x, y, z = np.broadcast_arrays(m * d, n * d, depths[:, None, None])
        where = np.full(z.size, layer)
        half = self.near(x.ravel(), y.ravel(), z.ravel(), where, pressures=[Node(d)])[0]
        half = half.reshape(self.components, *z.shape)
        mirrored = half[..., :0:-1].copy()
        mirrored[list(self.odd_in_y)] *= -1
        block = np.concatenate([mirrored, half], axis=-1)
        for axis in (2, 3):  # plus 1/80 of its fourth differences
            b = np.moveaxis(block, axis, 0)
            fourth = b[:-4] + b[4:] - 4 * (b[1:-3] + b[3:-1]) + 6 * b[2:-2]
            block = np.moveaxis(b[2:-2] + fourth / 80, 0, axis)
        return block.swapaxes(0, 1)


def _influence(point: PointField, z: float, d: float, near: Array | None, m: Array, n: Array) -> Array:
    """Influence of unit force on a node at integer offsets (m, n), (components, k)."""
    if near is None:
        return point(m * d, n * d, z)
    close = np.maximum(np.abs(m), np.abs(n)) <= NEAR
    total = np.empty((len(near), m.size))
    total[:, ~close] = point(m[~close] * d, n[~close] * d, z)
    total[:, close] = near[:, m[close] + NEAR, n[close] + NEAR]
    return total


def _stress_field(body: Body) -> _Field:
    point = partial(PointField.of, response=subsurface.stress_response(body))
    return _Field(partial(subsurface.stress, body=body), point, 6, odd_in_y=(3, 5))


def _displacement_field(body: Body) -> _Field:
    point = partial(PointField.of, response=subsurface.displacement_response(body))
    return _Field(partial(subsurface.displacement, body=body), point, 3, odd_in_y=(1,))


def _evaluate(
    x: ArrayLike, y: ArrayLike, z: ArrayLike, layer: ArrayLike, fine: Lattice, field: _Field
) -> Array:
    """Field components (n,) + points, layer by layer and depth by depth."""
    x, y, z, layer = np.broadcast_arrays(*(np.asarray(v) for v in (x, y, z, layer)))
    shape = z.shape
    x, y, z, layer = (v.ravel() for v in (x, y, z, layer))
    lattices = [fine]
    while max(lattices[-1].force.shape) > 24:
        lattices.append(lattices[-1].coarser())
    shallow = z < SHALLOW * fine.dx
    out = np.zeros((field.components, z.size))
    for number in np.unique(layer):
        for near in (True, False):
            here = np.flatnonzero((layer == number) & (shallow == near))
            depths, which = np.unique(z[here], return_inverse=True)
            if near and depths.size > DEPTHS:
                depths = chebyshev(depths[0], depths[-1], False)
                share = weights(depths, z[here])
                for w, of_depth in zip(share, _fields(depths, int(number), lattices, field), strict=True):
                    out[:, here] += w * of_depth(x[here], y[here])
            else:
                for i, of_depth in enumerate(_fields(depths, int(number), lattices, field)):
                    at = here[which == i]
                    out[:, at] = of_depth(x[at], y[at])
    return out.reshape(field.components, *shape)


def _fields(
    depths: Array, layer: int, lattices: list[Lattice], field: _Field
) -> Iterator[Callable[[Array, Array], Array]]:
    """For each depth of one layer, the field as a function of x and y, (k,) -> (components, k)."""
    fine = lattices[0]
    odd = field.odd_in_y
    for z, (influence, kernel) in zip(depths, field.influences(depths, layer, fine.dx), strict=True):
        level = int(np.clip(np.log2(max(z / (COARSE * fine.dx), 1)), 0, len(lattices) - 1))
        lattice, shallow = lattices[level], z < SHALLOW * fine.dx
        if max(lattice.force.shape) > WIDE:
            pair = lattice, lattices[level + GATHERED]
            if level:
                influence = partial(_of_lattice, kernel, lattice.dx)
            yield partial(
                near_and_far,
                lattices=pair,
                influence=influence,
                kernel=kernel,
                odd_in_y=odd,
                order=4 if shallow else 10,
            )
        elif shallow:
            yield partial(between_sites, lattice=fine, influence=influence, odd_in_y=odd, order=4)
        else:
            yield partial(at_points, lattice=lattice, kernel=kernel, odd_in_y=odd, order=10)


def _of_lattice(kernel: Callable[[Array, Array], Array], d: float, m: Array, n: Array) -> Array:
    """``kernel`` at integer offsets on a lattice of spacing ``d`` [m]."""
    return kernel(m * d, n * d)
