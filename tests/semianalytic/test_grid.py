"""Transfer of heights and of first guesses between grids."""

import numpy as np
import pytest

from semianalytic.patches.grid import Grid, Window, prolong, window_around


def _hertz(grid):
    """Pressure [E*] under a sphere and the gap beside it, a = R = E* = 1."""
    r = grid.radius
    outside = np.maximum(r, 1)
    # Johnson (1985) eq. 3.42a, with p0 = 2 / pi
    u = ((2 - outside**2) * np.arcsin(1 / outside) + np.sqrt(outside**2 - 1)) / np.pi
    gap = np.where(r > 1, u + r**2 / 2 - 1, 0)
    return 2 / np.pi * np.sqrt(np.maximum(1 - r**2, 0)), gap


def test_carried_over_contact_is_hertz_with_its_edge_between_the_patches():
    source, target = Grid(40, 0.06), Grid(160, 0.015)
    p, gap = _hertz(source)
    start = prolong(p, gap, source, target, Window(10, 150, 10, 150), 1.0)
    exact = _hertz(target)[0][10:150, 10:150]
    # linear interpolation of p^2, and of its continuation across the edge
    assert np.abs(start - exact)[target.radius[10:150, 10:150] < 0.9].max() < 2e-3
    # a quarter of the source's patch: without the continuation the edge is a patch of the source too wide
    a = np.sqrt(np.count_nonzero(start) / np.pi) * target.d
    assert abs(a - 1) < 0.25 * source.d
    # within a patch of the edge 1 % of p0 on average, half of it from taking a rim patch to lie 0.6 d inside
    ring = np.abs(target.radius - 1)[10:150, 10:150] < source.d
    assert np.sqrt(np.mean((start - exact)[ring] ** 2)) < 1e-2 * 2 / np.pi


def _even(grid):
    x, y = np.cos(3 * grid.x)[:, None], np.cos(2 * grid.x)
    return 2 + x * y + x**2


@pytest.mark.parametrize("n", [12, 14, 13, 15])
def test_even_field_is_that_of_its_quarter(n):
    whole, quarter = Grid(n, 0.1), Grid(n, 0.1, quarter=True)
    field, held = _even(whole), _even(quarter)
    np.testing.assert_array_equal(quarter.held(field), held)
    np.testing.assert_allclose(quarter.whole(held), field, rtol=0, atol=1e-14)
    np.testing.assert_allclose(quarter.ringed(held)[:-1, :-1], field[n // 2 - 1 :, n // 2 - 1 :], atol=1e-14)
    assert quarter.force(held) == pytest.approx(whole.force(field), rel=1e-14)
    m, k = n // 2 - 2, n // 2 - 4
    inner = quarter.across(Window(0, m, 0, k))
    np.testing.assert_allclose(quarter.whole(held[:m, :k]), field[inner.slices], rtol=0, atol=1e-14)


def test_window_around_a_contact_is_the_same_on_a_quarter():
    whole, source = Grid(40, 0.1), Grid(21, 0.2)
    p = np.where(np.hypot(source.x[:, None] / 0.7, source.x / 1.1) < 1, 1.0, 0.0)
    expected = window_around(p, source, whole)
    half, target = Grid(21, 0.2, quarter=True), Grid(40, 0.1, quarter=True)
    window = window_around(half.held(p), half, target)
    assert target.across(window) == expected
    assert window_around(p, source, target) == window
