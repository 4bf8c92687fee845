"""What a guest's function returned, at the points of a question.

A mapping or an object with any of contact_radius, approach, peak_pressure, largest_tension, tension_place,
pressure(x, y), stress(x, y, z, layer), displacement(x, y, z); for each an uncertainty if there is one:
``uncertainty`` with the names of the numbers, pressure_uncertainty, stress_uncertainty.
"""

import inspect
from collections.abc import Callable, Mapping
from contextlib import suppress
from types import SimpleNamespace
from typing import Any

import numpy as np

from verification.guests.protocol import Question
from verification.problem.arrays import Array
from verification.problem.contact import CoatedContact
from verification.problem.profile import line_of
from verification.problem.quantity import PEAKS, QUANTITIES, SCALARS
from verification.sampling.lines import sample

Numbers = dict[str, dict[str, Any]]


class NotGiven(ValueError):
    """A result that holds nothing that was asked for."""


class Face:
    """A guest's result with the attributes of a ``Solution``, each if the guest has it."""

    def __init__(self, result: Any) -> None:
        self._get: Callable[[str], Any] = (
            result.get if isinstance(result, Mapping) else lambda name: getattr(result, name, None)
        )
        self.uncertainty = self._get("uncertainty")
        if isinstance(self.uncertainty, Mapping):
            self.uncertainty = SimpleNamespace(**self.uncertainty)

    def has(self, name: str) -> bool:
        return self._get(name) is not None

    def __getattr__(self, name: str) -> Any:
        value = self._get(name)
        if value is None:
            raise AttributeError(name)
        return value

    def number(self, name: str) -> float:
        return float(np.asarray(self._get(name), dtype=float).reshape(()))

    def pressure(self, x: Any, y: Any = 0.0) -> Array:
        """p [Pa] at points of the surface, (n,)."""
        x, y = np.broadcast_arrays(np.asarray(x, dtype=float), np.asarray(y, dtype=float))
        return _shaped("pressure", self._get("pressure")(x, y), x.shape)

    def stress(self, x: Any, y: Any, z: Any, layer: int | None = None) -> Array:
        """sigma[i, j, ...] [Pa] at points, (3, 3) + points."""
        x, y, z = np.broadcast_arrays(*(np.asarray(v, dtype=float) for v in (x, y, z)))
        function = self._get("stress")
        named = {"layer": layer} if "layer" in inspect.signature(function).parameters else {}
        return _shaped("stress", function(x, y, z, **named), (3, 3, *x.shape))


class _Plain(Face):
    """A face whose uncertainty is not complete, and so not used for fields."""

    def __init__(self, result: Any) -> None:
        super().__init__(result)
        self.uncertainty = None


def values_of(result: Any, problem: CoatedContact, question: Question) -> tuple[Numbers, Numbers]:
    """Values and uncertainties that ``result`` gives of those wanted, by line and quantity.

    Raises NotGiven where it gives none, ValueError for one of a wrong shape.
    """
    # A whole solution, as the methods return it, is sampled as they are.
    whole = all(
        hasattr(result, name) for name in ("uncertainty", "pressure_uncertainty", "stress_uncertainty")
    )
    face: Any = result if whole else _Plain(result)
    stated = Face(result).uncertainty
    values: Numbers = {"contact": {}}
    uncertainty: Numbers = {"contact": {}}
    for name in question.contact:
        record = QUANTITIES[name]
        if name in SCALARS and record.derived is not None:
            with suppress(AttributeError):  # a number of which it follows is not given
                values["contact"][name] = record.value(face, problem)
                if whole and (U := record.uncertainty(result, problem)) is not None:
                    uncertainty["contact"][name] = U
        elif Face(result).has(name):
            values["contact"][name] = Face(result).number(name)
            if getattr(stated, name, None) is not None:
                uncertainty["contact"][name] = float(getattr(stated, name))
    for asked in question.lines:
        line = line_of(asked.line, problem)
        along = np.array(asked.z if line.depth is None else asked.x)
        found = []
        if whole or Face(result).has("stress"):
            search = asked.line == "surface" and not set(PEAKS).isdisjoint(question.contact)
            search = search and (whole or Face(result).has("contact_radius"))
            if not whole and not Face(result).has("pressure"):
                face.pressure = lambda x, y=0.0: np.zeros(np.shape(x))
            found = list(sample(face, "guest", line, along, problem if search else None))
        elif asked.line == "surface" and Face(result).has("pressure"):
            values["surface"] = {"pressure": face.pressure(along).tolist()}
        for p in found:
            wanted = question.contact if p.line == "contact" else asked.quantities
            missing = p.quantity == "pressure" and not Face(result).has("pressure")
            if p.quantity not in wanted or missing or p.quantity in values.get(p.line, {}):
                continue
            one = p.line == "contact"
            values.setdefault(p.line, {})[p.quantity] = float(p.value[0]) if one else p.value.tolist()
            if p.uncertainty is not None:
                U = float(p.uncertainty[0]) if one else p.uncertainty.tolist()
                uncertainty.setdefault(p.line, {})[p.quantity] = U
    values = {line: numbers for line, numbers in values.items() if numbers}
    if not values:
        names = "contact_radius, approach, peak_pressure, pressure, stress"
        raise NotGiven(f"its result, {type(result).__name__}, has none of {names}")
    return values, {line: numbers for line, numbers in uncertainty.items() if numbers}


def _shaped(name: str, value: Any, shape: tuple[int, ...]) -> Array:
    found = np.asarray(value, dtype=float)
    if found.shape != shape:
        raise ValueError(f"{name} returns an array of shape {found.shape}; {shape} is needed")
    return found
