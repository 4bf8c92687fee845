"""Uncertainty of a number from a solution's coarser companions, for integrals over the contact edge.

Near the edge the uncertainty of the pressure is that of the position of a steep front; integrated as if all
of it had one sign it is a hundred times too large. There the change of the integral over the companions is
used.
"""

from collections.abc import Callable
from typing import Any

import numpy as np

from verification.problem.array_types import Array
from verification.problem.coated_contact import ContactSolution

INNER = 0.95  # of a; out to here the uncertainty of the pressure is integrated
# LAST: an error of order 3/2 on patches sqrt(2) coarser, 1/(2^(3/4) - 1). BEFORE guards against a last change
# that is small by chance.
LAST, BEFORE = 1.5, 0.5


def followed(
    solution: ContactSolution, value: Callable[[Any], Array], before: float = BEFORE
) -> Array | None:
    """Uncertainty of ``value(solution)`` from what it is for the coarser companions; None without any.

    before : of the change before the last one, that counts where the last is small by chance.
    """
    first = getattr(solution, "coarser", None)
    if first is None:
        return None
    here, there = value(solution), value(first)
    change = LAST * np.abs(here - there)
    second = getattr(first, "coarser", None)
    if second is not None:
        change = np.maximum(change, before * np.abs(there - value(second)))
    return change
