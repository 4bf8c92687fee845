"""Displacements and stiffness of the references: closed forms, far fields, laws."""

import numpy as np
import pytest

from verification.problem.point_answers import Points
from verification.sources.references import integral_equation
from verification.sources.references.hertz import Hertz

R, W, STEEL, F = 10e-3, 20.0, (210e9, 0.3), 0.25
E, NU = STEEL
G = E / (2 * (1 + NU))
SLIDING = Hertz(R, W, E, NU, F)
A = SLIDING.contact_radius


def exact(coatings=(), friction=F):
    return integral_equation.solve(radius=R, load=W, coatings=coatings, substrate=STEEL, friction=friction)


def points(random):
    x, y = random.uniform(-5, 5, (2, 60)) * A
    z = np.concatenate([np.zeros(20), random.uniform(0.02, 4, 40)]) * A
    x[:3], y[:3] = [0, A, -A], 0  # the axis, the edge
    return x, y, z


@pytest.mark.parametrize("coatings", [(), ((E, NU, 0.4 * A), (E, NU, 0.7 * A))])
def test_integral_equation_gives_the_closed_displacement_where_all_moduli_are_equal(coatings):
    at = points(np.random.default_rng(1))
    gap = exact(coatings).displacement(*at) - SLIDING.displacement(*at)
    assert np.abs(gap).max() < 1e-11 * SLIDING.approach


def test_closed_displacement_of_the_surface_is_johnsons():
    sphere, r = Hertz(R, W, E, NU), np.linspace(0, 4, 33) * A
    u = sphere.displacement(r, 0.0, 0.0)
    # Johnson (3.41a), (3.42a)
    s = np.minimum(A / np.maximum(r, A), 1)
    outside = ((2 * A**2 - r**2) * np.arcsin(s) + r * A * np.sqrt(1 - s**2)) / (2 * A)
    down = np.where(r <= A, np.pi / 4 * (2 * A**2 - r**2) / A, outside)
    assert u[2] == pytest.approx(sphere.peak_pressure * (1 - NU**2) / E * down, rel=1e-12, abs=0)
    # Johnson (3.41b), (3.42b): the load inside r moves the surface towards the axis
    inside = 1 - np.maximum(1 - (r[1:] / A) ** 2, 0) ** 1.5
    radial = -(1 - 2 * NU) * (1 + NU) / (3 * E) * A**2 / r[1:] * sphere.peak_pressure * inside
    assert u[0, 1:] == pytest.approx(radial, rel=1e-10, abs=0)
    assert u[:2, 0] == pytest.approx(0, abs=1e-15 * sphere.approach)


def test_displacement_passes_an_interface_and_states_its_uncertainty():
    coated = exact(((4 * E, 0.2, 0.5 * A), (0.3 * E, 0.4, 0.3 * A)))
    x = A * np.array([0.3, -0.9, 2.0])
    for depth in (0.5 * A, 0.8 * A):
        above, below = (coated.displacement(x, 0.4 * A, depth * (1 + s)) for s in (-1e-7, 1e-7))
        assert np.abs(above - below).max() < 1e-6 * coated.approach
    U = coated.sample(Points(x, 0.4 * A, 0.0), "displacement").uncertainty
    assert U.shape == (3, 3)
    assert 0 < U.max() < 1e-8 * coated.approach
