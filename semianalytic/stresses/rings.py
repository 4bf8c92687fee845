"""Pressure on rings around a point, by angular harmonics.

The field at depth z below a point is the pressure p times the influence of a point force, a few harmonics of
the direction psi from the force to the point (``point_force``), summed over the contact. Ring by ring,

    int p G_m(rho, z) cos(m psi) dA = int_0^inf G_m(rho, z) P_m(rho) rho d rho,    P_m = int p cos(m psi) d
    psi,

and the P_m of one point serve every depth below it. Where a ring crosses the edge of the contact p falls to
zero like a square root. Each arc inside is integrated from the crossing, or from where the ring passes
nearest to the edge, by Gauss points in mu, with beta the angle from the middle of the gap outside and delta
half its width,

    beta = delta cosh(mu) on a ring that crosses the edge,    beta = delta sinh(mu) on one that misses it.

Panels of rho shrink towards the radii at which a ring touches the edge, and to the scale of the depth.
Against closed forms: 1e-8 of the peak pressure, at the edge itself too.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray

from semianalytic import numbers
from semianalytic.edge.edge_shape import Shape
from semianalytic.stresses.ring_quadrature import from_gap, gauss_legendre, panels

Array = NDArray[np.floating]

# Signs of 1, cos psi, sin psi, .. cos 3 psi, sin 3 psi under x -> -x, psi -> pi - psi; and under y -> -y.
MIRRORED = [[1, -1, 1, 1, -1, -1, 1], [1, 1, -1, 1, -1, 1, -1]]


@dataclass(frozen=True, eq=False)
class Rings:
    """foot : index of the point each ring surrounds, (n,), ascending.  radius : rho [m].  weight : rho d rho
    [m^2].

    harmonics : P_m [Pa] with 1, cos psi, sin psi, .. cos 3 psi, sin 3 psi, (7, n).
    """

    foot: NDArray[np.intp]
    radius: Array
    weight: Array
    harmonics: Array


@lru_cache(maxsize=16)
def rings_of(shape: Shape, coarser: int = 0) -> "RingPressure":
    """The pressure of a shape, by fewer points where ``coarser``; the same object for the same one."""
    terms = max(len(shape.coefficients), 6)
    more = 12 if shape.outside else 0
    length = int(np.arcsinh(1 / shape.layer))  # of the polynomials' argument, which varies along an arc
    angular, radial = 12 + more + terms + 2 * length - 2 * coarser, 6 + more + terms // 2 - coarser
    if shape.round:
        # fewer on an arc are enough here: 1e-8 of the peak pressure, against 120
        return Disc(shape.axes[0], shape.at_distance, angular - 4, radial, shape.width)
    if shape.twin:
        return Twins(SmoothContour(replace(shape, twin=False), angular, radial))
    return SmoothContour(shape, angular, radial)


@dataclass(frozen=True, eq=False)
class Disc:
    """Round pressure: ``of_square``, p of r^2, on a disc of ``radius`` [m]; Gauss points on an arc, on a
    panel; ``width`` [m] over which p changes beside the edge."""

    radius: float
    of_square: Callable[[Array], Array]
    angular: int = 20
    radial: int = 8
    width: float = np.inf

    def pressure(self, x: ArrayLike, y: ArrayLike) -> Array:
        """p [Pa], 0 outside."""
        square = np.asarray(x, dtype=float) ** 2 + np.asarray(y, dtype=float) ** 2
        return np.where(square < self.radius**2, self.of_square(square), 0.0)

    def rings(self, x: Array, y: Array, scale: Array) -> Rings:
        """Rings around points x, y [m], (n,), below which fields change over depths from ``scale`` [m]."""
        return _around([self], x, y, scale)[0]


def rings_around(
    pressures: "Sequence[RingPressure]", points: Sequence[tuple[Array, Array]], scale: Array
) -> list[Rings]:
    """Rings of each pressure around its points x, y [m], (n,); ``scale`` as in `Disc`.

    Round pressures of the same x/a share the places of the rings over a.
    """
    discs = [p for p in pressures if isinstance(p, Disc)]
    alike = len(discs) == len(pressures) and all(
        np.allclose(np.divide(one, disc.radius), np.divide(points[0], discs[0].radius), 1e-12, 0.0)
        for disc, one in zip(discs, points, strict=True)
    )
    # one pressure on fewer points shows the error of these
    if alike and not any(disc.of_square == discs[0].of_square for disc in discs[1:]):
        return _around(discs, *points[0], scale)
    return [p.rings(x, y, scale) for p, (x, y) in zip(pressures, points, strict=True)]


def _around(discs: Sequence[Disc], x: Array, y: Array, scale: Array) -> list[Rings]:
    """Rings around points x, y [m] of the first disc, and at the same x/a and y/a of the others."""
    first = discs[0]
    a = first.radius
    # points at the same distance from the axis, but for rounding, share their rings
    r0, same = np.unique(np.round(np.hypot(x, y) / a, 13), return_inverse=True)
    r0 *= a
    least = np.full(r0.size, np.inf)
    np.minimum.at(least, same, scale)
    marks = [([abs(a - one), a + one], one < a) for one in r0]
    foot, radius, weight = panels(marks, least, first.radial, first.width)
    harmonics = np.zeros((len(discs), 7, foot.size))
    s, w = gauss_legendre(first.angular)
    for begin in range(0, foot.size, numbers.CACHE // first.angular):
        part = slice(begin, begin + numbers.CACHE // first.angular)
        r, rho = r0[foot[part]], radius[part]
        # the direction -x inwards; kappa = cos of the crossing from there
        product = 2 * r * rho
        kappa = np.full(rho.shape, -1e3)
        np.divide(r * r + rho * rho - a**2, product, out=kappa, where=product > 0)
        crossing = kappa > -1
        delta = np.where(
            crossing, np.pi - np.arccos(np.clip(kappa, -1, 1)), np.arccosh(np.maximum(-kappa, 1.0))
        )
        beta, slope = from_gap(delta, np.full(rho.shape, np.pi), crossing, s)
        cosine = np.cos(beta)
        square = np.minimum((r - rho)[:, None] ** 2 + product[:, None] * (1 + cosine), a**2)
        powers = [2 * slope * w]
        for _ in range(3):
            powers.append(powers[-1] * cosine)
        for disc, held in zip(discs, harmonics, strict=True):
            p = disc.of_square(square * (disc.radius / a) ** 2)
            p[kappa >= 1] = 0
            mean, m1, m2, m3 = (np.vecdot(p, one) for one in powers)  # of cos^m from the direction inwards
            held[0, part], held[1, part] = mean, -m1
            held[3, part], held[5, part] = 2 * m2 - mean, 3 * m1 - 4 * m3
    found = []
    for disc, held in zip(discs, harmonics, strict=True):
        k = disc.radius / a
        found.append(_turned(Rings(foot, radius * k, weight * k * k, held), same, np.arctan2(y, x)))
    return found


@dataclass(frozen=True, eq=False)
class SmoothContour:
    """Pressure of a shape whose edge is no circle around the origin."""

    shape: Shape
    angular: int = 20
    radial: int = 8

    def pressure(self, x: ArrayLike, y: ArrayLike) -> Array:
        """p [Pa], 0 outside."""
        return self.shape.pressure(x, y)

    def rings(self, x: Array, y: Array, scale: Array) -> Rings:
        """Rings of `Disc`, one set for mirror images; the last are kept, for the next layer or field."""
        mirrors = self.shape.mirrors
        folded = [np.abs(v) if mirror else v for v, mirror in zip((x, y), mirrors, strict=True)]
        feet, same = np.unique(np.stack(folded), axis=1, return_inverse=True)
        same, least = same.ravel(), np.full(feet.shape[1], np.inf)
        np.minimum.at(least, same, scale)
        rings = _copied(_around_contour(self, *(v.tobytes() for v in (*feet, least))), same)
        for v, mirror, signs in zip((x, y), mirrors, np.array(MIRRORED), strict=True):
            if mirror:
                rings.harmonics[:, v[rings.foot] < 0] *= signs[:, None]
        return rings

    def around(self, x: Array, y: Array, scale: Array) -> Rings:
        """Rings around points without regard to mirror images."""
        inside = self.shape.polynomials(x, y)[0] > 0
        marks = list(zip(self._touching(x, y), inside.tolist(), strict=True))
        foot, radius, weight = panels(marks, scale, self.radial, self.shape.width)
        harmonics = np.empty((7, foot.size))
        step = numbers.CACHE // self.angular
        for begin in range(0, foot.size, step):
            part = slice(begin, begin + step)
            harmonics[:, part] = self._harmonics(x[foot[part]], y[foot[part]], radius[part])
        return Rings(foot, radius, weight, harmonics)

    def _touching(self, x: Array, y: Array) -> list[list[float]]:
        """Distances at which rings around each point touch the edge: extrema along it, ascending."""
        h = 1e-3

        def square(of: NDArray[np.intp], angle: Array) -> Array:
            X, Y = self.shape.on_ray(1.0, angle)
            found: Array = (X - x[of]) ** 2 + (Y - y[of]) ** 2
            return found

        sampled = square(np.arange(x.size)[:, None], 2 * np.pi * np.arange(numbers.AROUND) / numbers.AROUND)
        before, after = np.roll(sampled, 1, axis=1), np.roll(sampled, -1, axis=1)
        extreme = (sampled - before) * (after - sampled) <= 0
        extreme[~extreme.any(axis=1), :1] = True  # the centre of a circle
        point, k = np.nonzero(extreme)
        angle = 2 * np.pi * k / numbers.AROUND
        for _ in range(4):
            low, here, high = square(point, angle + h * np.array([[-1], [0], [1]]))
            slope, bend = (high - low) / (2 * h), (high - 2 * here + low) / h**2
            flat = np.abs(bend) < 1e-6 * here
            step = np.where(flat, 0.0, -slope / np.where(flat, 1.0, bend))
            angle = angle + np.clip(step, -np.pi / numbers.AROUND, np.pi / numbers.AROUND)
        # where two extrema are about to arise, or have just gone, the harmonics change as fast as beside one
        bend = after - 2 * sampled + before
        inflected, size = bend * np.roll(bend, -1, axis=1) < 0, np.abs(bend)
        flattest = (size < np.roll(size, 1, axis=1)) & (size <= np.roll(size, -1, axis=1))
        flattest &= ~(inflected | np.roll(inflected, 1, axis=1))
        point_of_arising, k = np.nonzero(inflected | flattest)
        crossing, share = inflected[point_of_arising, k], np.zeros(k.size)
        share[crossing] = bend[inflected] / (bend - np.roll(bend, -1, axis=1))[inflected]
        distance = np.sqrt(
            np.concatenate(
                [square(point, angle), square(point_of_arising, 2 * np.pi * (k + share) / numbers.AROUND)]
            )
        )
        point = np.concatenate([point, point_of_arising])
        order = np.lexsort((distance, point))
        point, distance = point[order], distance[order]
        begin = np.searchsorted(point, np.arange(x.size + 1))
        touches = [distance[i:j].tolist() for i, j in pairwise(begin)]
        return [
            [one[0], *(d for d in one[1:-1] if d > 1.001 * one[0] and d < 0.999 * one[-1]), one[-1] + 1e-15]
            for one in touches
        ]

    def _harmonics(self, x: Array, y: Array, rho: Array) -> Array:
        def t(ring: NDArray[np.intp], phi: Array) -> Array:
            shift = (...,) + (None,) * (phi.ndim - 1)
            u = x[ring][shift] + rho[ring][shift] * np.cos(phi)
            return self.shape.inside(u, y[ring][shift] + rho[ring][shift] * np.sin(phi))

        everywhere = np.arange(rho.size)
        sampled = t(everywhere, 2 * np.pi * np.arange(numbers.RING)[None] / numbers.RING)
        ring, low, high, curvature = _segments(sampled, t)
        t_low, t_high = t(ring, low), t(ring, high)
        # around a point on an axis of symmetry one of each two arcs that are mirror images counts twice
        on_axis = [mirror & (v == 0) for v, mirror in zip((x, y), self.shape.mirrors, strict=True)]
        on_axis[0] &= ~on_axis[1]
        middle, times = (low + high) / 2, np.ones(ring.size)
        for on, side in zip(on_axis, (np.cos(middle), np.sin(middle)), strict=True):
            times[on[ring]] = 1 + np.sign(np.round(side[on[ring]], 9))
        kept = (t_high > 0) & (times > 0)
        ring, low, high, curvature = ring[kept], low[kept], high[kept], curvature[kept]
        t_low, t_high, times = t_low[kept], t_high[kept], times[kept]
        crossing = t_low < 0
        outer, cut = np.ones(ring.size), np.flatnonzero(crossing)
        at, begin, length = ring[cut], low[cut], (high - low)[cut]
        outer[cut] = _crossing(lambda share: t(at, begin + share * length), t_low[cut], t_high[cut])
        width = np.abs(high - low)
        missed = np.sqrt(np.maximum(2 * t_low, 0) / np.maximum(curvature, 1e-300))
        delta = np.where(crossing, outer * width, missed)
        s, w = gauss_legendre(self.angular)
        beta, slope = from_gap(delta, width, crossing, s)
        phi = low[:, None] + np.sign(high - low)[:, None] * beta
        cos, sin = np.cos(phi), np.sin(phi)
        p = self.shape.pressure(
            x[ring][:, None] + rho[ring][:, None] * cos, y[ring][:, None] + rho[ring][:, None] * sin
        ) * (slope * w * times[:, None])
        harmonics = np.array([np.bincount(ring, one, minlength=rho.size) for one in _sums(p, cos, sin)])
        for on, signs in zip(on_axis, np.array(MIRRORED), strict=True):
            harmonics[np.ix_(signs < 0, on)] = 0.0
        return harmonics


@dataclass(frozen=True, eq=False)
class Twins:
    """Pressure with its mirror image at -x."""

    one: SmoothContour

    def pressure(self, x: ArrayLike, y: ArrayLike) -> Array:
        """p [Pa], 0 outside."""
        return self.one.pressure(x, y) + self.one.pressure(-np.asarray(x), y)

    def rings(self, x: Array, y: Array, scale: Array) -> Rings:
        """Rings of `Disc`."""
        here, there = self.one.rings(x, y, scale), self.one.rings(-x, y, scale)
        foot = np.concatenate([here.foot, there.foot])
        order = np.argsort(foot, kind="stable")
        return Rings(
            foot[order],
            np.concatenate([here.radius, there.radius])[order],
            np.concatenate([here.weight, there.weight])[order],
            np.concatenate([here.harmonics, np.array(MIRRORED[0])[:, None] * there.harmonics], axis=1)[
                :, order
            ],
        )


@dataclass(frozen=True, eq=False)
class Node:
    """Unit force on a node of patches of side d [m]: p = B(x/d) B(y/d)/d^2, B Keys' cubic."""

    d: float

    def pressure(self, x: ArrayLike, y: ArrayLike) -> Array:
        """p [1/m^2]."""
        return _keys(np.asarray(x) / self.d) * _keys(np.asarray(y) / self.d) / self.d**2

    def rings(self, x: Array, y: Array, scale: Array) -> Rings:
        """Rings of `Disc`; those around the same places, in patches, are kept for other patches."""
        places = (np.round(x / self.d, 9), np.round(y / self.d, 9), np.minimum(scale / self.d, 1.0))
        unit = _around_node(*(v.tobytes() for v in places))
        harmonics = unit.harmonics / self.d**2
        return Rings(unit.foot, unit.radius * self.d, unit.weight * self.d**2, harmonics)


