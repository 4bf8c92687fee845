"""Convergence of the methods: the references are right, their errors fall, what fails is a message."""

import json
from dataclasses import replace
from functools import partial
from importlib import import_module

import numpy as np
import pytest
from quick_case import QUICK, solved_here
from synthetic_study import study

from verification.commands import run as command
from verification.commands.common import named_files, task_progress
from verification.credibility import accuracy_study as accuracy_study
from verification.credibility.accuracy_study import BARE, to_json
from verification.credibility.refinement_studies import order_of, refined_grid
from verification.judging.outcome import Outcome
from verification.regression.run_exit_codes import EXIT
from verification.running.checked_files import StoreError, write_checked
from verification.sources.method_sources import solve_semianalytic


def test_level_that_fails_is_a_sentence_and_the_coarser_ones_stay():
    import semianalytic

    def stops(problem, numerics):
        if numerics["patches"] > 33:
            raise semianalytic.NotConverged("not settled after 3 iterations;\n raise max_iterations")
        return solve_semianalytic(problem, numerics)

    found = refined_grid(BARE, (33, 65, 129), solve=stops)
    assert [level.name for level in found.levels] == ["N = 33"]
    assert found.failure.startswith("N = 65: ")


@pytest.mark.slow
def test_study_goes_on_where_a_part_of_it_fails(monkeypatch):
    def broken(*_, **__):
        raise ValueError("no grid fits")

    good = refined_grid(BARE, (33,))
    monkeypatch.setattr(accuracy_study, "refined_grid", lambda *_, **__: good)
    failed = replace(good, failure="fine: no mesh")
    monkeypatch.setattr(accuracy_study, "refined_mesh", lambda *_, **__: failed)
    monkeypatch.setattr(accuracy_study, "discs_of", broken)
    found = accuracy_study.measure()
    assert len(found.refinements) == 9
    assert len(found.failures) == 4


@pytest.mark.parametrize(
    ("resolution", "errors", "order"),
    [
        ((10, 20, 40, 80), [7 * n**-2.5 for n in (10, 20, 40, 80)], pytest.approx(2.5, abs=1e-12)),
        # another parameter takes over
        ((10, 20, 40, 80, 160), [1e-2, 1e-4, 1e-6, 1e-6, 1e-6], pytest.approx(np.log(1e4) / np.log(4))),
        # the third error crosses zero; the fourth shows what the grid is good for
        ((10, 20, 40, 80), [1e-2, 2.5e-3, 1e-9, 1.6e-4], pytest.approx(2.0, abs=0.3)),
        # within less than a doubling
        ((41, 49, 65, 129), [2e-7, 1e-8, 1e-8, 1e-8], None),
        ((10,), [1e-3], None),
        ((10, 20), [1e-3, 0.9e-3], None),
        ((10, 20), [1e-3, np.nan], None),
        ((10, 20), [0.0, 0.0], None),
        ((10, 20), [1e-5, 1e-3], None),
    ],
)
def test_order_is_that_of_the_errors_that_fall(resolution, errors, order):
    assert order_of(resolution, errors) == order


def test_study_is_kept_for_the_very_same_code_only(tmp_path, monkeypatch):
    whole = study()
    path = accuracy_study.path_in(tmp_path)
    for found, code, kept in (
        (whole, whole.made_by, True),
        (whole, "b28aa40c1d2e", False),
        (study("order 3: no mesh"), whole.made_by, False),
    ):
        write_checked(path, to_json(found))
        monkeypatch.setattr(accuracy_study, "fingerprint", lambda code=code: code)
        assert (accuracy_study.stored(tmp_path) == found) is kept
    path.write_bytes(path.read_bytes()[:-100])
    with pytest.raises(StoreError, match=r"accuracy\.json: "):
        accuracy_study.stored(tmp_path)
    assert accuracy_study.stored(tmp_path / "elsewhere") is None


@pytest.fixture
def one_case(tmp_path, monkeypatch):
    """Arguments of a run whose shipped cases are one that takes no method, beside no baseline."""
    case = tmp_path / "quick.toml"
    case.write_text(QUICK)
    monkeypatch.setattr(named_files, "default_cases", lambda: {"quick": case})
    return {"quiet": True, "baseline": tmp_path / "none", "records": tmp_path / "none"}


@pytest.mark.slow
def test_study_that_fails_is_a_sentence_of_the_report_and_no_verdict(one_case, tmp_path, monkeypatch):
    whole = accuracy_study.task

    def broken(folder):
        return replace(whole(folder), work=partial(import_module, "verification.no_such_module"))

    monkeypatch.setattr(accuracy_study, "task", broken)
    assert (
        command.run(output=tmp_path / "all", **one_case) == EXIT[Outcome.NO_RESULT]
    )  # of the judged studies
    assert "verification.no_such_module" in (tmp_path / "all" / "report.html").read_text()
    report = json.loads((tmp_path / "all" / "report.json").read_text())
    assert report["accuracy"]["failures"]
    assert [c["outcome"] for c in report["cases"]] == ["AGREES"]

    # A run of chosen cases measures no convergence.
    monkeypatch.setattr(task_progress, "run_tasks", solved_here)
    assert command.run("quick", output=tmp_path / "one", **one_case) == 0
    assert 'id="semi-analytical-accuracy"' not in (tmp_path / "one" / "report.html").read_text()
    assert json.loads((tmp_path / "one" / "report.json").read_text())["accuracy"] is None


def test_resumed_run_keeps_the_study(one_case, tmp_path, monkeypatch):
    monkeypatch.setattr(task_progress, "run_tasks", solved_here)
    monkeypatch.setattr(accuracy_study, "stored", lambda folder: study())
    monkeypatch.setattr(accuracy_study, "task", lambda folder: pytest.fail("measured again"))
    command.run(output=tmp_path / "out", resume=True, **one_case)  # the errors of the stand-in are judged
    assert 'id="finite-element-accuracy"' in (tmp_path / "out" / "report.html").read_text()
