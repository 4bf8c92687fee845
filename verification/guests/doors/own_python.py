"""The door of Python functions in an environment of their own: PYTHON own_python.py MODULE:FUNCTION.

This file needs numpy alone, so that a code which cannot share coatcheck's environment stays in its own. It
answers as ``serve_function`` does, which calls functions by it too, but without whole planes and without
solutions that are sampled as they are.
"""

from __future__ import annotations

import importlib
import inspect
import json
import os
import sys
import traceback
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from functools import reduce
from typing import Any

import numpy as np

TENSORS = {"xx": (0, 0), "yy": (1, 1), "zz": (2, 2), "xz": (0, 2), "xy": (0, 1), "yz": (1, 2)}
STRESSES = {f"sigma_{name}": place for name, place in TENSORS.items()}
COMPONENTS: dict[str, Any] = {"pressure": ((), {"pressure": ...}), "stress": ((3, 3), STRESSES)}
COMPONENTS["displacement"] = (3,), {"u_x": 0, "u_y": 1, "u_z": 2}
AROUND = np.concatenate([1 - np.geomspace(1e-4, 0.99, 60)[::-1], [1.0], 1 + np.geomspace(1e-4, 4.0, 60)])


def keywords(question: dict[str, Any]) -> dict[str, Any]:
    """The problem as the keywords of a solver; what a problem may lack is given too, as nothing."""

    def layers(found: list[dict[str, float]]) -> tuple[Any, ...]:
        return tuple((c["E"], c["nu"], c["thickness"]) for c in found)

    problem = question["problem"]
    nothing: dict[str, Any] = {} if "side" in problem else {"friction": 0.0}
    nothing |= {"ball": None} if "load" in problem else {}
    found = nothing | problem | question["parameter"]
    found |= {
        "coatings": layers(found["coatings"]),
        "substrate": (found["substrate"]["E"], found["substrate"]["nu"]),
    }
    if ball := found.get("ball"):
        found["ball"] = ball["E"], ball["nu"], layers(ball["coatings"])
    if "radius_x" in found:
        radii = found.pop("radius_x"), found.pop("radius_y")
        found |= {"indenter": ("ellipsoid", radii), "radius": (radii[0] * radii[1]) ** 0.5}
    return found


def called(function: Any, given: dict[str, Any]) -> Any:
    """``function`` with the keywords that it takes; one that it lacks must be nothing."""
    accepted = inspect.signature(function).parameters
    if not any(p.kind is inspect.Parameter.VAR_KEYWORD for p in accepted.values()):
        given = {k: v for k, v in given.items() if k in accepted or v}
    return function(**given)


def entry(result: Any, name: str) -> Any:
    """Entry of a mapping or attribute of an object of this ``name``; None where it has none."""
    return result.get(name) if isinstance(result, Mapping) else getattr(result, name, None)


def field(result: Any, name: str, x: Any, y: Any, z: Any, layers: list[int], of: str = "") -> Any:
    """Values of a function of the result at points; None where it has none.

    A stress that takes ``layer`` is called for each layer.
    of : the field whose components it has, where that is not its name.
    """
    function, components = entry(result, name), COMPONENTS[of or name][0]
    if function is None:
        return None
    if (of or name) != "stress" or "layer" not in inspect.signature(function).parameters:
        return at_points(function, name, components, x, y, z)
    found = np.empty((*components, x.size))
    for layer in sorted(set(layers)):
        at = np.flatnonzero(np.array(layers) == layer)
        value = at_points(function, name, components, x[at], y[at], z[at], layer=layer)
        if value is None:
            return None
        found[..., at] = value
    return found


def at_points(function: Any, name: str, components: tuple[int, ...], *points: Any, **of: Any) -> Any:
    """Values of a function at points x, y, z, of ``components`` each; None where it gives none.

    of : layer and body.   An error has the first ``place`` that it is of, at which the function fails by
    itself.
    """

    def values(*points: Any) -> Any:
        value = function(*points[:2]) if name.startswith("pressure") else function(*points, **of)
        return None if value is None else shaped(name, value, (*components, *points[0].shape))

    try:
        return values(*points)
    except NotImplementedError:
        raise
    except Exception as error:
        error.place = _first_place(values, *points)  # type: ignore[attr-defined]
        raise


def _first_place(values: Any, *points: Any) -> str:
    for at in zip(*points, strict=True) if points[0].ndim == 1 and points[0].size > 1 else ():
        try:
            values(*(np.array([v]) for v in at))
        except Exception:
            return f", first at x, y, z = {', '.join(f'{v:.4g}' for v in at)}"
    return ""


def shaped(name: str, value: Any, shape: tuple[int, ...]) -> Any:
    """``value`` as an array of that shape. Raises ValueError for any other."""
    found = np.asarray(value, dtype=float)
    if found.shape != shape:
        raise ValueError(f"{name} returns an array of shape {found.shape}; {shape} is needed")
    return found


def largest_tension(result: Any, question: dict[str, Any]) -> dict[str, float]:
    """The largest sigma_xx of the surface on y = 0 with its x, around the exact contact edge."""
    if not question["edge"]:
        return {}
    a = question["edge"] * AROUND
    x = np.concatenate([-a[::-1], a]) if question["problem"].get("friction") else -a[::-1]
    sigma = field(result, "stress", x, 0 * x, 0 * x, [0] * x.size)
    if sigma is None:
        return {}
    i = int(np.argmax(sigma[0, 0]))
    return {"largest_tension": float(sigma[0, 0, i]), "tension_place": float(x[i])}


