"""Change of a contact by a small change of its influence coefficients, without solving it again.

On a contact set kept, A p + g0 = delta 1 and sum p = P become, for A + dA,

    A dp = d(delta) 1 - dA p,    sum dp = 0    (at a given approach d(delta) = 0 in place of sum dp = 0).

Times q, the pressure of a flat punch of the same contact set, A q = c 1 and sum q = 1, since A is symmetric:

    d(delta) = q . dA p,

the approach changes by the mean of dA p, weighted with the pressure of the flat punch. A set that changes
counts in the second order: at the edge p ~ sqrt(s) falls to zero, and dp ~ 1/sqrt(s) there is an edge that
moves, (p + dp)^2 = K^2 (s + ds). For the change of pressure and edge the linear problem is solved with a free
edge: the contact that was found, under the gap dA p in addition, magnified to ``SIZE`` of the approach. A few
iterations give a thousandth of the change. The correction for a smooth edge is linear in A and changes alike.
"""

from copy import copy
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from semianalytic import arrays, convolution
from semianalytic.defect_correction import defect, fit, near_influence
from semianalytic.grid import window_around
from semianalytic.inputs import Body, Numerics
from semianalytic.level import Indenter, Level, LevelProblem

__all__ = ["of_kernel"]

Array = NDArray[np.floating]

SIZE = 1e-3  # of the gap dA p, over the approach, to which a smaller one is magnified
ACCURACY = 1e-3  # of the change


def of_kernel(
    level: Level, change: Array, other: Numerics, indenter: Indenter, body: Body, numerics: Numerics
) -> dict[str, float]:
    """Changes of the scalars of a contact of patches by that of its influence coefficients.

    change : dK [m/Pa], at least as many offsets as the grid has patches a side.  other : numerics of those
    within a patch at a smooth edge.
    """
    grid, found = level.grid, level.found
    window = window_around(found.pressure, grid, grid)
    p = arrays.copy(found.pressure[window.slices])
    problem = LevelProblem(grid, p, found.approach, window, level, indenter, body, numerics)
    # the undeformed gap with the correction for a smooth edge, where there is one
    problem.gap = found.gap[window.slices] + found.approach - problem.deflection(p)
    fitted = None if level.edge is None else fit(problem, p)
    before = replace(level, found=replace(found, pressure=p, gap=problem.gap), edge=fitted and fitted[0])
    varied = copy(problem)
    nx, ny = grid.across(window).shape
    varied.deflection = convolution.even_convolution(
        change[:nx, :ny], quarter=grid.quarter, threads=numerics.threads
    )
    load = varied.deflection(p)
    if fitted is not None:
        near = near_influence(grid.d, body, other) - near_influence(grid.d, body, numerics)
        load += defect(varied, p, fitted, near)[0]
    inside = load[p > 0]
    xp = arrays.namespace(inside)
    low, high = float(xp.min(inside)), float(xp.max(inside))
    size = high - low if indenter.approach is None else max(-low, high)
    if not size:
        return dict.fromkeys(level.scalars, 0.0)
    magnified = max(1.0, SIZE * found.approach / size)
    problem.numerics = replace(numerics, tolerance=min(ACCURACY * magnified * size / found.approach, 0.1))
    after = problem.solve(magnified * load, level.load - grid.force(p), start=p)
    fitted = fitted and fit(problem, after.found.pressure)
    after = replace(after, edge=fitted and fitted[0])
    return {name: abs(value - before.scalars[name]) / magnified for name, value in after.scalars.items()}
