"""Ladders of made-up values whose limit, order and scatter are known."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from verification.credibility.level_uncertainty import convergence_index, least_squares

STEPS = (8.0, 4.0, 2.0, 1.0)
LIMIT = 3.7


def levels(order, alpha=0.05, steps=STEPS):
    return [LIMIT + alpha * h**order for h in steps]


@pytest.mark.parametrize("order", [0.6, 1.0, 1.5, 2.0])
def test_exact_power_law_gives_its_order_its_limit_and_five_quarters_of_its_error(order):
    found = least_squares(STEPS, levels(order))
    assert found.order == pytest.approx(order, abs=1e-4)
    assert found.limit == pytest.approx(LIMIT, rel=1e-5)
    assert found.uncertainty == pytest.approx(1.25 * 0.05, rel=1e-3)


def test_order_of_three_levels_is_that_of_the_power_law_on_uneven_steps():
    steps = (3.0, 1.7, 1.0)
    found = convergence_index(steps, levels(1.3, steps=steps))
    assert found.order == pytest.approx(1.3, abs=1e-9)
    assert found.uncertainty == pytest.approx(1.25 * 0.05, rel=1e-9)
    assert found.limit == pytest.approx(LIMIT, rel=1e-12)


def test_two_levels_take_the_theoretical_order_and_the_factor_three():
    found = convergence_index((2.0, 1.0), levels(2.0)[-2:], order=2.0)
    assert found.order is None
    assert found.uncertainty == pytest.approx(3 * 0.05)


@settings(max_examples=200, deadline=None, derandomize=True)
@given(
    order=st.floats(0.6, 2.0),
    alpha=st.floats(1e-3, 1.0),
    second=st.floats(-0.05, 0.05),
    levels=st.integers(4, 6),
)
def test_true_error_is_bracketed_when_a_term_of_the_next_order_is_small(order, alpha, second, levels):
    h = 2.0 ** np.arange(levels)
    values = LIMIT + alpha * (h**order + second * h ** (order + 0.5) / h.max() ** 0.5)
    found = least_squares(h, values)
    assert abs(values[0] - LIMIT) <= found.uncertainty


@pytest.mark.parametrize("order", [1.0, 1.5, 2.0])
def test_noise_of_a_fortieth_of_the_error_is_bracketed_in_nineteen_of_twenty_ladders(order):
    """At a fifth of the error, a fitted first order wanders so far that only three of four are."""
    random = np.random.default_rng(7)
    h = np.array([5.0, 4.0, 3.0, 2.0, 1.5, 1.0])
    held = 0
    for _ in range(100):
        values = LIMIT + 0.02 * h**order + 0.0005 * random.standard_normal(h.size)
        held += abs(values[-1] - LIMIT) <= least_squares(h, values).uncertainty
    assert held >= 95


def test_oscillating_values_are_not_believed_and_their_swing_is_the_uncertainty():
    found = least_squares(STEPS, [LIMIT + 0.1, LIMIT - 0.1, LIMIT + 0.1, LIMIT - 0.1])
    assert found.uncertainty >= 0.1
    three = convergence_index(STEPS[1:], [LIMIT - 0.1, LIMIT + 0.1, LIMIT - 0.1])
    assert three.uncertainty >= 0.2
    assert three.order is None


def test_order_beyond_the_theoretical_one_is_not_trusted():
    """The factor is 3, on the fit of order 1 or 2 that explains the values best."""
    found = least_squares(STEPS, levels(4.0))
    assert found.order is None
    assert found.uncertainty > 3 * 0.05
    assert least_squares(STEPS, levels(4.0), order=4.0).uncertainty == pytest.approx(1.25 * 0.05, rel=1e-3)


def test_order_below_one_half_is_not_trusted():
    values = levels(0.2)
    assert least_squares(STEPS, values).uncertainty > 1.25 * abs(values[-1] - values[-2])


def test_values_that_stand_still_are_as_uncertain_as_their_last_digit():
    found = least_squares(STEPS, [LIMIT] * 4)
    assert 0 < found.uncertainty <= 1e-15 * LIMIT
    assert found.limit == LIMIT


def test_ladder_may_be_given_in_any_order_and_any_unit():
    one = least_squares(STEPS, levels(1.5))
    other = least_squares(np.array(STEPS)[[2, 0, 3, 1]] * 1e-6, np.array(levels(1.5))[[2, 0, 3, 1]])
    assert other.uncertainty == pytest.approx(one.uncertainty, rel=1e-9)


@pytest.mark.parametrize(
    ("h", "phi", "said"),
    [
        (STEPS, (1.0, 2.0, 3.0), "step"),
        ((1.0, 1.0, 2.0, 4.0), (1.0, 1.0, 2.0, 4.0), "3"),
        ((1.0, 2.0, 3.0), (1.0, 2.0, 3.0), "4"),
        ((0.0, 1.0, 2.0, 4.0), (1.0, 1.0, 2.0, 4.0), "positive"),
        (STEPS, (1.0, 1.0, float("nan"), 4.0), "finite"),
    ],
)
def test_ladder_that_is_none_is_refused_in_one_sentence(h, phi, said):
    with pytest.raises(ValueError, match=said):
        least_squares(h, phi)
