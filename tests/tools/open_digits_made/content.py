"""The content of the open digits: one entry for each problem, and the whole data set."""

import gzip
import hashlib
import json
from collections.abc import Sequence
from math import ceil, floor, log10
from typing import Any

import numpy as np

from open_digits_made.problems import VectorProblem
from open_digits_made.row import Row
from open_digits_made.vector_schema import VectorSet
from verification.guests.vectors.open_digits import csv_texts, shipped

DIGITS = 12  # significant, of values


def vector(problem: VectorProblem, rows: Sequence[Row]) -> dict[str, Any]:
    """The content of one problem."""
    contact: dict[str, list[float]] = {}
    points: list[dict[str, Any]] = []
    for row in rows:
        value, U = zip(
            *(_written(v, u) for v, u in zip(row.value, row.uncertainty, strict=True)), strict=True
        )
        if row.points is None:
            contact[row.quantity] = [value[0], U[0]]
            continue
        at = row.points
        place = {
            "body": at.body,
            "layer": at.layer,
            **{c: np.asarray(getattr(at, c)).tolist() for c in "xyz"},
        }
        if not points or {k: points[-1][k] for k in place} != place:
            points.append(place | {"values": {}, "uncertainty": {}})
        points[-1]["values"][row.quantity] = list(value)
        points[-1]["uncertainty"][row.quantity] = list(U)
    return {
        "name": problem.name,
        "group": problem.group,
        "problem": problem.entry,
        "contact": contact,
        "points": points,
    }


def _written(value: float, uncertainty: float) -> tuple[float, float]:
    """``value`` with ``DIGITS`` digits; its uncertainty, rounding included, with two, rounded up."""
    shown = float(f"{value:.{DIGITS}g}")
    U = float(uncertainty) + abs(shown - float(value))
    if U == 0:
        return shown, 0.0
    step = 10.0 ** (floor(log10(U)) - 1)
    return shown, float(f"{ceil(U / step) * step:.2g}")


def data_set(
    vectors: Sequence[dict[str, Any]], checked: Sequence[dict[str, Any]], made_by: dict[str, str]
) -> dict[str, Any]:
    """The whole data set as JSON content, checked against its schema. Raises ValueError."""
    sums = {name: hashlib.sha256(text.encode()).hexdigest() for name, text in csv_texts(vectors).items()}
    made = {"made_by": made_by, "checked": list(checked), "sha256": sums, "problems": list(vectors)}
    content = {**shipped(), **made}
    VectorSet.model_validate_json(json.dumps(content))
    return content


def packed(content: dict[str, Any]) -> bytes:
    """``content`` as the package holds it; the same bytes each time."""
    return gzip.compress(json.dumps(content, separators=(",", ":")).encode(), 9, mtime=0)
