"""Stress and displacement below a pressure with a smooth edge, ring by ring.

    sigma(x, y, z) = int p G dA = sum over rings rho around (x, y) of  G_m(rho, z) P_m(rho) rho d rho,

G_m the influence of a normal and of a tangential point force f (``point_force``), P_m the harmonics of p on
the ring (``rings``), q = f p in +x. In the first layer G is the closed form of the half-space of its
material plus the reflection of what lies below; deeper down, the response of the layers. Both come from
tables over rho, one a depth; where many depths share a layer, from those of a few Chebyshev depths. At z = 0
the closed form leaves the local terms sigma_zz = -p, sigma_xz = -q, (sigma_xx + sigma_yy)/2 = -(1 + 2 nu)
p/2 (Johnson 1985, section 3.4).

"Stress analysis of elastic coated solids in point contact", eqs. 1-4. Axes: z down; tension positive; SI.
Rough pressures, and planes of many points: ``patch_field``.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from semianalytic.inputs import Body
from semianalytic.point_force import (
    PointForce,
    combine_displacement,
    combine_stress,
    directions,
    displacement_below,
    half_space_displacement,
    half_space_stress,
    stress_below,
)
from semianalytic.rings import RingPressure, Rings, rings_around

Array = NDArray[Any]

PAIRS = 200_000  # points times rings held at a time
# Chebyshev depths within an octave of the reach: 10 leave 1e-6 of p0; fewer depths are taken as they are
DEPTHS = 14


@dataclass(frozen=True, eq=False)
class Response:
    """Stress or displacement of a unit force: closed(rho, z) of the half-space of the first material,
    (columns, n); below(z, layer, scale, excess=) the tables of the layers; combine(table, harmonics,
    friction) the components."""

    components: int
    closed: Callable[[Array, Array], Array]
    below: Callable[..., list[PointForce]]
    combine: Callable[[Array, Array, float], Array]


def stress(
    x: Array,
    y: Array,
    z: Array,
    layer: Array,
    *,
    pressures: Sequence[RingPressure],
    body: Body,
    ratios: Sequence[float] | None = None,
) -> Array:
    """Stress xx, yy, zz, xy, xz, yz [Pa] under each pressure, (pressures, 6, n).

    x, y, z : points [m] of the layers named, (n,) each.  layer : picks the side of an interface.
    ratios : of x and y under each pressure to those given; 1 by default.
    """
    nu, f = body.materials[0][1], body.friction
    response = stress_response(nu, body)
    ratios = [1.0] * len(pressures) if ratios is None else ratios
    total = _summed(x, y, z, layer, pressures, ratios, body, response)
    local = np.array([-(1 + 2 * nu) / 2, -(1 + 2 * nu) / 2, -1.0, 0.0, -f, 0.0])
    surface = (z == 0) & (layer == 0)
    for out, pressure, ratio in zip(total, pressures, ratios, strict=True):
        out[:, surface] += local[:, None] * pressure.pressure(x[surface] * ratio, y[surface] * ratio)
    return total


def displacement(
    x: Array,
    y: Array,
    z: Array,
    layer: Array,
    *,
    pressures: Sequence[RingPressure],
    body: Body,
) -> Array:
    """Displacement u_x, u_y, u_z [m], (pressures, 3, n); arguments as in `stress`."""
    E, nu, *_ = body.materials[0]
    response = displacement_response(E, nu, body)
    return _summed(x, y, z, layer, pressures, [1.0] * len(pressures), body, response)


def stress_response(nu: float, body: Body) -> Response:
    """Of the stress, with Poisson's ratio ``nu`` of the first material."""
    of_force = partial(_stress, nu, body.friction)
    return Response(6, of_force, partial(stress_below, body=body), combine_stress)


def displacement_response(E: float, nu: float, body: Body) -> Response:
    """Of the displacement, with ``E`` [Pa] and ``nu`` of the first material."""
    of_force = partial(_displacement, E, nu, body.friction)
    return Response(3, of_force, partial(displacement_below, body=body), combine_displacement)


def _stress(nu: float, f: float, rho: Array, z: Array) -> Array:
    return half_space_stress(rho, z, nu, f)


def _displacement(E: float, nu: float, f: float, rho: Array, z: Array) -> Array:
    return half_space_displacement(rho, z, E, nu, f)


def _summed(
    x: Array,
    y: Array,
    z: Array,
    layer: Array,
    pressures: Sequence[RingPressure],
    ratios: Sequence[float],
    body: Body,
    response: Response,
) -> Array:
    """Components (pressures, components, n): the sums over the rings around each point."""
    out = np.zeros((len(pressures), response.components, z.size))
    if not z.size:
        return out
    feet, foot = np.unique(np.stack([x, y]), axis=1, return_inverse=True)
    foot = foot.ravel()
    first = body.thickness[0] if body.coatings else np.inf
    scale = np.full(feet.shape[1], first, dtype=float)
    np.minimum.at(scale, foot[z > 0], z[z > 0])
    around = rings_around(pressures, ratios, feet[0], feet[1], scale)
    for number in np.unique(layer):
        members = np.flatnonzero(layer == number)
        members = members[np.argsort(z[members], kind="stable")]
        tables = _Tables.of(z[members], int(number), body, response)
        for total, rings in zip(out, around, strict=True):
            total[:, members] = _at_depths(
                rings, foot[members], z[members], int(number), tables, body, response
            )
    return out


