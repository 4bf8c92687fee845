"""Change of a contact by other influence coefficients: against the contact solved again, and reciprocity."""

from dataclasses import replace

import numpy as np
import pytest

from semianalytic import influence, perturbation, uncertainty
from semianalytic.grid import Grid, odd
from semianalytic.inputs import Body, Numerics
from semianalytic.level import Indenter
from semianalytic.nested import levels, solve_on

SUBSTRATE = (1.0, 0.3)
TIGHT = 1e-10


def rough(rng, amplitude):
    """Waves that the patches resolve, on a paraboloid; lengths in the half-width of the box."""
    phase, k = rng.uniform(0, 2 * np.pi, (6, 2)), rng.uniform(2, 5, (6, 2))
    curved = rng.uniform(0.7, 1.4, 2)

    def gap(grid):
        x, y = grid.x[:, None], grid.x
        waves = sum(np.cos(a * x + s) * np.cos(b * y + t) for (a, b), (s, t) in zip(k, phase, strict=True))
        z = curved[0] * x**2 + curved[1] * y**2 + amplitude * waves
        return z - z.min()

    return gap


def problem(seed, amplitude=0.01):
    rng = np.random.default_rng(seed)
    ratio, h = np.exp(rng.uniform(-2, 2)), np.exp(rng.uniform(-3, 0))
    body = Body(((ratio, 0.3, h),), SUBSTRATE, 0.0)
    by_load = rng.random() < 0.7
    load, approach = (rng.uniform(0.05, 0.15), None) if by_load else (None, rng.uniform(0.05, 0.1))
    return body, Indenter(rough(rng, amplitude), load, approach, round=False)


def coefficients(n, d, body, numerics, other):
    return tuple(influence.surface_coefficients(n, d, body, one) for one in (numerics, other))


def changes(seed, numerics, other, n=49):
    """By the perturbation, and by solving again."""
    body, indenter = problem(seed)
    grid = Grid(n, 2 / n)
    level = solve_on(grid, None, indenter, body, numerics)
    K, K_other = coefficients(n, grid.d, body, numerics, other)
    found = perturbation.of_kernel(level, K_other - K, other, indenter, body, numerics)
    again = solve_on(grid, None, indenter, body, other)
    return level, found, uncertainty.change(level.scalars, again.scalars)


def check(seed, numerics, other):
    level, found, again = changes(seed, numerics, other)
    noise = 10 * TIGHT * level.found.approach
    assert found["approach"] == pytest.approx(again["approach"], rel=0.05, abs=noise)
    scale = level.scalars["peak_pressure"]
    # a tenth for the second order, the square of the change of the kernel
    second = (again["peak_pressure"] + again["approach"] / level.found.approach * scale) ** 2 / scale
    assert found["peak_pressure"] == pytest.approx(again["peak_pressure"], rel=0.1, abs=1e-7 * scale + second)


PLAIN = Numerics(conversion="plain", tolerance=TIGHT, edge_correction=False)
SPLIT = replace(PLAIN, conversion="split")
COARSE = replace(SPLIT, hankel_points=512)


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("numerics", [PLAIN, COARSE], ids=["plain", "coarse"])
def test_change_of_a_contact_by_its_coefficients_is_that_of_solving_again(seed, numerics):
    check(seed, numerics, SPLIT)


@pytest.mark.slow
@pytest.mark.parametrize("numerics", [PLAIN, COARSE], ids=["plain", "coarse"])
def test_change_of_a_hundred_contacts_is_that_of_solving_again(numerics):
    for seed in range(100):
        check(seed, numerics, SPLIT)


@pytest.mark.parametrize("seed", [0, 1, 2])
def test_change_of_the_approach_is_the_mean_over_a_flat_punch(seed):
    """d(delta) = q . dK p, q of unit load, by direct solution on the contact set."""
    body, indenter = problem(seed)
    indenter = replace(indenter, load=0.1, approach=None)
    n = 33
    grid = Grid(n, 2 / n)
    level = solve_on(grid, None, indenter, body, SPLIT)
    K, K_other = coefficients(n, grid.d, body, SPLIT, replace(SPLIT, conversion="plain"))
    i, j = np.nonzero(level.found.pressure)
    near = abs(i[:, None] - i), abs(j[:, None] - j)
    q = np.linalg.solve(K[near], np.ones(i.size))
    expected = abs(q @ (K_other - K)[near] @ level.found.pressure[i, j] / q.sum())
    found = perturbation.of_kernel(level, K_other - K, SPLIT, indenter, body, SPLIT)
    assert found["approach"] == pytest.approx(expected, rel=5e-3)
    assert q.min() > 0  # so that the gap the iteration leaves moves the approach by no more than its largest


