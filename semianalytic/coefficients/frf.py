"""Frequency response functions of an elastic half-space under any number of bonded coatings.

In the frame of the wave vector, L along k, T across it, z down, all fields vary as exp(i k L). In each
layer the Papkovich-Neuber potentials of the plane problem (L, z) are written as

    phi + s psi = d1 / k^2,  psi = d2 / k,  d(s) = e^{-ks} [[1, ks], [0, 1]] d(0)    down, s from the top
    phi - t psi = g1 / k^2,  psi = g2 / k,  g(t) = e^{-kt} [[1,-kt], [0, 1]] g(0)    up, t from the bottom

so that every field is a combination of (d1, d2, g1, g2) at its depth with coefficients free of k: the
potentials of O'Sullivan and King, J. Tribol. 110 (1988) 235-240, with the origin moved to the top,
respectively the bottom, of the layer (derived here). The solid below a layer enters as a reflection g = R d
at its bottom (Kennett, Seismic Wave Propagation in Stratified Media, Cambridge University Press, 1983, for
waves). R is carried from the substrate up, the amplitudes from the surface down; each step is a 2 x 2 matrix
without any growing exponential: k h = 1e-6 is as safe as 1e4.

Signs: stress positive in tension, sigma_zz = -p, sigma_Lz = i T0, sigma_Tz = t at z = 0; u_z into the solid.
``coatings`` ((E, nu, thickness), ...) from the surface down, ``substrate`` (E, nu); Pa, m.
"""

from collections.abc import Sequence
from math import factorial
from typing import Any, Literal

import numpy as np
from numpy.polynomial import polynomial
from numpy.typing import ArrayLike, NDArray

Array = NDArray[Any]
Coatings = Sequence[tuple[float, float, float]]
Load = Literal["normal", "in-plane", "anti-plane"]

_TRACTION: dict[Load, list[float]] = {"normal": [-1.0, 0.0], "in-plane": [0.0, 1.0], "anti-plane": [1.0]}


def compliance_excess(k: ArrayLike, coatings: Coatings, substrate: tuple[float, float]) -> Array:
    """Normal surface compliance M of the layered half-space, relative to its first coating, less 1.

        u_z = (1 - nu1) / (G1 k) M(k) p,      M(inf) = 1,      M(0) = E1* / E2*   (E2* of the substrate)

    Without cancellation; M - 1 decays like (k h)^2 exp(-2 k h). One coating: closed form of the Papkovich
    potentials. More: the waves reflected from the interfaces, by reflection matrices (module docstring).

    k : wavenumber >= 0 [rad/m], any shape.  coatings : at least one.  Returns [-], shape of ``k``.
    """
    k = np.asarray(k, dtype=float)
    if len(coatings) == 1:
        return _one_coating_excess(k, coatings[0], substrate)
    u = _fields(k.ravel(), np.zeros(1), 0, coatings, substrate, "normal", _rows_displacement, excess=True)
    return (u[0, 0] / (2 * (1 - coatings[0][1]))).reshape(k.shape)


def _one_coating_excess(
    k: Array, coating: tuple[float, float, float], substrate: tuple[float, float]
) -> Array:
    """M - 1 of a single coating in closed form: lam and kap are its two reflection coefficients.

    With L = 1 - lam, Q = 1 - kap, th = exp(-2x), x = k h the denominator is

        1 - (lam + kap + 4 kap x^2) th + lam kap th^2
            = (1 - th) (L th + Q) + L Q th^2 + 4 kap th (sinh^2 x - x^2),

    a sum of positive terms for a stiff coating, where L and Q are of the order E2/E1.
    """
    E1, nu1, h = coating
    E2, nu2 = substrate
    m = E1 * (1 + nu2) / (E2 * (1 + nu1))
    L, Q = 4 * (1 - nu1) / (1 + m * (3 - 4 * nu2)), 4 * (1 - nu1) / (m + 3 - 4 * nu1)
    lam = 1 - L
    kap = (m - 1) / (m + 3 - 4 * nu1)
    x = np.minimum(k * h, 400.0)  # beyond, th underflows; x^2 th must not become inf * 0
    th, u = np.exp(-2 * x), -np.expm1(-2 * x)
    small = np.minimum(x, 1.0) ** 2
    series = polynomial.polyval(small, [0, 0, *(2.0 ** (2 * n - 1) / factorial(2 * n) for n in range(2, 13))])
    bending = np.where(x < 1, th * series, u**2 / 4 - x**2 * th)  # th (sinh^2 x - x^2)
    denominator = u * (L * th + Q) + L * Q * th**2 + 4 * kap * bending
    return th * (lam * (u + Q * th) + kap * (u + L * th) + 4 * kap * x * (1 + x)) / denominator


