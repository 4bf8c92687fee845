"""Profiles of a solution along the lines of a case."""

import numpy as np
from numpy.typing import NDArray

from verification.problem.contact import Solution, stress_with_uncertainty
from verification.problem.profile import SCALARS, STRESSES, Line, Profile

__all__ = ["sample", "sample_contact"]


def sample_contact(solution: Solution, source: str) -> tuple[Profile, ...]:
    """Peak pressure [Pa], contact radius [m] and approach [m] as profiles of one point."""
    origin = np.zeros(1)
    stated = solution.uncertainty
    return tuple(
        Profile(
            name,
            "contact",
            origin,
            np.array([getattr(solution, name)], dtype=float),
            source,
            None if stated is None else np.array([getattr(stated, name)], dtype=float),
        )
        for name in SCALARS
    )


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
    for name, component in STRESSES.items():
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
