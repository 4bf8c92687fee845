"""Contact on one grid, corrected for the square root of the pressure at a smooth edge, in rounds.

A round fits the shape of the edge to the pressures of the patches (``edge_shape``), adds what constant
patches miss of its deflection to the gap (``smooth_edge``) and solves the contact on the patches again. Its
fixed point is the contact under f + (p - f at the centres), f within the patches, p at their centres; each
round leaves a fifth to a tenth of the error.
"""

from dataclasses import replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from semianalytic import numbers
from semianalytic.coefficients import influence
from semianalytic.edge import edge_shape, smooth_edge
from semianalytic.edge.edge_shape import Shape, Step
from semianalytic.patches.level import Level, LevelProblem

Array = NDArray[np.floating]


def corrected(problem: LevelProblem) -> Level:
    """Contact on a window with its edge corrected; of the patches alone where the edge is not a smooth curve.

    The rounds start with the shape on the coarser grid, where there is one.
    """
    before = problem.before
    start = None if before is None else before.shape
    if before is not None and start is not None and start.outside:
        start = None if min(start.axes) < numbers.FEW_PATCHES * before.grid.d else start
    if start is not None:
        terms = numbers.OUTER_TERMS if start.outside else _terms(start, problem.grid.d)
        level = _rounds(problem, start.with_terms(terms), None)
        if level is not None:
            return level
    alone = problem.solve()
    p = alone.found.pressure
    shape = _start(problem, p)
    if shape is None:
        return alone
    # all of the pressure or, where its inside is not smooth, what is near the edge
    outside = (
        () if problem.indenter.round else (replace(shape.with_terms(numbers.OUTER_TERMS), outside=True),)
    )
    for first in (shape, *outside):
        level = _rounds(problem, first, p)
        if level is not None:
            return replace(level, convolutions=level.convolutions + alone.convolutions)
    return alone


def _rounds(problem: LevelProblem, shape: Shape, p: Array | None) -> Level | None:
    """Rounds of fit and contact from a shape; None where the edge that they find is not that of the patches.

    p : pressure of the patches alone [Pa], to which the shape is fitted first; None for a shape that is
    fitted.
    """
    grid, (x, y) = problem.grid, problem.centres
    near, weight, convolutions = _near_influence(problem), grid.weight(problem.gap.shape), 0
    step: Step | None = None
    moved, unsettled = np.inf, 0.0
    fit = partial(edge_shape.fitted, x=x, y=y, deflection=problem.deflection, weight=weight, patch=grid.d)
    fresh = p is not None
    if p is None:  # f is smoother than the interpolated pressure of the patches
        p = problem.first_guess() if shape.outside else shape.pressure(x, y)
    for number in range(numbers.ROUNDS):
        # the patches alone know the radius better than the shape of their pressure near the edge
        if fresh and number < numbers.HELD_ROUNDS:
            shape, _ = fit(shape, p, fixed_edge=True)
        elif fresh and number == numbers.HELD_ROUNDS:
            for _ in range(2):
                shape, _ = fit(shape, p)
        edge = smooth_edge.edge_patches(shape, p, grid, problem.window)
        if not edge.misfit < numbers.COARSE_MISFIT and number >= numbers.HELD_ROUNDS:
            return None
        u, missing = smooth_edge.beyond_centres(edge, p, grid, problem.deflection, near)
        if not abs(missing) < numbers.LOST * grid.force(p):
            return None
        level = problem.solve(u, missing, start=p)
        convolutions += level.convolutions + 1
        p = level.found.pressure
        if fresh and number < numbers.HELD_ROUNDS:
            continue
        shape, step = fit(shape, p, before=step)
        before = moved
        moved = float(np.abs(step.change[-len(shape.harmonics) :]).sum()) * min(shape.axes)
        # rounds converge as a geometric series; no faster than the slowest seen, no slower than by halves
        fall = min(max(moved / before, 0.2), 0.5)
        unsettled = moved * fall / (1 - fall)
        if moved < numbers.STILL * grid.d:
            break
    edge = smooth_edge.edge_patches(shape, p, grid, problem.window)
    edge = replace(edge, parts=edge.parts.mean(axis=1, keepdims=True))  # all that is needed from now on
    if not edge.misfit < numbers.MISFIT or min(shape.axes) < numbers.NARROW_EDGE * grid.d:
        return None
    if abs(shape.radius - level.radius) > grid.d:  # a contour that loops between the patches
        return None
    if not (problem.indenter.round or shape.outside):
        missed = np.where(p > 0, np.abs(p - shape.pressure(x, y)), 0.0)
        missed[edge.i, edge.j] = 0.0
        if missed.max() > numbers.INNER_MISFIT * p.max():
            return None
    return replace(level, shape=shape, edge=edge, convolutions=convolutions, unsettled=unsettled)


