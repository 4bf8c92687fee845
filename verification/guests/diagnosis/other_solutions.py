"""Exact values of another problem, or at other places, where a case asks for values of its own."""

from collections.abc import Mapping, Set
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

import numpy as np

from verification.guests.diagnosis.wrong_outputs import Key
from verification.guests.exam_subjects import SPHERE, SquareLoad, Subject
from verification.problem.array_types import Array
from verification.problem.coated_contact import CoatedContact, PrescribedLoad
from verification.problem.point_answers import Points
from verification.problem.quantity import DISPLACEMENTS, PEAKS, STRESSES
from verification.sampling.largest_tension import Search
from verification.sampling.line_sampling import sample_contact
from verification.sources.exact_sources import hertz, solve_exactly

ODD = ("sigma_xz", "sigma_xy", "u_x")  # of the opposite sign in a mirror image in x
FAST = {"estimate_uncertainty": False}


@dataclass(frozen=True)
class WrongPlaces:
    """The right field at other points: x mirrored, all coordinates stretched, x less ``shift`` [m]."""

    name: str
    message: str
    mirror: float = 1.0
    stretch: float = 1.0
    shift: float = 0.0


RIGHT = WrongPlaces("", "")


def other_values(
    case: Subject,
    problem: CoatedContact,
    positions: Mapping[str, Array],
    wanted: Set[Key],
    places: WrongPlaces = RIGHT,
) -> dict[Key, Array]:
    """The values ``wanted`` of ``problem`` in place of that of ``case``, at ``positions`` along its lines.

    Raises ValueError or ArithmeticError where the reference cannot solve the problem.
    """
    load = _load_on(case, problem)
    if isinstance(load, SquareLoad):
        found = replace(case, problem=problem)._under_square(load)
        return {(p.quantity, p.line): p.value for p in found if (p.quantity, p.line) in wanted}
    if problem.indenter is not None:
        found = sample_contact(hertz(problem), "")
        return {(p.quantity, p.line): p.value for p in found}
    return sampled(case, problem, _solved(load), positions, wanted, places)


@lru_cache(maxsize=32)  # about as many slips as are tried, each first by its numbers, then by its fields
def _solved(load: CoatedContact | PrescribedLoad) -> Any:
    return solve_exactly(load, FAST if isinstance(load, CoatedContact) else None)


def sampled(
    case: Subject,
    problem: CoatedContact,
    solution: Any,
    positions: Mapping[str, Array],
    wanted: Set[Key],
    places: WrongPlaces = RIGHT,
) -> dict[Key, Array]:
    """The values ``wanted`` of a ``solution`` of ``problem`` at ``positions`` along the lines of ``case``."""
    values = {(p.quantity, p.line): p.value for p in sample_contact(solution, "")}
    if wanted & {(q, "contact") for q in PEAKS} and case.load == SPHERE:
        search = Search(solution, problem)
        largest = search.largest(solution.stress(search.x, 0.0, 0.0, layer=0)[0, 0], None)
        place = places.mirror * largest.place / places.stretch + places.shift
        values |= {(PEAKS[0], "contact"): np.array([largest.value]), (PEAKS[1], "contact"): np.array([place])}
    for name in {line for _, line in wanted if line != "contact"} & positions.keys():
        asked = {q for q, line in wanted if line == name}
        found = _on_line(case, problem, solution, name, positions[name], places, asked)
        values |= {(q, name): v for q, v in found.items()}
    return values


def _on_line(
    case: Subject,
    problem: CoatedContact,
    solution: Any,
    name: str,
    at: Array,
    places: WrongPlaces,
    asked: Set[str],
) -> dict[str, Array]:
    """The fields ``asked`` on a line; of a layer that the other problem has elsewhere that at this depth."""
    line = case.line(name)
    x, y, z = line.points(at)
    x = places.mirror * (places.stretch * x - places.shift)
    y, z = places.stretch * y, places.stretch * z
    same = problem.seen_from(line.body).interfaces == case.problem.seen_from(line.body).interfaces
    points = Points(x, y, z, line.layer if same and places.stretch == 1 else None, line.body)
    found: dict[str, Array] = {}
    if asked & STRESSES.keys():
        sigma = solution.sample(points, "stress", False).value
        found |= {q: sigma[c] for q, c in STRESSES.items()} if sigma is not None else {}
    if asked & set(DISPLACEMENTS) and line.depth is None and line.coordinate != "z":
        u = solution.sample(replace(points, layer=None), "displacement", False).value
        found |= dict(zip(DISPLACEMENTS, u, strict=True)) if u is not None else {}
    if name == "surface" and "pressure" in asked:
        found["pressure"] = solution.sample(points, "pressure", False).value
    return {q: places.mirror * v if q in ODD else v for q, v in found.items()}


def _load_on(case: Subject, problem: CoatedContact) -> CoatedContact | PrescribedLoad | SquareLoad:
    """The load of ``case`` on the solid of ``problem``, larger and wider as this one's is."""
    load = case.loaded
    if isinstance(load, CoatedContact):
        return problem
    more, wider = problem.load / case.problem.load, problem.radius / case.problem.radius
    solid: dict[str, Any] = {"coatings": problem.coatings, "substrate": problem.substrate}
    solid["pressure"] = load.pressure * more
    if isinstance(load, SquareLoad):
        return replace(load, **solid)
    return replace(load, load_radius=load.load_radius * wider, **solid)
