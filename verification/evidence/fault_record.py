"""Record of all trials of planted faults: detections, score, file."""

from collections.abc import Iterable
from dataclasses import dataclass
from enum import StrEnum
from typing import Any

from verification.running.json_records import RecordFile

PASS_SHARE = 0.95
# Titles of the groups of faults, in the order of the matrix.
GROUPS = {
    "material": "Material",
    "ball": "Elastic ball",
    "frf": "Frequency response functions",
    "conversion_fft": "Conversion and FFT",
    "conjugate_gradients": "Conjugate gradients",
    "grids": "Grids",
    "edge": "Edge correction",
    "stress": "Stress",
    "rings": "Stress coefficients",
    "finite_elements": "Finite elements",
    "fields": "Displacements, stiffness, stacks, planes",
    "references": "References",
    "harness": "Harness",
    "coverage": "Harness: coverage, manifest, baseline, exit",
}
# The columns of the matrix of faults: title and what is compared.
COLUMNS = {
    "bare, closed form": "uncoated cases, Hertz or Hamilton on one side",
    "bare, exact": "uncoated cases, the integral equation on one side, no closed form on the other",
    "bare, methods": "uncoated cases, method against method",
    "coated, exact": "coated cases, the integral equation on one side",
    "coated, methods": "coated cases, method against method",
    "invariants": "invariants that one solution must satisfy by itself",
    "studies": "errors against exact solutions, iterations, ratio of grids, if nothing else noticed",
    "published": "tables published by others (coatcheck run published)",
    "self-tests": "known answers of the harness itself",
    "manifest": "less that is judged: points, lines, invariants, or a wider cap or scale",
    "baseline": "numbers that changed; counted only where no other check can detect the fault",
}
COMPARISONS = tuple(name for name in COLUMNS if name.startswith(("bare", "coated")))
SMALLEST_CHANGE = 1e-12  # of its scale; a smaller change is rounding
EQUIVALENT_CHANGE = 1e-6  # of its scale; below the uncertainty that a method states, and below every cap


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
class FaultRow:
    """One fault with the outcomes of its checks, column by column.

    as_predicted : True where a check that was predicted caught it.   by : message of the check that did.
    change : see Trial.   reason, remedy : of a survivor, why it survives and what would catch it.
    equivalent : of a survivor, the same numbers by another way, within ``EQUIVALENT_CHANGE``.
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
    equivalent: bool = False

    @property
    def caught(self) -> bool:
        return self.catch in CAUGHT

    def seen_in(self, columns: Iterable[str] = COMPARISONS) -> bool:
        """Whether a check of ``columns``, by default a comparison of sources, reports the fault."""
        found = [self.columns[name] for name in columns if name in self.columns]
        return any(tally.disagree or tally.inconclusive for tally in found)

    @property
    def only_coated(self) -> bool:
        """Whether every comparison of uncoated cases passes and some of coated ones do not."""
        bare = [name for name in self.columns if name.startswith("bare")]
        passed = not any(self.columns[name].no_result for name in bare) and not self.seen_in(bare)
        return bool(bare) and passed and self.seen_in()


@dataclass(frozen=True)
class Record:
    """All trials of one run of ``python tests/tools faults``, with provenance.

    controls : trials in which nothing was planted.   failing_clean : checks that do not pass without a fault
    either, so that no trial counts them.   seconds : elapsed; core_seconds : of all trials.
    source : hash of the code.
    """

    rows: tuple[FaultRow, ...]
    controls: tuple[FaultRow, ...]
    started: str
    seconds: float
    core_seconds: float
    commit: str | None
    machine: str
    versions: dict[str, str]
    failing_clean: tuple[str, ...] = ()
    source: str = ""

    @property
    def caught(self) -> int:
        return sum(row.caught for row in self.rows)

    @property
    def as_predicted(self) -> int:
        return sum(row.as_predicted for row in self.rows)

    @property
    def tried(self) -> tuple[FaultRow, ...]:
        """Faults whose trial ended; the others detect nothing, but no check has passed them either."""
        return tuple(row for row in self.rows if row.catch is not Catch.NOT_TRIED)

    @property
    def share(self) -> float:
        """Share of the faults tried that were caught."""
        return self.caught / len(self.tried) if self.tried else 1.0

    @property
    def survivors(self) -> tuple[FaultRow, ...]:
        return tuple(row for row in self.tried if not row.caught)

    @property
    def unexplained(self) -> tuple[FaultRow, ...]:
        """Survivors without a reason on record."""
        return tuple(row for row in self.survivors if not (row.reason and (row.remedy or row.equivalent)))

    @property
    def idle(self) -> tuple[FaultRow, ...]:
        """Faults that survive or that a comparison reports though no compared number changed."""
        # invariants and published values have numbers of their own, which a fault may change alone
        return tuple(
            row
            for row in self.rows
            if not (row.change > SMALLEST_CHANGE or row.failure or row.reason)
            and (row.catch is Catch.SURVIVED or row.seen_in())
        )

    @property
    def alarms(self) -> tuple[FaultRow, ...]:
        """Controls in which a check failed."""
        return tuple(row for row in self.controls if row.catch is not Catch.SURVIVED)

    @property
    def passed(self) -> bool:
        """True where all are tried, enough caught, survivors explained, numbers change and controls pass."""
        silent = not (self.unexplained or self.idle or self.alarms or self.failing_clean)
        return self.share >= PASS_SHARE and silent and len(self.tried) == len(self.rows)

    @property
    def score(self) -> dict[str, Any]:
        """The counts, for other readers of the file."""
        return {
            "faults": len(self.rows),
            "caught": self.caught,
            "as_predicted": self.as_predicted,
            "share": self.share,
            "by": {catch: sum(row.catch is catch for row in self.rows) for catch in Catch},
            "controls": len(self.controls),
            "alarms": len(self.alarms),
            "passed": self.passed,
        }


_FILE = RecordFile(
    Record,
    "faults.json",
    ("coatcheck-faults/2",),
    "planted faults",
    "try the faults again",
    lambda record: {"score": record.score},
)
to_json, write_record, read_record = _FILE.to_json, _FILE.write, _FILE.read
