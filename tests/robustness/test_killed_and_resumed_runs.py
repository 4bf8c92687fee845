"""Runs that are killed and resumed, or repeated, come to the same numbers."""

from pathlib import Path

import pytest
from case_texts import case_text
from kill_runs import disturbed, largest_difference, resumed

from verification.cases.case_file import read_case
from verification.running.case_tasks import case_task
from verification.running.checked_files import write_checked
from verification.running.pool.process_pool import run_tasks

LIMIT = 1e-12

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
    cases = quick_cases(tmp_path, 4)
    assert resumed(tmp_path / "calm", cases, 2).wait() in (0, 4)
    assert disturbed(tmp_path / "rough", cases, kills=10, longest=20.0, jobs=2) >= 4
    difference, compared = largest_difference(tmp_path / "calm", tmp_path / "rough")
    assert compared > 1000
    assert difference <= LIMIT


@pytest.mark.slow
def test_ten_repetitions_give_identical_verdicts_and_numbers(tmp_path):
    cases = [read_case(Path(path)) for path in quick_cases(tmp_path, 2)]
    for n in range(10):
        run_tasks([case_task(case, tmp_path / f"{n}") for case in cases], jobs=2, time_limit=3600)
        difference, compared = largest_difference(tmp_path / "0", tmp_path / f"{n}")
        assert compared > 1000
        assert difference <= LIMIT


def test_comparison_of_runs_sees_a_changed_number_and_a_changed_verdict(tmp_path):
    profile = {"quantity": "sigma_xx", "value": [1e9, 2e9, -4e9], "position": [0.0, 1.0, 2.0]}
    verdict = {"outcome": "AGREES", "difference": 1e-6, "reason": "difference 1e-6"}
    payload = {"outcome": "AGREES", "seconds": 1.0, "profiles": [profile], "verdicts": [verdict]}
    payload["problem"] = {"p_h": 4e9}
    write_checked(tmp_path / "a" / "cases" / "x.json", payload)
    for change, expected in (
        ({}, 0.0),
        ({"seconds": 2.0}, 0.0),
        ({"profiles": [profile | {"value": [1e9, 2e9 + 4.0, -4e9]}]}, 1e-9),
        ({"profiles": [profile | {"value": [1e9, 2e9]}]}, float("inf")),
        ({"profiles": [profile | {"value": [1e9, 2e9, "nan"]}]}, float("inf")),
        ({"outcome": "DISAGREES"}, float("inf")),
        ({"verdicts": [verdict | {"difference": 2e-6, "reason": ""}]}, 1e-6),
        ({"verdicts": [verdict | {"outcome": "NO_RESULT"}]}, float("inf")),
    ):
        write_checked(tmp_path / "b" / "cases" / "x.json", payload | change)
        difference, _ = largest_difference(tmp_path / "a", tmp_path / "b")
        assert difference == pytest.approx(expected, rel=1e-6, abs=0)
