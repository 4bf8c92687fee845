"""Two runs side by side: what is told of verdicts, numbers, versions, times."""

import json
from dataclasses import replace
from functools import partial
from pathlib import Path

from quick_case import coatcheck
from synthetic_results import INFO, STEEL, contact, result_of, run_directory

from verification.judging.verdict import Outcome
from verification.regression.number_drift import State
from verification.regression.run_comparison import compare_runs
from verification.running.case_result import CaseResult, RunInfo
from verification.running.stored_run import StoredRun

E, NU = STEEL
GOOD = result_of(contact((2 * E, NU, 1.0)), name="stiff", points=33)
WRONG = result_of(
    contact((2 * E, NU, 1.0)),
    name="stiff",
    points=33,
    errors={"semianalytic": 2e-3},
    stated={"semianalytic": 0.7},
)


def run_of(*results: CaseResult, info: RunInfo = INFO) -> StoredRun:
    return StoredRun(Path("somewhere/report.json"), info, results)


def test_a_run_beside_itself_shows_nothing():
    found = compare_runs(run_of(GOOD), run_of(GOOD))
    assert (found.drifted, found.worse, found.verdicts, found.versions) == (False, False, (), ())
    assert found.seconds == (("stiff", 3.4, 3.4),)


def test_verdicts_that_changed_are_told_with_the_worse_ones_first():
    found = compare_runs(run_of(GOOD), run_of(WRONG))
    assert found.worse
    assert {c.before for c in found.verdicts} == {Outcome.AGREES}
    assert {c.after for c in found.verdicts} == {Outcome.DISAGREES, Outcome.INCONCLUSIVE}
    assert all(c.worse and "semianalytic" in c.between for c in found.verdicts)
    better = compare_runs(run_of(WRONG), run_of(GOOD))
    assert better.verdicts
    assert not better.worse


def test_cases_versions_and_times_of_one_run_only_are_told():
    other = replace(GOOD, name="other", seconds=1.5)
    info = replace(INFO, versions={**INFO.versions, "numpy": "2.5.0", "extra": "1"}, commit="0123456789ab")
    found = compare_runs(run_of(GOOD, other), run_of(GOOD, replace(GOOD, name="new"), info=info))
    assert {c.name: c.state for c in found.cases} == {
        "stiff": State.SAME,
        "other": State.GONE,
        "new": State.NEW,
    }
    assert ("other", 1.5, None) in found.seconds
    assert dict((name, (then, now)) for name, then, now in found.versions) == {
        "commit": (INFO.commit, "0123456789ab"),
        "numpy": ("2.4.0", "2.5.0"),
        "extra": ("none", "1"),
    }
    # what only one of them ran is told by its numbers
    assert found.drifted
    assert found.verdicts == ()


def test_the_command_says_it_by_code_and_by_words(tmp_path):
    run_directory(tmp_path / "a", [GOOD])
    run_directory(tmp_path / "b", [WRONG])
    compare = partial(coatcheck, "compare", cwd=tmp_path)
    assert compare("a", "a").returncode == 0
    worse = compare("a", "b")
    assert worse.returncode == 1
    assert "DISAGREES" in worse.stdout
    back = compare("b", "a", "--json")
    assert back.returncode == 5
    assert json.loads(back.stdout)["worse"] is False
    gone = compare("a", "c")
    assert gone.returncode == 2
    assert "cannot" in gone.stderr
    assert len(gone.stderr.strip().splitlines()) == 1
