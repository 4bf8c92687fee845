"""The slow tests that continuous integration runs: every part within a week of changes."""

from datetime import date, timedelta

import pytest
from slow_parts import PARTS, part_of

START = date(2026, 11, 23)


@pytest.mark.parametrize("gap", [1, 3, 7])
@pytest.mark.parametrize("commits", [1, 5])
def test_every_part_runs_within_seven_days_of_changes(gap, commits):
    days = [str(START + timedelta(days=gap * n)) for n in range(20) for _ in range(commits)]
    parts = [part_of(reversed(days[:k]), shallow=False) for k in range(commits, len(days) + 1, commits)]
    assert all(len(set(parts[n : n + PARTS])) == PARTS for n in range(20 - PARTS))
    assert len({part_of(reversed(days[:k]), shallow=False) for k in range(1, commits + 1)}) == 1


def test_a_clone_without_history_counts_days():
    assert {part_of([str(START + timedelta(days=n))], shallow=True) for n in range(PARTS)} == set(
        range(PARTS)
    )
