"""The part of the slow tests that is due: python tests/tools/slow_parts.py prints its number.

A day on which main changes has one part of seven, the next such day the next: each part runs within seven
days of changes, however many days lie between them. Without history, the days of the calendar are counted.
"""

import subprocess
import sys
from collections.abc import Iterable
from datetime import date

PARTS = 7  # as in tests/conftest.py


def part_of(days: Iterable[str], shallow: bool) -> int:
    """Part of the newest of ``days``, which are the dates of all commits, the newest first."""
    days = list(days)
    return (date.fromisoformat(days[0]).toordinal() if shallow else len(set(days))) % PARTS


def _git(*words: str) -> list[str]:
    return subprocess.run(["git", *words], capture_output=True, text=True, check=False).stdout.split()


if __name__ == "__main__":
    days = _git("log", "--first-parent", "--format=%cs")
    whole = _git("rev-parse", "--is-shallow-repository") == ["false"]
    sys.stdout.write(f"{part_of(days or [str(date.today())], shallow=not whole)}\n")
