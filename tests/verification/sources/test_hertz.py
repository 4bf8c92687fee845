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


def test_johnson_1985_maximum_shear_is_0310_p0_at_048_a(sphere):
    # Johnson, section 4.2(a): printed to two and three digits.
    z = np.linspace(0.3, 0.7, 4001) * sphere.contact_radius
    sigma = stress_on_axis(sphere, z)
    shear = np.abs(sigma[2, 2] - sigma[0, 0]) / 2 / sphere.peak_pressure
    assert shear.max() == pytest.approx(0.310, abs=5e-4)
    assert z[shear.argmax()] / sphere.contact_radius == pytest.approx(0.48, abs=5e-3)


def test_johnson_1985_edge_tension_is_one_minus_2_nu_over_3(sphere):
    sigma = sphere.stress(sphere.contact_radius, 0.0, 0.0)
    assert sigma[0, 0] / sphere.peak_pressure == pytest.approx((1 - 2 * sphere.nu) / 3, rel=1e-12)


def test_field_meets_the_axis_formulas(sphere):
    z = np.linspace(0, 5, 101) * sphere.contact_radius
    assert sphere.stress(0.0, 0.0, z) == pytest.approx(
        stress_on_axis(sphere, z), abs=1e-12 * sphere.peak_pressure
    )


def test_surface_carries_the_pressure_alone(sphere):
    x = np.linspace(-2, 2, 81) * sphere.contact_radius
    sigma = sphere.stress(x, 0.3 * sphere.contact_radius, 0.0)
    # w^2 z^2 cancels to rounding near the edge, so a few digits of the sixteen go.
    tolerance = 1e-10 * sphere.peak_pressure
    assert sigma[2, 2] == pytest.approx(-sphere.pressure(x, 0.3 * sphere.contact_radius), abs=tolerance)
    assert np.abs(sigma[:2, 2]).max() <= tolerance


def test_field_is_in_equilibrium(sphere):
    a, d = sphere.contact_radius, 1e-4 * sphere.contact_radius
    for point in np.array([(0.7, 0.3, 0.2), (0.5, -0.8, 0.6), (0.4, 1.2, 1.5)]) * a:
        steps = d * np.eye(3)
        divergence = sum(
            (sphere.stress(*(point + steps[j]))[:, j] - sphere.stress(*(point - steps[j]))[:, j]) / (2 * d)
            for j in range(3)
        )
        # Central differences err by d^2/6 times a third derivative, about 20 p0/a^3 here.
        assert np.abs(divergence).max() * a / sphere.peak_pressure < 1e-6


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


@pytest.mark.parametrize(("name", "value"), [("radius", 0.0), ("load", -1.0), ("E", 0.0), ("nu", 0.6)])
def test_bad_input_is_one_sentence_with_the_quantity(name, value):
    arguments = {"radius": 1.0, "load": 1.0, "E": 1.0, "nu": 0.3} | {name: value}
    with pytest.raises(ValueError, match=f"{name} = "):
        Hertz(**arguments)
