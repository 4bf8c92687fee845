"""Layers with nu = 1/2 or near it, and bases far stiffer than their film: every source solves them."""

from dataclasses import replace

import numpy as np
import pytest

import fem_reference
from verification.problem.coated_contact import CoatedContact
from verification.problem.point_answers import Points
from verification.problem.quantity import QUANTITIES
from verification.sources.exact_sources import solve_exactly
from verification.sources.method_sources import solve_elements, solve_semianalytic

SCALARS = ("contact_radius", "approach", "peak_pressure")


def film(nu, base=22e9):
    """A confined film: the contact is ten times as wide as it is thick."""
    return CoatedContact(0.1, 1.4, ((2.2e6, nu, 1e-4),), (base, 0.3))


@pytest.mark.parametrize("nu", [0.5, pytest.param(0.5 - 1e-7, marks=pytest.mark.slow)])
def test_a_confined_incompressible_film_is_the_same_in_every_source(nu):
    problem = film(nu)
    exact = solve_exactly(problem)
    a, z = exact.contact_radius, np.array([1e-5, 5e-5, 9e-5])
    edge = a * np.array([0.9, 0.99, 0.999, 1.0, 1.001, 1.01])
    for found in (solve_semianalytic(problem), solve_elements(problem, {"quality": "fast"})):
        for name in SCALARS:
            U = getattr(found.uncertainty, name)
            assert abs(getattr(found, name) - getattr(exact, name)) <= U <= 1e-4 * getattr(exact, name), name
        value, U = found.sample(Points(0.5 * a, 0.0, z), "stress")
        assert (np.abs(value - exact.stress(0.5 * a, 0.0, z)) <= U).all()
        error = np.abs(found.pressure(edge) - exact.pressure(edge))
        assert (error <= found.sample(Points(edge), "pressure").uncertainty).all()
        assert error.max() <= 0.01 * exact.peak_pressure
    # what it costs to take 0.49 for it
    assert solve_exactly(film(0.49)).approach > 1.4 * exact.approach


@pytest.mark.parametrize(
    "problem",
    [
        replace(film(0.5), friction=0.2),
        CoatedContact(6.651e-4, 3.094e-5, ((1.0342e6, 0.5 - 5.5e-8, 3.1314e-6),), (4.7218e8, 0.2)),
    ],
    ids=["ten times as wide as thick", "four times"],
)
def test_the_surface_of_a_confined_film_is_within_its_uncertainty_at_fixed_places(problem):
    """There sigma_zz is -p, and as uncertain as that by the radius, whatever the other stresses are."""
    exact, found = solve_exactly(problem), solve_semianalytic(problem)
    places = Points(exact.contact_radius * np.array([0.0, 0.3, 0.5, 0.9, 1.0, 1.1]))
    for quantity in ("pressure", "stress", "displacement"):
        (value, U), (true, V) = (source.sample(places, quantity) for source in (found, exact))
        assert (np.abs(value - true) <= U + V).all(), quantity


def test_a_base_far_stiffer_than_its_film_is_solved_and_not_replaced():
    problem = film(0.3, 2.2e6 * 1e9)
    exact = solve_exactly(problem)
    found = fem_reference.solve(
        radius=0.1, load=1.4, coatings=problem.coatings, substrate=problem.substrate, quality="fast"
    )
    for name in SCALARS:
        cap = QUANTITIES[name].cap * getattr(exact, name)
        assert abs(getattr(found, name) - getattr(exact, name)) <= getattr(found.uncertainty, name) <= cap
