"""DC-FFT against direct summation."""

import numpy as np
import pytest

from semianalytic import numbers
from semianalytic.patches import convolution

RNG = np.random.default_rng(7)


@pytest.mark.parametrize("shape", [(9, 9), (8, 13), (31, 6)])
@pytest.mark.parametrize("threads", [1, 2])
def test_convolution_is_the_direct_sum(shape, threads):
    nx, ny = shape
    kernel, p = RNG.normal(size=shape), RNG.normal(size=shape)
    i, j = np.arange(nx), np.arange(ny)
    full = kernel[np.abs(i[:, None] - i)[:, :, None, None], np.abs(j[:, None] - j)[None, None]]
    direct = np.einsum("ikjl,kl->ij", full, p)
    u = convolution.even_convolution(kernel, threads=threads)(p)
    # rounding of a few hundred terms of order one
    np.testing.assert_allclose(u, direct, rtol=0, atol=1e-11)


@pytest.mark.parametrize("build", [convolution.even_convolution, convolution.circulant_inverse])
@pytest.mark.parametrize("shape", [(9, 9), (33, 21), (8, 8), (34, 22), (33, 22)])
def test_quarter_is_that_of_the_whole(build, shape):
    i, j = (np.arange(n) for n in shape)
    kernel = 1 / (1 + np.hypot(i[:, None], j))
    c = [n // 2 for n in shape]
    p = RNG.normal(size=[n - k for n, k in zip(shape, c, strict=True)])
    even = p
    for axis, n in enumerate(shape):
        width = [(0, 0), (0, 0)]
        width[axis] = (n // 2, 0)
        even = np.pad(even, width, mode="reflect" if n % 2 else "symmetric")
    whole = build(kernel)(even)[c[0] :, c[1] :]
    np.testing.assert_allclose(
        build(kernel, quarter=True)(p), whole, rtol=0, atol=1e-13 * np.abs(whole).max()
    )


def test_nothing_wraps_around():
    kernel, p = np.ones((16, 16)), np.zeros((16, 16))
    kernel[8:] = 0
    p[0, 0] = 1
    u = convolution.even_convolution(kernel)(p)
    # a circular convolution would bring the near rows back at the far end
    np.testing.assert_allclose(u[8:], 0, atol=1e-14)
    np.testing.assert_allclose(u[:8], 1, rtol=0, atol=1e-14)


def test_a_later_call_leaves_what_an_earlier_one_returned():
    A = convolution.even_convolution(RNG.normal(size=(12, 12)))
    p, q = RNG.normal(size=(2, 12, 12))
    first = A(p)
    kept = first.copy()
    A(q)
    np.testing.assert_array_equal(first, kept)
    np.testing.assert_array_equal(A(p), kept)


def test_a_second_thread_changes_no_more_than_rounding():
    n = 320  # so that the transforms are large enough to be shared between threads
    assert convolution.good_size(2 * n - 1) ** 2 > numbers.SHARED
    kernel, p = RNG.normal(size=(2, n, n))
    for build in (convolution.even_convolution, convolution.circulant_inverse):
        one, two = build(kernel, threads=1)(p), build(kernel, threads=2)(p)
        np.testing.assert_allclose(two, one, rtol=0, atol=1e-14 * np.abs(one).max())


def test_convolution_is_symmetric():
    r = np.hypot(*np.meshgrid(np.arange(21), np.arange(21)))
    A = convolution.even_convolution(1 / (1 + r))
    p, q = RNG.normal(size=(2, 21, 21))
    # Maxwell's reciprocity: the work of p on the deflection of q and the other way round
    assert np.vdot(p, A(q)) == pytest.approx(np.vdot(q, A(p)), rel=1e-12)


def test_circulant_inverse_undoes_a_short_kernel():
    kernel = np.zeros((24, 24))
    kernel[0, 0], kernel[1, 0], kernel[0, 1] = 1.0, 0.05, 0.05
    r = np.zeros((24, 24))
    r[8:16, 8:16] = RNG.normal(size=(8, 8))
    z = convolution.circulant_inverse(kernel)(r)
    # the inverse of so short a kernel has died by 0.1^8 at the boundary, where circulant and linear differ
    np.testing.assert_allclose(
        convolution.even_convolution(kernel)(z)[4:20, 4:20], r[4:20, 4:20], rtol=0, atol=1e-7
    )


@pytest.mark.parametrize("n", [1, 2, 7, 101, 513, 1025, 4097])
def test_good_size_is_even_and_near(n):
    m = convolution.good_size(n)
    assert m % 2 == 0
    assert n <= m <= max(1.15 * n, n + 4)
