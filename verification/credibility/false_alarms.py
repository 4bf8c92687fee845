"""False alarms counted: verdicts other than AGREES on random problems that contain no error."""

from collections.abc import Sequence

import numpy as np

from verification.evidence.alarm_record import DECADES, Alarm, AlarmRecord, Ratios
from verification.judging.verdict import Outcome
from verification.running.case_result import CaseResult, RunInfo
from verification.sources.source_registry import EXACT, METHODS

LEAST = 1e-9  # of the largest reference value of a profile: smaller errors are rounding


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
