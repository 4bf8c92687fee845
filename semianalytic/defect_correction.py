"""Defect correction at the contact edge.

The error of constant patches at the square root of the edge is measured on the fitted profile, whose exact
deflection is known, and added to the gap; the profile is fitted anew to the pressure that results.
"""

from functools import partial

import numpy as np
from numpy.typing import NDArray

from semianalytic import abel, edge_profile
from semianalytic.grid import Grid, Window
from semianalytic.inputs import Body, Numerics
from semianalytic.level import Indenter, Level, LevelProblem

__all__ = ["corrected"]

Array = NDArray[np.floating]

SKIPS = (2.5, 1.5, 1.0)  # patches inside the edge that are left out of the fit, by round


def corrected(
    grid: Grid, gap: Array, before: Level | None, indenter: Indenter, body: Body, numerics: Numerics
) -> Level:
    """Contact of a round indenter by ``numerics.edge_rounds`` corrections; uncorrected without a profile.

    gap : [m], on the grid.  before : level to start from.
    """
    whole = Window(0, grid.n, 0, grid.n)
    problem = LevelProblem(grid, gap, float(np.ptp(gap)), whole, before, indenter, body, numerics)
    rounds = numerics.edge_rounds
    level = problem.solve(0.0, 0.0, None, max(numerics.tolerance, 1e-5) if rounds else numerics.tolerance)
    thickness = body.thickness[0] if body.coatings else None
    share = numerics.edge_terms
    fit = partial(edge_profile.of_contact, r=grid.radius, d=grid.d, thickness=thickness, share=share)
    shape = None
    for k in range(rounds):
        shape = fit(level.found.pressure, skip=SKIPS[min(k, len(SKIPS) - 1)])
        if shape is None:
            return problem.solve(0.0, 0.0, level, numerics.tolerance)
        on_patches = shape.pressure(grid.radius)
        missing = shape.load - float(on_patches.sum() * grid.d**2)
        exact = abel.deflection(shape.radius, shape.coefficients, body.moduli[0], indenter.table, grid.radius)
        tolerance = numerics.tolerance if k == rounds - 1 else max(numerics.tolerance, 1e-6)
        level = problem.solve(exact - problem.deflection(on_patches), missing, level, tolerance)
    if shape is not None:
        shape = fit(level.found.pressure, skip=SKIPS[-1])
    return Level(grid, level.found, shape, level.load, level.convolutions)
