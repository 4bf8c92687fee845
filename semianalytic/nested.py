"""Nested iteration: contacts on ever finer grids, each started from the one before."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from semianalytic import convolution, influence
from semianalytic.arrays import copy, namespace, to_numpy
from semianalytic.contact import NotConverged
from semianalytic.defect_correction import corrected, smoothed
from semianalytic.edge_profile import Profile
from semianalytic.grid import Grid, Window, odd, touches_rim, window_around
from semianalytic.inputs import COARSEST, Body, Numerics
from semianalytic.level import Indenter, Level, LevelProblem

__all__ = ["is_alone", "levels", "lowest_point", "solve_on", "undeformed"]

Array = NDArray[np.floating]

STRIDE = 2.8  # of grids that only give the start: iterations on the next one are about as many as by halves
HALVINGS = 6  # of steps to the lowest point between the patches, off by 1e-4 of the height over a patch
QUICK = 60  # iterations, more than a contact takes that the patches resolve


def levels(
    half_width: float, indenter: Indenter, body: Body, numerics: Numerics, estimate_uncertainty: bool
) -> list[Level]:
    """Contacts on N/4, N/2 and N patches a side for an uncertainty, else on N; each with its edge profile.

    Those on coarser grids before them, without, give the start. Where they do not converge quickly, under
    films a thousand times stiffer than what lies below, the start is the edge profile.
    """
    kept = 3 if estimate_uncertainty else 1
    sizes = [numerics.patches]
    while len(sizes) < kept:
        sizes.insert(0, odd(sizes[0] / 2))
    stride = 2.0 if indenter.shapes else STRIDE
    while sizes[0] > 2 * COARSEST:
        sizes.insert(0, odd(sizes[0] / stride))
    shapes: list[Profile | None] = [None] * len(sizes)
    for k, profile in enumerate(indenter.shapes[:kept]):
        shapes[-1 - k] = profile
    starter = replace(numerics, tolerance=max(3e-4, numerics.tolerance))
    if indenter.shapes:
        starter = replace(starter, max_iterations=min(QUICK, numerics.max_iterations))
    found: list[Level] = []
    rough = replace(indenter, edge_correction=False, between=None)
    for k, (n, shape) in enumerate(zip(sizes, shapes, strict=True)):
        used, pressed = (numerics, indenter) if k >= len(sizes) - kept else (starter, rough)
        before, grid = found[-1] if found else None, Grid(n, 2 * half_width / n, indenter.round)
        try:
            found.append(solve_on(grid, before, pressed, body, used, shape))
            if k < len(sizes) - kept and not indenter.shapes:
                found[-1] = _of_single_precision(found[-1])
            if not estimate_uncertainty:
                del found[:-1]
        except NotConverged:
            if not indenter.shapes:
                raise
            if shape is not None:
                found.append(solve_on(grid, None, indenter, body, used, shape))
    return found


def solve_on(
    grid: Grid,
    before: Level | None,
    indenter: Indenter,
    body: Body,
    numerics: Numerics,
    shape: Profile | None = None,
) -> Level:
    """Contact on a grid: of a sphere corrected by an edge profile, of others on the window they need.

    Where the gap is even in x and in y, so are all fields, and a quarter of the grid is enough, of NumPy.
    """
    if indenter.round:
        return corrected(grid, indenter.gap(grid), before, shape, indenter, body, numerics)
    grid, gap = undeformed(replace(grid, quarter=False), indenter)
    xp, whole = namespace(gap), grid.window
    datum = lowest_point(grid, gap, indenter)
    depth = float(xp.max(gap)) - datum
    if before is not None:
        before = before.whole if grid.quarter < before.grid.quarter else before
        window = window_around(before.found.pressure, before.grid, grid)
        if window.shape != whole.shape:
            lowest, gap = grid.lowest(gap), copy(gap[window.slices])
            lowest -= datum
            problem = LevelProblem(grid, gap, depth, window, before, indenter, body, numerics, datum)
            level = _solved(problem)
            del problem  # frees the memory of its transforms for those below
            level = _embedded(level, window, depth)
            if is_alone(level, lowest, window, body, numerics):
                return level
            _, gap = undeformed(replace(grid, quarter=False), indenter)
    problem = LevelProblem(grid, gap, depth, whole, before, indenter, body, numerics, datum)
    return _solved(problem)


def undeformed(grid: Grid, indenter: Indenter) -> tuple[Grid, Array]:
    """Gap on a whole grid; on a quarter, and that grid, where it is even in x and in y to the last digit."""
    gap = indenter.gap(grid)
    if not isinstance(gap, np.ndarray):
        return grid, gap
    c = (grid.n + 1) // 2
    rows = gap[:c]
    if np.array_equal(rows, gap[: -c - 1 : -1]) and np.array_equal(rows[:, :c], rows[:, : -c - 1 : -1]):
        grid = replace(grid, quarter=True)
        gap = grid.held(gap).copy()
    return grid, gap


def lowest_point(grid: Grid, gap: Array, indenter: Indenter) -> float:
    """Lowest gap on the patches and, where it is known between them, beside the lowest: by halving steps."""
    xp, lowest = namespace(gap), float(namespace(gap).min(gap))
    if indenter.between is None:
        return lowest
    x, y = (float(grid.x[k]) for k in divmod(int(xp.argmin(gap)), gap.shape[1]))
    for k in range(HALVINGS):
        step = np.array([0.0, -0.5, 0.5]) * grid.d / 2**k
        beside = [np.clip(centre + step, -grid.half_width, grid.half_width) for centre in (x, y)]
        z = np.broadcast_to(to_numpy(indenter.between(*map(xp.asarray, beside))), (3, 3))
        i, j = divmod(int(z.argmin()), 3)
        x, y, lowest = float(beside[0][i]), float(beside[1][j]), min(lowest, float(z[i, j]))
    return lowest


def _of_single_precision(level: Level) -> Level:
    """The same as a first guess, in half the memory."""
    found, xp = level.found, namespace(level.found.pressure)
    pressure, gap = (xp.asarray(values, dtype=xp.float32) for values in (found.pressure, found.gap))
    return replace(level, found=replace(found, pressure=pressure, gap=gap))


def _solved(problem: LevelProblem) -> Level:
    return smoothed(problem) if problem.indenter.edge_correction else problem.solve(0.0, 0.0)


def _embedded(level: Level, window: Window, depth: float) -> Level:
    across = level.grid.across(window)
    edge = None if level.edge is None else level.edge.embedded(across.i0, across.j0)
    found = level.found.embedded(window.slices, level.grid.window.shape, depth)
    return replace(level, found=found, edge=edge)


def is_alone(level: Level, lowest: Array, window: Window, body: Body, numerics: Numerics) -> bool:
    """Whether only the window is in contact: its rim is free, and the gap beyond it open.

    The deflection beyond is computed on patches of twice the side, which at the distance of the window's
    margin changes it by 1e-3; ``lowest`` is the smallest gap on each.
    """
    grid, p = level.grid, level.found.pressure
    # two rings: a smooth edge lies up to a patch beyond the last loaded one
    if touches_rim(p[window.slices], grid.quarter, rings=2):
        return False
    merged = grid.merged(p)
    n = 2 * len(merged) - grid.n % 2 if grid.quarter else merged.shape[0]
    kernel = influence.surface_coefficients(n, 2 * grid.d, body, numerics, namespace(p))
    g = convolution.even_convolution(kernel, quarter=grid.quarter, threads=numerics.threads)(merged)
    g += lowest
    g -= level.found.approach
    g[grid.merging(window).slices] = np.inf
    return bool(namespace(g).min(g) > 0)
