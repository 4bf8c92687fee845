"""Contacts that are no discs, by the compliance of finite elements."""

import numpy as np
import pytest

from fem_reference import NotConverged, solve_shape
from fem_reference.not_round.indenter_height import indenter_height
from verification.problem.indenter_shape import height_of
from verification.problem.point_answers import EDGE, Points
from verification.sources.references.hertz_ellipse import pressed_ellipsoid

STEEL = (210e9, 0.3)
RADII = (16e-3, 6e-3)
LOAD = 20.0
EXACT = pressed_ellipsoid(*RADII, LOAD, *STEEL)
QUICK = {"harmonics": 32, "surface": 0.12, "far": 100.0, "estimate_uncertainty": False}


def solved(start, **changes):
    given = {"indenter": ("ellipsoid", RADII), "radius": 9.8e-3, "load": LOAD, "coatings": ()}
    return solve_shape(start=start, substrate=STEEL, **given | QUICK | changes)


def wrong(x, y):
    return 1.01 * EXACT.pressure(np.asarray(x) / 1.02, y)


def test_a_wrong_start_is_corrected_to_the_contact_of_hertz():
    found, other = solved(wrong), solved(EXACT.pressure)
    assert found.peak_pressure == pytest.approx(EXACT.peak_pressure, rel=3e-4)
    assert found.approach == pytest.approx(EXACT.approach, rel=5e-5)
    assert found.contact_radius == pytest.approx(EXACT.contact_radius, rel=5e-4)
    assert found.extent_x == pytest.approx(EXACT.axes[0], rel=5e-3)  # of the 2e-2 given
    assert found.extent_y == pytest.approx(EXACT.axes[1], rel=5e-3)
    assert found.load == pytest.approx(LOAD, rel=1e-6)
    # the start does not decide
    assert found.peak_pressure == pytest.approx(other.peak_pressure, rel=1e-4)
    assert found.approach == pytest.approx(other.approach, rel=1e-5)
    # the gap left inside is small
    s = np.array([0.0, 0.3, 0.6])
    gap = other.gap(s * EXACT.axes[0], 0 * s, height_of(("ellipsoid", RADII), 1.0), other.approach)
    assert np.abs(gap).max() < 1e-4 * other.approach


@pytest.mark.parametrize("radii", [RADII, RADII[::-1]], ids=["long axis", "short axis"])
def test_the_stress_at_the_end_of_an_axis_is_johnsons(radii):
    """K. L. Johnson, Contact Mechanics, 1985, section 4.2: sigma_x = -sigma_y there."""
    exact, (_, nu) = pressed_ellipsoid(*radii, LOAD, *STEEL), STEEL
    found = solved(exact.pressure, indenter=("ellipsoid", radii), harmonics=None, surface=0.06)
    b, a = sorted(exact.axes)
    e = np.sqrt(1 - (b / a) ** 2)
    radial = (1 - 2 * nu) * exact.peak_pressure * b / (a * e * e)
    radial *= np.arctanh(e) / e - 1 if exact.axes[0] == a else 1 - b / (a * e) * np.arctan(e * a / b)
    stress = found.stress(found.extent_x, 0.0, 0.0) / exact.peak_pressure
    assert stress[0, 0] == pytest.approx(radial / exact.peak_pressure, abs=3e-4)
    assert stress[1, 1] == pytest.approx(-radial / exact.peak_pressure, abs=3e-4)


def test_beside_its_own_edge_the_pressure_is_as_uncertain_as_it_is_wrong():
    found = solved(EXACT.pressure, surface=0.06, estimate_uncertainty=True)
    share, exact = np.array([0.97, 0.997, 0.9997]), EXACT.axes[0]
    p = EXACT.pressure(share * exact, 0.0)
    at_same_share = np.abs(found.pressure(share * found.extent_x) - p)
    at_same_place = np.abs(found.pressure(share * exact) - p)
    relative = found.sample(Points(share * found.extent_x, frame=EDGE), "pressure").uncertainty
    assert np.all(at_same_share <= relative)
    assert np.all(at_same_place <= found.sample(Points(share * exact), "pressure").uncertainty)
    assert np.all(relative < 0.5 * found.sample(Points(share * exact), "pressure").uncertainty), (
        "the edge counts twice"
    )


def test_a_start_turned_by_a_right_angle_is_not_taken_for_the_contact():
    turned = pressed_ellipsoid(*RADII[::-1], LOAD, *STEEL).pressure
    try:
        found = solved(turned)
    except (NotConverged, ValueError, np.linalg.LinAlgError):
        return
    assert found.extent_x / found.extent_y == pytest.approx(EXACT.axes[0] / EXACT.axes[1], rel=0.02)


@pytest.mark.parametrize(
    "indenter",
    [("ellipsoid", (2e-2, 5e-3)), ("asperities", (2e-4,)), ("lobes", (3.0, 3e-8, 9e-5))],
    ids=lambda one: one[0],
)
def test_height_and_symmetry(indenter):
    height, fold = indenter_height(indenter, 1e-2)
    r, theta = np.meshgrid(1e-4 * np.array([0.2, 0.7, 1.3]), np.array([0.1, 0.9, 2.2]))
    x, y = r * np.cos(theta), r * np.sin(theta)
    np.testing.assert_allclose(height(x, y), height_of(indenter, 1e-2)(x, y), rtol=1e-12, atol=1e-22)
    turned = theta + 2 * np.pi / fold
    np.testing.assert_allclose(height(r * np.cos(turned), r * np.sin(turned)), height(x, y), rtol=1e-9)
    np.testing.assert_allclose(height(x, -y), height(x, y), rtol=1e-12)


def test_a_shape_that_is_unknown_is_refused():
    with pytest.raises(ValueError, match="ellipsoid"):
        indenter_height(("cube", (1.0,)), 1.0)
