"""Exact surface deflection of the layered half-space under an axisymmetric pressure.

For p = sqrt(t) q(t), t = 1 - (r/a)^2, Abel's integral turns the pressure into phi on 0 <= x <= 1,

    p(r) = -int_r^a d phi/dx dx / sqrt(x^2 - r^2),     phat(k) = int_0^a phi cos(kx) dx,

and the deflection, with M(k) the compliance of the layers over that of the first material (E1*), is

    u(r) = (2/E1*) [ int_0^min(r, a) phi(x) dx / sqrt(r^2 - x^2) + int_0^inf (M - 1) phat(k) J0(kr) dk ]:

Sneddon, Fourier Transforms (1951), section 52.3, for the first; the second converges like exp(-2 k h).
Independent of any patches, it gives the error of a grid of constant patches at the contact edge.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline
from scipy.special import j0, spherical_jn

__all__ = ["LayerTable", "deflection", "layer_table"]

Array = NDArray[np.floating]

CYCLES = 1400.0  # largest k a: complete for coatings down to h = a/100


@dataclass(frozen=True, eq=False)
class LayerTable:
    """(M - 1) J0(kr) with quadrature weights: int (M - 1) phat J0(kr) dk = matrix @ phat(k).

    k [rad/m] : (nk,).  r [m] : (nr,).  matrix : (nr, nk).
    """

    k: Array
    r: Array
    matrix: Array


def layer_table(
    excess: Callable[[Array], Array],
    thickness: float,
    radius: float,
    reach: float,
    *,
    cycles: float = CYCLES,
) -> LayerTable:
    """Table for contacts of about ``radius`` and points r <= reach, by Gauss panels of half an oscillation.

    excess : M(k) - 1, k [rad/m].  thickness : of the first coating [m].  cycles : largest k a.
    """
    k_max = min(14 / thickness, cycles / radius)  # exp(-28) is rounding
    width = 5 / (1.1 * radius + reach)
    edges = np.concatenate(
        [[0], np.geomspace(1e-4 * width, width, 10), np.linspace(width, k_max, int(k_max / width) + 2)[1:]]
    )
    s, w = legendre.leggauss(10)
    half = np.diff(edges)[:, None] / 2
    k = (edges[:-1, None] + half * (1 + s)).ravel()
    spacing = min(thickness, 0.1 * radius) / 20
    r = np.linspace(0, reach, int(np.clip(reach / spacing, 120, 1000)))
    return LayerTable(k, r, j0(np.outer(r, k)) * ((half * w).ravel() * excess(k)))


def deflection(
    radius: float, coefficients: Array, E_star: float, table: LayerTable | None, r: Array
) -> Array:
    """u(r) [m] under p = sqrt(t) sum b_m P_m(2t - 1).

    radius : a [m].  coefficients : b_m [Pa].  E_star : E1/(1 - nu1^2) [Pa] of the first material.
    table : of the layers, None for the homogeneous solid.  r [m], any shape.
    """
    a, terms = radius, len(coefficients)
    phi = np.linalg.solve(_abel(terms), coefficients) * a  # phi = x' sum phi_m P_m(2x' - 1), x' = 1 - (x/a)^2
    reach = float(np.max(r))
    inner = a * np.sin(np.linspace(0, np.pi / 2, 400))
    outer = a + np.linspace(0, np.sqrt(max(reach - a, 1e-2 * a)), 300) ** 2
    # smooth in r inside, in sqrt(r - a) outside
    u = np.where(
        r <= a,
        CubicSpline(inner, _over_circle(phi, inner / a))(np.minimum(r, a)),
        CubicSpline(np.sqrt(outer - a), _over_circle(phi, outer / a))(np.sqrt(np.maximum(r - a, 0))),
    )
    if table is not None:
        u = u + CubicSpline(table.r, table.matrix @ (a * _cosine_transform(phi, table.k * a)))(r)
    return 2 / E_star * u


def _abel(terms: int) -> Array:
    """Column j: Legendre coefficients of q(t) = 2 int_0^1 phi'(t (1 - v^2)) dv for phi = x' P_j(2x' - 1)."""
    v, w = legendre.leggauss(terms + 1)
    v, w = (1 + v) / 2, w / 2
    s, ws = legendre.leggauss(terms)
    t = (1 + s) / 2
    y = t[:, None] * (1 - v**2)
    basis = np.eye(terms)
    project = (ws[:, None] * legendre.legvander(s, terms - 1)).T * (np.arange(terms)[:, None] + 0.5)
    columns = []
    for unit in basis:
        slope = legendre.legval(2 * y - 1, unit) + 2 * y * legendre.legval(2 * y - 1, legendre.legder(unit))
        columns.append(project @ (2 * slope @ w))
    return np.array(columns).T


def _over_circle(phi: Array, rho: Array) -> Array:
    """int_0^min(rho, 1) phi(x) dx / sqrt(rho^2 - x^2), x = rho sin(theta); exact to rounding by 48 points."""
    s, w = legendre.leggauss(48)
    end = np.arcsin(np.minimum(1, 1 / np.maximum(rho, 1e-300)))
    x = rho[:, None] * np.sin(end[:, None] * (1 + s) / 2)
    y = 1 - np.minimum(x, 1) ** 2
    return (y * legendre.legval(2 * y - 1, phi)) @ w * end / 2


def _cosine_transform(phi: Array, k: Array) -> Array:
    """int_0^1 phi(x) cos(kx) dx from the even Legendre polynomials of phi: int P_2i cos = (-1)^i j_2i(k)."""
    n = len(phi) + 1
    s, w = legendre.leggauss(2 * n + 2)
    y = 1 - s**2
    value = y * legendre.legval(2 * y - 1, phi)
    total = np.zeros_like(k)
    for i in range(n):
        c = (2 * i + 0.5) * np.sum(w * value * legendre.legval(s, [0] * (2 * i) + [1]))
        total += c * (-1) ** i * spherical_jn(2 * i, k)
    return total
