"""Numbers that textbooks print of a sphere on steel, nu = 0.3, met by both methods and the closed forms."""

import functools

import numpy as np
import pytest

import fem_reference
import semianalytic
from verification.sources.references.hamilton import Hamilton
from verification.sources.references.hertz import Hertz

PROBLEM = {"radius": 10e-3, "load": 20.0, "coatings": (), "substrate": (210e9, 0.3)}
SOLID = (10e-3, 20.0, 210e9, 0.3)
SOURCES = ["closed form", "semianalytic", "fem_reference"]


@functools.cache
def solved(source, friction=0.0):
    if source == "closed form":
        return Hamilton(*SOLID, friction) if friction else Hertz(*SOLID)
    if friction:
        return solved(source).with_friction(friction)
    method = {"semianalytic": semianalytic, "fem_reference": fem_reference}[source]
    return method.solve(**PROBLEM, estimate_uncertainty=False)


def von_mises(sigma):
    deviator = sigma - np.trace(sigma) / 3 * np.eye(3).reshape(3, 3, *[1] * (sigma.ndim - 2))
    return np.sqrt(1.5 * (deviator * deviator).sum(axis=(0, 1)))


@pytest.mark.parametrize("source", SOURCES)
def test_johnson_1985_maximum_shear_and_von_mises_on_the_axis(source):
    # Johnson, section 4.2(a): the largest shear is 0.310 p0 at z = 0.48 a. On the axis, where two principal
    # stresses are equal, von Mises' stress is twice that.
    contact = solved(source)
    z = np.linspace(0.3, 0.7, 201) * contact.contact_radius
    sigma = contact.stress(0.0, 0.0, z)
    shear = np.abs(sigma[2, 2] - sigma[0, 0]) / 2 / contact.peak_pressure
    # Half a unit of the printed digits; the depth of a flat maximum follows from them.
    assert shear.max() == pytest.approx(0.310, abs=5e-4)
    assert z[shear.argmax()] / contact.contact_radius == pytest.approx(0.48, abs=5e-3)
    assert von_mises(sigma).max() / contact.peak_pressure == pytest.approx(0.620, abs=5e-4)


@pytest.mark.parametrize("source", SOURCES)
def test_johnson_1985_tension_around_the_contact(source):
    # Johnson, section 3.4(d): sigma_r = -sigma_theta = (1 - 2 nu) p0 a^2 / 3 r^2 on the surface outside.
    contact = solved(source)
    r = np.array([1.1, 1.3, 2.0]) * contact.contact_radius
    sigma = contact.stress(r, 0.0, 0.0) / contact.peak_pressure
    expected = (1 - 2 * 0.3) / 3 * (contact.contact_radius / r) ** 2
    # The accuracy asked of either method on the surface away from the edge.
    assert sigma[0, 0] == pytest.approx(expected, abs=2e-4)
    assert sigma[1, 1] == pytest.approx(-expected, abs=2e-4)


@pytest.mark.parametrize("source", SOURCES)
def test_johnson_1985_stress_at_the_centre_of_the_surface(source):
    # Johnson, section 3.4(d): sigma_r = sigma_theta = -(1 + 2 nu)/2 p0, sigma_z = -p0.
    contact = solved(source)
    sigma = contact.stress(0.0, 0.0, 0.0) / contact.peak_pressure
    assert np.diag(sigma) == pytest.approx([-0.8, -0.8, -1.0], abs=2e-4)


@pytest.mark.parametrize("source", SOURCES)
def test_hertz_1882_contact_scales(source):
    # a^3 = 3 W R / 4 E*, delta = a^2 / R, p0 = 3 W / 2 pi a^2, to the accuracy asked of either method.
    contact = solved(source)
    E_star = 210e9 / (1 - 0.3**2)
    a = (3 * 20.0 * 10e-3 / (4 * E_star)) ** (1 / 3)
    assert contact.contact_radius == pytest.approx(a, rel=5e-4)
    assert contact.approach == pytest.approx(a**2 / 10e-3, rel=1e-5)
    assert contact.peak_pressure == pytest.approx(1.5 * 20.0 / (np.pi * a**2), rel=2e-5)


@pytest.mark.parametrize(
    ("source", "friction", "yields_first"),
    [
        *((source, 0.25, "below") for source in SOURCES),
        *((source, 0.35, "surface") for source in SOURCES[:2]),
        # A second sliding solve of some ten seconds.
        pytest.param("fem_reference", 0.35, "surface", marks=pytest.mark.slow),
    ],
)
def test_hamilton_1983_first_yield_reaches_the_surface_at_friction_above_03(source, friction, yields_first):
    contact = solved(source, friction)
    a = contact.contact_radius
    x = a * np.linspace(-1.2, 0.8, 41)
    # Away from the edge itself, where the maximum on the surface sits but no method is at its best.
    surface = von_mises(contact.stress(x[np.abs(np.abs(x) - a) > 0.02 * a], 0.0, 0.0)).max()
    x, z = np.meshgrid(a * np.linspace(0.0, 0.6, 13), a * np.linspace(0.3, 0.6, 13))
    below = von_mises(contact.stress(x, 0.0, z)).max()
    assert (below > surface) == (yields_first == "below")


@pytest.mark.parametrize("source", SOURCES)
def test_hamilton_1983_tension_behind_a_sliding_contact(source):
    # On y = 0 behind the contact: Hertz's tension and that of the friction, here from the closed form, which
    # at the edge itself is (1 - 2 nu)/3 + f pi (4 + nu)/8.
    contact, exact = solved(source, 0.25), Hamilton(*SOLID, 0.25)
    x = -np.array([1.1, 1.3, 2.0]) * exact.contact_radius
    expected = exact.stress(x, 0.0, 0.0)[0, 0] / exact.peak_pressure
    assert contact.stress(x, 0.0, 0.0)[0, 0] / exact.peak_pressure == pytest.approx(expected, abs=2e-4)
    edge = exact.stress(-exact.contact_radius, 0.0, 0.0)[0, 0] / exact.peak_pressure
    assert edge == pytest.approx(0.4 / 3 + 0.25 * np.pi * 4.3 / 8, rel=1e-12)
