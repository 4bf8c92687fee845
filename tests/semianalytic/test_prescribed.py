"""Prescribed pressures: their load, means over patches, and the patches that stand for them."""

import numpy as np
import pytest

from semianalytic.patches.prescribed import Prescribed, deconvolve, patch_mean


@pytest.mark.parametrize("power", [0, 0.5, 1, 3])
def test_load_is_the_integral_and_the_patches_carry_it(power):
    """Of (1 - r^2/a^2)^m over the disc: pi a^2/(m + 1)."""
    a, n, d = 2.0, 41, 0.11
    shape = Prescribed(a, lambda r: (1 - (r / a) ** 2) ** power)
    # 200 Gauss points of a polynomial in the distance from the rim
    assert shape.load == pytest.approx(np.pi * a**2 / (power + 1), rel=1e-12)
    x = (np.arange(n) - n // 2) * d
    mean = patch_mean(shape, x, d)
    assert mean.sum() * d**2 == pytest.approx(shape.load, rel=1e-12)
    r = np.hypot(x[:, None], x)
    outside, s = r > a + d, 1 - (r / a) ** 2
    assert not mean[outside].any()
    # p + d^2/24 lap p, lap s^m = 4 m/a^2 (m (s - 1) - s) s^(m-2) (-1); the next term is of order (d/a)^4
    inside = r < 0.5 * a
    s = s[inside]
    laplacian = 4 * power / a**2 * ((power - 1) * (1 - s) * s ** (power - 2) - s ** (power - 1))
    np.testing.assert_allclose(mean[inside], s**power + d**2 / 24 * laplacian, rtol=0, atol=3 * (d / a) ** 4)


def test_patches_equivalent_to_means_have_the_moments_of_a_cubic_pressure():
    """Means p + d^2/24 lap p; patches add as much again: p - d^2/24 lap p stands for p. Here d = 1."""
    x, y = np.meshgrid(np.arange(9.0), np.arange(8.0), indexing="ij")
    p, laplacian = x**3 - 2 * x * y + y**2 + 500, 6 * x + 2
    found = deconvolve(p + laplacian / 24)
    np.testing.assert_allclose(found[1:-1, 1:-1], (p - laplacian / 24)[1:-1, 1:-1], rtol=1e-13)
