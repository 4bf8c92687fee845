"""NaN and infinity in what the methods compute never end in agreement."""

import sys
from collections import Counter

import pytest
from not_finite import BAD, PLACES, clean, outcome_of

from verification.judging.verdict import Outcome


def spoilt_cases_of(places, values):
    _, whole, _ = clean()
    assert whole.outcome is Outcome.AGREES
    assert len(whole.verdicts) > 40
    found = Counter()
    for place in places:
        for value in values:
            result, asked = outcome_of(place, BAD[value])
            assert asked > 0, f"{place} was never asked, so nothing was spoilt"
            assert result.outcome is not Outcome.AGREES, f"{value} in {place} agrees"
            found[result.outcome] += 1
    return found


@pytest.mark.slow
def test_nan_and_infinity_in_twenty_places_of_each_method_never_agree():
    methods = Counter(place.method for place in PLACES)
    assert min(methods.values()) >= 20
    found = spoilt_cases_of(PLACES, BAD)
    sys.stdout.write(f"{len(PLACES)} places, {found.total()} plants: {dict(found)}\n")
    assert found.total() == 3 * len(PLACES)