RingPressure = Disc | SmoothContour | Twins | Node  # a pressure with a smooth edge


@lru_cache(maxsize=12)
def _around_contour(contour: SmoothContour, *places: bytes) -> Rings:
    return contour.around(*(np.frombuffer(v) for v in places))


@lru_cache(maxsize=8)
def _around_node(*places: bytes) -> Rings:
    """Rings around points x, y over their arcs within the node, on patches of side 1."""
    x, y, scale = (np.frombuffer(v) for v in places)
    corner = 2**1.5
    r, towards = np.hypot(x, y), np.arctan2(-y, -x)
    marks = [([max(one - corner, 0.0), one + corner], False) for one in r]
    foot, radius, weight = panels(marks, scale, numbers.NODE_POINTS[1])
    # half the angle within which a ring crosses the circle around the node
    kappa = (r[foot] ** 2 + radius**2 - corner**2) / np.maximum(2 * r[foot] * radius, 1e-30)
    width = np.arccos(np.clip(kappa, -1, 1))
    s = (np.arange(numbers.NODE_POINTS[0]) + 0.5) / numbers.NODE_POINTS[0] * 2 - 1
    phi = towards[foot][:, None] + width[:, None] * s
    c, s = np.cos(phi), np.sin(phi)
    p = _keys(x[foot][:, None] + radius[:, None] * c) * _keys(y[foot][:, None] + radius[:, None] * s)
    p *= (2 * width / numbers.NODE_POINTS[0])[:, None]
    return Rings(foot, radius, weight, _sums(p, c, s))


