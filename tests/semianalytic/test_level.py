"""Contact on one grid: a quarter of the plane, and what the iteration leaves."""

from dataclasses import replace

import numpy as np
import pytest

from semianalytic.collocation import contact
from semianalytic.grid import Grid, Window
from semianalytic.inputs import Body, Numerics
from semianalytic.level import Indenter, LevelProblem
from semianalytic.nested import solve_on


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


@pytest.mark.parametrize(("E", "load", "approach"), [(0.2, 2e-3, None), (5.0, None, 0.05)])
def test_sphere_on_a_quarter_is_that_on_the_whole_plane(E, load, approach):
    """Two levels, the first from the gap alone, the second with the edge profile."""
    body = Body(((E, 0.3, 0.1),), (1.0, 0.3), 0.0)
    shape = contact(1.0, load, approach, body)[0].profile
    indenter = Indenter(lambda grid: grid.radius**2 / 2, load, approach, round=True)
    half_width, levels = 1.12 * shape.radius, []
    for quarter in (True, False):
        before = None
        for n, profile in ((33, None), (65, shape)):
            grid = Grid(n, 2 * half_width / n, quarter)
            before = solve_on(grid, before, indenter, body, Numerics(hankel_points=512), profile)
        levels.append(before)
    quarter, whole = levels[0].whole, levels[1]
    assert (quarter.found.iterations, quarter.convolutions) == (whole.found.iterations, whole.convolutions)
    assert quarter.load == pytest.approx(whole.load, rel=1e-13)
    assert quarter.scalars == pytest.approx(whole.scalars, rel=1e-12)
    for field in ("pressure", "gap"):
        expected = getattr(whole.found, field)
        atol = 1e-12 * np.abs(expected).max()
        np.testing.assert_allclose(getattr(quarter.found, field), expected, rtol=0, atol=atol)
