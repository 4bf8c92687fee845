"""Comparison of two runs: verdicts, numbers, versions, times."""

from dataclasses import dataclass

from verification.judging.verdict import Outcome
from verification.regression.baseline import Baseline, CaseDrift, Update, against, digest
from verification.regression.drift import State, measured
from verification.running.result import CaseResult
from verification.running.stored import StoredRun

EVERY = 1_000_000  # more points than a profile has


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
    update = Update("", a.info.started, a.info.commit, a.info.machine, a.info.versions, 0, {})
    first = Baseline(
        {result.name: measured(result, EVERY) for result in a.results},
        {result.name: digest(result.text) for result in a.results},
        (update,),
    )
    names = list(dict.fromkeys(result.name for result in (*a.results, *b.results)))
    found = {name: (a.result(name), b.result(name)) for name in names}
    changes = [
        change for name, (one, two) in found.items() if one and two for change in _verdicts(name, one, two)
    ]
    return RunComparison(
        (str(a.path), str(b.path)),
        (a.info.started, b.info.started),
        against(b.results, first, whole=True, points=EVERY),
        tuple(changes),
        _versions(a, b),
        tuple(
            (name, None if one is None else one.seconds, None if two is None else two.seconds)
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
            reason = now.reason if now is not None else "is not claimed any more"
            outcomes = (None if then is None else then.outcome, None if now is None else now.outcome)
            found.append(VerdictChange(name, *key, *outcomes, reason))
    return found


def _versions(a: StoredRun, b: StoredRun) -> tuple[tuple[str, str, str], ...]:
    pairs = [(n, str(getattr(a.info, n)), str(getattr(b.info, n))) for n in ("command", "commit", "machine")]
    for name in dict.fromkeys([*a.info.versions, *b.info.versions]):
        pairs.append((name, a.info.versions.get(name, "none"), b.info.versions.get(name, "none")))
    return tuple((name, then, now) for name, then, now in pairs if then != now)
