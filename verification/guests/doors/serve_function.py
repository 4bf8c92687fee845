"""The door of Python functions: python -m verification.guests.doors.serve_function MODULE:FUNCTION.

Answers the questions on standard input by calls of the function. What the function prints goes to standard
error, so that it is not taken for an answer.

The function returns a mapping or an object with any of contact_radius, approach, peak_pressure,
largest_tension, tension_place, pressure(x, y), stress(x, y, z, layer), displacement(x, y, z), stress_plane(z,
layer) at nodes in x and y; for each an uncertainty if there is one: ``uncertainty`` with the names of the
numbers, pressure_uncertainty, stress_uncertainty, displacement_uncertainty. Or it answers ``sample``, as the
two methods do.
"""

import sys
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any

import numpy as np
from scipy.interpolate import RectBivariateSpline

from verification.guests.doors.own_python import (
    COMPONENTS,
    answer_of,
    at_points,
    entry,
    keywords,
    message,
    one_line,
    serve,
    shaped,
)
from verification.guests.exam_subjects import PLANE, Load, SquareLoad
from verification.guests.guest_protocol import GuestAnswer, LineOfPoints, Question
from verification.problem import point_answers
from verification.problem.array_types import Array
from verification.problem.coated_contact import CoatedContact, PrescribedLoad
from verification.problem.line_profile import Line, Profile
from verification.problem.point_answers import FIELDS, FLAT, UNSUPPORTED, NotClaimed, Points, Sampled
from verification.problem.quantity import BALL_PEAKS, PEAKS, STRESSES
from verification.running.json_records import plain
from verification.sampling.largest_tension import Search
from verification.sampling.line_sampling import sample

Numbers = dict[str, dict[str, Any]]


class GuestFields(Sampled):
    """A guest's result as a source of what it has, with the uncertainties that it states."""

    def __init__(self, result: Any) -> None:
        self.result = result

    def gives(self, *names: str) -> bool:
        """Whether it has all these numbers or functions."""
        return all(entry(self.result, name) is not None for name in names)

    def sample(self, points: Points | None, quantity: str, uncertainty: bool = True) -> point_answers.Answer:
        """Value and uncertainty of a field at points, or of a number of the contact."""
        if points is None:
            stated = entry(entry(self.result, "uncertainty"), quantity)
            return point_answers.Answer(
                _number(entry(self.result, quantity)), _number(stated) if uncertainty else None
            )
        U = self._field(f"{quantity}_uncertainty", quantity, points) if uncertainty else None
        return point_answers.Answer(self._field(quantity, quantity, points), U)

    def _field(self, name: str, quantity: str, points: Points) -> Array | None:
        """Values of the function ``name`` at points, whose shape is that of ``quantity``."""
        function = entry(self.result, name)
        if function is None:
            return None
        x, y, z = np.broadcast_arrays(
            *(np.asarray(v, dtype=float) for v in (points.x, points.y, points.z)), subok=True
        )
        of: dict[str, Any] = {} if points.body == FLAT else {"body": points.body}
        of |= {"layer": points.layer} if quantity == "stress" else {}
        found: Array | None = at_points(function, name, FIELDS[quantity], x, y, z, **of)
        return found


class AroundExact(GuestFields):
    """A guest's stress around the exact contact edge, where the largest tension is searched."""

    def __init__(self, result: Any, edge: float) -> None:
        super().__init__(result)
        self.edge = edge

    def sample(self, points: Points | None, quantity: str, uncertainty: bool = True) -> point_answers.Answer:
        """The exact contact radius in place of the guest's own."""
        return point_answers.Answer(self.edge) if points is None else super().sample(points, quantity, False)


def _number(value: Any) -> float | None:
    return None if value is None else float(np.asarray(value, dtype=float).reshape(()))


@dataclass
class Given:
    """Values and uncertainties by line and quantity, with the reasons why others are missing or failed."""

    values: Numbers = field(default_factory=dict)
    uncertainty: Numbers = field(default_factory=dict)
    missing: Numbers = field(default_factory=dict)
    failed: Numbers = field(default_factory=dict)

    def put(self, line: str, quantity: str, value: Any, U: Any) -> None:
        """One quantity; nothing where it is None."""
        if value is not None:
            self.values.setdefault(line, {})[quantity] = value
            if U is not None:
                self.uncertainty.setdefault(line, {})[quantity] = U

    @contextmanager
    def without(self, line: str, quantities: Iterable[str]) -> Iterator[None]:
        """An exception costs these quantities on this line, and no other."""
        try:
            yield
        except (NotImplementedError, NotClaimed) as error:
            self.missing.setdefault(line, {}).update(
                dict.fromkeys(quantities, one_line(error) or "not implemented")
            )
        except Exception as error:
            self.failed.setdefault(line, {}).update(dict.fromkeys(quantities, message(error)))


