"""Field of the edge profile: closed forms at the edge, boundary values, continuity, Hankel quadrature."""

import numpy as np
import pytest
from scipy.special import jv, roots_legendre

import semianalytic
from semianalytic import abel, axisymmetric
from semianalytic.edge_profile import Profile
from semianalytic.inputs import Body

A = 1e-4
HERTZ = Profile(A, np.array([1e9]))
ROUGH = Profile(A, 1e9 * 0.6 ** np.arange(16) * np.cos(np.arange(16)))
COATED = Body(((4.0, 0.25, 0.3 * A), (0.3, 0.4, 0.15 * A)), (1.0, 0.3), 0.4)
# both sides of the edge down to 1e-12 of it, the edge itself, the axis
R = A * np.concatenate(
    [[0.0, 1e-9, 0.3, 0.9, 1.0, 2.0, 30.0], *(1 + s * 10.0 ** np.arange(-12, -1) for s in (-1, 1))]
)


def stress(profile, body, x, y, z, layer=0):
    x, y, z, layer = (v.ravel() for v in np.broadcast_arrays(x, y, z, layer))
    return axisymmetric.stress([profile], body, x, y, z, layer)[0]


@pytest.mark.parametrize("f", [0.0, 0.25, 0.8])
@pytest.mark.parametrize("nu", [0.0, 0.2, 0.3, 0.5])
def test_tension_at_the_trailing_edge(nu, f):
    """Hertz, Hamilton: sigma_xx(-a, 0, 0) = p0 [(1 - 2 nu)/3 + (4 + nu) pi f/8]."""
    xx = stress(HERTZ, Body((), (1.0, nu), f), -A, 0.0, 0.0)[0, 0]
    assert xx == pytest.approx(1e9 * ((1 - 2 * nu) / 3 + (4 + nu) * np.pi * f / 8), abs=1e-3)


@pytest.mark.parametrize("coatings", [(), COATED.coatings])
@pytest.mark.parametrize("profile", [HERTZ, ROUGH])
def test_tractions_on_the_surface(profile, coatings):
    body = Body(coatings, (1.0, 0.3), 0.4)
    angle = np.linspace(0, 2 * np.pi, R.size)
    x, y = R * np.cos(angle), R * np.sin(angle)
    _, _, zz, _, xz, yz = stress(profile, body, x, y, 0.0)
    p = profile.pressure(np.hypot(x, y))
    # at the edge p turns rounding of r into its square root
    slack = 1e-11 * 1e9 + np.abs(p - profile.pressure(np.hypot(x, y) * (1 + 4e-16)))
    assert np.all(np.abs(zz + p) < slack)
    assert np.all(np.abs(xz + 0.4 * p) < slack)
    assert np.all(np.abs(yz) < slack)


def test_agrees_with_quadrature_over_wavenumbers():
    s, w = roots_legendre(4000)
    r, z = (v.ravel() for v in np.meshgrid(np.array([0.0, 0.4, 1.0, 1.7]), [0.3, 1.0, 3.0]))
    k, w = 70 * (1 + s), 70 * w
    phat = abel.cosine_transform(abel.potential(ROUGH.coefficients), k)
    plain, linear = axisymmetric.half_space_integrals(ROUGH, A * r, A * z, 1)
    lower, _ = axisymmetric.half_space_integrals(ROUGH, A * r, A * z, 0)
    for m in range(4):
        kernel = jv(m, np.outer(r, k)) * np.exp(-np.outer(z, k)) * phat * w
        np.testing.assert_allclose(lower[m], A * kernel.sum(axis=1), rtol=0, atol=1e-10 * 1e9 * A)
        np.testing.assert_allclose(plain[m], kernel @ k, rtol=0, atol=1e-10 * 1e9)
        np.testing.assert_allclose(linear[m], z * (kernel @ k**2), rtol=0, atol=1e-10 * 1e9)


def test_deflection_of_the_surface():
    u = axisymmetric.displacement(
        [ROUGH], Body((), (2e11, 0.3), 0.0), R, 0 * R, 0 * R, np.zeros(R.size, int)
    )[0]
    exact = abel.deflection(A, ROUGH.coefficients, 2e11 / 0.91, None, R)
    np.testing.assert_allclose(u[2], exact, rtol=0, atol=1e-8 * exact.max())


