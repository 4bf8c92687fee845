"""One published case from its problem to its verdicts, both methods held against what was printed."""

import time
from collections.abc import Callable, Mapping
from dataclasses import fields, replace
from typing import Any

from verification.limits import towards_limits
from verification.printed import PRINTED, Printed, PublishedCase
from verification.problem import CoatedContact, PrescribedLoad, Solution
from verification.profile import Profile
from verification.quantity import values
from verification.result import CaseResult, SourceResult
from verification.run import describe, diagnostics_of, sentence
from verification.verdict import Outcome, Verdict, compare, judge

__all__ = ["Solver", "failed", "run", "solvers"]

Solver = Callable[[CoatedContact | PrescribedLoad], Solution]


def solvers() -> dict[str, Solver]:
    """Both methods, by name; imported only when a case is run."""
    import fem_reference
    import semianalytic

    def solver(method: Any) -> Solver:
        def solve(problem: CoatedContact | PrescribedLoad) -> Solution:
            if isinstance(problem, PrescribedLoad):
                return method.solve_prescribed(**_arguments(problem))
            return method.solve(**_arguments(problem))

        return solve

    return {
        "semianalytic": solver(semianalytic),
        "fem_reference": lambda problem: towards_limits(problem, solver(fem_reference)),
    }


def run(case: PublishedCase, available: Mapping[str, Solver] | None = None) -> CaseResult:
    """Solve by both methods, take what was printed at the very points, judge every column on every line.

    A method that fails leaves its sentence and NO_RESULT on each of its claims.
    """
    started = time.perf_counter()
    available = solvers() if available is None else available
    outcomes: dict[str, SourceResult] = {}
    profiles = {(p.profile.quantity, p.profile.line, PRINTED): p.profile for p in case.printed}
    for source, solve in available.items():
        begin = time.perf_counter()
        try:
            solution = solve(case.problem)
            found = [_profile(solution, source, item, case) for item in case.printed]
        except Exception as error:  # a failed solve is a row of the report, whatever went wrong
            outcomes[source] = SourceResult(source, time.perf_counter() - begin, sentence(error))
            continue
        seconds, budget = time.perf_counter() - begin, getattr(solution.uncertainty, "budget", ())
        outcomes[source] = SourceResult(source, seconds, None, diagnostics_of(solution.diagnostics), budget)
        profiles |= {(p.quantity, p.line, source): p for p in found}
    printed = {(p.profile.quantity, p.profile.line): p for p in case.printed}
    verdicts = []
    for claim in case.claims:
        source, item = claim.between[0], printed[claim.quantity, claim.line]
        failure = outcomes[source].failure if source in outcomes else "was not asked"
        if failure is not None:
            verdicts.append((claim, Verdict(Outcome.NO_RESULT, f"{source}: {failure}")))
            continue
        mine = profiles[claim.quantity, claim.line, source]
        comparison = compare(mine, item.profile, scale=item.scale, excluded=~item.counted)
        verdicts.append((claim, judge(comparison, claim.cap)))
    return replace(
        _blank(case),
        sources=tuple(outcomes.values()),
        profiles=tuple(profiles.values()),
        verdicts=tuple(verdicts),
        seconds=time.perf_counter() - started,
    )


def failed(case: PublishedCase, reason: str, seconds: float) -> CaseResult:
    """The result of a case that could not be run at all: every claim NO_RESULT, for ``reason``."""
    return replace(
        _blank(case),
        sources=(SourceResult("case", seconds, reason),),
        verdicts=tuple((claim, Verdict(Outcome.NO_RESULT, reason)) for claim in case.claims),
        seconds=seconds,
    )


def _blank(case: PublishedCase) -> CaseResult:
    return CaseResult(
        name=case.name,
        title=case.title,
        source=case.source,
        problem=describe(case.problem),
        sources=(),
        profiles=(),
        verdicts=(),
        seconds=0.0,
        text=case.text,
        published=case.citation | {"printed": [_record(item) for item in case.printed]},
    )


def _record(item: Printed) -> dict[str, Any]:
    """What the report needs to show a column as it was printed."""
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
        "counted": item.counted.tolist(),
        "scale": item.scale,
    }


def _profile(solution: Solution, source: str, item: Printed, case: PublishedCase) -> Profile:
    value, spread = values(solution, item.profile.quantity, item.at, case.problem)
    return replace(item.profile, value=value, source=source, uncertainty=spread)


def _arguments(problem: CoatedContact | PrescribedLoad) -> dict[str, Any]:
    return {f.name: getattr(problem, f.name) for f in fields(problem)}
