"""The engine of a study on made-up answers: nothing lost, nothing solved twice, the same table always."""

from pathlib import Path

import numpy as np
import pyarrow.parquet as pq
import pytest
from quick_case import solved_here
from synthetic_solves import FAILING, STUDY, made_up

from verification.study import study_engine
from verification.study.study_engine import run_study
from verification.study.study_plan import parse_study
from verification.study.study_point import answer
from verification.study.study_table import COLUMNS, read_columns

SOLVES = 6 + 2 * 3  # curves and their checks


def plan(**replaced):
    text = STUDY
    for old, new in replaced.items():
        text = text.replace(f"{old} = ", f"{old} = {new} #")
    return parse_study(text.encode(), Path("made_up.toml"))


@pytest.fixture(autouse=True)
def asked(monkeypatch):
    """The requests that were answered so far, by made-up answers in this process."""
    found = []

    def solve(request):
        found.append(request)
        return made_up(request)

    monkeypatch.setattr(study_engine, "answer", solve)
    monkeypatch.setattr(study_engine, "run_tasks", solved_here)
    return found


def test_every_point_is_a_row_with_its_full_input(tmp_path):
    came = run_study(plan(), tmp_path, 1)
    assert (came.points, came.rows, came.done, came.kept, came.failed) == (12, 12 + 2 * 6, SOLVES, 0, 0)
    assert came.complete
    found = read_columns(came.table)
    assert list(found) == COLUMNS.names
    curve = found["source"] == "semianalytic"
    assert found["point"][curve].tolist() == list(range(12))
    assert found["friction"][curve].tolist() == [0.0, 0.25] * 6
    assert found["thickness"][curve].tolist() == [2e-5, 2e-5, 4e-5, 4e-5, 8e-5, 8e-5] * 2
    assert found["coating_E"][curve].tolist() == [105e9] * 6 + [420e9] * 6
    checked = found["source"] == "fem_reference"
    assert found["point"][checked].tolist() == [0, 1, 4, 5, 10, 11]
    assert np.isnan(found["sigma_xx_base_x"]).all()
    assert b"Made up" in pq.read_schema(came.table).metadata[b"coatcheck_study"]


def test_order_of_the_answers_leaves_no_trace(tmp_path, monkeypatch):
    one = run_study(plan(), tmp_path / "one", 1)
    backwards = lambda tasks, **callbacks: solved_here(tasks[::-1], **callbacks)  # noqa: E731
    monkeypatch.setattr(study_engine, "run_tasks", backwards)
    assert run_study(plan(), tmp_path / "two", 1).table.read_bytes() == one.table.read_bytes()


def test_study_goes_on_where_it_stopped_and_solves_nothing_twice(tmp_path, asked):
    whole = run_study(plan(), tmp_path / "whole", 1).table.read_bytes()
    asked.clear()

    class Stop(Exception):
        pass

    def stop(source, done, total):
        if done >= 4:
            raise Stop

    with pytest.raises(Stop):
        run_study(plan(), tmp_path, 1, report=stop)
    stored = len(asked)
    assert read_columns(tmp_path / "made_up.parquet")["point"].tolist() == [0, 1, 2, 3]
    again = run_study(plan(), tmp_path, 1)
    assert (again.kept, again.done, len(asked)) == (stored, SOLVES - stored, SOLVES)
    assert again.table.read_bytes() == whole
    again.table.unlink()
    last = run_study(plan(), tmp_path, 1)
    assert (last.kept, last.done, len(asked)) == (SOLVES, 0, SOLVES)
    assert last.table.read_bytes() == whole


def test_identical_points_are_solved_once(tmp_path, asked):
    came = run_study(plan(thickness="[4e-5, 4e-5, 4e-5]"), tmp_path, 1)
    assert came.rows == 12 + 12  # all three checked points of each modulus are one solve
    assert len(asked) == came.done == 2 + 2 * 2
    assert run_study(plan(thickness="[4e-5, 8e-5]", cross_check="0"), tmp_path, 1).kept == 2


@pytest.mark.parametrize("damage", ["flip", "cut", "swap", "empty"])
def test_damage_to_the_cache_is_noticed_named_mended(tmp_path, asked, damage):
    content = run_study(plan(), tmp_path, 1).table.read_bytes()
    files = sorted((tmp_path / "cache").rglob("*.json"))
    raw = bytearray(files[3].read_bytes())
    if damage == "flip":
        raw[len(raw) // 2] ^= 4
    elif damage == "swap":
        raw = bytearray(files[4].read_bytes())  # whole, but the answer to another request
    files[3].write_bytes(raw[: {"cut": len(raw) // 2, "empty": 0}.get(damage, len(raw))])
    again = run_study(plan(), tmp_path, 1)
    assert (again.done, len(asked)) == (1, SOLVES + 1)
    assert [str(files[3]) in message for message in again.damaged] == [True]
    assert again.table.read_bytes() == content


def test_a_point_that_fails_is_a_row_with_its_sentence(tmp_path):
    study = plan(thickness=f"[4e-5, {FAILING}]", cross_check="0")
    came = run_study(study, tmp_path, 1)
    found = read_columns(came.table)
    failed = found["status"] == "failed"
    assert failed.tolist() == [False, False, True, True] * 2
    assert came.failed == 4
    assert len(set(found["failure"][failed])) == 1
    assert np.isnan(found["peak_pressure"][failed]).all()
    assert np.isfinite(found["peak_pressure"][~failed]).all()
    # it is an answer like any other: not asked for again
    assert run_study(study, tmp_path, 1).done == 0


def test_what_a_process_could_not_answer_is_a_row_now_tried_again_later(tmp_path, monkeypatch):
    def crashing(tasks, *, finished, **_):
        for task in tasks:
            finished(task.name, task.failed("it crashed", 0.0))

    with monkeypatch.context() as patch:
        patch.setattr(study_engine, "run_tasks", crashing)
        came = run_study(plan(), tmp_path, 1)
    assert (came.failed, came.done) == (came.rows, 0)
    assert set(read_columns(came.table)["failure"]) == {"it crashed"}
    again = run_study(plan(), tmp_path, 1)
    assert (again.failed, again.done) == (0, SOLVES)


def test_a_solver_that_raises_answers_with_its_sentence():
    request = next(plan().solves()).request
    found = answer(request | {"numerics": {"patches": 20}})
    assert {row["status"] for row in found["rows"]} == {"failed"}
    assert all("patches = 20" in row["failure"] for row in found["rows"])
