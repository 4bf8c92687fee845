"""A study of accuracy made up from power laws, for tests of the report."""

from verification.credibility.accuracy_study import CORRECTED, PLAIN, STAIRCASE, AccuracyStudy
from verification.credibility.refinement_studies import QUANTITIES, Refinement, RefinementLevel

PATCHES = (33, 65, 129, 257)


def falling(setting: str, order: float, floor: float = 0.0, solid: str = "coated") -> Refinement:
    """Errors of N^-order, no smaller than ``floor``, in every quantity."""
    levels = tuple(
        RefinementLevel(f"N = {n}", float(n), 0.01 * n, dict.fromkeys(QUANTITIES, max(n**-order, floor)))
        for n in PATCHES
    )
    return Refinement("semianalytic", solid, setting, levels)


def elements(order: int) -> Refinement:
    """Finite elements that converge as their order says."""
    levels = tuple(
        RefinementLevel(name, size, 1.0, dict.fromkeys(QUANTITIES, size**-order))
        for name, size in (("fast", 100.0), ("default", 200.0))
    )
    return Refinement("fem_reference", "coated", f"order {order}", levels)


def study(*failures: str) -> AccuracyStudy:
    """One of everything that a study holds."""
    return AccuracyStudy(
        (
            falling(CORRECTED, 4.0, 1e-7),
            falling(STAIRCASE, 1.0),
            falling(PLAIN, 0.05),
            falling(CORRECTED, 5.0, solid="uncoated"),
            falling(STAIRCASE, 1.0, solid="uncoated"),
            *(elements(order) for order in (2, 3, 4)),
        ),
        failures,
        9.5,
        "a28aa40c1d2e",
    )
