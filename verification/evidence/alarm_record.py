"""False alarms: verdicts other than AGREES on random problems that contain no error.

Those that find the uncertainty too large to judge are counted apart. Both methods and every reference
solve each problem.
"""

from dataclasses import dataclass

import numpy as np

from verification.judging.verdict import Outcome
from verification.running.json_records import RecordFile

SCHEMA = "coatcheck-alarms/3"
READABLE = (SCHEMA, "coatcheck-alarms/2")  # the second without ratios
# Of log10 error/U: the ends of the bins; below the first and above the last all is counted in the outermost.
DECADES = tuple(float(x) for x in np.arange(-5, 1.01, 0.25))


@dataclass(frozen=True)
class Alarm:
    """One comparison that does not agree, or invariant that does not hold, with its case file."""

    case: str
    title: str
    quantity: str
    line: str
    between: tuple[str, ...]
    outcome: Outcome
    reason: str
    toml: str


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
class AlarmRecord:
    """The alarms of ``problems`` random problems of ``seed``, with provenance and seconds in total.

    agreeing : problems in which all comparisons agree and all invariants hold.   source : hash of the code.
    """

    seed: int
    problems: int
    agreeing: int
    comparisons: int
    invariants: int
    alarms: tuple[Alarm, ...]
    started: str
    seconds: float
    commit: str | None
    machine: str
    versions: dict[str, str]
    ratios: tuple[Ratios, ...] = ()
    source: str = ""

    @property
    def false_alarms(self) -> tuple[Alarm, ...]:
        """The verdicts that claim an error, or have no result, where there is no error."""
        return tuple(one for one in self.alarms if one.outcome is not Outcome.INCONCLUSIVE)

    @property
    def inconclusive(self) -> tuple[Alarm, ...]:
        """The verdicts that find U above its cap."""
        return tuple(one for one in self.alarms if one.outcome is Outcome.INCONCLUSIVE)

    @property
    def tally(self) -> str:
        """Both numbers in words."""
        text = f"{len(self.false_alarms)} false alarms"
        if vague := self.inconclusive:
            problems = len({one.case for one in vague})
            text += f" and {len(vague)} inconclusive verdicts (U above its cap, in {problems} problems)"
        return f"{text} in {self.comparisons} comparisons and {self.invariants} invariants"


_FILE = RecordFile(AlarmRecord, "alarms.json", READABLE, "false alarms", "measure it again")
write_record, read_record = _FILE.write, _FILE.read
