"""Contact on one grid: a quarter of the plane, and what the iteration leaves."""

import tracemalloc
from dataclasses import replace

import numpy as np
import pytest

from semianalytic import arrays, convolution, level
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


def test_preconditioner_of_single_precision_finds_the_same_contact(monkeypatch):
    """Rough surface under load, coated: the same iterations, the gap closed within the same tolerance."""
    rng, body = np.random.default_rng(5), Body(((4.0, 0.3, 0.05),), (1.0, 0.3), 0.0)
    grid = Grid(97, 1 / 48)
    wave = np.cos(np.outer(np.arange(2, 9), np.pi * grid.x) + rng.uniform(0, 6, (7, 1)))
    gap = grid.radius**2 / 4 + wave.T @ rng.normal(size=(7, 7)) @ wave / 300
    gap -= gap.min()
    indenter = Indenter(lambda grid: gap, 0.05, None, round=False)
    found = []
    for patches in (level.SINGLE, 0):
        monkeypatch.setattr(level, "SINGLE", patches)
        problem = LevelProblem(grid, gap, float(gap.max()), grid.window, None, indenter, body, Numerics())
        assert problem.work.dtype == (np.float64 if patches else np.float32)
        found.append(problem.solve(0.0, 0.0).found)
    double, single = found
    assert double.iterations > 8
    assert abs(single.iterations - double.iterations) <= 1
    assert max(single.gap_inside, single.penetration_outside) <= 1e-8
    assert single.load_error < 1e-14
    assert single.approach == pytest.approx(double.approach, rel=1e-8)
    np.testing.assert_allclose(single.pressure, double.pressure, rtol=0, atol=1e-6 * double.pressure.max())


def test_memory_of_a_contact_on_half_of_the_square(monkeypatch):
    """At most 30 bytes a patch above the 24 of pressure, gap and kernel; as of a large grid, in small."""
    monkeypatch.setattr(level, "SINGLE", 0)
    for module in (convolution, arrays):
        monkeypatch.setattr(module, "BLOCK", 2**11)
    n, body = 320, Body((), (1.0, 0.0), 0.0)

    def gap(grid):
        waves = 0.01 * (2 - np.cos(9 * grid.x - 0.1)[:, None] - np.cos(9 * grid.x))
        return waves + np.maximum(np.hypot(grid.x[:, None], grid.x) - 0.6, 0) ** 2

    indenter = Indenter(gap, None, 0.01, round=False)
    before = solve_on(Grid(n // 2, 4 / n), None, indenter, body, Numerics(tolerance=1e-4))
    tracemalloc.start()
    found = solve_on(Grid(n, 2 / n), before, indenter, body, Numerics(tolerance=1e-4)).found
    memory = tracemalloc.get_traced_memory()[1] / n**2
    tracemalloc.stop()
    loaded = np.flatnonzero(found.pressure.any(axis=0))
    assert 0.6 < (loaded[-1] - loaded[0]) / n < 0.75  # its window is half of the square
    assert memory < 24 + 30
