"""Rooms with their mutants: the draw, the outcome of each, the survivors that were read, the score."""

import random
from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from pathlib import Path
from typing import Any

from verification.cases.toml_file import load_toml
from verification.credibility.faults.fault_planting import Fault
from verification.credibility.mutation.sites import Mutant, mutants
from verification.running.case_result import RunInfo
from verification.running.checked_files import StoreError, read_checked, write_checked
from verification.running.json_records import decode, encode

SCHEMA = "coatcheck-mutants/1"
RECORD = "mutants.json"  # its name in a folder of records
ROOT = Path(__file__).resolve().parents[3]
SURVIVORS = Path(__file__).with_name("survivors.toml")


@dataclass(frozen=True)
class Room:
    """A ``folder`` of code with its ``tests``, see rooms.toml."""

    folder: str
    tests: tuple[str, ...]
    asked: float
    where: str
    cases: tuple[str, ...]
    solve: tuple[str, ...] = ()

    @property
    def checks(self) -> Fault:
        """Nothing planted, with what is solved under each mutant."""
        return Fault("none", "", "", self.where, cases=self.cases, solve=self.solve)


ROOMS = decode(dict[str, Room], load_toml(Path(__file__).with_name("rooms.toml").read_bytes())[1])


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
    def survivors(self) -> list[tuple[Trial, Mutant]]:
        return [(trial, trial.mutant) for trial in self.trials if trial.mutant and not trial.caught]

    def score(self, *rooms: str) -> tuple[int, int]:
        """Caught, and all but the equivalent ones, in ``rooms``; in all unless given."""
        counted = [t for t in self.trials if (not rooms or t.room in rooms) and t.kind != "equivalent"]
        return sum(t.caught for t in counted), len(counted)

    @property
    def passed(self) -> bool:
        """True where enough is caught in the rooms of each share asked, and every survivor was read."""
        shares = {room.asked for room in ROOMS.values()}
        scores = {s: self.score(*(name for name, room in ROOMS.items() if room.asked == s)) for s in shares}
        enough = all(caught >= share * count for share, (caught, count) in scores.items())
        return enough and all(trial.kind for trial, _ in self.survivors)


def drawn(rooms: Sequence[str], count: int, seed: int) -> list[tuple[str, Mutant]]:
    """``count`` mutants, as many from each of ``rooms``; those of a larger count are these with more."""
    found = []
    for number, name in enumerate(rooms):
        files = sorted((ROOT / ROOMS[name].folder).rglob("*.py"))
        known = [m for f in files for m in mutants(f.read_text("utf-8"), f.relative_to(ROOT).as_posix())]
        random.Random(f"{seed} {name}").shuffle(known)
        share = count // len(rooms) + (number < count % len(rooms))
        found += [(name, mutant) for mutant in known[:share]]
    return found


def annotated(trials: Sequence[Trial], listed: Path = SURVIVORS) -> tuple[Trial, ...]:
    """``trials`` with kind and reason of the survivors listed by file, function and change."""
    rows = load_toml(listed.read_bytes())[1].get("survivor", [])
    known = {(row["file"], row["function"], row["change"]): row for row in rows}

    def read(trial: Trial, m: Mutant | None) -> Trial:
        row = known.get((m.file, m.function, m.change)) if m and trial.catch is Catch.SURVIVED else None
        return replace(trial, kind=row["kind"], reason=row["reason"]) if row else trial

    return tuple(read(trial, trial.mutant) for trial in trials)


def to_json(record: MutantRecord) -> dict[str, Any]:
    """The record with its score as strict JSON."""
    return {"schema": SCHEMA, **encode(record), "score": list(record.score()), "passed": record.passed}


def read_record(path: Path) -> MutantRecord | None:
    """The record stored at ``path``; None where there is none. Raises StoreError where it is damaged."""
    if not path.exists():
        return None
    try:
        return decode(MutantRecord, read_checked(path))
    except ValueError as error:
        raise StoreError(f"{path}: not a record of {SCHEMA} ({error}); run coatcheck mutants again") from None


def write_record(path: Path, record: MutantRecord) -> None:
    """Store ``record`` as a checked file. Raises StoreError where it cannot be written."""
    write_checked(path, to_json(record))
