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
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from importlib import import_module
from typing import Any

import numpy as np
from scipy.interpolate import RectBivariateSpline

from verification.guests.exam_subjects import PLANE, Load, SquareLoad
from verification.guests.guest_protocol import (
    TOKEN,
    VERSION,
    DiscProblem,
    EllipsoidProblem,
    GuestAnswer,
    Layer,
    LineOfPoints,
    Question,
    SquareProblem,
)
from verification.problem import point_answers
from verification.problem.array_types import Array, Coatings
from verification.problem.coated_contact import CoatedContact, PrescribedLoad, keywords
from verification.problem.line_profile import Line, Profile
from verification.problem.point_answers import FIELDS, FLAT, NotClaimed, Points, Sampled
from verification.problem.quantity import BALL_PEAKS, DISPLACEMENTS, PEAKS, STRESSES
from verification.running.json_records import plain
from verification.sampling.largest_tension import Search
from verification.sampling.line_sampling import sample

Numbers = dict[str, dict[str, Any]]


class AtPoint(ValueError):
    """An exception of a guest's function, whose message says at which point; its cause is the guest's own."""


def _given(result: Any, name: str) -> Any:
    """Entry of a mapping or attribute of an object of this ``name``; None where it has none."""
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

        def called(x: Array, y: Array, z: Array) -> Array | None:
            found = function(x, y) if quantity == "pressure" else function(x, y, z, **of)
            return None if found is None else _shaped(name, found, (*FIELDS[quantity], *x.shape))

        try:
            return called(x, y, z)
        except NotImplementedError:
            raise
        except Exception as error:
            raise AtPoint(f"{error}{_first_point(called, x, y, z)}") from error


def _first_point(called: Callable[..., Any], *points: Array) -> str:
    """The first of several points, at which a function fails by itself; "" where it fails at none."""
    for x, y, z in zip(*points, strict=True) if points[0].ndim == 1 and points[0].size > 1 else ():
        try:
            called(*(np.array([v]) for v in (x, y, z)))
        except Exception:
            return f", first at x, y, z = {x:.4g}, {y:.4g}, {z:.4g}"
    return ""


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
                dict.fromkeys(quantities, _message(error) or "not implemented")
            )
        except Exception as error:
            self.failed.setdefault(line, {}).update(dict.fromkeys(quantities, _with_place(error)))


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
    stress_plane, nodes = (_given(result, name) for name in ("stress_plane", "nodes"))
    if stress_plane is None or nodes is None:
        return None
    nodes = np.asarray(nodes, dtype=float)
    x, y = np.array(asked.x), np.array(asked.y)
    if nodes.ndim != 1 or max(abs(x).max(), abs(y).max()) > min(-nodes[0], nodes[-1]):
        return None
    sigma = _shaped("stress_plane", stress_plane(asked.z[0], asked.layer[0]), (3, 3, *2 * nodes.shape))
    return {name: RectBivariateSpline(nodes, nodes, sigma[c]).ev(x, y) for name, c in STRESSES.items()}


def _on_line(guest: GuestFields, asked: LineOfPoints, given: Given) -> Iterator[Profile]:
    """Every quantity that the guest gives at points of the flat; nothing of a ball but its planes."""
    x, y, z = (np.array(v) for v in (asked.x, asked.y, asked.z))
    plane = None
    if asked.line == PLANE:
        with given.without(asked.line, STRESSES):
            plane = _of_plane(guest.result, asked)
    found: dict[str, tuple[Array, Array | None]] = {name: (s, None) for name, s in (plane or {}).items()}

    def fill(name: str, names: Mapping[str, Any], layers: Iterable[int | None]) -> None:
        if not set(names) & set(asked.quantities):
            return
        with given.without(asked.line, set(names) & set(asked.quantities)):
            parts: dict[str, tuple[Array, Array | None]] = {}
            for layer in layers:
                here = np.array(asked.layer) == layer if layer is not None else np.ones(x.shape, dtype=bool)
                value, U = guest.sample(Points(x[here], y[here], z[here], layer), name)
                for quantity, c in names.items() if value is not None else ():
                    into = parts.setdefault(
                        quantity, (np.empty(x.size), None if U is None else np.empty(x.size))
                    )
                    into[0][here] = value[c]
                    if U is not None and into[1] is not None:
                        into[1][here] = U[c]
            found.update(parts)

    if asked.body == FLAT:
        fill("pressure", {"pressure": slice(None)}, [None])
        if plane is None:
            fill("stress", STRESSES, sorted(set(asked.layer)))
        fill("displacement", {name: i for i, name in enumerate(DISPLACEMENTS)}, [None])
    for quantity, (value, U) in found.items():
        yield Profile(quantity, asked.line, x, value, "guest", U)


