"""Stress and displacement below a pressure with a smooth edge, ring by ring.

    sigma(x, y, z) = int p G dA = sum over rings rho around (x, y) of  G_m(rho, z) P_m(rho) rho d rho,

G_m the influence of a normal and of a tangential point force f (``point_force``), P_m the harmonics of p on
the ring (``rings``), q = f p in +x. In the first layer G is the closed form of the half-space of its
material plus the reflection of what lies below; deeper down, the response of the layers. Both come from
tables over rho, one a depth; where many depths share a layer, from those of a few Chebyshev depths. At z = 0
the closed form leaves the local terms sigma_zz = -p, sigma_xz = -q, (sigma_xx + sigma_yy)/2 = -(1 + 2 nu)
p/2 (Johnson 1985, section 3.4).

G: Johnson, Contact Mechanics (1985), sections 3.2 and 3.6, and the layers' response; the sum over rings was
derived here (manual, "Stresses below the patches"). Axes: z down; tension positive; SI. Rough pressures, and
planes of many points: ``patch_field``.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PPoly

from semianalytic import numbers
from semianalytic.coefficients.point_force import (
    PointForce,
    combine_displacement,
    combine_stress,
    directions,
    displacement_below,
    half_space_displacement,
    half_space_stress,
    stress_below,
)
from semianalytic.inputs import Body
from semianalytic.stresses.rings import RingPressure, Rings, rings_around

Array = NDArray[Any]


@dataclass(frozen=True, eq=False)
class FieldResponse:
    """Stress or displacement of a unit force on ``body``.

    closed(rho, z) : radial functions of the half-space of the first material, (columns, n).
    below(z, layer, scale, excess=) : tables of the layers.
    combine(radial, harmonics, friction) : the components.
    """

    body: Body
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
    places: Sequence[tuple[Array, Array]] | None = None,
) -> Array:
    """Stress xx, yy, zz, xy, xz, yz [Pa] under each pressure, (pressures, 6, n).

    x, y, z : points [m] of the layers named, (n,) each.  layer : picks the side of an interface.
    places : x and y [m] under each pressure in place of those given.
    """
    nu, f = body.materials[0][1], body.friction
    places = places or [(x, y)] * len(pressures)
    total = _summed(places, z, layer, pressures, stress_response(body))
    local = np.array([-(1 + 2 * nu) / 2, -(1 + 2 * nu) / 2, -1.0, 0.0, -f, 0.0])
    surface = (z == 0) & (layer == 0)
    for out, pressure, (x, y) in zip(total, pressures, places, strict=True):
        out[:, surface] += local[:, None] * pressure.pressure(x[surface], y[surface])
    return total


def displacement(
    x: Array,
    y: Array,
    z: Array,
    layer: Array,
    *,
    pressures: Sequence[RingPressure],
    body: Body,
    places: Sequence[tuple[Array, Array]] | None = None,
) -> Array:
    """Displacement u_x, u_y, u_z [m], (pressures, 3, n); arguments as in `stress`."""
    places = places or [(x, y)] * len(pressures)
    return _summed(places, z, layer, pressures, displacement_response(body))


def stress_response(body: Body) -> FieldResponse:
    """Response of the stress to point forces."""
    nu = body.materials[0][1]
    closed = partial(half_space_stress, nu=nu, friction=body.friction)
    return FieldResponse(body, 6, closed, partial(stress_below, body=body), combine_stress)


def displacement_response(body: Body) -> FieldResponse:
    """Response of the displacement to point forces."""
    E, nu, *_ = body.materials[0]
    closed = partial(half_space_displacement, E=E, nu=nu, friction=body.friction)
    return FieldResponse(body, 3, closed, partial(displacement_below, body=body), combine_displacement)


def _summed(
    places: Sequence[tuple[Array, Array]],
    z: Array,
    layer: Array,
    pressures: Sequence[RingPressure],
    response: FieldResponse,
) -> Array:
    """Components (pressures, components, n): the sums over the rings around each point."""
    out = np.zeros((len(pressures), response.components, z.size))
    if not z.size:
        return out
    at = np.stack([v for place in places for v in place])
    _, first, foot = np.unique(at, axis=1, return_index=True, return_inverse=True)
    foot = foot.ravel()
    feet = [(x[first], y[first]) for x, y in places]
    body = response.body
    scale = np.full(first.size, body.thickness[0] if body.coatings else np.inf, dtype=float)
    np.minimum.at(scale, foot[z > 0], z[z > 0])
    around = rings_around(pressures, feet, scale)
    for number in np.unique(layer):
        members = np.flatnonzero(layer == number)
        members = members[np.argsort(z[members], kind="stable")]
        field = PointField.of(z[members], int(number), response)
        for total, rings in zip(out, around, strict=True):
            total[:, members] = _at_depths(rings, foot[members], z[members], field)
    return out


def _at_depths(rings: Rings, foot: NDArray[np.intp], z: Array, field: "PointField") -> Array:
    """Components (components, n) at points of one layer with the rings ``foot`` and depths z, ascending."""
    response = field.response
    begin = np.searchsorted(rings.foot, np.arange(foot.max() + 2))
    count = np.diff(begin)[foot]
    ends = np.cumsum(count)
    out = np.empty((response.components, z.size))
    start = 0
    while start < z.size:
        held = ends[start - 1] if start else 0
        stop = max(start + 1, int(np.searchsorted(ends, held + numbers.CACHE // 3, side="right")))
        some = slice(start, stop)
        which = np.repeat(np.arange(stop - start), count[some])
        ring = np.arange(which.size) + np.repeat(
            begin[foot[some]] - (ends[some] - count[some] - held), count[some]
        )
        depth, rho = z[some][which], rings.radius[ring]
        harmonics = rings.harmonics[:, ring] * rings.weight[ring]
        parts = response.combine(field.radial(rho, depth), harmonics, response.body.friction)
        out[:, some] = [np.bincount(which, part, minlength=stop - start) for part in parts]
        start = stop
    return out


@dataclass(frozen=True, eq=False)
class PointField:
    """Field of a normal force 1 with a tangential force f in one layer, at depths it is made for.

    groups : of the layers: (least depth, whether they are interpolated between the depths, these, tables).
    image : depth [m] from which the fields vary in proportion to the distance.
    """

    layer: int
    response: FieldResponse
    groups: list[tuple[float, bool, Array, list[PointForce]]]
    image: float

    @classmethod
    def of(cls, z: Array, layer: int, response: FieldResponse) -> "PointField":
        """For the depths z [m], ascending, of one layer.

        Fields vary with the distance from the force, in the first coating from its image: ``reach``.
        """
        body = response.body
        if not body.coatings:
            return cls(layer, response, [], 0.0)
        image = 2 * body.thickness[0] if layer == 0 else 0.0
        reach = np.abs(image - z)
        # counted from the least, so that a few depths beside each other share a scale and its error
        least = reach.min(initial=np.inf)
        octave = np.floor(np.log2(reach / least) + 1e-9)
        groups = []
        for power in dict.fromkeys(octave):
            here = octave == power
            depths = np.unique(z[here])
            if between := depths.size > numbers.DEPTHS:
                nodes = chebyshev(reach[here].min(), reach[here].max(), True)
                depths = np.abs(image - nodes)
            tables = response.below(depths, layer, least * 2.0**power, excess=layer == 0)
            groups.append((float(z[here][0]), between, depths, tables))
        return cls(layer, response, groups, image)

    def __call__(self, x: Array, y: Array, z: float) -> Array:
        """Components at offsets (x, y) [m] from the force; (components,) + shape of ``x``."""
        rho = np.maximum(np.hypot(x, y), 1e-9 * z).ravel()
        distinct, where = np.unique(rho, return_inverse=True)  # an eighth of a lattice
        radial = self.radial(distinct, np.full(distinct.size, z))[:, where]
        harmonics = directions(x.ravel() / rho, y.ravel() / rho)
        parts = self.response.combine(radial, harmonics, self.response.body.friction)
        return parts.reshape(self.response.components, *x.shape)

    def radial(self, rho: Array, z: Array) -> Array:
        """Radial functions (columns, n) of the force at rho, z [m]."""
        closed = self.response.closed(rho, z) if self.layer == 0 else 0.0
        return closed + self._of_layers(rho, z) if self.groups else np.asarray(closed)

    def _of_layers(self, rho: Array, z: Array) -> Array:
        which = np.searchsorted([low for low, *_ in self.groups], z, side="right") - 1
        out = np.zeros((self.groups[0][-1][0].radial.c.shape[-1], rho.size))
        for k in np.unique(which):
            _, between, depths, tables = self.groups[k]
            here = np.flatnonzero(which == k)
            s, at = np.arcsinh(rho[here] / tables[0].scale), z[here]
            at = at[:1] if np.ptp(at) == 0 else at
            if between:
                share = weights(*(np.log(np.abs(self.image - one)) for one in (depths, at)))
            else:
                share = np.searchsorted(depths[:-1], at * (1 - 1e-12)) == np.arange(len(tables))[:, None]
            if at.size == 1:  # one table
                c = sum(w * table.radial.c for w, table in zip(share[:, 0], tables, strict=True) if w)
                out[:, here] = PPoly(c, tables[0].radial.x)(s).T
            else:
                for w, table in zip(share, tables, strict=True):
                    on = np.flatnonzero(w)
                    out[:, here[on]] += w[on] * table.radial(s[on]).T
        return out


def chebyshev(low: float, high: float, in_logarithm: bool) -> Array:
    """Depths at the Chebyshev nodes of [low, high], ends included, or of its logarithm."""
    t = (1 - np.cos(np.pi * np.arange(numbers.DEPTHS) / (numbers.DEPTHS - 1))) / 2
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
