"""Stiffness of thin layers on a rigid base, or of thick coatings, in closed form.

Thin, compressible: the layer is a bed of springs, p = M u/h with the oedometric modulus M = E (1 - nu) /
((1 + nu)(1 - 2 nu)). Thin, incompressible: the layer is a film that has to be squeezed out sideways,

    (1/r) d/dr (r dp/dr) = -3 G w/h^3,   w the depth pressed in

Johnson, Contact Mechanics (1985), section 5.8; Jaffar, Int. J. Mech. Sci. 31 (1989) 229-235; Barber, Contact
Mechanics (2018), chapter 18. Thick: Hertz of the coating, then what the interface adds to first order in a/h.
"""

import numpy as np

from verification.problem.array_types import Coatings
from verification.problem.gauss_legendre import wavenumber_panels
from verification.sources.references.layered_half_space import LayeredHalfSpace, bending_length


def spring_bed(a: float, E: float, nu: float, h: float) -> tuple[float, float]:
    """(S [N/m], W R [N m]) of a thin compressible layer: S = pi M a^2/h, W = pi M a^4/(4 R h)."""
    M = E * (1 - nu) / ((1 + nu) * (1 - 2 * nu))
    return np.pi * M * a**2 / h, np.pi * M * a**4 / (4 * h)


def squeezed_film(a: float, E: float, h: float) -> tuple[float, float]:
    """(S, W R) of a thin incompressible layer: S = 3 pi G a^4/(8 h^3), W = pi G a^6/(32 R h^3)."""
    G = E / 3
    return 3 * np.pi * G * a**4 / (8 * h**3), np.pi * G * a**6 / (32 * h**3)


def thick(a: float, coatings: Coatings, substrate: tuple[float, float]) -> tuple[float, float]:
    """kappa of a flat punch on a thick coating: Hertz's 1, then 1/(1 + (2/pi) a int_0^inf (M - 1) dk).

    First order in a/h: the kernel of the integral equation is constant under the punch.
    """
    end = 40.0 / coatings[0][2]
    k, weight = wavenumber_panels(end, 0.5 / bending_length(coatings, substrate), 0.5 / coatings[0][2], 16)
    excess = float(weight @ (LayeredHalfSpace(coatings, substrate, k).compliance - 1))
    return 1.0, 1 / (1 + 2 / np.pi * a * excess)
