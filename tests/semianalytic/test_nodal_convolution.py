"""Convolution on a lattice against plain sums; the influence of a node."""

from functools import partial

import numpy as np
import pytest

from semianalytic.inputs import Body
from semianalytic.stresses import patch_field
from semianalytic.stresses.nodal_convolution import Lattice, at_points, between_sites, near_and_far
from semianalytic.stresses.rings import Node

RNG = np.random.default_rng(5)
LATTICE = Lattice(-0.7, 0.2, 0.1, 0.15, RNG.random((23, 18)))


def newton(x, y):
    """Two smooth kernels, even and odd in y, of scale 1.5."""
    rho = np.sqrt(x**2 + y**2 + 2.25)
    return np.stack([(1 + x) / rho**3, y / rho**5])


def plain_sum(x, y, lattice):
    X = lattice.x0 + np.arange(lattice.force.shape[0])[:, None] * lattice.dx
    Y = lattice.y0 + np.arange(lattice.force.shape[1]) * lattice.dy
    return np.array(
        [(newton(a - X, b - Y) * lattice.force).sum(axis=(1, 2)) for a, b in zip(x, y, strict=True)]
    ).T


@pytest.mark.parametrize("points", [5, 200])
def test_field_at_points_is_the_plain_sum(points):
    x, y = RNG.uniform(-2, 3, (2, points))
    field = at_points(x, y, LATTICE, newton, (1,), order=10)
    exact = plain_sum(x, y, LATTICE)
    # few: rounding; many: half-way between ten sites the remainder is (9!!/2^5)^2/10! = 2.4e-4 times d^10
    # times the tenth derivative: 1.2e-8 of the largest value by differences of the field at the sites, and
    # 1.4e-8 found at the centres of all cells
    tolerance = 1e-12 if points < 64 else 1.5e-8
    np.testing.assert_allclose(field, exact, rtol=0, atol=tolerance * np.abs(exact).max())


@pytest.mark.parametrize("columns", [(-5, 25), (-7, -5), (8, 9), (30, 33)], ids=str)
@pytest.mark.parametrize("sites", [3, 60])
def test_field_on_sites_needs_no_interpolation(sites, columns):
    i, j = RNG.integers(-5, 25, sites), RNG.integers(*columns, sites)
    x, y = LATTICE.x0 + i * LATTICE.dx, LATTICE.y0 + j * LATTICE.dy
    field = between_sites(x, y, LATTICE, lambda m, n: newton(m * LATTICE.dx, n * LATTICE.dy), (1,), order=4)
    exact = plain_sum(x, y, LATTICE)
    np.testing.assert_allclose(field, exact, rtol=0, atol=1e-12 * np.abs(exact).max())


@pytest.mark.parametrize("reach", [0, 3, 8, 30])
@pytest.mark.parametrize("sites", [(-60, 80), (5, 20), (40, 80)], ids=str)
def test_forces_beyond_the_reach_count_for_nothing(sites, reach):
    i, j = RNG.integers(*sites, (2, 60))
    x, y = LATTICE.x0 + i * LATTICE.dx, LATTICE.y0 + j * LATTICE.dy

    def influence(m, n):
        return newton(m * LATTICE.dx, n * LATTICE.dy)

    field = between_sites(x, y, LATTICE, influence, (1,), order=4, reach=reach)
    p, q = np.meshgrid(*map(np.arange, LATTICE.force.shape), indexing="ij")
    m, n = i[:, None, None] - p, j[:, None, None] - q
    near = (np.abs(m) <= reach) & (np.abs(n) <= reach)
    exact = (influence(m, n) * near * LATTICE.force).sum(axis=(2, 3))
    np.testing.assert_allclose(field, exact, rtol=0, atol=1e-12)
    assert not field[:, ~near.any(axis=(1, 2))].any()


def test_on_the_axis_of_even_forces_what_is_odd_across_it_vanishes():
    even = Lattice(-0.7, -0.45, 0.1, 0.15, np.hstack([half := RNG.random((23, 4)), half[:, -2::-1]]))
    i = np.array([3, -2, 12])
    x, y = even.x0 + i * even.dx, np.zeros(3)
    field = between_sites(x, y, even, lambda m, n: newton(m * even.dx, n * even.dy), (1,), order=4)
    np.testing.assert_allclose(field, plain_sum(x, y, even), rtol=0, atol=1e-12 * np.abs(field).max())
    assert not field[1].any()


