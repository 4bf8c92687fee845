"""Contacts on arrays of another library: array-api-strict, which has the functions of the standard alone."""

from types import SimpleNamespace

import array_api_strict as strict
import numpy as np
import pytest
from scipy.ndimage import gaussian_filter

import semianalytic
from semianalytic import arrays, contact, convolution, influence
from semianalytic.arrays import to_numpy
from semianalytic.inputs import Body, Numerics

COATED = Body(((420e9, 0.25, 5e-6), (100e9, 0.3, 1e-6)), (210e9, 0.3), 0.0)
N, D = 40, 1e-6


@pytest.fixture(autouse=True)
def _no_implicit_conversion(monkeypatch):
    """Its arrays, like those on a GPU, become arrays of NumPy only where the code converts them."""

    def refused(*_, **__):
        raise TypeError("implicit conversion to an array of NumPy")

    for name in ("__array__", "__buffer__"):
        monkeypatch.setattr(type(strict.zeros(1)), name, refused, raising=False)


@pytest.fixture(scope="module")
def kernel():
    return influence.surface_coefficients(N, D, COATED, Numerics())


@pytest.mark.parametrize("d", [1e-7, 1e-6, 1e-4])
@pytest.mark.parametrize("at_once", [arrays.AT_ONCE, 900])
def test_coefficients_are_those_of_numpy_however_they_are_divided(d, at_once, monkeypatch):
    monkeypatch.setattr(arrays, "AT_ONCE", at_once)
    ours = influence.surface_coefficients(N, d, COATED, Numerics())
    theirs = influence.surface_coefficients(N, d, COATED, Numerics(), strict)
    assert to_numpy(theirs) == pytest.approx(ours, rel=1e-12, abs=0)


def test_coefficients_of_another_conversion_are_computed_by_numpy_and_moved():
    numerics = Numerics(conversion="split-fft")
    moved = influence.surface_coefficients(9, D, COATED, numerics, strict)
    assert np.array_equal(to_numpy(moved), influence.surface_coefficients(9, D, COATED, numerics))


@pytest.mark.parametrize("at_once", [arrays.AT_ONCE, 900])
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
        expected = gaussian_filter(one.astype(float), 1.7, mode=mirror, truncate=3)
        for xp in (np, strict):
            mean = arrays.gaussian_mean(xp.asarray(one), 1.7, mirror, xp.empty(shape))
            assert to_numpy(mean) == pytest.approx(expected, abs=1e-13)


@pytest.mark.parametrize("n", [7, 8])
def test_median_is_that_of_numpy(n):
    a = np.random.default_rng(0).random((n, 3))
    assert arrays.median(strict.asarray(a)) == np.median(a)


@pytest.mark.parametrize("at_once", [arrays.AT_ONCE, 900])
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


def rough(n):
    """Heights [m] on n x n patches with slopes of many wavelengths."""
    k = np.hypot(*np.meshgrid(np.fft.fftfreq(n), np.fft.fftfreq(n)))
    noise = np.fft.fft2(np.random.default_rng(1).standard_normal((n, n)))
    z = np.fft.ifft2(noise / (k**2 + 1e-3) ** 0.9).real
    return 2e-8 * z / z.std()


def ellipsoid(x, y):
    return ((x - 2e-7) ** 2 / 2 + y**2) / 1e-2


PRESSED = {"half_width": 1e-4, "load": 5.0, "coatings": ((420e9, 0.25, 5e-6),), "substrate": (210e9, 0.3)}
QUICK = {"estimate_uncertainty": False}
INDENTERS = {
    "rough surface": {"profile": rough(64)},
    "rough surface at a given approach": {
        "profile": rough(64),
        "load": None,
        "approach": 5e-8,
        "estimate_uncertainty": False,
    },
    "smooth edge": {"profile": ellipsoid, "patches": 80, "ball": (600e9, 0.2, ())},
    "window of the square": {"profile": ellipsoid, "patches": 201, "half_width": 5e-4},
    "patches alone": {"profile": ellipsoid, "patches": 65, "edge_correction": False},
}


@pytest.mark.parametrize("name", INDENTERS)
def test_contact_is_that_of_numpy(name):
    given = PRESSED | INDENTERS[name]
    ours, theirs = (semianalytic.indent(**given, array_namespace=xp) for xp in (None, strict))
    assert theirs.diagnostics.iterations == ours.diagnostics.iterations
    assert theirs.diagnostics.convolutions == ours.diagnostics.convolutions
    assert type(theirs.patch_pressure) is np.ndarray
    # rounding of the two libraries, through rounds of fit and contact
    assert theirs.patch_pressure == pytest.approx(ours.patch_pressure, abs=1e-9 * ours.peak_pressure)
    for quantity in ("contact_radius", "approach", "peak_pressure"):
        value = getattr(ours, quantity)
        assert getattr(theirs, quantity) == pytest.approx(value, rel=1e-12)
        if ours.uncertainty:
            estimate = getattr(ours.uncertainty, quantity)
            assert getattr(theirs.uncertainty, quantity) == pytest.approx(
                estimate, rel=1e-6, abs=1e-13 * value
            )


def test_heights_choose_the_library_that_computes(monkeypatch):
    used = []
    monkeypatch.setattr(
        arrays, "dot", lambda a, b, w=None, dot=arrays.dot: used.append(type(a)) or dot(a, b, w)
    )
    given = PRESSED | QUICK
    theirs = semianalytic.indent(profile=strict.asarray(rough(33)), **given)
    assert set(used) == {type(strict.zeros(1))}
    used.clear()
    ours = semianalytic.indent(profile=rough(33), **given)
    assert set(used) == {np.ndarray}
    assert theirs.approach == pytest.approx(ours.approach, rel=1e-12)


def unwritable(*_, **__):
    return ()  # a tuple raises TypeError where an entry is set


@pytest.mark.parametrize(
    ("library", "message"),
    [
        (SimpleNamespace(__name__="bare"), "bare.*fft.rfft, fft.irfft"),
        (
            SimpleNamespace(__name__="fixed", fft=strict.fft, zeros=unwritable, float64=float),
            "fixed",
        ),
        (SimpleNamespace(__name__="short", fft=strict.fft, zeros=np.zeros), "float64"),
    ],
)
def test_a_library_that_lacks_what_is_needed_is_refused(library, message):
    with pytest.raises(ValueError, match=message):
        semianalytic.indent(profile=rough(33), **PRESSED, array_namespace=library)
