"""The outcomes of a comparison."""

from collections.abc import Iterable
from enum import StrEnum


class Outcome(StrEnum):
    """Outcome of a comparison; only AGREES passes.

    UNSUPPORTED : of guests alone, a quantity that the code does not give. It neither passes nor fails.
    """

    AGREES = "AGREES"
    DISAGREES = "DISAGREES"
    INCONCLUSIVE = "INCONCLUSIVE"
    NO_RESULT = "NO_RESULT"
    UNSUPPORTED = "UNSUPPORTED"


DECIDED = tuple(outcome for outcome in Outcome if outcome is not Outcome.UNSUPPORTED)


def worst(outcomes: Iterable[Outcome]) -> Outcome:
    """Disagreement before a missing result before inconclusive; no result where nothing was judged."""
    found = set(outcomes)
    order = (Outcome.DISAGREES, Outcome.NO_RESULT, Outcome.INCONCLUSIVE, Outcome.AGREES)
    return next((outcome for outcome in order if outcome in found), Outcome.NO_RESULT)
