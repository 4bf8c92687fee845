"""Stresses are uncertain by the contact's radius: at fixed places and at those that move with the edge."""

from functools import lru_cache

import numpy as np
import pytest

from verification.problem.coated_contact import CoatedContact
from verification.problem.point_answers import Points
from verification.sources.exact_sources import solve_exactly
from verification.sources.method_sources import solve_semianalytic

PROBLEMS = {  # drawn at random, where one term each was left out: up to 1.25 U
    "stiff layer, deep": CoatedContact(1e-3, 1.0, ((2.6e11, 0.2, 4e-5),), (2e10, 0.3), 0.01),
    "film of ten patches": CoatedContact(
        6.4077e-5, 2.60244e-7, ((1.12279e6, 0.5 - 2.75e-8, 8.07658e-9),), (3.15149e9, 0.476307)
    ),
}


@lru_cache
def solved(name):
    return solve_exactly(PROBLEMS[name]), solve_semianalytic(PROBLEMS[name])


def test_a_field_in_the_patches_that_the_edge_cuts_is_as_uncertain_by_the_edge_as_beside_them():
    exact, found = solved("stiff layer, deep")
    d, a = found.diagnostics.patch_size, found.contact_radius
    share = 1 - np.array([1.7, 1.4, 1.0, 0.3, 0.05]) * d / a  # the first beside them
    for field, where in (("pressure", ()), ("stress", (0, 0)), ("stress", (2, 2))):
        value, U = (v[where] for v in found.sample(Points(share * a, frame="edge"), field))
        assert (U[1:] > 0.9 * U[0]).all()
        true, V = (v[where] for v in exact.sample(Points(share * exact.contact_radius), field))
        assert (np.abs(value - true) <= 0.5 * (U + V)).all()


@pytest.mark.parametrize("frame", ["fixed", "edge"])
@pytest.mark.parametrize("name", PROBLEMS)
def test_a_stress_is_within_its_uncertainty_however_far_from_the_edge(name, frame):
    problem, (exact, found) = PROBLEMS[name], solved(name)
    a, (*_, h) = exact.contact_radius, problem.coatings[0]
    x, z = (v.ravel() for v in np.meshgrid([0.9 * a, a, 1.3 * a], [0.3 * h, h, h + 0.3 * a]))
    moved = found.contact_radius / a if frame == "edge" else 1.0
    value, U = found.sample(Points(moved * x, 0.0, z, frame=frame), "stress")
    true, V = exact.sample(Points(x, 0.0, z), "stress")
    assert (np.abs(value - true) <= 0.5 * (U + V)).all()
