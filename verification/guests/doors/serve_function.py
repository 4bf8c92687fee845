"""The door of Python functions: python -m verification.guests.doors.serve_function MODULE:FUNCTION.

Answers the questions on standard input by calls of the function. What the function prints goes to standard
error, so that it is not taken for an answer.

The function returns a mapping or an object with any of contact_radius, approach, peak_pressure,
largest_tension, tension_place, pressure(x, y), stress(x, y, z, layer), displacement(x, y, z), stress_plane(z,
layer) at nodes in x and y; for each an uncertainty if there is one:
``uncertainty`` with the names of the numbers, pressure_uncertainty, stress_uncertainty.
"""

import inspect
import os
import sys
import traceback
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
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
from verification.problem.array_types import Array, Coatings
from verification.problem.coated_contact import FLAT, CoatedContact, NotClaimed, PrescribedLoad, keywords
from verification.problem.line_profile import Line, Profile
from verification.problem.quantity import DISPLACEMENTS, PEAKS, QUANTITIES, STRESSES
from verification.running.json_records import plain
from verification.sampling.largest_tension import Search
from verification.sampling.line_sampling import sample

Numbers = dict[str, dict[str, Any]]


class NotGiven(ValueError):
    """A result that holds nothing that was asked for."""


def _given(result: Any, name: str) -> Any:
    """What a mapping or an object has of this ``name``; None where it has nothing."""
    return result.get(name) if isinstance(result, Mapping) else getattr(result, name, None)


class Face:
    """A guest's result with the attributes of a ``Solution``, each if the guest has it.

    It states no uncertainty, which is used for fields only where it is complete.
    """

    uncertainty = None

    def __init__(self, result: Any) -> None:
        self._result = result

    def __getattr__(self, name: str) -> Any:
        value = _given(self._result, name)
        if value is None:
            raise AttributeError(name)
        return {"pressure": self._pressure, "stress": self._stress}.get(name, value)

    def _pressure(self, x: Any, y: Any = 0.0) -> Array:
        """p [Pa] at points of the surface, (n,)."""
        x, y = np.broadcast_arrays(np.asarray(x, dtype=float), np.asarray(y, dtype=float))
        return _shaped("pressure", _given(self._result, "pressure")(x, y), x.shape)

    def _stress(self, x: Any, y: Any, z: Any, layer: int | None = None) -> Array:
        """sigma[i, j, ...] [Pa] at points, (3, 3) + points."""
        x, y, z = np.broadcast_arrays(*(np.asarray(v, dtype=float) for v in (x, y, z)))
        function = _given(self._result, "stress")
        named = {"layer": layer} if "layer" in inspect.signature(function).parameters else {}
        return _shaped("stress", function(x, y, z, **named), (3, 3, *x.shape))


def values_of(result: Any, problem: Load, question: Question) -> tuple[Numbers, Numbers]:
    """Values and uncertainties that ``result`` gives of those wanted, by line and quantity.

    Raises NotGiven where it gives none, ValueError for one of a wrong shape.
    """
    # A whole solution, as the methods return it, is sampled as they are.
    whole = all(
        hasattr(result, name) for name in ("uncertainty", "pressure_uncertainty", "stress_uncertainty")
    )
    face: Any = result if whole else Face(result)
    stated = _given(result, "uncertainty")
    values: Numbers = {"contact": {}}
    uncertainty: Numbers = {"contact": {}}
    for name in question.contact:
        record = QUANTITIES[name]
        if record.derived is not None or (whole and record.kind == "slope"):
            with suppress(AttributeError):  # a number of which it follows is not given
                values["contact"][name] = record.value(face, problem)
                if whole and (own := record.uncertainty(result, problem)) is not None:
                    uncertainty["contact"][name] = own
        elif (value := _given(result, name)) is not None:
            values["contact"][name] = float(np.asarray(value, dtype=float).reshape(()))
            if (own := _given(stated, name)) is not None:
                uncertainty["contact"][name] = float(own)
    missing = set(question.contact) - set(values["contact"])
    if (
        isinstance(problem, CoatedContact)
        and not whole
        and missing & set(PEAKS)
        and _able(face, "stress", "contact_radius")
    ):
        search = Search(face, problem)
        found = search.largest(face.stress(search.x, 0.0, 0.0, layer=0)[0, 0], None)
        values["contact"] |= dict(zip(PEAKS, (found.value, found.place), strict=True))
    for asked in question.lines:
        for p in _sampled(result, problem, asked) if whole else _on_line(face, asked):
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


def _able(face: Any, *names: str) -> bool:
    return all(getattr(face, name, None) is not None for name in names)


def _sampled(solution: Any, problem: Load, asked: LineOfPoints) -> tuple[Profile, ...]:
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
    if asked.line != PLANE or (plane := _of_plane(solution, asked)) is None:
        return found
    return tuple(replace(p, value=plane[p.quantity]) if p.quantity in plane else p for p in found)


def _of_plane(face: Any, asked: LineOfPoints) -> dict[str, Array] | None:
    """The stresses of a whole plane at points, by a cubic spline; None where the plane is not given there."""
    if not _able(face, "stress_plane", "nodes"):
        return None
    nodes = np.asarray(face.nodes, dtype=float)
    x, y = np.array(asked.x), np.array(asked.y)
    if nodes.ndim != 1 or max(abs(x).max(), abs(y).max()) > min(-nodes[0], nodes[-1]):
        return None
    sigma = _shaped("stress_plane", face.stress_plane(asked.z[0], asked.layer[0]), (3, 3, *2 * nodes.shape))
    return {name: RectBivariateSpline(nodes, nodes, sigma[c]).ev(x, y) for name, c in STRESSES.items()}


def _on_line(face: Any, asked: LineOfPoints) -> Iterator[Profile]:
    """Every quantity that ``face`` gives at points of the flat; nothing of a ball."""
    x, y, z = (np.array(v) for v in (asked.x, asked.y, asked.z))
    found: dict[str, Array] = {}
    flat = asked.body == FLAT
    if flat and "pressure" in asked.quantities and _able(face, "pressure"):
        found["pressure"] = face.pressure(x, y)
    if asked.line == PLANE and (plane := _of_plane(face, asked)) is not None:
        found |= plane
    elif flat and set(STRESSES) & set(asked.quantities) and _able(face, "stress"):
        sigma, layers = np.empty((3, 3, x.size)), np.array(asked.layer)
        for layer in sorted(set(asked.layer)):
            here = layers == layer
            sigma[..., here] = face.stress(x[here], y[here], z[here], layer=layer)
        found |= {name: sigma[component] for name, component in STRESSES.items()}
    if flat and set(DISPLACEMENTS) & set(asked.quantities) and _able(face, "displacement"):
        u = _shaped("displacement", face.displacement(x, y, z), (3, x.size))
        found |= {name: u[i] for i, name in enumerate(DISPLACEMENTS)}
    for quantity, value in found.items():
        yield Profile(quantity, asked.line, x, value, "guest")


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
