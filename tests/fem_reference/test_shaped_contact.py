"""Contacts that are no discs, by the compliance of finite elements."""

import numpy as np
import pytest

import semianalytic
from fem_reference import ElementsNotConverged, solve_shape
from fem_reference.not_round.harmonic_compliance import HarmonicCompliance, Meridian
from fem_reference.not_round.indenter_height import touching_shape
from verification.problem.coated_contact import CoatedContact
from verification.problem.indenter_shape import height_of
from verification.problem.point_answers import EDGE, Points
from verification.sources.method_sources import solve_elements, solve_semianalytic
from verification.sources.references.hertz_ellipse import pressed_ellipsoid

STEEL = (210e9, 0.3)
RADII = (16e-3, 6e-3)
LOAD = 20.0
EXACT = pressed_ellipsoid(*RADII, LOAD, *STEEL)
QUICK = {"harmonics": 32, "surface": 0.12, "degree": 8, "far": 100.0, "estimate_uncertainty": False}


def solved(**changes):
    given = {"indenter": ("ellipsoid", RADII), "radius": 9.8e-3, "load": LOAD, "coatings": ()}
    return solve_shape(**given | {"substrate": STEEL} | QUICK | changes)


def test_the_contact_is_that_of_hertz():
    found = solved(surface=0.09, harmonics=96)
    assert found.peak_pressure == pytest.approx(EXACT.peak_pressure, rel=1e-4)
    assert found.approach == pytest.approx(EXACT.approach, rel=5e-5)
    assert found.contact_radius == pytest.approx(EXACT.contact_radius, rel=3e-4)
    assert (found.extent_x, found.extent_y) == pytest.approx(EXACT.axes, rel=1e-3)
    assert found.load == pytest.approx(LOAD, rel=1e-6)
    s = np.array([0.0, 0.3, 0.6])
    x = s * EXACT.axes[0]
    lifted = height_of(("ellipsoid", RADII), 1.0)(x, 0 * x) + found.displacement(x, 0.0, 0.0)[2]
    gap = lifted - found.approach
    assert np.abs(gap).max() < 1e-4 * found.approach


SHAPES = {
    "ellipsoid": ("ellipsoid", RADII),
    "asperities": ("asperities", (150e-6,)),
    "lobes": ("lobes", (3.0, 20e-9, 86e-6)),
}


@pytest.mark.parametrize(
    "indenter",
    [pytest.param(one, marks=[pytest.mark.slow] * (name == "asperities")) for name, one in SHAPES.items()],
    ids=SHAPES,
)
def test_the_start_is_forgotten(indenter):
    """From a first contact 10 % too wide and from one half as wide, which leaves its mesh, on a coating."""
    given = {"indenter": indenter, "coatings": ((420e9, 0.25, 40e-6),)}
    wide = solved(first=1.1, estimate_uncertainty=True, **given)
    narrow = solved(first=0.5, **given)
    for name in ("contact_radius", "approach", "peak_pressure"):
        value, U = wide.sample(None, name)
        assert abs(narrow.sample(None, name).value - value) <= U
    share, turn = np.array([0.0, 0.3, 0.6, 0.9]), np.linspace(0, np.pi, 5)[:, None]
    x, y = (e * share * f(turn) for e, f in ((wide.extent_x, np.cos), (wide.extent_y, np.sin)))
    value, U = wide.sample(Points(x, y), "pressure")
    assert np.all(np.abs(narrow.pressure(x, y) - value) <= U)