def test_equal_moduli_are_the_half_space():
    x, z = np.meshgrid(np.concatenate([-R, R]), A * np.array([0.0, 1e-6, 0.2, 0.3]))
    alike = Body(((1.0, 0.3, 0.3 * A),), (1.0, 0.3), 0.4)
    bare = stress(HERTZ, Body((), (1.0, 0.3), 0.4), x, 0.2 * x, z)
    np.testing.assert_allclose(stress(HERTZ, alike, x, 0.2 * x, z), bare, rtol=0, atol=1e-10 * 1e9)
    x, z = np.meshgrid(np.concatenate([-R, R]), A * np.array([0.3, 0.5, 1.0, 4.0]))
    bare = stress(HERTZ, Body((), (1.0, 0.3), 0.4), x, 0.2 * x, z)
    np.testing.assert_allclose(stress(HERTZ, alike, x, 0.2 * x, z, 1), bare, rtol=0, atol=1e-9 * 1e9)


@pytest.mark.parametrize("interface", [1, 2])
def test_bonded_interfaces(interface):
    depth = sum(COATED.thickness[:interface])
    x = np.concatenate([-R, R])
    points = x, 0.3 * x, np.full(x.size, depth)
    sides = [np.full(x.size, interface - 1), np.full(x.size, interface)]
    above, below = (axisymmetric.stress([ROUGH], COATED, *points, side)[0] for side in sides)
    np.testing.assert_allclose(above[[2, 4, 5]], below[[2, 4, 5]], rtol=0, atol=1e-8 * 1e9)
    above, below = (axisymmetric.displacement([ROUGH], COATED, *points, side)[0] for side in sides)
    np.testing.assert_allclose(above, below, rtol=0, atol=1e-8 * np.abs(above).max())


@pytest.mark.parametrize("body", [Body((), (1.0, 0.3), 0.4), COATED])
def test_equilibrium_next_to_the_edge(body):
    """div sigma = 0 by central differences, 1e-2 a from the edge."""
    at = A * np.array([-1.006, 0.05, 0.008])
    step = 2e-5 * A
    shifted = at + step * np.concatenate([np.eye(3), -np.eye(3)])
    xx, yy, zz, xy, xz, yz = stress(HERTZ, body, *shifted.T)
    slope = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    slope = (slope[..., :3] - slope[..., 3:]) / (2 * step)
    assert np.abs(np.einsum("ijj->i", slope)).max() < 1e-5 * np.abs(slope).max()


def test_several_profiles_at_once():
    x = np.linspace(-2, 2, 9) * A
    both = axisymmetric.stress([HERTZ, ROUGH], COATED, x, x, 0 * x, np.zeros(9, int))
    np.testing.assert_allclose(both[1], stress(ROUGH, COATED, x, x, 0.0), rtol=0, atol=1e-9 * 1e9)


def test_points_held_at_a_time_change_no_field(monkeypatch):
    x, z, layer = R[:6], A * np.array([0.0, 0.2, 0.2, 0.4, 1.0, 1.0]), np.array([0, 0, 0, 1, 2, 2])
    whole = axisymmetric.stress([HERTZ], COATED, x, x, z, layer)
    monkeypatch.setattr(axisymmetric, "BLOCK", 1)
    one_by_one = axisymmetric.stress([HERTZ], COATED, x, x, z, layer)
    np.testing.assert_allclose(one_by_one, whole, rtol=0, atol=1e-12 * 1e9)


@pytest.mark.parametrize("coatings", [(), ((840e9, 0.3, 2e-5),), ((52e9, 0.3, 2e-5), (300e9, 0.2, 1e-5))])
def test_solution_at_its_own_edge(coatings):
    """The peak of a sliding contact lies on the edge, and the planes agree with the points."""
    found = semianalytic.solve(
        radius=10e-3, load=20.0, coatings=coatings, substrate=(210e9, 0.3), friction=0.3, patches=65
    )
    a = found.contact_radius
    x = -a * (1 + np.array([-1e-3, -1e-6, 0.0, 1e-6, 1e-3]))
    xx = found.stress(x, 0.0, 0.0)[0, 0]
    assert xx.argmax() == 2
    if not coatings:
        exact = found.peak_pressure * (0.4 / 3 + 4.3 * np.pi * 0.3 / 8)
        assert xx[2] == pytest.approx(exact, rel=1e-6)
    plane = found.stress_plane(1e-5)
    i = np.array([3, 20, 32, 40])
    points = found.stress(found.nodes[i], found.nodes[20], 1e-5)
    np.testing.assert_allclose(plane[:, :, i, 20], points, rtol=0, atol=1e-6 * found.peak_pressure)


def test_uncertain_radius_shows_at_the_edge_only():
    found = semianalytic.solve(radius=10e-3, load=20.0, coatings=(), substrate=(210e9, 0.3), patches=65)
    a = found.contact_radius
    U = found.stress_uncertainty(a * np.array([0.5, 1.0, 1.5]), 0.0, 0.0)[0, 0]
    assert U[1] > 0.1 * found.peak_pressure * np.sqrt(2 * found.uncertainty.contact_radius / a)
    assert U[[0, 2]].max() < 0.1 * U[1]
