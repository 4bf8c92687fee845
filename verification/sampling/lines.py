"""Profiles of a solution along the lines of a case."""

import numpy as np
from numpy.typing import NDArray

from verification.problem.contact import CoatedContact, Solution, stress_with_uncertainty
from verification.problem.profile import Line, Profile
from verification.problem.quantity import IN_PLANE, QUANTITIES, SCALARS

__all__ = ["sample", "sample_contact"]


def sample_contact(solution: Solution, source: str, problem: CoatedContact) -> tuple[Profile, ...]:
    """Every scalar of the contact as a profile of one point [SI]."""
    found = []
    for name in SCALARS:
        value = np.array([QUANTITIES[name].value(solution, problem)])
        stated = QUANTITIES[name].uncertainty(solution, problem)
        spread = None if stated is None else np.array([stated])
        found.append(Profile(name, "contact", np.zeros(1), value, source, spread))
    return tuple(found)


def sample(solution: Solution, source: str, line: Line, position: NDArray[np.float64]) -> tuple[Profile, ...]:
    """Every quantity of ``line`` at ``position`` [m]: the four stresses, on the surface the pressure too."""
    if line.depth is None:
        x, z = np.zeros_like(position), position
    else:
        x, z = position, np.full_like(position, line.depth)
    stated = solution.uncertainty is not None
    profiles = []
    if line.name == "surface":
        profiles.append(
            Profile(
                "pressure",
                line.name,
                position,
                solution.pressure(x),
                source,
                solution.pressure_uncertainty(x) if stated else None,
            )
        )
    sigma, spread = stress_with_uncertainty(solution, x, 0.0, z, layer=line.layer)
    for name, component in IN_PLANE.items():
        profiles.append(
            Profile(
                name,
                line.name,
                position,
                sigma[component],
                source,
                None if spread is None else spread[component],
            )
        )
    return tuple(profiles)
