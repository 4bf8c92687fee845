"""What is judged is pinned: each way to judge less that a planted mistake may take is noticed."""

import json
from dataclasses import replace
from pathlib import Path

import pytest
from faults_planted.fault_anchor import Change
from faults_planted.fault_planting import planted
from quick_case import QUICK, coatcheck

from verification.cases.case_file import parse_case
from verification.cases.toml_file import CaseError
from verification.credibility.self_tests import self_tests
from verification.credibility.self_tests.known_outputs import ELSEWHERE, HERE
from verification.credibility.self_tests.known_runs import MATERIAL, ran
from verification.credibility.self_tests.stand_ins import Stated
from verification.regression.baseline_change import regression, updated
from verification.regression.baseline_file import write_baseline
from verification.running.case_result import CaseResult
from verification.running.stored_run import read_run

DECIDE = "verification.running:decide"
TENFOLD = Change(
    DECIDE,
    "compare(a, b, scale=scale, excluded=excluded)",
    "compare(a, b, scale=(1 if claim.line == 'contact' else 10) * scale, excluded=excluded)",
)
DEPTHS = (
    "bounds = np.array([0.0, *problem.interfaces, max(4 * a, *(2 * z for z in problem.interfaces), 0.0)])"
)
ZONE = "np.abs(np.abs(a.position) - edge) < claim.edge * edge"


def run() -> CaseResult:
    true = Stated(*MATERIAL)
    return ran(None, True, semianalytic=true, fem_reference=true)


@pytest.fixture(scope="module")
def recorded():
    return updated(None, [run()], HERE, "known", "2026-11-22")


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (TENFOLD, "1.90986e+10"),
        (Change(DECIDE, "claim.cap", "max(claim.cap, 0.05)"), "0.05"),
        (Change(DECIDE, ZONE, "a.position < 0"), "first"),
        (Change(DECIDE, ZONE, "(a.position > 1.5 * edge) & (claim.line == 'axis')"), "axis"),
        (Change(DECIDE, "claim.edge * edge", "0.12 * edge"), "points"),
        (Change("verification.sampling:_depths", DEPTHS, f"a *= 0.4; {DEPTHS}"), "axis"),
        (
            Change(
                "verification.judging.invariants:_of_body",
                'yield "symmetry", partial(mirror_symmetry.symmetry, *subject)',
                "pass",
            ),
            "semianalytic",
        ),
        (
            Change(
                "verification.running:judge_case",
                "check(solution, source, case.problem)",
                "check(solution, source, case.problem) if source == 'semianalytic' else ()",
            ),
            "fem_reference",
        ),
    ],
)
def test_less_that_is_judged_is_a_failure_on_any_machine(recorded, change, message):
    assert regression([run()], recorded, "b", ELSEWHERE).judged == ()
    with planted((change,)):
        result = run()
    assert result.outcome == "AGREES"
    found = regression([result], recorded, "b", ELSEWHERE)
    assert any(message in row.message for row in found.less), found.less


def test_a_case_that_claims_nothing_is_refused(tmp_path):
    with (
        planted(
            (Change("verification.judging:standard_claims", "(*claims, *_off_plane(problem, pairs))", "()"),)
        ),
        pytest.raises(CaseError, match="judged"),
    ):
        parse_case(QUICK.partition("[[claim]]")[0].encode(), Path("quick.toml"))


def test_a_run_that_judges_less_ends_with_code_6_and_says_so_first(tmp_path):
    (tmp_path / "quick.toml").write_text(QUICK)
    assert coatcheck("run", "quick.toml", "-b", "base", cwd=tmp_path).returncode == 0
    stored = read_run(tmp_path / "reports")
    answers = {test.name: test.answers for test in self_tests()}
    known = updated(None, stored.results, stored.info, "first", "2026-11-22", answers)
    write_baseline(tmp_path / "base", known)
    words = ("run", "quick.toml", "--resume", "-b", "base")
    done = coatcheck(*words, cwd=tmp_path)
    assert (done.returncode, "manifest:" in done.stdout) == (0, False)

    case = known.cases["quick"]
    (group,) = case.manifest.comparisons

    def record(times: float) -> None:
        """A baseline whose cap of the one comparison is another."""
        other = replace(group, judged=replace(group.judged, cap=group.judged.cap * times))
        manifest = replace(case.manifest, comparisons=(other,))
        write_baseline(tmp_path / "base", replace(known, cases={"quick": replace(case, manifest=manifest)}))

    record(0.5)
    done = coatcheck(*words, cwd=tmp_path)
    assert done.returncode == 6
    assert "manifest:" in done.stdout
    page = (tmp_path / "reports" / "report.html").read_text()
    assert "contact: cap" in page.partition('id="first"')[2].partition('class="page')[0]
    assert 'name="manifest"' in (tmp_path / "reports" / "junit.xml").read_text()
    assert json.loads((tmp_path / "reports" / "report.json").read_text())["baseline"]["manifest"][0]["less"]

    record(2.0)
    assert coatcheck(*words, cwd=tmp_path).returncode == 0
