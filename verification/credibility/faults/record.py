"""The trials of planted faults as one record: who caught what, the score, its exact JSON form."""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import Any

from verification.credibility.faults.checks import COLUMNS, Check
from verification.credibility.faults.planting import Fault
from verification.credibility.faults.survivors import SURVIVORS
from verification.credibility.faults.trial import Trial
from verification.judging.verdict import Outcome
from verification.running.records import plain

__all__ = ["PASS_SHARE", "SCHEMA", "Catch", "Record", "Row", "Seen", "from_json", "row_of", "to_json"]

SCHEMA = "coatcheck-faults/1"
PASS_SHARE = 0.95
SMALLEST_CHANGE = 1e-12  # of its scale; less is rounding, so that nothing was planted


class Catch(StrEnum):
    """How a fault was noticed; the first three count as caught."""

    DISAGREES = "caught"
    INCONCLUSIVE = "inconclusive"
    DRIFTED = "baseline"
    NO_RESULT = "no result"
    SURVIVED = "survived"
    NOT_TRIED = "not tried"


CAUGHT = (Catch.DISAGREES, Catch.INCONCLUSIVE, Catch.DRIFTED)


@dataclass(frozen=True)
class Seen:
    """What the checks of one column made of a fault: how many were made, how many came to each outcome.

    said : the check that speaks loudest, with its reason; empty where all passed.
    """

    made: int
    disagree: int
    inconclusive: int
    no_result: int
    said: str = ""


@dataclass(frozen=True)
class Row:
    """One fault with what every column of checks made of it.

    as_expected : True where a check caught it that was named for it before it was tried; by : its words.
    change : see Trial.   reason, cure : of a survivor, why it survives, what would catch it.
    """

    name: str
    group: str
    sentence: str
    where: str
    catch: Catch
    as_expected: bool
    by: str
    columns: dict[str, Seen]
    change: float
    changed: str
    seconds: float
    cases: tuple[str, ...]
    failure: str = ""
    reason: str = ""
    cure: str = ""

    @property
    def caught(self) -> bool:
        return self.catch in CAUGHT


@dataclass(frozen=True)
class Record:
    """All trials of one run of ``coatcheck faults``, with when, where, by which versions it was made.

    blanks : the trials in which nothing was planted.   already : checks that no trial could count, for they
    do not pass without a fault either.   seconds : of the clock; core_seconds : of all trials.
    """

    rows: tuple[Row, ...]
    blanks: tuple[Row, ...]
    started: str
    seconds: float
    core_seconds: float
    commit: str | None
    machine: str
    versions: dict[str, str]
    already: tuple[str, ...] = ()

    @property
    def caught(self) -> int:
        return sum(row.caught for row in self.rows)

    @property
    def as_expected(self) -> int:
        return sum(row.as_expected for row in self.rows)

    @property
    def share(self) -> float:
        """Of the faults that were caught, 0 to 1."""
        return self.caught / len(self.rows) if self.rows else 1.0

    @property
    def survivors(self) -> tuple[Row, ...]:
        return tuple(row for row in self.rows if not row.caught)

    @property
    def unexplained(self) -> tuple[Row, ...]:
        """Survivors of which nobody has said why."""
        return tuple(row for row in self.survivors if not (row.reason and row.cure))

    @property
    def idle(self) -> tuple[Row, ...]:
        """Faults that changed no number: nothing was tried."""
        return tuple(row for row in self.rows if not row.change > SMALLEST_CHANGE and not row.failure)

    @property
    def alarms(self) -> tuple[Row, ...]:
        """Trials that caught something though nothing was planted."""
        return tuple(row for row in self.blanks if row.catch is not Catch.SURVIVED)

    @property
    def passed(self) -> bool:
        """True where enough is caught, each survivor explained, each fault real, nothing amiss without."""
        silent = not (self.unexplained or self.idle or self.alarms or self.already)
        return self.share >= PASS_SHARE and silent


