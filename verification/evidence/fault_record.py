"""Record of all trials of planted faults: detections, score, file."""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path
from typing import Any

from verification.credibility.faults.default_checks import COLUMNS, Check
from verification.credibility.faults.fault_planting import Fault
from verification.credibility.faults.fault_trial import Trial
from verification.judging.verdict import Outcome
from verification.running.checked_files import StoreError, read_checked, write_checked
from verification.running.json_records import decode, encode, plain

SCHEMA = "coatcheck-faults/2"
PASS_SHARE = 0.95
WORST_FIRST = (Outcome.DISAGREES, Outcome.INCONCLUSIVE, Outcome.NO_RESULT)  # of those that do not pass
SMALLEST_CHANGE = 1e-12  # of its scale; a smaller change is rounding


class Catch(StrEnum):
    """Detection of a fault; the first three count as caught."""

    DISAGREES = "caught"
    INCONCLUSIVE = "inconclusive"
    DRIFTED = "baseline"
    NO_RESULT = "no result"
    SURVIVED = "survived"
    NOT_TRIED = "not tried"


CAUGHT = (Catch.DISAGREES, Catch.INCONCLUSIVE, Catch.DRIFTED)


@dataclass(frozen=True)
class Tally:
    """Checks of one column in a trial: how many were made, how many had each outcome.

    message : that of the worst check; empty where all passed.
    """

    made: int
    disagree: int
    inconclusive: int
    no_result: int
    message: str = ""


@dataclass(frozen=True)
class Row:
    """One fault with the outcomes of its checks, column by column.

    as_predicted : True where a check that was predicted caught it.   by : message of the check that did.
    change : see Trial.   reason, remedy : of a survivor, why it survives and what would catch it.
    """

    name: str
    group: str
    description: str
    where: str
    catch: Catch
    as_predicted: bool
    by: str
    columns: dict[str, Tally]
    change: float
    changed: str
    seconds: float
    cases: tuple[str, ...]
    failure: str = ""
    reason: str = ""
    remedy: str = ""

    @property
    def caught(self) -> bool:
        return self.catch in CAUGHT

    @property
    def compared(self) -> bool:
        """True where a comparison of sources reports the fault."""
        found = [tally for name, tally in self.columns.items() if name.startswith(("bare", "coated"))]
        return any(tally.disagree or tally.inconclusive for tally in found)


@dataclass(frozen=True)
class Record:
    """All trials of one run of ``coatcheck faults``, with provenance.

    controls : trials in which nothing was planted.   failing_clean : checks that do not pass without a fault
    either, so that no trial counts them.   seconds : elapsed; core_seconds : of all trials.
    """

    rows: tuple[Row, ...]
    controls: tuple[Row, ...]
    started: str
    seconds: float
    core_seconds: float
    commit: str | None
    machine: str
    versions: dict[str, str]
    failing_clean: tuple[str, ...] = ()

    @property
    def caught(self) -> int:
        return sum(row.caught for row in self.rows)

    @property
    def as_predicted(self) -> int:
        return sum(row.as_predicted for row in self.rows)

    @property
    def share(self) -> float:
        """Share of the faults that were caught."""
        return self.caught / len(self.rows) if self.rows else 1.0

    @property
    def survivors(self) -> tuple[Row, ...]:
        return tuple(row for row in self.rows if not row.caught)

    @property
    def unexplained(self) -> tuple[Row, ...]:
        """Survivors without a reason on record."""
        return tuple(row for row in self.survivors if not (row.reason and row.remedy))

    @property
    def idle(self) -> tuple[Row, ...]:
        """Faults that survive or that a comparison reports though no compared number changed.

        Invariants and published values have numbers of their own, which a fault may change alone.
        """
        return tuple(
            row
            for row in self.rows
            if not (row.change > SMALLEST_CHANGE or row.failure or row.reason)
            and (row.catch is Catch.SURVIVED or row.compared)
        )

    @property
    def alarms(self) -> tuple[Row, ...]:
        """Controls in which a check failed."""
        return tuple(row for row in self.controls if row.catch is not Catch.SURVIVED)

    @property
    def passed(self) -> bool:
        """True where enough is caught, survivors have a reason, faults change numbers and controls pass."""
        silent = not (self.unexplained or self.idle or self.alarms or self.failing_clean)
        return self.share >= PASS_SHARE and silent


