"""Profiles along the lines off the plane y = 0: all six stresses, all three displacements.

On the line "off plane" those of the semi-analytical method come from its fields on whole planes, by FFT.
"""

from dataclasses import replace
from typing import Any

import numpy as np

from verification.problem.array_types import Array
from verification.problem.coated_contact import CoatedContact, ContactSolution
from verification.problem.line_profile import Line, Profile
from verification.problem.point_answers import FLAT, Points
from verification.problem.quantity import DISPLACEMENTS, STRESSES

# Of the contact radius.
ACROSS = np.linspace(0, 1.2, 13)
SURFACE = np.concatenate([np.linspace(0, 1.4, 15), np.geomspace(1.6, 5.0, 8)])
DOWN = 2.0 * ((np.arange(12) + 0.5) / 12) ** 1.2
# Of a coating; the least distance from an interface, whose sides other lines have.
INSIDE, CLEAR = np.array([0.35, 0.8]), 1e-3


def positions(problem: CoatedContact, line: Line, a: float, nodes: Array) -> Array:
    """Positions [m] along ``line``; without friction on one side of the plane x = 0 where both are alike.

    a : contact radius [m].  nodes : centres of patches along x and along y [m], one of them at 0.
    """
    problem = problem.seen_from(line.body)
    if line.place == "oblique":
        bounds = np.array([0.0, *problem.interfaces])
        inside = bounds[:-1, None] + np.diff(bounds)[:, None] * INSIDE
        z = np.unique(np.concatenate([inside.ravel(), max(a, 0.75 * bounds[-1]) * DOWN]))
        clear = CLEAR * min([a, *(h for _, _, h in problem.coatings)])
        z = z[np.abs(z[:, None] - bounds).min(axis=1) > clear]
        return z / line.direction[2]
    if line.place == "off plane":
        y = nodes[nodes >= 0]
        y = y[: (y.size + 1) // 2]  # 2 y is a centre too
        s = y[np.unique(np.abs(y[None, :] - 0.2**0.5 * a * ACROSS[:, None]).argmin(axis=1))] / 0.2**0.5
    else:
        s = a * SURFACE
    return np.concatenate([-s[:0:-1], s]) if problem.friction else s


def sample(solution: ContactSolution, source: str, line: Line, position: Array) -> tuple[Profile, ...]:
    """Every quantity of ``line`` at ``position`` [m]; no displacement where the source claims none."""
    x, y, z = line.points(position)
    found: list[tuple[str, Array, Array | None]] = []
    on_plane = _on_plane(solution, line, x, y) if line.place == "off plane" else None
    points = Points(x, y, z, line.layer, line.body)
    if line.place != "oblique surface":
        sigma, U = solution.sample(points, "stress")
        sigma = sigma if on_plane is None else on_plane[0]
        found += [(n, sigma[c], None if U is None else U[c]) for n, c in STRESSES.items()]
    u, U = solution.sample(replace(points, layer=None), "displacement")
    if u is None:
        u = np.zeros((0, position.size))
    elif on_plane is not None:
        u = on_plane[1]
    found += [(n, u[i], None if U is None else U[i]) for i, n in enumerate(DISPLACEMENTS[: len(u)])]
    return tuple(Profile(name, line.name, position, value, source, U) for name, value, U in found)


def _on_plane(solution: Any, line: Line, x: Array, y: Array) -> tuple[Array, Array] | None:
    """Stress (3, 3, n) and displacement (3, n) of the plane through ``line``; None off patch centres.

    They differ from those at points by less than 1e-7 of the peak pressure and of the approach, below the
    uncertainty of either.
    """
    if not hasattr(type(solution), "stress_plane"):
        return None
    nodes = solution.nodes
    i, j = (np.abs(nodes[:, None] - at).argmin(axis=0) for at in (x, y))
    if np.abs([nodes[i] - x, nodes[j] - y]).max() > 1e-9 * nodes[-1]:
        return None
    z = line.origin[2]
    of = {} if line.body == FLAT else {"body": line.body}
    return solution.stress_plane(z, **of)[:, :, i, j], solution.displacement_plane(z, **of)[:, i, j]
