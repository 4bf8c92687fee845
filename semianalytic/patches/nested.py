"""Nested iteration: contacts on ever finer grids, each started from the one before."""

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from semianalytic import numbers
from semianalytic.coefficients import influence
from semianalytic.edge.edge_correction import corrected
from semianalytic.inputs import Body, Numerics
from semianalytic.patches import convolution
from semianalytic.patches.grid import Grid, Window, odd, touches_rim, window_around
from semianalytic.patches.level import Indenter, Level, LevelProblem

Array = NDArray[np.floating]


def levels(
    half_width: float, indenter: Indenter, body: Body, numerics: Numerics, estimate_uncertainty: bool
) -> list[Level]:
    """Contacts on the three grids of a refinement study, or on the last alone: N/2, N/1.4, N patches a side.

    Each starts from the one before, with the shape of its edge; the first from coarser grids of patches
    alone.
    """
    ratios: tuple[float, ...] = numbers.REFINED if indenter.edge_correction else numbers.HALVED
    if not estimate_uncertainty:
        ratios = (2.0, 1.0) if indenter.edge_correction else (1.0,)
    sizes = [odd(numerics.patches / ratio) for ratio in ratios[:-1]] + [numerics.patches]
    kept = len(sizes)
    while sizes[0] > 2 * numbers.COARSEST:
        sizes.insert(0, odd(sizes[0] / (2 * numbers.FINER)))
    starter = replace(numerics, tolerance=max(3e-4, numerics.tolerance))
    found: list[Level] = []
    rough = replace(indenter, edge_correction=False, between=None)
    for k, n in enumerate(sizes):
        used, pressed = (numerics, indenter) if k >= len(sizes) - kept else (starter, rough)
        before, grid = found[-1] if found else None, Grid(n, 2 * half_width / n, indenter.round)
        found.append(solve_on(grid, before, pressed, body, used))
        if not estimate_uncertainty:
            del found[:-1]
    return found


def solve_on(grid: Grid, before: Level | None, indenter: Indenter, body: Body, numerics: Numerics) -> Level:
    """Contact on a grid, on the window that it needs.

    Where the gap is even in x and in y, so are all fields, and a quarter of the grid is enough, of NumPy.
    """
    grid, gap = undeformed(replace(grid, quarter=False), indenter)
    whole = grid.window
    datum = lowest_point(grid, gap, indenter)
    depth = float(np.max(gap)) - datum
    of_window = partial(
        LevelProblem, grid, depth=depth, indenter=indenter, body=body, numerics=numerics, datum=datum
    )
    if before is not None and not indenter.round:
        before = before.whole if grid.quarter < before.grid.quarter else before
        window = window_around(before.found.pressure, before.grid, grid)
        if window.shape != whole.shape:
            level = _solved(of_window(gap=gap[window.slices], window=window, before=before))
            level = _embedded(level, window, depth)
            if is_alone(level, gap - datum, window, body, numerics):
                return level
    return _solved(of_window(gap=gap, window=whole, before=before))


def undeformed(grid: Grid, indenter: Indenter) -> tuple[Grid, Array]:
    """Gap on a whole grid; on a quarter, and that grid, where it is even in x and in y to the last digit."""
    if indenter.round:
        grid = replace(grid, quarter=True)
        return grid, indenter.gap(grid)
    gap = indenter.gap(grid)
    c = (grid.n + 1) // 2
    rows = gap[:c]
    if np.array_equal(rows, gap[: -c - 1 : -1]) and np.array_equal(rows[:, :c], rows[:, : -c - 1 : -1]):
        grid = replace(grid, quarter=True)
        gap = grid.held(gap).copy()
    return grid, gap


def lowest_point(grid: Grid, gap: Array, indenter: Indenter) -> float:
    """Lowest gap on the patches and, where it is known between them, beside the lowest: by halving steps."""
    lowest = float(np.min(gap))
    if indenter.between is None:
        return lowest
    x, y = (float(grid.x[k]) for k in divmod(int(np.argmin(gap)), gap.shape[1]))
    for k in range(numbers.HALVINGS):
        step = np.array([0.0, -0.5, 0.5]) * grid.d / 2**k
        beside = [np.clip(centre + step, -grid.half_width, grid.half_width) for centre in (x, y)]
        z = np.broadcast_to(indenter.between(*beside), (3, 3))
        i, j = divmod(int(z.argmin()), 3)
        x, y, lowest = float(beside[0][i]), float(beside[1][j]), min(lowest, float(z[i, j]))
    return lowest


def _solved(problem: LevelProblem) -> Level:
    return corrected(problem) if problem.indenter.edge_correction else problem.solve()


def _embedded(level: Level, window: Window, depth: float) -> Level:
    edge = level.edge
    edge = edge and replace(edge, i=edge.i + window.i0, j=edge.j + window.j0)
    found = level.found.embedded(window.slices, level.grid.window.shape, depth)
    return replace(level, found=found, edge=edge)


def is_alone(level: Level, gap: Array, window: Window, body: Body, numerics: Numerics) -> bool:
    """Whether only the window is in contact: its rim is free, and the ``gap`` beyond it stays open.

    By the deflection of patches of twice the side, and the lowest gap on each.
    """
    grid, p = level.grid, level.found.pressure
    # two rings: a smooth edge lies up to a patch beyond the last loaded one
    if touches_rim(p[window.slices], grid.quarter, rings=2):
        return False
    beyond = gap.copy()
    beyond[window.slices] = np.inf
    beyond = _merged(beyond, grid.n, np.minimum)
    n = 2 * len(beyond) - grid.n % 2 if grid.quarter else len(beyond)
    kernel = influence.surface_coefficients(n, 2 * grid.d, body, numerics)
    p = _merged(p, grid.n, lambda one, other: (one + other) / 2)
    u = convolution.even_convolution(kernel, quarter=grid.quarter, threads=numerics.threads)(p)
    return bool(np.min(u + beyond) > (1 + numbers.BESIDE_WINDOW) * level.found.approach)


def _merged(field: Array, n: int, joined: Callable[[Array, Array], Array]) -> Array:
    """Field on patches of twice the side: of an even number ``n`` two joined, of an odd one every other with
    half of both beside it; mirrored at the ends."""
    for _ in (0, 1):
        if n % 2:
            field = np.pad(field, ((1, 1), (0, 0)), mode="reflect")
            field = joined(field[:-1], field[1:])
        elif len(field) % 2:
            field = np.pad(field, ((0, 1), (0, 0)), mode="symmetric")
        field = joined(field[:-1:2], field[1::2]).T
    return field