def _sums(p: Array, cos: Array, sin: Array) -> Array:
    """P_m of p times the arc, (n, nodes), at the directions from the points: (7, n)."""
    sums, even, odd = [p.sum(axis=1)], p, 0.0 * p
    for _ in range(3):  # the direction to the point is that from it turned by pi
        even, odd = odd * sin - even * cos, -even * sin - odd * cos
        sums += [even.sum(axis=1), odd.sum(axis=1)]
    return np.array(sums)


def _keys(t: Array) -> Array:
    """B(t): R. G. Keys, IEEE Trans. Acoust. Speech Signal Process. 29 (1981) 1153-1160, eq. 15."""
    t = np.abs(t)
    outer = np.maximum(2 - t, 0)
    return np.where(t < 1, (1.5 * t - 2.5) * t * t + 1, 0.5 * (1 - t) * outer * outer)


def _copied(rings: Rings, same: NDArray[np.intp]) -> Rings:
    """The rings around each of the points ``same``, one after the other."""
    begin = np.searchsorted(rings.foot, np.arange(same.max(initial=0) + 2))
    count = np.diff(begin)[same]
    foot = np.repeat(np.arange(same.size), count)
    at = np.arange(foot.size) + np.repeat(begin[same] - (np.cumsum(count) - count), count)
    return Rings(foot, rings.radius[at], rings.weight[at], rings.harmonics[:, at])


