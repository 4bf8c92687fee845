"""The outcomes of a comparison."""

from enum import StrEnum


class Outcome(StrEnum):
    """What a comparison came to; only AGREES passes.

    UNSUPPORTED : of guests alone, a quantity that the code does not give. It neither passes nor fails.
    """

    AGREES = "AGREES"
    DISAGREES = "DISAGREES"
    INCONCLUSIVE = "INCONCLUSIVE"
    NO_RESULT = "NO_RESULT"
    UNSUPPORTED = "UNSUPPORTED"


DECIDED = tuple(outcome for outcome in Outcome if outcome is not Outcome.UNSUPPORTED)
