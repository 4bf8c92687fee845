"""Uncertainty of a pressure that is not round, and of the stress by it."""

from dataclasses import replace

import numpy as np
import pytest

from fem_reference.element_numbers import OF_FIELDS
from fem_reference.not_round.star_contact import StarPressure
from fem_reference.not_round.star_estimate import StarEstimate

FINE = StarPressure.of_ellipse(0.0, (1.0, 0.4), 1.0, 2, 12)
WEAKER = replace(FINE, coefficients=0.99 * FINE.coefficients)
FOUND = StarEstimate(FINE, FINE, WEAKER)
ZERO = np.zeros(1)


def test_a_pressure_is_uncertain_by_the_change_from_the_lower_degree():
    x = np.linspace(0.0, 0.9, 7)
    uncertain = FOUND.of_pressure(x, 0 * x)
    assert np.all(uncertain >= 0.999 * OF_FIELDS * 0.01 * FINE(x, 0 * x))
    assert uncertain[0] == pytest.approx(OF_FIELDS * 0.01 * FINE(0.0, 0.0), rel=1e-6)
    assert FOUND.of_pressure(np.array([1.01]), ZERO) == 0


def test_a_lower_degree_that_agrees_by_chance_does_not_hide_what_a_richer_one_changes():
    x = np.linspace(0.0, 0.99, 7)
    both = StarEstimate(FINE, FINE, FINE, ((WEAKER, WEAKER),))
    assert both.of_pressure(x, 0 * x) == pytest.approx(FOUND.of_pressure(x, 0 * x))


def test_a_richer_degree_tells_nothing_that_the_meshes_explain():
    by_its_own = StarEstimate(FINE, FINE, FINE, ((WEAKER, FINE),))
    assert by_its_own.of_pressure(ZERO, ZERO) == 0
    by_both = StarEstimate(FINE, WEAKER, FINE, ((WEAKER, WEAKER),))
    assert by_both.of_pressure(ZERO, ZERO) == StarEstimate(FINE, WEAKER, FINE).of_pressure(ZERO, ZERO)


def test_the_stress_at_the_edge_is_as_uncertain_as_the_pressure_inside():
    at_edge = FOUND.of_stress(np.array([1.0]), ZERO, ZERO)
    assert at_edge >= 0.999 * FOUND.of_pressure(ZERO, ZERO)


def test_an_uncertain_last_wave_dies_out_with_the_square_of_the_distance_from_the_edge():
    z = np.array([0.2, 0.4])
    near, far = FOUND.of_stress(np.ones(2), np.zeros(2), z)
    assert near == pytest.approx(4 * far)
    assert near < FOUND.of_stress(np.array([1.0]), ZERO, ZERO)


def test_on_the_last_wave_the_largest_change_there_counts():
    at_the_sides = np.array([n == 2 for n, _ in FINE.terms(12)])
    turned = replace(FINE, coefficients=FINE.coefficients + 0.01 * at_the_sides)
    found = StarEstimate(FINE, FINE, turned)
    w, tau = np.array([[0.97], [0.99], [0.9999]]), np.linspace(0, np.pi, 9)
    uncertain = found.of_pressure(*FINE.points(w, tau))
    assert np.ptp(uncertain) == pytest.approx(0, abs=1e-9 * uncertain.max())
