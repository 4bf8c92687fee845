"""One solve of a study: from its plain request to the rows of all its frictions.

Requests and answers are plain dictionaries, lists, numbers and text, so that any process with the package can
answer.
"""

import json
import time
from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import product
from typing import Any

from threadpoolctl import threadpool_limits

from verification.problem.coated_contact import CoatedContact
from verification.running.case_result import message_of
from verification.running.json_records import decode
from verification.running.provenance import versions
from verification.running.slicing import sliced
from verification.sampling.along_axis import AlongAxis
from verification.sources.source_registry import solvers
from verification.study.largest_stresses import quantities
from verification.study.study_table import OVER, SCALARS, SCALES


def answer(request: Mapping[str, Any]) -> dict[str, Any]:
    """Solve ``request`` and find every quantity at each of its frictions.

    request : source, numerics (its own keywords), problem (a CoatedContact), swept (number of the swept
    coating), residual (its stresses [Pa]), frictions, halved (problem and swept, half of the sub-layers).
    Returns {"rows": [one dictionary for each residual stress, then friction], "seconds", "versions"}; a solve
    that fails leaves its message in every row.
    """
    begin = time.perf_counter()
    frictions = [float(f) for f in request["frictions"]]
    # The pressure does not depend on friction, stresses are linear in it: friction 1 gives every other.
    problem = problem_of(request, 1.0 if any(frictions) else 0.0)
    try:
        with threadpool_limits(1):  # the order of sums over threads changes the last digit
            solution = solvers()[request["source"]](problem, request["numerics"])
            rows = _rows(solution, problem, frictions, request["residual"], request["swept"])
            if request.get("halved"):
                rows = _sliced(rows, answer(halved_request(request))["rows"])
    except Exception as error:  # a point that fails is a row with its message
        rows = failed_rows(request, message_of(error))
    return {"rows": rows, "seconds": time.perf_counter() - begin, "versions": versions()}


def halved_request(request: Mapping[str, Any]) -> dict[str, Any]:
    """A request with half of the sub-layers of its graded coatings."""
    return {key: value for key, value in (dict(request) | request["halved"]).items() if key != "halved"}


def _sliced(rows: list[dict[str, Any]], halved: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """``rows`` with the uncertainty of the slicing, see ``sliced``; the swept coating is not graded.

    Raises ValueError with the message of a solve that failed.
    """
    found = []
    for row, other in zip(rows, halved, strict=True):
        if other["failure"] is not None:
            raise ValueError(f"with half of the sub-layers: {other['failure']}")
        ends = {f"{name}_uncertainty": sliced(row[name] - other[name]) for name in SCALES if name in row}
        found.append(row | {end: row[end] + more for end, more in ends.items() if row.get(end) is not None})
    return found


def failed_rows(request: Mapping[str, Any], message: str) -> list[dict[str, Any]]:
    """A row with the ``message`` for each residual stress and friction of ``request``."""
    failed = [{"friction": float(f), "status": "failed", "failure": message} for f in request["frictions"]]
    return [row for _ in request["residual"] for row in failed]


def problem_of(request: Mapping[str, Any], friction: float) -> CoatedContact:
    """The contact of ``request`` at ``friction``."""
    return replace(decode(CoatedContact, request["problem"]), friction=friction)


def table_rows(
    first: int,
    key: str,
    request: Mapping[str, Any],
    found: Mapping[str, Any],
    places: Sequence[tuple[float, float]],
) -> list[dict[str, Any]]:
    """The rows of the answer ``found`` to ``request``, whose first row is point ``first``.

    places : (thickness [m], load [N]) of equal h/a_h. There stresses over p_h, positions over a_h and the
    approach over delta_h are the same: both bodies are half-spaces and the gap is a parabola.
    """
    solved = problem_of(request, 0.0)
    (E1, nu1, thickness), (E2, nu2) = solved.coatings[request["swept"]], solved.substrate
    rows: list[dict[str, Any]] = []
    count = len(request["frictions"])
    for i, (h, load) in enumerate(places):
        bare = replace(solved, coatings=(), load=load)
        k = i if len(request["residual"]) > 1 else 0
        shared = {
            "source": request["source"],
            "radius": solved.radius,
            "load": load,
            "coating_E": E1,
            "coating_nu": nu1,
            "thickness": h,
            "residual_stress": request["residual"][k] * bare.p_h / solved.p_h,
            "substrate_E": E2,
            "substrate_nu": nu2,
            "modulus_ratio": E1 / E2,
            "thickness_over_a_h": thickness / solved.a_h,
            "a_h": bare.a_h,
            "p_h": bare.p_h,
            "delta_h": bare.delta_h,
            "ball": json.dumps(solved.ball),
            "indenter": json.dumps(solved.indenter),
            "numerics": json.dumps(request["numerics"], sort_keys=True),
            "versions": json.dumps(found["versions"], sort_keys=True),
            "key": key,
            "seconds": found["seconds"],
        }
        for row in found["rows"][k * count : (k + 1) * count]:
            rows.append({"point": first + len(rows)} | shared | _scaled(row, solved, bare))
    return rows


def _scaled(row: Mapping[str, Any], solved: CoatedContact, bare: CoatedContact) -> dict[str, Any]:
    """``row`` of ``solved`` at the scales of ``bare``, its numbers over them too."""
    found = dict(row)
    for name, value in row.items():
        scale = OVER.get(name.removesuffix("_uncertainty"))
        if scale is not None and value is not None:
            found[name] = value * (getattr(bare, scale) / getattr(solved, scale))
            if name in OVER:
                found[f"{name}_over_{scale}"] = value / getattr(solved, scale)
    return found


def _rows(
    solution: Any, problem: CoatedContact, frictions: list[float], residual: list[float], swept: int
) -> list[dict[str, Any]]:
    common: dict[str, Any] = {}
    for name in SCALARS:
        value, spread = solution.sample(None, name)
        if not 0 < value < float("inf"):
            raise ValueError(f"{name} = {value:g}; the solution is no contact")
        common |= {name: value} | ({} if spread is None else {f"{name}_uncertainty": spread})
    rows = []
    # of an ellipse the half axis takes the place of the radius; without friction in both planes of symmetry
    axes = (False,) if problem.friction else (False, True)
    sides: list[Any] = [AlongAxis(solution, across=across) for across in axes if problem.elliptical] or [
        solution
    ]
    views = [quantities(side, problem, frictions, residual, swept) for side in sides]
    for stress, f in product(residual, frictions):
        row: dict[str, Any] = {"friction": f, "status": "solved", "failure": None, **common}
        for name in views[0][stress, f]:
            at = max((view[stress, f][name] for view in views), key=lambda at: at.value)
            row |= {
                name: at.value,
                f"{name}_uncertainty": at.uncertainty,
                f"{name}_x": at.x,
                f"{name}_z": at.z,
            }
        rows.append(row)
    return rows
