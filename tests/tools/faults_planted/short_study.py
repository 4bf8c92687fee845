"""The accuracy study of a trial: fewer grids, up to the first part that disagrees."""

from collections.abc import Callable
from functools import partial

from verification.credibility.accuracy_study import BARE, COATED, FILM, discs_of
from verification.credibility.exact_errors import grid_ratios, iteration_counts, turned_ellipse
from verification.credibility.refinement_studies import refined_grid
from verification.credibility.study_verdicts import CORRECTED, STAIRCASE, verdicts
from verification.judging.invariant_verdict import Invariant
from verification.judging.outcome import Outcome
from verification.running.case_result import message_of
from verification.sources.source_registry import solvers


def quick() -> tuple[Invariant, ...]:
    """The verdicts of a shorter study, part by part up to the first that disagrees: fewer grids.

    For trials of planted faults: whatever fails is a verdict without a result.
    """
    grid = partial(refined_grid, solve=solvers(COATED)["semianalytic"])
    parts: tuple[Callable[[], tuple[Invariant, ...]], ...] = (
        lambda: verdicts(errors=discs_of()),
        lambda: verdicts([grid(COATED, (129,), solid="coated", setting=CORRECTED)]),
        lambda: verdicts([grid(FILM, (129,), solid="compliant film", setting=CORRECTED)]),
        lambda: verdicts(
            [grid(COATED, (33, 65, 129), solid="coated", setting=STAIRCASE, edge_correction=False)]
        ),
        lambda: verdicts(errors=turned_ellipse(BARE, "approach")),
        lambda: verdicts(errors=turned_ellipse(BARE, "load")),
        lambda: verdicts(errors=iteration_counts(COATED, "coated")),
        lambda: verdicts(errors=grid_ratios(COATED, "coated")),
    )
    found: list[Invariant] = []
    for part in parts:
        try:
            found += part()
        except Exception as error:
            found += verdicts(failures=[f"discs and ellipses: {message_of(error)}"])
        if any(row.outcome is Outcome.DISAGREES for row in found):
            break
    return tuple(found)
