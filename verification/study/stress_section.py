"""The stresses in the plane of symmetry of the flat, on a grid in each layer in sight."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from verification.problem.array_types import Array
from verification.problem.coated_contact import CoatedContact, ContactSolution
from verification.study.friction_planes import in_plane

COLUMNS, ROWS = 161, 24  # points along x, in depth of a layer


@dataclass(frozen=True, eq=False)
class StressSection:
    """xx, yy, zz, xz [Pa] of each layer in sight, (4, depth, x), at depths ``z`` [m], all along ``x`` [m]."""

    x: Array
    z: tuple[Array, ...]
    stress: tuple[Array, ...]


def section(
    solution: ContactSolution,
    problem: CoatedContact,
    half_width: float,
    deepest: float,
    residual: Sequence[float] = (),
) -> StressSection:
    """The section of ``solution`` from -``half_width`` to it, from the surface to ``deepest`` [m].

    residual : equibiaxial stress [Pa] of each coating, () for none.   Raises what the solution raises.
    """
    x = half_width * np.linspace(-1, 1, COLUMNS)
    bounds = [0.0, *(z for z in problem.interfaces if z < deepest), deepest]
    added = (*(residual or [0.0] * len(problem.coatings)), 0.0)
    depths, found = [], []
    for layer, (top, bottom) in enumerate(pairwise(bounds)):
        z = top + (bottom - top) * np.linspace(0, 1, ROWS) ** 1.5
        points = np.broadcast_arrays(x[None, :], z[:, None])
        full = solution.stress(points[0].ravel(), 0.0, points[1].ravel(), layer=layer)
        s = in_plane(full).reshape(4, ROWS, COLUMNS)
        s[:2] += added[layer]
        depths.append(z)
        found.append(s)
    return StressSection(x, tuple(depths), tuple(found))
