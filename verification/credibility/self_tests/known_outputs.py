"""Outputs of a run, from made-up results: comparison with the baseline, exit code, JUnit XML."""

from collections.abc import Mapping
from dataclasses import replace
from itertools import pairwise
from typing import Any
from xml.etree.ElementTree import fromstring

import numpy as np

from verification.credibility.self_tests.stand_ins import Answers
from verification.judging.invariant_verdict import Invariant
from verification.judging.verdict import Claim, Judged, Outcome, Verdict
from verification.problem.line_profile import Profile
from verification.regression.baseline_change import Regression, regression, updated
from verification.regression.junit_xml import junit_xml
from verification.regression.manifest import ManifestDifference, differences, manifest_of
from verification.regression.run_exit_codes import run_code
from verification.running.case_result import CaseResult, RunInfo, SourceResult

HERE = RunInfo("known", "2026-01-01T00:00:00+00:00", 1.0, 1, None, "here", {})
ELSEWHERE = replace(HERE, machine="elsewhere")
JUDGED = Judged(1e-3, 1e9, 5, (-1.0, 1.0), 0.5)
CODES = {Outcome.AGREES: 0, Outcome.DISAGREES: 1, Outcome.NO_RESULT: 3, Outcome.INCONCLUSIVE: 4}


def _result(
    outcome: Outcome = Outcome.AGREES, judged: Judged = JUDGED, kept: int = 2, **changes: Any
) -> CaseResult:
    """A case of two sources, a line of five points and two invariants, of which ``kept`` are left."""
    x = np.linspace(-1.0, 1.0, 5)
    stress = [Profile("sigma_xx", "surface", x, 1e9 * x, s, np.full(5, 1e4)) for s in ("one", "two")]
    radius = Profile("contact_radius", "contact", np.zeros(1), np.array([0.7]), "one", np.zeros(1))
    profiles = (*stress, radius)
    claims = [Claim(q, "surface", ("one", "two"), 1e-3, "known") for q in ("sigma_xx", "sigma_yy")]
    verdict = Verdict(outcome, "known", 1e-6, 1e-5, 1e-5, 0.0, judged)
    invariants = tuple(
        Invariant("symmetry", s, 1e-6, 1e-5, Outcome.AGREES, "known", 5e-3, 7, 1e-5) for s in ("one", "two")
    )
    sources = (SourceResult("one", 1.0), SourceResult("two", 1.0))
    verdicts = tuple((claim, verdict) for claim in claims)[:kept]
    result = CaseResult("known", "known", "", {}, sources, profiles, verdicts, 1.0)
    return replace(result, **({"invariants": invariants[:kept]} | changes))


def _changed(value: float = 0.0, U: float = 1.0) -> CaseResult:
    """One value of the second source moved by ``value`` [Pa], its uncertainty multiplied by ``U``."""
    result = _result()
    first, second, radius = result.profiles
    at = np.arange(5) == 3
    assert second.uncertainty is not None
    moved = replace(second, value=second.value + value * at, uncertainty=second.uncertainty * (U * at + ~at))
    return replace(result, profiles=(first, moved, radius))


def _beside(result: CaseResult, info: RunInfo = HERE, tests: Mapping[str, int] | None = None) -> Regression:
    known = updated(None, [_result()], HERE, "known", "2026-01-01", {"a part": 3})
    return regression([result], known, "known", info, whole=True, self_tests=tests or {"a part": 3})


