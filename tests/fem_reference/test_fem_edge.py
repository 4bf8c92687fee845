"""Stresses at the contact edge: the peak of sigma_xx, its sides, the estimate in the strip around it."""

import numpy as np
import pytest

from fem_reference import solve
from fem_reference.elasticity.axisymmetric import Discretisation
from fem_reference.elasticity.recovery import HarmonicField
from fem_reference.element_numbers import EDGE_SERIES, EDGE_SIZE
from fem_reference.meshing.mesh import Grading, meridian_mesh
from verification.problem.point_answers import Points
from verification.sources.references import hertz, integral_equation

R, W, E, NU = 10e-3, 20.0, 210e9, 0.3
A_H = (3 * W * R * (1 - NU**2) / (4 * E)) ** (1 / 3)
P_H = 3 * W / (2 * np.pi * A_H**2)


def problem(ratio, thickness, friction=0.25):
    coatings = ((ratio * E, NU, thickness * A_H),) if thickness else ()
    return {"radius": R, "load": W, "coatings": coatings, "substrate": (E, NU), "friction": friction}


@pytest.mark.slow
@pytest.mark.parametrize("friction", [0.0, 0.25, 0.5])
@pytest.mark.parametrize(("ratio", "thickness"), [(1, 0), (0.25, 0.1), (0.25, 1.0), (4.0, 0.1), (4.0, 1.0)])
def test_tension_at_the_edge_equals_the_exact_value_on_both_sides(ratio, thickness, friction):
    given = problem(ratio, thickness, friction)
    s = solve(**given, estimate_uncertainty=False)
    exact = integral_equation.solve(**given, estimate_uncertainty=False)
    assert s.contact_radius == pytest.approx(exact.contact_radius, rel=1e-6)
    for side in (-1, 1):
        expected = exact.stress(side * exact.contact_radius, 0.0, 0.0)[0, 0]
        x = side * s.contact_radius * np.array([1 - 1e-12, 1.0, 1 + 1e-12])
        got = s.stress(x, 0.0, 0.0)[0, 0]
        assert np.abs(got - expected).max() < 2e-5 * P_H
        assert np.ptp(got) < 1e-5 * P_H


def test_largest_tension_of_a_sliding_contact_lies_at_the_edge():
    given = problem(1, 0)
    s, exact = (solve(**given, quality="fast", estimate_uncertainty=False), hertz.Hertz(R, W, E, NU, 0.25))
    offsets = 10 ** np.linspace(-9, -1.5, 100)
    x = -s.contact_radius * (1 + np.concatenate([-offsets, [0.0], offsets]))
    sigma = s.stress(x, 0.0, 0.0)[0, 0]
    assert abs(x[np.argmax(sigma)] / exact.contact_radius + 1) < 1e-5
    assert sigma.max() == pytest.approx(exact.stress(-exact.contact_radius, 0.0, 0.0)[0, 0], abs=2e-5 * P_H)


@pytest.mark.parametrize("friction", [0.0, 0.5])
def test_the_estimate_covers_the_error_in_the_strip_around_the_edge(friction):
    s, exact = solve(**problem(1, 0, friction), quality="fast"), hertz.Hertz(R, W, E, NU, friction)
    rng = np.random.default_rng(1)
    n, a = 3000, exact.contact_radius
    offset = np.where(rng.random(n) < 0.5, rng.uniform(0, 0.1, n), 10 ** rng.uniform(-9, -1, n))
    r, theta = a * (1 + rng.choice([-1, 1], n) * offset), rng.uniform(0, 2 * np.pi, n)
    points = r * np.cos(theta), r * np.sin(theta), 0.05 * a * np.maximum(rng.uniform(-0.5, 1, n), 0) ** 2
    stress, uncertainty = s.sample(Points(*points), "stress")
    excess = np.abs(stress - exact.stress(*points)) > uncertainty + 1e-9 * P_H
    assert excess.mean() < 1e-3
    # at the edge the uncertainty of sigma is about the square root of that of the radius
    assert s.sample(Points(-a, 0.0, 0.0), "stress").uncertainty[0, 0] < 2e-2 * P_H


