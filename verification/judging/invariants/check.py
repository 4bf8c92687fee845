"""Every invariant that one solution can be held against by itself."""

from collections.abc import Callable, Iterator
from functools import partial

from verification.judging.invariant import Invariant, absent
from verification.judging.invariants import bond, coefficients, statics, symmetry
from verification.problem.contact import CoatedContact, NotClaimed, Solution

__all__ = ["check"]

Law = Callable[[], Invariant | tuple[Invariant, ...]]


def check(solution: Solution, source: str, problem: CoatedContact) -> tuple[Invariant, ...]:
    """Balance, tractions, equilibrium, bonds, Hooke's law and symmetry of ``solution`` by ``source``.

    One that cannot be evaluated is NO_RESULT with its sentence; one about a field that the source makes no
    claim of is left out; the others go on.
    """
    found: list[Invariant] = []
    for name, law in _laws(solution, source, problem):
        try:
            row = law()
        except NotClaimed:
            continue
        except Exception as error:  # whatever a solution fails with is a row of the report
            row = absent(name, source, f"{type(error).__name__}: {' '.join(str(error).split())[:300]}")
        found += row if isinstance(row, tuple) else (row,)
    return tuple(found)


def _laws(solution: Solution, source: str, problem: CoatedContact) -> Iterator[tuple[str, Law]]:
    subject = (solution, source, problem)
    yield "load balance", partial(statics.load_balance, *subject)
    yield "surface tractions", partial(statics.surface, *subject)
    yield "sphere", partial(bond.sphere, *subject)
    for k in range(1, len(problem.coatings) + 1):
        yield f"bonded tractions, interface {k}", partial(bond.bonded_traction, *subject, k)
        yield f"bonded displacements, interface {k}", partial(bond.bonded_displacement, *subject, k)
    for layer in range(len(problem.coatings) + 1):
        stencil = statics.places_in(layer, solution, problem)
        yield f"equilibrium, layer {layer}", partial(statics.equilibrium, *subject, layer, stencil)
        yield f"Hooke's law, layer {layer}", partial(bond.hooke, *subject, layer, stencil)
    if problem.friction:
        yield "reciprocity of load and sliding", partial(bond.reciprocity, *subject)
    yield "symmetry", partial(symmetry.symmetry, *subject)
    if source == "semianalytic":
        yield "influence coefficients", partial(coefficients.influence_coefficients, *subject)
