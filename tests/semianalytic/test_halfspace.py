"""Love, Boussinesq and Cerruti against quadrature, equilibrium, Hooke's law and each other."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import dblquad

from semianalytic.coefficients import halfspace
from semianalytic.coefficients.point_force import (
    combine_displacement,
    combine_stress,
    directions,
    half_space_displacement,
    half_space_stress,
)

SIX = ([0, 3, 4], [3, 1, 5], [4, 5, 2])


def of_forces(radial, combine, x, y):
    """Components of a normal and of a tangential unit force from the radial functions of both."""
    r = np.hypot(x, y)
    harmonics = directions(np.asarray(x / r), np.asarray(y / r))
    normal, both = (combine(radial, harmonics, friction) for friction in (0.0, 1.0))
    return np.stack([normal, both - normal])


def stress(x, y, z, nu):
    return of_forces(half_space_stress(np.hypot(x, y), z, nu, 1.0), combine_stress, x, y)[:, SIX]


def displacement(x, y, z, nu):
    """Under E = 1."""
    radial = half_space_displacement(np.hypot(x, y), z, 1.0, nu, 1.0)
    return of_forces(radial, combine_displacement, x, y)


@pytest.mark.parametrize("place", [(0, 0), (1, 0), (3, 2)])
def test_surface_deflection_of_love_is_the_integral_of_one_over_r(place):
    d = 0.7
    x, y = place[0] * d, place[1] * d

    # polar singularity at the loaded point: integrate its four quadrants apart
    def inverse(eta, xi):
        return 1 / np.hypot(x - xi, y - eta)

    xs, ys = (sorted({-d / 2, d / 2, float(np.clip(v, -d / 2, d / 2))}) for v in (x, y))
    total = sum(
        dblquad(inverse, x0, x1, y0, y1, epsabs=1e-10)[0]
        for x0, x1 in pairwise(xs)
        for y0, y1 in pairwise(ys)
    )
    # tolerance of dblquad 1e-10
    assert halfspace.surface_deflection(5, d)[place] == pytest.approx(total, abs=1e-9)


@pytest.mark.parametrize("nu", [0.0, 0.3, 0.5])
def test_stress_balances_and_carries_the_force(nu):
    centre, h = np.array([0.31, -0.22, 0.4]), 1e-3
    divergence = np.zeros((2, 3))
    for axis in range(3):
        for k, c in ((1, 2 / 3), (2, -1 / 12)):
            step = np.zeros(3)
            step[axis] = k * h
            divergence += c * (stress(*(centre + step), nu) - stress(*(centre - step), nu))[:, axis] / h
    # fourth-order differences: h^4 f'''''/30 and 1e-16/h
    np.testing.assert_allclose(divergence, 0, atol=1e-6)
    # the traction on a hemisphere balances the unit force
    s, w = np.polynomial.legendre.leggauss(40)
    cosine, angle = (1 + s) / 2, 2 * np.pi * np.arange(40) / 40
    n = np.array(
        [
            np.sqrt(1 - cosine**2)[:, None] * np.cos(angle),
            np.sqrt(1 - cosine**2)[:, None] * np.sin(angle),
            cosine[:, None] + 0 * angle,
        ]
    )
    sigma = stress(*n.reshape(3, -1), nu).reshape(2, 3, 3, 40, 40)
    force = np.einsum("fijpq,jpq,p->fi", sigma, n, w / 2) * 2 * np.pi / 40
    np.testing.assert_allclose(force, [[0, 0, -1], [-1, 0, 0]], atol=1e-9)


@pytest.mark.parametrize("nu", [0.0, 0.3, 0.45])
def test_stress_is_hooke_of_the_displacement(nu):
    centre, h, E = np.array([0.31, -0.22, 0.4]), 1e-3, 1.0
    gradient = np.zeros((2, 3, 3))
    for axis in range(3):
        for k, c in ((1, 2 / 3), (2, -1 / 12)):
            step = np.zeros(3)
            step[axis] = k * h
            up, down = (displacement(*(centre + sign * step), nu) for sign in (1, -1))
            gradient[:, :, axis] += c * (up - down) / h
    strain = (gradient + gradient.swapaxes(1, 2)) / 2
    G, lam = E / (2 * (1 + nu)), E * nu / ((1 + nu) * (1 - 2 * nu))
    expected = lam * np.einsum("fii,jk->fjk", strain, np.eye(3)) + 2 * G * strain
    # fourth-order differences, as above, times lam/E <= 3.1
    np.testing.assert_allclose(stress(*centre, nu), expected, rtol=0, atol=1e-6)


def test_reciprocity_of_normal_and_tangential_force():
    # u_x at B under a normal force at A is u_z at A under a force in x at B (Betti)
    forth, back = displacement(3.0, -2.0, 0.0, 0.3)[0, 0], displacement(-3.0, 2.0, 0.0, 0.3)[1, 2]
    assert forth == pytest.approx(back, rel=1e-12, abs=0)


@pytest.mark.skipif(np.finfo(np.longdouble).eps > 2e-19, reason="no extended precision on this machine")
@pytest.mark.parametrize("depth", [0.0, 0.3, 24.0, 3000.0])
def test_every_coefficient_of_a_large_table_keeps_its_digits(depth):
    """Relative to the coefficient itself, where corner sums meet the series, 25 sides, and 1200 away."""
    d = np.longdouble(1.5)
    table = halfspace.surface_deflection(1201, 1.5, depth)
    i = np.array([0, 1, 7, 16, 20, 24, 25, 26, 27, 60, 1000, 1200])[:, None]
    j = np.array([0, 1, 13, 24, 25, 26, 39, 40])
    z = np.longdouble(depth)

    def corner(X, Y):
        angle = z * np.arctan2(X * Y, z * np.sqrt(X * X + Y * Y + z * z)) if depth else 0
        return X * np.arcsinh(Y / np.hypot(X, z)) + Y * np.arcsinh(X / np.hypot(Y, z)) - angle

    h = np.longdouble(0.5)
    right, left, top, bottom = (i + h) * d, (i - h) * d, (j + h) * d, (j - h) * d
    exact = corner(right, top) - corner(left, top) - corner(right, bottom) + corner(left, bottom)
    # the sixth moments, 5e-12; of the corner sum in extended precision 1200^2 roundings, 1e-12
    assert (np.abs(table[i, j] / exact - 1) < 7e-12).all()
