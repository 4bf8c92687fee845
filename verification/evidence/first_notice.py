"""What notices a fault of the semi-analytical method first, from a comparison down to the unit tests."""

from enum import StrEnum

from verification.evidence.fault_record import COLUMNS, SMALLEST_CHANGE, FaultRow, Record


class Noticed(StrEnum):
    """What noticed a fault first, in this order; the first three count in the headline."""

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
    Noticed.COMPARISON: tuple(name for name in COLUMNS if name.startswith(("bare", "coated"))),
    Noticed.INVARIANT: ("invariants",),
    Noticed.STUDY: ("studies",),
    Noticed.HARNESS: ("published", "self-tests", "manifest"),
}


def noticed(row: FaultRow) -> Noticed:
    """The first kind of check that reports the fault: it disagrees, or U exceeds its cap."""
    if row.failure:
        return Noticed.NOT_TRIED
    for kind, columns in _NOTICED.items():
        found = [row.columns[name] for name in columns if name in row.columns]
        if any(tally.disagree or tally.inconclusive for tally in found):
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


def of_method(record: Record) -> tuple[FaultRow, ...]:
    """The faults in the semi-analytical method."""
    return tuple(row for row in record.rows if row.where == "semianalytic")


def noticed_by(record: Record, *kinds: Noticed) -> int:
    """Faults of the method that checks of these ``kinds`` notice first."""
    return sum(noticed(row) in kinds for row in of_method(record))


def method_score(record: Record) -> tuple[int, int]:
    """Faults of the method that a counted kind notices, of all tried but the harmless ones."""
    apart = noticed_by(record, Noticed.EQUIVALENT, Noticed.NOT_TRIED)
    return noticed_by(record, *COUNTED), len(of_method(record)) - apart


def kinds(record: Record) -> str:
    """Each counted kind with the faults that it notices first, and the harmless faults."""
    parts = [f"{noticed_by(record, kind)} by {kind}" for kind in COUNTED]
    apart = noticed_by(record, Noticed.EQUIVALENT)
    return ", ".join(parts) + (f"; {apart} harmless apart" if apart else "")