def _turned(rings: Rings, same: NDArray[np.intp], angle: Array) -> Rings:
    """The rings around points on the x axis as those around points ``same`` in the direction ``angle``."""
    rings = _copied(rings, same)
    harmonics, foot = rings.harmonics, rings.foot
    for m in (1, 2, 3):
        even = harmonics[2 * m - 1].copy()
        harmonics[2 * m - 1] = even * np.cos(m * angle)[foot]
        harmonics[2 * m] = even * np.sin(m * angle)[foot]
    return rings


def _crossing(t: Callable[[Array], Array], t_low: Array, t_high: Array) -> Array:
    """Shares of arcs, from t_low < 0 to t_high > 0, at which t changes sign.

    By bisection, then by the Illinois method (M. Dowell and P. Jarratt, BIT 11 (1971) 168-174), in
    w = sin^2 of pi/2 times the share, in which t on a ring within a round contact is linear.
    """
    low, high, before = np.zeros(t_low.size), np.ones(t_low.size), np.zeros(t_low.size)
    share = high
    for step in range(sum(numbers.CROSSING)):
        w = (
            (low + high) / 2
            if step < numbers.CROSSING[0]
            else (low * t_high - high * t_low) / (t_high - t_low)
        )
        share = 2 / np.pi * np.arcsin(np.sqrt(w))
        found = t(share)
        side = np.sign(found)
        t_low = np.where(side > 0, np.where(before > 0, t_low / 2, t_low), found)
        t_high = np.where(side > 0, found, np.where(before < 0, t_high / 2, t_high))
        low, high, before = np.where(side > 0, low, w), np.where(side > 0, w, high), side
    return share


