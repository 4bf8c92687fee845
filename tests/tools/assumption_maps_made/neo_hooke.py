"""Compressible neo-Hookean solid, which is Hooke's at small strain.

    Psi = mu/2 (tr C - 3) - mu ln J + lambda/2 (ln J)^2,      P = mu (F - F^-T) + lambda ln(J) F^-T

Bonet and Wood, Nonlinear Continuum Mechanics for Finite Element Analysis, 2nd ed. (2008), chapter 6; mu and
lambda are Lame's. A gradient has the components rr, rz, zr, zz, tt of axisymmetry on its last axis, with
F_rz = dr/dZ.
"""

import numpy as np

from verification.problem.array_types import Array

COMPONENTS = 5
IDENTITY = np.array([1.0, 0.0, 0.0, 1.0, 1.0])
_COFACTOR = np.array([3, 2, 1, 0])  # of the meridian's 2 x 2 block: its entry, with _SIGN
_TRANSPOSE = np.array([0, 2, 1, 3, 4])
_SIGN = np.array([1.0, -1.0, -1.0, 1.0])


def lame(E: float, nu: float) -> tuple[float, float]:
    """Lame's mu and lambda [Pa]."""
    return E / (2 * (1 + nu)), E * nu / ((1 + nu) * (1 - 2 * nu))


def _inverse_transpose(F: Array) -> tuple[Array, Array]:
    """F^-T and J; NaN where J is not positive."""
    plane = F[..., 0] * F[..., 3] - F[..., 1] * F[..., 2]
    J = plane * F[..., 4]
    J = np.where((plane > 0) & (J > 0), J, np.nan)
    inverse = np.empty_like(F)
    inverse[..., :4] = _SIGN * F[..., _COFACTOR] / plane[..., None]
    inverse[..., 4] = 1 / F[..., 4]
    return inverse, J


def first_piola(F: Array, mu: Array, lam: Array) -> Array:
    """P [Pa] of the deformation gradient ``F`` (..., 5); ``mu``, ``lam`` (...). NaN where J <= 0."""
    inverse, J = _inverse_transpose(F)
    return mu[..., None] * (F - inverse) + (lam * np.log(J))[..., None] * inverse


def tangent(F: Array, mu: Array, lam: Array) -> Array:
    """dP/dF [Pa], (..., 5, 5): mu dF + (mu - lambda ln J) F^-T dF^T F^-T + lambda F^-T (F^-T : dF)."""
    inverse, J = _inverse_transpose(F)
    first = (mu - lam * np.log(J))[..., None, None]
    D = lam[..., None, None] * inverse[..., :, None] * inverse[..., None, :]
    D += mu[..., None, None] * np.eye(COMPONENTS)
    # (F^-T dF^T F^-T)_ij = G_il dF_kl G_kj with G = F^-T
    G = inverse[..., :4].reshape(*inverse.shape[:-1], 2, 2)
    D[..., :4, :4] += first * np.einsum("...il,...kj->...ijkl", G, G).reshape(*G.shape[:-2], 4, 4)
    D[..., 4, 4] += first[..., 0, 0] * inverse[..., 4] ** 2
    return D


def hooke(H: Array, mu: Array, lam: Array) -> Array:
    """Small-strain stress [Pa] of the displacement gradient ``H``: tangent(I) H."""
    trace = H[..., 0] + H[..., 3] + H[..., 4]
    P = mu[..., None] * (H + H[..., _TRANSPOSE])
    P[..., [0, 3, 4]] += (lam * trace)[..., None]
    return P


def free_surface_stress(
    by_r: Array, by_z: Array, hoop: Array, mu: float, lam: float, finite: bool = True
) -> Array:
    """sigma_rr [Pa] of a free surface of revolution from u_r,X, u_z,X and u_r/X.

    With stretches l1 along it and l2 around, y = ln l3^2 of that along the normal from
    mu (e^y - 1) + lambda (ln l1 l2 + y/2) = 0; sigma_rr = mu (l1^2 - e^y) / J (dr/dX)^2 / l1^2.
    """
    if not finite:
        return 2 * mu * (by_r + lam / (lam + 2 * mu) * (by_r + hoop))
    l1, l2 = np.hypot(1 + by_r, by_z), 1 + hoop
    y = np.zeros_like(l1)
    for _ in range(30):
        y -= (mu * np.expm1(y) + lam * (np.log(l1 * l2) + y / 2)) / (mu * np.exp(y) + lam / 2)
    return np.asarray(mu * (l1**2 - np.exp(y)) / (l1 * l2 * np.exp(y / 2)) * ((1 + by_r) / l1) ** 2)
