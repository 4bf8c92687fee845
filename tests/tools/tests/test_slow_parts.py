"""The slow tests that continuous integration runs: every part within a week of changes."""

from datetime import datetime, timedelta
from itertools import pairwise

import pytest
from slow_parts import PARTS, due

START = datetime(2026, 11, 23, 9)


@pytest.mark.parametrize("hours", [1, 23, 30, 24 * 3, 24 * 9])
def test_every_part_runs_within_a_week_of_changes(hours):
    """Commits ``hours`` apart, two weeks of them."""
    times = [START + timedelta(hours=hours * n) for n in range(24 * 14 // hours + 2)]
    ran = {}
    for before, now in pairwise(times):
        ran |= dict.fromkeys(due(before, now), now)
    assert set(ran) == set(range(PARTS))
    assert all(times[-1] - last <= timedelta(days=7, hours=hours) for last in ran.values())
