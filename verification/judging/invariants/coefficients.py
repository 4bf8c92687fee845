"""Influence coefficients of the semi-analytical method against direct quadrature."""

from verification.judging.invariant import Invariant, decide
from verification.judging.invariants.influence import conversion_errors
from verification.problem.contact import CoatedContact, Solution

__all__ = ["influence_coefficients"]

PATCHES = 33
BOUND = 1e-7  # what the default conversion is asked for; it reaches 1e-10


def influence_coefficients(solution: Solution, source: str, problem: CoatedContact) -> Invariant:
    """The default conversion on a grid over the contact, at patches near and far, over the largest.

    A correction of the contact edge takes the error of a poor conversion away with its own, so that the
    contact alone would not show it.
    """
    found = conversion_errors(problem, PATCHES, ())[0]
    law = f"influence coefficients at {len(found.error)} patches are those of direct quadrature"
    return decide("influence coefficients", source, law, found.largest, BOUND)
