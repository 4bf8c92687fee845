"""The content of the open digits: one entry for each problem, and the whole data set."""

import gzip
import hashlib
import json
from collections.abc import Sequence
from math import ceil, floor, log10
from typing import Any

from open_digits_made.problems import VectorProblem
from open_digits_made.row import SCALARS, Row
from open_digits_made.vector_schema import LICENCE, VERSION, VectorSet
from verification.guests.vectors.open_digits import csv_texts
from verification.problem.coated_contact import CoatedContact

DIGITS = 12  # significant, of values
CITE = (
    "coatcheck open digits, version 1 (2026): exact values of coated point contact and of layered "
    "half-spaces under a uniform disc; CC0 1.0"
)
CONVENTIONS = {
    "units": "SI",
    "axes": "origin at first contact, x along sliding, z into the solid, surface z = 0; all points at y = 0",
    "signs": "stress positive in tension, pressure and load in compression; on the surface sigma_zz = -p and "
    "sigma_xz = -friction p",
    "problem": "rigid parabolic sphere, rigid ellipsoid with radii of curvature along x and y, or uniform "
    "pressure on a disc; coatings from the surface down, bonded; friction does not change the pressure",
    "contact_radius": "of an ellipse that of the disc of its area, sqrt(half_axis_x half_axis_y)",
    "layer": "0 is the first below the surface; on an interface it picks the side",
    "approach": "of the sphere; of a disc u_z at the origin, positive into the solid",
}


def vector(problem: VectorProblem, rows: Sequence[Row]) -> dict[str, Any]:
    """The content of one problem."""
    contact: dict[str, list[float]] = {}
    points: list[dict[str, Any]] = []
    for row in rows:
        value, U = zip(
            *(_written(v, u) for v, u in zip(row.value, row.uncertainty, strict=True)), strict=True
        )
        if row.x.size == 1 and row.x[0] == row.z[0] == 0 and row.quantity in CONTACT:
            contact[row.quantity] = [value[0], U[0]]
            continue
        place = {"layer": row.layer, "x": row.x.tolist(), "z": row.z.tolist()}
        if not points or {k: points[-1][k] for k in place} != place:
            points.append(place | {"values": {}, "uncertainty": {}})
        points[-1]["values"][row.quantity] = list(value)
        points[-1]["uncertainty"][row.quantity] = list(U)
    return {
        "name": problem.name,
        "group": problem.group,
        "problem": _entry(problem),
        "contact": contact,
        "points": points,
    }


CONTACT = (*SCALARS, "half_axis_x", "half_axis_y")


def _entry(problem: VectorProblem) -> dict[str, Any]:
    given = problem.problem
    if isinstance(given, CoatedContact):
        shape = {"radius": given.radius}
        if given.indenter is not None:
            shape = dict(zip(("radius_x", "radius_y"), given.indenter[1], strict=True))
        loaded = shape | {"load": given.load}
    else:
        loaded = {"pressure": given.pressure, "load_radius": given.load_radius}
    E, nu = given.substrate
    return {
        **loaded,
        "friction": given.friction,
        "coatings": [{"E": E1, "nu": nu1, "thickness": h} for E1, nu1, h in given.coatings],
        "substrate": {"E": E, "nu": nu},
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
    content = {
        "schema": VERSION,
        "licence": LICENCE,
        "cite": CITE,
        "conventions": CONVENTIONS,
        "made_by": made_by,
        "checked": list(checked),
        "sha256": sums,
        "problems": list(vectors),
    }
    VectorSet.model_validate_json(json.dumps(content))
    return content


def packed(content: dict[str, Any]) -> bytes:
    """``content`` as the package holds it; the same bytes each time."""
    return gzip.compress(json.dumps(content, separators=(",", ":")).encode(), 9, mtime=0)
