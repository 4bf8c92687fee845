"""Effective contact moduli of a film on a substrate by formulas of nanoindentation.

All define E_eff by the contact stiffness S = dP/d delta = 2 a E_eff at contact radius a, for a sphere that
of a flat punch: E_eff compares with E1* kappa of ``flat_punch``. ``xi`` is h/a.

    I0 = (2/pi) atan xi + [(1 - 2 nu) xi ln(1 + 1/xi^2) - xi/(1 + xi^2)] / (2 pi (1 - nu))
    I1 = (2/pi) atan xi + (xi/pi) ln(1 + 1/xi^2)

Gao, Chiu and Lee, Int. J. Solids Struct. 29 (1992) 2471-2492: I0 and I1 are the exact first-order weights of
the shear modulus and of Poisson's ratio of the film. No primary source was at hand: the formulas are those
of D. Mercier's NIMS toolbox (2014), I0 and I1 besides confirmed by differentiating the exact stiffness.
Formulas with a coefficient that is fitted to each experiment (Doerner and Nix 1986, King 1987, Saha and Nix
2002, Mencik 1997, Hu and Lawn 1998, Jung 2004) make no prediction by themselves and are left out.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from verification.problem.array_types import Array

Material = tuple[float, float]

# Between these n is fitted to each ratio of moduli, by Perriot and Barthel as the NIMS toolbox tells.
PERRIOT_BARTHEL_N = (1.06, 1.32)
_X0 = (-0.093, 0.792, 0.05)
_F = 0.0626  # Hay and Crawford's, from finite elements


def I0(xi: Array, nu: float | Array) -> Array:
    """Weight of the film's shear modulus."""
    edge = (1 - 2 * nu) * xi * np.log1p(1 / xi**2) - xi / (1 + xi**2)
    return 2 / np.pi * np.arctan(xi) + edge / (2 * np.pi * (1 - nu))


def I1(xi: Array) -> Array:
    """Weight of the film's Poisson ratio."""
    return 2 / np.pi * np.arctan(xi) + xi / np.pi * np.log1p(1 / xi**2)


def gao(film: Material, substrate: Material, xi: Array) -> Array:
    """E_eff = 2 G/(1 - nu), G = G2 + (G1 - G2) I0, nu = nu2 + (nu1 - nu2) I1. Gao, Chiu and Lee (1992)."""
    (G1, nu1), (G2, nu2) = _shear(film), _shear(substrate)
    nu = nu2 + (nu1 - nu2) * I1(xi)
    return 2 * (G2 + (G1 - G2) * I0(xi, nu)) / (1 - nu)


def xu_pharr(film: Material, substrate: Material, xi: Array) -> Array:
    """The same with compliances mixed: 1/G = 1/G2 + (1/G1 - 1/G2) I0.

    Xu and Pharr, Scr. Mater. 55 (2006) 315-318.
    """
    (G1, nu1), (G2, nu2) = _shear(film), _shear(substrate)
    nu = nu2 + (nu1 - nu2) * I1(xi)
    return 2 / ((1 / G2 + (1 / G1 - 1 / G2) * I0(xi, nu)) * (1 - nu))


def hay_crawford(film: Material, substrate: Material, xi: Array) -> Array:
    """1/G = (1 - I0)/(G2 + F I0 G1) + I0/G1, F = 0.0626. Hay and Crawford, J. Mater. Res. 26 (2011) 727-738.

    nu = 1 - (1 - nu1)(1 - nu2)/(1 - (1 - I1) nu1 - I1 nu2).
    """
    (G1, nu1), (G2, nu2) = _shear(film), _shear(substrate)
    w = I1(xi)
    nu = 1 - (1 - nu1) * (1 - nu2) / (1 - (1 - w) * nu1 - w * nu2)
    v = I0(xi, nu)
    return 2 / (((1 - v) / (G2 + _F * v * G1) + v / G1) * (1 - nu))


def perriot_barthel(film: Material, substrate: Material, xi: Array, n: float) -> Array:
    """E_eff = E1* + (E2* - E1*)/(1 + (x0 xi)^n). Perriot and Barthel, J. Mater. Res. 19 (2004) 600-608.

    ``perriot_barthel_x0`` for E2*/E1* from 0.01 to 100; n depends on that ratio too, PERRIOT_BARTHEL_N.
    """
    E1, E2 = _contact(film), _contact(substrate)
    return E1 + (E2 - E1) / (1 + (perriot_barthel_x0(E2 / E1) * xi) ** n)


def perriot_barthel_x0(ratio: float) -> float:
    """log10 x0 = -0.093 + 0.792 L + 0.05 L^2, L = log10 of ``ratio`` = E2*/E1*."""
    return float(10 ** np.polynomial.polynomial.polyval(np.log10(ratio), _X0))


def bec(film: Material, substrate: Material, xi: Array) -> Array:
    """1/E_eff = [2 xi/(pi E1*) + 1/E2*]/(1 + 2 xi/pi): springs in series.

    Bec, Tonck, Loubet, Phil. Mag. 86 (2006) 5347-5358.
    """
    s = 2 * xi / np.pi
    return (1 + s) / (s / _contact(film) + 1 / _contact(substrate))


@dataclass(frozen=True)
class Formula:
    """``modulus`` of (film, substrate, h/a), each material (E [Pa], nu), in Pa."""

    name: str
    modulus: Callable[[Material, Material, Array], Array]


FORMULAS = (
    Formula("Gao, Chiu and Lee 1992", gao),
    Formula("Xu and Pharr 2006", xu_pharr),
    Formula("Bec and others 2006", bec),
    Formula("Hay and Crawford 2011", hay_crawford),
)


def _shear(material: Material) -> Material:
    E, nu = material
    return E / (2 * (1 + nu)), nu


def _contact(material: Material) -> float:
    E, nu = material
    return E / (1 - nu**2)
