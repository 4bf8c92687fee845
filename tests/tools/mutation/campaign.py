"""Rooms of the code whose mutants are tried: the draw and the survivors that were read."""

import random
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from mutation.sites import mutants
from verification.cases.toml_file import load_toml
from verification.credibility.faults.fault_planting import Fault
from verification.evidence.mutant_record import Catch, Mutant, Trial
from verification.running.json_records import decode

ROOT = Path(__file__).resolve().parents[3]
SURVIVORS = Path(__file__).with_name("survivors.toml")


@dataclass(frozen=True)
class Room:
    """A ``folder`` of code with its ``tests``, see rooms.toml."""

    folder: str
    tests: tuple[str, ...]
    where: str
    cases: tuple[str, ...]
    solve: tuple[str, ...] = ()

    @property
    def checks(self) -> Fault:
        """Nothing planted, with what is solved under each mutant."""
        return Fault("none", "", "", self.where, cases=self.cases, solve=self.solve)


ROOMS = decode(dict[str, Room], load_toml(Path(__file__).with_name("rooms.toml").read_bytes())[1])


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
