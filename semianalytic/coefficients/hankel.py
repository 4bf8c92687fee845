"""Hankel transforms of smooth response functions on a logarithmic grid.

    g(r) = 1/(2 pi) int_0^inf F(k) J_m(k r) k dk

by the fast transform of Talman (1978) and Hamilton (2000). F must decay like exp(-k L), L the ``scale``, and
be smooth at k = 0. Its expansion there, F_0 + F_1 k, is subtracted first in closed form (Watson 1944, 13.2),

    int_0^inf e^{-kL} J_m(k r) dk = t^m / rho,     rho = sqrt(r^2 + L^2),   t = (rho - L) / r,

with its derivatives by L, because the logarithmic grid has to end somewhere above k = 0: a rest of order
k^3 then leaves errors of 2e-8 of the largest value, weighted with (1 + r/L)^2, over 0.01 < r/L < 1000. A
stiff coating bends and stretches on a base far softer over lengths much beyond L, and F changes from one
level to another at k L << 1: the two levels are subtracted each on its own length. Where that length is more
than 1e4 L the grid has to begin at smaller wavenumbers too: a change of F below its end would be lost and
would appear as an error at small radii. Nearer than L/10 the power series of J_m is exact to rounding.

Sources
-------
J. D. Talman, J. Comput. Phys. 29 (1978) 35-48.
A. J. S. Hamilton, Mon. Not. R. Astron. Soc. 312 (2000) 257-284.
G. N. Watson, A Treatise on the Theory of Bessel Functions, Cambridge University Press, 1944.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.fft import fht
from scipy.special import factorial

from semianalytic import numbers

Array = NDArray[Any]

_STEP = np.log(numbers.HANKEL_SPAN) / (numbers.HANKEL_POINTS - 1)


@dataclass(frozen=True, eq=False)
class LogGrid:
    """Wavenumbers k L up to 3e2 and radii r / L from 3e-3, as many, both growing by the same factor."""

    wavenumbers: Array
    radii: Array


def _log_grid(n: int) -> LogGrid:
    powers = np.exp(_STEP * (np.arange(n) - (n - 1) / 2))
    centre = 3e2 / powers[-1]
    return LogGrid(centre * powers, powers / centre)


USUAL = _log_grid(numbers.HANKEL_POINTS)  # wavenumbers from 1e-8, radii to 1e8
LONG = _log_grid(
    numbers.HANKEL_LONG
)  # from 1e-11, to 1e11: for an F that changes over lengths of more than 1e4 L


def hankel(F: Array, order: int, scale: float, *, over_k: bool = False, grid: LogGrid = USUAL) -> Array:
    """g(r) at r = scale * grid.radii of F given at k = grid.wavenumbers / scale; with ``over_k`` of F/k.

    F : (..., nk), tends to a constant at k = 0.  order : m = 0..3.  scale : L [m].
    Returns g, unit of F / m^2, or of F / m with ``over_k``; shape of ``F``.
    """
    x, r = grid.wavenumbers, grid.radii
    F_0, slope = _at_zero(F, x)
    low, length = _low_level(F, F_0, x)
    first = 0 if over_k else 1
    g = 0.0
    rest = F
    for height, incline, L in (
        (low, np.where(low, slope, 0.0), length),
        (F_0 - low, slope * (low == 0), 1.0),
    ):
        incline = incline + height * L  # of the rest of F after subtraction of height e^{-xL}
        powers = _closed_forms(order, L, r)
        g = g + height * powers[first] + incline * powers[first + 1]
        rest = rest - (height + incline * x) * np.exp(-x * L)
    # offset 0 keeps the radii free of the order; the ringing it allows stays below the errors above
    bias = (numbers.HANKEL_BIAS_OVER_K if over_k else numbers.HANKEL_BIAS)[order]
    tail = fht(rest * x**first, _STEP, order, offset=0.0, bias=bias)
    if order == 0:
        # the periodic image of r >> L affects small r less with a smaller bias
        bias, end = (-0.05, 10.0) if over_k else (0.1, 3.0)
        near = slice(0, int(np.searchsorted(r, end)))
        tail[..., near] = fht(rest * x**first, _STEP, order, offset=0.0, bias=bias)[..., near]
    g = g + tail / r
    return g / (2 * np.pi * (scale if over_k else scale**2))


def near_axis(
    F: Array, order: int, scale: float, r: Array, *, over_k: bool = False, grid: LogGrid = USUAL
) -> Array:
    """g(r) as `hankel`, at r [m] up to ``NEAR_AXIS`` L: int F J_m(kr) k dk by the moments of F.

        J_m(x) = sum_j (-1)^j (x/2)^(m+2j) / (j! (m+j)!),    Watson (1944), 3.1

    r : (nr,).  Returns (..., nr).
    """
    x, s = grid.wavenumbers, np.asarray(r) / scale
    powers = order + 2 * np.arange(numbers.NEAR_AXIS_TERMS)
    exponent = powers + (1 if over_k else 2)
    # a trapezoidal rule in log k, spectrally accurate, plus the part below the first wavenumber
    weight = _STEP * x[:, None] ** exponent
    weight[0] = weight[0] / 2 + x[0] ** exponent / exponent
    j = np.arange(numbers.NEAR_AXIS_TERMS)
    moments = (F @ weight) * (-1.0) ** j / (factorial(j) * factorial(order + j))
    g: Array = moments @ (s / 2) ** powers[:, None]
    return g / (2 * np.pi * (scale if over_k else scale**2))


def _closed_forms(order: int, L: Array | float, r: Array) -> tuple[Array, Array, Array]:
    """int x^n e^{-xL} J_m(x r) dx for n = 0, 1, 2; L broadcast against r."""
    rho = np.hypot(r, L)
    t_m = (r / (rho + L)) ** order
    return (
        t_m / rho,
        t_m * (L + order * rho) / rho**3,
        t_m * (3 * L**2 + 3 * order * L * rho + (order**2 - 1) * rho**2) / rho**5,
    )


def _low_level(F: Array, F_0: Array, x: Array) -> tuple[Array, Array]:
    """Part of F_0 lost at k L = 0.03, zero where that is little, and the length over which it decays."""
    low = F_0 - F[..., [np.searchsorted(x, 0.03)]]
    low = np.where(np.abs(low) > 0.1 * np.abs(F).max(axis=-1, keepdims=True), low, 0.0)
    half = np.argmax(np.abs(F - F_0) > 0.5 * np.abs(low), axis=-1)[..., None]
    return low, np.where(low, np.log(2) / x[half], 1.0)


def _at_zero(F: Array, x: Array) -> tuple[Array, Array]:
    """F and dF/dx at x = 0 by the parabola through three small x."""
    nodes, unit = np.searchsorted(x, x[0] * np.array([0, 3, 6])), 10 * x[0]
    inverse = np.linalg.inv(np.vander(x[nodes] / unit, 3, increasing=True))
    F_0, slope, _ = np.moveaxis(F[..., nodes] @ inverse.T, -1, 0)[..., None]
    return F_0, slope / unit
