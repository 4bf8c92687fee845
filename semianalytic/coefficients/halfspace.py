"""Love's rectangle under pressure, on a half-space.

Under unit pressure on a rectangle the surface deflects by u_z = (1-nu)/(2 pi G) V, V = int int 1/rho with rho
= |point - source|: a sum over its corners, which loses digits as
(distance/side)^2; beyond ``FAR_SIDES`` sides a series of its moments.

Sources
-------
A. E. H. Love, Phil. Trans. R. Soc. A 228 (1929) 377-420.
K. L. Johnson, Contact Mechanics, Cambridge University Press, 1985, section 3.3.
"""

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from semianalytic import numbers

Array = NDArray[np.floating]


def surface_deflection(n: int, d: float, depth: float = 0.0) -> Array:
    """Potential V of a square of side d at the centres of a grid of squares.

        V(i d, j d, depth),  i, j = 0..n-1;   u_z = (1-nu)/(2 pi G) V at depth 0

    Nearer than ``FAR_SIDES`` sides Love (1929) eq. 4, with every corner value used by the four squares that
    share it. Beyond, 1/rho and its even derivatives of orders 2, 4 times the moments of the square: no
    cancellation, within 5e-12 of every entry however large the table.

    d, depth [m].  Returns V [m], shape (n, n).
    """
    V: Array = np.empty((n, n))
    near = min(int(np.ceil(np.sqrt(max((numbers.FAR_SIDES * d) ** 2 - depth**2, 0.0)) / d)), n)
    x = np.arange(n) * d
    for i, j in pairwise([0, *range(near, n, 32), n]):
        first = max(i, near)
        V[i:j, first:] = _potential_series(x[i:j, None], x[first:], depth, d * d)
        V[first:, i:j] = V[i:j, first:].T
    X = (np.arange(near + 1) - 0.5) * d
    corner = _potential_corner(X[:, None], X[None, :], depth)
    V[:near, :near] = np.diff(np.diff(corner, axis=0), axis=1)
    return V


def _potential_series(x: Array, y: Array, z: float, a: float) -> Array:
    """V to the fourth moments of a square of area a: the mean of a Taylor series of 1/rho, by Horner in
    rho^-2."""
    x2, y2 = x * x, y * y
    s = 1 / (x2 + (y2 + z * z))
    sum_ = (105 / 1920 * a * a) * x2 * x2 + (105 / 1920 * a * a) * y2 * y2
    sum_ += (105 / 576 * a * a * x2) * y2
    for of_square, constant in (
        (-(a / 1920 * 90 + a / 576 * 15) * a, 0.0),
        (a / 8, (a * a + a * a) * 9 / 1920 + a * a * 3 / 576),
        (0.0, -(a + a) / 24),
        (0.0, 1.0),
    ):
        sum_ *= s
        sum_ += of_square * x2 + (of_square * y2 + constant)
    sum_ *= np.sqrt(s)
    sum_ *= a
    return sum_


def _potential_corner(X: Array, Y: Array, z: float) -> Array:
    """V; X and Y lie half a side beside the axes."""
    sx, sy = X * X + z * z, Y * Y + z * z
    rho = np.sqrt(sx + Y * Y)
    V: Array = X * np.asinh(Y / np.sqrt(sx)) + Y * np.asinh(X / np.sqrt(sy)) - z * np.atan2(X * Y, z * rho)
    return V
