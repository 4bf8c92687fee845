"""The door of Python functions in an environment of their own: PYTHON own_python.py MODULE:FUNCTION.

This file needs numpy alone, so that a code which cannot share coatcheck's environment stays in its own. It
answers as ``serve_function`` does, without whole planes and without solutions that are sampled as they are.
"""

from __future__ import annotations

import importlib
import inspect
import json
import os
import sys
import traceback
from typing import Any

import numpy as np

TENSORS = {"xx": (0, 0), "yy": (1, 1), "zz": (2, 2), "xz": (0, 2), "xy": (0, 1), "yz": (1, 2)}
STRESSES = {f"sigma_{name}": place for name, place in TENSORS.items()}
COMPONENTS: dict[str, Any] = {"pressure": ((), {"pressure": ...}), "stress": ((3, 3), STRESSES)}
COMPONENTS["displacement"] = (3,), {"u_x": 0, "u_y": 1, "u_z": 2}
AROUND = np.concatenate([1 - np.geomspace(1e-4, 0.99, 60)[::-1], [1.0], 1 + np.geomspace(1e-4, 4.0, 60)])


def keywords(question: dict[str, Any]) -> dict[str, Any]:
    """The problem as the keywords of a solver, without those that are nothing."""

    def layers(found: list[dict[str, float]]) -> tuple[Any, ...]:
        return tuple((c["E"], c["nu"], c["thickness"]) for c in found)

    found = {k: v for k, v in question["problem"].items() if v is not None} | question["parameter"]
    found |= {
        "coatings": layers(found["coatings"]),
        "substrate": (found["substrate"]["E"], found["substrate"]["nu"]),
    }
    if "ball" in found:
        found["ball"] = found["ball"]["E"], found["ball"]["nu"], layers(found["ball"]["coatings"])
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


def field(result: Any, name: str, x: Any, y: Any, z: Any, layers: list[int]) -> Any:
    """Values of a function of the result at points, a call for each layer; None where it has none."""
    function = result.get(name) if isinstance(result, dict) else getattr(result, name, None)
    if function is None:
        return None
    found = np.empty((*COMPONENTS[name][0], x.size))
    for layer in sorted(set(layers)):
        at = np.flatnonzero(np.array(layers) == layer)
        try:
            value = at_points(function, name, x[at], y[at], z[at], layer)
        except NotImplementedError:
            raise
        except Exception as error:
            error.place = first_point(function, name, x[at], y[at], z[at], layer)  # type: ignore[attr-defined]
            raise
        if value is None:
            return None
        found[..., at] = value
    return found


def at_points(function: Any, name: str, x: Any, y: Any, z: Any, layer: int) -> Any:
    """Values of a function of the result at points of one layer, checked; None where it gives none."""
    of = {"layer": layer} if "layer" in inspect.signature(function).parameters else {}
    value = function(x, y) if name == "pressure" else function(x, y, z, **of)
    if value is None:
        return None
    value, shape = np.asarray(value, dtype=float), (*COMPONENTS[name][0], x.size)
    if value.shape != shape:
        raise ValueError(f"{name} returns an array of shape {value.shape}; {shape} is needed")
    return value


def first_point(function: Any, name: str, x: Any, y: Any, z: Any, layer: int) -> str:
    """The first of several points, at which a function fails by itself; "" where it fails at none."""
    for i in range(x.size if x.size > 1 else 0):
        try:
            at_points(function, name, x[i : i + 1], y[i : i + 1], z[i : i + 1], layer)
        except Exception:
            return f", first at x, y, z = {x[i]:.4g}, {y[i]:.4g}, {z[i]:.4g}"
    return ""


def largest_tension(result: Any, question: dict[str, Any]) -> dict[str, float]:
    """The largest sigma_xx of the surface on y = 0 with its x, around the exact contact edge."""
    a = question["edge"] * AROUND
    x = np.concatenate([-a[::-1], a]) if question["problem"].get("friction") else -a[::-1]
    sigma = field(result, "stress", x, 0 * x, 0 * x, [0] * x.size)
    if sigma is None:
        return {}
    i = int(np.argmax(sigma[0, 0]))
    return {"largest_tension": float(sigma[0, 0, i]), "tension_place": float(x[i])}


def answered(function: Any, question: dict[str, Any]) -> dict[str, Any]:
    """The values by line and quantity, with the reasons of those that are missing or failed."""
    result = called(function, keywords(question))
    found: dict[str, Any] = {"values": {}, "missing": {}, "failed": {}}

    def put(line: str, quantities: list[str], make: Any) -> None:
        try:
            values = make() or {}
            wanted = {q: values[q] for q in quantities if values.get(q) is not None}
            found["values"].setdefault(line, {}).update(wanted)
        except NotImplementedError as error:
            found["missing"].setdefault(line, {}).update(
                dict.fromkeys(quantities, str(error) or "not implemented")
            )
        except Exception as error:
            found["failed"].setdefault(line, {}).update(dict.fromkeys(quantities, message(error)))

    get: Any = result.get if isinstance(result, dict) else lambda name: getattr(result, name, None)
    for name in question["contact"]:
        put("contact", [name], lambda name=name: {} if get(name) is None else {name: float(get(name))})
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


def message(error: BaseException) -> str:
    """Type, text, point and line of an exception, of the guest's own files where it passed them."""
    frames = traceback.extract_tb(error.__traceback__)
    frame = [*frames[-1:], *(f for f in frames if f.filename.startswith(os.getcwd()))][-1]
    where = f"{os.path.basename(frame.filename)}, line {frame.lineno}"
    text = " ".join(str(error).split())[:400] + getattr(error, "place", "")
    return f"{type(error).__name__}: {text} ({where})"


def main(place: str) -> None:
    """Answer every line of standard input; what the function prints goes to standard error."""
    replies = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)
    sys.path.insert(0, os.getcwd())
    for line in sys.stdin:
        question = json.loads(line)
        answer: dict[str, Any] = {
            "protocol": question["protocol"],
            "id": question["id"],
            "units": question["units"],
        }
        try:
            module, _, name = place.partition(":")
            answer |= answered(getattr(importlib.import_module(module), name), question)
        except NotImplementedError as error:
            answer["unsupported"] = str(error) or "not implemented"
        except Exception as error:
            answer["error"] = message(error)
        replies.write(f"COATCHECK {json.dumps(answer)}\n")
        replies.flush()


if __name__ == "__main__":
    main(sys.argv[1])
