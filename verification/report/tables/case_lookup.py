"""Lookup in a case result: scales, references, differences."""

import re
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from verification.judging.verdict import Comparison
from verification.page.page_parts import Cell
from verification.problem.line_profile import Profile
from verification.problem.point_answers import BALL, FLAT
from verification.problem.quantity import QUANTITIES
from verification.running.case_result import CaseResult
from verification.sources.source_registry import METHODS, REFERENCES

# By their shape in a problem.
INDENTERS = {"ellipsoid": "ellipsoid", "asperities": "pair of asperities", "lobes": "lobed sphere"}


def sources_with_profiles(result: CaseResult) -> tuple[str, ...]:
    """The sources that gave numbers, in the order of the case; a failed one gave none."""
    found = {profile.source for profile in result.profiles}
    order = [source.source for source in result.sources]
    return tuple(s for s in order if s in found) + tuple(sorted(found - set(order)))


def reference_source(result: CaseResult) -> str | None:
    """Reference source of a case: the last exact reference, else the finite elements."""
    found = sources_with_profiles(result)
    exact = [source for source in found if source in REFERENCES]
    references = [source for source in found if source not in METHODS]
    elements = [source for source in found if source in METHODS[1:]]
    return next((choice[-1] for choice in (exact, references, elements) if choice), None)


def scale(problem: Mapping[str, Any], name: str) -> np.float64:
    """A Hertz scale of a problem by name, "a_h", "p_h" or "delta_h"; NaN where it is not stated."""
    try:
        return np.float64(problem[name])
    except (KeyError, TypeError, ValueError):
        return np.float64("nan")


def layers(problem: Mapping[str, Any], body: str = FLAT) -> list[tuple[float, float, float]]:
    """(E [Pa], nu, thickness [m]) from the surface down, the substrate last with thickness infinity.

    [] where the problem states anything else than finite numbers, and of a rigid ball.
    """
    try:
        given, substrate = problem["coatings"], problem["substrate"]
        if body == BALL:
            *substrate, given = problem.get("ball") or (None, None, ())
        coatings = [(float(E), float(nu), float(h)) for E, nu, h in given]
        E, nu = (float(value) for value in substrate)
    except (KeyError, TypeError, ValueError):
        return []
    numbers = [number for layer in coatings for number in layer] + [E, nu]
    if not np.isfinite(numbers).all() or min(E for E, _, _ in [*coatings, (E, nu, 0.0)]) <= 0:
        return []
    return [*coatings, (E, nu, float("inf"))]


def scalar(result: CaseResult, quantity: str, source: str) -> tuple[np.float64, float | None] | None:
    """Value [SI] with uncertainty of a scalar of the contact; None where the source gave none."""
    profile = result.profile_of.get((quantity, "contact", source))
    if profile is None or profile.value.size == 0:
        return None
    uncertainty = None if profile.uncertainty is None else float(profile.uncertainty[0])
    return profile.value[0], uncertainty


def contact_radius(result: CaseResult) -> float | None:
    """The contact radius [m] by the best source that gave a finite one."""
    for source in (reference_source(result), *sources_with_profiles(result)):
        found = scalar(result, "contact_radius", source) if source else None
        if found is not None and np.isfinite(found[0]):
            return found[0]
    return None


def difference(
    result: CaseResult, first: Profile | None, second: Profile | None
) -> tuple[NDArray[np.float64], NDArray[np.float64] | None] | None:
    """|A - B| with U_A + U_B, both over ``Quantity.divisor``, as in the verdicts.

    None where the two are not at the same positions, so that nothing may be subtracted.
    """
    if first is None or second is None or not np.array_equal(first.position, second.position):
        return None
    reach = divisor(result, first.quantity, second.value[0])
    comparison = Comparison(first, second, float(reach), np.ones(first.position.shape, dtype=bool))
    return np.abs(comparison.difference), comparison.uncertainty


def divisor(result: CaseResult, quantity: str, value: Any) -> np.float64:
    """Divisor of a difference of ``quantity``, with ``value`` of the reference [SI], as in the verdicts."""
    best = reference_source(result)
    found = [scalar(result, name, best) if best else None for name in ("peak_pressure", "approach")]
    p0, delta = (np.float64(0.0 if one is None else one[0]) for one in found)
    p_h, delta_h = scale(result.problem, "p_h"), scale(result.problem, "delta_h")
    if quantity not in QUANTITIES:
        return p_h
    a = contact_radius(result) or np.nan
    return np.float64(QUANTITIES[quantity].divisor(value, p_h, p0, a, delta_h, delta))


def slug(text: str) -> str:
    """``text`` as part of an anchor or a file name: letters, digits and hyphens only."""
    return re.sub(r"[^a-z0-9]+", "-", text.lower()).strip("-")[:60] or "case"


def case_cell(result: CaseResult, href: str) -> Cell:
    """The title of a case as the head of a row, with its name for a pointer."""
    return Cell(result.title, note=f"{result.title} ({result.name})", href=href)
