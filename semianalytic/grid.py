"""Square surface patches that hold the contact.

Patch centres x_i = (i - (n-1)/2) d with n odd, so that the origin is a patch centre. Outside the box no
pressure acts; the convolution is linear, so the box needs a margin for the contact to settle in and no more.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import RectBivariateSpline

__all__ = ["Grid", "carry_over", "odd"]

Array = NDArray[np.floating]


@dataclass(frozen=True)
class Grid:
    """n x n square patches of side d [m], centred at the origin; n odd."""

    n: int
    d: float

    @property
    def x(self) -> Array:
        """Patch centres along one axis [m], shape (n,)."""
        return (np.arange(self.n) - (self.n - 1) / 2) * self.d

    @property
    def half_width(self) -> float:
        """Half the side of the box [m]."""
        return self.n * self.d / 2

    @property
    def radius(self) -> Array:
        """Distance of the patch centres from the origin [m], shape (n, n)."""
        return np.hypot(self.x[:, None], self.x[None, :])

    def sample(self, heights: Array, half_width: float) -> Array:
        """Heights given on m x m patches that fill the square of ``half_width``, at these patch centres.

        Between the given centres a linear interpolation, beyond the last ones the last ones.
        """
        m = heights.shape[0]
        if m == self.n:
            return heights
        given = (np.arange(m) - (m - 1) / 2) * (2 * half_width / m)
        spline = RectBivariateSpline(given, given, heights, kx=1, ky=1)
        x = np.clip(self.x, given[0], given[-1])
        return spline(x, x)


def odd(n: float) -> int:
    """Nearest odd integer, at least 3."""
    return max(3, 2 * int(n // 2) + 1)


def carry_over(pressure: Array, gap: Array, source: Grid, target: Grid, E_star: float) -> Array:
    """Pressure of one grid as a first guess on another, its contact edge between the patches.

    At the edge of a contact p = K sqrt(s) inside, and outside the gap opens as g = 4 K s^(3/2) / (3 E*),
    s the distance. p^2 inside and minus K^2 s outside is therefore smooth across the edge and is what is
    interpolated; K is taken as one for the whole edge.

    pressure [Pa], gap [m] : on the source.  E_star [Pa].  Returns p [Pa] on the target, (n, n); 0 beyond.
    """
    loaded = np.pad(pressure > 0, 1)
    inner = loaded[2:, 1:-1] & loaded[:-2, 1:-1] & loaded[1:-1, 2:] & loaded[1:-1, :-2]
    rim = loaded[1:-1, 1:-1] & ~inner
    # a rim patch lies 0.6 d from the edge on average
    K2 = float(np.mean(pressure[rim] ** 2)) / (0.6 * source.d)
    opening = (np.maximum(gap, 0) * (0.75 * E_star) / np.sqrt(K2)) ** (2 / 3)
    level = np.where(loaded[1:-1, 1:-1], pressure**2, -K2 * opening)
    spline = RectBivariateSpline(source.x, source.x, level, kx=1, ky=1)
    x = np.clip(target.x, source.x[0], source.x[-1])
    guess = np.sqrt(np.maximum(spline(x, x), 0))
    beyond = np.abs(target.x) > source.half_width
    guess[beyond] = 0
    guess[:, beyond] = 0
    return guess
