"""What a solution's own coarser companions say of a number, for laws that integrate over the contact edge.

At the edge the uncertainty of the pressure is that of a steep front that may be displaced; carried through
an integral as if all of it had one sign it says a hundred times too much. There the integral itself is
followed over the companions instead.
"""

from collections.abc import Callable
from typing import Any

import numpy as np

from verification.problem.arrays import Array
from verification.problem.contact import Solution

__all__ = ["INNER", "followed"]


INNER = 0.95  # of a; out to here the pressure's own uncertainty speaks
# An error of order 3/2 on patches sqrt(2) coarser: 1/(2^(3/4) - 1). The change before guards against a last
# one that is small by chance.
LAST, BEFORE = 1.5, 0.5


def followed(solution: Solution, value: Callable[[Any], Array]) -> Array | None:
    """Uncertainty of ``value(solution)`` from what it is for the coarser companions; None without any."""
    first = getattr(solution, "coarser", None)
    if first is None:
        return None
    here, there = value(solution), value(first)
    change = LAST * np.abs(here - there)
    second = getattr(first, "coarser", None)
    if second is not None:
        change = np.maximum(change, BEFORE * np.abs(there - value(second)))
    return change