def stress_frf(
    k: ArrayLike,
    z: ArrayLike,
    layer: int,
    *,
    coatings: Coatings,
    substrate: tuple[float, float],
    load: Load,
    excess: bool = False,
) -> Array:
    """Stress amplitudes at depths ``z`` in ``layer`` for a surface traction of unit amplitude, all real.

        normal, p = 1     :  s_zz, s_Lz / i, s_LL, s_TT
        in-plane, T0 = 1  :  s_zz, s_Lz / i, s_LL, s_TT
        anti-plane, t = 1 :  s_Tz, s_LT / i

    Any number of coatings, by reflection matrices (module docstring). A traction q on the solid in +x is
    T0 = i q cos(a), t = q sin(a), with a the direction of the wave vector. ``excess`` leaves out the
    homogeneous half-space made of the first coating (in layer 0 only), computed without cancellation.

    k : wavenumbers [rad/m], (nk,).  z : depths [m], (nz,), each inside the closed layer.
    layer : 0 at the surface, len(coatings) is the substrate.  Returns [-], (4 or 2, nz, nk).
    """
    rows = _rows_shear_stress if load == "anti-plane" else _rows_stress
    return _fields(k, z, layer, coatings, substrate, load, rows, excess)


def displacement_frf(
    k: ArrayLike,
    z: ArrayLike,
    layer: int,
    *,
    coatings: Coatings,
    substrate: tuple[float, float],
    load: Load,
    excess: bool = False,
) -> Array:
    """Displacement amplitudes times k: (k u_z, k u_L / i) in plane, (k u_T,) anti-plane.

    Arguments as in `stress_frf`. The factor k keeps the amplitude finite at k = 0.
    Returns [1/Pa], (2 or 1, nz, nk).
    """
    material = (*coatings, substrate)[layer]
    G = material[0] / (2 * (1 + material[1]))
    rows = _rows_shear_displacement if load == "anti-plane" else _rows_displacement
    scale = 1 / G if load == "anti-plane" else 1 / (2 * G)
    return scale * _fields(k, z, layer, coatings, substrate, load, rows, excess)


# ---------------------------------------------------- the fields as rows acting on (d1, d2) and (g1, g2)
def _rows_stress(nu: float) -> tuple[Array, Array]:
    """s_zz, s_Lz / i, s_LL, s_TT from (d1, d2) and from (g1, g2)."""
    down = np.array([[1, 2 * (1 - nu)], [-1, -(1 - 2 * nu)], [-1, 2 * nu], [0, 2 * nu]])
    up = np.array([[1, -2 * (1 - nu)], [1, -(1 - 2 * nu)], [-1, -2 * nu], [0, -2 * nu]])
    return down, up


def _rows_displacement(nu: float) -> tuple[Array, Array]:
    """2 G k u_z, 2 G k u_L / i from (d1, d2) and from (g1, g2)."""
    return np.array([[-1, -(3 - 4 * nu)], [1, 0]]), np.array([[1, -(3 - 4 * nu)], [1, 0]])


def _rows_shear_stress(nu: float) -> tuple[Array, Array]:
    """s_Tz, s_LT / i from the single anti-plane amplitudes G k u_T = d + g."""
    return np.array([[-1.0], [1.0]]), np.array([[1.0], [1.0]])


def _rows_shear_displacement(nu: float) -> tuple[Array, Array]:
    """G k u_T from the anti-plane amplitudes."""
    return np.ones((1, 1)), np.ones((1, 1))


def _fields(k, z, layer, coatings, substrate, load, rows, excess) -> Array:
    """Rows of fields (n, nz, nk) at depths ``z`` of one layer."""
    k, z = np.atleast_1d(np.asarray(k, dtype=float)), np.atleast_1d(np.asarray(z, dtype=float))
    down, up = _amplitudes(k, layer, coatings, substrate, load, excess)
    top = sum(h for _, _, h in coatings[:layer])
    ks = k * (z[:, None] - top)
    row_down, row_up = rows((*coatings, substrate)[layer][1])
    out = np.einsum("ab,b...->a...", row_down, _propagate(down[:, None, :], ks, +1))
    if layer < len(coatings):
        kt = k * (top + coatings[layer][2] - z[:, None])
        out += np.einsum("ab,b...->a...", row_up, _propagate(up[:, None, :], kt, -1))
    return out


