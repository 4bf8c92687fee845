"""The baseline: what counts as the same number, what an update keeps, what the command line says."""

import json
from dataclasses import replace

import numpy as np
import pytest
from quick_case import QUICK, coatcheck
from synthetic_results import INFO, STEEL, contact, result_of, run_directory

from verification.cases.case_file import default_cases
from verification.cases.published_file import published_cases
from verification.commands.common.known_folders import BASELINE
from verification.regression.baseline_change import (
    Baseline,
    against,
    case_drift,
    regression,
    regression_json,
    updated,
)
from verification.regression.baseline_file import path_in, points_by_line, read_baseline, write_baseline
from verification.regression.number_drift import RELATIVE, State, drift, measured
from verification.running.case_result import CaseResult, to_json
from verification.running.checked_files import write_checked

E, NU = STEEL
RESULT = result_of(contact((2 * E, NU, 1.0)), text="title = 'stiff'\n")


def baseline_of(*results: CaseResult) -> Baseline:
    return updated(None, results, INFO, "the first", "2026-11-21T10:00:00+00:00")


def changed(result: CaseResult, index: int, by: float, quantity="sigma_xx", line="axis") -> CaseResult:
    """One value of the finite elements moved by ``by`` of the largest magnitude of its profile."""
    profiles = []
    for profile in result.profiles:
        if (profile.quantity, profile.line, profile.source) == (quantity, line, "fem_reference"):
            value = profile.value.copy()
            value[index] += by * np.abs(value).max()
            profile = replace(profile, value=value)
        profiles.append(profile)
    return replace(result, profiles=tuple(profiles))


def drifted(now: CaseResult, then: CaseResult = RESULT) -> list[tuple[str, str, str]]:
    found = case_drift(now, baseline_of(then))
    return [(d.source, d.quantity, d.line) for d in found.drifts if d.state is not State.SAME]


def test_a_run_is_the_same_as_itself_through_the_file(tmp_path):
    write_baseline(tmp_path, baseline_of(RESULT))
    stored = read_baseline(tmp_path)
    assert stored is not None
    found = case_drift(RESULT, stored)
    assert found.state is State.SAME
    # stored to a hundredth of what counts as a change
    assert found.change is not None
    assert 0 < found.change < 0.51e-2 * RELATIVE
    assert found.count(State.SAME) == stored.last.numbers > 5000


@pytest.mark.parametrize(
    ("uncertainty", "by", "state", "beyond"),
    [
        (1e-5, 0.9e-6, State.SAME, False),  # another kernel of the linear algebra moves it so far, within U
        (1e-5, 2e-6, State.DRIFTED, False),
        (1e-7, 0.9e-6, State.DRIFTED, True),
        (1e-12, 0.9e-8, State.DRIFTED, True),
        (1e-12, 0.4e-10, State.SAME, False),
    ],
)
def test_a_change_counts_by_its_uncertainty_and_by_what_a_machine_explains(uncertainty, by, state, beyond):
    value = np.linspace(1.0, 0.5, 22)
    then = replace(measured(RESULT)[0], line="surface", position=np.arange(22.0), value=value, scale=1.0)
    then = replace(then, uncertainty=np.full(22, uncertainty))
    found = drift(then, replace(then, value=value + by * (np.arange(22) == 5)))
    assert (found.state, found.beyond) == (state, beyond)


@pytest.mark.parametrize(
    ("U", "by", "state"),
    [(3.7e-6, 1.14, State.SAME), (3.7e-6, 2.2, State.DRIFTED), (3.7e-5, 1.14, State.DRIFTED)],
)
def test_an_uncertainty_changes_by_no_more_than_values_may(U, by, state):
    then = replace(measured(RESULT)[0], value=np.ones(22), uncertainty=np.full(22, U), scale=1.0)
    then = replace(then, position=np.arange(22.0))
    assert drift(then, replace(then, uncertainty=np.full(22, U * by))).state is state


def test_what_is_not_finite_is_strict_json_and_no_change_where_it_never_was_finite():
    off = changed(RESULT, 0, np.inf)
    assert case_drift(off, baseline_of(RESULT)).state is State.DRIFTED
    json.dumps(regression_json(regression([off], baseline_of(RESULT), "b", INFO)), allow_nan=False)
    assert drifted(changed(RESULT, 0, np.nan), changed(RESULT, 0, np.nan)) == []


def test_cases_and_sources_come_and_go():
    other = replace(RESULT, name="other")
    base = baseline_of(RESULT, other)
    new = replace(RESULT, name="brand_new")
    whole = {c.name: c.state for c in against([RESULT, new], base, whole=True)}
    assert whole == {RESULT.name: State.SAME, "brand_new": State.NEW, "other": State.GONE}
    chosen = {c.name: c.state for c in against([RESULT, new], base, whole=False)}
    assert chosen == {RESULT.name: State.SAME, "brand_new": State.NEW}
    dead = result_of(contact((2 * E, NU, 1.0)), failures={"semianalytic": "no"})
    found = case_drift(dead, base)
    assert found.state is State.GONE
    assert {d.source for d in found.drifts if d.state is State.GONE} == {"semianalytic"}
    assert regression([dead], base, "b", INFO, whole=False).drifted
    assert not regression([RESULT, new], base, "b", INFO, whole=False).drifted
    assert not regression([dead], None, "b", INFO, whole=True).drifted


