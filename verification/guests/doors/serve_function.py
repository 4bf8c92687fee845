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
import sys
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
from scipy.interpolate import RectBivariateSpline

from verification.guests.doors import own_python
from verification.guests.doors.own_python import answer_of, at_points, entry, keywords, number, serve, shaped
from verification.guests.exam_subjects import PLANE, Load, SquareLoad
from verification.guests.guest_protocol import GuestAnswer, LineOfPoints, Question
from verification.problem.array_types import Array
from verification.problem.coated_contact import CoatedContact, PrescribedLoad
from verification.problem.line_profile import Line, Profile
from verification.problem.point_answers import FIELDS, FLAT, Answer, NotClaimed, Points, Sampled
from verification.problem.quantity import BALL_PEAKS, PEAKS, STRESSES
from verification.running.json_records import plain
from verification.sampling.largest_tension import Search
from verification.sampling.line_sampling import sample

REFUSALS = (NotImplementedError, NotClaimed)


class GuestFields(Sampled):
    """A guest's result as a source of what it has, with the uncertainties that it states.

    edge : exact contact radius in place of its own numbers, around which its values are searched; or None.
    """

    def __init__(self, result: Any, edge: float | None = None) -> None:
        self.result, self.edge = result, edge

    def gives(self, *names: str) -> bool:
        """Whether it has all these numbers or functions."""
        return all(entry(self.result, name) is not None for name in names)

    def sample(self, points: Points | None, quantity: str, uncertainty: bool = True) -> Answer:
        """Value and uncertainty of a field at points, or of a number of the contact."""
        stated = uncertainty and self.edge is None
        if points is not None:
            U = self._field(f"{quantity}_uncertainty", quantity, points) if stated else None
            return Answer(self._field(quantity, quantity, points), U)
        if self.edge is not None:
            return Answer(self.edge)
        U = entry(entry(self.result, "uncertainty"), quantity) if stated else None
        return Answer(number(entry(self.result, quantity)), number(U))

    def _field(self, name: str, quantity: str, points: Points) -> Array | None:
        """Values of the function ``name`` at points, whose shape is that of ``quantity``."""
        function = entry(self.result, name)
        if function is None:
            return None
        x, y, z = np.broadcast_arrays(
            *(np.asarray(v, dtype=float) for v in (points.x, points.y, points.z)), subok=True
        )
        of: dict[str, Any] = {} if points.body == FLAT else {"body": points.body}
        if quantity == "stress" and "layer" in inspect.signature(function).parameters:
            of["layer"] = points.layer
        found: Array | None = at_points(function, name, FIELDS[quantity], x, y, z, **of)
        return found


def values_of(result: Any, problem: Load, question: Question) -> dict[str, Any]:
    """Values that ``result`` gives of those wanted, by line and quantity, as parts of an answer."""
    guest = GuestFields(result)
    # A whole solution, as the methods return it, is sampled as they are.
    source: Any = result if guest.gives("sample", "uncertainty") else guest
    if source is guest and not guest.gives("uncertainty", "pressure_uncertainty", "stress_uncertainty"):
        tension = partial(_largest_tension, problem)
        return own_python.values_of(result, question.model_dump(), REFUSALS, _of_plane, tension)
    given = own_python.Given(REFUSALS)
    for name in question.contact:
        with given.without("contact", [name]):
            given.put("contact", name, *source.sample(None, name))
    sought = given.lacks("contact", {*PEAKS, *BALL_PEAKS} & set(question.contact))
    for asked in question.lines:
        with given.without(asked.line, asked.quantities):
            for p in _sampled(source, result, problem, asked):
                if p.line == "contact" and p.quantity in sought:
                    U = None if p.uncertainty is None else p.uncertainty[0]
                    given.put(p.line, p.quantity, p.value[0], U)
                elif p.quantity in asked.quantities:
                    given.put(p.line, p.quantity, p.value, p.uncertainty)
    return given.answered(result)


def _largest_tension(problem: Load, result: Any, question: dict[str, Any]) -> dict[str, float]:
    """The largest tension of a guest's stress with its place, searched around the exact contact edge."""
    guest = GuestFields(result)
    if not isinstance(problem, CoatedContact) or not guest.gives("stress"):
        return {}
    around: Any = GuestFields(result, question["edge"] or guest.contact_radius)
    search = Search(around, problem)
    found = search.largest(guest.stress(search.x, 0.0, 0.0, layer=0)[0, 0], None)
    return dict(zip(PEAKS, (found.value, found.place), strict=True))


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
    plane = _of_plane(result, asked.model_dump()) or {}
    return tuple(replace(p, value=plane[p.quantity]) if p.quantity in plane else p for p in found)


def _of_plane(result: Any, asked: dict[str, Any]) -> dict[str, Array] | None:
    """The stresses of a whole plane at points, by a cubic spline; None where the plane is not given there."""
    stress_plane, nodes = (entry(result, name) for name in ("stress_plane", "nodes"))
    if asked["line"] != PLANE or stress_plane is None or nodes is None:
        return None
    nodes = np.asarray(nodes, dtype=float)
    x, y = np.array(asked["x"]), np.array(asked["y"])
    if nodes.ndim != 1 or max(abs(x).max(), abs(y).max()) > min(-nodes[0], nodes[-1]):
        return None
    sigma = shaped("stress_plane", stress_plane(asked["z"][0], asked["layer"][0]), (3, 3, *2 * nodes.shape))
    return {name: RectBivariateSpline(nodes, nodes, sigma[c]).ev(x, y) for name, c in STRESSES.items()}


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
        found: dict[str, Any] = plain(values_of(result, problem_of(question), question))
        return found

    found = answer_of(place, question.model_dump(), values, REFUSALS)
    return GuestAnswer(**found).model_dump_json()


if __name__ == "__main__":
    serve(partial(answer, sys.argv[1]))
