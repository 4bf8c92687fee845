"""Mutants on record: what caught each, the survivors that were read, the score of each part of the code."""

from dataclasses import dataclass
from enum import StrEnum
from hashlib import sha256

from verification.running.case_result import RunInfo
from verification.running.json_records import RecordFile

# Share of the mutants of each part of the code that has to be caught.
REQUIRED = {
    "semianalytic": 0.9,
    "fem_reference": 0.9,
    "references": 0.9,
    "judging": 0.95,
    "sampling": 0.95,
    "running": 0.95,
}


@dataclass(frozen=True)
class Mutant:
    """The lines ``before`` of ``file``, from ``line`` on, become ``after``, changed at ``column``.

    function : what encloses them, "" in the module itself.
    """

    file: str
    function: str
    operator: str
    line: int
    column: int
    before: str
    after: str

    @property
    def name(self) -> str:
        """Its place with a digest, as the name of a file."""
        place = self.file.removesuffix(".py").replace("/", ".")
        return f"{place}_{self.line}_{sha256(repr(self).encode()).hexdigest()[:8]}"

    @property
    def change(self) -> str:
        """Both in one line."""
        return " ".join(f"{self.before} -> {self.after}".split())


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

    by : its message.   change, changed : the largest change of a number, as in ``fault_trial.Trial``.
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

    @property
    def passed(self) -> bool:
        """True where enough is caught in the parts of each required share, and every survivor was read."""
        shares = set(REQUIRED.values())
        scores = {s: self.score(*(name for name, share in REQUIRED.items() if share == s)) for s in shares}
        enough = all(caught >= share * count for share, (caught, count) in scores.items())
        return enough and all(trial.kind for trial, _ in self.survivors)

    def score(self, *rooms: str) -> tuple[int, int]:
        """Caught, and all but the equivalent ones, in ``rooms``; in all unless given."""
        counted = [t for t in self.trials if (not rooms or t.room in rooms) and t.kind != "equivalent"]
        return sum(t.caught for t in counted), len(counted)


_FILE = RecordFile(
    MutantRecord,
    "mutants.json",
    ("coatcheck-mutants/1",),
    "mutants",
    "make it again",
    lambda record: {"score": list(record.score()), "passed": record.passed},
)
to_json, write_record, read_record = _FILE.to_json, _FILE.write, _FILE.read