def test_an_update_keeps_every_reason_with_what_changed(tmp_path):
    write_baseline(tmp_path, baseline_of(RESULT, replace(RESULT, name="other")))
    old = read_baseline(tmp_path)
    now = changed(RESULT, 0, 3e-6)
    write_baseline(tmp_path, updated(old, [now], INFO, "finer", "2026-11-22T10:00:00+00:00"))
    stored = read_baseline(tmp_path)
    assert stored is not None
    assert [u.why for u in stored.history][1:] == ["finer"]
    changes = stored.last.changes
    assert changes[RESULT.name][0] == 1
    assert changes[RESULT.name][1] == pytest.approx(3e-6, rel=1e-3)
    assert changes["other"] == (stored.history[0].numbers // 2, None)
    assert case_drift(now, stored).state is State.SAME
    assert case_drift(RESULT, stored).state is State.DRIFTED


def test_the_command_refuses_in_one_sentence_and_writes_nothing(tmp_path):
    partial = [result_of(contact(), name="01_uncoated_steel", points=9)]
    run_directory(tmp_path / "partial", partial)
    failed = result_of(contact(), name="05_ratio_4", points=9, failures={"hertz": "no"})
    bad = [failed if name == "05_ratio_4" else replace(partial[0], name=name) for name in default_cases()]
    run_directory(tmp_path / "bad", bad)
    before = sorted(tmp_path.rglob("*"))
    for words, said in (
        (["update"], "--why"),
        (["update", "--why", "  "], "--why"),
        (["update", "none", "--why", "x"], "none"),
        (["update", "partial", "--why", "x"], "02_ratio_quarter"),
        (["update", "bad", "--why", "x"], "05_ratio_4"),
    ):
        done = coatcheck("baseline", *words, cwd=tmp_path)
        assert done.returncode == 2
        assert said in done.stderr
        assert len(done.stderr.strip().splitlines()) == 1
    assert sorted(tmp_path.rglob("*")) == before


def test_the_command_updates_from_a_whole_run_and_keeps_the_reason(tmp_path):
    found = result_of(contact(), points=9)
    results = [replace(found, name=name) for name in default_cases()]
    run_directory(tmp_path / "reports", results)
    done = coatcheck("baseline", "update", "--why", "the [bold]first[/]", "-b", "base", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    stored = read_baseline(tmp_path / "base")
    assert sorted(stored.cases) == sorted(default_cases())
    assert [(one.why, one.commit) for one in stored.history] == [("the [bold]first[/]", INFO.commit)]
    # A stored case of another run must not slip in.
    other = replace(results[0], seconds=9.9)
    write_checked(tmp_path / "reports" / "cases" / f"{other.name}.json", to_json(other))
    done = coatcheck("baseline", "update", "--why", "again", "-b", "base", cwd=tmp_path)
    assert done.returncode == 2
    assert "another" in done.stderr


def test_a_run_that_agrees_but_drifted_ends_with_code_5(tmp_path):
    (tmp_path / "quick.toml").write_text(QUICK)
    done = coatcheck("run", "quick.toml", "--json", "--baseline", "base", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout)["baseline"]["recorded"] is None
    from verification.running.stored_run import confirm, read_run

    run = read_run(tmp_path / "reports")
    confirm(run)
    write_baseline(tmp_path / "base", updated(None, run.results, run.info, "first", "2026-11-21"))
    words = ("run", "quick.toml", "--resume", "--baseline", "base", "--json")
    done = coatcheck(*words, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout)["cases"]["quick"]["baseline"] == "same"
    moved = changed_by(run.results[0], 2e-6)
    write_baseline(tmp_path / "base", updated(None, [moved], run.info, "off", "2026-11-21"))
    done = coatcheck(*words, cwd=tmp_path)
    assert done.returncode == 5
    summary = json.loads(done.stdout)
    assert (summary["exit_code"], summary["cases"]["quick"]["outcome"]) == (5, "AGREES")
    assert summary["cases"]["quick"]["baseline"] == "drifted"
    report = json.loads((tmp_path / "reports" / "report.json").read_text())
    assert report["baseline"]["cases"][0]["drifted"] == 1
    said = coatcheck("run", "quick.toml", "--resume", "--baseline", "base", cwd=tmp_path).stdout
    assert "drifted" in next(line for line in said.splitlines() if line.split()[:1] == ["quick"])
    assert "2.0e-6" in " ".join(said.split())
    path_in(tmp_path / "base").write_text("{}")
    done = coatcheck(*words, cwd=tmp_path)
    assert done.returncode == 2
    assert "base/baseline.json.xz" in done.stderr


def changed_by(result: CaseResult, share: float) -> CaseResult:
    first, *others = result.profiles
    return replace(result, profiles=(replace(first, value=first.value * (1 + share)), *others))


def test_the_shipped_baseline_is_whole_small_and_has_its_reasons():
    stored = read_baseline(BASELINE)
    assert stored is not None
    contacts = [name for name, case in stored.cases.items() if not case.published]
    assert set(contacts) == set(default_cases())
    assert set(stored.cases) <= {*default_cases(), *published_cases()}
    assert path_in(BASELINE).stat().st_size < 1_200_000  # 492,000 numbers, 2.4 bytes each
    assert all(update.why and update.when and update.versions for update in stored.history)


def test_numbers_that_could_be_taken_for_others_are_not_stored(tmp_path):
    stored = read_baseline(BASELINE)
    assert stored is not None
    for name, case in stored.cases.items():
        points_by_line(name, case.numbers)
    known = baseline_of(RESULT)
    first, *rest = known.cases[RESULT.name].numbers
    for wrong, message in (
        ([first, first, *rest], "same source, quantity and line"),
        ([first, replace(first, quantity="other", position=first.position + 1.0), *rest], "other points"),
    ):
        case = replace(known.cases[RESULT.name], numbers=tuple(wrong))
        with pytest.raises(ValueError, match=message):
            write_baseline(tmp_path, replace(known, cases={RESULT.name: case}))
