"""Hertz's elliptical contact of homogeneous solids, in closed form.

    p = p0 sqrt(1 - (x/a)^2 - (y/b)^2),   a >= b,   e^2 = 1 - b^2/a^2,
    height = A x^2 + B y^2,   A = p0 b/(E* e^2 a^2) (K - E),   B = p0 b/(E* e^2 a^2) (a^2/b^2 E - K),
    approach = p0 b K/E*,     load = 2 pi a b p0/3,

K and E the complete elliptic integrals of modulus e. K. L. Johnson, Contact Mechanics, 1985, section 4.2.
"""

from dataclasses import dataclass
from math import exp, log, pi
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk

from verification.problem.array_types import Array
from verification.problem.coated_contact import ScalarUncertainty
from verification.problem.point_answers import ByFunctions


@dataclass(frozen=True)
class HertzEllipse(ByFunctions):
    """Contact with semi-axes ``a`` >= ``b`` [m], pressure ``p0`` [Pa] and contact modulus ``E_star`` [Pa].

    along_y : whether the long axis lies along y.
    """

    a: float
    b: float
    p0: float
    E_star: float
    along_y: bool = False
    uncertainty: ClassVar[ScalarUncertainty] = ScalarUncertainty()  # zero: exact
    diagnostics: ClassVar[None] = None

    @property
    def load(self) -> float:
        """[N]"""
        return 2 * pi * self.a * self.b * self.p0 / 3

    @property
    def approach(self) -> float:
        """[m]"""
        return float(self.p0 * self.b / self.E_star * ellipk(self._m))

    @property
    def contact_radius(self) -> float:
        """Radius of the disc of the same area [m]."""
        return (self.a * self.b) ** 0.5

    @property
    def peak_pressure(self) -> float:
        """[Pa]"""
        return self.p0

    @property
    def axes(self) -> tuple[float, float]:
        """Semi-axes along x and y [m]."""
        return (self.b, self.a) if self.along_y else (self.a, self.b)

    @property
    def curvatures(self) -> tuple[float, float]:
        """A and B of the indenter's height A x^2 + B y^2 [1/m], of an ellipse that is no circle."""
        K, E = float(ellipk(self._m)), float(ellipe(self._m))
        scale = self.p0 * self.b / (self.E_star * self._m * self.a**2)
        return scale * (K - E), scale * ((self.a / self.b) ** 2 * E - K)

    @property
    def _m(self) -> float:
        return 1 - (self.b / self.a) ** 2

    @property
    def surface_nodes(self) -> Array:
        """Points x on y = 0 [m] to sample at."""
        return self.contact_radius * np.linspace(-2.5, 2.5, 501)

    def pressure(self, x: ArrayLike, y: ArrayLike = 0.0) -> Array:
        """p [Pa], 0 outside."""
        inside = 1 - (np.asarray(x) / self.axes[0]) ** 2 - (np.asarray(y) / self.axes[1]) ** 2
        return self.p0 * np.sqrt(np.maximum(inside, 0.0))


def pressed_ellipsoid(
    R_x: float, R_y: float, load: float, E: float, nu: float, ball: tuple[float, float] | None = None
) -> HertzEllipse:
    """Contact of an ellipsoid with radii of curvature R_x, R_y [m] under ``load`` [N] on one solid.

    ball : (E, nu) of the ellipsoid, None where it is rigid.

    The ratio of the axes is that whose curvatures have the given ratio; then p0 and a follow from the load
    and one curvature.
    """
    E_star = 1 / sum((1 - nu_k**2) / E_k for E_k, nu_k in ((E, nu), *((ball,) if ball else ())))
    long, short = max(R_x, R_y), min(R_x, R_y)
    if long == short:
        a = (0.75 * load * long / E_star) ** (1 / 3)
        return HertzEllipse(a, a, 1.5 * load / (pi * a**2), E_star)

    def excess(log_ratio: float) -> float:
        A, B = HertzEllipse(1.0, exp(-log_ratio), 1.0, 1.0).curvatures
        return log(B / A) - log(long / short)

    ratio = exp(-brentq(excess, 1e-8, 12.0, xtol=1e-15))
    unit = HertzEllipse(1.0, ratio, E_star, E_star)  # for which all scale: A ~ p0/a, W ~ p0 a^2
    a = (load / unit.load * 2 * long * unit.curvatures[0]) ** (1 / 3)
    return HertzEllipse(a, ratio * a, E_star * a / (2 * long * unit.curvatures[0]), E_star, R_x < R_y)
