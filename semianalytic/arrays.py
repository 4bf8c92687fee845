"""Functions of large arrays by blocks, so that temporary arrays stay in the cache."""

from collections.abc import Iterator
from functools import lru_cache
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import correlate1d

Array = NDArray[np.floating]
Mirror = Literal["mirror", "reflect"]

BLOCK = 2**15  # numbers that stay in the cache


def strips(count: int, length: int) -> Iterator[slice]:
    """Slices of ``count`` rows or columns of a ``length``, of ``BLOCK`` numbers at most."""
    size = max(1, BLOCK // max(length, 1))
    return (slice(i, min(i + size, count)) for i in range(0, count, size))


def blocks(a: NDArray[Any]) -> Iterator[tuple[slice, slice]]:
    """Rows of an array, ``BLOCK`` numbers at most."""
    return ((rows, slice(None)) for rows in strips(*a.shape))


def subtract(a: Array, b: Array, factor: float) -> None:
    """a - factor b, in place of a."""
    for rows in blocks(a):
        a[rows] -= b[rows] * factor


def total(a: Array, weight: Array | None = None) -> float:
    """Sum of all a, or of weight a."""
    if weight is None:
        return float(np.sum(a, dtype=np.float64))
    return float(np.einsum("ij,ij->", a, weight))


def dot(a: Array, b: Array, weight: Array | None = None) -> float:
    """Sum of all a b, or of weight a b."""
    # not by BLAS: its threads keep spinning after such a short sum and slow those of the FFT
    return float(
        np.einsum("ij,ij->", a, b, dtype=float) if weight is None else np.einsum("ij,ij,ij->", a, b, weight)
    )


@lru_cache
def _gaussian(sigma: float) -> Array:
    reach = int(3 * sigma + 0.5)
    weight = np.exp(-0.5 * (np.arange(-reach, reach + 1) / sigma) ** 2)
    return np.asarray(weight / weight.sum())


def gaussian_mean(a: NDArray[Any], sigma: float, mirror: Mirror, out: Array) -> Array:
    """Means of a weighted by a Gaussian of ``sigma`` entries, cut off at three.

    mirror : of a at the rim, as in ``scipy.ndimage``: about an entry, or about the border.
    """
    weight = _gaussian(sigma)
    correlate1d(a, weight, axis=0, output=out, mode=mirror)
    correlate1d(out, weight, axis=1, output=out, mode=mirror)
    return out
