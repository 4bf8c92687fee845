"""Nested iteration: contacts on ever finer grids, each started from the one before."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from semianalytic import convolution, influence
from semianalytic.contact import NotConverged
from semianalytic.defect_correction import corrected
from semianalytic.grid import Grid, Window, odd, touches_rim, window_around
from semianalytic.inputs import COARSEST, Body, Numerics
from semianalytic.level import Indenter, Level, LevelProblem

__all__ = ["first_level", "levels", "solve_on"]

Array = NDArray[np.floating]


def levels(
    half_width: float,
    first: Level | None,
    indenter: Indenter,
    body: Body,
    numerics: Numerics,
    estimate_uncertainty: bool,
) -> list[Level]:
    """Contacts on .., N/4, N/2 and N patches a side.

    Where the edge is corrected the error falls fast: half the patches would overestimate it, so that N is
    compared with N/sqrt(2) patches, the terms of their edge profile reduced in proportion.
    """
    sizes = [numerics.patches]
    while sizes[0] > 2 * COARSEST or len(sizes) < 3:
        sizes.insert(0, odd(sizes[0] / 2))
    if estimate_uncertainty and numerics.edge_rounds:
        sizes.insert(-1, odd(sizes[-1] / 2**0.5))
    kept = 3 if estimate_uncertainty else 1
    starter = replace(numerics, tolerance=max(1e-5, numerics.tolerance), edge_rounds=0)
    found, level = [], first
    for k, n in enumerate(sizes):
        used = replace(numerics, edge_terms=n / numerics.patches) if k >= len(sizes) - kept else starter
        level = solve_on(Grid(n, 2 * half_width / n), level, indenter, body, used)
        found.append(level)
    return found


def first_level(half_width: float, indenter: Indenter, body: Body, numerics: Numerics) -> Level:
    """Contact on a coarse grid fitted to it, starting from a grid of ``half_width`` [m].

    Raises NotConverged where no grid fits.
    """
    rough = replace(numerics, tolerance=max(1e-4, numerics.tolerance), edge_rounds=0)
    for _ in range(12):
        grid = Grid(COARSEST, 2 * half_width / COARSEST)
        level = solve_on(grid, None, indenter, body, rough)
        a = level.radius
        if touches_rim(level.found.pressure):
            half_width *= 1.5  # a contact that reaches the rim hides its size
        elif numerics.fill * a > 0.75 * half_width:
            return level
        else:
            half_width = numerics.fill * max(a, 1.5 * grid.d)
    raise NotConverged(
        f"no grid was found that fits the contact, last half-width {half_width:.3g} m; "
        "the moduli of the layers may lie too far apart"
    )


def solve_on(grid: Grid, before: Level | None, indenter: Indenter, body: Body, numerics: Numerics) -> Level:
    """Contact on a grid: of a sphere its edge corrected, of another indenter on the window it needs."""
    gap = indenter.gap(grid)
    if indenter.round:
        return corrected(grid, gap, before, indenter, body, numerics)
    whole, depth = Window(0, grid.n, 0, grid.n), float(np.ptp(gap))
    if before is not None:
        window = window_around(before.found.pressure, before.grid, grid)
        if window.shape != whole.shape:
            lowest, gap = _lowest_of_four(gap), gap[window.slices].copy()
            problem = LevelProblem(grid, gap, depth, window, before, indenter, body, numerics)
            level = problem.solve(0.0, 0.0, None, numerics.tolerance)
            del problem  # frees the memory of its transforms for those below
            level = replace(level, found=level.found.embedded(window.slices, grid.n, depth))
            if _is_alone(level, lowest, window, body, numerics):
                return level
            gap = indenter.gap(grid)
    problem = LevelProblem(grid, gap, depth, whole, before, indenter, body, numerics)
    return problem.solve(0.0, 0.0, None, numerics.tolerance)


def _lowest_of_four(gap: Array) -> Array:
    """Smallest gap on patches of twice the side."""
    if len(gap) % 2:
        gap = np.pad(gap, (0, 1), mode="edge")
    rows = np.minimum(gap[::2], gap[1::2])
    return np.minimum(rows[:, ::2], rows[:, 1::2])


def _is_alone(level: Level, lowest: Array, window: Window, body: Body, numerics: Numerics) -> bool:
    """Whether only the window is in contact: its rim is free, and the gap beyond it open.

    The deflection beyond is computed on patches of twice the side, which at the distance of the window's
    margin changes it by 1e-3; ``lowest`` is the smallest gap of the four.
    """
    p = level.found.pressure
    if touches_rim(p[window.slices]):
        return False
    if level.grid.n % 2:
        p = np.pad(p, (0, 1))
    rows = p[::2] + p[1::2]
    merged = (rows[:, ::2] + rows[:, 1::2]) / 4
    del rows
    kernel = influence.surface_coefficients(len(lowest), 2 * level.grid.d, body, numerics)
    g = lowest + convolution.even_convolution(kernel, threads=numerics.threads)(merged) - level.found.approach
    g[window.i0 // 2 : -(-window.i1 // 2), window.j0 // 2 : -(-window.j1 // 2)] = np.inf
    return bool(g.min() > 0)