def _propagate(amplitude: Array, distance: Array, sign: int) -> Array:
    """Amplitudes after ``distance`` (times k): e^{-x} [[1, sign x], [0, 1]] in plane, e^{-x} anti-plane."""
    distance = np.maximum(distance, 0.0)  # rounding at an interface
    decay = np.exp(-distance)
    if amplitude.shape[0] == 1:
        return amplitude * decay
    shift = sign * (distance * decay)
    return np.stack([amplitude[0] * decay + amplitude[1] * shift, amplitude[1] * decay])


def _propagator(distance: Array, n: int, sign: int) -> Array:
    """The matrix of `_propagate`, (n, n, nk)."""
    return np.stack([_propagate(np.eye(n)[:, j, None], distance, sign) for j in range(n)], axis=1)


# ------------------------------------------------------------------------------- reflection and transmission
def _amplitudes(k, layer, coatings, substrate, load, excess) -> tuple[Array, Array]:
    """Amplitudes d at the top and g at the bottom of ``layer``, (2 or 1, nk) each, for unit surface traction.

    At the bottom of layer j, with the layer below seen as g = Q d from its own top (Q = E R E there):
        B_j (d_j, g_j) = B_{j+1} (1, Q) d_{j+1}   =>   d_j = P d_{j+1},  g_j = S d_{j+1},  R = S P^-1.
    """
    n = 1 if load == "anti-plane" else 2
    layers = (*coatings, (*substrate, np.inf))
    reflect: list[Array] = []  # of interface j, from the lowest one up
    transmit: list[Array] = []
    below = np.zeros((n, n, k.size))
    for j in range(len(coatings) - 1, -1, -1):
        jump = _interface(layers[j][:2], layers[j + 1][:2], n)
        seen = np.concatenate([np.broadcast_to(np.eye(n)[:, :, None], below.shape), below])
        both = np.einsum("ab,bc...->ac...", jump, seen)
        inverse = _inverse(both[:n])
        reflect.insert(0, _product(both[n:], inverse))
        transmit.insert(0, inverse)
        x = k * layers[j][2]
        below = _product(_propagator(x, n, -1), _product(reflect[0], _propagator(x, n, +1)))

    surface_down, surface_up = _surface_rows(layers[0][1], n)
    response = surface_down[:, :, None] + np.einsum("ab,bc...->ac...", surface_up, below)
    d = np.einsum("ab...,b->a...", _inverse(response), np.array(_TRACTION[load]))
    for j in range(layer):
        d = np.einsum("ab...,b...->a...", transmit[j], _propagate(d, k * layers[j][2], +1))
    if layer == len(coatings):
        return d, np.zeros_like(d)
    g = np.einsum("ab...,b...->a...", reflect[layer], _propagate(d, k * layers[layer][2], +1))
    if excess:  # the traction of what comes up is cancelled at the surface
        arriving = _propagate(g, k * layers[0][2], -1)
        d = -np.linalg.solve(surface_down, np.einsum("ab,b...->a...", surface_up, arriving))
    return d, g


def _surface_rows(nu: float, n: int) -> tuple[Array, Array]:
    """Rows of the tractions on z = const: s_zz, s_Lz / i in plane, s_Tz anti-plane."""
    down, up = (_rows_shear_stress if n == 1 else _rows_stress)(nu)
    return down[:n], up[:n]


def _interface(upper: tuple[float, float], lower: tuple[float, float], n: int) -> Array:
    """B_upper^-1 B_lower (2n, 2n): amplitudes just above an interface from those just below (bonded)."""
    rows = _rows_shear_displacement if n == 1 else _rows_displacement
    ratio = upper[0] * (1 + lower[1]) / (lower[0] * (1 + upper[1]))  # G_upper / G_lower
    B_upper = np.vstack([np.hstack(rows(upper[1])), np.hstack(_surface_rows(upper[1], n))])
    B_lower = np.vstack([ratio * np.hstack(rows(lower[1])), np.hstack(_surface_rows(lower[1], n))])
    return np.linalg.solve(B_upper, B_lower)


def _product(A: Array, B: Array) -> Array:
    """Product of matrices that depend on k, (n, n, nk)."""
    return np.einsum("ab...,bc...->ac...", A, B)


def _inverse(A: Array) -> Array:
    """Inverse of 1 x 1 or 2 x 2 matrices that depend on k, (n, n, nk)."""
    if A.shape[0] == 1:
        return 1 / A
    adjugate = np.stack([np.stack([A[1, 1], -A[0, 1]]), np.stack([-A[1, 0], A[0, 0]])])
    return adjugate / (A[0, 0] * A[1, 1] - A[0, 1] * A[1, 0])