def test_change_of_a_smooth_edge_is_about_that_of_solving_again():
    """Within a factor of two in pressure: the correction changes once more with the pressure."""
    body, numerics = Body((), SUBSTRATE, 0.0), replace(PLAIN, tolerance=1e-8)
    grid = Grid(49, 2 / 49)
    indenter = Indenter(
        lambda grid: np.add.outer(grid.x**2, 1.5 * grid.x**2), 0.15, None, round=False, edge_correction=True
    )
    level, again = (solve_on(grid, None, indenter, body, one) for one in (numerics, SPLIT))
    K, K_other = coefficients(49, grid.d, body, numerics, SPLIT)
    found = perturbation.of_kernel(level, K_other - K, SPLIT, indenter, body, numerics)
    expected = uncertainty.change(level.scalars, again.scalars)
    assert level.edge is not None
    assert again.edge is not None
    assert found["approach"] == pytest.approx(expected["approach"], rel=0.1)
    for name in ("peak_pressure", "contact_radius"):
        assert 0.5 < found[name] / expected[name] < 2


def test_change_is_magnified_out_of_the_noise_and_in_proportion():
    body, indenter = problem(1)
    n = 49
    level = solve_on(Grid(n, 2 / n), None, indenter, body, SPLIT)
    K, K_other = coefficients(n, 2 / n, body, SPLIT, replace(SPLIT, conversion="plain"))
    one, small = (
        perturbation.of_kernel(level, factor * (K_other - K), SPLIT, indenter, body, SPLIT)
        for factor in (1, 1e-8)
    )
    for name in ("approach", "peak_pressure"):
        assert 1e8 * small[name] == pytest.approx(one[name], rel=0.02)
    none = perturbation.of_kernel(level, 0 * K, SPLIT, indenter, body, SPLIT)
    assert set(none.values()) == {0.0}


@pytest.mark.parametrize("amplitude", [0.0, 0.01])
@pytest.mark.parametrize("edge", [True, False])
def test_gap_left_by_the_iteration_bounds_its_error(amplitude, edge):
    for seed in range(3):
        body, indenter = problem(seed, amplitude)
        indenter = replace(indenter, edge_correction=edge)
        loose, tight = (
            levels(1.0, indenter, body, Numerics(patches=65, tolerance=t, edge_correction=False), False)[-1]
            for t in (1e-5, TIGHT)
        )
        U = uncertainty._of_iteration(loose, indenter)
        error = uncertainty.change(tight.scalars, loose.scalars)
        assert error["approach"] <= 1.01 * U["approach"] + 1e-9 * loose.found.approach
        assert error["peak_pressure"] <= 1.5 * U["peak_pressure"]


def test_contact_beyond_the_box_counts_in_the_domain():
    """A pillar just outside the box, as high as the indenter's tip."""
    numerics, body = Numerics(patches=65, edge_correction=False), Body((), SUBSTRATE, 0.0)

    def gap(grid):
        z = np.add.outer(grid.x**2, grid.x**2)
        return np.where(np.abs(grid.x) > 1.05, 0.0, z) if pillar else z

    budget = {}
    for pillar in (False, True):
        indenter = Indenter(gap, 0.1, None, round=False)
        found = levels(1.0, indenter, body, numerics, True)
        rows = uncertainty.of_contact(found, indenter, body, numerics).budget
        budget[pillar] = {q: value for q, varied, value in rows if varied == "domain"}
    assert set(budget[False].values()) == {0.0}
    assert budget[True]["approach"] > 0.1 * found[-1].found.approach


def test_kernel_by_fft_depends_on_its_domain():
    body, indenter = problem(2)
    indenter = replace(indenter, load=0.1, approach=None)
    numerics = replace(PLAIN, patches=65)
    found = levels(1.0, indenter, body, numerics, True)
    rows = uncertainty.of_contact(found, indenter, body, numerics).budget
    domain = {q: value for q, varied, value in rows if varied == "domain"}
    coarse = found[-3].grid
    wide = solve_on(replace(coarse, n=odd(uncertainty.WIDER * coarse.n)), None, indenter, body, numerics)
    again = uncertainty.change(found[-3].scalars, wide.scalars)
    assert domain["approach"] == pytest.approx(again["approach"], rel=0.05)
