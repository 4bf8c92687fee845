"""Defect correction at the contact edge.

The error of constant patches at the square root of the edge is measured on the edge profile, whose exact
deflection is known, and added to the gap: the patches find what the profile leaves of the contact.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from semianalytic import abel
from semianalytic.edge_profile import Profile
from semianalytic.grid import Grid
from semianalytic.inputs import Body, Numerics
from semianalytic.level import Indenter, Level, LevelProblem

__all__ = ["corrected"]

Array = NDArray[np.floating]


def corrected(
    grid: Grid,
    gap: Array,
    before: Level | None,
    shape: Profile | None,
    indenter: Indenter,
    body: Body,
    numerics: Numerics,
) -> Level:
    """Contact of a round indenter corrected by an edge profile, uncorrected without one.

    gap : [m], on the grid.  before : level to start from.
    """
    problem = LevelProblem(grid, gap, float(np.ptp(gap)), grid.window, before, indenter, body, numerics)
    if shape is None:
        return problem.solve(0.0, 0.0)
    on_patches = shape.pressure(grid.radius)
    missing = shape.load - grid.force(on_patches)
    E_star = body.contact_modulus
    exact = abel.deflection(shape.radius, shape.coefficients, E_star, indenter.table, grid.radius)
    level = problem.solve(exact - problem.deflection(on_patches), missing)
    return replace(level, shape=shape, convolutions=level.convolutions + 1)