def test_an_error_of_the_matrix_moves_the_contact(monkeypatch):
    """A matrix 1e-3 too large is a modulus as much too small: p0 ~ E*^(2/3), approach ~ E*^(-2/3)."""
    right, exact = solved(estimate_uncertainty=True), Meridian.compliance.fget
    monkeypatch.setattr(Meridian, "compliance", property(lambda one: 1.001 * exact(one)))
    wrong = solved()
    assert wrong.peak_pressure / right.peak_pressure == pytest.approx(1.001 ** (-2 / 3), abs=2e-5)
    assert wrong.approach / right.approach == pytest.approx(1.001 ** (2 / 3), abs=2e-5)
    for name, closed in (("peak_pressure", EXACT.peak_pressure), ("approach", EXACT.approach)):
        value, U = right.sample(None, name)
        assert abs(value - closed) <= U < abs(wrong.sample(None, name).value - closed), name


def test_an_error_of_the_conditions_alone_is_seen_in_the_gap(monkeypatch):
    """They close the gap of another solid; the approach by the gap is right, and as uncertain as that."""
    right, exact = solved(), HarmonicCompliance.matrices
    monkeypatch.setattr(HarmonicCompliance, "matrices", lambda *of: 1.001 * exact(*of))
    wrong = solved(estimate_uncertainty=True)
    assert wrong.peak_pressure / right.peak_pressure == pytest.approx(1.001 ** (-2 / 3), abs=2e-5)
    approach, U = wrong.sample(None, "approach")
    assert approach == pytest.approx(EXACT.approach, rel=2e-5)
    assert (1.001 ** (2 / 3) - 1) * approach < U


@pytest.mark.slow
def test_an_error_of_the_patches_is_none_of_the_elements(monkeypatch):
    """A modulus of the patches 1.5e-3 too large is a consistent error of 1e-3 p0: both methods disagree."""
    right = semianalytic.solve

    def wrong(substrate, **given):
        return right(substrate=(1.0015 * substrate[0], substrate[1]), **given)

    monkeypatch.setattr(semianalytic, "solve", wrong)
    problem = CoatedContact(float(np.prod(RADII) ** 0.5), LOAD, (), STEEL, indenter=("ellipsoid", RADII))
    solutions = solve_semianalytic(problem), solve_elements(problem, QUICK | {"estimate_uncertainty": True})
    (p, U), (q, V) = (one.sample(None, "peak_pressure") for one in solutions)
    assert p / q - 1 == pytest.approx(1e-3, rel=0.2)
    assert abs(p - q) > U + V


@pytest.mark.slow
def test_two_elastic_bodies_meet_as_one_of_both_compliances():
    ball = (310e9, 0.25)
    exact = pressed_ellipsoid(*RADII, LOAD, *STEEL, ball)
    found = solved(ball=(*ball, ()), friction=0.2)
    assert found.peak_pressure == pytest.approx(exact.peak_pressure, rel=1e-4)
    assert found.approach == pytest.approx(exact.approach, rel=5e-5)
    turned = solved(ball=(*STEEL, ()), substrate=ball, friction=0.2)
    x, z = 0.4 * exact.axes[0], 0.5 * exact.axes[1]
    on_ball, on_flat = found.stress(x, 0.0, z, body="ball"), turned.stress(-x, 0.0, z)
    mirror = np.array([[1, -1, -1], [-1, 1, 1], [-1, 1, 1]])
    np.testing.assert_allclose(on_ball, mirror * on_flat, atol=1e-4 * exact.peak_pressure)


@pytest.mark.parametrize(
    "radii", [RADII, pytest.param(RADII[::-1], marks=pytest.mark.slow)], ids=["long axis", "short axis"]
)
def test_the_stress_at_the_end_of_an_axis_is_johnsons(radii):
    """K. L. Johnson, Contact Mechanics, 1985, section 4.2: sigma_x = -sigma_y there."""
    exact, (_, nu) = pressed_ellipsoid(*radii, LOAD, *STEEL), STEEL
    found = solved(indenter=("ellipsoid", radii), harmonics=None, surface=0.06)
    b, a = sorted(exact.axes)
    e = np.sqrt(1 - (b / a) ** 2)
    radial = (1 - 2 * nu) * exact.peak_pressure * b / (a * e * e)
    radial *= np.arctanh(e) / e - 1 if exact.axes[0] == a else 1 - b / (a * e) * np.arctan(e * a / b)
    stress = found.stress(found.extent_x, 0.0, 0.0) / exact.peak_pressure
    assert stress[0, 0] == pytest.approx(radial / exact.peak_pressure, abs=3e-4)
    assert stress[1, 1] == pytest.approx(-radial / exact.peak_pressure, abs=3e-4)


