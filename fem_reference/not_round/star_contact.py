"""Pressure on a contact that is star-shaped about its centre, corrected until the gap inside it vanishes.

By hand: no package solves a contact by the compliance of one meridian plane.

With the edge at r = R(tau) about the centre and s = r/R, a pressure p is corrected by moving its edge to
R (1 + c_n cos(n tau)) and by

    sqrt(1 - s^2) s^(n + 2 j) cos(n tau),   n + 2 j <= DEGREE,

until the gap  u_z + height - approach  has no product with any  (1 - s^2)^1.5 s^(n + 2 j) cos(n tau),
n + 2 j <= DEGREE + 2, inside: as many conditions as there are unknowns, once the load is given. The weight
leaves out the edge, where finite elements are too stiff. Newton's method, with the derivatives of
p = p0 sqrt(1 - s^2); elements give u_z, so the pressure found is theirs. What is left of the gap is the error
that functions of this degree do not reach.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from fem_reference.elasticity.line_quadrature import gauss_legendre
from fem_reference.not_round.harmonic_compliance import HarmonicCompliance

Pressure = Callable[[Any, Any], Any]

DEGREE = 2
RADIAL = 10  # points between two vertices of the surface
ANGULAR = 24, 1.6  # points on an arc inside the contact: some, and more for each harmonic
SAMPLES = 256  # on half a circle, between which an arc begins or ends
WAVES, LEFT_OUT = 128, 1e-12  # of the cosine series of 1/R^2; 64 leave 1e-3 of p0 at the end of a coated one
BISECTIONS = 48
STEPS, ENOUGH, CLOSE = 8, 3e-7, 1e-4  # change of the edge in the last step, and in one that failed
TOUCHING = 1e-5  # of the largest pressure on the axis of symmetry: p above counts as contact
LARGEST = 0.2  # change of the edge in one step


@dataclass(frozen=True, eq=False)
class StarPressure:
    """A ``given`` pressure with its edge moved and with smooth terms added; lengths and pressure scaled.

    centre : x of the centre, whose mirror image at -x counts too unless it is 0.  fold : of the symmetry
    contour : coefficients of 1/R^2 by cos(k tau).  edge : c_n of the ``waves``.  coefficients : of the
    ``terms``
    """

    given: Pressure
    centre: float
    fold: int
    contour: np.ndarray
    edge: np.ndarray
    coefficients: np.ndarray

    @classmethod
    def of(cls, given: Pressure, fold: int, reach: float) -> "StarPressure":
        """The ``given`` pressure itself, which is zero beyond ``reach``.

        Raises ValueError where it is zero at the origin and no single contact lies on either side.
        """
        centre, x = 0.0, np.linspace(0, reach, 2001)
        along = given(x, 0 * x)
        least = TOUCHING * float(along.max())
        if not along[0] > least:
            inside = np.flatnonzero(along > least)
            if inside.size == 0 or np.any(np.diff(inside) > 1):
                raise ValueError("the contact is neither one region around the origin nor two beside it")
            centre, fold = float(x[inside].mean()), 1
        tau = np.pi * (np.arange(4 * WAVES) + 0.5) / (4 * WAVES)
        low, high = np.zeros(tau.size), np.full(tau.size, 2 * reach)
        for _ in range(BISECTIONS):
            r = (low + high) / 2
            at = centre + r * np.cos(tau)
            loaded = (given(at, r * np.sin(tau)) > least) & ((at > 0) | (centre == 0))
            low, high = np.where(loaded, r, low), np.where(loaded, high, r)
        k = np.arange(WAVES)
        series = np.cos(k[:, None] * tau) @ low**-2 * np.where(k > 0, 2, 1) / tau.size
        contour = np.polynomial.chebyshev.chebtrim(series, LEFT_OUT * series[0])
        empty = cls(given, centre, fold, contour, np.zeros(0), np.zeros(0))
        return replace(
            empty, edge=np.zeros(len(empty.waves)), coefficients=np.zeros(len(empty.terms(DEGREE)))
        )

    @property
    def waves(self) -> tuple[int, ...]:
        return tuple(range(0, DEGREE + 3, self.fold))

    def terms(self, degree: int) -> tuple[tuple[int, int], ...]:
        """(n, j) with n + 2 j up to ``degree``."""
        return tuple((n, j) for n in range(0, degree + 1, self.fold) for j in range((degree - n) // 2 + 1))

    def polynomials(self, s: np.ndarray, tau: np.ndarray, degree: int) -> np.ndarray:
        """s^(n + 2 j) cos(n tau) of the terms, (terms,) + points."""
        return np.array([s ** (n + 2 * j) * np.cos(n * tau) for n, j in self.terms(degree)])

    def edge_at(self, tau: np.ndarray) -> np.ndarray:
        """Distance of the moved edge from the centre."""
        given = np.polynomial.chebyshev.chebval(np.cos(tau), self.contour) ** -0.5
        return given * (1 + self._shift(np.ones(tau.shape), tau))

    def _shift(self, s: np.ndarray, tau: np.ndarray) -> np.ndarray:
        """Relative change of r of the points s of the given pressure; regular at the centre."""
        total = np.zeros(s.shape)
        for n, c in zip(self.waves, self.edge, strict=True):
            total = total + c * s ** (2 if n else 0) * np.cos(n * tau)
        return total

    def __call__(self, x: Any, y: Any) -> np.ndarray:
        """p; x and y broadcast."""
        x, y = np.broadcast_arrays(np.asarray(x, dtype=float), np.asarray(y, dtype=float))
        x = (np.abs(x) if self.centre else x) - self.centre
        r, tau = np.hypot(x, y), np.arctan2(np.abs(y), x)
        s = r / self.edge_at(tau)
        r = r / (1 + self._shift(np.minimum(s, 1.0), tau))
        p = np.asarray(self.given(self.centre + r * np.cos(tau), r * np.sin(tau)), dtype=float)
        if not self.coefficients.any():
            return p
        added = np.tensordot(self.coefficients, self.polynomials(np.minimum(s, 1.0), tau, DEGREE), 1)
        return np.where(s < 1, np.maximum(p + np.sqrt(np.maximum(1 - s**2, 0)) * added, 0), 0)

    def matching(self, other: "StarPressure", x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Points as far from the edge of the ``other`` as x, y are from this; inside by shares of the way."""
        s, tau = self._polar(x, y)
        r = s * self.edge_at(tau) + np.minimum(s, 1) * (other.edge_at(tau) - self.edge_at(tau))
        sides = np.where(x < 0, -1, 1) if self.centre else 1
        return sides * (other.centre + r * np.cos(tau)), np.where(y < 0, -1, 1) * r * np.sin(tau)

    def quadrature(self, compliance: HarmonicCompliance, last: int) -> "Quadrature":
        """Points on half circles about the origin between the vertices, for harmonics to ``last``.

        By Gauss-Legendre on the arcs inside the contact, towards whose ends p falls like a square root.
        """
        vertices = compliance.nodes[:: compliance.discretisation.order]
        r, of_r = gauss_legendre(RADIAL, vertices[:-1], vertices[1:])
        theta = np.pi * np.arange(SAMPLES + 1) / SAMPLES
        inside = self._inside(r[:, None], theta) > 0
        ring, place = np.nonzero(inside[:, 1:] != inside[:, :-1])
        low, high = theta[place], theta[place + 1]
        for _ in range(BISECTIONS):
            middle = (low + high) / 2
            same = (self._inside(r[ring], middle) > 0) == inside[ring, place]
            low, high = np.where(same, middle, low), np.where(same, high, middle)
        rings = np.concatenate([ring, *(np.flatnonzero(inside[:, end]) for end in (0, -1))])
        ends = np.concatenate([low, np.zeros(inside[:, 0].sum()), np.full(inside[:, -1].sum(), np.pi)])
        order = np.lexsort((ends, rings))
        arc, (begin, end) = rings[order][::2], ends[order].reshape(-1, 2).T
        t, weight = gauss_legendre(int(ANGULAR[0] + ANGULAR[1] * last), -np.pi / 2, np.pi / 2)
        angle = (begin + end)[:, None] / 2 + (end - begin)[:, None] / 2 * np.sin(t)
        of_angle = (end - begin)[:, None] / 2 * np.cos(t) * weight
        x, y = r[arc, None] * np.cos(angle), r[arc, None] * np.sin(angle)
        weights = 2 * (of_r * r)[arc, None] * of_angle
        x, y, weights = x.ravel(), y.ravel(), weights.ravel()
        s, tau = self._polar(x, y)
        return Quadrature(r[arc], angle, np.minimum(s, 1 - 1e-14), tau, x, y, weights)

    def _inside(self, r: np.ndarray, theta: np.ndarray) -> np.ndarray:
        """Positive inside the contact."""
        return 1 - self._polar(r * np.cos(theta), r * np.sin(theta))[0]

    def _polar(self, x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """s and tau."""
        x = (np.abs(x) if self.centre else x) - self.centre
        tau = np.arctan2(np.abs(y), x)
        return np.hypot(x, y) / self.edge_at(tau), tau

    @property
    def area(self) -> float:
        tau = np.pi * (np.arange(720) + 0.5) / 720
        return float(np.pi * np.mean(self.edge_at(tau) ** 2) * (2 if self.centre else 1))

    @property
    def _contour(self) -> tuple[np.ndarray, np.ndarray]:
        """x and y along the edge, from the end on x > 0."""
        tau = np.linspace(0, np.pi, 1441)
        R = self.edge_at(tau)
        return self.centre + R * np.cos(tau), R * np.sin(tau)

    @property
    def reach(self) -> tuple[float, float]:
        """Least and largest distance of the contact from the origin."""
        distance = np.hypot(*self._contour)
        return float(distance.min()) if self.centre else 0.0, float(distance.max())

    def scaled(self, length: float, pressure: float) -> "StarPressure":
        """The same, not corrected yet, in these units."""

        def given(x: Any, y: Any) -> np.ndarray:
            return np.asarray(self.given(np.asarray(x) * length, np.asarray(y) * length)) / pressure

        return replace(self, given=given, centre=self.centre / length, contour=self.contour * length**2)

    @property
    def edges(self) -> tuple[float, ...]:
        """x at which the edge crosses the axis y = 0."""
        ahead, behind = self.edge_at(np.array([0.0, np.pi]))
        x = (self.centre + ahead, self.centre - behind)
        return (*x, -x[0], -x[1]) if self.centre else x

    def end_angle(self, depth: float) -> float:
        """Half of the angle about the origin that the contact fills at a ``depth`` inside its end on x > 0.

        Pi where it reaches no farther there than to the sides.
        """
        x, y = self._contour
        ended = np.flatnonzero(np.hypot(x, y) < x[0] - depth)
        return float(np.arctan2(y, x)[ended[0]]) if ended.size else np.pi

    @property
    def peak(self) -> float:
        """Largest pressure, between the points of a grid by a parabola in each direction."""
        s, tau = np.linspace(0, 0.99, 100), np.pi * np.arange(61) / 60
        R = self.edge_at(tau)
        x, y = self.centre + np.outer(s, R * np.cos(tau)), np.outer(s, R * np.sin(tau))
        p = self(x, y)
        i, j = np.unravel_index(int(p.argmax()), p.shape)
        # refined around the highest point, whose place matters to second order alone
        size = 0.02 * float(R[j])
        for _ in range(4):
            offset = size * np.linspace(-1, 1, 9)
            X, Y = x[i, j] + offset[:, None], y[i, j] + offset[None, :]
            x, y = np.broadcast_arrays(X, Y)
            p = self(x, y)
            i, j = np.unravel_index(int(p.argmax()), p.shape)
            size /= 4
        return float(p[i, j])

    @property
    def extents(self) -> tuple[float, float]:
        """Largest x and y of the contact."""
        x, y = self._contour
        return float(x.max()), float(y.max())


@dataclass(frozen=True, eq=False)
class Quadrature:
    """Points on arcs of radius r (arcs,) at angles theta (arcs, points); s, tau, x, y and ``weights`` of them
    all, of integrals over the whole contact."""

    r: np.ndarray
    theta: np.ndarray
    s: np.ndarray
    tau: np.ndarray
    x: np.ndarray
    y: np.ndarray
    weights: np.ndarray


@dataclass(frozen=True, eq=False)
class Corrected:
    """A pressure under which the gap vanishes, with its approach, and the compliance it was found with."""

    compliance: HarmonicCompliance
    pressure: StarPressure
    approach: float
    steps: int
    converged: bool

    @cached_property
    def nodal_loads(self) -> np.ndarray:
        """Products of the pressure with the shape functions, (harmonics, nodes)."""
        at, forces = self._forces
        each = forces.reshape(1, *at.theta.shape)
        return self.compliance.nodal_loads(at.r, at.theta, each, self.compliance.last)[..., 0]

    def residual(self, height: Pressure) -> float:
        """Root mean square of the gap left inside, weighted with the pressure, over the approach."""
        at, forces = self._forces
        deflection = self.compliance.deflection(self.nodal_loads, at.r, at.theta).ravel()
        gap = deflection + height(at.x, at.y) - self.approach
        return float(np.sqrt((forces * gap**2).sum() / forces.sum()) / self.approach)

    @cached_property
    def _forces(self) -> tuple[Quadrature, np.ndarray]:
        at = self.pressure.quadrature(self.compliance, self.compliance.last)
        return at, at.weights * self.pressure(at.x, at.y)


def corrected(
    compliance: HarmonicCompliance, given: StarPressure, height: Pressure, load: float, last: int
) -> Corrected:
    """Pressure under which the gap below an indenter of ``height`` (x, y) vanishes; scaled units.

    last : harmonic at which the compliance is cut off, since the corrections are smooth
    """
    matrices = compliance.matrices[: last // compliance.fold + 1]
    pressure = given
    for step in range(STEPS + 1):
        at = pressure.quadrature(compliance, last)
        p = pressure(at.x, at.y)
        root = np.sqrt(1 - at.s**2)
        smooth = root * pressure.polynomials(at.s, at.tau, DEGREE)
        singular = float((at.weights * p).sum() / (at.weights * root).sum()) / root
        moved = np.array([singular * at.s ** (4 if n else 2) * np.cos(n * at.tau) for n in pressure.waves])
        tests = root**3 * pressure.polynomials(at.s, at.tau, DEGREE + 2)
        forces = np.concatenate([[p], smooth, moved, tests]) * at.weights
        k = 1 + len(smooth) + len(moved)
        L = compliance.nodal_loads(at.r, at.theta, forces.reshape(-1, *at.theta.shape), last)
        known = height(at.x, at.y)
        total = forces.sum(axis=1)
        work = np.einsum("mit,mic->tc", L[:, :, k:], matrices @ L[:, :, :k])
        A = np.zeros((len(tests) + 1, k))
        A[:-1, :-1], A[:-1, -1], A[-1, :-1] = work[:, 1:], -total[k:], total[1:k]
        b = np.append(-work[:, 0] - forces[k:] @ known, load - total[0])
        rows = np.abs(A).max(axis=1)
        columns = np.abs(A / rows[:, None]).max(axis=0)
        x = np.linalg.lstsq(A / rows[:, None] / columns, b / rows, rcond=1e-12)[0] / columns
        n = len(smooth)
        size = float(np.abs(x[n:-1]).max())
        if size < ENOUGH or step == STEPS:
            break
        share = min(1.0, LARGEST / size)
        pressure = replace(
            pressure, coefficients=pressure.coefficients + share * x[:n], edge=pressure.edge + share * x[n:-1]
        )
    return Corrected(compliance, pressure, float(x[-1]), step, size < CLOSE)