@pytest.mark.slow
def test_hard_ultra_thin_film_converges():
    given = {"radius": 8e-3, "load": 28.060850301711923, "substrate": (207e9, 0.455)}
    given["coatings"] = ((6236910000000.0, 0.4309, 4.411584e-7),)
    s = solve(**given, quality="fast", estimate_uncertainty=False)
    exact = integral_equation.solve(**given, estimate_uncertainty=False)
    assert s.contact_radius == pytest.approx(exact.contact_radius, rel=1e-3)


class Strained(HarmonicField):
    """Strains that are given, in place of the derivatives of a displacement."""

    def _fields_and_strains(self, at):
        return np.zeros((2 + self.harmonic, at.r.size)), self.pressure(at)


def strained(strain, harmonic=0):
    """The field of ``strain``, a function of points, on a coated solid in contact at radius 1."""
    mesh = meridian_mesh(contact_radius=1.0, thicknesses=(0.5,), far=500.0, grading=Grading(axis_size=0.6))
    d = Discretisation(mesh, 2)
    return Strained(d, np.zeros((2 + harmonic) * d.N), ((4.0, 0.1), (1.0, 0.4)), harmonic, strain, -1.0, True)


@pytest.mark.parametrize("harmonic", [0, 1])
def test_the_series_at_the_edge_leaves_out_what_displaces_it(harmonic):
    inside, outside, count = 0.3, -0.7, 4 + 2 * harmonic

    def strain(r, displaced=2e-5):
        d = np.abs(r - 1)
        root = np.where(r < 1, inside, outside) * np.sqrt(d)
        return np.tile(
            1 + root + displaced * np.where(r < 1, 1, -1) / np.sqrt(np.maximum(d, 1e-12)), (count, 1)
        )

    field, unit = strained(lambda at: strain(at.r), harmonic), EDGE_SERIES[0] * EDGE_SIZE
    r = 1 + unit * np.array([-1.1, -0.9, -0.1, 0.0, 0.1, 0.9, 1.1])
    found, near = field._with_series(r, strain(r)), np.abs(r - 1) < unit
    replaced = [0, 4] if harmonic else [0]
    kept = np.delete(np.arange(count), replaced)
    np.testing.assert_allclose(found[replaced][:, near], strain(r, 0.0)[replaced][:, near], rtol=0, atol=1e-8)
    np.testing.assert_array_equal(found[:, ~near], strain(r)[:, ~near])
    np.testing.assert_array_equal(found[kept], strain(r)[kept])


def test_the_interface_has_the_traction_of_the_side_with_the_smaller_error():
    """Of the weights E / M^2 with M = lambda + 2 G of either side."""
    field = strained(lambda at: np.tile([[0.0], [0.0], [1.0], [0.0]], at.r.size))
    at = field.discretisation.locator.points(np.array([0.7]), np.array([0.5]), np.array([0]))
    E, nu = np.array(field.materials).T
    G = E / (2 * (1 + nu))
    M = 2 * G + 2 * G * nu / (1 - 2 * nu)
    expected = np.average(M, weights=E / M**2)
    np.testing.assert_allclose(field(at)[1][2], expected, rtol=1e-13)


def test_the_smallest_triangle_lies_at_the_contact_edge():
    mesh = meridian_mesh(contact_radius=1.0, thicknesses=(), far=500.0, grading=Grading.of(0.3))
    corners = mesh.points[:, mesh.triangles]
    sides = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=0).min(axis=0)
    at = sides.argmin()
    assert 1e-7 <= sides[at] < 1.5e-7
    assert np.linalg.norm(corners[:, :, at].mean(axis=1) - [1.0, 0.0]) < 1e-6
