"""Contact on one grid: what the iteration leaves, the staircase."""

from dataclasses import replace

import numpy as np
import pytest

from semianalytic import uncertainty
from semianalytic.inputs import Body, Numerics
from semianalytic.patches.contact import Contact
from semianalytic.patches.grid import Grid, Window
from semianalytic.patches.level import Indenter, Level, LevelProblem


def test_noise_bounds_the_pressure_of_a_checkerboard():
    """+-p on patches of side d: u = 2 p / (E* k), k = sqrt(2) pi / d the highest frequency of the grid."""
    grid, body, approach, p = Grid(33, 2.0), Body((), (3.0, 0.5), 0.0), 8.0, 1e-6
    gap = grid.radius**2 / 100
    indenter = Indenter(lambda grid: gap, None, approach, round=False)
    window = Window(0, grid.n, 0, grid.n)
    problem = LevelProblem(grid, gap, float(gap.max()), window, None, indenter, body, Numerics())
    i = np.arange(grid.n)
    u = problem.deflection(p * (-1.0) ** (i[:, None] + i))[grid.n // 2, grid.n // 2]
    noise = replace(problem, numerics=Numerics(tolerance=u / approach)).solve().noise
    # patches of constant pressure also hold harmonics of it: a third more at their centres
    assert p <= noise < 1.5 * p


@pytest.mark.parametrize("quarter", [False, True])
def test_staircase_of_a_disc_is_a_quarter_of_a_patch_of_its_radius(quarter):
    grid = Grid(401, 1 / 150, quarter)
    disc = Contact.of_load(np.where(grid.radius < 1, 1.0, 0.0))
    found = Level(grid, disc, np.pi, 0)
    assert found.radius == pytest.approx(1, rel=1e-3)
    assert found.edge_error == pytest.approx(grid.d / 4, rel=1e-2)


def test_patches_alone_are_refined_until_their_uncertainty_no_longer_falls():
    """Without a smooth edge no further grid can be the first to resolve it."""
    grids = [Grid(n, 2.4 / n) for n in (65, 91, 129, 183)]
    levels = [Level(grid, Contact.of_load(np.where(grid.radius < 1, 1.0, 0.0)), np.pi, 0) for grid in grids]
    assert uncertainty.is_stalled(1e-5, [2e-4, 2e-4, 2e-4], levels)
    assert not uncertainty.is_stalled(1e-5, [4e-4, 2e-4, 1e-4], levels)
