"""The four outcomes of a comparison."""

from enum import StrEnum


class Outcome(StrEnum):
    """What a comparison came to; only AGREES passes."""

    AGREES = "AGREES"
    DISAGREES = "DISAGREES"
    INCONCLUSIVE = "INCONCLUSIVE"
    NO_RESULT = "NO_RESULT"
