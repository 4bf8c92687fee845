"""Verdicts: agreement needs finite numbers, a stated uncertainty that covers the difference, a cap on it."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from verification.judging.verdict import Outcome, compare, judge
from verification.problem.line_profile import Profile


def profile(value, uncertainty=None, source="a", position=None):
    value = np.atleast_1d(np.asarray(value, dtype=float))
    where = np.arange(value.size, dtype=float) if position is None else np.asarray(position, dtype=float)
    spread = (
        None if uncertainty is None else np.broadcast_to(np.asarray(uncertainty, dtype=float), value.shape)
    )
    return Profile("sigma_xx", "surface", where, value, source, spread)


def outcome(a, b, cap=1e-2, scale=1.0, excluded=None):
    return judge(compare(a, b, scale=scale, excluded=excluded), cap).outcome


def test_difference_within_uncertainty_agrees():
    assert outcome(profile(1.0, 1e-3), profile(1.0015, 1e-3, "b")) is Outcome.AGREES


def test_difference_beyond_uncertainty_disagrees_however_small():
    assert outcome(profile(1.0, 1e-6), profile(1.00001, 1e-6, "b")) is Outcome.DISAGREES


def test_uncertainty_beyond_the_cap_is_inconclusive():
    assert outcome(profile(1.0, 1e-2), profile(1.0, 1e-2, "b")) is Outcome.INCONCLUSIVE


def test_disagreement_is_not_hidden_by_a_large_uncertainty_elsewhere():
    a, b = profile([1.0, 1.0], [1e-6, 1.0]), profile([1.1, 1.0], [1e-6, 1.0], "b")
    assert outcome(a, b) is Outcome.DISAGREES


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_values_that_are_not_finite_never_agree(bad):
    assert outcome(profile([1.0, bad], 1e-3), profile([1.0, bad], 1e-3, "b")) is Outcome.NO_RESULT
    assert outcome(profile([1.0, 1.0], [1e-3, bad]), profile([1.0, 1.0], 1e-3, "b")) is Outcome.NO_RESULT


def test_negative_uncertainty_never_agrees():
    assert outcome(profile(1.0, -1e-3), profile(1.0, 1e-3, "b")) is Outcome.NO_RESULT


@pytest.mark.parametrize("scale", [0.0, np.nan, -1.0])
def test_comparison_without_a_scale_has_no_result(scale):
    assert outcome(profile(0.0, 0.0), profile(0.0, 0.0, "b"), scale=scale) is Outcome.NO_RESULT


def test_unstated_uncertainty_never_agrees():
    assert outcome(profile(1.0), profile(1.0, 0.0, "b")) is Outcome.INCONCLUSIVE
    assert outcome(profile(1.0), profile(1.1, 0.0, "b")) is Outcome.DISAGREES


def test_points_around_the_contact_edge_are_left_out_and_no_others():
    a, b = profile([1.0, 5.0, 1.0], 1e-3), profile([1.0, 1.0, 1.0], 1e-3, "b")
    assert outcome(a, b, excluded=np.array([False, True, False])) is Outcome.AGREES
    assert outcome(a, b, excluded=np.array([True, False, False])) is Outcome.DISAGREES
    assert outcome(a, b, excluded=np.ones(3, dtype=bool)) is Outcome.NO_RESULT


def test_profiles_of_different_points_are_not_compared():
    with pytest.raises(ValueError, match="positions"):
        compare(profile([1.0, 2.0]), profile([1.0, 2.0], position=[0.0, 3.0]), scale=1.0)


@given(
    a=st.floats(-1e3, 1e3),
    b=st.floats(-1e3, 1e3),
    ua=st.floats(0, 10),
    ub=st.floats(0, 10),
    scale=st.floats(1e-3, 1e3),
)
def test_agreement_always_means_a_covered_difference_under_the_cap(a, b, ua, ub, scale):
    verdict = judge(compare(profile(a, ua), profile(b, ub, "b"), scale=scale), 1e-2)
    if verdict.outcome is Outcome.AGREES:
        # A subnormal difference is lost in the division by the scale.
        assert abs(a - b) <= (ua + ub) * (1 + 1e-9) + 1e-300
        assert (ua + ub) / scale <= 1e-2 * (1 + 1e-9)
