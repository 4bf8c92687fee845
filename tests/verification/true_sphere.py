"""Closed form of a true sphere on a homogeneous half-space, where the contacts elsewhere have a parabola.

    delta = a artanh(a/R),   W = E* [(a^2 + R^2) artanh(a/R) - a R]
    p(0) = (E*/pi) [artanh(a/R) + chi_2(a/R)],   chi_2(s) = sum s^(2n+1) / (2n+1)^2

Sneddon, Int. J. Engng Sci. 3 (1965) 47-57, eqs. (6.14), (6.15); p(0) = -int_0^a phi'(t)/t dt of its phi.
Against the parabola at the same load, to the order (a/R)^2:

    a : -2/15,   delta : +1/15,   p(0) : +4/45.

The sphere is that of ``integral_equation.SPHERE`` on coated solids. Slopes of order a/R are not small: what
this costs is the error of the parabola alone, not that of small strains.
"""

from dataclasses import dataclass

import numpy as np
from scipy.special import spence


@dataclass(frozen=True)
class SphereOnHalfSpace:
    """Sphere of ``radius`` [m] in contact over ``contact_radius`` [m] < R; ``E_star`` [Pa] of both bodies."""

    radius: float
    contact_radius: float
    E_star: float

    @property
    def _artanh(self) -> float:
        return float(np.arctanh(self.contact_radius / self.radius))

    @property
    def approach(self) -> float:
        """delta [m]."""
        return self.contact_radius * self._artanh

    @property
    def load(self) -> float:
        """W [N], a difference: the relative rounding error grows as (R/a)^2."""
        a, R = self.contact_radius, self.radius
        return self.E_star * ((a**2 + R**2) * self._artanh - a * R)

    @property
    def peak_pressure(self) -> float:
        """p(0) [Pa]; chi_2(s) = [Li_2(s) - Li_2(-s)] / 2."""
        s = self.contact_radius / self.radius
        chi = float(spence(1 - s) - spence(1 + s)) / 2
        return self.E_star / np.pi * (self._artanh + chi)
