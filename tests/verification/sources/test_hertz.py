"""Hertz's closed form against print, its own limits and equilibrium."""

import numpy as np
import pytest

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
