"""Square surface patches of the contact.

Patch centres x_i = (i - (n-1)/2) d; with n odd the origin is a patch centre, with n even a corner of four.
Outside the grid no pressure acts; the convolution is linear, so the grid, or the window of it in use, only
needs a margin for the contact to change during the iteration. Fields even in x and in y are held on a quarter
of the grid.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.floating]


@dataclass(frozen=True)
class Grid:
    """n x n square patches of side d [m], centred at the origin.

    quarter : fields are even in x and in y and held on the patches x >= 0, y >= 0 alone.
    """

    n: int
    d: float
    quarter: bool = False

    @property
    def x(self) -> Array:
        """Centres along one axis of the patches held [m], shape (n,), of a quarter ((n + 1) // 2,)."""
        x = (np.arange(self.n) - (self.n - 1) / 2) * self.d
        return x[self.n // 2 :] if self.quarter else x

    @property
    def half_width(self) -> float:
        """Half the side of the box [m]."""
        return self.n * self.d / 2

    @cached_property
    def radius(self) -> Array:
        """Distance of the patch centres held from the origin [m]."""
        return np.hypot(self.x[:, None], self.x[None, :])

    def weight(self, shape: tuple[int, ...]) -> Array | None:
        """Patches that each one held represents: of a quarter 1 at the origin, 2 on the axes, 4 elsewhere.

        shape : of a window, of a quarter one that begins at the axes.  None of a whole grid.
        """
        if not self.quarter:
            return None
        w = np.where(self.x > 0, 2.0, 1.0)
        return np.outer(*(w[:m] for m in shape))

    def force(self, pressure: Array) -> float:
        """Force of a pressure on a window of the patches held [N]."""
        w = self.weight(pressure.shape)
        return float(np.sum(pressure if w is None else w * pressure)) * self.d**2

    @property
    def window(self) -> "Window":
        """All the patches held."""
        m = len(self.x)
        return Window(0, m, 0, m)

    def across(self, window: "Window") -> "Window":
        """A window on all n x n patches, of one on those held: of a quarter with its mirror images."""
        if not self.quarter:
            return window
        first = self.n // 2 + self.n % 2
        return Window(first - window.i1, self.n // 2 + window.i1, first - window.j1, self.n // 2 + window.j1)

    def whole_centres(self, window: "Window") -> tuple[Array, Array]:
        """x and y [m] of the patches of a field made ``whole``."""
        across, grid = self.across(window), Grid(self.n, self.d)
        rows, columns = across.slices
        return grid.x[rows], grid.x[columns]

    def held(self, field: Array) -> Array:
        """The part that is held of a field on all n x n patches."""
        c = self.n // 2
        return field[c:, c:] if self.quarter else field

    def whole(self, field: Array) -> Array:
        """A field on all n x n patches, of one held on a window that begins at the axes of a quarter."""
        if not self.quarter:
            return field
        mx, my = (m - self.n % 2 for m in field.shape)
        whole = np.empty((mx + len(field), my + field.shape[1]))
        whole[mx:, my:] = field
        whole[mx:, :my] = field[:, ::-1][:, :my]
        whole[:mx] = whole[::-1][:mx]
        return whole

    def ringed(self, field: NDArray[Any]) -> NDArray[Any]:
        """A field with one more patch all around: 0 beyond the grid, mirrored at the axes of a quarter."""
        nx, ny = field.shape
        ringed: NDArray[Any] = np.zeros((nx + 2, ny + 2), dtype=field.dtype)
        ringed[1:-1, 1:-1] = field
        if self.quarter:
            image = 1 + self.n % 2
            ringed[0, :] = ringed[image, :]
            ringed[:, 0] = ringed[:, image]
        return ringed


def odd(n: float) -> int:
    """Nearest odd integer, at least 3."""
    return max(3, 2 * int(n // 2) + 1)


@dataclass(frozen=True)
class Window:
    """Patches i0 <= i < i1, j0 <= j < j1 of a grid."""

    i0: int
    i1: int
    j0: int
    j1: int

    @property
    def slices(self) -> tuple[slice, slice]:
        return slice(self.i0, self.i1), slice(self.j0, self.j1)

    @property
    def shape(self) -> tuple[int, int]:
        return self.i1 - self.i0, self.j1 - self.j0


def window_around(pressure: Array, source: Grid, target: Grid) -> Window:
    """Patches of the target that the contact on the source may extend to: 4 % and 3 patches beyond it."""
    edges = []
    for axis in (1, 0):
        loaded = source.x[np.any(pressure > 0, axis=axis)]
        low, high = loaded[0], loaded[-1]
        if target.quarter:
            high = max(-low, high)
            low = -high
        margin = 0.04 * (high - low) / 2 + 3 * source.d
        first = int(np.floor((low - margin - target.x[0]) / target.d))
        last = int(np.ceil((high + margin - target.x[0]) / target.d))
        edges += [max(first, 0), min(last, len(target.x) - 1) + 1]
    return Window(*edges)


def prolong(pressure: Array, gap: Array, source: Grid, target: Grid, window: Window, E_star: float) -> Array:
    """Pressure of one grid as a first guess on another, its contact edge between the patches.

    At the edge of a contact p = K sqrt(s) inside, and outside the gap opens as g = 4 K s^(3/2) / (3 E*),
    s the distance. p^2 inside and minus K^2 s outside is therefore smooth across the edge and is
    interpolated, with one K for the whole edge.

    pressure [Pa], gap [m] : on the source.  window : of the target.  E_star [Pa].
    Returns p [Pa] on the window; 0 beyond the source.
    """
    loaded = source.ringed(pressure > 0)
    inner = loaded[2:, 1:-1] & loaded[:-2, 1:-1] & loaded[1:-1, 2:] & loaded[1:-1, :-2]
    beside = loaded[:-2, :] | loaded[1:-1, :] | loaded[2:, :]
    beside = beside[:, :-2] | beside[:, 1:-1] | beside[:, 2:]
    loaded = loaded[1:-1, 1:-1]
    # a rim patch lies 0.6 d from the edge on average
    rim = loaded & ~inner
    weight = source.weight(rim.shape)
    squares = pressure[rim] ** 2
    K2 = float(np.mean(squares) if weight is None else np.average(squares, weights=weight[rim]))
    K2 /= 0.6 * source.d
    level = pressure**2
    # patches not next to a loaded one are never interpolated with one: any value that is not positive serves
    beside &= ~loaded
    level[beside] = -K2 * (np.maximum(gap[beside], 0.0) * (0.75 * E_star) / K2**0.5) ** (2 / 3)
    rows, columns = window.slices
    level = _linear(_linear(level, source, target.x[rows]).T, source, target.x[columns])
    return np.sqrt(np.maximum(level, 0.0)).T


def touches_rim(pressure: Array, quarter: bool = False, rings: int = 1) -> bool:
    """Whether a patch of the outermost ``rings`` is loaded; two sides of a ``quarter`` belong to them."""
    rim = (pressure[-rings:, :], pressure[:, -rings:], pressure[:rings, :], pressure[:, :rings])
    return any(bool(np.any(side > 0)) for side in rim[: 2 if quarter else 4])


def _linear(values: Array, source: Grid, x: Array) -> Array:
    """Linear interpolation along the first index, from the patch centres of the source to x; 0 beyond it."""
    n = len(values)
    at = np.clip((x - source.x[0]) / source.d, 0, n - 1)
    i = np.minimum(at.astype(int), n - 2)
    t = (at - i)[:, None]
    result: Array = values[i] * (1 - t) + values[i + 1] * t
    result[: np.searchsorted(x, -source.half_width), :] = 0.0
    result[np.searchsorted(x, source.half_width, side="right") :, :] = 0.0
    return result
