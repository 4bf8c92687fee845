"""The door of Python functions in an environment of their own: PYTHON own_python.py MODULE:FUNCTION.

This file needs numpy alone, so that a code which cannot share coatcheck's environment stays in its own. It
answers as ``serve_function`` does, which calls functions by it too, but without uncertainties, whole planes,
and solutions that are sampled as they are.
"""

from __future__ import annotations

import importlib
import inspect
import json
import os
import sys
import traceback
from collections.abc import Callable, Mapping
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


def field(result: Any, name: str, x: Any, y: Any, z: Any, layers: list[int]) -> Any:
    """Values of a function of the result at points, a call for each layer; None where it has none."""
    function = entry(result, name)
    if function is None:
        return None
    found = np.empty((*COMPONENTS[name][0], x.size))
    for layer in sorted(set(layers)):
        at = np.flatnonzero(np.array(layers) == layer)
        value = at_points(function, name, COMPONENTS[name][0], x[at], y[at], z[at], layer=layer)
        if value is None:
            return None
        found[..., at] = value
    return found


def at_points(function: Any, name: str, components: tuple[int, ...], *points: Any, **of: Any) -> Any:
    """Values of a function at points x, y, z, of ``components`` each; None where it gives none.

    of : layer and body, given where the function takes them.   An error has the first ``place`` that it is
    of: at which the function fails by itself.
    """

    def values(*points: Any) -> Any:
        value = function(*points[:2]) if name.startswith("pressure") else function(*points, **of)
        return None if value is None else shaped(name, value, (*components, *points[0].shape))

    if "layer" in of and "layer" not in inspect.signature(function).parameters:
        del of["layer"]
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
    a = question["edge"] * AROUND
    x = np.concatenate([-a[::-1], a]) if question["problem"].get("friction") else -a[::-1]
    sigma = field(result, "stress", x, 0 * x, 0 * x, [0] * x.size)
    if sigma is None:
        return {}
    i = int(np.argmax(sigma[0, 0]))
    return {"largest_tension": float(sigma[0, 0, i]), "tension_place": float(x[i])}


def values_of(result: Any, question: dict[str, Any]) -> dict[str, Any]:
    """The values by line and quantity, with the reasons of those that are missing or failed."""
    found: dict[str, Any] = {"values": {}, "missing": {}, "failed": {}}

    def put(line: str, quantities: list[str], make: Any) -> None:
        try:
            values = make() or {}
            wanted = {q: values[q] for q in quantities if values.get(q) is not None}
            found["values"].setdefault(line, {}).update(wanted)
        except NotImplementedError as error:
            found["missing"].setdefault(line, {}).update(
                dict.fromkeys(quantities, one_line(error) or "not implemented")
            )
        except Exception as error:
            found["failed"].setdefault(line, {}).update(dict.fromkeys(quantities, message(error)))

    for name in question["contact"]:
        number = entry(result, name)
        put("contact", [name], lambda name=name, v=number: {} if v is None else {name: float(v)})
    peaks = {"largest_tension", "tension_place"} & set(question["contact"])
    if peaks - set(found["values"].get("contact", ())) and question["edge"]:
        put("contact", sorted(peaks), lambda: largest_tension(result, question))
    for line in (line for line in question["lines"] if line["body"] == "flat"):
        x, y, z = (np.array(line[c]) for c in "xyz")
        for name, (_, parts) in COMPONENTS.items():
            if wanted := [q for q in line["quantities"] if q in parts]:

                def make(name: str = name, parts: Any = parts, points: Any = (x, y, z, line["layer"])) -> Any:
                    values = field(result, name, *points)
                    return {} if values is None else {q: values[c].tolist() for q, c in parts.items()}

                put(line["line"], wanted, make)
    return found


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
