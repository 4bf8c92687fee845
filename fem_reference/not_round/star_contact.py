"""Contour and pressure of a contact that is star-shaped about its centre.

In the plane stretched by the half axes A_x, A_y of the contact,  X = (x - centre)/A_x,  Y = y/A_y,  with the
polar coordinates w R(tau), tau, in which w = 1 is the edge,

    R(tau) = 1 + sum_n c_n cos(n tau),   s = w R(tau) / (1 + sum_n c_n w^n cos(n tau)),
    p = sqrt(1 - s^2) sum_nj b_nj s^n T_j(2 s^2 - 1) cos(n tau),   n + 2 j <= degree.

The powers w^n make s a smooth coordinate at the centre, where that of R alone has no second derivative. Of an
ellipse all c_n vanish, and p is a polynomial in X and Y times the root of Hertz's pressure.
"""

from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import Any

import numpy as np
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk

from fem_reference import element_numbers as chosen
from fem_reference.elasticity.line_quadrature import gauss_legendre

_of_angle = lru_cache(gauss_legendre)


def hertz_axes(curvatures: tuple[float, float], load: float, compliance: float) -> tuple[float, float]:
    """Half axes along x and y of the contact of bare bodies; K. L. Johnson, Contact Mechanics, section 4.2.

    curvatures : of the gap along x and y [1/m].   compliance : 1/E* of both bodies together
    """
    low, high = sorted(curvatures)
    if high - low < 1e-9 * high:
        a = (0.75 * load * compliance / high) ** (1 / 3)
        return a, a

    def ratio(q: float) -> float:
        # of the curvatures across and along an ellipse a : b = exp(q)
        m = -np.expm1(-2 * q)
        return float((np.exp(2 * q) * ellipe(m) - ellipk(m)) / (ellipk(m) - ellipe(m)))

    q = brentq(lambda q: ratio(q) - high / low, 1e-6, np.log(high / low) + 1.0, xtol=1e-12)
    m = -np.expm1(-2 * q)
    along = (3 * load * compliance * (ellipk(m) - ellipe(m)) / (np.pi * m * low)) ** (1 / 3)
    axes = float(along), float(along * np.exp(-q))
    return axes if curvatures[0] <= curvatures[1] else axes[::-1]


