"""The door of Python functions: python -m verification.guests.doors.serve_function MODULE:FUNCTION.

Answers the questions on standard input by calls of the function. What the function prints goes to standard
error, so that it is not taken for an answer.

The function returns a mapping or an object with any of contact_radius, approach, peak_pressure,
largest_tension, tension_place, pressure(x, y), stress(x, y, z, layer), displacement(x, y, z), stress_plane(z,
layer) at nodes in x and y; for each an uncertainty if there is one: ``uncertainty`` with the names of the
numbers, pressure_uncertainty, stress_uncertainty, displacement_uncertainty. Or it answers ``sample``, as the
two methods do.
"""

import inspect
import os
import sys
import traceback
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from importlib import import_module
from typing import Any

import numpy as np
from scipy.interpolate import RectBivariateSpline

from verification.guests.exam_subjects import PLANE, Load, SquareLoad
from verification.guests.guest_protocol import (
    TOKEN,
    VERSION,
    Answer,
    Disc,
    Ellipsoid,
    Layer,
    LineOfPoints,
    Question,
    Square,
)
from verification.problem import point_answers
from verification.problem.array_types import Array, Coatings
from verification.problem.coated_contact import CoatedContact, PrescribedLoad, keywords
from verification.problem.line_profile import Line, Profile
from verification.problem.point_answers import FIELDS, FLAT, NotClaimed, Points, Sampled
from verification.problem.quantity import DISPLACEMENTS, PEAKS, STRESSES
from verification.running.json_records import plain
from verification.sampling.largest_tension import Search
from verification.sampling.line_sampling import sample

Numbers = dict[str, dict[str, Any]]


class NotGiven(ValueError):
    """A result that holds nothing that was asked for."""


def _given(result: Any, name: str) -> Any:
    """What a mapping or an object has of this ``name``; None where it has nothing."""
    return result.get(name) if isinstance(result, Mapping) else getattr(result, name, None)


class GuestFields(Sampled):
    """A guest's result as a source of what it has, with the uncertainties that it states."""

    def __init__(self, result: Any) -> None:
        self.result = result

    def gives(self, *names: str) -> bool:
        """Whether it has all these numbers or functions."""
        return all(_given(self.result, name) is not None for name in names)

    def sample(self, points: Points | None, quantity: str, uncertainty: bool = True) -> point_answers.Answer:
        """Value and uncertainty of a field at points, or of a number of the contact."""
        if points is None:
            stated = _given(_given(self.result, "uncertainty"), quantity)
            return point_answers.Answer(
                _number(_given(self.result, quantity)), _number(stated) if uncertainty else None
            )
        U = self._field(f"{quantity}_uncertainty", quantity, points) if uncertainty else None
        return point_answers.Answer(self._field(quantity, quantity, points), U)

    def _field(self, name: str, quantity: str, points: Points) -> Array | None:
        """Values of the function ``name`` at points, whose shape is that of ``quantity``."""
        function = _given(self.result, name)
        if function is None:
            return None
        x, y, z = np.broadcast_arrays(
            *(np.asarray(v, dtype=float) for v in (points.x, points.y, points.z)), subok=True
        )
        of: dict[str, Any] = {} if points.body == FLAT else {"body": points.body}
        if quantity == "stress" and "layer" in inspect.signature(function).parameters:
            of["layer"] = points.layer
        found = function(x, y) if quantity == "pressure" else function(x, y, z, **of)
        return _shaped(name, found, (*FIELDS[quantity], *x.shape))


def _number(value: Any) -> float | None:
    return None if value is None else float(np.asarray(value, dtype=float).reshape(()))


