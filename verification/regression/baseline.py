"""The baseline that every run is compared with: its numbers, their date, the reason of each update."""

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

from verification.regression.drift import POINTS, Drift, Numbers, State, drift, measured
from verification.running.records import plain
from verification.running.result import CaseResult, RunInfo


@dataclass(frozen=True)
class CaseDrift:
    """Changes of one case, profile by profile; ``message`` concerns the case as a whole."""

    name: str
    title: str
    drifts: tuple[Drift, ...]
    message: str = ""

    @property
    def state(self) -> State:
        """The worst state of its profiles."""
        found = {drift.state for drift in self.drifts}
        return next((state for state in State if state in found), State.NEW)

    @property
    def change(self) -> float | None:
        """The largest change of a value over its scale."""
        return max((d.change for d in self.drifts if d.change is not None), default=None)

    def count(self, state: State) -> int:
        """Number of numbers in ``state``."""
        return sum(
            d.moved if state is State.DRIFTED else d.count - d.moved
            for d in self.drifts
            if d.state is state or (d.state is State.DRIFTED and state is State.SAME)
        )


@dataclass(frozen=True)
class Update:
    """One update of the baseline: its reason, the run it was made from.

    changes : by case, how many numbers changed, with the largest change over its scale.
    """

    why: str
    when: str
    commit: str | None
    machine: str
    versions: dict[str, str]
    numbers: int
    changes: dict[str, tuple[int, float | None]]


@dataclass(frozen=True, eq=False)
class Baseline:
    """The numbers of every case, the digest of its file, every update from first to last."""

    cases: Mapping[str, tuple[Numbers, ...]]
    digests: Mapping[str, str]
    history: tuple[Update, ...]

    @property
    def last(self) -> Update:
        """The update that wrote the present numbers."""
        return self.history[-1]


@dataclass(frozen=True)
class Regression:
    """Comparison of a run with the baseline in ``folder``; ``update`` is None where there is no baseline.

    other_versions : (name, then, now) of the machine and each package that differs.
    """

    folder: str
    update: Update | None
    cases: tuple[CaseDrift, ...]
    other_versions: tuple[tuple[str, str, str], ...] = ()

    @property
    def drifted(self) -> bool:
        """True where a number of the baseline changed or is missing."""
        return any(case.state in (State.DRIFTED, State.GONE) for case in self.cases)

    @property
    def unexplained(self) -> bool:
        """True where it drifted on the machine with the versions of the baseline: the code has changed."""
        return self.drifted and not self.other_versions

    def of(self, name: str) -> CaseDrift | None:
        """The changes of the case ``name``, None where it was not compared."""
        return next((case for case in self.cases if case.name == name), None)


def against(
    results: Sequence[CaseResult], baseline: Baseline, *, whole: bool, points: int = POINTS
) -> tuple[CaseDrift, ...]:
    """The changes of every case; cases that a ``whole`` run lacks are gone.

    points : that the baseline was ``measured`` with.
    """
    found = [case_drift(result, baseline, points) for result in results]
    names = {result.name for result in results}
    for name, numbers in baseline.cases.items():
        if whole and name not in names:
            gone = tuple(_unpaired(then, State.GONE) for then in numbers)
            found.append(CaseDrift(name, name, gone, "this case was not run"))
    return tuple(found)


def case_drift(result: CaseResult, baseline: Baseline, points: int = POINTS) -> CaseDrift:
    """The changes of one case since ``baseline``."""
    now = {numbers.key: numbers for numbers in measured(result, points)}
    then = {numbers.key: numbers for numbers in baseline.cases.get(result.name, ())}
    drifts = [drift(old, now[key]) if key in now else _unpaired(old, State.GONE) for key, old in then.items()]
    drifts += [_unpaired(numbers, State.NEW) for key, numbers in now.items() if key not in then]
    message = "" if baseline.digests.get(result.name) == digest(result.text) else "its case file was changed"
    if result.name not in baseline.cases:
        message = "not in the baseline"
    return CaseDrift(result.name, result.title, tuple(drifts), message)


def regression(
    results: Sequence[CaseResult], baseline: Baseline | None, folder: str, info: RunInfo, *, whole: bool
) -> Regression:
    """Compare the ``results`` of the run ``info`` with ``baseline`` from ``folder``."""
    if baseline is None:
        return Regression(folder, None, ())
    then = baseline.last
    other = differing({"machine": then.machine, **then.versions}, {"machine": info.machine, **info.versions})
    return Regression(folder, then, against(results, baseline, whole=whole), other)


def differing(then: Mapping[str, str], now: Mapping[str, str]) -> tuple[tuple[str, str, str], ...]:
    """(name, then, now) of each text that differs, "none" where one side lacks it."""
    pairs = ((name, then.get(name, "none"), now.get(name, "none")) for name in dict.fromkeys([*then, *now]))
    return tuple(pair for pair in pairs if pair[1] != pair[2])


def regression_json(found: Regression) -> dict[str, Any]:
    """The comparison as strict JSON: counts by case, every profile that changed."""
    cases = [
        {
            "name": case.name,
            "state": case.state,
            "message": case.message,
            "change": case.change,
            **{state: case.count(state) for state in State},
            "profiles": [asdict(drift) for drift in case.drifts if drift.state is not State.SAME],
        }
        for case in found.cases
    ]
    update = found.update
    recorded = None if update is None else {"why": update.why, "when": update.when, "commit": update.commit}
    content = {"folder": found.folder, "recorded": recorded, "drifted": found.drifted}
    return plain(content | {"other_versions": found.other_versions, "cases": cases})


def updated(
    old: Baseline | None, results: Sequence[CaseResult], info: RunInfo, why: str, when: str
) -> Baseline:
    """The baseline of the ``results`` of the run ``info``, one update more than ``old``."""
    cases = {result.name: measured(result) for result in results}
    changes: dict[str, tuple[int, float | None]] = {}
    for case in against(results, old, whole=True) if old is not None else ():
        count = sum(case.count(state) for state in (State.DRIFTED, State.GONE, State.NEW))
        if count:
            changes[case.name] = (count, case.change)
    numbers = sum(n.count for found in cases.values() for n in found)
    update = Update(why, when, info.commit, info.machine, dict(info.versions), numbers, changes)
    digests = {result.name: digest(result.text) for result in results}
    return Baseline(cases, digests, (*(old.history if old is not None else ()), update))


def _unpaired(numbers: Numbers, state: State) -> Drift:
    message = "is no longer there" if state is State.GONE else "was not there before"
    return Drift(*numbers.key, state, numbers.count, 0, None, message)


def digest(text: str) -> str:
    """Digest that identifies a case file, 16 hexadecimal digits."""
    return hashlib.sha256(text.encode("utf-8", errors="replace")).hexdigest()[:16]