def _segments(
    sampled: Array, t: Callable[[NDArray[np.intp], Array], Array]
) -> tuple[NDArray[np.intp], Array, Array, Array]:
    """Arcs from each minimum of t on a ring to the maxima beside it: ring, both angles, t'' at the minimum.

    sampled : t at equal angles from 0, (rings, RING).
    """
    before, after = np.roll(sampled, 1, axis=1), np.roll(sampled, -1, axis=1)
    lows, highs = (sampled < before) & (sampled <= after), (sampled > before) & (sampled >= after)
    flat = np.ptp(sampled, axis=1) < numbers.ROUNDING * np.abs(sampled).max(axis=1)
    flat |= ~lows.any(axis=1) | ~highs.any(axis=1)
    lows[flat], highs[flat] = False, False
    lows[flat, 0] = highs[flat, numbers.RING // 2] = True
    ring, k = np.nonzero(lows | highs)
    phi, low = 2 * np.pi * k / numbers.RING, lows[ring, k]
    h = 1e-3
    for _ in range(3):
        minus, here, plus = (t(ring, phi + shift) for shift in (-h, 0.0, h))
        slope, curvature = (plus - minus) / (2 * h), (plus - 2 * here + minus) / h**2
        good = ~flat[ring] & (np.where(low, curvature, -curvature) > 1e-12 * np.abs(sampled).max())
        change = np.where(good, -slope / np.where(good, curvature, 1.0), 0.0)
        phi = phi + np.clip(change, -np.pi / numbers.RING, np.pi / numbers.RING)
    # neighbours along a ring, the last one and the first
    first = np.searchsorted(ring, ring)
    last = np.searchsorted(ring, ring, side="right") - 1
    index = np.arange(ring.size)
    following = np.where(index == last, first, index + 1)
    ahead = np.where(index == last, phi[following] + 2 * np.pi, phi[following])
    use = low != low[following]
    at_low = np.where(low, index, following)[use]
    start, end = np.where(low[use], (phi[use], ahead[use]), (ahead[use], phi[use]))
    return ring[use], start, end, np.maximum(curvature[at_low], 0.0)
