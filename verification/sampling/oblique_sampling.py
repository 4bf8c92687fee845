"""Profiles along the lines off the plane y = 0: all six stresses, all three displacements."""

import numpy as np

from verification.problem.array_types import Array
from verification.problem.coated_contact import (
    CoatedContact,
    NotClaimed,
    Solution,
    displacement_with_uncertainty,
    stress_with_uncertainty,
)
from verification.problem.line_profile import Line, Profile
from verification.problem.quantity import DISPLACEMENTS, STRESSES

__all__ = ["positions", "sample"]

# Of the contact radius.
ACROSS = np.linspace(0, 2.5, 21)
SURFACE = np.concatenate([np.linspace(0, 1.4, 15), np.geomspace(1.6, 5.0, 8)])
DOWN = 2.0 * ((np.arange(12) + 0.5) / 12) ** 1.2
# Of a coating; the least distance from an interface, whose sides other lines have.
INSIDE, CLEAR = np.array([0.35, 0.8]), 1e-3


def positions(problem: CoatedContact, line: Line, a: float) -> Array:
    """Positions [m] along ``line``; without friction on one side of the plane x = 0 where both are alike.

    a : contact radius [m].
    """
    problem = problem.seen_from(line.body)
    if line.place == "oblique":
        bounds = np.array([0.0, *problem.interfaces])
        inside = bounds[:-1, None] + np.diff(bounds)[:, None] * INSIDE
        z = np.unique(np.concatenate([inside.ravel(), max(a, 0.75 * bounds[-1]) * DOWN]))
        clear = CLEAR * min([a, *(h for _, _, h in problem.coatings)])
        z = z[np.abs(z[:, None] - bounds).min(axis=1) > clear]
        return z / line.direction[2]
    s = a * (ACROSS if line.place == "off plane" else SURFACE)
    return np.concatenate([-s[:0:-1], s]) if problem.friction else s


def sample(solution: Solution, source: str, line: Line, position: Array) -> tuple[Profile, ...]:
    """Every quantity of ``line`` at ``position`` [m]; no displacement where the source claims none."""
    x, y, z = line.points(position)
    found: list[tuple[str, Array, Array | None]] = []
    if line.place != "oblique surface":
        sigma, U = stress_with_uncertainty(solution, x, y, z, layer=line.layer, body=line.body)
        found += [(n, sigma[c], None if U is None else U[c]) for n, c in STRESSES.items()]
    if line.place != "off plane":
        try:
            u, U = displacement_with_uncertainty(solution, x, y, z, line.body)
        except NotClaimed:
            u, U = np.zeros((0, position.size)), None
        found += [(n, u[i], None if U is None else U[i]) for i, n in enumerate(DISPLACEMENTS[: len(u)])]
    return tuple(Profile(name, line.name, position, value, source, U) for name, value, U in found)
