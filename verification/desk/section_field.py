"""The first principal stress in the plane of symmetry of the flat, on a grid in each layer."""

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from verification.desk.answer_stresses import first_principal
from verification.problem.array_types import Array
from verification.problem.coated_contact import CoatedContact
from verification.problem.point_answers import FLAT
from verification.sources.source_registry import METHODS, solvers
from verification.study.friction_planes import in_plane

WIDTH, BELOW, COLUMNS, ROWS = 2.0, 0.5, 161, 24  # extents over a; points along x, in depth of a layer


@dataclass(frozen=True, eq=False)
class Section:
    """sigma_1 [Pa] of each layer in sight, (depth, x), at depths ``z`` [m], all along ``x`` [m]."""

    x: Array
    z: tuple[Array, ...]
    stress: tuple[Array, ...]


def section(problem: CoatedContact, residual: Mapping[str, tuple[float, ...]]) -> Section:
    """The section from the surface to half a contact radius below the deepest interface in sight.

    Solved by the semi-analytical method. Raises what it raises.
    """
    solution = solvers()[METHODS[0]](problem, {"estimate_uncertainty": False})
    a = float(solution.contact_radius)
    x = WIDTH * a * np.linspace(-1, 1, COLUMNS)
    # A film is seen by itself: the view is no deeper than three times the stack.
    stack = problem.interfaces[-1] if problem.coatings else 0.0
    deepest = min(max(3 * stack, 0.02 * a), stack + BELOW * a) if stack else BELOW * a
    bounds = [0.0, *(z for z in problem.interfaces if z < deepest), deepest]
    added = (*residual.get(FLAT, [0.0] * len(problem.coatings)), 0.0)
    depths, found = [], []
    for layer, (top, bottom) in enumerate(pairwise(bounds)):
        z = np.linspace(top, bottom, ROWS)
        points = np.broadcast_arrays(x[None, :], z[:, None])
        full = solution.stress(points[0].ravel(), 0.0, points[1].ravel(), layer=layer)
        s = in_plane(full).reshape(4, ROWS, COLUMNS)
        s[:2] += added[layer]
        depths.append(z)
        found.append(first_principal(s))
    return Section(x, tuple(depths), tuple(found))
