"""False alarms: verdicts other than AGREES on random problems that contain no error.

Both methods and every reference solve each problem.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from verification.judging.verdict import Outcome
from verification.running.case_result import CaseResult, RunInfo
from verification.running.json_records import RecordFile
from verification.sources.source_registry import EXACT, METHODS

SCHEMA = "coatcheck-alarms/3"
READABLE = (SCHEMA, "coatcheck-alarms/2")  # the second without ratios
# Of log10 error/U: the ends of the bins; below the first and above the last all is counted in the outermost.
DECADES = tuple(float(x) for x in np.arange(-5, 1.01, 0.25))
LEAST = 1e-9  # of the largest reference value of a profile: smaller errors are rounding


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
    median : of U over the error.   largest : of the error over U.   Errors below ``LEAST`` do not count.
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

    agreeing : problems in which all comparisons agree and all invariants hold.
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


def counted(results: Sequence[CaseResult], seed: int, info: RunInfo) -> AlarmRecord:
    """The alarms in ``results``; a case without any comparison is one."""
    verdicts = [(r, claim, verdict) for r in results for claim, verdict in r.verdicts]
    invariants = [(r, invariant) for r in results for invariant in r.invariants]
    nothing = ("", "", (), Outcome.NO_RESULT, "nothing was compared")
    found: list[tuple[CaseResult, tuple[str, str, tuple[str, ...], Outcome, str]]] = [
        *((r, (c.quantity, c.line, c.between, v.outcome, v.reason)) for r, c, v in verdicts),
        *((r, (i.name, "", (i.source,), i.outcome, i.message)) for r, i in invariants),
        *((r, nothing) for r in results if not r.verdicts),
    ]
    alarms = [Alarm(r.name, r.title, *row, r.text) for r, row in found if row[3] is not Outcome.AGREES]
    return AlarmRecord(
        seed,
        len(results),
        sum(result.outcome is Outcome.AGREES for result in results),
        len(verdicts),
        len(invariants),
        tuple(alarms),
        info.started,
        info.seconds,
        info.commit,
        info.machine,
        dict(info.versions),
        tuple(_ratios(results, source) for source in METHODS),
    )


def _ratios(results: Sequence[CaseResult], source: str) -> Ratios:
    found = []
    for result in results:
        profiles = {(p.quantity, p.line, p.source): p for p in result.profiles}
        for (quantity, line, name), mine in profiles.items():
            exact = profiles.get((quantity, line, EXACT[0]))
            if name != source or exact is None or mine.uncertainty is None or exact.uncertainty is None:
                continue
            error = np.abs(mine.value - exact.value)
            counted = error > LEAST * np.abs(exact.value).max(initial=0.0)
            U = (mine.uncertainty + exact.uncertainty)[counted]
            found.append(error[counted] / np.maximum(U, np.finfo(float).tiny))
    ratio = np.concatenate(found) if found else np.zeros(0)
    place = np.clip(np.log10(np.maximum(ratio, 1e-99)), DECADES[0], DECADES[-1])
    counts, _ = np.histogram(place, DECADES)
    within, median = (float(np.mean(ratio <= 1)), float(1 / np.median(ratio))) if ratio.size else (1.0, 0.0)
    return Ratios(
        source, int(ratio.size), within, median, tuple(counts.tolist()), float(ratio.max(initial=0.0))
    )


_FILE = RecordFile(AlarmRecord, "alarms.json", READABLE, "false alarms", "measure it again")
path_in, write_record, read_record = _FILE.path_in, _FILE.write, _FILE.read