def row_of(fault: Fault, trial: Trial) -> Row:
    """The row of one trial: its checks counted column by column."""
    columns = {}
    for column in COLUMNS:
        checks = [check for check in trial.checks if check.column == column]
        if checks:
            columns[column] = _seen(checks)
    bad = [check for check in trial.checks if not check.passed]
    decided = [c for c in bad if c.outcome in (Outcome.DISAGREES, Outcome.INCONCLUSIVE)]
    named = [c for c in decided if c.name in fault.expected]
    reason, cure = SURVIVORS.get(fault.name, ("", ""))
    catch = _catch(bad, fault, trial)
    return Row(
        fault.name,
        fault.group,
        fault.sentence,
        fault.where,
        catch,
        bool(named),
        _loudest(named or decided or bad),
        columns,
        trial.change,
        trial.changed,
        trial.seconds,
        (*fault.cases, *fault.published),
        trial.failure or "",
        "" if catch in CAUGHT else reason,
        "" if catch in CAUGHT else cure,
    )


def _catch(bad: Sequence[Check], fault: Fault, trial: Trial) -> Catch:
    if trial.failure is not None:
        return Catch.NOT_TRIED
    # That a number is not what it was says no more than that; it counts where nothing else can know.
    of_itself = [check for check in bad if check.column != "baseline"]
    for outcome, catch in (
        (Outcome.DISAGREES, Catch.DISAGREES),
        (Outcome.INCONCLUSIVE, Catch.INCONCLUSIVE),
    ):
        if any(check.outcome is outcome for check in of_itself):
            return catch
    if "baseline" in fault.expected and len(of_itself) < len(bad):
        return Catch.DRIFTED
    return Catch.NO_RESULT if of_itself else Catch.SURVIVED


def _seen(checks: Sequence[Check]) -> Seen:
    def count(outcome: Outcome) -> int:
        return sum(check.outcome is outcome for check in checks)

    bad = [check for check in checks if not check.passed]
    return Seen(
        len(checks),
        count(Outcome.DISAGREES),
        count(Outcome.INCONCLUSIVE),
        count(Outcome.NO_RESULT),
        _loudest(bad),
    )


def _loudest(bad: Sequence[Check]) -> str:
    """The check that says most: a disagreement first, of those the one listed first."""
    for outcome in (Outcome.DISAGREES, Outcome.INCONCLUSIVE, Outcome.NO_RESULT):
        for check in bad:
            if check.outcome is outcome:
                return check.said
    return ""


def to_json(record: Record) -> dict[str, Any]:
    """The record as strict JSON."""
    return {
        "schema": SCHEMA,
        **{name: plain(value) for name, value in vars(record).items() if name not in ("rows", "blanks")},
        "score": {
            "faults": len(record.rows),
            "caught": record.caught,
            "as_expected": record.as_expected,
            "share": record.share,
            "by": {catch: sum(row.catch is catch for row in record.rows) for catch in Catch},
            "blanks": len(record.blanks),
            "alarms": len(record.alarms),
            "passed": record.passed,
        },
        "rows": [_row_to_json(row) for row in record.rows],
        "blanks": [_row_to_json(row) for row in record.blanks],
    }


def _row_to_json(row: Row) -> dict[str, Any]:
    columns = {name: plain(vars(seen)) for name, seen in row.columns.items()}
    return plain(vars(row)) | {"columns": columns}


def from_json(data: dict[str, Any]) -> Record:
    """The inverse of ``to_json``. Raises ValueError where the schema is another one."""
    if data.get("schema") != SCHEMA:
        raise ValueError(f"schema = {data.get('schema')!r}; this version reads {SCHEMA!r}, try again")
    return Record(
        rows=tuple(_row_from_json(row) for row in data["rows"]),
        blanks=tuple(_row_from_json(row) for row in data["blanks"]),
        started=str(data["started"]),
        seconds=float(data["seconds"]),
        core_seconds=float(data["core_seconds"]),
        commit=data["commit"],
        machine=str(data["machine"]),
        versions=dict(data["versions"]),
        already=tuple(data["already"]),
    )


def _row_from_json(data: dict[str, Any]) -> Row:
    made = {
        **data,
        "catch": Catch(data["catch"]),
        "cases": tuple(data["cases"]),
        "change": float(data["change"]),
        "columns": {name: Seen(**seen) for name, seen in data["columns"].items()},
    }
    return Row(**made)
