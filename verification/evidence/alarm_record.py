"""False alarms: verdicts other than AGREES on random problems that contain no error.

Those that find the uncertainty too large to judge are counted apart. Both methods and every reference
solve each problem.
"""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from scipy.special import betaincinv

from verification.judging.verdict import Outcome
from verification.running.json_records import RecordFile

KINDS = ("round contacts", "thin films", "ellipses")
# Of log10 error/U: the ends of the bins; below the first and above the last all is counted in the outermost.
DECADES = tuple(float(x) for x in np.arange(-5, 1.01, 0.25))


@dataclass(frozen=True)
class Alarm:
    """One comparison that does not agree, or invariant that does not hold."""

    case: str
    title: str
    quantity: str
    line: str
    between: tuple[str, ...]
    outcome: Outcome
    reason: str


def wrong_first(alarms: Iterable[Alarm]) -> list[Alarm]:
    """Alarms in their order, those before the rest that do not merely find U above its cap."""
    return sorted(alarms, key=lambda one: one.outcome is Outcome.INCONCLUSIVE)


@dataclass(frozen=True)
class Ratios:
    """Error over uncertainty of every value of a method, the exact reference taken for the truth.

    counts : values in each of the bins of ``DECADES``.   within : share with an error of at most U.
    median : of U over the error.   largest : of the error over U.   Errors of rounding do not count.
    """

    source: str
    values: int
    within: float
    median: float
    counts: tuple[int, ...]
    largest: float = 0.0


@dataclass(frozen=True)
class Campaign:
    """``problems`` random problems of one ``kind`` and ``seed``, with provenance and seconds in total.

    agreeing : those without any alarm.   largest : difference over U.   source : hash of the code.
    """

    kind: str
    seed: int
    problems: int
    agreeing: int
    comparisons: int
    invariants: int
    alarms: tuple[Alarm, ...]
    largest: float
    started: str
    seconds: float
    commit: str | None
    machine: str
    versions: dict[str, str]
    ratios: tuple[Ratios, ...] = ()
    source: str = ""

    @property
    def judged(self) -> str:
        """Name, for ``source_hash``, of the code whose hash ``source`` is."""
        return "alarms" if self.kind == KINDS[-1] else "alarms of spheres"

    @property
    def wrong(self) -> set[str]:
        """Problems with a verdict that claims an error where there is none, or without a result."""
        return {one.case for one in self.alarms if one.outcome is not Outcome.INCONCLUSIVE}

    @property
    def vague(self) -> set[str]:
        """Problems with a verdict that finds U above its cap, and no false alarm."""
        return {one.case for one in self.alarms} - self.wrong


@dataclass(frozen=True)
class AlarmRecord:
    """The campaigns on one code, each of a kind and a seed, and what they sum up to."""

    campaigns: tuple[Campaign, ...]

    @property
    def kinds(self) -> dict[str, "AlarmRecord"]:
        """The campaigns of each kind that was drawn."""
        of = {kind: tuple(one for one in self.campaigns if one.kind == kind) for kind in KINDS}
        return {kind: AlarmRecord(drawn) for kind, drawn in of.items() if drawn}

    @property
    def problems(self) -> int:
        """Number of problems."""
        return sum(one.problems for one in self.campaigns)

    @property
    def wrong(self) -> int:
        """Number of problems with a false alarm."""
        return sum(len(one.wrong) for one in self.campaigns)

    @property
    def rate(self) -> float:
        """Upper bound at 95 % of the share of problems with a false alarm.

        The p at which so few have a probability of 5 % (Clopper and Pearson, Biometrika 26, 1934, 404-413).
        """
        return float(betaincinv(self.wrong + 1, self.problems - self.wrong, 0.95))


_FILE = RecordFile(AlarmRecord, "alarms.json", ("coatcheck-alarms/4",), "false alarms", "measure it again")
write_record, read_record = _FILE.write, _FILE.read
