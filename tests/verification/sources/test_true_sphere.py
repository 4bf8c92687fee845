"""A true sphere in place of the parabola: closed form, rate of the difference, both methods."""

import numpy as np
import pytest
from true_sphere import SphereOnHalfSpace

import fem_reference
import semianalytic
from fem_reference.contact.fixed_radius import solve_at_radius
from fem_reference.elasticity.axisymmetric import Discretisation
from fem_reference.meshing.mesh import Grading, meridian_mesh
from fem_reference.scaling import LayeredSolid
from verification.sources.references import integral_equation
from verification.sources.references.integral_equation import PARABOLA, SPHERE

E, NU, R = 210e9, 0.3, 10e-3
E_STAR = E / (1 - NU**2)
SCALARS = ("contact_radius", "approach", "peak_pressure")


def load_at(s):
    """Load under which the parabola touches the bare solid over a = s R."""
    return 4 / 3 * E_STAR * s**3 * R**2


def problem(s, ratio=None, h=0.5):
    coatings = () if ratio is None else ((ratio * E, 0.25, h * s * R),)
    return {"radius": R, "load": load_at(s), "coatings": coatings, "substrate": (E, NU)}


def change(solve, gaps, s, ratio=None, **numerics):
    """Relative change of the scalars from the parabola to the sphere."""
    parabola, sphere = (
        solve(**problem(s, ratio), estimate_uncertainty=False, gap=gap, **numerics) for gap in gaps
    )
    return np.array([getattr(sphere, name) / getattr(parabola, name) - 1 for name in SCALARS])


@pytest.mark.parametrize("s", [0.03, 0.3, 0.8])
def test_uncoated_sphere_meets_sneddons_closed_form(s):
    closed = SphereOnHalfSpace(R, s * R, E_STAR)
    exact = integral_equation.solve(
        radius=R, load=closed.load, coatings=(), substrate=(E, NU), gap=SPHERE, estimate_uncertainty=False
    )
    for name in SCALARS:
        assert getattr(exact, name) == pytest.approx(getattr(closed, name), rel=1e-11)
    assert exact.stiffness == pytest.approx(2 * E_STAR * closed.contact_radius, rel=1e-12)


def test_uncoated_difference_has_the_closed_first_coefficients():
    s = 0.01
    # the next term of the series is of order s^2 = 1e-4
    assert change(integral_equation.solve, (PARABOLA, SPHERE), s) / s**2 == pytest.approx(
        np.array([-2 / 15, 1 / 15, 4 / 45]), rel=1e-4
    )


@pytest.mark.parametrize("ratio", [None, 0.1, 10.0])
def test_difference_vanishes_as_the_square_of_the_contact_radius(ratio):
    radii = np.array([0.01, 0.1])
    small, large = (change(integral_equation.solve, (PARABOLA, SPHERE), s, ratio, nodes=40) for s in radii)
    exponent = np.log(large / small) / np.log(radii[1] / radii[0])
    assert exponent == pytest.approx(2.0, rel=0.05)


def test_semianalytical_sphere_agrees_with_the_exact_one():
    methods = (
        (integral_equation.solve, (PARABOLA, SPHERE), {}),
        (semianalytic.solve, ("parabola", "sphere"), {"patches": 33}),
    )
    exact, found = (change(solve, gaps, 0.3, 4.0, **numerics) for solve, gaps, numerics in methods)
    # the changes are 3e-3 to 9e-3; the radius of 33 patches errs by 1e-4, alike for both but for a tenth
    assert found == pytest.approx(exact, abs=1e-5)


def test_finite_elements_at_a_radius_meet_the_closed_form():
    s, grading = 0.5, Grading(size=0.4, edge_rate=0.4, edge_size=1e-5, axis_size=0.4, far_size=0.4)
    mesh = meridian_mesh(contact_radius=1.0, thicknesses=(), far=1000.0, grading=grading)
    solid = LayeredSolid(materials=((1 - NU**2, NU),), thicknesses=(), far=mesh.far)
    found = solve_at_radius(solid, Discretisation(mesh, 4), curvature=s)
    closed = SphereOnHalfSpace(1 / s, 1.0, 1.0)
    # the unit of displacement is L^2/R, here s; the parabola is 5 % away
    assert found.load * s == pytest.approx(closed.load, rel=1e-5)
    assert found.approach * s == pytest.approx(closed.approach, rel=1e-5)
    assert found.pressure(np.zeros(1))[0] * s == pytest.approx(closed.peak_pressure, rel=1e-3)


@pytest.mark.slow
def test_finite_elements_confirm_the_change_of_a_coated_contact():
    exact = change(integral_equation.solve, (PARABOLA, SPHERE), 0.3, 0.25)
    found = change(fem_reference.solve, ("parabola", "sphere"), 0.3, 0.25, size=0.3)
    assert found == pytest.approx(exact, rel=1e-4)
