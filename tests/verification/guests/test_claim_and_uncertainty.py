"""A guest's claim and its own uncertainty: the second never turns a right answer red."""

import numpy as np
import pytest
from guest_exams import GUEST

from verification.guests.guest_verdicts import decided
from verification.judging.verdict import Outcome, compare, judge
from verification.problem.line_profile import Profile

EXACT = Profile("pressure", "surface", np.zeros(1), np.ones(1), "exact", np.zeros(1))


def verdict(difference, U):
    uncertainty = None if U is None else np.full(1, U)
    mine = Profile("pressure", "surface", np.zeros(1), np.full(1, 1 + difference), "g", uncertainty)
    return decided(GUEST, judge(compare(mine, EXACT, scale=1.0), GUEST.claim))


@pytest.mark.parametrize("U", [1e-9, 1e-3, 0.5])
def test_a_difference_within_the_claim_agrees_as_without_an_uncertainty(U):
    for difference in GUEST.claim * np.array([0.0, 1e-3, 0.3, 0.99]):
        assert verdict(difference, None).outcome is Outcome.AGREES
        found = verdict(difference, U)
        assert found.outcome is Outcome.AGREES
        covered = difference <= U <= GUEST.claim
        assert covered is not ("not show this accuracy" in found.reason)
        assert found.uncertainty == pytest.approx(U)


def test_beyond_the_claim_an_uncertainty_that_covers_the_difference_is_inconclusive():
    difference = 3 * GUEST.claim
    outcomes = [verdict(difference, U).outcome for U in (None, 1e-9, 1.0)]
    assert outcomes == [Outcome.DISAGREES, Outcome.DISAGREES, Outcome.INCONCLUSIVE]
