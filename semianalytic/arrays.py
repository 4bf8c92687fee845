"""Array functions that NumPy does not share with other libraries.

The convolution, the kernels and the iteration use functions of the Python array API standard, whose namespace
is that of their arrays: a GPU computes on arrays of CuPy. Arrays are written in place, so they have to be
mutable. Where the standard lacks a function, or NumPy has a faster one, it is here.
"""

import sys
from collections.abc import Iterator
from functools import lru_cache
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import correlate1d

__all__ = [
    "Mirror",
    "at_once",
    "blocks",
    "check_namespace",
    "copy",
    "dot",
    "gaussian_mean",
    "masked",
    "median",
    "namespace",
    "strips",
    "subtract",
    "take_rows",
    "to_numpy",
    "total",
]

Array = NDArray[np.floating]
Mask = NDArray[np.bool_]
Mirror = Literal["mirror", "reflect"]

BLOCK = 2**15  # numbers that stay in the cache
TRANSFORMS = ("rfft", "irfft", "fft", "ifft", "hfft")
AT_ONCE = 2**26  # of another library: half a gigabyte


def namespace(a: Any) -> Any:
    """The module of functions for an array: that of NumPy for whatever is no array of another library."""
    if isinstance(a, np.ndarray):
        return np
    if hasattr(a, "__array_namespace__"):
        return a.__array_namespace__()
    if hasattr(a, "__cuda_array_interface__"):  # of CuPy, whose arrays do not name it
        return sys.modules[type(a).__module__.partition(".")[0]]
    return np


def check_namespace(xp: Any) -> None:
    """Raise ValueError for a namespace without Fourier transforms, or whose arrays cannot be written."""
    name, numpy = getattr(xp, "__name__", repr(xp)), "give heights of NumPy, which computes without it"
    lacking = [f"fft.{one}" for one in TRANSFORMS if not hasattr(getattr(xp, "fft", None), one)]
    if lacking:
        raise ValueError(f"the array library {name} lacks {', '.join(lacking)}; {numpy}")
    try:
        xp.zeros((1, 1), dtype=xp.float64)[0, 0] = 1.0
    except (AttributeError, TypeError) as error:
        raise ValueError(
            f"arrays of {name} of double precision cannot be written ({error}); {numpy}"
        ) from None


def to_numpy(a: Any) -> NDArray[Any]:
    """An array of any library as one of NumPy, itself where it is one."""
    if isinstance(a, np.ndarray):
        return a
    return a.get() if hasattr(a, "get") else np.array(np.from_dlpack(a))


def copy(a: Array, dtype: Any = None) -> Array:
    """A copy of an array, by rows."""
    same: Array = namespace(a).empty(a.shape, dtype=dtype or a.dtype)
    same[...] = a
    return same


def take_rows(a: Array, i: NDArray[np.intp]) -> Array:
    """The rows i of an array."""
    xp = namespace(a)
    return a[i] if xp is np else xp.take(a, xp.asarray(i), axis=0)  # the other one copies a transposed one


def at_once(xp: Any) -> int:
    """Numbers that a namespace computes at a time: NumPy as many as stay in the cache."""
    return BLOCK if xp is np else AT_ONCE


def strips(count: int, length: int, xp: Any) -> Iterator[slice]:
    """Slices of ``count`` rows or columns of a ``length``, of ``at_once`` numbers at most."""
    size = max(1, at_once(xp) // max(length, 1))
    return (slice(i, min(i + size, count)) for i in range(0, count, size))


def blocks(a: NDArray[Any]) -> Iterator[tuple[slice, slice]]:
    """Rows of an array, ``at_once`` numbers at most, so that temporary arrays are small."""
    return ((rows, slice(None)) for rows in strips(a.shape[0], a.shape[1], namespace(a)))


def subtract(a: Array, b: Array, factor: float) -> None:
    """a - factor b, in place of a."""
    for rows in blocks(a):
        a[rows] -= b[rows] * factor


def masked(a: Array, mask: Mask, out: Array) -> None:
    """a where the mask is true, 0 elsewhere."""
    if isinstance(a, np.ndarray):
        np.multiply(a, mask, out=out)
    else:
        out[...] = namespace(a).where(mask, a, 0.0)


def total(a: Array, weight: Array | None = None) -> float:
    """Sum of all a, or of weight a."""
    if weight is None:
        xp = namespace(a)
        return float(xp.sum(a, dtype=xp.float64))
    return float(np.einsum("ij,ij->", a, weight))


def dot(a: Array, b: Array, weight: Array | None = None) -> float:
    """Sum of all a b, or of weight a b."""
    if not isinstance(a, np.ndarray):
        return sum(total(a[rows] * b[rows]) for rows in blocks(a))
    # not by BLAS: its threads keep spinning after such a short sum and slow those of the FFT
    return float(
        np.einsum("ij,ij->", a, b, dtype=float) if weight is None else np.einsum("ij,ij,ij->", a, b, weight)
    )


def median(a: Array) -> float:
    """Median of all entries."""
    if isinstance(a, np.ndarray):
        return float(np.median(a))
    xp = namespace(a)
    ordered = xp.sort(xp.reshape(a, (-1,)))
    n = ordered.shape[0]
    return (float(ordered[(n - 1) // 2]) + float(ordered[n // 2])) / 2


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
    if isinstance(a, np.ndarray):
        correlate1d(a, weight, axis=0, output=out, mode=mirror)
        correlate1d(out, weight, axis=1, output=out, mode=mirror)
        return out
    xp, reach = namespace(a), weight.size // 2
    out[...] = xp.asarray(a, dtype=out.dtype)
    for axis, n in enumerate(a.shape):
        period = max(2 * n - 2, 1) if mirror == "mirror" else 2 * n
        at = np.arange(-reach, n + reach) % period
        at = np.minimum(at, 2 * n - 2 + (mirror == "reflect") - at)
        wide = xp.take(out, xp.asarray(at), axis=axis)
        out[...] = 0.0
        for k, factor in enumerate(weight.tolist()):
            out += (wide[k : k + n, :] if axis == 0 else wide[:, k : k + n]) * factor
    return out