def of_regression() -> Answers:
    """U is 1e4 Pa, the scale 1e9 Pa."""
    for what, result, here, elsewhere in (
        ("the same numbers", _result(), False, False),
        ("a value off by 5 Pa", _changed(5.0), False, False),
        ("a value off by 50 Pa, as another kernel may cause", _changed(50.0), False, False),
        ("a value off by half its U", _changed(-5e3), True, False),
        ("a value off by 1.5 U", _changed(-1.5e4), True, True),
        ("a value that is NaN", _changed(np.nan), True, True),
        ("a U twice as large", _changed(U=2.0), True, False),
        ("a U half as large", _changed(U=0.5), True, False),
        ("a U five times as large", _changed(U=5.0), True, True),
        ("a U that is NaN", _changed(U=np.nan), True, True),
        ("a source that is gone", replace(_result(), profiles=_result().profiles[::2]), True, True),
    ):
        yield f"{what}, here", _beside(result).unexplained, here
        yield f"{what}, elsewhere", _beside(result, ELSEWHERE).unexplained, elsewhere
    for what, change, less in (
        ("a cap", {"cap": 2e-3}, True),
        ("a scale", {"scale": 1e10}, True),
        ("points", {"points": 4}, True),
        ("the first point", {"extent": (0.0, 1.0)}, True),
        ("the last point", {"extent": (-1.0, 0.5)}, True),
        ("a gap", {"gap": 0.6}, True),
        ("a cap of one per cent more", {"cap": 1.01e-3}, True),
        ("a narrower cap", {"cap": 5e-4}, False),
        ("a narrower scale", {"scale": 1e8}, False),
        ("more points", {"points": 6}, False),
        ("a longer line", {"extent": (-2.0, 1.0)}, False),
    ):
        found = _beside(_result(judged=replace(JUDGED, **change)), ELSEWHERE).judged
        yield f"{what} changed", [(row.less, row.count) for row in found], [(less, 2)]
    rows: list[bool]
    for what, change, rows in (
        ("a cap", {"cap": 6e-3}, [True]),
        ("residuals", {"points": 6}, [True]),
        ("a bound five times as large", {"widest": 5e-5}, [True]),
        ("a bound three times as large", {"widest": 3e-5}, []),
        ("more residuals", {"points": 8}, [False]),
    ):
        first, second = _result().invariants
        found = _beside(_result(invariants=(first, replace(second, **change))), ELSEWHERE).judged
        yield f"{what} of an invariant changed", [row.less for row in found], rows
    for what, counted, less in (("fewer", (True, False), True), ("more", (True, True, True), False)):
        tables = {"tables": [], "columns": [{"counted": [True, True]}]}
        now = _result(published=tables | {"columns": [{"counted": list(counted)}]})
        found = differences(now, manifest_of(_result(published=tables)))
        yield f"{what} published values that count", [row.less for row in found], [less]
    for what, changed, count in (
        ("nothing", _result(), 0),
        ("a comparison and an invariant", _result(kept=1), 2),
        ("all of them", _result(kept=0), 4),
        ("a source", _result(sources=(SourceResult("one", 1.0),)), 1),
        ("the case", _result(name="another"), 1),
    ):
        found = _beside(changed, ELSEWHERE).less
        yield f"{what} missing", sum(row.count for row in found), count
    for name, tests, less in (("fewer", {"a part": 2}, True), ("more", {"a part": 4}, False)):
        found = _beside(_result(), ELSEWHERE, tests).judged
        yield f"{name} answers of a self-test", [row.less for row in found], [less]


def of_codes() -> Answers:
    fine = Regression("known", None, ())
    for outcome, code in CODES.items():
        yield f"code of {outcome}", run_code([_result(), _result(outcome)], fine, passed=True), code
    order = [Outcome.AGREES, Outcome.INCONCLUSIVE, Outcome.NO_RESULT, Outcome.DISAGREES]
    for better, worse in pairwise(order):
        code = run_code([_result(worse), _result(better)], fine, passed=True)
        yield f"{worse} beside {better}", code, CODES[worse]
    yield "no case", run_code([], fine, passed=True), 3
    yield "a case that judges nothing", run_code([_result(kept=0)], fine, passed=True), 3
    yield "a self-test that failed", run_code([_result()], fine, passed=False), 1
    less = Regression("known", None, (), judged=(ManifestDifference("known", "fewer", 1, True),))
    more = Regression("known", None, (), judged=(ManifestDifference("known", "more", 1, False),))
    yield "less judged", run_code([_result()], less, passed=True), 6
    yield "more judged", run_code([_result()], more, passed=True), 0
    yield "less judged, not converged", run_code([_result(Outcome.NO_RESULT)], less, passed=True), 3
    moved, far = _changed(5e3), _changed(1.5e4)
    yield "drifted here", run_code([moved], _beside(moved), passed=True), 5
    yield "drifted within U elsewhere", run_code([moved], _beside(moved, ELSEWHERE), passed=True), 0
    yield "drifted beyond U elsewhere", run_code([far], _beside(far, ELSEWHERE), passed=True), 5


def of_junit() -> Answers:
    def counted(*outcomes: Outcome, beside: Regression | None = None, **tests: str) -> tuple[int, ...]:
        root = fromstring(junit_xml([_result(o) for o in outcomes], HERE, beside, tests))
        elements = ("testcase", "failure", "error")
        written = tuple(int(root.get(name, "-1")) for name in ("tests", "failures", "errors"))
        return written if written == tuple(len(root.findall(f".//{e}")) for e in elements) else (-1, -1, -1)

    yield "all agree", counted(Outcome.AGREES), (4, 0, 0)
    yield "two disagree", counted(Outcome.DISAGREES), (4, 2, 0)
    yield "two are inconclusive", counted(Outcome.AGREES, Outcome.INCONCLUSIVE), (8, 2, 0)
    yield "two have no result", counted(Outcome.NO_RESULT), (4, 0, 2)
    yield "a self-test", counted(Outcome.AGREES, one="", two="wrong"), (6, 1, 0)
    yield "baseline and manifest", counted(Outcome.AGREES, beside=_beside(_result())), (6, 0, 0)
    far, fewer = _beside(_changed(1.5e4), ELSEWHERE), _beside(_result(judged=replace(JUDGED, points=4)))
    yield "a number that moved", counted(Outcome.AGREES, beside=far), (6, 1, 0)
    yield "less judged", counted(Outcome.AGREES, beside=fewer), (6, 1, 0)
    broken = replace(_result().invariants[0], outcome=Outcome.DISAGREES)
    text = junit_xml([_result(invariants=(broken,))], HERE)
    yield "an invariant that is broken", fromstring(text).get("failures"), "1"
    yield "a case that judges nothing", fromstring(junit_xml([_result(kept=0)], HERE)).get("errors"), "1"
