"""Rooms with their mutants: the draw, the outcome of each, the survivors that were read, the score."""

import random
from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from pathlib import Path
from typing import Any

from verification.cases.toml import load_toml
from verification.credibility.faults.planting import Fault
from verification.credibility.mutation.sites import Mutant, mutants
from verification.running.records import decode, encode
from verification.running.result import RunInfo
from verification.running.store import StoreError, read_checked, write_checked

SCHEMA = "coatcheck-mutants/1"
RECORD = "mutants.json"  # its name in a folder of records
ROOT = Path(__file__).resolve().parents[3]
SURVIVORS = Path(__file__).with_name("survivors.toml")


@dataclass(frozen=True)
class Room:
    """A ``folder`` of code with its ``tests``; ``asked`` is the share of its mutants that should be caught.

    checks : nothing planted, with the cases and the sources that are solved under each mutant.
    """

    folder: str
    tests: tuple[str, ...]
    asked: float
    checks: Fault


def _checks(where: str, solve: tuple[str, ...], *cases: str) -> Fault:
    return Fault("none", "", "", where, cases=(*cases, "14_ratio_4_sliding"), solve=solve)


_SMOOTH, _SLIDING, _HOUSE = "01_uncoated_steel", "13_uncoated_sliding", "tests/verification"
_HARNESS = _checks("harness", ("semianalytic", "integral_equation"))
_RUN = (
    f"{_HOUSE}/running",
    "tests/robustness/test_failing_workers.py",
    "tests/robustness/test_run_directories.py",
)
ROOMS = {
    **{
        name: Room(name, (f"tests/{name}",), 0.9, _checks(name, (name,), _SMOOTH))
        for name in ("semianalytic", "fem_reference")
    },
    "references": Room(
        "verification/sources/references",
        (f"{_HOUSE}/sources",),
        0.9,
        _checks("integral_equation", ("integral_equation", "hertz", "hamilton"), _SMOOTH, _SLIDING),
    ),
    "judging": Room("verification/judging", (f"{_HOUSE}/judging",), 0.95, _HARNESS),
    "sampling": Room("verification/sampling", (f"{_HOUSE}/sampling", f"{_HOUSE}/running"), 0.95, _HARNESS),
    "running": Room("verification/running", _RUN, 0.95, _HARNESS),
}


class Catch(StrEnum):
    """What noticed a mutant first."""

    CHECKS = "checks"
    SELF_TESTS = "self-tests"
    TESTS = "unit tests"
    CRASH = "crash"
    TIME = "time"
    SURVIVED = "survived"
    NOT_TRIED = "not tried"


@dataclass(frozen=True)
class Trial:
    """A mutant of a ``room``, None where nothing was changed, with what caught it.

    by : its message.   change, changed : the largest change of a number, as in ``faults.trial.Trial``.
    kind, reason : of a survivor that was read: "equivalent", or "harmless" below the uncertainty.
    """

    room: str
    mutant: Mutant | None
    catch: Catch
    by: str = ""
    change: float = 0.0
    changed: str = ""
    seconds: float = 0.0
    kind: str = ""
    reason: str = ""

    @property
    def caught(self) -> bool:
        return self.catch not in (Catch.SURVIVED, Catch.NOT_TRIED)


@dataclass(frozen=True)
class MutantRecord:
    """Trials of mutants drawn with ``seed``, with the run; ``seconds`` of one core."""

    seed: int
    trials: tuple[Trial, ...]
    seconds: float
    info: RunInfo

    @property
    def survivors(self) -> tuple[Trial, ...]:
        return tuple(trial for trial in self.trials if not trial.caught)

    def score(self, *rooms: str) -> tuple[int, int]:
        """Caught, and all but the equivalent ones, in ``rooms``; in all unless given."""
        counted = [t for t in self.trials if (not rooms or t.room in rooms) and t.kind != "equivalent"]
        return sum(t.caught for t in counted), len(counted)

    @property
    def passed(self) -> bool:
        """True where enough is caught in the rooms of each share asked, and every survivor was read."""
        for asked in {room.asked for room in ROOMS.values()}:
            caught, count = self.score(*(name for name, room in ROOMS.items() if room.asked == asked))
            if caught < asked * count:
                return False
        return all(trial.kind for trial in self.survivors)


def drawn(rooms: Sequence[str], count: int, seed: int, root: Path = ROOT) -> list[tuple[str, Mutant]]:
    """``count`` mutants, as many from each of ``rooms``; those of a larger count are these with more."""
    found = []
    for number, name in enumerate(rooms):
        files = sorted((root / ROOMS[name].folder).rglob("*.py"))
        known = [m for f in files for m in mutants(f.read_text("utf-8"), f.relative_to(root).as_posix())]
        random.Random(f"{seed} {name}").shuffle(known)
        share = count // len(rooms) + (number < count % len(rooms))
        found += [(name, mutant) for mutant in known[:share]]
    return found


def annotated(trials: Sequence[Trial], listed: Path = SURVIVORS) -> tuple[Trial, ...]:
    """``trials`` with kind and reason of the survivors listed by file, function and change."""
    rows = load_toml(listed.read_bytes())[1].get("survivor", [])
    known = {(row["file"], row["function"], row["change"]): row for row in rows}
    found = []
    for trial in trials:
        m = trial.mutant
        row = known.get((m.file, m.function, m.change)) if m and not trial.caught else None
        found.append(replace(trial, kind=row["kind"], reason=row["reason"]) if row else trial)
    return tuple(found)


def to_json(record: MutantRecord) -> dict[str, Any]:
    """The record with its score as strict JSON."""
    return {"schema": SCHEMA, **encode(record), "score": list(record.score()), "passed": record.passed}


def write_record(folder: Path, record: MutantRecord) -> None:
    """Store ``record`` in ``folder``. Raises StoreError where it cannot be written."""
    write_checked(folder / RECORD, to_json(record))


def read_record(folder: Path) -> MutantRecord | None:
    """The record in ``folder``; None where there is none. Raises StoreError where it is damaged."""
    path = folder / RECORD
    if not path.exists():
        return None
    try:
        data = read_checked(path)
        if data.get("schema") == SCHEMA:
            return decode(MutantRecord, data)
    except ValueError as error:
        raise StoreError(f"{path}: {error}") from None
    raise StoreError(f"{path}: not a record of {SCHEMA}; run coatcheck mutants again")