def _at_depths(
    rings: Rings,
    foot: NDArray[np.intp],
    z: Array,
    layer: int,
    tables: "_Tables | None",
    body: Body,
    response: Response,
) -> Array:
    """Components (components, n) at points of one layer with the rings ``foot`` and depths z, ascending."""
    begin = np.searchsorted(rings.foot, np.arange(foot.max() + 2))
    count = np.diff(begin)[foot]
    ends = np.cumsum(count)
    out = np.empty((response.components, z.size))
    start = 0
    while start < z.size:
        held = ends[start - 1] if start else 0
        stop = max(start + 1, int(np.searchsorted(ends, held + PAIRS, side="right")))
        some = slice(start, stop)
        which = np.repeat(np.arange(stop - start), count[some])
        ring = np.arange(which.size) + np.repeat(
            begin[foot[some]] - (ends[some] - count[some] - held), count[some]
        )
        depth, rho = z[some][which], rings.radius[ring]
        table = _columns(rho, depth, layer, tables, response)
        parts = response.combine(table, rings.harmonics[:, ring] * rings.weight[ring], body.friction)
        out[:, some] = [np.bincount(which, part, minlength=stop - start) for part in parts]
        start = stop
    return out


def _columns(rho: Array, z: Array, layer: int, tables: "_Tables | None", response: Response) -> Array:
    """Radial functions (columns, n) of a point force at rho, z [m] of one layer."""
    closed = [response.closed(rho, z)] if layer == 0 else []
    return sum([tables(rho, z)] if tables else [], start=sum(closed, start=np.zeros(1)))


@dataclass(frozen=True, eq=False)
class PointField:
    """Field of a normal force 1 with a tangential force f in one layer, at depths it is made for."""

    layer: int
    tables: "_Tables | None"
    response: Response
    friction: float

    @classmethod
    def of(cls, z: Array, layer: int, body: Body, response: Response) -> "PointField":
        """For the depths z [m], ascending."""
        return cls(layer, _Tables.of(z, layer, body, response), response, body.friction)

    def __call__(self, x: Array, y: Array, z: float) -> Array:
        """Components at offsets (x, y) [m] from the force; (components,) + shape of ``x``."""
        rho = np.maximum(np.hypot(x, y), 1e-9 * z).ravel()
        table = _columns(rho, np.full(rho.size, z), self.layer, self.tables, self.response)
        harmonics = directions(x.ravel() / rho, y.ravel() / rho)
        return self.response.combine(table, harmonics, self.friction).reshape(
            self.response.components, *x.shape
        )


@dataclass(frozen=True, eq=False)
class _Tables:
    """Radial functions of the layers at any depth between those of ``groups``: (least depth, nodes, tables).

    image : depth [m] from which the fields vary in proportion to the distance
    """

    groups: list[tuple[float, Array, list[PointForce]]]
    between: list[bool]
    image: float

    @classmethod
    def of(cls, z: Array, layer: int, body: Body, response: Response) -> "_Tables | None":
        """For the depths z [m], ascending, of one layer; None of an uncoated body.

        Fields vary with the distance from the force, in the first coating from its image: ``reach``.
        """
        if not body.coatings:
            return None
        image = 2 * body.thickness[0] if layer == 0 else 0.0
        reach = np.abs(image - z)
        # counted from the least, so that a few depths beside each other share a scale and its error
        least = reach.min(initial=np.inf)
        octave = np.floor(np.log2(reach / least) + 1e-9)
        groups, between = [], []
        for power in dict.fromkeys(octave):
            here = octave == power
            depths = np.unique(z[here])
            between.append(depths.size > DEPTHS)
            if between[-1]:
                nodes = chebyshev(reach[here].min(), reach[here].max(), True)
                depths = np.abs(image - nodes)
            tables = response.below(depths, layer, least * 2.0**power, excess=layer == 0)
            groups.append((float(z[here][0]), depths, tables))
        return cls(groups, between, image)

    def __call__(self, rho: Array, z: Array) -> Array:
        """(columns, n) at rho, z [m]."""
        lows = [low for low, *_ in self.groups]
        which = np.searchsorted(lows, z, side="right") - 1
        *_, (first, *_) = self.groups[0]
        out = np.zeros((first.radial.c.shape[-1], rho.size))
        for k, (_, depths, tables) in enumerate(self.groups):
            here = np.flatnonzero(which == k)
            s = np.arcsinh(rho[here] / tables[0].scale)
            if self.between[k]:
                nodes, reach = (np.log(np.abs(self.image - one)) for one in (depths, z[here]))
                for w, table in zip(weights(nodes, reach), tables, strict=True):
                    out[:, here] += w * table.radial(s).T
            else:
                nearest = np.clip(np.searchsorted(depths, z[here] * (1 - 1e-12)), 0, len(tables) - 1)
                for i, table in enumerate(tables):
                    at = nearest == i
                    out[:, here[at]] = table.radial(s[at]).T
        return out


def chebyshev(low: float, high: float, in_logarithm: bool) -> Array:
    """Depths at the Chebyshev nodes of [low, high], ends included, or of its logarithm."""
    t = (1 - np.cos(np.pi * np.arange(DEPTHS) / (DEPTHS - 1))) / 2
    return low * (high / low) ** t if in_logarithm else low + (high - low) * t


def weights(nodes: Array, x: Array) -> Array:
    """Barycentric weights (nodes, n) of the polynomial through Chebyshev ``nodes``, ends included, at x."""
    w = (-1.0) ** np.arange(nodes.size)
    w[[0, -1]] /= 2
    difference = x - nodes[:, None]
    exact = np.abs(difference) < 1e-14 * (nodes[-1] - nodes[0])
    terms = w[:, None] / np.where(exact, 1.0, difference)
    terms = np.where(exact.any(axis=0), exact, terms)
    return terms / terms.sum(axis=0)
