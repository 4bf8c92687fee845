"""Response of the surfaces in contact to pressure: one compliance of both bodies.

The surfaces approach each other by u_z of both bodies,

    u(k) = 2/(E* k) M(k) p(k),    M = E* sum M_i/E_i*,    1/E* = sum 1/E_i*,

with M_i the compliance of each body over that of its first material, of modulus E_i*. Smooth over log k at
any ratio of moduli, M is sampled once for a solve. Its long range and the Hankel transform of the rest,

    M = 1 + c e^(-b k) + R(k),    g(r) = int_0^inf R(k) J0(kr) dk,

serve the patches of all grids: a second coated body costs next to nothing.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.fft import fht, fhtoffset
from scipy.interpolate import CubicSpline, PPoly, make_interp_spline

from semianalytic import numbers
from semianalytic.coefficients import frf

Array = NDArray[np.floating]
Function = Callable[[Array], Array]
Layers = tuple[float, dict[str, Any]]


def response(bodies: Sequence[Layers]) -> "Response":
    """The response of ``bodies``, at least one: E*/E_i* and the layers of each, as keywords of `frf`."""
    thickness = [[h for _, _, h in layers["coatings"]] for _, layers in bodies]
    first, total = min(h[0] for h in thickness), max(sum(h) for h in thickness)
    x = np.linspace(np.log(1e-10 / total), np.log(40 / first), numbers.COMPLIANCE_SAMPLES)
    samples = sum(share * frf.compliance_excess(np.exp(x), **layers) for share, layers in bodies)
    spline = PPoly.from_spline(make_interp_spline(x, samples, k=5))
    low, high = np.exp(x[[0, -1]])

    def excess(k: Array) -> Array:
        k = np.asarray(k, dtype=float)
        value: Array = spline(np.log(np.clip(k, low, high)))
        return np.where(k < high, value, 0.0)

    return Response(excess, first, total)


@dataclass(frozen=True, eq=False)
class Response:
    """Compliance of coated surfaces.

    excess : M(k) - 1, k [rad/m].  first : thickness of the first coating, of two bodies the thinner one [m].
    total : of all coatings of a body, of two the larger [m].
    """

    excess: Function
    first: float
    total: float

    @cached_property
    def depth(self) -> float:
        """Depth [m] of the first interface that matters: exp(-2 k h) is rounding where the response ends.

        The thickness of the first coating where the next material differs; a coating divided into equal parts
        reflects at the bottom of the last one only. Far below the coatings without a reflection.
        """
        k = np.geomspace(1e-2 / self.total, 40 / self.first, 4000)
        felt = np.flatnonzero(np.abs(self.excess(k)) > numbers.NEGLIGIBLE)
        return 14.0 / float(k[felt[-1] if felt.size else 0])

    @cached_property
    def image(self) -> tuple[float, float]:
        """Strength c [-] and depth b [m] of the image c exp(-b k) that removes the long range of M(k) - 1.

        c = M(0) - 1,    b = ln 2 / (wavenumber at which half of c is left), but not above the image
                                      of the surface in the first interface, 2 h1
        """
        k = np.geomspace(1e-8 / self.total, 40 / self.first, 4000)
        M = self.excess(k)
        c = float(M[0])
        left = np.abs(M) < 0.5 * abs(c)
        if abs(c) < 1e-12 or not left.any():
            return c, 2 * self.total
        return c, max(float(np.log(2) / k[np.argmax(left)]), 2 * self.first)

    def unseen_edge(self, d: float) -> float:
        """Distance [m] by which patches of side ``d`` [m] may misplace a smooth edge of a contact.

        Near the edge, a half-line, the factor of Wiener and Hopf of M(k)/M(k0) is 1 + i k s at small k: what
        is shorter than seen moves the root of the pressure by s. By the integral of the factor (A. D.
        Polyanin, A. V. Manzhirov, Handbook of Integral Equations (1998), section 11.10-3, eq. 44), of waves
        shorter than 2 pi d, k0 = 1/d, with the magnitude:

            s = 1/pi int_k0^inf |ln(M(k)/M(k0))| / k^2 dk
        """
        k = np.geomspace(1.0, 2 + 40 * d / self.first, numbers.COMPLIANCE_SAMPLES) / d
        M = np.maximum(1 + self.excess(k), np.finfo(float).tiny)
        G = np.abs(np.log(M / M[0]))
        return float(np.trapezoid(G / k, np.log(k)) + G[-1] / k[-1]) / np.pi

    def radial(self, points: int) -> tuple[Function, Function]:
        """g(r) and int_0^r g r dr by a logarithmic Hankel grid of as many ``points``."""
        if points not in self._radial:
            self._radial[points] = self._transformed(points)
        return self._radial[points]

    @cached_property
    def _radial(self) -> dict[int, tuple[Function, Function]]:
        return {}

    def _transformed(self, points: int) -> tuple[Function, Function]:
        """Moments of R to a tenth of a coating, the Hankel grid beyond."""
        c, b = self.image
        h = self.first  # M - 1 decays as exp(-2 k h): deeper layers give smoother terms
        low, high = 1e-7 / max(b, self.total), 1e4 / h
        k = np.geomspace(low, high, points)
        step = np.log(k[1] / k[0])
        R = self.excess(k) - c * np.exp(-b * k)
        offset = fhtoffset(step, mu=0)
        A = fht(R, step, mu=0, offset=offset)
        r = np.exp(offset) / k[::-1]
        m0, m1, m2, m3 = (float(np.sum(R * k ** (2 * j + 1)) * step) for j in range(4))
        # the transform is periodic in log r: one period below, g is m0
        A -= m0 * np.exp(-points * step) * r
        near = 0.1 * h
        far = 1e6 * max(b, self.total)
        keep = (r > 0.5 * near) & (r < far)
        x = np.log(r[keep])
        spline = CubicSpline(x, A[keep] / r[keep])
        inner = CubicSpline(x, A[keep] * r[keep]).antiderivative()

        def g(r: Array) -> Array:
            s = (r / 2) ** 2
            small = m0 - s * (m1 - s * (m2 / 4 - s * m3 / 36))
            large = np.where(r < far, spline(np.log(np.clip(r, near, far))), 0.0)
            return np.where(r < near, small, large)

        def on_disc(r: Array) -> Array:
            s = (np.minimum(r, near) / 2) ** 2
            small = 2 * s * (m0 - s * (m1 / 2 - s * (m2 / 12 - s * m3 / 144)))
            return small + inner(np.log(np.clip(r, near, far))) - inner(np.log(near))

        return g, on_disc