class Given:
    """Values and uncertainties by line and quantity, with the reasons why others are missing or failed.

    refusals : exceptions that say that something is not given.
    """

    def __init__(self, refusals: tuple[type[Exception], ...] = (NotImplementedError,)) -> None:
        self.found: dict[str, dict[str, dict[str, Any]]] = {
            name: {} for name in ("values", "uncertainty", "missing", "failed")
        }
        self.refusals = refusals

    def lacks(self, line: str, quantities: Iterable[str]) -> set[str]:
        """Those of ``quantities`` that have no value on a line."""
        return set(quantities) - set(self.found["values"].get(line, ()))

    def put(self, line: str, quantity: str, value: Any, U: Any = None) -> None:
        """One quantity; nothing where it is None."""
        for name, one in (("values", value), ("uncertainty", U)) if value is not None else ():
            if one is not None:
                self.found[name].setdefault(line, {})[quantity] = one

    @contextmanager
    def without(self, line: str, quantities: Iterable[str]) -> Iterator[None]:
        """An exception costs these quantities on this line, and no other."""
        try:
            yield
        except Exception as error:
            refused = isinstance(error, self.refusals)
            reason = (one_line(error) or "not implemented") if refused else message(error)
            by = self.found["missing" if refused else "failed"].setdefault(line, {})
            by.update(dict.fromkeys(quantities, reason))

    def answered(self, result: Any) -> dict[str, Any]:
        """All of it, as parts of an answer. Raises NotImplementedError where ``result`` has nothing."""
        if not any(self.found.values()):
            names = "contact_radius, approach, peak_pressure, pressure, stress"
            raise NotImplementedError(f"its result, {type(result).__name__}, has none of {names}")
        return self.found


def number(value: Any) -> float | None:
    """A number of any shape as a float."""
    return None if value is None else float(np.asarray(value, dtype=float).reshape(()))


def values_of(
    result: Any,
    question: dict[str, Any],
    refusals: tuple[type[Exception], ...] = (NotImplementedError,),
    plane_of: Callable[[Any, dict[str, Any]], Any] = lambda result, line: None,
    tension_of: Callable[[Any, dict[str, Any]], dict[str, float]] = largest_tension,
) -> dict[str, Any]:
    """The values by line and quantity, with the reasons of those that are missing or failed.

    plane_of : the stresses on a line from a whole plane, None where it gives none.   tension_of : the largest
    tension with its place.
    """
    given, uncertainty = Given(refusals), entry(result, "uncertainty")
    for name in question["contact"]:
        with given.without("contact", [name]):
            given.put("contact", name, number(entry(result, name)), number(entry(uncertainty, name)))
    peaks = {"largest_tension", "tension_place"} & set(question["contact"])
    if given.lacks("contact", peaks):
        with given.without("contact", sorted(peaks)):
            for name, value in tension_of(result, question).items():
                given.put("contact", name, value)
    for line in (line for line in question["lines"] if line["body"] == "flat"):
        plane, (x, y, z) = None, (np.array(line[c]) for c in "xyz")
        with given.without(line["line"], STRESSES):
            plane = plane_of(result, line)
        for name, (_, parts) in COMPONENTS.items():
            wanted = [quantity for quantity in parts if quantity in line["quantities"]]
            if name == "stress" and plane is not None:
                for quantity in wanted:
                    given.put(line["line"], quantity, plane[quantity].tolist())
            elif wanted:
                with given.without(line["line"], wanted):
                    value = field(result, name, x, y, z, line["layer"])
                    U = field(result, f"{name}_uncertainty", x, y, z, line["layer"], name)
                    for quantity in wanted if value is not None else ():
                        c = parts[quantity]
                        given.put(
                            line["line"], quantity, value[c].tolist(), None if U is None else U[c].tolist()
                        )
    return given.answered(result)


def one_line(error: BaseException) -> str:
    """The text of an exception, without line ends."""
    return " ".join(str(error).split())[:400]


def message(error: BaseException) -> str:
    """Type, text, point and line of an exception, of the guest's own files where it passed them."""
    frames = traceback.extract_tb(error.__traceback__)
    frame = [*frames[-1:], *(f for f in frames if f.filename.startswith(os.getcwd()))][-1]
    where = f"{os.path.basename(frame.filename)}, line {frame.lineno}"
    return f"{type(error).__name__}: {one_line(error)}{getattr(error, 'place', '')} ({where})"


def answer_of(
    place: str,
    question: dict[str, Any],
    values_of: Callable[[Any], dict[str, Any]],
    refusals: tuple[type[Exception], ...] = (NotImplementedError,),
) -> dict[str, Any]:
    """The answer of the function at ``place``, MODULE:FUNCTION; an exception becomes an answer too."""
    answer = {"protocol": question["protocol"], "id": question["id"]}
    try:
        module, _, name = place.partition(":")
        function = reduce(getattr, name.split("."), importlib.import_module(module))
        answer |= values_of(called(function, keywords(question)))
    except refusals as error:
        answer["unsupported"] = one_line(error) or "not implemented"
    except Exception as error:
        answer["error"] = message(error)
    return answer


def serve(answer: Callable[[str], str]) -> None:
    """Answer every line of standard input; what a function prints goes to standard error."""
    replies = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)
    sys.path.insert(0, os.getcwd())
    for line in sys.stdin:
        replies.write(f"COATCHECK {answer(line)}\n")
        replies.flush()


def _answer(line: str) -> str:
    question = json.loads(line)
    found = answer_of(sys.argv[1], question, lambda result: values_of(result, question))
    return json.dumps(found | {"units": question["units"]})


if __name__ == "__main__":
    serve(_answer)
