"""False alarms: what the verdicts say of random problems in which nothing is wrong.

Both methods with every reference solve each problem; whatever does not agree there is an alarm about nothing.
"""

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from verification.judging.verdict import Outcome
from verification.running.records import plain
from verification.running.result import CaseResult, RunInfo
from verification.running.store import StoreError, read_checked, write_checked

__all__ = ["Alarm", "AlarmRecord", "counted", "path_in", "read_record", "write_record"]

SCHEMA = "coatcheck-alarms/1"


@dataclass(frozen=True)
class Alarm:
    """One comparison that does not agree, or law of one source that does not hold, with its case file."""

    case: str
    title: str
    quantity: str
    line: str
    between: tuple[str, ...]
    outcome: Outcome
    reason: str
    toml: str


@dataclass(frozen=True)
class AlarmRecord:
    """What ``problems`` clean problems of ``seed`` came to, when, with what; seconds of the whole.

    agreeing : problems in which every one of the ``comparisons`` agrees, every one of the ``laws`` holds.
    smallest_margin : of U - |A - B| over U, the least of all that agree; how near an alarm was.
    """

    seed: int
    problems: int
    agreeing: int
    comparisons: int
    laws: int
    alarms: tuple[Alarm, ...]
    smallest_margin: float | None
    started: str
    seconds: float
    commit: str | None
    machine: str
    versions: dict[str, str]


def counted(results: Sequence[CaseResult], seed: int, info: RunInfo) -> AlarmRecord:
    """The alarms of clean problems, each of a case without a comparison at all included."""
    alarms = [
        Alarm(r.name, r.title, c.quantity, c.line, c.between, v.outcome, v.reason, r.text)
        for r in results
        for c, v in r.verdicts
        if v.outcome is not Outcome.AGREES
    ]
    alarms += [
        Alarm(r.name, r.title, law.name, "", (law.source,), law.outcome, law.message, r.text)
        for r in results
        for law in r.invariants
        if law.outcome is not Outcome.AGREES
    ]
    alarms += [
        Alarm(r.name, r.title, "", "", (), Outcome.NO_RESULT, "nothing was compared", r.text)
        for r in results
        if not r.verdicts
    ]
    margins = [
        verdict.margin / (verdict.margin + verdict.difference)
        for result in results
        for _, verdict in result.verdicts
        if verdict.outcome is Outcome.AGREES and verdict.margin is not None and verdict.difference
    ]
    return AlarmRecord(
        seed,
        len(results),
        sum(result.outcome is Outcome.AGREES for result in results),
        sum(len(result.verdicts) for result in results),
        sum(len(result.invariants) for result in results),
        tuple(alarms),
        min(margins, default=None),
        info.started,
        info.seconds,
        info.commit,
        info.machine,
        dict(info.versions),
    )


def path_in(folder: Path) -> Path:
    """Where the record lies among those of ``folder``."""
    return folder / "alarms.json"


def write_record(folder: Path, record: AlarmRecord) -> Path:
    """Store the record in ``folder``, whole or not at all. Raises StoreError."""
    path = path_in(folder)
    write_checked(path, {"schema": SCHEMA, **plain(asdict(record))})
    return path


def read_record(folder: Path) -> AlarmRecord | None:
    """The record in ``folder``, None where there is none. Raises StoreError where it is damaged."""
    path = path_in(folder)
    if not path.exists():
        return None
    data: dict[str, Any] = read_checked(path)
    if data.pop("schema", None) != SCHEMA:
        raise StoreError(f"{path}: not a record of false alarms that this version reads; measure it again")
    try:
        alarms = tuple(
            Alarm(**{**a, "between": tuple(a["between"]), "outcome": Outcome(a["outcome"])})
            for a in data.pop("alarms")
        )
        return AlarmRecord(alarms=alarms, **data)
    except (KeyError, TypeError, ValueError) as error:
        raise StoreError(f"{path}: not a record of false alarms ({error}); measure it again") from None
