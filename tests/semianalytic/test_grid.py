"""Transfer of heights and of first guesses between grids."""

import numpy as np
import pytest

from semianalytic.grid import Grid, Window, prolong


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


@pytest.mark.parametrize("n", [7, 12, 31])
def test_heights_on_other_patches_are_linear_between_the_given_centres(n):
    given, asked = Grid(12, 1 / 6), Grid(n, 2 / n)  # both fill the square of half-width 1

    def plane(x, y):
        return 1 + 2 * x[:, None] - 3 * y

    held = np.clip(asked.x, given.x[0], given.x[-1])
    sample = asked.sample(plane(given.x, given.x), 1.0)
    np.testing.assert_allclose(sample, plane(held, held), rtol=0, atol=1e-14)
