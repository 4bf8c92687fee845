"""The check that notices a planted fault first, from a comparison down to the unit tests."""

from collections.abc import Iterable
from enum import StrEnum

from verification.evidence.fault_record import COMPARISONS, SMALLEST_CHANGE, FaultRow, Record


class Noticed(StrEnum):
    """Checks that notice a fault, in this order; the first three count in the headline."""

    COMPARISON = "comparison"
    INVARIANT = "invariant"
    STUDY = "study"
    HARNESS = "published, self-test or manifest"
    STOPPED = "no result"
    EQUIVALENT = "harmless"
    BASELINE = "baseline"
    NOTHING = "unit tests at most"
    NOT_TRIED = "not tried"


COUNTED = (Noticed.COMPARISON, Noticed.INVARIANT, Noticed.STUDY)
_NOTICED = {
    Noticed.COMPARISON: COMPARISONS,
    Noticed.INVARIANT: ("invariants",),
    Noticed.STUDY: ("studies",),
    Noticed.HARNESS: ("published", "self-tests", "manifest"),
}


def noticed(row: FaultRow) -> Noticed:
    """The first kind of check that reports the fault: it disagrees, or U exceeds its cap."""
    if row.failure:
        return Noticed.NOT_TRIED
    for kind, columns in _NOTICED.items():
        if row.seen_in(columns):
            return kind
    if any(tally.no_result for tally in row.columns.values()):
        return Noticed.STOPPED
    if row.equivalent:
        return Noticed.EQUIVALENT
    baseline = row.columns.get("baseline")
    return Noticed.BASELINE if baseline is not None and baseline.disagree else Noticed.NOTHING


def unused(row: FaultRow) -> bool:
    """Whether the fault changes no number of any run: an argument for a further case."""
    return not row.failure and row.change <= SMALLEST_CHANGE and noticed(row) is Noticed.NOTHING


def by_place(record: Record) -> dict[str, list[FaultRow]]:
    """Faults by what they are in: each method, the references, the harness; none without faults."""
    names = {
        "semianalytic": "semi-analytical method",
        "fem_reference": "finite elements",
        "harness": "harness",
    }
    found: dict[str, list[FaultRow]] = {name: [] for name in (*names.values(), "references")}
    for row in record.rows:
        found[names.get(row.where, "references")].append(row)
    return {name: rows for name, rows in found.items() if rows}


def score(rows: Iterable[FaultRow]) -> tuple[int, int]:
    """Faults that a counted kind notices, of all that were tried but the harmless ones."""
    real = [kind for kind in map(noticed, rows) if kind not in (Noticed.EQUIVALENT, Noticed.NOT_TRIED)]
    return sum(kind in COUNTED for kind in real), len(real)
