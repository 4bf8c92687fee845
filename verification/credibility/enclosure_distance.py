"""Distance of a solution from the proven enclosures of its problem."""

from collections.abc import Iterator

from verification.evidence.enclosure_record import LOWER, SURFACE, Bounds, Enclosure
from verification.problem.coated_contact import CoatedContact, Solution, stress_with_uncertainty


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
