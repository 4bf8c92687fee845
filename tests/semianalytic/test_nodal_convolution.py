"""Convolution on a lattice against plain sums; the influence of a node against direct quadrature."""

import numpy as np
import pytest

from semianalytic import halfspace
from semianalytic.interpolation_kernel import near_influence
from semianalytic.nodal_convolution import Lattice, at_points, between_sites
from semianalytic.point_force import stress_from_lines

RNG = np.random.default_rng(5)
LATTICE = Lattice(-0.7, 0.2, 0.1, 0.15, RNG.random((23, 18)))
SIX = ((0, 1, 2, 0, 0, 1), (0, 1, 2, 1, 2, 2))


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


@pytest.mark.parametrize("sites", [3, 60])
def test_field_on_sites_needs_no_interpolation(sites):
    i, j = RNG.integers(-5, 25, (2, sites))
    x, y = LATTICE.x0 + i * LATTICE.dx, LATTICE.y0 + j * LATTICE.dy
    field = between_sites(x, y, LATTICE, lambda m, n: newton(m * LATTICE.dx, n * LATTICE.dy), (1,), order=4)
    exact = plain_sum(x, y, LATTICE)
    np.testing.assert_allclose(field, exact, rtol=0, atol=1e-12 * np.abs(exact).max())


def test_coarser_lattice_keeps_moments_up_to_the_fifth():
    coarse = LATTICE.coarser()

    def moments(lattice):
        X = lattice.x0 + np.arange(lattice.force.shape[0])[:, None] * lattice.dx
        Y = lattice.y0 + np.arange(lattice.force.shape[1]) * lattice.dy
        return [(lattice.force * X**a * Y**b).sum() for a in range(6) for b in range(6)]

    np.testing.assert_allclose(moments(coarse), moments(LATTICE), rtol=1e-11, atol=1e-9)
    assert coarse.force.size < 0.6 * (LATTICE.force.size + 400)


def keys(t):
    """Cubic convolution kernel as Keys (1981) prints it in eq. 15."""
    s = np.abs(t)
    return np.where(
        s < 1, 1.5 * s**3 - 2.5 * s**2 + 1, np.where(s < 2, -0.5 * s**3 + 2.5 * s**2 - 4 * s + 2, 0)
    )


@pytest.mark.parametrize("nu", [0.0, 0.3, 0.5])
@pytest.mark.parametrize("z", [0.4, 1.0, 2.5])
def test_influence_of_a_node_is_the_quadrature_of_point_forces(nu, z):
    dx, dy, f, tiny = 1.0, 0.8, 0.6, 1e-4

    def squares(X, Y, dx, dy):
        fields = (
            halfspace.normal_stress(X, Y, z, dx, dy, nu),
            halfspace.tangential_stress(X, Y, z, dx, dy, nu),
        )
        return np.array([field[SIX] for field in fields]) / (dx * dy)

    def both(X, Y, dx=dx, dy=dy):
        normal, tangential = squares(X, Y, dx, dy)
        return normal + f * tangential

    outside = stress_from_lines(lambda X, Y: squares(X, Y, tiny, tiny), 6 * np.exp(np.arange(0, 4, 0.02)), f)
    influence = near_influence(both, outside, None, dx, dy, z, (3, 5))
    m, n = np.array([0, 1, 0, -3, 2, -1]), np.array([0, 0, 2, 1, -2, -1])
    mine = influence(m, n)

    s, w = np.polynomial.legendre.leggauss(16)
    t = (np.arange(-3.5, 4)[:, None] + s / 2).ravel()
    fourth = np.array([1, -4, 6, -4, 1]) / 80
    fourth[2] += 1  # the node carries a fourth difference that takes off the fourth moment
    B = np.tile(w / 2, 8) * sum(c * keys(t + a - 2) for a, c in enumerate(fourth))
    X, Y = (m[:, None, None] - t[:, None]) * dx, (n[:, None, None] - t) * dy
    exact = np.einsum("cpxy,x,y->cp", both(*np.broadcast_arrays(X, Y), tiny, tiny), B, B)
    # issue: 1e-7 of the largest; Gauss of 16 points at z = 0.4 d reaches 1e-9
    np.testing.assert_allclose(mine, exact, rtol=0, atol=1e-7 * np.abs(exact).max())


def test_influence_beyond_the_block_is_that_of_a_point_force():
    def squares(X, Y, side):
        fields = (
            halfspace.normal_stress(X, Y, 0.5, side, side, 0.3),
            halfspace.tangential_stress(X, Y, 0.5, side, side, 0.3),
        )
        return np.array([field[SIX] for field in fields]) / side**2

    outside = stress_from_lines(lambda X, Y: squares(X, Y, 1e-3), 6 * np.exp(np.arange(0, 4, 0.02)), 0.6)
    influence = near_influence(
        lambda X, Y: np.tensordot([1, 0.6], squares(X, Y, 1.0), 1), outside, None, 1.0, 1.0, 0.5, (3, 5)
    )
    m, n = np.array([9, -12, 40, 7]), np.array([3, -9, 25, -30])
    exact = np.tensordot([1, 0.6], squares(m.astype(float), n.astype(float), 1e-3), 1)
    np.testing.assert_allclose(influence(m, n), exact, atol=1e-6 * np.abs(exact).max())
    # and the block joins on: its last offsets differ from points by the sixth moment of B only
    m, n = np.array([8, -8, 6]), np.array([0, 8, -8])
    exact = np.tensordot([1, 0.6], squares(m.astype(float), n.astype(float), 1e-3), 1)
    np.testing.assert_allclose(influence(m, n), exact, atol=2e-3 * np.abs(exact).max())