def values_of(result: Any, problem: Load, question: Question) -> tuple[Numbers, Numbers]:
    """Values and uncertainties that ``result`` gives of those wanted, by line and quantity.

    Raises NotGiven where it gives none, ValueError for one of a wrong shape.
    """
    guest = GuestFields(result)
    # A whole solution, as the methods return it, is sampled as they are.
    source: Any = result if guest.gives("sample", "uncertainty") else guest
    whole = source is result or guest.gives("uncertainty", "pressure_uncertainty", "stress_uncertainty")
    values: Numbers = {"contact": {}}
    uncertainty: Numbers = {"contact": {}}
    for name in question.contact:
        value, own = source.sample(None, name)
        if value is not None:
            values["contact"][name] = value
        if own is not None:
            uncertainty["contact"][name] = own
    missing = set(question.contact) - set(values["contact"])
    if (
        isinstance(problem, CoatedContact)
        and not whole
        and missing & set(PEAKS)
        and guest.gives("stress", "contact_radius")
    ):
        search = Search(source, problem)
        found = search.largest(guest.stress(search.x, 0.0, 0.0, layer=0)[0, 0], None)
        values["contact"] |= dict(zip(PEAKS, (found.value, found.place), strict=True))
    for asked in question.lines:
        for p in _sampled(source, result, problem, asked) if whole else _on_line(guest, asked):
            one = p.line == "contact"
            if p.quantity in (missing if one else asked.quantities):
                values.setdefault(p.line, {})[p.quantity] = p.value[0] if one else p.value
                if p.uncertainty is not None:
                    wide = p.uncertainty[0] if one else p.uncertainty
                    uncertainty.setdefault(p.line, {})[p.quantity] = wide
    values = {line: numbers for line, numbers in values.items() if numbers}
    if not values:
        names = "contact_radius, approach, peak_pressure, pressure, stress"
        raise NotGiven(f"its result, {type(result).__name__}, has none of {names}")
    return values, {line: numbers for line, numbers in uncertainty.items() if numbers}


def _sampled(solution: Any, result: Any, problem: Load, asked: LineOfPoints) -> tuple[Profile, ...]:
    """Every quantity of a whole solution on a line, with the uncertainties, as the methods are sampled."""
    points = np.array([asked.x, asked.y, asked.z])
    (_, y, z), ends = points, points[:, [0, -1]]
    direction = np.diff(ends)[:, 0] / np.linalg.norm(np.diff(ends))
    moving = np.flatnonzero(direction)
    # Along an axis the coordinate itself, to the last bit.
    position = points[moving[0]] if moving.size == 1 else direction @ points
    origin = ends[:, 0] - (direction @ ends[:, 0]) * direction
    level = z[0] == z[-1]
    line = Line(
        asked.line,
        float(z[0]) if level and not y.any() else None,
        asked.layer[0] if level else None,
        tuple(origin.tolist()),
        tuple(direction.tolist()),
        asked.body,
    )
    contact = problem if line.depth == 0 and isinstance(problem, CoatedContact) else None
    found = sample(solution, "guest", line, position, contact)
    if asked.line != PLANE or (plane := _of_plane(result, asked)) is None:
        return found
    return tuple(replace(p, value=plane[p.quantity]) if p.quantity in plane else p for p in found)


def _of_plane(result: Any, asked: LineOfPoints) -> dict[str, Array] | None:
    """The stresses of a whole plane at points, by a cubic spline; None where the plane is not given there."""
    stress_plane, nodes = (_given(result, name) for name in ("stress_plane", "nodes"))
    if stress_plane is None or nodes is None:
        return None
    nodes = np.asarray(nodes, dtype=float)
    x, y = np.array(asked.x), np.array(asked.y)
    if nodes.ndim != 1 or max(abs(x).max(), abs(y).max()) > min(-nodes[0], nodes[-1]):
        return None
    sigma = _shaped("stress_plane", stress_plane(asked.z[0], asked.layer[0]), (3, 3, *2 * nodes.shape))
    return {name: RectBivariateSpline(nodes, nodes, sigma[c]).ev(x, y) for name, c in STRESSES.items()}


