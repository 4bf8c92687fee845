"""A pressure that closes the gap: what is refused, how rich it becomes, two bodies of one kind."""

from dataclasses import dataclass, replace
from types import SimpleNamespace

import numpy as np
import pytest

from fem_reference import ElementsNotConverged, solve_shape
from fem_reference.not_round.gap_closing import Closed, as_rich_as_helps
from fem_reference.not_round.harmonic_compliance import harmonic_compliance
from fem_reference.not_round.off_axis import discretised
from fem_reference.not_round.star_contact import StarPressure
from fem_reference.scaling import LayeredSolid
from verification.sources.references.hertz_ellipse import pressed_ellipsoid

STEEL, RADII, LOAD = (210e9, 0.3), (16e-3, 6e-3), 20.0
ROUGH = {"order": 2, "harmonics": 12, "surface": 0.3, "size": 0.6, "degree": 8, "far": 100.0}


def solved(**changes):
    given = {"indenter": ("ellipsoid", RADII), "radius": 9.8e-3, "load": LOAD, "coatings": ()}
    return solve_shape(**given | ROUGH | {"substrate": STEEL, "estimate_uncertainty": False} | changes)


def test_of_two_equal_bodies_one_is_the_mirror_image_of_the_other():
    """Sliding too, which acts on them in opposite directions."""
    found = solved(ball=(*STEEL, ()), friction=0.2)
    exact = pressed_ellipsoid(*RADII, LOAD, *STEEL, STEEL)
    # on so coarse a mesh
    assert found.peak_pressure == pytest.approx(exact.peak_pressure, rel=1e-2)
    assert found.approach == pytest.approx(exact.approach, rel=1e-2)
    x, z = 0.4 * exact.axes[0], 0.5 * exact.axes[1]
    mirror = np.array([[1, -1, -1], [-1, 1, 1], [-1, 1, 1]])
    on_ball, on_flat = found.stress(x, 0.0, z, body="ball"), found.stress(-x, 0.0, z)
    np.testing.assert_allclose(on_ball, mirror * on_flat, rtol=0, atol=1e-12 * exact.peak_pressure)


@pytest.mark.parametrize("wider", [-0.04, 0.04])
def test_an_approach_is_found_in_spite_of_a_wrong_contour(wider):
    """Hertz's contact by a pressure of the same load on an ellipse of another size, at no approach."""
    exact = pressed_ellipsoid(*RADII, LOAD, *STEEL)
    L, load = 1.2 * max(exact.axes), LOAD / (STEEL[0] * (1.2 * max(exact.axes)) ** 2)
    solid = LayeredSolid.scaled((), STEEL, L, 100.0, STEEL[0])
    compliance = harmonic_compliance(solid, discretised(solid, 0.4, 0.1, 4), 24, 2)
    axes = tuple((1 + wider) * one / L for one in exact.axes)
    pressure = StarPressure.of_ellipse(0.0, axes, load, 2, 4)
    asked = (lambda x, y: L / 2 * (x**2 / RADII[0] + y**2 / RADII[1]), load, 24)
    wrong = Closed((compliance,), pressure, 0.0, 0, True, np.zeros((0, 0)), asked)
    assert L * wrong.missed == pytest.approx(exact.approach, rel=2 * wider**2)


def test_a_ball_without_a_modulus_is_refused():
    with pytest.raises(ValueError, match="E"):
        solved(ball=(-1.0, 0.3, ()))


def test_a_pressure_that_pulls_is_refused():
    pushing = StarPressure.of_ellipse(0.0, (1.0, 0.4), 1.0, 2, 12)
    pulling = replace(pushing, coefficients=-pushing.coefficients)
    found = Closed((), pulling, 1.0, 3, True, np.zeros((1, 1)), (lambda x, y: 0 * x, 1.0, 12))
    with pytest.raises(ElementsNotConverged, match="the pressure under the punch is negative"):
        found.check("punch")


@dataclass
class OfDegree:
    """A contact by a pressure of a degree.

    errors : uncertainty of its edge at degree 8, 10, ..   resting : the highest degree whose contour rests
    """

    degree: int
    errors: tuple[float, ...]
    resting: int

    @property
    def found(self):
        pressure = SimpleNamespace(degree=self.degree)
        return SimpleNamespace(pressure=pressure, converged=self.degree <= self.resting)

    companion = found

    def uncertain(self, _):
        return self.errors[(self.degree - 8) // 2]

    def by(self, more):
        return replace(self, degree=self.degree + more)


@pytest.mark.parametrize(
    ("errors", "resting", "best", "others"),
    [((4, 3, 2, 1), 14, 14, [12]), ((4, 1, 2, 3, 0.5), 16, 10, [8, 12, 14]), ((4, 3, 2, 1), 10, 10, [8])],
    ids=["richer is better", "richer is worse", "a richer one is not at rest"],
)
def test_a_pressure_is_as_rich_as_helps_and_rests(errors, resting, best, others):
    chosen, beside = as_rich_as_helps(OfDegree(8, errors, resting), 8 + 2 * (len(errors) - 1))
    assert (chosen.degree, [one.degree for one in beside]) == (best, others)
