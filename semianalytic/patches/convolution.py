"""Discrete convolution of patch pressures with influence coefficients by FFT.

DC-FFT (Liu, Wang and Liu, Wear 243 (2000) 101-111): the linear convolution

    u_ij = sum_kl K_(i-k, j-l) p_kl

is a circular one on a domain doubled by zeros. Here K is even in both indices, so its transform is
real, even, and fully held by one quadrant, a cosine transform of the quadrant of K. Pressures even in both
indices need a quarter of the patches, and cosine transforms alone (Martucci, IEEE Trans. Signal Process. 42
(1994) 1038-1051): of an odd number of patches about the centre of the middle one, of an even number about the
border of the middle two.
"""

from collections.abc import Callable

import ducc0
import numpy as np
from numpy.typing import NDArray

from semianalytic import numbers

Array = NDArray[np.floating]
Operator = Callable[[Array], Array]


def good_size(n: int) -> int:
    """Smallest even length >= n that the FFT handles fast."""
    return 2 * int(ducc0.fft.good_size((n + 1) // 2, False))


def even_convolution(kernel: Array, *, quarter: bool = False, threads: int = 1) -> Operator:
    """Linear convolution with a kernel even in both indices.

    kernel : K(i, j) for i, j >= 0, shape (nx, ny), the largest offsets between two patches.
    quarter : p is even about the middle of the nx x ny patches and held on its far side, that included.
    Returns u(p) for p of shape (nx, ny), of a quarter ((nx + 1) // 2, (ny + 1) // 2); u has its shape, units
    K times p. It reuses its work memory: concurrent calls need one operator each.
    """
    nx, ny = kernel.shape
    if quarter:
        # cosines of half-odd frequency change sign over 2 mx patches: what wraps around lands beyond u
        mx, my = (int(ducc0.fft.good_size(n, True)) for n in (nx, ny))
        spectrum: Array = np.zeros((mx, my))
        spectrum[:nx, :ny] = kernel
        ducc0.fft.dct(spectrum, axes=(0, 1), type=3, nthreads=_worth(threads, mx * my), out=spectrum)
        spectrum /= 4 * mx * my
        return _apply_cosines(spectrum, nx, ny, ((4, 4), (3, 2)), threads)
    spectrum = _even_spectrum(kernel, good_size(2 * nx - 1), good_size(2 * ny - 1), threads)
    return _apply_even(spectrum, nx, ny, threads)


def circulant_inverse(kernel: Array, *, quarter: bool = False, threads: int = 1) -> Operator:
    """Inverse of the circular convolution that keeps the near half of the kernel.

    Strang's circulant preconditioner (Stud. Appl. Math. 74 (1986) 171-176): offsets up to half the grid,
    wrapped around; about the inverse FRF, and a quarter of the work of the padded convolution.

    kernel, quarter : as in ``even_convolution``.  Returns a function of r, of the shape of p there.
    """
    nx, ny = kernel.shape
    mx, my = good_size(nx), good_size(ny)
    spectrum = _even_spectrum(kernel[: mx // 2 + 1, : my // 2 + 1], mx, my, threads)
    # truncation can turn eigenvalues negative; true ones do not fall below those of the shortest waves
    floor = 0.5 * np.median(np.abs(spectrum))
    inverse = np.reciprocal(np.maximum(spectrum, floor, out=spectrum), out=spectrum)
    if quarter:
        inverse /= mx * my
        held = inverse[: mx // 2 + nx % 2, : my // 2 + ny % 2]
        return _apply_cosines(held, nx, ny, ((2, 3), (1, 1)), threads)
    return _apply_even(inverse, nx, ny, threads)


def _even_spectrum(kernel: Array, mx: int, my: int, threads: int) -> Array:
    """Transform of the even kernel on a periodic mx x my grid, one quadrant of it."""
    quadrant = np.zeros((mx // 2 + 1, my // 2 + 1))
    quadrant[: kernel.shape[0], : kernel.shape[1]] = kernel
    threads = _worth(threads, quadrant.size)
    return ducc0.fft.dct(quadrant, axes=(0, 1), type=1, nthreads=threads, out=quadrant)


def _worth(threads: int, size: int) -> int:
    """Threads for a transform of this size."""
    return threads if size >= numbers.SHARED else 1


def _apply_cosines(
    spectrum: Array, nx: int, ny: int, types: tuple[tuple[int, int], tuple[int, int]], threads: int
) -> Operator:
    """Multiplication of the cosine transform of a quarter of nx x ny patches by ``spectrum``.

    types : of the transform and of its inverse, along an even number of patches and along an odd one.
    """
    wave = np.empty_like(spectrum, order="C")
    mx, my = (nx + 1) // 2, (ny + 1) // 2
    rows = wave[:mx]
    threads = _worth(threads, wave.size)
    (of_columns, back_columns), (of_rows, back_rows) = types[nx % 2], types[ny % 2]

    def apply(p: Array) -> Array:
        rows[:, :my] = p
        rows[:, my:] = 0
        ducc0.fft.dct(rows, axes=(1,), type=of_rows, nthreads=threads, out=rows)
        wave[mx:] = 0
        ducc0.fft.dct(wave, axes=(0,), type=of_columns, nthreads=threads, out=wave)
        np.multiply(wave, spectrum, out=wave)
        ducc0.fft.dct(wave, axes=(0,), type=back_columns, nthreads=threads, out=wave)
        ducc0.fft.dct(rows, axes=(1,), type=back_rows, nthreads=threads, out=rows)
        return rows[:, :my].copy()

    return apply


def _apply_even(spectrum: Array, nx: int, ny: int, threads: int) -> Operator:
    half = spectrum.shape[0] - 1
    mx, my = 2 * half, 2 * (spectrum.shape[1] - 1)
    spectrum /= mx * my
    threads = _worth(threads, mx * my)
    rows, wave = np.zeros((nx, my)), np.empty((mx, my // 2 + 1), complex)

    def apply(p: Array) -> Array:
        """Transform rows, then columns: neither rows of zeros nor unused rows are transformed."""
        rows[:, :ny] = p
        rows[:, ny:] = 0
        ducc0.fft.r2c(rows, axes=(1,), nthreads=threads, out=wave[:nx])
        wave[nx:] = 0
        ducc0.fft.c2c(wave, axes=(0,), nthreads=threads, out=wave)
        wave[: half + 1] *= spectrum
        wave[half + 1 :] *= spectrum[half - 1 : 0 : -1]
        ducc0.fft.c2c(wave, axes=(0,), forward=False, nthreads=threads, out=wave)
        ducc0.fft.c2r(wave[:nx], axes=(1,), lastsize=my, forward=False, nthreads=threads, out=rows)
        return rows[:, :ny].copy()

    return apply
