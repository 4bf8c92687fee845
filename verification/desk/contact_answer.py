"""The answer to one problem: contact size, largest stresses, their differences from a second method."""

import time
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from verification.desk.answer_stresses import Course, Extreme, stresses
from verification.problem.coated_contact import CoatedContact
from verification.problem.quantity import QUANTITIES
from verification.sources.source_registry import SOURCES

__all__ = ["NUMBERS", "Answer", "Difference", "answer", "differences", "usual_seconds"]

# Measured on one core of 2.5 GHz, an elastic ball with two thin films within 5 %.
BODY_SECONDS, FILM_SECONDS, THIN = 4.0, 8.0, 0.1
NUMBERS = ("peak_pressure", "contact_radius", "approach")


@dataclass(frozen=True)
class Answer:
    """What ``source`` answers: ``numbers`` as (value, uncertainty) by name, SI; extremes, courses.

    An uncertainty is None where the source states none.
    """

    source: str
    seconds: float
    numbers: dict[str, tuple[float, float | None]]
    extremes: tuple[Extreme, ...]
    courses: tuple[Course, ...]


@dataclass(frozen=True)
class Difference:
    """``value`` of a second answer less the first [SI], of ``key`` as of ``differences``.

    within : whether its magnitude is at most the sum of both uncertainties.
    """

    key: tuple[str, ...]
    value: float
    within: bool


def answer(
    problem: CoatedContact,
    source: str,
    numerics: Mapping[str, Any] | None = None,
    residual: Mapping[str, tuple[float, ...]] | None = None,
    layers: Mapping[str, tuple[int, ...]] | None = None,
) -> Answer:
    """Solve ``problem`` by ``source``, find its largest stresses; ``residual``, ``layers`` as there.

    Raises what the source raises.
    """
    begin = time.perf_counter()
    solve = SOURCES[source].solve
    if solve is None:
        raise ValueError(f"source = {source!r}; it solves nothing")
    solution = solve(problem, numerics or {})
    numbers = {
        name: (QUANTITIES[name].value(solution, problem), QUANTITIES[name].uncertainty(solution, problem))
        for name in NUMBERS
    }
    found, drawn = stresses(solution, problem, residual, layers)
    return Answer(source, time.perf_counter() - begin, numbers, found, drawn)


def differences(first: Answer, second: Answer) -> tuple[Difference, ...]:
    """Differences of two answers to one problem: keys (name,), or (body, quantity, where) of extremes."""
    pairs: dict[tuple[str, ...], list[tuple[float, float]]] = {}
    for one in (first, second):
        for name, (value, stated) in one.numbers.items():
            pairs.setdefault((name,), []).append((value, float("nan") if stated is None else stated))
        for at in one.extremes:
            pairs.setdefault((at.body, at.quantity, at.where), []).append((at.value, at.uncertainty))
    return tuple(
        Difference(key, b - a, abs(b - a) <= U_a + U_b) for key, ((a, U_a), (b, U_b)) in pairs.items()
    )


def usual_seconds(problem: CoatedContact) -> float:
    """Usual processor time [s] of the answer by finite elements, with the mesh of each body and thin film."""
    thin = [h < THIN * problem.a_h for body in problem.bodies for *_, h in problem.seen_from(body).coatings]
    return BODY_SECONDS * len(problem.bodies) + FILM_SECONDS * sum(thin)