def values_of(result: Any, problem: Load, question: Question) -> Given:
    """Values that ``result`` gives of those wanted, by line and quantity."""
    guest, given = GuestFields(result), Given()
    # A whole solution, as the methods return it, is sampled as they are.
    source: Any = result if guest.gives("sample", "uncertainty") else guest
    whole = source is result or guest.gives("uncertainty", "pressure_uncertainty", "stress_uncertainty")
    for name in question.contact:
        with given.without("contact", [name]):
            given.put("contact", name, *source.sample(None, name))
    sought = (set(question.contact) - set(given.values.get("contact", {}))) & {*PEAKS, *BALL_PEAKS}
    if isinstance(problem, CoatedContact) and not whole and sought & set(PEAKS) and guest.gives("stress"):
        with given.without("contact", sought & set(PEAKS)):
            around: Any = AroundExact(result, question.edge or float(guest.contact_radius))
            search = Search(around, problem)
            found = search.largest(guest.stress(search.x, 0.0, 0.0, layer=0)[0, 0], None)
            for name, value in zip(PEAKS, (found.value, found.place), strict=True):
                given.put("contact", name, value, None)
    for asked in question.lines:
        with given.without(asked.line, asked.quantities):
            for p in _sampled(source, result, problem, asked) if whole else _on_line(guest, asked, given):
                if p.line == "contact" and p.quantity in sought:
                    given.put(
                        p.line, p.quantity, p.value[0], None if p.uncertainty is None else p.uncertainty[0]
                    )
                elif p.quantity in asked.quantities:
                    given.put(p.line, p.quantity, p.value, p.uncertainty)
    if not given.values and not given.failed and not given.missing:
        names = "contact_radius, approach, peak_pressure, pressure, stress"
        raise NotClaimed(f"its result, {type(result).__name__}, has none of {names}")
    return given


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
    stress_plane, nodes = (entry(result, name) for name in ("stress_plane", "nodes"))
    if stress_plane is None or nodes is None:
        return None
    nodes = np.asarray(nodes, dtype=float)
    x, y = np.array(asked.x), np.array(asked.y)
    if nodes.ndim != 1 or max(abs(x).max(), abs(y).max()) > min(-nodes[0], nodes[-1]):
        return None
    sigma = shaped("stress_plane", stress_plane(asked.z[0], asked.layer[0]), (3, 3, *2 * nodes.shape))
    return {name: RectBivariateSpline(nodes, nodes, sigma[c]).ev(x, y) for name, c in STRESSES.items()}


def _on_line(guest: GuestFields, asked: LineOfPoints, given: Given) -> Iterator[Profile]:
    """Every quantity that the guest gives at points of the flat; nothing of a ball but its planes."""
    x, plane = np.array(asked.x), None
    if asked.line == PLANE:
        with given.without(asked.line, STRESSES):
            plane = _of_plane(guest.result, asked)
    for quantity, sigma in (plane or {}).items():
        yield Profile(quantity, asked.line, x, sigma, "guest")
    for name, (_, parts) in COMPONENTS.items() if asked.body == FLAT else ():
        wanted = [quantity for quantity in parts if quantity in asked.quantities]
        found: point_answers.Answer = UNSUPPORTED
        if wanted and (name != "stress" or plane is None):
            with given.without(asked.line, wanted):
                found = _in_layers(guest, name, asked)
        value, U = found
        for quantity in wanted if value is not None else ():
            c = parts[quantity]
            yield Profile(quantity, asked.line, x, value[c], "guest", None if U is None else U[c])


def _in_layers(guest: GuestFields, name: str, asked: LineOfPoints) -> point_answers.Answer:
    """A field at the points of a line; of a stress, which an interface parts, each layer by itself."""
    x, y, z, layers = (np.array(v) for v in (asked.x, asked.y, asked.z, asked.layer))
    if name != "stress":
        return guest.sample(Points(x, y, z), name)
    value, U = np.empty((2, *FIELDS[name], x.size))
    stated = True
    for layer in np.unique(layers).tolist():
        here = layers == layer
        part = guest.sample(Points(x[here], y[here], z[here], layer), name)
        if part.value is None:
            return UNSUPPORTED
        value[..., here] = part.value
        stated = stated and part.uncertainty is not None
        if stated:
            U[..., here] = part.uncertainty
    return point_answers.Answer(value, U if stated else None)


def problem_of(question: Question) -> Load:
    """The problem of ``question`` in the units of the guest."""
    words = keywords(question.model_dump() | {"parameter": {}})
    kind: Any = CoatedContact
    if "load" not in words:
        kind = SquareLoad if "side" in words else PrescribedLoad
    found: Load = kind(**words)
    return found


def answer(place: str, line: str) -> str:
    """The answer of the function at ``place`` to a line with a question."""
    question = Question.model_validate_json(line)

    def values(result: Any) -> dict[str, Any]:
        found: dict[str, Any] = plain(vars(values_of(result, problem_of(question), question)))
        return found

    found = answer_of(place, question.model_dump(), values, (NotImplementedError, NotClaimed))
    return GuestAnswer(**found).model_dump_json()


if __name__ == "__main__":
    serve(partial(answer, sys.argv[1]))
