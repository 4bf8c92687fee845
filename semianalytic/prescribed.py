"""Prescribed pressure on a disc, on patches and as a function of the distance from the axis."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from semianalytic.ring_quadrature import gauss_legendre

Array = NDArray[np.floating]

JUMP = 1e-4  # change of the pressure at one radius, over its largest magnitude, that counts as a jump


@dataclass(frozen=True, eq=False)
class Prescribed:
    """Any pressure p(r) [Pa] on a disc of ``radius`` [m]; ``load`` is its integral [N], by Gauss points.

    The points are crowded at the rim, where p may fall like a square root.
    Raises ValueError where the function gives no finite pressure.
    """

    radius: float
    function: Callable[[Array], Array]

    def pressure(self, r: ArrayLike) -> Array:
        """p(r) [Pa], 0 outside; shape of ``r`` [m]."""
        r = np.asarray(r, dtype=float)
        value = np.zeros(r.shape)
        inside = r <= self.radius
        value[inside] = self.function(r[inside])
        return value

    @cached_property
    def singular_radii(self) -> tuple[float, ...]:
        """Radii [m] at which p jumps or is not finite, where the stress of the surface has no value.

        Halving the interval of the larger change, from 1024 intervals on, leaves a change only at a jump; of
        two jumps in one interval the larger is found.
        """
        low, high = np.arange(1024) / 1024 * self.radius, np.arange(1, 1025) / 1024 * self.radius
        with np.errstate(all="ignore"):
            ends = np.abs(self.pressure(np.array([0.0, self.radius])))
            p_low, p_high = self.pressure(low), self.pressure(high)
            size = np.max(np.abs(p_low)[1:])
            for _ in range(44):
                middle = (low + high) / 2
                p = self.pressure(middle)
                left = ~(np.abs(p_high - p) > np.abs(p - p_low))
                high, p_high = np.where(left, middle, high), np.where(left, p, p_high)
                low, p_low = np.where(left, low, middle), np.where(left, p_low, p)
            inside = high[np.abs(p_high - p_low) > JUMP * size]
        rim = [self.radius] if not ends[1] <= JUMP * size else []
        return (*([] if np.isfinite(ends[0]) else [0.0]), *map(float, np.unique(inside)), *rim)

    def of_square(self, square: Array) -> Array:
        """p [Pa] of the square of r [m^2]."""
        return self.pressure(np.sqrt(square))

    @property
    def load(self) -> float:
        t, w = gauss_legendre(200)
        r = self.radius * (1 - t**2)
        p = np.asarray(self.function(r), dtype=float)
        if p.shape != r.shape or not np.all(np.isfinite(p)):
            raise ValueError("pressure(r) must return a finite value [Pa] for every r <= load_radius")
        return float(4 * np.pi * self.radius * np.sum(w * p * r * t))


def patch_mean(shape: Prescribed, x: Array, d: float) -> Array:
    """Mean of an axisymmetric pressure over square patches of side d centred at (x_i, x_j), shape (n, n).

    Gauss points; near the rim along lines that end at it, crowded there for the square root. The remaining
    error of the load, about 1e-7, is removed at the rim patches.

    x : centres [m], symmetric, n odd.
    """
    c = len(x) // 2
    i, j = np.tril_indices(c + 1)
    X, Y = x[c + i], x[c + j]
    r = np.hypot(X, Y)
    near = np.abs(r - shape.radius) < 3 * d
    inner = ~near & (r < shape.radius)
    mean = np.zeros(r.shape)
    s, w = gauss_legendre(3, -0.5, 0.5)
    distance = np.hypot(X[inner, None, None] + s[:, None] * d, Y[inner, None, None] + s * d)
    mean[inner] = np.einsum("pij,i,j->p", shape.pressure(distance), w, w)
    s, w = gauss_legendre(12)
    y = Y[near, None] + (s - 0.5) * d
    # X >= Y: the rim is crossed by lines along x, which end at X + d/2 or at the rim
    start = X[near, None] - d / 2
    rim = np.sqrt(np.maximum(shape.radius**2 - y**2, 0))
    length = np.clip(rim - start, 0, d)
    along = (start + length)[..., None] - length[..., None] * s**2
    # rounding must not put the end of a line beyond the rim
    reach = np.where(length < d, shape.radius, np.inf)[..., None]
    value = shape.pressure(np.minimum(np.hypot(along, y[..., None]), reach))
    mean[near] = np.einsum("pjk,pj,j,k->p", value, length, w, 2 * s * w) / d
    number = np.where(j == 0, 4, np.where(i == j, 4, 8)) - 3 * (i == 0)  # of equal patches by symmetry
    at_rim = float(np.sum((number * mean)[near]))
    if at_rim:
        mean[near] *= 1 + (shape.load / d**2 - float(np.sum(number * mean))) / at_rim
    quadrant = np.zeros((c + 1, c + 1))
    quadrant[i, j] = quadrant[j, i] = mean
    return np.pad(quadrant, ((c, 0), (c, 0)), mode="reflect")


def deconvolve(mean: Array) -> Array:
    """Constant patches equivalent to a pressure of these patch means: p - (d^2/12) laplacian(p).

    The means lack the second moment of the pressure in the patch, d^2/24, and constant patches once more.
    """
    q = np.pad(mean, 1)
    around = q[2:, 1:-1] + q[:-2, 1:-1] + q[1:-1, 2:] + q[1:-1, :-2]
    return mean - (around - 4 * mean) / 12
