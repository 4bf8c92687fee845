"""Hertz's elliptical contact of homogeneous solids, in closed form.

    p = p0 sqrt(1 - (x/a)^2 - (y/b)^2),   a >= b,   e^2 = 1 - b^2/a^2,
    height = A x^2 + B y^2,   A = p0 b/(E* e^2 a^2) (K - E),   B = p0 b/(E* e^2 a^2) (a^2/b^2 E - K),
    approach = p0 b K/E*,     load = 2 pi a b p0/3,

K and E the complete elliptic integrals of modulus e. K. L. Johnson, Contact Mechanics, 1985, section 4.2.
"""

from dataclasses import dataclass
from math import exp, log, pi

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk

from verification.problem.array_types import Array
from verification.problem.coated_contact import Uncertainty
from verification.problem.point_answers import ByFunctions

__all__ = ["HertzEllipse", "PressedEllipsoid", "pressed_ellipsoid"]


@dataclass(frozen=True)
class HertzEllipse:
    """Contact with semi-axes ``a`` > ``b`` [m], pressure ``p0`` [Pa] and contact modulus ``E_star`` [Pa]."""

    a: float
    b: float
    p0: float
    E_star: float

    @property
    def load(self) -> float:
        """[N]"""
        return 2 * pi * self.a * self.b * self.p0 / 3

    @property
    def approach(self) -> float:
        """[m]"""
        return float(self.p0 * self.b / self.E_star * ellipk(self._m))

    @property
    def curvatures(self) -> tuple[float, float]:
        """A and B of the indenter's height A x^2 + B y^2 [1/m]."""
        K, E = float(ellipk(self._m)), float(ellipe(self._m))
        scale = self.p0 * self.b / (self.E_star * self._m * self.a**2)
        return scale * (K - E), scale * ((self.a / self.b) ** 2 * E - K)

    @property
    def _m(self) -> float:
        return 1 - (self.b / self.a) ** 2


EXACT = Uncertainty()


@dataclass(frozen=True)
class PressedEllipsoid(ByFunctions):
    """Numbers of the contact of an ellipsoid; ``axes`` : semi-axes along x and y [m]."""

    contact_radius: float
    approach: float
    peak_pressure: float
    axes: tuple[float, float]
    uncertainty: Uncertainty = EXACT
    diagnostics: None = None

    @property
    def surface_nodes(self) -> Array:
        """Points x on y = 0 [m] to sample at."""
        return self.contact_radius * np.linspace(-2.5, 2.5, 501)

    def pressure(self, x: ArrayLike, y: ArrayLike = 0.0) -> Array:
        """p0 sqrt(1 - x^2/a_x^2 - y^2/a_y^2) [Pa], 0 outside."""
        inside = 1 - (np.asarray(x) / self.axes[0]) ** 2 - (np.asarray(y) / self.axes[1]) ** 2
        return self.peak_pressure * np.sqrt(np.maximum(inside, 0.0))


def pressed_ellipsoid(R_x: float, R_y: float, load: float, E: float, nu: float) -> PressedEllipsoid:
    """Contact of a rigid ellipsoid with radii of curvature R_x, R_y [m] under ``load`` [N] on one solid.

    The ratio of the axes is that whose curvatures have the given ratio; then p0 and a follow from the load
    and one curvature.
    """
    E_star, (long, short) = E / (1 - nu**2), (max(R_x, R_y), min(R_x, R_y))
    if long == short:
        a = (0.75 * load * long / E_star) ** (1 / 3)
        return PressedEllipsoid(a, a**2 / long, 1.5 * load / (pi * a**2), (a, a))

    def excess(log_ratio: float) -> float:
        A, B = HertzEllipse(1.0, exp(-log_ratio), 1.0, 1.0).curvatures
        return log(B / A) - log(long / short)

    ratio = exp(-brentq(excess, 1e-8, 12.0, xtol=1e-15))
    unit = HertzEllipse(1.0, ratio, E_star, E_star)  # for which all scale: A ~ p0/a, W ~ p0 a^2
    a = (load / unit.load * 2 * long * unit.curvatures[0]) ** (1 / 3)
    exact = HertzEllipse(a, ratio * a, E_star * a / (2 * long * unit.curvatures[0]), E_star)
    axes = (exact.a, exact.b) if R_x >= R_y else (exact.b, exact.a)
    return PressedEllipsoid((exact.a * exact.b) ** 0.5, exact.approach, exact.p0, axes)
