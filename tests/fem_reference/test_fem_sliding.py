"""Sliding friction as first harmonic against closed forms and against equilibrium in three dimensions."""

from functools import lru_cache

import numpy as np
import pytest

from fem_reference import solve, solve_prescribed

R, W = 10e-3, 20.0
E, NU, F = 210e9, 0.3, 0.5
A_H = (3 * W * R * (1 - NU**2) / (4 * E)) ** (1 / 3)
COATED = ((2 * E, 0.25, 0.5 * A_H),)


@lru_cache
def at_rest(coatings, quality):
    return solve(
        radius=R,
        load=W,
        coatings=coatings,
        substrate=(E, NU),
        quality=quality,
        estimate_uncertainty=False,
    )


@lru_cache
def sliding(friction=F, coatings=(), quality="default"):
    """The contact is solved once; that sliding later equals sliding from the start has a test of its own."""
    return at_rest(coatings, quality).with_friction(friction)


def cerruti_stress(x, y, z, nu):
    """Stress (6,) of a unit force in +x at the origin: xx, yy, zz, xy, yz, xz. Johnson (3.76)."""
    rho = np.sqrt(x**2 + y**2 + z**2)
    s = rho + z
    m = 1 - 2 * nu
    near = 1 / (rho**3 * s**2) + 2 / (rho**2 * s**3)
    xx = -3 * x**3 / rho**5 + m * (x / rho**3 - 3 * x / (rho * s**2) + x**3 * near)
    yy = -3 * x * y**2 / rho**5 + m * (x / rho**3 - x / (rho * s**2) + x * y**2 * near)
    xy = -3 * x**2 * y / rho**5 + m * (-y / (rho * s**2) + x**2 * y * near)
    zz, yz, xz = (-3 * x * a / rho**5 for a in (z * z, y * z, x * z))
    return np.stack([xx, yy, zz, xy, yz, xz]) / (2 * np.pi)


def sliding_part(x, y, z):
    """The share of the traction q in the stress at (x, y, z), shape (6, n)."""
    total = sliding().stress(x, y, z) - sliding(0.0).stress(x, y, z)
    return np.stack([total[i, j] for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2))])


def test_full_tensor_is_that_of_distributed_point_forces():
    """q = f p0 sqrt(1 - r^2/a^2) summed over Cerruti's point force, deep enough for the sum to converge."""
    rng = np.random.default_rng(3)
    x, y, z = rng.uniform(-1.5, 1.5, 40), rng.uniform(-1.5, 1.5, 40), rng.uniform(0.25, 2, 40)
    s, weight = np.polynomial.legendre.leggauss(60)
    t, w = (s + 1) / 2, weight / 2
    theta = 2 * np.pi * np.arange(128) / 128
    r = np.sqrt(1 - t**2)[:, None]
    xi, eta = (r * np.cos(theta)).ravel(), (r * np.sin(theta)).ravel()
    # dA = t dt dtheta with q = f p0 t
    q = np.repeat(F * t**2 * w, theta.size) * 2 * np.pi / theta.size
    point = cerruti_stress(x[:, None] - xi, y[:, None] - eta, z[:, None], NU)
    expected = sliding().peak_pressure * (point @ q)
    got = sliding_part(x * A_H, y * A_H, z * A_H)
    # issue: 1e-4 f p0 inside
    assert np.abs(got - expected).max() < 1e-4 * F * sliding().peak_pressure


def test_shear_on_the_axis_follows_the_closed_form():
    s = sliding()
    t = np.linspace(0, 3, 61)
    expected = -1 + 1.5 * t * np.arctan2(1, t) - t**2 / (2 * (1 + t**2))
    got = s.stress(0.0, 0.0, t * s.contact_radius)[0, 2] / (F * s.peak_pressure)
    assert np.abs(got - expected).max() < 1e-4  # issue: 1e-4 f p0


def test_tension_at_the_trailing_edge_follows_the_closed_form():
    s = sliding()
    got = s.stress(-s.contact_radius, 0.0, 0.0)[0, 0] / s.peak_pressure
    expected = (1 - 2 * NU) / 3 + F * np.pi * (4 + NU) / 8
    assert got == pytest.approx(expected, rel=1e-5)


def test_tension_at_the_edge_of_a_contact_at_rest_follows_the_closed_form():
    s = sliding(0.0)
    peak = s.stress(s.contact_radius, 0.0, 0.0)[0, 0]
    assert peak == pytest.approx((1 - 2 * NU) / 3 * s.peak_pressure, rel=2e-5)


def test_surface_stress_inside_the_contact_is_linear_in_x():
    """Under q of Hertz shape sigma_xx = -f p0 pi (4 + nu) x / (8 a), without friction's p. Johnson (7.34)."""
    s = sliding()
    x = np.linspace(-0.98, 0.98, 99)
    got = sliding_part(x * s.contact_radius, 0 * x, 0 * x)
    expected = -F * s.peak_pressure * np.pi * (4 + NU) / 8 * x
    assert np.abs(got[0] - expected).max() < 1e-4 * F * s.peak_pressure