@pytest.mark.slow
def test_beside_its_own_edge_the_pressure_is_as_uncertain_as_it_is_wrong():
    found = solved(surface=0.06, estimate_uncertainty=True)
    share, exact = np.array([0.97, 0.997, 0.9997, 0.99997]), EXACT.axes[0]
    p = EXACT.pressure(share * exact, 0.0)
    at_same_share = np.abs(found.pressure(share * found.extent_x) - p)
    at_same_place = np.abs(found.pressure(share * exact) - p)
    relative = found.sample(Points(share * found.extent_x, frame=EDGE), "pressure").uncertainty
    assert np.all(at_same_share <= relative)
    assert np.all(at_same_place <= found.sample(Points(share * exact), "pressure").uncertainty)
    fixed = found.sample(Points(share * exact), "pressure").uncertainty
    assert relative[-1] < 0.5 * fixed[-1], "the edge counts twice"


@pytest.mark.slow
def test_under_a_thin_film_fields_beside_a_pointed_end_are_as_uncertain_as_wrong():
    """3 : 1 on a film of a quarter of the short half axis, where stresses erred by five times their U."""
    radii, film = (20e-3, 3.6e-3), (420e9, 0.13, 12.5e-6)
    problem = CoatedContact(float(np.prod(radii) ** 0.5), LOAD, (film,), STEEL, indenter=("ellipsoid", radii))
    patches, elements = solve_semianalytic(problem), solve_elements(problem, {"harmonics": 300, "far": 100.0})
    at_surface, below = [0.9, 0.95, 0.97, 0.99, 1.01, 1.03, 1.1], [0.9, 1.0, 1.1]
    for quantity, x, z, layer in (
        ("pressure", at_surface, 0.0, 0),
        ("stress", at_surface, 0.0, 0),
        ("stress", below, film[2], 0),
        ("stress", below, film[2], 1),
    ):
        at = Points(np.array(x) * elements.extent_x, 0.0, z, layer)
        (s, U), (t, V) = (one.sample(at, quantity) for one in (elements, patches))
        assert np.all(np.abs(s - t) <= U + V)


def test_a_contact_with_a_hole_is_refused():
    with pytest.raises(ElementsNotConverged, match="the shape or the load"):
        solved(indenter=("lobes", (3.0, 2e-6, 86e-6)))


@pytest.mark.parametrize(
    "indenter",
    [("ellipsoid", (2e-2, 5e-3)), ("asperities", (2e-4,)), ("lobes", (3.0, 3e-8, 9e-5))],
    ids=lambda one: one[0],
)
def test_height_and_symmetry(indenter):
    shape = touching_shape(indenter, 1e-2)
    height, fold = shape.height, shape.turns
    r, theta = np.meshgrid(1e-4 * np.array([0.2, 0.7, 1.3]), np.array([0.1, 0.9, 2.2]))
    x, y = r * np.cos(theta), r * np.sin(theta)
    np.testing.assert_allclose(height(x, y), height_of(indenter, 1e-2)(x, y), rtol=1e-12, atol=1e-22)
    turned = theta + 2 * np.pi / fold
    np.testing.assert_allclose(height(r * np.cos(turned), r * np.sin(turned)), height(x, y), rtol=1e-9)
    np.testing.assert_allclose(height(x, -y), height(x, y), rtol=1e-12)


def test_a_shape_that_is_unknown_is_refused():
    with pytest.raises(ValueError, match="ellipsoid"):
        touching_shape(("cube", (1.0,)), 1.0)
