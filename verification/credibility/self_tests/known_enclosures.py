"""The exact reference held against proven enclosures, of a few problems that are quickly solved."""

from collections.abc import Iterator

from verification.credibility.self_tests.known_answers import Answers
from verification.evidence.enclosure_record import (
    LOWER,
    SHIPPED,
    SURFACE,
    WIDTH,
    Bounds,
    Enclosure,
    read_record,
)
from verification.problem.coated_contact import CoatedContact, Solution, keywords, stress_with_uncertainty
from verification.sources.references import integral_equation

TEST = "exact reference"
COATED = ("ratio_10_h_1", "ratio_0.1_h_1", "two_soft_on_stiff")
# Of the value: an enclosure of the required width contains the reference.
ROUNDING = WIDTH / 2


def of_enclosures() -> Answers:
    record = read_record(SHIPPED)
    known = {one.name: one for one in record.enclosures} if record else {}
    for name in ("uncoated", *COATED):
        one = known[name]
        exact = integral_equation.solve(**keywords(one.problem), estimate_uncertainty=False)
        for bounds, distance, _ in distances(one, exact):
            what = f"{bounds.quantity} of {name}, {bounds.line}, in its enclosure"
            yield what, distance <= ROUNDING * abs(bounds.middle), True


def distances(enclosure: Enclosure, solution: Solution) -> Iterator[tuple[Bounds, float, float | None]]:
    """Each bound with the distance of the solution's value from it, then U of this value if stated."""
    for bounds in enclosure.bounds:
        value, U = _value(enclosure.problem, solution, bounds)
        yield bounds, bounds.distance(value), U


def _value(problem: CoatedContact, solution: Solution, bounds: Bounds) -> tuple[float, float | None]:
    if bounds.quantity == "sigma_xx":
        layer = 1 if bounds.line == LOWER else 0
        z = 0.0 if bounds.line == SURFACE else problem.interfaces[0]
        sigma, U_sigma = stress_with_uncertainty(solution, 0.0, 0.0, z, layer)
        return float(sigma[0, 0]), None if U_sigma is None else float(U_sigma[0, 0])
    if bounds.quantity == "pressure":
        U = None if solution.uncertainty is None else float(solution.pressure_uncertainty(0.0))
        return float(solution.pressure(0.0)), U
    U = None if solution.uncertainty is None else getattr(solution.uncertainty, bounds.quantity)
    return getattr(solution, bounds.quantity), U