def test_surface_traction_is_friction_times_pressure():
    s = sliding(coatings=COATED)
    x = np.linspace(-1.5, 1.5, 61) * A_H
    y = 0.3 * A_H
    sigma = s.stress(x, y, 0.0)
    np.testing.assert_allclose(sigma[0, 2], -F * s.pressure(x, y), atol=1e-9 * s.peak_pressure)
    np.testing.assert_allclose(sigma[1, 2], 0, atol=1e-9 * s.peak_pressure)


def test_reversed_friction_mirrors_the_field():
    forward, backward = sliding(coatings=COATED, quality="fast"), sliding(-F, COATED, "fast")
    x, y, z = (A_H * np.array(v) for v in ([0.4, -0.9], [0.2, 0.3], [0.3, 0.9]))
    mirror = np.diag([-1.0, 1.0, 1.0])
    expected = np.einsum("ia,jb,ab...->ij...", mirror, mirror, forward.stress(x, y, z))
    np.testing.assert_allclose(backward.stress(-x, y, z), expected, atol=1e-9 * forward.peak_pressure)
    np.testing.assert_allclose(
        backward.displacement(-x, y, z)[0], -forward.displacement(x, y, z)[0], rtol=1e-9
    )


@pytest.mark.parametrize("depth", [0.3, 1.1])
def test_three_dimensional_equilibrium_holds_in_every_layer(depth):
    """div sigma = 0 by fourth-order differences, at points off every plane of symmetry."""
    s = sliding(coatings=COATED)
    points = A_H * np.array([[0.31, 0.22, depth], [-0.63, 0.41, depth], [1.2, -0.7, depth]]).T
    step = 0.05 * A_H
    divergence = np.zeros((3, points.shape[1]))
    for axis in range(3):
        shift = np.zeros((3, 1))
        shift[axis] = step
        near = s.stress(*(points + shift)) - s.stress(*(points - shift))
        wide = s.stress(*(points + 2 * shift)) - s.stress(*(points - 2 * shift))
        divergence += (8 * near - wide)[:, axis] / (12 * step)
    # stress errors of 5e-5 p_h divided by the step, and step^4/30 of fifth derivatives
    assert np.abs(divergence).max() < 1e-3 * s.peak_pressure / A_H


def test_tractions_are_continuous_across_the_interface_when_sliding():
    s = sliding(coatings=COATED)
    x, y = np.linspace(-2, 2, 41) * A_H, 0.4 * A_H
    # a hair off the interface each side differentiates alone
    above, below = (s.stress(x, y, COATED[0][2] * side) for side in (1 - 1e-6, 1 + 1e-6))
    assert np.abs(above[:, 2] - below[:, 2]).max() < 2e-4 * s.peak_pressure


def test_stress_is_the_gradient_of_the_displacement():
    s = sliding(coatings=COATED)
    x, y, z = 0.4 * A_H, 0.3 * A_H, 0.25 * A_H
    step = 1e-3 * A_H
    gradient = np.zeros((3, 3))
    for axis in range(3):
        shift = step * np.eye(3)[axis]
        ahead = s.displacement(x + shift[0], y + shift[1], z + shift[2])
        behind = s.displacement(x - shift[0], y - shift[1], z - shift[2])
        gradient[:, axis] = (ahead - behind) / (2 * step)
    strain = (gradient + gradient.T) / 2
    E_1, nu_1, _ = COATED[0]
    G = E_1 / (2 * (1 + nu_1))
    sigma = 2 * G * strain + 2 * G * nu_1 / (1 - 2 * nu_1) * np.trace(strain) * np.eye(3)
    # central differences: step^2 times third derivatives, and triangles of a quartic field
    np.testing.assert_allclose(sigma, s.stress(x, y, z), atol=2e-5 * s.peak_pressure)


def test_friction_does_not_change_the_pressure():
    assert sliding().contact_radius == sliding(0.0).contact_radius
    x = np.linspace(0, 1, 7) * A_H
    np.testing.assert_array_equal(sliding().pressure(x), sliding(0.0).pressure(x))


def test_prescribed_hertz_pressure_reproduces_the_contact():
    s = sliding(coatings=COATED)
    given = solve_prescribed(
        pressure=s.pressure,
        load_radius=s.contact_radius,
        coatings=COATED,
        substrate=(E, NU),
        friction=F,
        estimate_uncertainty=False,
    )
    x, z = np.linspace(-1.5, 1.5, 31) * A_H, 0.45 * A_H
    assert np.abs(given.stress(x, 0.1 * A_H, z) - s.stress(x, 0.1 * A_H, z)).max() < 5e-5 * s.peak_pressure
    assert given.approach == pytest.approx(s.approach, rel=2e-6)
