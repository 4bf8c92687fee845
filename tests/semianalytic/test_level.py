"""Pressure that the gap left by the iteration may cause on one grid."""

from dataclasses import replace

import numpy as np

from semianalytic.grid import Grid, Window
from semianalytic.inputs import Body, Numerics
from semianalytic.level import Indenter, LevelProblem


def test_noise_bounds_the_pressure_of_a_checkerboard():
    """+-p on patches of side d: u = 2 p / (E* k), k = sqrt(2) pi / d the highest frequency of the grid."""
    grid, body, approach, p = Grid(33, 2.0), Body((), (3.0, 0.5), 0.0), 8.0, 1e-6
    gap = grid.radius**2 / 100
    indenter = Indenter(lambda grid: gap, None, approach, round=False)
    window = Window(0, grid.n, 0, grid.n)
    problem = LevelProblem(grid, gap, float(gap.max()), window, None, indenter, body, Numerics())
    i = np.arange(grid.n)
    u = problem.deflection(p * (-1.0) ** (i[:, None] + i))[grid.n // 2, grid.n // 2]
    problem.numerics = replace(problem.numerics, tolerance=u / approach)
    noise = problem.solve(0.0, 0.0).noise
    # patches of constant pressure also hold harmonics of it: a third more at their centres
    assert p <= noise < 1.5 * p
