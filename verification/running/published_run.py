"""One published case from its problem to its verdicts."""

import time
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from verification.cases.published_file import PublishedCase
from verification.cases.published_table import PublishedColumn
from verification.judging.verdict import Outcome, Verdict, compare, judge
from verification.problem.coated_contact import CoatedContact, ContactSolution, PrescribedLoad
from verification.problem.line_profile import Profile
from verification.problem.loading_curve import Problem
from verification.problem.quantity import QUANTITIES
from verification.running.case_result import CaseResult, SourceResult, attempted
from verification.sampling.point_values import values
from verification.sources.loading_solution import Loading
from verification.sources.source_record import Solver
from verification.sources.source_registry import CLOSED, METHODS, PUBLISHED, solvers


def run(case: PublishedCase, available: Mapping[str, Solver] | None = None) -> CaseResult:
    """Solve by every source, evaluate each at the published points, judge every column on every line.

    available : solvers by source; a method that is missing has NO_RESULT, a reference no claims.
    A source that fails leaves its message and NO_RESULT on each of its claims.
    """
    started = time.perf_counter()
    if available is None:  # the methods, and the exact reference where it supports the problem
        available = {name: one for name, one in solvers(case.problem).items() if name not in CLOSED}
    outcomes: dict[str, SourceResult] = {}
    profiles = {(p.profile.quantity, p.profile.line, PUBLISHED): p.profile for p in case.columns}
    for source, solve in available.items():
        claimed = {(c.quantity, c.line) for c in case.claims if source in c.between}
        items = [
            item
            for item in case.columns
            if source in METHODS or (item.profile.quantity, item.profile.line) in claimed
        ]

        def solved(source: str = source, solve: Solver = solve, items: Any = items) -> Any:
            solution = solve(case.problem)
            found = [_profile(solution, source, item, case) for item in items]
            profiles.update({(p.quantity, p.line, source): p for p in found})
            return solution

        _, outcomes[source] = attempted(source, solved)
    columns = {(p.profile.quantity, p.profile.line): p for p in case.columns}
    verdicts = []
    for claim in case.claims:
        source, item = claim.between[0], columns[claim.quantity, claim.line]
        if source not in available and source not in METHODS:
            continue
        failure = outcomes[source].failure if source in outcomes else "was not solved"
        if failure is not None:
            verdicts.append((claim, Verdict(Outcome.NO_RESULT, f"{source}: {failure}")))
            continue
        mine = profiles[claim.quantity, claim.line, source]
        left_out = _singular(case.problem, item)
        comparison = compare(mine, item.reference, scale=item.scale, excluded=left_out)
        told = _singular_points(item, left_out) + _departures(item)
        if left_out.all():
            verdicts.append((claim, Verdict(Outcome.NO_RESULT, f"no point to judge{told}")))
            continue
        verdict = judge(comparison, claim.cap)
        verdicts.append((claim, replace(verdict, reason=verdict.reason + told)))
    return CaseResult.of(
        case,
        sources=tuple(outcomes.values()),
        profiles=tuple(profiles.values()),
        verdicts=tuple(verdicts),
        seconds=time.perf_counter() - started,
        published=_published(case),
    )


def failed(case: PublishedCase, reason: str, seconds: float) -> CaseResult:
    """The result of a case that could not be run at all: every claim NO_RESULT, for ``reason``."""
    return CaseResult.failed(case, reason, seconds, published=_published(case))


def _published(case: PublishedCase) -> dict[str, Any]:
    return case.citation | {"columns": [_record(item) for item in case.columns]}


def _record(item: PublishedColumn) -> dict[str, Any]:
    """A published column as the report shows it."""
    return {
        "quantity": item.profile.quantity,
        "line": item.profile.line,
        "file": item.file,
        "column": item.column,
        "coordinate": item.at.coordinate,
        "position": (item.at.along / item.at.in_si).tolist(),
        "position_unit": item.at.unit,
        "text": item.text,
        "rows": item.rows,
        "labels": item.labels,
        "unit": item.unit,
        "to_si": item.to_si,
        "seen": item.seen,
        "departure": (item.departure / item.to_si).tolist(),
        "counted": item.counted.tolist(),
        "scale": item.scale,
    }


def _singular(problem: Problem, item: PublishedColumn) -> NDArray[np.bool_]:
    """The points at which the quantity of a column has no value."""
    local = QUANTITIES[item.profile.quantity].kind in ("pressure", "stress", "strain")
    if not (local and isinstance(problem, PrescribedLoad)):
        return np.zeros(item.at.x.shape, dtype=bool)
    return problem.is_singular(item.at.x, item.at.y, item.at.z)


def _singular_points(item: PublishedColumn, left_out: NDArray[np.bool_]) -> str:
    """Message on the singular points of a column, which are not judged; empty where there are none."""
    if not left_out.any():
        return ""
    rows = ", ".join(f"{v:.6g}" for v in np.unique(item.at.along[left_out] / item.at.in_si))
    what = f"{left_out.sum()} of {left_out.size} values, at {item.at.coordinate} = {rows} {item.at.unit}"
    return f"; {what}, lie on the rim of the load, where {item.profile.quantity} has no value: not judged"


def _departures(item: PublishedColumn) -> str:
    """Message on the listed departures of a column; empty where there are none."""
    if not item.departs.any():
        return ""
    largest = np.abs(item.departure).max() / item.scale
    count = f"{item.departs.sum()} of {item.departs.size} values, listed and not counted"
    return f"; {count}, depart from the exact solution by up to {largest:.2e}"


def _profile(
    solution: ContactSolution | Loading, source: str, item: PublishedColumn, case: PublishedCase
) -> Profile:
    problem = case.problem
    exact = problem.a_h if isinstance(problem, CoatedContact) and problem.homogeneous else None
    value, uncertainty = values(solution, item.profile.quantity, item.at, problem, item.series, exact)
    return replace(item.profile, value=value, source=source, uncertainty=uncertainty)
