"""The stress of a solution along x at one depth, as a function of friction.

The pressure does not depend on f (Goodman) and stress is linear in f, so that one solution at friction g
gives the stress at every f:

    sigma = sigma_n + f sigma_t

In the plane y = 0 the two parts have opposite parity in x, so that the values at x and -x determine both.
Between the samples both are quintic splines. At the contact edge the surface stress has a cusp: sigma_n is
smooth outside r = a and has the root of the pressure inside; sigma_t is smooth inside and has a root outside.
Splines on either side of it, smooth up to the edge, meet at the solution's own value there.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import make_interp_spline

from verification.judging.invariants.companion_uncertainty import followed
from verification.problem.array_types import Array
from verification.problem.coated_contact import ContactSolution
from verification.problem.point_answers import Points
from verification.problem.quantity import IN_PLANE
from verification.sampling.largest_tension import around_edge, edge_uncertainty

Curve = Callable[[Array], Array]

XX, YY, ZZ, XZ = range(4)
# factor of the response to p under x -> -x; that to q has the opposite sign
PARITY = np.array([1.0, 1.0, 1.0, -1.0])
PARITIES = np.concatenate([PARITY, -PARITY])
LEAST = 33  # samples of a plane; below, the semi-analytical method sums point by point, which takes longer
DENSE = 16  # points between two samples of a line
MIRRORED = 5  # samples repeated beyond x = 0, so that the splines know the parity


@dataclass(frozen=True)
class Parts:
    """Stress due to p and due to q = p, from ``solution`` at ``friction`` g > 0, or 0 without sliding.

    stated : whether its uncertainty is evaluated too.
    """

    solution: ContactSolution
    friction: float
    stated: bool = True

    def __call__(self, r: Array, z: float | Array, layer: int) -> tuple[Array, Array, Array]:
        """sigma_n, sigma_t at x = ``r`` >= 0, (4,) + shape of r, with the uncertainty at r, -r, (2, 4) + it.

        z : one depth, or one of each point.
        The uncertainty is the solution's own, NaN where it has none.
        """
        x = np.stack([r, -r]) if self.friction else r[None]
        full, U = self.solution.sample(Points(x, 0.0, z, layer), "stress", self.stated)
        sigma, bound = in_plane(full), in_plane(np.full_like(full, np.nan) if U is None else U)
        if not self.friction:
            return sigma[:, 0], np.zeros_like(sigma[:, 0]), np.stack([bound[:, 0]] * 2)
        right, left = sigma[:, 0], sigma[:, 1] * PARITY.reshape(4, *[1] * r.ndim)
        return (right + left) / 2, (right - left) / (2 * self.friction), np.moveaxis(bound, 1, 0)

    def uncertainty(self, bound: Array, friction: Array | float) -> Array:
        """Uncertainty of sigma_n + f sigma_t at x, (4, n), from those at x and -x, (2, 4, n).

        sigma(x) = (g + f)/2g S(x) +- (g - f)/2g S(-x), S the stress at friction g.
        """
        here = (1 + friction / self.friction) / 2 if self.friction else 1.0
        return here * bound[0] + np.abs(1 - here) * bound[1]


def in_plane(sigma: Array) -> Array:
    """xx, yy, zz, xz, (4, ...), of a stress tensor, (3, 3, ...)."""
    return np.stack([sigma[component] for component in IN_PLANE.values()])


@dataclass(frozen=True, eq=False)
class DepthLine:
    """Stress at one depth in one layer as a function of x and f.

    knots : radii [m] of the samples.   fine, coarse : sigma_n, then sigma_t over r, (8,) + shape of r, from
    all the samples and from every other one.   edge : on the surface, uncertainty of values which move with
    the contact edge, there and opposite, (2, 4).
    """

    parts: Parts
    z: float
    layer: int
    knots: Array
    fine: Curve
    coarse: Curve
    edge: Array | None = None

    def __call__(self, x: Array, friction: float) -> Array:
        """xx, yy, zz, xz [Pa] at signed ``x`` [m], (4,) + shape of ``x``."""
        return _signed(self.fine(np.abs(x)), x, friction)

    def course(self, friction: float) -> tuple[Array, Array]:
        """x [m] on both sides, ``DENSE`` points between two knots, and the stress there; the last is kept."""
        if friction not in self._courses:
            x = both_sides(self.knots, DENSE)
            self._courses.clear()
            self._courses[friction] = x, self(x, friction)
        return self._courses[friction]

    @cached_property
    def _courses(self) -> dict[float, tuple[Array, Array]]:
        return {}

    def beside(self, x: float) -> Array:
        """The knots [m] around x, whose uncertainties count there: one, or two."""
        i = int(np.clip(np.searchsorted(self.knots, abs(x)), 1, self.knots.size - 1))
        at_knot = np.isclose(abs(x), self.knots, rtol=1e-12, atol=0)
        return self.knots[at_knot if at_knot.any() else slice(i - 1, i + 1)]

    def interpolation(self, x: float, friction: float) -> Array:
        """Uncertainty [Pa] (4,) by the samples: 1/8 of the error with half of them."""
        at = np.array([x])
        fine, coarse = (_signed(curve(np.abs(at)), at, friction) for curve in (self.fine, self.coarse))
        return np.abs(fine - coarse)[:, 0] / 8


def both_sides(knots: Array, fine: int) -> Array:
    """Points from -knots[-1] to knots[-1], the trailing side first, ``fine`` between two knots."""
    r = finer(knots, fine)
    return np.concatenate([-r[:0:-1], r])


def finer(points: Array, fine: int) -> Array:
    """``points`` with each interval divided into ``fine`` equal ones."""
    inner = points[:-1, None] + np.diff(points)[:, None] * np.arange(fine) / fine
    return np.append(inner.ravel(), points[-1])


def _signed(parts: Array, x: Array, friction: float) -> Array:
    normal, tangential = parts[:4], parts[4:]
    left = x < 0
    sign = np.where(left, PARITY.reshape(4, *[1] * x.ndim), 1.0)
    return sign * (normal + friction * np.where(left, -1.0, 1.0) * tangential)


def stress_at(parts: Parts, x: Array, z: Array, layer: int, friction: float) -> Array:
    """xx, yy, zz, xz [Pa] at points (x, 0, z), (4, n)."""
    normal, tangential, _ = replace(parts, stated=False)(np.abs(x), z, layer)
    return _signed(np.concatenate([normal, tangential]), x, friction)


def outer_planes(
    parts: Parts, interfaces: Sequence[float], h: float
) -> tuple[list[DepthLine], list[DepthLine]]:
    """The planes on the upper side of each layer, and those on the lower side of each coating.

    interfaces : depths [m], from the surface down.   h : thickness of the first coating, a of a bare body.
    """
    a = float(parts.solution.contact_radius)
    tops, bases = [_surface(parts, a, h, min(a + 2 * h, 7 * a))], []
    for k, z in enumerate(interfaces):
        knots = _crowded(a, 0.5 * min(a, z), a + 2.5 * z)
        bases += _planes(parts, knots, np.array([z]), k)
        tops += _planes(parts, knots, np.array([z]), k + 1)
    return tops, bases


def inner_planes(parts: Parts, interfaces: Sequence[float], layer: int) -> tuple[list[DepthLine], Array]:
    """The planes below the top of ``layer`` and above the base of a coating, with their knots."""
    a, top = float(parts.solution.contact_radius), (0.0, *interfaces)[layer]
    if layer < len(interfaces):
        h = interfaces[layer]
        depths = _depths(top, h, 0.5 * a)[1:-1]
    else:
        h = top or a
        depths = _depths(top, 1.5 * top + 2 * a, 0.5 * max(a / 2, top))[1:]
    knots = _crowded(a, 0.5 * min(a, h), 0.5 * (a + h))
    return _planes(parts, knots, depths, layer), knots


def _crowded(a: float, width: float, reach: float) -> Array:
    """Radii [m] from 0 to a + ``reach`` as a sinh, densest at r = a, ``width``/6 apart there."""
    low, high = np.arcsinh(-a / width), np.arcsinh(reach / width)
    count = max(LEAST, int(np.ceil((high - low) / 0.16)) + 1)
    r = a + width * np.sinh(np.linspace(low, high, count))
    r[0] = 0.0
    return r


def _depths(top: float, bottom: float, width: float) -> Array:
    """Depths from ``top`` to ``bottom``, densest at the top."""
    end = np.arcsinh((bottom - top) / width)
    z = top + width * np.sinh(np.linspace(0, end, 5 + int(2 * end)))
    z[0], z[-1] = top, bottom
    return z


def _planes(parts: Parts, knots: Array, depths: Array, layer: int) -> list[DepthLine]:
    """Planes at ``depths`` > 0, sampled at ``knots``, together: those around one point share its rings."""
    r, z = np.broadcast_arrays(knots, depths[:, None])
    both = np.concatenate(replace(parts, stated=False)(r, z, layer)[:2])

    def curve(i: int, keep: NDArray[np.int_]) -> Curve:
        return _spline(knots[keep], both[:, i, keep], PARITIES)

    every, half = np.arange(knots.size), _every_other(knots.size)
    return [
        DepthLine(parts, float(at), layer, knots, curve(i, every), curve(i, half))
        for i, at in enumerate(depths)
    ]


def _surface(parts: Parts, a: float, h: float, reach: float) -> DepthLine:
    """The surface out to a + ``reach`` under a contact of radius ``a``, on a coating of thickness ``h``.

    Splines in theta = arcsin(r/a) inside, eta = arcosh(r/a) outside: the roots of the edge are smooth there.
    """
    more = 0.5 * min(a / h, 20)
    theta = np.linspace(0, np.pi / 2, int(22 + more))
    eta = np.linspace(0, np.arccosh(1 + reach / a), int(17 + more + 2 * reach / a))
    inside = theta.size
    knots = np.concatenate([a * np.sin(theta), a * np.cosh(eta[1:])])
    normal, tangential, bound = parts(around_edge(parts.solution), 0.0, 0)
    sides = np.stack([normal + g * tangential for g in (parts.friction, -parts.friction)])
    edge = edge_uncertainty(sides, bound, _change(parts))
    both = np.concatenate(replace(parts, stated=False)(knots, 0.0, 0)[:2])

    def joined(keep: Callable[[int], NDArray[np.int_]]) -> Curve:
        i, o = keep(inside), keep(eta.size)
        within = _spline(theta[i], both[:, i], PARITIES)
        beyond = _spline(eta[o], both[:, inside - 1 + o], None)

        def curve(r: Array) -> Array:
            s = r / a
            return np.where(s <= 1, within(np.arcsin(np.minimum(s, 1))), beyond(np.arccosh(np.maximum(s, 1))))

        return curve

    return DepthLine(parts, 0.0, 0, knots, joined(np.arange), joined(_every_other), edge)


def _change(parts: Parts) -> Array | None:
    """Change of the stress at x = a and -a over the coarser companions, (1, 4, 2)."""

    def at_edge(solution: Any) -> Array:
        edge = np.array([float(solution.contact_radius)])
        normal, tangential, _ = Parts(solution, parts.friction, stated=False)(edge, 0.0, 0)
        return np.stack([normal + g * tangential for g in (parts.friction, -parts.friction)])[..., 0]

    change = followed(parts.solution, at_edge)
    return None if change is None else change.T[None]


def _spline(at: Array, values: Array, parity: Array | None) -> Curve:
    """Quintic spline through ``values`` (8, n); continued across 0 by ``parity`` where given."""
    if parity is not None:
        m = min(MIRRORED, at.size - 1)
        at = np.concatenate([-at[m:0:-1], at])
        values = np.concatenate([parity[:, None] * values[:, m:0:-1], values], axis=1)
    return make_interp_spline(at, values, k=min(5, at.size - 1), axis=1)


def _every_other(n: int) -> NDArray[np.int_]:
    """Numbers of every other of n samples with both ends."""
    return np.unique(np.append(np.arange(0, n, 2), n - 1))
