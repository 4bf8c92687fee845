"""Finite strain: neo-Hookean layers, elements, the contact against closed forms and a second theory."""

from dataclasses import astuple

import numpy as np
import pytest
from assumption_maps_made import neo_hooke
from assumption_maps_made.finite_deformation import SphereContact
from assumption_maps_made.meridian_elements import Meridian
from assumption_maps_made.small_strain_cost import Resolution, deformed, of_small_strains
from true_sphere import SphereOnHalfSpace

from verification.problem.coated_contact import CoatedContact, keywords
from verification.sources.references import integral_equation
from verification.sources.references.integral_equation import SPHERE

STEEL = (210e9, 0.3)
MU, LAM = (np.array(part) for part in neo_hooke.lame(1.0, 0.3))
SMALL, FINER = Resolution(3, 1.5, 0.05, 10.0), Resolution(5, 1.0, 3e-4, 100.0)


def contact(width, ratio=None, thickness=0.5, nu=0.3):
    """A contact of a_h/R = ``width``, uncoated without ``ratio``."""
    E, R = STEEL[0], 1e-3
    a_h = width * R
    coatings = () if ratio is None else ((ratio * E, nu, thickness * a_h),)
    return CoatedContact(R, 4 * a_h**3 * E / (1 - nu**2) / (3 * R), coatings, (E, nu))


def grid(resolution, depths=()):
    return Meridian(depths, resolution.far, resolution.degree, resolution.step, resolution.edge)


def gradient(seed=1, size=0.2):
    return neo_hooke.IDENTITY + size * np.random.default_rng(seed).uniform(-1, 1, 5)


def slopes(function, x, step=1e-6):
    return np.stack(
        [(function(x + h) - function(x - h)) / (2 * step) for h in step * np.eye(x.size)], axis=-1
    )


def test_tangent_is_the_slope_of_the_stress():
    F = gradient()
    by_slopes = slopes(lambda F: neo_hooke.first_piola(F, MU, LAM), F)
    assert neo_hooke.tangent(F, MU, LAM) == pytest.approx(by_slopes, abs=1e-8)


def test_contact_of_a_sphere_at_small_strain():
    """Radius to the size of the elements at the edge, approach to the boundary."""
    exact = SphereOnHalfSpace(5.0, 1.0, 1.0)
    mesh = grid(Resolution(4, 1.6, 1e-3, 20.0))
    model = SphereContact(mesh, 5.0, exact.load, (), (0.91, 0.3), False)
    found = model.results(model.solve())
    assert found.contact_radius == pytest.approx(1.0, rel=5e-5)
    assert found.approach == pytest.approx(exact.approach, rel=1e-4)
    assert found.peak_pressure == pytest.approx(exact.peak_pressure, rel=1e-3)
    assert found.tension == pytest.approx(0.4 * exact.load / (2 * np.pi), abs=2e-3 * exact.peak_pressure)


def test_deformed_contact_lies_on_the_sphere_and_balances_the_load():
    R, load = 4.0, 0.3
    model = SphereContact(grid(SMALL, (0.5,)), R, load, ((0.5, 0.3, 0.5),), (1.0, 0.3), True)
    state = model.solve()
    r, z = state.A * model.rho + state.u[model.c_r], state.u[model.c_z]
    assert np.hypot(r, R - state.delta + z) == pytest.approx(R, rel=1e-9)
    f = model.forces(state)
    slope = r / np.sqrt(R**2 - r**2)
    assert f[model.c_r][1:] == pytest.approx((slope * f[model.c_z])[1:], abs=1e-9 * load)  # along the normal
    assert 2 * np.pi * f[model.c_z].sum() == pytest.approx(load)
    assert f[model.c_z][-1] == pytest.approx(0.0, abs=1e-9 * load)


@pytest.mark.slow
@pytest.mark.parametrize("nu", [0.0, 0.3, 0.49])
@pytest.mark.parametrize("ratio", [0.25, 10.0])
@pytest.mark.parametrize("thickness", [0.01, 0.05, 1.0])
def test_small_strain_meets_the_exact_coated_contact(thickness, ratio, nu):
    """Stress to 2e-4 of the peak pressure also near incompressibility, so nothing locks."""
    problem = contact(0.1, ratio, thickness, nu)
    exact = integral_equation.solve(**keywords(problem), gap=SPHERE, estimate_uncertainty=False)
    found, a_h, p_h = deformed(problem, FINER)[0], problem.a_h, problem.E_star
    assert found.contact_radius * a_h == pytest.approx(exact.contact_radius, rel=3e-5)
    assert found.approach * a_h == pytest.approx(exact.approach, rel=2e-3)
    assert found.peak_pressure * p_h == pytest.approx(exact.peak_pressure, rel=1e-4)
    edge = exact.contact_radius + thickness * a_h * np.linspace(-2, 1, 200)
    x = np.sort(np.append(np.linspace(0, 4, 400) * a_h, edge[edge > 0]))
    shear = np.abs(exact.stress(x, 0.0, problem.interfaces[0], 0)[0, 2]).max()
    assert found.shear * p_h == pytest.approx(shear, abs=2e-4 * exact.peak_pressure)
    tension = exact.stress(-exact.contact_radius, 0.0, 0.0)[0, 0]
    assert found.tension * p_h == pytest.approx(tension, abs=3e-4 * exact.peak_pressure)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("ratio", "thickness"), [(None, 0.5), (0.25, 0.5), (4.0, 0.5), (0.1, 0.02), (10.0, 0.02)]
)
def test_cost_is_of_first_order_in_the_width(ratio, thickness):
    widths = 1e-3, 4e-3
    small, large = (of_small_strains(contact(width, ratio, thickness))[0] for width in widths)
    changes = [pair for pair in zip(astuple(small), astuple(large), strict=True) if None not in pair]
    for one, other in changes:
        assert np.log(other / one) / np.log(widths[1] / widths[0]) == pytest.approx(1.0, abs=0.05)
