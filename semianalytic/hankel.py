"""Hankel transforms of smooth response functions on a logarithmic grid.

    g(r) = 1/(2 pi) int_0^inf F(k) J_m(k r) k dk

by the fast transform of Talman (1978) and Hamilton (2000). F must die like exp(-k L), L the ``scale``, and
be smooth at k = 0. What it does there, F_0 + F_1 k, is taken off first in closed form (Watson 1944, 13.2),

    int_0^inf e^{-kL} J_m(k r) dk = t^m / rho,     rho = sqrt(r^2 + L^2),   t = (rho - L) / r,

with its derivatives by L, because the logarithmic grid has to end somewhere above k = 0: a rest of order
k^3 then leaves errors of 2e-8 of the largest value, weighted with (1 + r/L)^2, over 0.01 < r/L < 1000. A
stiff coating bends on a base far softer over lengths much beyond L, and F changes from one level to another
at k L << 1: the two levels are taken off each on its own length.

Sources
-------
J. D. Talman, J. Comput. Phys. 29 (1978) 35-48.
A. J. S. Hamilton, Mon. Not. R. Astron. Soc. 312 (2000) 257-284.
G. N. Watson, A Treatise on the Theory of Bessel Functions, Cambridge University Press, 1944.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.fft import fht

__all__ = ["RADII", "WAVENUMBERS", "hankel"]

Array = NDArray[Any]

_N = 1500
_STEP = np.log(3e10) / (_N - 1)
_CENTRE = np.sqrt(1e-8 * 3e2)
_LADDER = np.exp(_STEP * (np.arange(_N) - (_N - 1) / 2))

WAVENUMBERS: Array = _CENTRE * _LADDER  # k L, from 1e-8 to 3e2
RADII: Array = _LADDER / _CENTRE  # r / L, from 3e-3 to 1e8
# balance what the finite grid cuts off at its two ends, per order
_BIAS = (0.7, 0.25, 0.0, 0.0)
_BIAS_OVER_K = (0.25, 0.0, -0.25, -0.25)


def hankel(F: Array, order: int, scale: float, *, over_k: bool = False) -> Array:
    """g(r) at r = scale * RADII of F given at k = WAVENUMBERS / scale; with ``over_k`` of F/k.

    F : (..., nk), tends to a constant at k = 0.  order : m = 0..3.  scale : L [m].
    Returns g, unit of F / m^2, or of F / m with ``over_k``; shape of ``F``.
    """
    x, r = WAVENUMBERS, RADII
    F_0, slope = _at_zero(F)
    low, length = _low_level(F, F_0)
    first = 0 if over_k else 1
    g = 0.0
    rest = F
    for height, incline, L in (
        (low, np.where(low, slope, 0.0), length),
        (F_0 - low, slope * (low == 0), 1.0),
    ):
        incline = incline + height * L  # of what is left of F once the height e^{-xL} is taken off
        powers = _closed_forms(order, L)
        g = g + height * powers[first] + incline * powers[first + 1]
        rest = rest - (height + incline * x) * np.exp(-x * L)
    # offset 0 keeps the radii free of the order; the ringing it allows stays below the errors above
    bias = (_BIAS_OVER_K if over_k else _BIAS)[order]
    tail = fht(rest * x**first, _STEP, order, offset=0.0, bias=bias)
    if order == 0 and not over_k:
        # what wraps around from r >> L weighs on small r the less the smaller the bias
        near = slice(0, int(np.searchsorted(r, 3.0)))
        tail[..., near] = fht(rest * x, _STEP, order, offset=0.0, bias=0.1)[..., near]
    g = g + tail / r
    return g / (2 * np.pi * (scale if over_k else scale**2))


def _closed_forms(order: int, L: Array | float) -> tuple[Array, Array, Array]:
    """int x^n e^{-xL} J_m(x r) dx at RADII for n = 0, 1, 2; L broadcast against them."""
    rho = np.hypot(RADII, L)
    t_m = (RADII / (rho + L)) ** order
    return (
        t_m / rho,
        t_m * (L + order * rho) / rho**3,
        t_m * (3 * L**2 + 3 * order * L * rho + (order**2 - 1) * rho**2) / rho**5,
    )


def _low_level(F: Array, F_0: Array) -> tuple[Array, Array]:
    """How much of F_0 is gone at k L = 0.03, zero where that is little, and the length over which it goes."""
    low = F_0 - F[..., [np.searchsorted(WAVENUMBERS, 0.03)]]
    low = np.where(np.abs(low) > 0.1 * np.abs(F).max(axis=-1, keepdims=True), low, 0.0)
    half = np.argmax(np.abs(F - F_0) > 0.5 * np.abs(low), axis=-1)[..., None]
    return low, np.where(low, np.log(2) / WAVENUMBERS[half], 1.0)


def _at_zero(F: Array) -> tuple[Array, Array]:
    """F and dF/dx at x = 0 by the parabola through three small x."""
    nodes = np.searchsorted(WAVENUMBERS, [0, 3e-8, 6e-8])
    inverse = np.linalg.inv(np.vander(WAVENUMBERS[nodes] * 1e7, 3, increasing=True))
    F_0, slope, _ = np.moveaxis(F[..., nodes] @ inverse.T, -1, 0)[..., None]
    return F_0, slope * 1e7
