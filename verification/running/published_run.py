"""One published case from its problem to its verdicts."""

import time
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from verification.cases.published_file import PublishedCase
from verification.cases.published_table import PublishedColumn
from verification.judging.verdict import Outcome, Verdict, compare, judge
from verification.problem.array_types import Array
from verification.problem.coated_contact import (
    CoatedContact,
    PrescribedLoad,
    Solution,
    relative_to_edge,
    stress_with_uncertainty,
)
from verification.problem.line_profile import Profile
from verification.problem.loading_curve import Problem
from verification.problem.quantity import QUANTITIES
from verification.running.case_result import CaseResult, SourceResult, diagnostics_of, message_of
from verification.sampling.largest_tension import BESIDE
from verification.sampling.point_values import values
from verification.sources.loading_solution import Loading
from verification.sources.source_record import Solver
from verification.sources.source_registry import CLOSED, METHODS, PUBLISHED, solvers


@dataclass(frozen=True, eq=False)
class BesideEdge:
    """``solution`` with points within ``BESIDE`` of the exact ``edge`` [m] at the same x/a of its own.

    At a fixed x next to the edge an error da of the radius changes the pressure by q sqrt(2 da/a), whatever
    the method; the radius is a quantity of its own.
    """

    solution: Solution
    edge: float

    def __getattr__(self, name: str) -> Any:
        return getattr(self.solution, name)

    def pressure(self, x: ArrayLike, y: ArrayLike = 0.0) -> Array:
        """As of the solution."""
        _, ratio = self._near(x, y, 0.0)
        return self.solution.pressure(np.asarray(x) * ratio, np.asarray(y) * ratio)

    def pressure_uncertainty(self, x: ArrayLike, y: ArrayLike = 0.0) -> Array:
        """As of the solution; of its view relative to the edge beside it."""
        near, ratio = self._near(x, y, 0.0)
        x, y = np.asarray(x) * ratio, np.asarray(y) * ratio
        relative = relative_to_edge(self.solution).pressure_uncertainty(x, y)
        return np.where(near, relative, self.solution.pressure_uncertainty(x, y))

    def stress(self, x: ArrayLike, y: ArrayLike, z: ArrayLike, layer: int | None = None) -> Array:
        """As of the solution."""
        _, ratio = self._near(x, y, z)
        return self.solution.stress(np.asarray(x) * ratio, np.asarray(y) * ratio, z, layer)

    def stress_uncertainty(self, x: ArrayLike, y: ArrayLike, z: ArrayLike, layer: int | None = None) -> Array:
        """As ``pressure_uncertainty``."""
        near, ratio = self._near(x, y, z)
        place = np.asarray(x) * ratio, np.asarray(y) * ratio, z
        relative = relative_to_edge(self.solution)
        _, U = stress_with_uncertainty(self.solution, *place, layer=layer)
        assert U is not None
        if not near.any() or relative is self.solution:
            return U
        _, beside = stress_with_uncertainty(relative, *place, layer=layer)
        assert beside is not None
        return np.where(near, beside, U)

    def _near(self, x: ArrayLike, y: ArrayLike, z: ArrayLike) -> tuple[Array, Array]:
        """Which points are beside the edge, and the factor on x and y."""
        x, y, z = np.broadcast_arrays(*(np.asarray(v, dtype=float) for v in (x, y, z)))
        near = np.hypot(np.hypot(x, y) - self.edge, z) <= BESIDE * self.edge
        return near, np.where(near, float(self.solution.contact_radius) / self.edge, 1.0)


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
        begin = time.perf_counter()
        try:
            solution = solve(case.problem)
            if isinstance(case.problem, CoatedContact) and case.problem.homogeneous:
                solution = BesideEdge(solution, case.problem.a_h)
            claimed = {(c.quantity, c.line) for c in case.claims if source in c.between}
            found = [
                _profile(solution, source, item, case)
                for item in case.columns
                if source in METHODS or (item.profile.quantity, item.profile.line) in claimed
            ]
        except Exception as error:  # a failed solve is a row of the report, whatever went wrong
            outcomes[source] = SourceResult(source, time.perf_counter() - begin, message_of(error))
            continue
        seconds, budget = time.perf_counter() - begin, getattr(solution.uncertainty, "budget", ())
        outcomes[source] = SourceResult(source, seconds, None, diagnostics_of(solution.diagnostics), budget)
        profiles |= {(p.quantity, p.line, source): p for p in found}
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
    solution: Solution | Loading, source: str, item: PublishedColumn, case: PublishedCase
) -> Profile:
    value, uncertainty = values(solution, item.profile.quantity, item.at, case.problem, item.series)
    return replace(item.profile, value=value, source=source, uncertainty=uncertainty)