def row_of(fault: Fault, trial: Trial) -> Row:
    """The row of one trial: its checks counted column by column."""
    by_column = {column: [c for c in trial.checks if c.column == column] for column in COLUMNS}
    bad = [check for check in trial.checks if not check.passed]
    decided = [c for c in bad if c.outcome is not Outcome.NO_RESULT]
    predicted = [c for c in decided if c.name in fault.predicted]
    catch = _catch(bad, fault, trial)
    return Row(
        fault.name,
        fault.group,
        fault.description,
        fault.where,
        catch,
        bool(predicted),
        _worst_message(predicted or decided or bad),
        {column: _tally(checks) for column, checks in by_column.items() if checks},
        trial.change,
        trial.changed,
        trial.seconds,
        (*fault.cases, *fault.published),
        trial.failure or "",
        "" if catch in CAUGHT else fault.reason,
        "" if catch in CAUGHT else fault.remedy,
    )


def _catch(bad: Sequence[Check], fault: Fault, trial: Trial) -> Catch:
    if trial.failure is not None:
        return Catch.NOT_TRIED
    # A changed number is not in itself an error; it counts where no other check can detect the fault.
    own = [check for check in bad if check.column != "baseline"]
    outcomes = {check.outcome for check in own}
    if Outcome.DISAGREES in outcomes:
        return Catch.DISAGREES
    if Outcome.INCONCLUSIVE in outcomes:
        return Catch.INCONCLUSIVE
    if "baseline" in fault.predicted and len(own) < len(bad):
        return Catch.DRIFTED
    return Catch.NO_RESULT if own else Catch.SURVIVED


def _tally(checks: Sequence[Check]) -> Tally:
    disagree, inconclusive, no_result = (sum(c.outcome is one for c in checks) for one in WORST_FIRST)
    message = _worst_message([check for check in checks if not check.passed])
    return Tally(len(checks), disagree, inconclusive, no_result, message)


def _worst_message(bad: Sequence[Check]) -> str:
    """Message of the worst check: the first disagreement, then the first inconclusive, then no result."""
    ranked = sorted(bad, key=lambda check: WORST_FIRST.index(check.outcome))
    return ranked[0].message if ranked else ""


def to_json(record: Record) -> dict[str, Any]:
    """The record with its score as strict JSON."""
    score = {
        "faults": len(record.rows),
        "caught": record.caught,
        "as_predicted": record.as_predicted,
        "share": record.share,
        "by": {catch: sum(row.catch is catch for row in record.rows) for catch in Catch},
        "controls": len(record.controls),
        "alarms": len(record.alarms),
        "passed": record.passed,
    }
    return {"schema": SCHEMA, **encode(record), "score": plain(score)}


def from_json(data: dict[str, Any]) -> Record:
    """The inverse of ``to_json``. Raises ValueError for another schema or a field that does not fit."""
    if data.get("schema") != SCHEMA:
        raise ValueError(f"schema = {data.get('schema')!r}; this version reads {SCHEMA!r}")
    return decode(Record, data)


def write_record(path: Path, record: Record) -> None:
    """Store ``record`` as a checked file. Raises StoreError where it cannot be written."""
    write_checked(path, to_json(record))


def read_record(path: Path) -> Record | None:
    """The record stored at ``path``; None where there is none. Raises StoreError where it is damaged."""
    if not path.exists():
        return None
    try:
        return from_json(read_checked(path))
    except ValueError as error:
        raise StoreError(f"{path}: not a record of {SCHEMA} ({error}); run coatcheck faults again") from None
