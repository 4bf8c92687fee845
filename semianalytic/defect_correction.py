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
from semianalytic.arrays import namespace, to_numpy
from semianalytic.edge_profile import Profile
from semianalytic.grid import Grid
from semianalytic.inputs import Body, Numerics
from semianalytic.level import Indenter, Level, LevelProblem

__all__ = ["corrected", "defect", "fit", "near_influence", "smoothed"]

Array = NDArray[np.floating]
Fitted = tuple[smooth_edge.Edge, Array]

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
    level, gap = problem.solve(0.0, 0.0), problem.gap
    convolutions, near = level.convolutions, near_influence(problem.grid.d, problem.body, problem.numerics)
    missing = 0.0
    for number in range(ROUNDS):
        p = level.found.pressure
        fitted = fit(problem, p)
        if fitted is None:
            problem.gap = gap
            return problem.solve(0.0, 0.0) if number else level
        del level  # large, as are the others
        u, beyond = defect(problem, p, fitted, near)
        edge = fitted[0]
        u += gap
        # patches that the edge barely touches would alternate between two rounds
        problem.gap, missing = ((problem.gap + u) / 2, (missing + beyond) / 2) if number else (u, beyond)
        del fitted, u
        level = problem.solve(0.0, missing * problem.grid.d**2, start=p)
        convolutions += level.convolutions + 1
    return replace(level, edge=edge, convolutions=convolutions)


def fit(problem: LevelProblem, p: Array) -> Fitted | None:
    """Smooth edge of the pressure p [Pa] on a window, by NumPy; None where it has none."""
    return smooth_edge.fit(problem.grid.whole(p), even=problem.grid.quarter)


def defect(problem: LevelProblem, p: Array, fitted: Fitted, near: Array) -> tuple[Array, float]:
    """Deflection [m] and sum of p [Pa] that constant patches miss at a smooth edge of p [Pa] on a window.

    fitted : as from `fit`, its parts are overwritten.  near : `near_influence`.
    """
    xp, (edge, parts) = namespace(p), fitted

    def deflection(moments: Array) -> Array:
        u: Array = to_numpy(problem.deflection_of_whole(xp.asarray(moments)))
        return u

    u, missing = edge.deflection_beyond_centres(parts, to_numpy(problem.grid.whole(p)), deflection, near)
    return xp.asarray(problem.held(u)), missing


def near_influence(d: float, body: Body, numerics: Numerics) -> Array:
    """``smooth_edge.near_influence`` of patches of side d [m]."""
    near, parts = smooth_edge.NEAR, smooth_edge.PARTS
    of_patch, of_part = (
        influence.surface_coefficients(n, side, body, numerics)
        for n, side in ((near + 2, d), ((near + 1) * parts, d / parts))
    )
    return smooth_edge.near_influence(of_patch, of_part)