@dataclass(frozen=True, eq=False)
class StarPressure:
    """Pressure on a star-shaped contact, or on two that are mirror images of each other.

    centre : x of the centre, whose mirror image at -x counts too unless it is 0.  axes : A_x, A_y
    fold : n of the symmetry by turns of 2 pi/n.  contour : c_n of the ``waves``.  coefficients : b of the
    ``terms``
    """

    centre: float
    axes: tuple[float, float]
    fold: int
    degree: int
    contour: np.ndarray
    coefficients: np.ndarray

    @classmethod
    def of_ellipse(
        cls, centre: float, axes: tuple[float, float], load: float, fold: int, degree: int
    ) -> "StarPressure":
        """Hertz's pressure under ``load`` on an ellipse."""
        empty = cls(centre, axes, fold, degree, np.zeros(0), np.zeros(0))
        b = np.zeros(len(empty.terms(degree)))
        b[0] = 1.5 * load / (np.pi * axes[0] * axes[1]) / (2 if centre else 1)
        return replace(empty, contour=np.zeros(len(empty.waves)), coefficients=b)

    @cached_property
    def waves(self) -> tuple[int, ...]:
        """n of the contour."""
        return tuple(range(0, self.degree + 1, self.fold))

    def terms(self, degree: int) -> tuple[tuple[int, int], ...]:
        """(n, j) with n + 2 j up to ``degree``."""
        return tuple((n, j) for n in range(0, degree + 1, self.fold) for j in range((degree - n) // 2 + 1))

    def polynomials(self, s: np.ndarray, tau: np.ndarray, degree: int) -> np.ndarray:
        """s^n T_j(2 s^2 - 1) cos(n tau) of the terms, (terms,) + points."""
        T = np.polynomial.chebyshev.chebvander(2 * s**2 - 1, degree // 2)
        turn = (s * np.exp(1j * tau)) ** self.fold
        waves = np.polynomial.polynomial.polyvander(turn, degree // self.fold).real
        return np.array([waves[..., n // self.fold] * T[..., j] for n, j in self.terms(degree)])

    @property
    def radial_slope(self) -> np.ndarray:
        """Coefficients of s d/ds of the polynomial in the pressure, of the same terms.

        s dT_j/ds = 2 j (T_j + 2 T_(j-1) + .. + 2 T_1 + T_0)
        """
        n, j = np.array(self.terms(self.degree)).T
        found, steeper = n * self.coefficients, 4 * j * self.coefficients
        for wave in self.waves:
            of_wave = np.flatnonzero(n == wave)
            rising = np.cumsum(steeper[of_wave[::-1]])[::-1] - steeper[of_wave] / 2
            found[of_wave] += np.where(j[of_wave] > 0, rising, rising / 2)
        return found

    def _wave(self, at: np.ndarray) -> np.ndarray:
        """sum_n c_n Re at^n."""
        return np.asarray(np.polynomial.polynomial.polyval(at**self.fold, self.contour).real)

    def edge_at(self, tau: np.ndarray) -> np.ndarray:
        """R(tau), in the stretched plane."""
        return 1 + self._wave(np.exp(1j * tau))

    def polar(self, x: Any, y: Any) -> tuple[np.ndarray, np.ndarray]:
        """w, tau of points; w = 1 is the edge."""
        x, y = np.broadcast_arrays(np.asarray(x, dtype=float), np.asarray(y, dtype=float))
        X, Y = ((np.abs(x) if self.centre else x) - self.centre) / self.axes[0], np.abs(y) / self.axes[1]
        tau = np.arctan2(Y, X)
        return np.hypot(X, Y) / self.edge_at(tau), tau

    def points(self, w: np.ndarray, tau: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """x and y of w, tau, of the contact on x > 0 where there are two."""
        r = w * self.edge_at(tau)
        return self.centre + self.axes[0] * r * np.cos(tau), self.axes[1] * r * np.sin(tau)

    def smooth(self, w: np.ndarray, tau: np.ndarray) -> np.ndarray:
        """The coordinate s of w, tau."""
        turn = np.exp(1j * tau)
        return np.asarray(w * (1 + self._wave(turn)) / (1 + self._wave(w * turn)))

    def __call__(self, x: Any, y: Any) -> np.ndarray:
        """p; x and y broadcast."""
        w, tau = self.polar(x, y)
        inside = w < 1
        p = np.zeros(w.shape)
        s = np.minimum(self.smooth(w[inside], tau[inside]), 1)
        p[inside] = np.sqrt(1 - s**2) * np.tensordot(
            self.coefficients, self.polynomials(s, tau[inside], self.degree), 1
        )
        return p

    def moved(self, c: np.ndarray, coefficients: np.ndarray) -> "StarPressure":
        """With the edge moved by c_n of the waves, those of an ellipse as centre and axes."""
        by = dict(zip(self.waves, c, strict=True))
        zero, one, two = (by.get(n, 0.0) for n in (0, 1, 2))
        axes = self.axes[0] * (1 + zero + two), self.axes[1] * (1 + zero - two)
        rest = self.contour + np.where(np.array(self.waves) > 2, c, 0.0)
        return replace(
            self, centre=self.centre + self.axes[0] * one, axes=axes, contour=rest, coefficients=coefficients
        )

    def of_degree(self, degree: int) -> "StarPressure":
        """Pressure as a polynomial of another degree; terms beyond it are left out."""
        known = dict(zip(self.terms(self.degree), self.coefficients, strict=True))
        c, empty = dict(zip(self.waves, self.contour, strict=True)), replace(self, degree=degree)
        b = np.array([known.get(one, 0.0) for one in self.terms(degree)])
        return replace(empty, contour=np.array([c.get(n, 0.0) for n in empty.waves]), coefficients=b)

    def scaled(self, length: float) -> "StarPressure":
        """Pressure with lengths in units of ``length``."""
        axes = self.axes[0] / length, self.axes[1] / length
        return replace(self, centre=self.centre / length, axes=axes)

    def matching(self, other: "StarPressure", x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Points as far from the edge of the ``other`` as x, y are from this; inside by shares of the way."""
        w, tau = self.polar(x, y)
        at, edge, other_edge = (
            np.array(one.points(v, tau)) for one, v in ((self, w), (self, 1 + 0 * w), (other, 1 + 0 * w))
        )
        X, Y = np.where(w < 1, np.array(other.points(np.minimum(w, 1), tau)), at + other_edge - edge)
        return np.where((x < 0) & (self.centre != 0), -1, 1) * X, np.where(y < 0, -1, 1) * Y

    def quadrature(self, vertices: np.ndarray, last: int, fold: int) -> list["Quadrature"]:
        """Points on arcs about the origin between the ``vertices``, for harmonics 0, fold, .. to ``last``.

        By Gauss-Legendre on the arcs inside the contact, towards whose ends p falls like a square root, in
        half of one of the ``fold`` turns that leave p as it is. Those of similar length are together.
        """
        r, of_r = gauss_legendre(chosen.RADIAL, vertices[:-1], vertices[1:])
        theta = np.linspace(0, np.pi / fold, chosen.ARC_SAMPLES // fold + 1)

        def within(r: np.ndarray, theta: np.ndarray) -> np.ndarray:
            return self.polar(r * np.cos(theta), r * np.sin(theta))[0] < 1

        inside = within(r[:, None], theta)
        ring, place = np.nonzero(inside[:, 1:] != inside[:, :-1])
        low, high = theta[place], theta[place + 1]
        for _ in range(np.finfo(float).nmant):  # to rounding
            middle = (low + high) / 2
            same = within(r[ring], middle) == inside[ring, place]
            low, high = np.where(same, middle, low), np.where(same, high, middle)
        rings = np.concatenate([ring, *(np.flatnonzero(inside[:, end]) for end in (0, -1))])
        ends = np.concatenate([low, np.zeros(inside[:, 0].sum()), np.full(inside[:, -1].sum(), theta[-1])])
        order = np.lexsort((ends, rings))
        begin, end = ends[order].reshape(-1, 2).T
        by_length = np.argsort(end - begin)
        batches = []
        for some in np.split(
            by_length, range(chosen.COLUMNS_AT_ONCE, by_length.size, chosen.COLUMNS_AT_ONCE)
        ):
            middle, half = (end + begin)[some, None] / 2, (end - begin)[some, None] / 2
            waves = chosen.ANGULAR[1] * last * 2 * float(half.max(initial=0.0)) / np.pi
            # a multiple of the least number, so that few rules are made
            count = chosen.ANGULAR[0] * (1 + int(np.ceil(waves / chosen.ANGULAR[0])))
            t, weight = _of_angle(count, -np.pi / 2, np.pi / 2)
            arc = rings[order][::2][some]
            angle = middle + half * np.sin(t)
            weights = 2 * fold * (of_r * r)[arc, None] * half * np.cos(t) * weight
            x, y = r[arc, None] * np.cos(angle), r[arc, None] * np.sin(angle)
            w, tau = self.polar(x, y)
            s = np.minimum(self.smooth(np.minimum(w, 1 - 1e-14), tau), 1 - 1e-14)
            batches.append(Quadrature(r[arc], angle, s, tau, x, y, weights))
        return batches

    @property
    def contour_points(self) -> tuple[np.ndarray, np.ndarray]:
        """x and y along the edge, from the end on x > 0."""
        tau = np.linspace(0, np.pi, 1441)
        return self.points(np.ones(tau.size), tau)

    @property
    def area(self) -> float:
        tau = np.pi * (np.arange(720) + 0.5) / 720
        return float(np.pi * np.prod(self.axes) * np.mean(self.edge_at(tau) ** 2) * (2 if self.centre else 1))

    @property
    def reach(self) -> tuple[float, float]:
        """Least and largest distance of the contact from the origin."""
        distance = np.hypot(*self.contour_points)
        return float(distance.min()) if self.centre else 0.0, float(distance.max())

    @property
    def edges(self) -> tuple[float, ...]:
        """x at which the edge crosses the axis y = 0."""
        x = self.contour_points[0][[0, -1]].tolist()
        return (*x, -x[0], -x[1]) if self.centre else tuple(x)

    def end_angle(self, depth: float) -> float:
        """Half of the angle about the origin that the contact fills at a ``depth`` inside its end on x > 0.

        Pi where it reaches no farther there than to the sides.
        """
        x, y = self.contour_points
        ended = np.flatnonzero(np.hypot(x, y) < x[0] - depth)
        return float(np.arctan2(y, x)[ended[0]]) if ended.size else np.pi

    @property
    def peak(self) -> float:
        """Largest pressure, on grids that close in on it: its place matters to second order alone."""
        tau, w = np.meshgrid(np.pi * np.arange(61) / 60, np.linspace(0, 0.99, 100))
        x, y = self.points(w, tau)
        size, offset = 0.02 * min(self.axes), np.linspace(-1, 1, 9)
        for _ in range(5):
            p = self(x, y)
            at = np.unravel_index(int(p.argmax()), p.shape)
            x, y = np.broadcast_arrays(x[at] + size * offset[:, None], y[at] + size * offset)
            size /= 4
        return float(p.max())

    @property
    def extents(self) -> tuple[float, float]:
        """Largest x and y of the contact."""
        x, y = self.contour_points
        return float(x.max()), float(y.max())


@dataclass(frozen=True, eq=False)
class Quadrature:
    """Points on arcs of radius r (arcs,) at angles theta (arcs, points), their s, tau, x and y.

    weights : of integrals over the whole contact
    """

    r: np.ndarray
    theta: np.ndarray
    s: np.ndarray
    tau: np.ndarray
    x: np.ndarray
    y: np.ndarray
    weights: np.ndarray
