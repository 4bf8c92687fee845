"""Logarithmic Hankel transform against closed forms, point-force tables against small squares."""

import numpy as np
import pytest
from scipy.special import gamma, hyp2f1

from semianalytic import halfspace
from semianalytic.hankel import LONG, USUAL, hankel
from semianalytic.inputs import Body
from semianalytic.point_force import displacement_below, stress_below


def laplace(m, n, r, L):
    """int_0^inf k^n e^{-kL} J_m(kr) dk, Gradshteyn and Ryzhik 6.621.1."""
    s = r / L
    series = hyp2f1((m + n + 1) / 2, (m + n + 2) / 2, m + 1, -(s**2))
    return (s / 2) ** m * gamma(m + n + 1) / gamma(m + 1) * series / L ** (n + 1)


@pytest.mark.parametrize("order", [0, 1, 2, 3])
@pytest.mark.parametrize("over_k", [False, True])
@pytest.mark.parametrize("decay", [1.0, 1.7, 4.0])
@pytest.mark.parametrize("grid", [USUAL, LONG])
def test_transform_of_polynomials_times_exponentials_is_the_closed_form(order, over_k, decay, grid):
    scale = 3e-5  # lengths in metres as they come
    x, radii = grid.wavenumbers, grid.radii
    F = (1 + 0.5 * x - 0.3 * x**2) * np.exp(-decay * x)
    first = 0 if over_k else 1
    exact = sum(c * laplace(order, first + n, radii, decay) for n, c in enumerate((1, 0.5, -0.3)))
    exact = exact / (2 * np.pi * scale ** (1 if over_k else 2))
    g = hankel(F, order, scale, over_k=over_k, grid=grid)
    used = (radii > 0.01) & (radii < 1e3)
    weight = (1 + radii) ** (1 if over_k else 2)
    error = np.abs(g - exact)[used] * weight[used] / np.abs(exact[used]).max()
    # 2e-8 as the module states for features on the scale L; smoother ones cost more, wavenumbers being few
    assert error.max() < 2e-8 * decay**2


@pytest.mark.parametrize("nu", [0.0, 0.3, 0.5])
def test_point_force_tables_are_boussinesq_and_cerruti(nu):
    f, E, z, side = 0.4, 2.0, np.array([1.0, 1.5]), 1e-2
    rng = np.random.default_rng(3)
    x, y = rng.normal(size=(2, 40)) * 4
    x[:3], y[:3] = (0, 1e-3, 100), (0, 2e-3, 40)
    body = Body((), (E, nu), f)
    stresses = stress_below(z, 0, 1.0, body)
    displacements = displacement_below(z, 0, 1.0, body)
    for depth, stress, displacement in zip(z, stresses, displacements, strict=True):
        exact = np.zeros((6, x.size))
        moved = np.zeros((3, x.size))
        # squares of side 2e-2 and 1e-2 extrapolated to a point: (side/z)^4 = 1e-8
        for s, weight in ((side, 4 / 3), (2 * side, -1 / 3)):
            square = halfspace.normal_stress(x, y, depth, s, s, nu)
            square = square + f * halfspace.tangential_stress(x, y, depth, s, s, nu)
            exact += weight / s**2 * square[(0, 1, 2, 0, 0, 1), (0, 1, 2, 1, 2, 2)]
            moved += weight / s**2 * halfspace.normal_displacement(x, y, depth, s, s, E, nu)
            moved += weight / s**2 * f * halfspace.tangential_displacement(x, y, depth, s, s, E, nu)
        assert np.abs(stress(x, y) - exact).max() < 1e-7 * np.abs(exact).max()
        assert np.abs(displacement(x, y) - moved).max() < 3e-7 * np.abs(moved).max()
