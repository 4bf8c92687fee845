"""An axisymmetric contact pressure given by its Abel potential phi on 0 <= t <= a.

    p(r) = -int_r^a phi'(t) / sqrt(t^2 - r^2) dt,    phi(a) = 0
    phat(k) = int_0^a p(r) J0(kr) r dr = int_0^a phi(t) cos(kt) dt,    W = 2 pi int_0^a phi dt

phi is a sum of even Legendre polynomials, so that every integral below is exact to rounding.
Hertz: phi = p0 (a^2 - t^2)/(2a). Sneddon, Int. J. Engng Sci. 3 (1965) 47-57.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import ArrayLike
from scipy.optimize import minimize_scalar

from verification.problem.array_types import Array
from verification.problem.gauss_legendre import gauss_legendre

NEAR_AXIS = 0.1  # of a
BESSELS = 16_000_000  # spherical Bessel functions held in memory at once


@dataclass(frozen=True, eq=False)
class AbelPressure:
    """phi(t) = sum_n c[n] P_2n(t/a) [N/m]; ``a`` [m]."""

    a: float
    c: Array

    @classmethod
    def from_nodes(cls, a: float, s: Array, weight: Array, phi: Array) -> "AbelPressure":
        """From values at Gauss-Legendre nodes ``s`` = t/a on [0, 1] with their ``weight``."""
        n = np.arange(s.size)
        P = legendre.legvander(s, 2 * s.size - 2)[:, ::2]
        c = (4 * n + 1) * (P.T @ (weight * phi))
        # Coefficients fall geometrically down to the rounding of phi; what is left there is noise.
        noise = 8 * np.finfo(float).eps * (4 * n + 1) * np.abs(phi).max()
        return cls(a, c[: 1 + np.flatnonzero(np.abs(c) > noise).max()])

    @property
    def load(self) -> float:
        """W = 2 pi int_0^a phi dt [N]: only P_0 has a mean."""
        return float(2 * np.pi * self.a * self.c[0])

    @property
    def edge_slope(self) -> float:
        """-phi'(a) [Pa]: p -> -phi'(a) sqrt(2 (1 - r/a)) at the edge; P_2n'(1) = n (2n + 1)."""
        n = np.arange(self.c.size)
        return float(-(self.c @ (n * (2 * n + 1))) / self.a)

    @cached_property
    def peak(self) -> float:
        """Largest p [Pa]: at r = 0, but on a ring where a stiff film on a soft solid bends like a plate."""
        # r = a sin(theta): a thin film bends over its own thickness, next to the contact edge; the potential
        # has less than one extremum a coefficient there
        theta = np.pi / 2 * np.linspace(0, 1, min(16 * self.c.size, 1600) + 1)
        p = self.pressure(self.a * np.sin(theta))
        best = int(p.argmax())
        if best == 0:
            return float(p[0])
        found = minimize_scalar(
            lambda angle: -float(self.pressure(self.a * np.sin(angle))),
            bounds=(theta[best - 1], theta[min(best + 1, theta.size - 1)]),
            method="bounded",
            options={"xatol": 1e-8},
        )
        return float(max(-found.fun, p[best]))

    def pressure(self, r: ArrayLike) -> Array:
        """p(r) [Pa], 0 outside; shape of ``r``.

        P_2n(t/a) is the potential of P_2n(u) / (P_2n(0) u a), u^2 = 1 - (r/a)^2: both have the transform
        (-1)^n j_2n(ka). Since phi(a) = sum c_n = 0, the recurrence of P_2n divides the sum by u:

            p = sum_n>=1 (4n - 1) C_n P_2n-1(u) / (2n P_2n(0) a),   C_n = c_n + c_n+1 + ...
        """
        r = np.asarray(r, dtype=float)
        u = np.sqrt(np.maximum((self.a - r) * (self.a + r), 0.0)) / self.a
        n = np.arange(1, self.c.size)
        at_zero = np.cumprod(1 / (2 * n) - 1)  # P_2n(0)
        tails = np.cumsum(self.c[:0:-1])[::-1]
        odd = np.zeros(2 * self.c.size - 2)
        odd[1::2] = (4 * n - 1) * tails / (2 * n * at_zero * self.a)
        return np.asarray(legendre.legval(u, odd))

    def resultant(self, r: ArrayLike) -> Array:
        """int_0^r p(s) s ds [N/rad], the load inside ``r`` over 2 pi; shape of ``r``.

        Next to the axis by quadrature, to be exact over r^2 too, otherwise W less the ring outside.
        """
        r = np.asarray(r, dtype=float)
        x, weight = gauss_legendre(16)
        t = 0.5 * (1 + x)
        near = np.minimum(r, NEAR_AXIS * self.a)
        inside = 0.5 * near**2 * (self.pressure(near[..., None] * t) * t @ weight)
        return np.where(r > near, self.load / (2 * np.pi) - self._load_outside(r), inside)

    def transform(self, k: Array) -> Array:
        """phat(k) [N]: int_0^1 P_2n(s) cos(ks) ds = (-1)^n j_2n(k)."""
        signed = self.a * self.c * (-1.0) ** np.arange(self.c.size)
        parts = np.array_split(k * self.a, max(1, k.size * self.c.size // BESSELS))
        return np.concatenate([signed @ _even_spherical_bessel(self.c.size, part) for part in parts])

    def sink(self, r: Array) -> Array:
        """E* u_z [N/m] on the surface of the homogeneous solid, 2 int phat(k) J0(kr) dk; shape of ``r``."""
        return 2 * self.over_circle(0, r)

    def over_circle(self, order: int, r: Array) -> Array:
        """int_0^inf phat(k) J_order(kr) dk [N/m] for even ``order``; shape of ``r``.

        = int_0^min(r,a) phi(t) cos(order asin(t/r)) / sqrt(r^2 - t^2) dt, with t = r sin(psi).
        """
        psi, weight, t = self._inside(r)
        phi = legendre.legval(np.minimum(t / self.a, 1.0), self._even)
        return (phi * np.cos(order * psi) * weight).sum(axis=-1)

    def bessel_integral(self, order: int, r: Array) -> Array:
        """int_0^inf phat(k) J_order(kr) k dk [Pa] for odd ``order``; shape of ``r``.

        = -int_0^min(r,a) phi'(t) sin(order asin(t/r)) / sqrt(r^2 - t^2) dt, with t = r sin(psi).
        """
        psi, weight, t = self._inside(r)
        return -(self._slope_over_t(t) * t * np.sin(order * psi) * weight).sum(axis=-1)

    def _inside(self, r: Array) -> tuple[Array, Array, Array]:
        """psi = asin(t/r), its weight, t of a quadrature over 0 < t < min(r, a) at each of ``r``."""
        psi_max = np.arcsin(np.minimum(self.a / np.maximum(r, 1e-300), 1.0))[..., None]
        x, weight = gauss_legendre(max(64, 2 * self.c.size))
        psi = 0.5 * psi_max * (1 + x)
        return psi, 0.5 * psi_max * weight, r[..., None] * np.sin(psi)

    @property
    def _even(self) -> Array:
        """Coefficients of all Legendre polynomials, those of odd order 0."""
        coefficients = np.zeros(2 * self.c.size - 1)
        coefficients[::2] = self.c
        return coefficients

    def _load_outside(self, r: Array) -> Array:
        """-int_r^a phi'(t) sqrt(t^2 - r^2) dt [N/rad], with s^2 = t^2 - r^2."""
        reach = np.sqrt(np.maximum(self.a**2 - r**2, 0.0))
        x, weight = gauss_legendre(max(64, 2 * self.c.size))
        s = 0.5 * reach[..., None] * (1 + x)
        t = np.minimum(np.hypot(r[..., None], s), self.a)
        return -0.5 * reach * ((self._slope_over_t(t) * s**2) @ weight)

    def _slope_over_t(self, t: Array) -> Array:
        """phi'(t)/t, an even polynomial."""
        slope = legendre.legder(self._even)
        s = t / self.a
        # At t = 0 the quotient is phi''(0).
        small = s < 1e-6
        safe = np.where(small, 1.0, s)
        curvature = legendre.legval(0.0, legendre.legder(slope)) if slope.size > 1 else 0.0
        return np.where(small, curvature, legendre.legval(safe, slope) / safe) / self.a**2


def _even_spherical_bessel(count: int, x: Array) -> Array:
    """j_0, j_2, ... j_2(count-1) of ``x`` > 0, shape (count,) + x.shape; all orders from one recurrence.

    j_{n+1} = (2n+1)/x j_n - j_{n-1}, upwards where x exceeds every order, downwards (Miller) elsewhere.
    """
    top = 2 * count
    found = np.empty((count, *x.shape))
    up = x > top
    far = x[up]
    below, here = np.sin(far) / far, np.sin(far) / far**2 - np.cos(far) / far
    for n in range(top):
        if n % 2 == 0:
            found[n // 2][up] = below
        below, here = here, (2 * n + 3) / far * here - below
    near = np.maximum(x[~up], 1e-8)
    above, here = np.zeros_like(near), np.full_like(near, 1e-280)
    scratch = np.zeros((count, near.size))
    # 40 orders above the largest argument the start value has no effect beyond rounding.
    for n in range(top + 40, -1, -1):
        if n % 2 == 0 and n < top:
            scratch[n // 2] = here
        if n:
            above, here = here, (2 * n + 1) / near * here - above
            large = np.abs(here) > 1e200
            above[large], here[large] = above[large] * 1e-250, here[large] * 1e-250
            scratch[:, large] *= 1e-250
    # j_0 vanishes at multiples of pi, where j_1 does not: normalise by whichever is larger.
    j0 = np.sin(near) / near
    j1 = np.where(near > 1e-3, np.sin(near) / near**2 - np.cos(near) / near, near / 3)
    even = np.abs(j0) >= np.abs(j1)
    found[:, ~up] = scratch * (np.where(even, j0, j1) / np.where(even, here, above))
    return found
