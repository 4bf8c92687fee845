"""Sensitivity of the verdicts on published values to a change of a single digit.

Every digit of every cell is replaced by each of the nine others; where that changes the cell by at least
``MATTERS`` times its uncertainty, the line is judged a second time, with the solutions as they are.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

from verification.cases.published_table import RECOMPUTED, PublishedColumn
from verification.judging.verdict import Claim, Outcome, compare, judge
from verification.problem.line_profile import Profile

MATTERS = 10.0
SHOWN = 20  # the most changes listed among those not noticed
GROUPS = ("counted", "departures", RECOMPUTED)


@dataclass
class Count:
    """Changes in the cells of one group, and how many turn a verdict: of any source, of each."""

    cells: int = 0
    changes: int = 0
    noticed: int = 0
    by: dict[str, int] | None = None

    def add(self, sources: Mapping[str, bool]) -> None:
        """Count one change, noticed or not by each of ``sources``."""
        self.changes += 1
        self.noticed += any(sources.values())
        self.by = {s: (self.by or {}).get(s, 0) + found for s, found in sources.items()}


def changed_digits(text: str) -> Iterator[str]:
    """Every text with one digit of the mantissa of ``text`` replaced by another."""
    for i, old in enumerate(text.lower().partition("e")[0]):
        if old.isdigit():
            yield from (text[:i] + new + text[i + 1 :] for new in "0123456789" if new != old)


def digit_changes(
    columns: tuple[PublishedColumn, ...],
    claims: tuple[Claim, ...],
    profiles: Mapping[tuple[str, str, str], Profile],
) -> dict[str, Any]:
    """Changes of digits and those noticed, by group of cells, and the first that were not.

    A change is noticed by a source whose verdict turns from AGREES to DISAGREES.   profiles : by quantity,
    line, source, of the sources in ``claims``.
    """
    counts = {group: Count() for group in GROUPS}
    passed = []
    for item in columns:
        key = item.profile.quantity, item.profile.line
        caps = {c.between[0]: c.cap for c in claims if (c.quantity, c.line) == key}
        sources = {s: (profiles[*key, s], cap) for s, cap in caps.items() if (*key, s) in profiles}
        agreeing = {s for s, (mine, cap) in sources.items() if _outcome(mine, item, cap) is Outcome.AGREES}
        for row, text in enumerate(item.text):
            group = RECOMPUTED if item.seen == RECOMPUTED else GROUPS[int(item.departs[row])]
            counts[group].cells += 1
            for new in changed_digits(text):
                moved = (float(new) - float(text)) * item.to_si
                U = item.profile.uncertainty
                if U is None or abs(moved) < MATTERS * U[row] * (1 - 1e-9):
                    continue
                other = _moved(item, row, moved)
                noticed = {
                    s: s in agreeing and _outcome(mine, other, cap) is Outcome.DISAGREES
                    for s, (mine, cap) in sources.items()
                }
                counts[group].add(noticed)
                if not any(noticed.values()):
                    passed.append(
                        f"{item.file}, line {item.rows[row]}, column {item.column}: {text} to {new}"
                    )
    return {
        "groups": {group: vars(count) for group, count in counts.items() if count.cells},
        "passed": passed[:SHOWN],
    }


def _moved(item: PublishedColumn, row: int, by: float) -> PublishedColumn:
    value = item.profile.value.copy()
    value[row] += by
    return replace(item, profile=replace(item.profile, value=value))


def _outcome(mine: Profile, item: PublishedColumn, cap: float) -> Outcome:
    return judge(compare(mine, item.reference, scale=item.scale), cap).outcome
