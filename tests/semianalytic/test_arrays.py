"""Kernels, convolution and iteration on arrays of another library: array-api-strict, the standard alone."""

import array_api_strict as strict
import numpy as np
import pytest

from semianalytic import arrays, contact, convolution, influence
from semianalytic.arrays import to_numpy
from semianalytic.inputs import Body, Numerics

COATED = Body(((420e9, 0.25, 5e-6), (100e9, 0.3, 1e-6)), (210e9, 0.3), 0.0)
N, D = 40, 1e-6


@pytest.fixture(scope="module")
def kernel():
    return influence.surface_coefficients(N, D, COATED, Numerics())


@pytest.mark.parametrize("d", [1e-7, 1e-6, 1e-4])
@pytest.mark.parametrize("at_once", [arrays.AT_ONCE, 300])
def test_coefficients_are_those_of_numpy_however_they_are_divided(d, at_once, monkeypatch):
    monkeypatch.setattr(arrays, "AT_ONCE", at_once)
    ours = influence.surface_coefficients(N, d, COATED, Numerics())
    theirs = influence.surface_coefficients(N, d, COATED, Numerics(), strict)
    assert to_numpy(theirs) == pytest.approx(ours, rel=1e-12, abs=0)


def test_coefficients_of_another_conversion_are_computed_by_numpy_and_moved():
    numerics = Numerics(conversion="split-fft")
    moved = influence.surface_coefficients(N, D, COATED, numerics, strict)
    assert np.array_equal(to_numpy(moved), influence.surface_coefficients(N, D, COATED, numerics))


@pytest.mark.parametrize("at_once", [arrays.AT_ONCE, 300])
@pytest.mark.parametrize("operator", [convolution.even_convolution, convolution.circulant_inverse])
def test_convolution_is_that_of_numpy_however_it_is_divided(operator, at_once, kernel, monkeypatch):
    monkeypatch.setattr(arrays, "AT_ONCE", at_once)
    K = kernel[:, :31]
    p = np.random.default_rng(0).random(K.shape)
    ours, theirs = operator(K)(p), operator(strict.asarray(K))(strict.asarray(p))
    assert to_numpy(theirs) == pytest.approx(ours, abs=1e-12 * np.abs(ours).max())


@pytest.mark.parametrize("mirror", ["mirror", "reflect"])
@pytest.mark.parametrize("shape", [(30, 20), (4, 20)])  # the second is narrower than the mean is wide
def test_means_are_those_of_scipy(shape, mirror):
    a = np.random.default_rng(0).random(shape)
    for one in (a, a > 0.5):
        ours = arrays.gaussian_mean(one, 1.7, mirror, np.empty(shape))
        theirs = arrays.gaussian_mean(strict.asarray(one), 1.7, mirror, strict.empty(shape))
        assert to_numpy(theirs) == pytest.approx(ours, abs=1e-13)


@pytest.mark.parametrize("n", [7, 8])
def test_median_is_that_of_numpy(n):
    a = np.random.default_rng(0).random((n, 3))
    assert arrays.median(strict.asarray(a)) == np.median(a)


@pytest.mark.parametrize("at_once", [arrays.AT_ONCE, 300])
@pytest.mark.parametrize("control", [{"total": 3e12}, {"approach": 3e-7}])
def test_iteration_takes_the_steps_of_numpy(control, at_once, kernel, monkeypatch):
    monkeypatch.setattr(arrays, "AT_ONCE", at_once)
    x = (np.arange(N) - (N - 1) / 2) * D
    gap = (x[:, None] ** 2 + x[None, :] ** 2) / 4e-4 + 2e-8 * np.random.default_rng(0).random((N, N))

    def solved(xp):
        K, g0 = xp.asarray(kernel), xp.asarray(gap)
        deflection, precondition = convolution.even_convolution(K), convolution.circulant_inverse(K)
        return contact.solve(
            deflection,
            g0,
            start=xp.asarray(np.maximum(1e-7 - gap, 0) * 1e15),
            precondition=precondition,
            scale=1e-7,
            tolerance=1e-10,
            max_iterations=100,
            **control,
        )

    ours, theirs = solved(np), solved(strict)
    assert theirs.iterations == ours.iterations > 5
    assert theirs.convolutions == ours.convolutions
    assert theirs.approach == pytest.approx(ours.approach, rel=1e-10)
    assert to_numpy(theirs.pressure) == pytest.approx(ours.pressure, abs=1e-10 * ours.pressure.max())
