"""Where a solution is sampled: depths on the axis, the place of the largest shear stress."""

import numpy as np
import pytest

import semianalytic
from verification.problem.coated_contact import CoatedContact, keywords
from verification.problem.evaluation_points import TablePoints
from verification.problem.line_profile import lines_of
from verification.problem.point_answers import Points
from verification.sampling.line_sampling import edge_of, positions, sample
from verification.sampling.point_values import values
from verification.sources.references.hertz import Hertz

STEEL = (210e9, 0.3)
HERTZ = Hertz(10e-3, 20.0, *STEEL)
A, P0 = HERTZ.contact_radius, HERTZ.peak_pressure


@pytest.mark.parametrize("thickness", [0.1, 3.0])
def test_the_axis_is_sampled_in_every_layer_and_down_to_four_radii_or_twice_the_coating(thickness):
    problem = CoatedContact(10e-3, 20.0, ((420e9, 0.3, thickness * A),), STEEL)
    axis = next(line for line in lines_of(problem) if line.name == "axis")
    z = positions(problem, [axis], {"hertz": HERTZ})[axis] / A
    bottom = max(4.0, 2 * thickness)
    assert 0 < z[0] < 0.01
    assert bottom * (1 - 1 / 12) - 1e-9 <= z[-1] < bottom
    assert np.count_nonzero(z < thickness) >= 6
    assert np.abs(z - thickness).min() > 1e-3
    assert np.diff(z).max() < 0.6 * max(1.0, thickness / 2)


@pytest.mark.parametrize(("quantity", "share"), [("tau_max", 0.310), ("von_mises_max", 0.620)])
def test_the_largest_shear_stress_under_hertz_is_that_of_johnson(quantity, share):
    """0.31 p0 at z = 0.48 a for nu = 0.3, Johnson (1985) section 4.2(a)."""
    problem = CoatedContact(10e-3, 20.0, (), STEEL)
    value, uncertainty = values(HERTZ, quantity, TablePoints.origin(2), problem)
    assert value.shape == (2,)
    assert value / P0 == pytest.approx(share, abs=5e-4)
    assert uncertainty is None or uncertainty.max() < 1e-9 * P0


def test_pressure_at_its_own_edge_is_known_better_than_the_edge():
    problem = CoatedContact(10e-3, 20.0, ((840e9, 0.25, 0.3 * A),), STEEL)
    found = semianalytic.solve(**keywords(problem), patches=65)
    surface = next(line for line in lines_of(problem) if line.name == "surface")
    solutions = {"semianalytic": found}
    x, edge = positions(problem, [surface], solutions)[surface], edge_of(solutions)
    profiles = sample(found, "semianalytic", surface, x, problem, edge)
    stated = next(one.uncertainty for one in profiles if one.quantity == "pressure")
    at = np.abs(x) == edge
    assert at.sum() == 1
    assert (stated[at] < 0.5 * found.sample(Points(x[at]), "pressure").uncertainty).all()
