"""Lines off the plane of symmetry: where they lie, what they hold."""

import numpy as np
import pytest

import semianalytic
from verification.problem.coated_contact import CoatedContact, keywords
from verification.problem.line_profile import line_of, oblique_lines
from verification.problem.quantity import DISPLACEMENTS, STRESSES
from verification.sampling import oblique_sampling
from verification.sources.references.hertz import Hertz

STEEL = (210e9, 0.3)
BARE = CoatedContact(10e-3, 20.0, (), STEEL, 0.25)
A = BARE.a_h
STACK = tuple((100e9 * k, 0.3, h * A) for k, h in ((1, 0.05), (4, 0.3), (2, 0.1), (6, 0.6), (3, 0.2)))
NODES = 1.2 * A * np.linspace(-1, 1, 129)
HAMILTON = Hertz(10e-3, 20.0, *STEEL, 0.25)


@pytest.mark.parametrize("friction", [0.0, 0.25])
@pytest.mark.parametrize("coatings", [(), STACK[:1], STACK, ((100e9, 0.3, oblique_sampling.DOWN[4] * A),)])
def test_oblique_line_visits_every_layer_and_no_interface(coatings, friction):
    problem = CoatedContact(10e-3, 20.0, coatings, STEEL, friction)
    line = line_of("oblique", problem)
    x, y, z = line.points(oblique_sampling.positions(problem, line, A, NODES))
    bounds = np.array([0.0, *problem.interfaces])
    assert set(np.searchsorted(bounds, z) - 1) == set(range(len(coatings) + 1))
    assert np.abs(z[:, None] - bounds).min() > 1e-5 * A
    assert min(np.ptp(x), np.ptp(y), np.ptp(z)) > 0.5 * A


def test_profiles_hold_the_six_stresses_and_three_displacements_of_their_points():
    for line in oblique_lines(BARE):
        position = oblique_sampling.positions(BARE, line, A, NODES)
        found = {p.quantity: p.value for p in oblique_sampling.sample(HAMILTON, "hamilton", line, position)}
        at = line.points(position)
        if line.name != "oblique surface":
            sigma = HAMILTON.stress(*at)
            assert all(np.array_equal(found[name], sigma[c]) for name, c in STRESSES.items())
        u = HAMILTON.displacement(*at)
        assert all(np.array_equal(found[name], u[i]) for i, name in enumerate(DISPLACEMENTS))


def test_off_plane_line_of_the_semi_analytical_method_comes_from_its_fields_on_planes():
    solution = semianalytic.solve(**keywords(BARE), patches=65, estimate_uncertainty=False)
    line = line_of("off plane", BARE)
    s = oblique_sampling.positions(BARE, line, A, solution.nodes)
    x, y, z = line.points(s)
    i, j = (np.abs(solution.nodes[:, None] - at).argmin(axis=0) for at in (x, y))
    found = {p.quantity: p.value for p in oblique_sampling.sample(solution, "semi", line, s)}
    sigma, u = solution.stress_plane(z[0]), solution.displacement_plane(z[0])
    assert s.size > 15
    assert all(np.array_equal(found[name], sigma[(*c, i, j)]) for name, c in STRESSES.items())
    assert all(np.array_equal(found[name], u[k, i, j]) for k, name in enumerate(DISPLACEMENTS))