def _shaped(name: str, value: Any, shape: tuple[int, ...]) -> Array:
    found = np.asarray(value, dtype=float)
    if found.shape != shape:
        raise ValueError(f"{name} returns an array of shape {found.shape}; {shape} is needed")
    return found


def main(place: str) -> None:
    """GuestAnswer every line of standard input."""
    replies = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)
    sys.path.insert(0, os.getcwd())
    for line in sys.stdin:
        question = Question.model_validate_json(line)
        replies.write(f"{TOKEN} {answer(place, question).model_dump_json()}\n")
        replies.flush()


def answer(place: str, question: Question) -> GuestAnswer:
    """The answer of the function at ``place``; an exception becomes an answer too."""
    given: dict[str, Any] = {"protocol": VERSION, "id": question.id}
    try:
        module, _, name = place.partition(":")
        function: Any = import_module(module)
        for part in name.split("."):
            function = getattr(function, part)
        problem = problem_of(question)
        found = values_of(called(function, problem, question.parameter), problem, question)
        return GuestAnswer(**given, **plain(vars(found)))
    except (NotImplementedError, NotClaimed) as error:
        return GuestAnswer(**given, unsupported=_message(error) or "not implemented")
    except Exception as error:
        return GuestAnswer(**given, error=_with_place(error))


def _with_place(error: Exception) -> str:
    """The message of ``error`` with the last line of the guest's own code, where there is one."""
    cause = error.__cause__ if isinstance(error, AtPoint) and error.__cause__ else error
    frames = traceback.extract_tb(cause.__traceback__)
    own = [frame for frame in frames if frame.filename.startswith(os.getcwd())] or frames[-1:]
    where = f" ({os.path.basename(own[-1].filename)}, line {own[-1].lineno})" if own else ""
    return f"{type(cause).__name__}: {_message(error)}{where}"


def problem_of(question: Question) -> Load:
    """The problem of ``question`` in the units of the guest."""
    p = question.problem
    substrate = (p.substrate.E, p.substrate.nu)
    if isinstance(p, DiscProblem):
        return PrescribedLoad(p.pressure, p.load_radius, _layers(p.coatings), substrate)
    if isinstance(p, SquareProblem):
        return SquareLoad(p.pressure, p.side, _layers(p.coatings), substrate)
    if isinstance(p, EllipsoidProblem):
        radii = (p.radius_x, p.radius_y)
        mean = (p.radius_x * p.radius_y) ** 0.5
        return CoatedContact(
            mean, p.load, _layers(p.coatings), substrate, p.friction, None, ("ellipsoid", radii)
        )
    ball = None if p.ball is None else (p.ball.E, p.ball.nu, _layers(p.ball.coatings))
    return CoatedContact(p.radius, p.load, _layers(p.coatings), substrate, p.friction, ball)


def _layers(coatings: list[Layer]) -> Coatings:
    return tuple((c.E, c.nu, c.thickness or 0.0) for c in coatings)


# What a problem may lack: given to every solver that takes it, left out where one does not.
NOTHING: dict[str, Any] = {"friction": 0.0, "coatings": (), "ball": None}


def called(function: Callable[..., Any], problem: Load, parameter: dict[str, float]) -> Any:
    """``function`` called with the problem by keywords; one that it lacks must be nothing."""
    given = {name: nothing for name, nothing in NOTHING.items() if hasattr(problem, name)} | keywords(problem)
    accepted = inspect.signature(function).parameters
    if not any(p.kind is inspect.Parameter.VAR_KEYWORD for p in accepted.values()):
        for name, nothing in NOTHING.items():
            if name in given and name not in accepted and given[name] == nothing:
                del given[name]
    return function(**given, **parameter)


def _message(error: BaseException) -> str:
    return " ".join(str(error).split())[:500]


if __name__ == "__main__":
    main(sys.argv[1])
