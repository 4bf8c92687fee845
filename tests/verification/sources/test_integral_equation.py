"""The exact coated sphere against print, limits, closed forms and the laws of elasticity."""

import numpy as np
import pytest
import scipy.linalg

from verification.problem.coated_contact import CoatedContact
from verification.sources.references import integral_equation
from verification.sources.references.axisymmetric_pressure import AbelPressure
from verification.sources.references.hankel_field import HankelField
from verification.sources.references.hertz import Hertz
from verification.sources.references.layered_half_space import LayeredHalfSpace, _in_plane, _propagator

STEEL = (210e9, 0.3)
BARE = CoatedContact(10e-3, 20.0, (), STEEL)


def solve(coatings, substrate=STEEL, friction=0.0, load=20.0, radius=10e-3):
    return integral_equation.solve(
        radius=radius, load=load, coatings=coatings, substrate=substrate, friction=friction
    )


def closed_form_M(x, E1, nu1, E2, nu2):
    """M of one coating, written from the Papkovich solution; the code under test uses impedances."""
    m, th = E1 * (1 + nu2) / (E2 * (1 + nu1)), np.exp(-2 * x)
    lam = 1 - 4 * (1 - nu1) / (1 + m * (3 - 4 * nu2))
    kap = (m - 1) / (m + 3 - 4 * nu1)
    return (1 + 4 * x * kap * th - lam * kap * th**2) / (
        1 - (lam + kap + 4 * kap * x**2) * th + lam * kap * th**2
    )


def test_compliance_meets_the_closed_form_over_ten_decades():
    k = np.logspace(-6, 4, 101)
    for E1, nu1, E2, nu2 in [(4, 0.3, 1, 0.3), (0.05, 0.45, 1, 0.2), (100, 0.0, 1, 0.5), (0.01, 0.3, 1, 0.1)]:
        M = LayeredHalfSpace(((E1, nu1, 1.0),), (E2, nu2), k).compliance
        # The propagator's condition number, (k h)^2 up to 1600, times rounding.
        assert pytest.approx(closed_form_M(k, E1, nu1, E2, nu2), rel=2e-12, abs=0) == M


@pytest.mark.parametrize("load", ["normal", "shear", "antiplane"])
def test_splitting_a_layer_changes_nothing(load):
    k = np.logspace(-3, 2.5, 56)
    whole = LayeredHalfSpace(((4.0, 0.2, 1.0),), (1.0, 0.4), k)
    split = LayeredHalfSpace(((4.0, 0.2, 0.2), (4.0, 0.2, 0.5), (4.0, 0.2, 0.3)), (1.0, 0.4), k)
    for z, layer, same in [(0.0, 0, 0), (0.4, 0, 1), (1.5, 1, 3)]:
        one, other = whole.amplitudes(z, layer, load), split.amplitudes(z, same, load)
        for name in ("T", "S", "ll", "tt", "t", "lt"):
            assert getattr(other, name) == pytest.approx(getattr(one, name), abs=2e-11)


def test_propagator_is_the_matrix_exponential():
    for x in (1e-4, 0.3, 0.49999, 0.50001, 3.0, -2.0):
        direct = scipy.linalg.expm(_in_plane(2.0, 0.3) * x) * np.exp(-abs(x))
        assert _propagator(np.array([x]), 2.0, 0.3)[0] == pytest.approx(direct, abs=1e-12)


def test_equal_moduli_give_hertz():
    a = BARE.a_h
    exact, hertz = solve(((*STEEL, 0.3 * a), (*STEEL, 0.4 * a))), Hertz(10e-3, 20.0, *STEEL)
    assert exact.contact_radius == pytest.approx(hertz.contact_radius, rel=1e-11, abs=0)
    x, y, z = np.random.default_rng(1).uniform(-2, 2, (3, 100)) * a
    for depth in (np.abs(z) + 0.02 * a, 0 * z):
        difference = exact.stress(x, y, depth) - hertz.stress(x, y, depth)
        assert np.abs(difference).max() < 1e-9 * hertz.peak_pressure


@pytest.fixture(scope="module")
def sliding():
    """Two coatings with unequal Poisson ratios under friction."""
    a = BARE.a_h
    return solve(((420e9, 0.2, 0.5 * a), (100e9, 0.4, 0.3 * a)), friction=0.3)


def test_surface_closed_form_continues_the_quadrature_below(sliding):
    x = np.linspace(-2, 2, 12) * BARE.a_h
    y, step = 0.3 * BARE.a_h, 2e-3 * BARE.a_h
    away = np.abs(np.hypot(x, y) / sliding.contact_radius - 1) > 0.2
    extrapolated = (
        3 * sliding.stress(x, y, step) - 3 * sliding.stress(x, y, 2 * step) + sliding.stress(x, y, 3 * step)
    )
    difference = np.abs(extrapolated - sliding.stress(x, y, 0.0))[:, :, away]
    # Quadratic extrapolation errs by step^3 = 8e-9 times third derivatives near the edge, up to 1e3.
    assert difference.max() < 1e-5 * BARE.p_h


def test_peak_on_a_ring_is_found_between_the_samples():
    s, weight = np.polynomial.legendre.leggauss(40)
    s, weight = (1 + s) / 2, weight / 2
    # phi = 3 (1 - t^4) - (1 - t^2) is p ~ sqrt(1 - r^2) (1 + 4 r^2), largest at r^2 = 7/12
    found = AbelPressure.from_nodes(1.0, s, weight, 3 * (1 - s**4) - (1 - s**2))
    assert found.peak == pytest.approx((5 / 12) ** 0.5 * 10 / 3 * found.pressure(0.0), rel=1e-13, abs=0)


@pytest.mark.parametrize("depth", [0.0, 0.5])
def test_integrals_are_cut_where_less_than_exp_of_the_tail_is_left(depth):
    pressure = AbelPressure(1.0, np.array([1.0, -1.0]) / 3)
    layers = ((4.0, 0.2, 0.5), (0.5, 0.4, 0.3)), (1.0, 0.3)
    cut, whole = (HankelField(pressure, *layers, 0.3, tail=tail) for tail in (10.0, 36.0))
    x = np.array([0.0, 0.5, 1.0, 2.0])
    left = cut.stress(x, 0.3, depth) - whole.stress(x, 0.3, depth)
    assert 0 < np.abs(left).max() < 0.2 * np.exp(-10)


def test_a_depth_just_below_the_surface_is_refused_before_it_fills_the_memory(sliding):
    a = sliding.contact_radius
    with pytest.raises(ValueError, match=r"depth z = .* wavenumbers; choose z = 0"):
        sliding.stress(0.5 * a, 0.0, 1e-6 * a)
    assert np.isfinite(sliding.stress(0.5 * a, 0.0, 1e-3 * a)).all()
