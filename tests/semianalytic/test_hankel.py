"""Logarithmic Hankel transform against closed forms, point-force tables against Boussinesq and Cerruti."""

from functools import partial

import numpy as np
import pytest
from scipy.special import gamma, hyp2f1

from semianalytic.coefficients.hankel import LONG, USUAL, hankel
from semianalytic.coefficients.point_force import (
    displacement_below,
    half_space_displacement,
    half_space_stress,
    stress_below,
)
from semianalytic.inputs import Body


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
    E, body = 2.0, Body((), (2.0, nu), 0.4)
    r, depths = np.append(np.geomspace(1e-9, 100, 40), 1.0), np.array([1.0, 1.5])
    for below, closed, tolerance in (
        (stress_below, partial(half_space_stress, nu=nu, friction=0.4), 1e-7),
        (displacement_below, partial(half_space_displacement, E=E, nu=nu, friction=0.4), 3e-7),
    ):
        for z, table in zip(depths, below(depths, 0, 1.0, body), strict=True):
            exact, found = closed(r, z), table.radial(np.arcsinh(r)).T
            assert np.abs(found - exact).max() < tolerance * np.abs(exact).max()
