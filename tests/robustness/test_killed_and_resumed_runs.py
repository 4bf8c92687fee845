"""Runs that are killed and resumed, or repeated, give the same numbers, to the last bit."""

import time
from pathlib import Path

import pytest
from case_texts import case_text
from kill_runs import cases_of, disturbed, resumed

from verification.cases.case_file import read_case
from verification.running.case_tasks import case_task
from verification.running.pool.process_pool import run_tasks

QUICK = case_text(
    "E = 420e9; nu = 0.25; thickness_over_a_h = 0.8",
    more="friction = 0.1",
    tables='[semianalytic]\npatches = 65\n[fem_reference]\nquality = "fast"\n',
)


def quick_cases(folder: Path, number: int) -> tuple[str, ...]:
    for n in range(number):
        (folder / f"quick-{n}.toml").write_text(QUICK.replace("420e9", f"{n + 1}00e9"))
    return tuple(str(folder / f"quick-{n}.toml") for n in range(number))


@pytest.mark.slow
def test_runs_killed_and_resumed_lose_nothing_and_end_with_the_same_numbers(tmp_path):
    cases, began = quick_cases(tmp_path, 4), time.perf_counter()
    assert resumed(tmp_path / "calm", cases, 2).wait() in (0, 4)
    quarter = (time.perf_counter() - began) / 4  # four of them cannot hold the work of the run
    assert disturbed(tmp_path / "rough", cases, kills=10, longest=quarter, jobs=2) >= 4
    assert cases_of(tmp_path / "calm") == cases_of(tmp_path / "rough")
    assert len(cases_of(tmp_path / "calm")) == 4


@pytest.mark.slow
def test_ten_repetitions_give_identical_verdicts_and_numbers(tmp_path):
    cases = [read_case(Path(path)) for path in quick_cases(tmp_path, 2)]
    for n in range(10):
        run_tasks([case_task(case, tmp_path / f"{n}") for case in cases], jobs=2, time_limit=3600)
        assert len(cases_of(tmp_path / f"{n}")) == 2
        assert cases_of(tmp_path / f"{n}") == cases_of(tmp_path / "0")
