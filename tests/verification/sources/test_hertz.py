"""Hertz's contact at rest and sliding against print, quadrature, its own limits and equilibrium."""

import numpy as np
import pytest

from verification.judging.standard_claims import sources_of
from verification.problem.coated_contact import CoatedContact
from verification.sources.references.axisymmetric_pressure import AbelPressure
from verification.sources.references.hankel_field import HankelField
from verification.sources.references.hertz import Hertz


@pytest.fixture
def sphere():
    return Hertz(radius=10e-3, load=20.0, E=210e9, nu=0.3)


def stress_on_axis(sphere, z):
    """Johnson (3.45a, b)."""
    s, sigma = z / sphere.contact_radius, np.zeros((3, 3, z.size))
    lateral = -(1 + sphere.nu) * (1 - s * np.arctan2(1, s)) + 0.5 / (1 + s**2)
    sigma[0, 0] = sigma[1, 1] = sphere.peak_pressure * lateral
    sigma[2, 2] = -sphere.peak_pressure / (1 + s**2)
    return sigma


def test_pressure_integrates_to_the_load(sphere):
    x, w = np.polynomial.legendre.leggauss(200)
    # r = a sin(t) takes the square root at the edge away.
    t = np.pi / 4 * (1 + x)
    a = sphere.contact_radius
    ring = 2 * np.pi * a**2 * sphere.pressure(a * np.sin(t)) * np.sin(t) * np.cos(t)
    assert np.pi / 4 * w @ ring == pytest.approx(sphere.load, rel=1e-12)
    assert sphere.surface_nodes == pytest.approx(np.linspace(-2 * a, 2 * a, 401), abs=1e-14 * a)


def test_field_meets_the_axis_formulas(sphere):
    z = np.linspace(0, 5, 101) * sphere.contact_radius
    assert sphere.stress(0.0, 0.0, z) == pytest.approx(
        stress_on_axis(sphere, z), abs=1e-12 * sphere.peak_pressure
    )


def test_surface_displacement_fits_the_sphere(sphere):
    r = np.linspace(0, 1, 11) * sphere.contact_radius
    assert sphere.displacement(r, 0.0, 0.0)[2] == pytest.approx(
        sphere.approach - r**2 / (2 * sphere.radius), rel=1e-12, abs=0
    )
    far = 50 * sphere.contact_radius
    # Far away the sphere is a point force: W / (pi E* r), the next term is of order (a/r)^2/10.
    assert sphere.displacement(far, 0.0, 0.0)[2] == pytest.approx(
        sphere.load / (np.pi * sphere.E_star * far), rel=1e-4, abs=0
    )


@pytest.fixture
def sliding():
    return Hertz(radius=10e-3, load=20.0, E=210e9, nu=0.3, friction=0.25)


def quadrature(sphere, friction):
    """The same field as Hankel integrals, for phi = p0 (a^2 - t^2)/(2a) = p0 a/3 (P0 - P2)."""
    a, p0 = sphere.contact_radius, sphere.peak_pressure
    abel = AbelPressure(a, p0 * a / 3 * np.array([1, -1]))
    return HankelField(abel, (), (sphere.E, sphere.nu), friction)


@pytest.mark.parametrize("nu", [-0.3, 0.0, 0.3, 0.5])
@pytest.mark.parametrize("depth", [0.0, 1e-2, 0.5, 2.0, 10.0])
def test_field_meets_hankel_quadrature_everywhere(nu, depth):
    sphere = Hertz(radius=10e-3, load=20.0, E=210e9, nu=nu, friction=1.0)
    a = sphere.contact_radius
    random = np.random.default_rng(3).uniform(-4, 4, (2, 12))
    # The axis and its neighbourhood, where real forms divide by r, and the contact edge.
    x = np.concatenate([random[0], [0.0, 1e-9, -1e-5, 0.0, 1 - 1e-6, -1 - 1e-6, 0.6]]) * a
    y = np.concatenate([random[1], [0.0, 0.0, 1e-6, 1e-3, 0.0, 0.0, 0.8 + 1e-9]]) * a
    exact = quadrature(sphere, 1.0).stress(x, y, depth * a) - quadrature(sphere, 0.0).stress(x, y, depth * a)
    found = sphere.stress_of_traction(x, y, depth * a)
    # Both are exact to rounding, which the quadrature gathers over some 1e4 nodes at the shallowest depth.
    assert np.abs(found - exact).max() <= 1e-11 * sphere.peak_pressure


def test_hamilton_1983_shear_on_the_axis(sliding):
    # sigma_xz / (f p0) = -1 + 3/2 Z atan(1/Z) - Z^2 / (2 (1 + Z^2))
    Z = np.linspace(0, 8, 161)
    printed = -1 + 1.5 * Z * np.arctan2(1, Z) - Z**2 / (2 * (1 + Z**2))
    found = sliding.stress(0.0, 0.0, Z * sliding.contact_radius)[0, 2]
    assert found == pytest.approx(0.25 * sliding.peak_pressure * printed, abs=1e-13 * sliding.peak_pressure)


def test_it_speaks_about_uncoated_sliding_alone():
    steel, coating = (210e9, 0.3), ((420e9, 0.3, 1e-5),)
    assert sources_of(CoatedContact(1e-2, 20.0, (), steel, 0.25))[-1] == "hamilton"
    assert sources_of(CoatedContact(1e-2, 20.0, (), steel))[-1] == "hertz"
    assert "hamilton" not in sources_of(CoatedContact(1e-2, 20.0, coating, steel, 0.25))
