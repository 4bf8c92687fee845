"""Love, Boussinesq and Cerruti on a rectangle against quadrature, equilibrium and each other."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import dblquad

from semianalytic import halfspace

DX, DY, NU = 1.0, 0.7, 0.3
FIELDS = {
    "normal stress": (halfspace.normal_stress, halfspace._normal_stress_point),
    "tangential stress": (halfspace.tangential_stress, halfspace._tangential_stress_point),
}


def by_gauss(point, x, y, z, order=60):
    """Point forces integrated over the rectangle; 60 a side resolve depths of 0.3 sides to rounding."""
    s, w = np.polynomial.legendre.leggauss(order)
    X, Y = x + 0.5 * DX * s[:, None], y + 0.5 * DY * s[None, :]
    weight = 0.25 * DX * DY * w[:, None] * w[None, :]
    return np.array([np.sum(weight * part) for part in point(X, Y, np.full(X.shape, z), NU)])


POINTS = [
    (0.0, 0.0, 0.5),
    (0.2, 0.1, 0.3),
    (-0.9, 0.4, 0.6),
    (0.5, -0.35, 0.4),
    (2.0, -3.0, 0.35),
    (9.0, 1.0, 4.0),
]


@pytest.mark.parametrize("name", FIELDS)
@pytest.mark.parametrize("place", POINTS)
def test_stress_is_the_integral_of_the_point_force(name, place):
    rectangle, point = FIELDS[name]
    s = rectangle(*place, DX, DY, NU)
    found = [s[0, 0], s[1, 1], s[2, 2], s[0, 1], s[0, 2], s[1, 2]]
    expected = by_gauss(point, *place) / (2 * np.pi)
    # rounding of the quadrature: 3600 terms of order one
    np.testing.assert_allclose(found, expected, atol=2e-13, rtol=0)


@pytest.mark.parametrize("place", POINTS)
@pytest.mark.parametrize(
    ("rectangle", "point"),
    [
        (halfspace.normal_displacement, halfspace._normal_displacement_point),
        (halfspace.tangential_displacement, halfspace._tangential_displacement_point),
    ],
)
def test_displacement_is_the_integral_of_the_point_force(rectangle, point, place):
    u = rectangle(*place, DX, DY, 1.0, NU)
    expected = by_gauss(point, *place) * (1 + NU) / (2 * np.pi)
    np.testing.assert_allclose(u, expected, atol=2e-13, rtol=0)


@pytest.mark.parametrize("place", [(0.0, 0.0), (0.8, 0.1), (3.0, -2.0)])
def test_surface_deflection_of_love_is_the_integral_of_one_over_r(place):
    x, y = place

    # polar singularity at the loaded point: integrate its four quadrants apart
    def inverse(eta, xi):
        return 1 / np.hypot(x - xi, y - eta)

    xs = sorted({-DX / 2, DX / 2, float(np.clip(x, -DX / 2, DX / 2))})
    ys = sorted({-DY / 2, DY / 2, float(np.clip(y, -DY / 2, DY / 2))})
    total = sum(
        dblquad(inverse, x0, x1, y0, y1, epsabs=1e-10)[0]
        for x0, x1 in pairwise(xs)
        for y0, y1 in pairwise(ys)
    )
    u = halfspace.normal_displacement(x, y, 0.0, DX, DY, 1.0, NU)[2]
    # tolerance of dblquad 1e-10
    assert u == pytest.approx((1 - NU**2) / np.pi * total, abs=1e-9)


@pytest.mark.parametrize("far", [24.9, 25.1])
@pytest.mark.parametrize("rectangle", [halfspace.normal_stress, halfspace.tangential_stress])
def test_near_and_far_forms_meet(rectangle, far, monkeypatch):
    direction = np.array([0.6, 0.64, 0.48])
    place = far * DX * direction
    here = rectangle(*place, DX, DY, NU)
    monkeypatch.setattr(halfspace, "FAR", 1e9 if far > 25 else 1.0)
    other = rectangle(*place, DX, DY, NU)
    # the documented 2e-11 of the largest local component
    np.testing.assert_allclose(here, other, rtol=0, atol=2e-11 * np.abs(here).max())


def test_far_forms_keep_their_digits():
    # at 1e6 sides a rectangle is a point force to (side/distance)^2 = 1e-12
    place = 1e6 * np.array([0.6, 0.64, 0.48])
    s = halfspace.normal_stress(*place, DX, DY, NU)
    point = np.array(halfspace._normal_stress_point(*place, NU)) * DX * DY / (2 * np.pi)
    np.testing.assert_allclose([s[0, 0], s[2, 2], s[0, 2]], point[[0, 2, 4]], rtol=1e-10)


def test_traction_on_the_surface_is_the_load():
    x = np.array([0.0, 0.3, DX / 2, DX / 2, 0.8])
    y = np.array([0.0, -0.2, 0.0, DY / 2, 0.0])
    expected = np.array([-1, -1, -0.5, -0.25, 0])  # inside, inside, edge, corner, outside
    normal = halfspace.normal_stress(x, y, 0.0, DX, DY, NU)
    tangential = halfspace.tangential_stress(x, y, 0.0, DX, DY, NU)
    np.testing.assert_allclose(normal[2, 2], expected, rtol=0, atol=1e-15)
    np.testing.assert_allclose(tangential[0, 2], expected, rtol=0, atol=1e-15)
    np.testing.assert_allclose(normal[:2, 2], 0, atol=1e-15)
    np.testing.assert_allclose(tangential[1:, 2], 0, atol=1e-15)


@pytest.mark.parametrize("nu", [0.0, 0.3, 0.5])
@pytest.mark.parametrize(
    ("stress", "displacement"),
    [
        (halfspace.normal_stress, halfspace.normal_displacement),
        (halfspace.tangential_stress, halfspace.tangential_displacement),
    ],
)
def test_stress_balances(stress, displacement, nu):
    centre, h = np.array([0.31, -0.22, 0.4]), 1e-3
    divergence = np.zeros(3)
    for axis in range(3):
        for k, c in ((1, 2 / 3), (2, -1 / 12)):
            step = np.zeros(3)
            step[axis] = k * h
            up = stress(*(centre + step), DX, DY, nu)[:, axis]
            down = stress(*(centre - step), DX, DY, nu)[:, axis]
            divergence += c * (up - down) / h
    # fourth-order differences: h^4 f'''''/30 and 1e-16/h
    np.testing.assert_allclose(divergence, 0, atol=1e-8)


@pytest.mark.parametrize("nu", [0.0, 0.3, 0.45])
@pytest.mark.parametrize(
    ("stress", "displacement"),
    [
        (halfspace.normal_stress, halfspace.normal_displacement),
        (halfspace.tangential_stress, halfspace.tangential_displacement),
    ],
)
def test_stress_is_hooke_of_the_displacement(stress, displacement, nu):
    centre, h, E = np.array([0.31, -0.22, 0.4]), 1e-3, 1.0
    gradient = np.zeros((3, 3))
    for axis in range(3):
        for k, c in ((1, 2 / 3), (2, -1 / 12)):
            step = np.zeros(3)
            step[axis] = k * h
            up = displacement(*(centre + step), DX, DY, E, nu)
            down = displacement(*(centre - step), DX, DY, E, nu)
            gradient[:, axis] += c * (up - down) / h
    strain = (gradient + gradient.T) / 2
    G, lam = E / (2 * (1 + nu)), E * nu / ((1 + nu) * (1 - 2 * nu))
    expected = lam * np.trace(strain) * np.eye(3) + 2 * G * strain
    # fourth-order differences, as above, times lam/E <= 3.1
    np.testing.assert_allclose(stress(*centre, DX, DY, nu), expected, rtol=0, atol=1e-8)


def test_reciprocity_of_normal_and_tangential_load():
    # u_x at B under p at A equals -u... of the unit point forces: exchange source and point
    place = np.array([3.0, -2.0])
    forth = halfspace.normal_displacement(*place, 0.0, DX, DY, 1.0, NU)[0]
    back = halfspace.tangential_displacement(*(-place), 0.0, DX, DY, 1.0, NU)[2]
    # Betti for equal rectangles, centre values: differs by the fourth-order moment only through symmetry
    assert forth == pytest.approx(back, rel=1e-12, abs=0)


def test_table_of_deflections_is_love():
    table = halfspace.surface_deflection(40, 30, DX, DY)
    x, y = np.arange(40) * DX, np.arange(30) * DY
    u = halfspace.normal_displacement(x[:, None], y[None, :], 0.0, DX, DY, 1.0, NU)[2]
    # far entries leave out the sixth moments of the rectangle
    np.testing.assert_allclose(table * (1 - NU**2) / np.pi, u, rtol=0, atol=1e-13)


@pytest.mark.skipif(np.finfo(np.longdouble).eps > 2e-19, reason="no extended precision on this machine")
@pytest.mark.parametrize("depth", [0.0, 0.3, 24.0, 3000.0])
def test_every_coefficient_of_a_large_table_keeps_its_digits(depth):
    """Relative to the coefficient itself, where corner sums meet the series, 25 sides, and 8192 away."""
    nx, ny, dx, dy = 8193, 41, np.longdouble(1.5), np.longdouble(1)
    table = halfspace.surface_deflection(nx, ny, 1.5, 1.0, depth)
    i = np.array([0, 1, 7, 16, 20, 24, 25, 26, 27, 60, 1000, 8192])[:, None]
    j = np.array([0, 1, 13, 24, 25, 26, 39, 40])
    z = np.longdouble(depth)

    def corner(X, Y):
        angle = z * np.arctan2(X * Y, z * np.sqrt(X * X + Y * Y + z * z)) if depth else 0
        return X * np.arcsinh(Y / np.hypot(X, z)) + Y * np.arcsinh(X / np.hypot(Y, z)) - angle

    h = np.longdouble(0.5)
    right, left, top, bottom = (i + h) * dx, (i - h) * dx, (j + h) * dy, (j - h) * dy
    exact = corner(right, top) - corner(left, top) - corner(right, bottom) + corner(left, bottom)
    # the sixth moments, 5e-12; of the corner sum in extended precision 8192^2 roundings, 4e-11
    tolerance = np.where(np.hypot(i, j) < 100, 7e-12, 1e-10)
    assert (np.abs(table[i, j] / exact - 1) < tolerance).all()


def test_points_above_the_surface_are_refused():
    with pytest.raises(ValueError, match="above the surface"):
        halfspace.normal_stress(0, 0, -1e-9, DX, DY, NU)
