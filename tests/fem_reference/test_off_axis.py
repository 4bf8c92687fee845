"""Pressures without symmetry, harmonic by harmonic."""

import numpy as np
import pytest

from fem_reference import check_pressure, solve_prescribed
from fem_reference.elasticity.loading import solve_traction
from fem_reference.not_round.harmonic_compliance import harmonic_compliance
from fem_reference.not_round.off_axis import AngularPressure, OffAxisFields, discretised
from fem_reference.scaling import LayeredSolid
from verification.problem.point_answers import Points
from verification.sources.references.hertz_ellipse import HertzEllipse

E, NU, F = 210e9, 0.3, 0.25
STEEL = (E, NU)
A = 1e-4
COATINGS = ((4 * E, 0.2, 0.4 * A),)


def checked(pressure, **changes):
    quick = {"harmonics": 8, "size": 0.3, "far": 100.0, "estimate_uncertainty": False}
    given = {"pressure": pressure, "reach": A, "coatings": COATINGS, "substrate": STEEL}
    return check_pressure(**given | quick | changes)


def ellipsoid(a, b, p0=1e9):
    return lambda x, y: p0 * np.sqrt(np.maximum(1 - (x / a) ** 2 - (y / b) ** 2, 0))


def three_lobes(x, y):
    r, theta = np.hypot(x, y) / A, np.arctan2(y, x)
    return 1e9 * np.maximum(1 - r**2, 0) * (1 + 0.3 * r**3 * np.cos(3 * theta))


def test_a_round_pressure_has_the_fields_of_harmonics_0_and_1():
    solid = LayeredSolid.scaled(COATINGS, STEEL, A, 100.0, E)
    d = discretised(solid, 0.4, 0.2, 4)
    angular = AngularPressure.of(lambda x, y: 1e9 * np.maximum(1 - (x**2 + y**2) / A**2, 0) ** 2, A)

    def profile(r):
        return np.maximum(1 - r**2, 0) ** 2

    compliance = harmonic_compliance(solid, d, 4, 1)
    found = OffAxisFields.of(compliance, angular.nodal_loads(compliance), F, angular)
    assert [field.harmonic for field in found.fields] == [0, 1]
    for field, traction in zip(found.fields, (profile, lambda r: F * profile(r)), strict=True):
        expected = solve_traction(d, solid, field.harmonic, traction)
        np.testing.assert_allclose(field.fields, expected, rtol=0, atol=1e-9 * np.abs(expected).max())


def test_a_harmonic_between_those_solved_is_interpolated():
    solid = LayeredSolid.scaled(COATINGS, STEEL, A, 100.0, E)
    d = discretised(solid, 0.5, 0.2, 4)
    many, all_ = harmonic_compliance(solid, d, 40, 2), harmonic_compliance(solid, d, 13, 2, density=20.0)
    assert len(many.solved) < len(many.harmonics)
    m = 12
    assert m in all_.solved
    assert m not in many.solved
    # the whole field, not the deflection alone: the stress below the surface is further off
    found, exact = (one.displacements(np.outer(one.harmonics == m, one.nodes))[m] for one in (many, all_))
    np.testing.assert_allclose(found, exact, rtol=0, atol=2e-4 * np.abs(exact).max())


def test_sliding_gives_the_tractions_of_the_product_with_the_direction():
    found = checked(ellipsoid(A, 0.8 * A), friction=F)
    sigma = found.stress(0.3 * A, 0.2 * A, 0.0)
    p = found.pressure(0.3 * A, 0.2 * A)
    np.testing.assert_allclose(sigma[2], [-F * p, 0.0, -p], atol=1e-9 * p)