def _on_line(guest: GuestFields, asked: LineOfPoints) -> Iterator[Profile]:
    """Every quantity that the guest gives at points of the flat; nothing of a ball but its planes."""
    x, y, z = (np.array(v) for v in (asked.x, asked.y, asked.z))
    plane = _of_plane(guest.result, asked) if asked.line == PLANE else None
    found: dict[str, tuple[Array, Array | None]] = {name: (s, None) for name, s in (plane or {}).items()}

    def sampled(field: str, names: Mapping[str, Any], layer: int | None, here: Any = slice(None)) -> None:
        value, U = guest.sample(Points(x[here], y[here], z[here], layer), field)
        for name, c in names.items() if value is not None else ():
            into = found.setdefault(name, (np.empty(x.size), None if U is None else np.empty(x.size)))
            into[0][here] = value[c]
            if U is not None and into[1] is not None:
                into[1][here] = U[c]

    if asked.body == FLAT:
        if "pressure" in asked.quantities:
            sampled("pressure", {"pressure": slice(None)}, None)
        if plane is None and set(STRESSES) & set(asked.quantities):
            for layer in sorted(set(asked.layer)):
                sampled("stress", STRESSES, layer, np.array(asked.layer) == layer)
        if set(DISPLACEMENTS) & set(asked.quantities):
            sampled("displacement", {name: i for i, name in enumerate(DISPLACEMENTS)}, None)
    for quantity, (value, U) in found.items():
        yield Profile(quantity, asked.line, x, value, "guest", U)


def _shaped(name: str, value: Any, shape: tuple[int, ...]) -> Array:
    found = np.asarray(value, dtype=float)
    if found.shape != shape:
        raise ValueError(f"{name} returns an array of shape {found.shape}; {shape} is needed")
    return found


def main(place: str) -> None:
    """Answer every line of standard input."""
    replies = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)
    sys.path.insert(0, os.getcwd())
    for line in sys.stdin:
        question = Question.model_validate_json(line)
        replies.write(f"{TOKEN} {answer(place, question).model_dump_json()}\n")
        replies.flush()


def answer(place: str, question: Question) -> Answer:
    """The answer of the function at ``place``; an exception becomes an answer too."""
    given: dict[str, Any] = {"protocol": VERSION, "id": question.id}
    try:
        module, _, name = place.partition(":")
        function: Any = import_module(module)
        for part in name.split("."):
            function = getattr(function, part)
        problem = problem_of(question)
        values, uncertainty = values_of(called(function, problem, question.parameter), problem, question)
        return Answer(**given, values=plain(values), uncertainty=plain(uncertainty))
    except (NotImplementedError, NotClaimed, NotGiven) as error:
        return Answer(**given, unsupported=_message(error) or "not implemented")
    except Exception as error:
        frames = traceback.extract_tb(error.__traceback__)
        # The last line of the guest's own, where there is one.
        own = [frame for frame in frames if frame.filename.startswith(os.getcwd())] or frames[-1:]
        where = f" ({os.path.basename(own[-1].filename)}, line {own[-1].lineno})" if own else ""
        return Answer(**given, error=f"{type(error).__name__}: {_message(error)}{where}")


def problem_of(question: Question) -> Load:
    """The problem of ``question`` in the units of the guest."""
    p = question.problem
    substrate = (p.substrate.E, p.substrate.nu)
    if isinstance(p, Disc):
        return PrescribedLoad(p.pressure, p.load_radius, _layers(p.coatings), substrate)
    if isinstance(p, Square):
        return SquareLoad(p.pressure, p.side, _layers(p.coatings), substrate)
    if isinstance(p, Ellipsoid):
        radii = (p.radius_x, p.radius_y)
        mean = (p.radius_x * p.radius_y) ** 0.5
        return CoatedContact(
            mean, p.load, _layers(p.coatings), substrate, p.friction, None, ("ellipsoid", radii)
        )
    ball = None if p.ball is None else (p.ball.E, p.ball.nu, _layers(p.ball.coatings))
    return CoatedContact(p.radius, p.load, _layers(p.coatings), substrate, p.friction, ball)


def _layers(coatings: list[Layer]) -> Coatings:
    return tuple((c.E, c.nu, c.thickness or 0.0) for c in coatings)


def called(function: Callable[..., Any], problem: Load, parameter: dict[str, float]) -> Any:
    """``function`` called with the problem by keywords; one that it lacks must be nothing."""
    given = keywords(problem)
    accepted = inspect.signature(function).parameters
    if not any(p.kind is inspect.Parameter.VAR_KEYWORD for p in accepted.values()):
        for name, nothing in (("friction", 0.0), ("coatings", ()), ("ball", None)):
            if name in given and name not in accepted and given[name] == nothing:
                del given[name]
    return function(**given, **parameter)


def _message(error: BaseException) -> str:
    return " ".join(str(error).split())[:500]


if __name__ == "__main__":
    main(sys.argv[1])
