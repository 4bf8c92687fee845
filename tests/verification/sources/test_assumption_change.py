"""Relative change of a contact by an assumption: rates, no change without its cause, the other method."""

from dataclasses import astuple, replace

import numpy as np
import pytest

import semianalytic
from verification.problem.coated_contact import CoatedContact, keywords
from verification.sources.assumptions.contact_change import (
    RESOLUTION,
    ShearCurve,
    line_along_interface,
    of_goodman,
    of_sphere,
)
from verification.sources.references import integral_equation

E, NU = 210e9, 0.3
BARE = CoatedContact(10e-3, 20.0, (), (E, NU))
COATED = replace(BARE, coatings=((4 * E, 0.25, 0.5 * BARE.a_h),))


def test_sphere_changes_every_quantity_as_the_square_of_the_contact_radius():
    # the same moduli and h/a_h at a load that widens the contact tenfold
    wide = replace(COATED, load=1000 * COATED.load)
    wide = replace(wide, coatings=((4 * E, 0.25, 0.5 * wide.a_h),))
    small, large = (np.array(astuple(of_sphere(one)[0])) for one in (COATED, wide))
    assert np.log10(large / small) == pytest.approx(2.0, rel=0.05)


@pytest.mark.parametrize("ratio", [0.1, 1.0, 10.0])
def test_shear_of_a_thin_coating_is_that_of_a_fine_line(ratio):
    coating = (ratio * E, NU, 0.05 * BARE.a_h)
    exact = integral_equation.solve(**keywords(replace(BARE, coatings=(coating,))), **RESOLUTION)
    a, h = exact.contact_radius, coating[2]
    line = ShearCurve(x := line_along_interface(a, h), exact.stress(x, 0.0, h, 0)[0, 2])
    fine = exact.stress(a + h * np.linspace(-2, 1, 601), 0.0, h, 0)[0, 2]
    assert line.largest == pytest.approx(np.abs(fine).max(), rel=5e-4)


def test_uncoated_trailing_tension_of_the_sphere_is_that_of_the_pressure_at_the_edge():
    # frictionless, sigma_xx(-a) = (1 - 2 nu) W/(2 pi a^2) whatever the pressure
    change, _ = of_sphere(BARE)
    assert change.tension == pytest.approx((1 + change.contact_radius) ** -2 - 1, rel=1e-6)
    assert change.shear is None


def test_semianalytical_stress_confirms_the_change_of_tension_by_the_sphere():
    s = 0.2
    problem = replace(COATED, load=4 / 3 * BARE.E_star * s**3 * BARE.radius**2, friction=0.3)
    problem = replace(problem, coatings=((4 * E, 0.25, 0.5 * problem.a_h),))
    parabola, sphere = (
        semianalytic.solve(**keywords(problem), estimate_uncertainty=False, gap=gap)
        for gap in ("parabola", "sphere")
    )
    tension = [one.stress(-one.contact_radius, 0.0, 0.0)[0, 0] for one in (parabola, sphere)]
    assert tension[1] / tension[0] - 1 == pytest.approx(of_sphere(problem)[0].tension, abs=2e-6)


def test_coupling_changes_scalars_as_the_square_of_friction_and_stresses_in_proportion():
    small, large = (np.array(astuple(of_goodman(replace(COATED, friction=f))[0])) for f in (1e-4, 1e-3))
    exponent = np.log10(np.abs(large / small))
    assert exponent[:2] == pytest.approx(2.0, rel=0.05)
    assert exponent[3:] == pytest.approx(1.0, rel=0.05)


def test_nothing_couples_without_friction():
    assert np.abs([astuple(one) for one in of_goodman(COATED)]).max() < 1e-12
