"""Hertz's elliptical contact of homogeneous solids, in closed form.

    p = p0 sqrt(1 - (x/a)^2 - (y/b)^2),   a >= b,   e^2 = 1 - b^2/a^2,
    height = A x^2 + B y^2,   A = p0 b/(E* e^2 a^2) (K - E),   B = p0 b/(E* e^2 a^2) (a^2/b^2 E - K),
    approach = p0 b K/E*,     load = 2 pi a b p0/3,

K and E the complete elliptic integrals of modulus e. K. L. Johnson, Contact Mechanics, 1985, section 4.2.
"""

from dataclasses import dataclass
from math import pi

from scipy.special import ellipe, ellipk

__all__ = ["HertzEllipse"]


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
