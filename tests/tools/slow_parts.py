"""The parts of the slow tests that are due: one for each day since the commit before, of at most a week.

python tests/tools/slow_parts.py prints their numbers. A day has one part of seven, so that every part runs
within a week of changes however the commits are spread: where main rested for three days, three are due.
"""

import subprocess
import sys
from datetime import datetime, timedelta

PARTS = 7  # as in tests/conftest.py


def due(before: datetime, now: datetime) -> list[int]:
    """Parts of the days after ``before`` up to that of ``now``, of ``now`` at least."""
    days = min(max((now.date() - before.date()).days, 1), PARTS)
    return [(now.date() - timedelta(days=back)).toordinal() % PARTS for back in range(days)]


def committed(revision: str) -> datetime:
    """When a commit was made; a shallow clone has none but the last, which stands for the others."""
    words = ["git", "log", "-1", "--first-parent", "--format=%cI"]
    done = subprocess.run([*words, revision], capture_output=True, text=True, check=False)
    found = done.stdout.strip() or subprocess.run(words, capture_output=True, text=True).stdout.strip()
    return datetime.fromisoformat(found)


if __name__ == "__main__":
    sys.stdout.write(" ".join(map(str, due(committed("HEAD~1"), committed("HEAD")))) + "\n")
