"""Invariants between solutions of an elastic ball, of the exact reference in place of a method."""

from dataclasses import replace

import pytest

from verification.judging.invariants import resolved
from verification.judging.invariants.resolved_invariants import BALL_NAMES
from verification.judging.verdict import Outcome
from verification.problem.coated_contact import CoatedContact, PrescribedLoad
from verification.sources.exact_sources import solve_exactly

BOTH_COATED = CoatedContact(
    1e-2, 20.0, ((4e11, 0.2, 2e-5),), (2.1e11, 0.3), ball=(3e11, 0.22, ((2e11, 0.3, 1.5e-5),))
)


def softer_ball(problem):
    E, nu, coatings = problem.ball or (0.0, 0.0, ())
    return replace(problem, ball=(0.99 * E, nu, coatings)) if E else problem


def loaded_ball(problem):
    return replace(problem, load=1.01 * problem.load) if problem.ball else problem


def thinner_on_the_flat(problem):
    return replace(problem, coatings=tuple((E, nu, 0.98 * h) for E, nu, h in problem.coatings))


@pytest.mark.parametrize(
    ("change", "broken"),
    [
        (lambda problem: problem, set()),
        (softer_ball, {"bodies exchanged", "coating on the ball", "equal bodies", "equal moduli"}),
        (loaded_ball, {"rigid ball", "equal moduli"}),
        (thinner_on_the_flat, {"bodies exchanged", "coating on the ball", "equal bodies"}),
    ],
)
def test_a_contact_of_two_bodies_breaks_the_invariants_that_its_fault_concerns(change, broken):
    def solve(problem, numerics=None):
        return solve_exactly(problem if isinstance(problem, PrescribedLoad) else change(problem))

    found = {row.name: row for row in resolved(BOTH_COATED, {"semianalytic": solve})}
    assert set(found) == {"scaling", "reciprocity", "equal moduli", *BALL_NAMES}
    # the other two do not tell one body from the other
    judged = {name: row.outcome for name, row in found.items() if name not in ("scaling", "reciprocity")}
    assert {name for name, outcome in judged.items() if outcome is Outcome.DISAGREES} == broken
    assert set(judged.values()) <= {Outcome.AGREES, Outcome.DISAGREES}
    for name in set(judged) - broken:
        assert found[name].bound < 1e-5
