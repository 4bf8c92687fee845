"""Contact on one grid: what the iteration leaves, the staircase, single precision, memory."""

import gc
import tracemalloc
from dataclasses import replace

import numpy as np
import pytest

from semianalytic import arrays, convolution, edge_shape, halved_convolution, level, smooth_edge
from semianalytic.contact import Contact
from semianalytic.grid import Grid, Window
from semianalytic.inputs import Body, Numerics
from semianalytic.level import Indenter, Level, LevelProblem
from semianalytic.nested import levels


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


@pytest.mark.parametrize("quarter", [False, True])
def test_staircase_of_a_disc_is_a_quarter_of_a_patch_of_its_radius(quarter):
    grid = Grid(401, 1 / 150, quarter)
    disc = Contact.of_load(np.where(grid.radius < 1, 1.0, 0.0))
    found = Level(grid, disc, np.pi, 0)
    assert found.radius == pytest.approx(1, rel=1e-3)
    assert found.staircase == pytest.approx(grid.d / 4, rel=1e-2)


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
        assert problem.single == (patches == 0)
        found.append(problem.solve(0.0, 0.0).found)
    double, single = found
    assert double.iterations > 8
    assert abs(single.iterations - double.iterations) <= 1
    assert max(single.gap_inside, single.penetration_outside) <= 1e-8
    assert single.load_error < 1e-14
    assert single.approach == pytest.approx(double.approach, rel=1e-8)
    np.testing.assert_allclose(single.pressure, double.pressure, rtol=0, atol=1e-6 * double.pressure.max())


@pytest.fixture
def small(monkeypatch):
    """Memory in small as of a large grid."""
    monkeypatch.setattr(level, "SINGLE", 0)
    monkeypatch.setattr(edge_shape, "HELD", 2**18)
    monkeypatch.setattr(smooth_edge, "AT_ONCE", 20)
    for module in (convolution, halved_convolution, arrays):
        monkeypatch.setattr(module, "BLOCK", 2**11)


def memory_of(indenter, n, **numerics):
    """Bytes a patch at the peak, and the contact."""
    gc.collect()
    tracemalloc.start()
    given = Numerics(patches=n, edge_correction=False, tolerance=1e-4, **numerics)
    found = levels(1.0, indenter, Body((), (1.0, 0.0), 0.0), given, False)[-1]
    memory = tracemalloc.get_traced_memory()[1] / n**2
    tracemalloc.stop()
    return memory, found


def waves(grid, k):
    return 0.01 * (2 - np.cos(k * grid.x - 0.1)[:, None] - np.cos(k * grid.x))


def test_memory_of_a_contact_on_half_of_the_square(small):
    """At most 30 bytes a patch above the 24 of pressure, gap and kernel."""

    def gap(grid):
        return waves(grid, 9) + np.maximum(np.hypot(grid.x[:, None], grid.x) - 0.6, 0) ** 2

    n = 320
    memory, found = memory_of(Indenter(gap, None, 0.01, round=False), n)
    loaded = np.flatnonzero(found.found.pressure.any(axis=0))
    assert 0.6 < (loaded[-1] - loaded[0]) / n < 0.75  # its window is half of the square
    assert memory < 24 + 25


@pytest.mark.slow
def test_memory_of_a_contact_all_over_the_square(small):
    """Strips of columns are a larger part of it than of 2048 x 2048 patches, where 29 bytes were measured."""
    n = 640
    heights = {grid: waves(Grid(grid, 2 / grid), 2 * np.pi) for grid in (29, 81, 229, n)}
    memory, found = memory_of(Indenter(lambda grid: heights[grid.n], None, 0.01, round=False), n)
    assert found.found.pressure[0].any()
    assert found.found.pressure[:, -1].any()
    assert memory < 24 + 36


@pytest.mark.slow
def test_memory_of_a_contact_with_a_smooth_edge(small):
    """Patches at the edge hold 121 numbers each, those of the grid before too.

    That is 80 bytes a patch here, 20 of 2400 x 2400 patches.
    """

    def gap(grid):
        x, y = grid.x[:, None], grid.x
        return x**2 + y**2 + 0.1 * x * y

    n = 600
    memory, found = memory_of(Indenter(gap, 0.6, None, round=False, edge_correction=True), n)
    assert found.edge is not None
    assert memory < 24 + 130
