"""Every invariant that one solution has to satisfy by itself."""

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial

from verification.judging.invariant_verdict import Invariant, failed
from verification.judging.invariants import (
    bonded_deformation,
    force_balance,
    indenter_gap,
    influence_error,
    mirror_symmetry,
)
from verification.problem.coated_contact import CoatedContact, ContactSolution
from verification.problem.either_body import on_body
from verification.problem.line_profile import ON_BALL
from verification.problem.point_answers import BALL, NotClaimed, Points

Law = Callable[[], Invariant | tuple[Invariant, ...]]


def check(solution: ContactSolution, source: str, problem: CoatedContact) -> tuple[Invariant, ...]:
    """Balance, tractions, equilibrium, bonds, Hooke's law and symmetry of ``solution`` by ``source``.

    The names of those of an elastic ball begin with "ball, ". One that raises an exception is NO_RESULT with
    its message; one of a field that the source does not claim is left out.
    """
    found: list[Invariant] = []
    for name, law in _laws(solution, source, problem):
        try:
            row = law()
        except NotClaimed:
            continue
        except Exception as error:  # any failure of a solution is a row of the report
            row = failed(name, source, error)
        rows = row if isinstance(row, tuple) else (row,)
        before = ON_BALL if name.startswith(ON_BALL) else ""
        found += [replace(one, name=before + one.name.removeprefix(before)) for one in rows]
    return tuple(found)


def _laws(solution: ContactSolution, source: str, problem: CoatedContact) -> Iterator[tuple[str, Law]]:
    subject = (solution, source, problem)
    if problem.indenter is not None:
        yield from _of_shape(solution, source, problem)
        return
    yield "load balance", partial(force_balance.load_balance, *subject)
    yield "sphere", partial(bonded_deformation.sphere, *subject)
    yield from _of_body(*subject)
    if source == "semianalytic":
        yield "influence coefficients", partial(influence_error.influence_coefficients, *subject)
    if problem.ball is not None:
        of_ball = on_body(solution, BALL), source, problem.seen_from(BALL)
        yield from ((f"{ON_BALL}{name}", law) for name, law in _of_body(*of_ball))


def _of_shape(solution: ContactSolution, source: str, problem: CoatedContact) -> Iterator[tuple[str, Law]]:
    """Invariants under an indenter that is no sphere, where no angle is like another."""
    subject = (solution, source, problem)
    yield "load balance", partial(indenter_gap.load_balance, *subject)
    if solution.sample(Points(0.0), "stress", False).value is None:  # a closed form of the contact alone
        return
    yield "indenter", partial(indenter_gap.gap, *subject)
    if source == "semianalytic":
        yield "influence coefficients", partial(influence_error.influence_coefficients, *subject)
    yield from _of_shaped_body(*subject)
    if problem.ball is not None:
        of_ball = on_body(solution, BALL), source, problem.seen_from(BALL)
        yield from ((f"{ON_BALL}{name}", law) for name, law in _of_shaped_body(*of_ball))


def _of_shaped_body(
    solution: ContactSolution, source: str, problem: CoatedContact
) -> Iterator[tuple[str, Law]]:
    """Invariants of the fields of one body below an indenter that is no sphere."""
    subject = (solution, source, problem)
    for k in range(1, len(problem.coatings) + 1):
        yield f"bonded tractions, interface {k}", partial(bonded_deformation.bonded_traction, *subject, k)
    for layer in range(len(problem.coatings) + 1):
        stencil = force_balance.places_in(layer, solution, problem)
        yield f"equilibrium, layer {layer}", partial(force_balance.equilibrium, *subject, layer, stencil)
        yield f"Hooke's law, layer {layer}", partial(bonded_deformation.hooke, *subject, layer, stencil)


def _of_body(solution: ContactSolution, source: str, problem: CoatedContact) -> Iterator[tuple[str, Law]]:
    """Invariants of the fields of one body, which is the flat of ``problem``."""
    subject = (solution, source, problem)
    yield "surface tractions", partial(force_balance.surface, *subject)
    for k in range(1, len(problem.coatings) + 1):
        yield f"bonded tractions, interface {k}", partial(bonded_deformation.bonded_traction, *subject, k)
        yield (
            f"bonded displacements, interface {k}",
            partial(bonded_deformation.bonded_displacement, *subject, k),
        )
    for layer in range(len(problem.coatings) + 1):
        stencil = force_balance.places_in(layer, solution, problem)
        yield f"equilibrium, layer {layer}", partial(force_balance.equilibrium, *subject, layer, stencil)
        yield f"Hooke's law, layer {layer}", partial(bonded_deformation.hooke, *subject, layer, stencil)
    if problem.friction:
        yield "reciprocity of load and sliding", partial(bonded_deformation.reciprocity, *subject)
    yield "symmetry", partial(mirror_symmetry.symmetry, *subject)
