"""Verdicts: what agreement always means; single verdicts are known answers of the self-tests."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from verification.judging.verdict import Outcome, compare, judge
from verification.problem.line_profile import Profile


def profile(value, uncertainty, source="a"):
    value = np.atleast_1d(value)
    U = np.broadcast_to(uncertainty, value.shape)
    return Profile("sigma_xx", "surface", np.arange(value.size, dtype=float), value, source, U)


def outcome(a, b, scale=1.0):
    return judge(compare(a, b, scale=scale), 1e-2).outcome


def test_disagreement_is_not_hidden_by_a_large_uncertainty_elsewhere():
    a, b = profile([1.0, 1.0], [1e-6, 1.0]), profile([1.1, 1.0], [1e-6, 1.0], "b")
    assert outcome(a, b) is Outcome.DISAGREES


@pytest.mark.parametrize("scale", [0.0, np.nan, -1.0])
def test_comparison_without_a_scale_has_no_result(scale):
    assert outcome(profile(0.0, 0.0), profile(0.0, 0.0, "b"), scale=scale) is Outcome.NO_RESULT


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
