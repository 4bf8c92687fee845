"""Comparison of two runs: verdicts, numbers, versions, times."""

from dataclasses import dataclass
from itertools import chain

from verification.judging.verdict import Outcome
from verification.page.number_text import scientific
from verification.regression.baseline_change import Baseline, CaseDrift, RecordedCase, against, differing
from verification.regression.number_drift import State
from verification.running.case_result import CaseResult
from verification.running.stored_run import StoredRun


@dataclass(frozen=True)
class VerdictChange:
    """A claim whose outcome differs between two runs; None where a run does not make it."""

    case: str
    quantity: str
    line: str
    between: tuple[str, str]
    before: Outcome | None
    after: Outcome | None
    reason: str

    @property
    def worse(self) -> bool:
        """True where a comparison that agreed no longer does."""
        return self.before is Outcome.AGREES and self.after is not Outcome.AGREES


@dataclass(frozen=True)
class RunComparison:
    """Differences of the second run from the first.

    cases : changes at every point of every profile.   versions : (name, then, now) that differ, with command,
    commit, machine.
    seconds : (case, then, now), None where a run lacks the case.
    """

    paths: tuple[str, str]
    started: tuple[str, str]
    cases: tuple[CaseDrift, ...]
    verdicts: tuple[VerdictChange, ...]
    versions: tuple[tuple[str, str, str], ...]
    seconds: tuple[tuple[str, float | None, float | None], ...]

    @property
    def drifted(self) -> bool:
        """True where a number changed, is missing or is new."""
        return any(case.state is not State.SAME for case in self.cases)

    @property
    def worse(self) -> bool:
        """True where a comparison that agreed no longer does."""
        return any(change.worse for change in self.verdicts)


def compare_runs(a: StoredRun, b: StoredRun) -> RunComparison:
    """Differences of run ``b`` from run ``a``, at every point of every profile."""
    first = Baseline({result.name: RecordedCase.of(result) for result in a.results}, ())
    names = dict.fromkeys(result.name for result in (*a.results, *b.results))
    found = {name: (a.result(name), b.result(name)) for name in names}
    changes = (_verdicts(name, one, two) for name, (one, two) in found.items() if one and two)
    return RunComparison(
        (str(a.path), str(b.path)),
        (a.info.started, b.info.started),
        against(b.results, first, whole=True, published=True),
        tuple(chain.from_iterable(changes)),
        differing(_provenance(a), _provenance(b), "none"),
        tuple(
            (name, one.seconds if one else None, two.seconds if two else None)
            for name, (one, two) in found.items()
        ),
    )


def _verdicts(name: str, one: CaseResult, two: CaseResult) -> list[VerdictChange]:
    before, after = (
        {(c.quantity, c.line, c.between): v for c, v in result.verdicts} for result in (one, two)
    )
    found = []
    for key in dict.fromkeys([*before, *after]):
        then, now = before.get(key), after.get(key)
        if then is None or now is None or then.outcome is not now.outcome:
            reason = now.reason if now else "is not claimed any more"
            outcomes = (then.outcome if then else None, now.outcome if now else None)
            found.append(VerdictChange(name, *key, *outcomes, reason))
    return found


def _provenance(run: StoredRun) -> dict[str, str]:
    return {
        name: str(getattr(run.info, name)) for name in ("command", "commit", "machine")
    } | run.info.versions


def comparison_message(found: RunComparison) -> str:
    """Changes from the first run to the second, in one sentence."""
    worse = sum(change.worse for change in found.verdicts)
    changed = f"{len(found.verdicts)} verdicts changed" if found.verdicts else "No verdict changed"
    changed += f", {worse} of them no longer AGREES" if worse else ""
    moved = sum(case.count(State.DRIFTED) for case in found.cases)
    total = sum(case.count(state) for case in found.cases for state in State)
    largest = max((c.change for c in found.cases if c.change is not None), default=None)
    drifted = f"{moved} of {total} numbers drifted" if moved else f"all {total} numbers are the same"
    if any(case.state is State.GONE or case.state is State.NEW for case in found.cases) and not moved:
        drifted = "no common number drifted"
    by = f", by at most {scientific(largest)} of their scale" if largest else ""
    return f"{changed}; {drifted}{by}."
