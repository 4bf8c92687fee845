"""Even convolution of a large grid in half the memory of ``convolution``.

Steps of single precision are transformed as there, in memory of single precision. A pressure of double
precision fits the same memory by halves. Its rows, padded from M to 2 M, have even frequencies, those of the
rows of M without padding, and odd ones: with c_n = (p_n - i p_(n + M/2)) exp(-i pi n / M), n < M/2,

    P_(4m + 1) = sum_n c_n exp(-4 pi i n m / M),    P_(2M - f) = conj(P_f),

so that a complex transform of M/2 holds all of them. The linear convolution is the mean of the circular one
that the even frequencies give and of the skew-circular one of the odd ones.
"""

from collections.abc import Callable, Iterator

import ducc0
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.floating]
Wave = NDArray[np.complexfloating]

BLOCK = (
    2**15
)  # numbers of the rows, or the columns, transformed at a time by a thread: they stay in the cache


def memory_size(nx: int, my: int) -> int:
    """Numbers of single precision that the operator uses: rows transformed in single precision, or halves."""
    return 2 * nx * (my // 2 + 2)


def apply_even(spectrum: Array, nx: int, ny: int, threads: int, memory: Array) -> Callable[..., Array]:
    """Convolution of arrays (nx, ny), padded by zeros, with the kernel of ``spectrum``, one quadrant of it.

    memory : of single precision, ``memory_size``.  Returns u(p, out=None): of single precision a part of the
    memory, lost with its next use; of double precision in ``out``, which may not be p.
    """
    half, M = spectrum.shape[0] - 1, spectrum.shape[1] - 1
    mx = 2 * half
    spectrum /= 2 * mx * M
    height, strip = max(1, BLOCK * threads // (2 * M)), max(16, BLOCK * threads // mx)
    odd = np.arange(1, 2 * M, 4)
    odd = np.minimum(odd, 2 * M - odd)
    twiddle = np.exp(-1j * np.pi / M * np.arange(M // 2))

    def columns(wave: Wave, frequencies: NDArray[np.intp]) -> None:
        column_of = np.empty((mx, strip), wave.dtype)
        for j in range(0, wave.shape[1], strip):
            part = wave[:, j : j + strip]
            column = column_of[:, : part.shape[1]]
            factor = spectrum[:, frequencies[j : j + strip]].astype(column.real.dtype)
            column[:nx] = part
            column[nx:] = 0
            ducc0.fft.c2c(column, axes=(0,), nthreads=threads, out=column)
            column[: half + 1] *= factor
            column[half + 1 :] *= factor[half - 1 : 0 : -1]
            ducc0.fft.c2c(column, axes=(0,), forward=False, nthreads=threads, out=column)
            part[:] = column[:nx]

    def rows(p: Array, length: int) -> Iterator[tuple[slice, Array]]:
        padded = np.empty((height, length), p.dtype)
        for i in range(0, nx, height):
            block = slice(i, min(i + height, nx))
            yield block, padded[: block.stop - i]

    def real(p: Array, out: Array, length: int) -> None:
        """Rows of a ``length`` by their real transform."""
        dtype = np.result_type(p, 1j)
        width = length // 2 + 1
        wave = memory.view(p.dtype)[: 2 * nx * width].view(dtype).reshape(nx, width)
        for block, padded in rows(p, length):
            padded[:, :ny] = p[block]
            padded[:, ny:] = 0
            ducc0.fft.r2c(padded, axes=(1,), nthreads=threads, out=wave[block])
        columns(wave, np.arange(width) * (2 * M // length))
        for block, padded in rows(p, length):
            ducc0.fft.c2r(
                wave[block], axes=(1,), lastsize=length, forward=False, nthreads=threads, out=padded
            )
            out[block] = padded[:, :ny]

    def add_odd(p: Array, out: Array) -> None:
        """Odd frequencies of rows of 2 M."""
        wave = memory.view(p.dtype)[: nx * M].view(complex).reshape(nx, M // 2)
        for block, padded in rows(p, M):
            padded[:, :ny] = p[block]
            padded[:, ny:] = 0
            of_block = wave[block]
            np.multiply(padded[:, M // 2 :], -1j, out=of_block)
            of_block += padded[:, : M // 2]
            of_block *= twiddle
            ducc0.fft.c2c(of_block, axes=(1,), nthreads=threads, out=of_block)
        columns(wave, odd)
        for block, padded in rows(p, M):
            of_block = wave[block]
            ducc0.fft.c2c(of_block, axes=(1,), forward=False, nthreads=threads, out=of_block)
            of_block *= 2 * twiddle.conj()
            padded[:, : M // 2] = of_block.real
            np.negative(of_block.imag, out=padded[:, M // 2 :])
            out[block] += padded[:, :ny]

    def apply(p: Array, out: Array | None = None) -> Array:
        if p.dtype == np.float32:
            out = memory[: nx * ny].reshape(nx, ny)
            real(p, out, 2 * M)
            return out
        out = np.empty((nx, ny)) if out is None else out
        real(p, out, M)
        add_odd(p, out)
        return out

    return apply