def test_coarser_lattice_keeps_moments_up_to_the_fifth():
    coarse = LATTICE.coarser()

    def moments(lattice):
        X = lattice.x0 + np.arange(lattice.force.shape[0])[:, None] * lattice.dx
        Y = lattice.y0 + np.arange(lattice.force.shape[1]) * lattice.dy
        return [(lattice.force * X**a * Y**b).sum() for a in range(6) for b in range(6)]

    np.testing.assert_allclose(moments(coarse), moments(LATTICE), rtol=1e-11, atol=1e-9)
    assert coarse.force.size < 0.6 * (LATTICE.force.size + 400)


@pytest.mark.parametrize("z", [0.0, 0.3, 2.5])
def test_rings_around_a_node_are_its_pressure(z):
    # the influence of point forces, spread by Keys' cubic: rho^-1 with a direction, by panels of the cubic
    x, y = np.array([0.0, 0.4, 1.0, -3.0, 7.0]), np.array([0.0, -0.3, 2.0, 1.0, -5.0])
    rings = Node(1.0).rings(x, y, np.full(5, z or 0.3))
    rho = np.hypot(rings.radius, z)
    kernel = np.array([1 / rho, 0 * rho, 0 * rho, rings.radius / rho**2, 0 * rho, 0 * rho, 0 * rho])
    mine = np.bincount(rings.foot, (kernel * rings.harmonics).sum(axis=0) * rings.weight)
    s, w = np.polynomial.legendre.leggauss(400)
    panels = np.arange(-2, 2)[:, None] + (1 + s) / 2
    t, w = panels.ravel(), np.tile(w / 2, 4)
    for k in range(5):
        if z == 0 and k < 3:
            continue  # the direct quadrature needs the singularity away from its points
        X, Y = x[k] - t[:, None], y[k] - t
        r2 = X * X + Y * Y
        c2 = (X * X - Y * Y) / np.maximum(r2, 1e-30)
        field = 1 / np.sqrt(r2 + z * z) + c2 * np.sqrt(r2) / (r2 + z * z)
        direct = w * keys(t) @ field @ (w * keys(t))
        assert mine[k] == pytest.approx(direct, abs=2e-6)


def keys(t):
    """Cubic convolution kernel as Keys (1981) prints it in eq. 15."""
    s = np.abs(t)
    return np.where(
        s < 1, 1.5 * s**3 - 2.5 * s**2 + 1, np.where(s < 2, -0.5 * s**3 + 2.5 * s**2 - 4 * s + 2, 0)
    )


def test_influence_near_a_node_joins_that_of_a_point_force():
    body = Body(((4.0, 0.25, 2.0),), (1.0, 0.3), 0.6)
    for z, layer in ((0.0, 0), (0.5, 0), (2.0, 1)):
        ((near, _),) = patch_field._stress_field(body).influences(np.array([z]), layer, 1.0)
        far = partial(near.func, near.args[0], z, 1.0, None)
        m, n = np.array([6, -6, 5, 12]), np.array([0, 6, -6, -20])
        exact = far(m, n)
        # the sixth moment of the cubic, which the fourth difference leaves
        np.testing.assert_allclose(near(m, n), exact, atol=5e-3 * np.abs(exact).max())


def test_distant_forces_gathered_add_up_to_the_plain_sum():
    wide = Lattice(-15.0, -10.0, 0.05, 0.05, RNG.standard_normal((600, 420)))
    gathered = wide.coarser().coarser().coarser()
    x, y = RNG.uniform(-16, 16, 40), np.zeros(40)

    def influence(m, n):
        return newton(m * wide.dx, n * wide.dy)

    field = near_and_far(x, y, (wide, gathered), influence, newton, (1,), order=10)
    for far in ((-70.0, 0.0), (70.0, 0.0), (0.0, 70.0), (70.0, 70.0)):  # where no force is nearby
        there = np.reshape(far, (2, 1)) + RNG.uniform(0, 1, (2, 14)) * [[1.0], [0.0 if far[1] == 0 else 1.0]]
        x, y = np.concatenate([[x, y], there], axis=1)
        apart = near_and_far(*there, (wide, gathered), influence, newton, (1,), order=10)
        field = np.concatenate([field, apart], axis=1)
    exact = plain_sum(x, y, wide)
    # ten sites interpolate erfc over three of them: (9!!/2^5)^2/10! = 2.4e-4 times its tenth derivative,
    # 0.13, times the kernel's share there, a tenth; 5e-7 found
    np.testing.assert_allclose(field, exact, rtol=0, atol=3e-6 * np.abs(exact).max())