def _start(problem: LevelProblem, p: Array) -> Shape | None:
    """Shape to begin with, None where the contact is no single island of some width, away from the rim.

    Nor two, each the other's mirror image.
    """
    grid = problem.grid
    harmonics: tuple[int, ...] = edge_shape.FULL
    if problem.indenter.round:
        harmonics = numbers.ROUND
    elif grid.quarter:
        harmonics = numbers.EVEN
    elif np.allclose(problem.gap, problem.gap[:, ::-1], rtol=0.0, atol=numbers.ROUNDING * problem.depth):
        harmonics = numbers.ACROSS
    whole = grid.whole(p)
    x, y = grid.whole_centres(problem.window)
    twin = grid.quarter and not (whole[np.abs(x) < grid.d] > 0).any()
    if twin:
        harmonics = numbers.HALF
        whole = np.where(x[:, None] > 0, whole, 0.0)
    if not _is_island(whole > 0):
        return None
    shape = edge_shape.start(whole, x[:, None], y, harmonics, numbers.FEWEST_TERMS, grid.d**2)
    if min(shape.axes) < numbers.NARROW_EDGE * grid.d:
        return None
    both = problem.body.response
    layer = numbers.LAYER * both.depth / min(shape.axes) if both else np.inf
    shape = replace(shape, layer=layer if layer < numbers.THICK else np.inf, twin=twin)
    highest = (
        np.inf
        if harmonics == edge_shape.FULL
        else max(numbers.LOW_HARMONICS, min(shape.axes) / grid.d / numbers.PATCHES_A_WIDTH)
    )
    return shape.with_terms(_terms(shape, grid.d), highest)


def _is_island(loaded: NDArray[np.bool_]) -> bool:
    """Whether the contact is connected, without holes or notches deeper than a patch along rows and
    columns."""
    for marks in (loaded, loaded.T):
        changes = np.count_nonzero(marks[:, 1:] & ~marks[:, :-1], axis=1) + marks[:, 0]
        if np.count_nonzero(changes > 1) > 0:
            return False
    return bool(loaded.any())


def _terms(shape: Shape, d: float) -> int:
    """Polynomials of q on patches of side ``d`` [m].

    Of an analytic function the error falls as exp(-c M), c from the distance of its singularities (Boyd,
    Chebyshev and Fourier Spectral Methods (2001), section 2), here over the length asinh(1/e). More than the
    patches resolve would fit their errors: the zero of the last polynomial next to the edge,
    t = 1.4 e asinh(1/e)/M^2, is to be no nearer than a quarter of a patch. They grow in number with the
    patches, so that a refinement study shows what the polynomials leave out too.
    """
    if np.isinf(shape.layer):
        return numbers.FEWEST_TERMS
    patches, e = min(shape.axes) / d, shape.layer
    length = float(np.arcsinh(1 / e))
    finer = max(0.0, float(np.log(patches / numbers.USUAL_RADIUS) / np.log(1.4)))
    wanted = numbers.LAYERED[0] + numbers.LAYERED[1] * length + finer
    resolved = numbers.RESOLVED_TERMS * np.sqrt(e * length * patches)
    return int(max(numbers.FEWEST_TERMS, min(wanted, patches / numbers.PATCHES_A_WIDTH, resolved)))


def _near_influence(problem: LevelProblem) -> Array:
    """``smooth_edge.near_influence`` of the patches of a problem."""
    near, parts, d = numbers.NEAR_PARTS, numbers.PARTS, problem.grid.d
    of_patch, of_part = (
        influence.surface_coefficients(n, side, problem.body, problem.numerics)
        for n, side in ((near + 2, d), ((near + 1) * parts, d / parts))
    )
    return smooth_edge.near_influence(of_patch, of_part)
