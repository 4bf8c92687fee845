"""Words and figures of an answer on the terminal."""

import math

from verification.problem.coated_contact import CoatedContact

DIGITS = 5  # of a value, unless its uncertainty ends before


def planes_text(problem: CoatedContact) -> str:
    """The planes in which the largest stresses are found."""
    if not problem.elliptical:
        return " y = 0, x along sliding"
    if problem.friction:
        return " y = 0, x along sliding; across it, where the plane x = 0 has no symmetry, none is found"
    return "s y = 0 and x = 0"


def value_text(value: float, spread: float | None) -> str:
    """``value`` in at most DIGITS digits, and in none beyond the first of its uncertainty."""
    if value == 0:
        return "0"
    decimals = DIGITS - 1 - math.floor(math.log10(abs(value)))
    if spread and math.isfinite(spread):
        decimals = min(decimals, -math.floor(math.log10(spread)))
    return f"{value:.{max(decimals, 0)}f}"


def spread_text(stated: float | None, scale: float) -> str:
    """An uncertainty over ``scale`` with one digit, "-" for none."""
    return "-" if stated is None or math.isnan(stated) else f"{stated / scale:.0e}"