@pytest.mark.parametrize(("ratio", "within"), [(0.5, 1e-4), (0.3, 5e-4)])
def test_an_indenter_of_hertz_leaves_no_gap_in_the_mean(ratio, within):
    exact = HertzEllipse(A, ratio * A, 1e9, E / (1 - NU**2))
    p, q = exact.curvatures
    found = checked(ellipsoid(A, ratio * A), coatings=(), harmonics=14, size=0.2, far=1000.0)
    assert found.load == pytest.approx(exact.load, rel=3e-5)
    approach = found.approach_of(lambda x, y: p * x**2 + q * y**2)
    assert approach == pytest.approx(exact.approach, rel=within)
    inside = 0.7 * A * np.array([0.0, 0.5, 0.9]), 0.5 * ratio * A * np.array([0.0, 1.0, -0.5])
    gap = found.gap(*inside, lambda x, y: p * x**2 + q * y**2)
    assert np.abs(gap).max() < 2e-3 * exact.approach


def test_exchanging_the_axes_exchanges_those_of_the_stress():
    x, y, z = A * np.array([[0.1, 0.4, -0.9], [0.3, -0.2, 0.5], [0.3, 0.5, 1.0]])
    one = checked(ellipsoid(A, 0.6 * A)).stress(x, y, z)
    other = checked(ellipsoid(0.6 * A, A)).stress(y, x, z)
    np.testing.assert_allclose(one, other[[1, 0, 2]][:, [1, 0, 2]], rtol=0, atol=1e-6 * 1e9)


def test_three_lobes_turn_by_a_third_of_a_circle():
    found = checked(three_lobes)
    angle = 0.3 + 2 * np.pi / 3 * np.arange(3)
    u = found.displacement(0.6 * A * np.cos(angle), 0.6 * A * np.sin(angle), 0.2 * A)[2]
    assert np.ptp(u) < 1e-9 * np.abs(u).max()
    assert (
        np.ptp(found.displacement(0.6 * A * np.cos([0, 1]), 0.6 * A * np.sin([0, 1]), 0.0)[2]) > 0.01 * u[0]
    )


def test_the_stated_uncertainty_covers_the_change_from_a_finer_solution():
    solid = {"pressure": three_lobes, "reach": A, "coatings": COATINGS, "substrate": STEEL, "friction": F}
    coarse, fine = (check_pressure(**solid, harmonics=5, size=size) for size in (0.34, 0.2))
    x, z = np.meshgrid(A * np.linspace(-1.3, 1.3, 9), A * np.array([0.0, 0.2, 0.4, 1.0]))
    stress, U = coarse.sample(Points(x, 0.3 * A, z), "stress")
    error = np.abs(fine.stress(x, 0.3 * A, z) - stress)
    assert np.mean(error > U) < 0.02
    u, U = coarse.sample(Points(x, 0.3 * A, z), "displacement")
    assert np.mean(np.abs(fine.displacement(x, 0.3 * A, z) - u) > U) < 0.02


def test_friction_is_that_of_a_prescribed_load():
    given = {"coatings": COATINGS, "substrate": STEEL, "friction": F}
    profile = lambda r: 1e9 * np.maximum(1 - (r / A) ** 2, 0)  # noqa: E731
    expected = solve_prescribed(pressure=profile, load_radius=A, quality="fast", **given)
    found = check_pressure(
        pressure=lambda x, y: profile(np.hypot(x, y)), reach=A, size=0.2, harmonics=12, **given
    )
    x, z = np.meshgrid(A * np.array([-1.2, -0.5, 0.0, 0.7]), A * np.array([0.1, 0.4, 0.9]))
    np.testing.assert_allclose(
        found.stress(x, 0.2 * A, z, None), expected.stress(x, 0.2 * A, z, None), rtol=0, atol=2e-4 * 1e9
    )


@pytest.mark.parametrize(
    ("pressure", "named"),
    [
        (lambda x, y: 1e9 * np.maximum(1 - (x**2 + (y - 0.1 * A) ** 2) / A**2, 0), "even"),
        (ellipsoid(1.3 * A, A), "reach"),
        (lambda x, y: np.full(x.shape, np.nan), "finite"),
    ],
)
def test_a_pressure_that_does_not_fit_is_refused(pressure, named):
    with pytest.raises(ValueError, match=named):
        checked(pressure, coatings=())
