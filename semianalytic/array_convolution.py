"""The convolution of ``convolution`` by the FFT of another array library than NumPy.

The same transforms: rows, then columns, neither rows of zeros nor unused rows, and of an even kernel one
quadrant of its real spectrum. Rows and columns are transformed by strips, which bounds the work memory.
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from semianalytic.arrays import median, namespace, strips

__all__ = ["apply_even", "even_spectrum", "reciprocal"]

Array = NDArray[np.floating]


def even_spectrum(kernel: Array, mx: int, my: int) -> Array:
    """Transform of the even kernel on a periodic mx x my grid, one quadrant of it."""
    xp = namespace(kernel)
    nx, ny = kernel.shape
    quadrant: Array = xp.zeros((mx // 2 + 1, my // 2 + 1))
    quadrant[:nx, :ny] = kernel

    def cosines(part: Array, m: int, axis: int) -> Array:
        wave: Array = xp.fft.hfft(xp.asarray(part, dtype=xp.complex128), n=m, axis=axis)
        return wave[:, : m // 2 + 1] if axis else wave[: m // 2 + 1, :]

    for rows in strips(mx // 2 + 1, my, xp):
        quadrant[rows, :] = cosines(quadrant[rows, :], my, 1)
    for columns in strips(my // 2 + 1, mx, xp):
        quadrant[:, columns] = cosines(quadrant[:, columns], mx, 0)
    return quadrant


def reciprocal(spectrum: Array) -> Array:
    """1 / spectrum, none of it above twice the median."""
    xp = namespace(spectrum)
    floor = 0.5 * median(xp.abs(spectrum))
    return 1.0 / xp.maximum(spectrum, floor)


def apply_even(spectrum: Array, nx: int, ny: int) -> Callable[[Array], Array]:
    """Convolution of arrays (nx, ny), padded by zeros, with the kernel of ``even_spectrum``."""
    xp = namespace(spectrum)
    half, width = spectrum.shape[0] - 1, spectrum.shape[1]
    mx, my = 2 * half, 2 * (width - 1)

    def apply(p: Array) -> Array:
        wave = xp.empty((nx, width), dtype=xp.complex128)
        for rows in strips(nx, my, xp):
            wave[rows, :] = xp.fft.rfft(p[rows, :], n=my, axis=1)
        for columns in strips(width, mx, xp):
            column = xp.fft.fft(wave[:, columns], n=mx, axis=0)
            column[: half + 1, :] *= spectrum[:, columns]
            column[half + 1 :, :] *= spectrum[half - 1 : 0 : -1, columns]
            wave[:, columns] = xp.fft.ifft(column, axis=0)[:nx, :]
        u: Array = xp.empty((nx, ny))
        for rows in strips(nx, my, xp):
            u[rows, :] = xp.fft.irfft(wave[rows, :], n=my, axis=1)[:, :ny]
        return u

    return apply
