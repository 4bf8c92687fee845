"""Defect correction at the contact edge.

The error of constant patches at the square root of the edge is measured on a pressure whose deflection is
known better, and added to the gap. Of a sphere that is the edge profile, with its exact deflection: the
patches find what the profile leaves of the contact. Of other indenters it is the pressure of the patches
themselves, continued to a smooth edge (``smooth_edge``), in a few rounds.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from semianalytic import abel, influence, smooth_edge
from semianalytic.edge_profile import Profile
from semianalytic.grid import Grid
from semianalytic.inputs import Body, Numerics
from semianalytic.level import Indenter, Level, LevelProblem

__all__ = ["corrected", "smoothed"]

Array = NDArray[np.floating]

ROUNDS = 2  # of the correction by a smooth edge


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


def smoothed(problem: LevelProblem) -> Level:
    """Contact on a window, corrected where its edge is a smooth curve, of the patches alone where it is not.

    The deflection under p beyond the centres is added to the gap, which gives another p: a fixed point, from
    the patches alone by ``ROUNDS`` rounds. A third changes less than the patch size does.
    """
    level = alone = problem.solve(0.0, 0.0)
    convolutions, near = alone.convolutions, None
    defect: Array | float = 0.0
    missing = 0.0
    for number in range(ROUNDS):
        p = problem.grid.whole(level.found.pressure)
        fitted = smooth_edge.fit(p)
        if fitted is None:
            return alone
        edge, parts = fitted
        near = _near_influence(problem) if near is None else near
        u, beyond = edge.deflection_beyond_centres(parts, p, problem.deflection_of_whole, near)
        u = problem.held(u)
        # patches that the edge barely touches would alternate between two rounds
        defect, missing = ((defect + u) / 2, (missing + beyond) / 2) if number else (u, beyond)
        level = problem.solve(defect, missing * problem.grid.d**2, start=level.found.pressure)
        convolutions += level.convolutions + 1
    return replace(level, edge=edge, convolutions=convolutions)


def _near_influence(problem: LevelProblem) -> Array:
    d, near, parts = problem.grid.d, smooth_edge.NEAR, smooth_edge.PARTS
    of_patch, of_part = (
        influence.surface_coefficients(n, side, problem.body, problem.numerics)
        for n, side in ((near + 2, d), ((near + 1) * parts, d / parts))
    )
    return smooth_edge.near_influence(of_patch, of_part)
