"""The baseline that every run is compared with: its numbers, their date, the reason of each update."""

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from typing import Any

from verification.page.number_text import scientific
from verification.regression.manifest import (
    Manifest,
    ManifestDifference,
    differences,
    differing_tests,
    manifest_of,
)
from verification.regression.number_drift import Drift, Numbers, State, drift, measured
from verification.running.case_result import CaseResult, RunInfo
from verification.running.json_records import plain
from verification.running.provenance import NOT_INSTALLED

COUNTED = (State.SAME, State.DRIFTED, State.GONE, State.NEW)


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
    def beyond(self) -> bool:
        """True where a number is missing or changed by more than any machine explains."""
        return any(drift.beyond for drift in self.drifts)

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
    less : what is judged no longer.
    """

    why: str
    when: str
    commit: str | None
    machine: str
    versions: dict[str, str]
    numbers: int
    changes: dict[str, tuple[int, float | None]]
    less: tuple[ManifestDifference, ...] = ()


@dataclass(frozen=True, eq=False)
class RecordedCase:
    """The numbers of a case, the digest of its file, and the manifest of what was judged of it."""

    digest: str
    manifest: Manifest
    numbers: tuple[Numbers, ...]

    @classmethod
    def of(cls, result: CaseResult) -> "RecordedCase":
        """Record of a result."""
        return cls(digest(result.text), manifest_of(result), measured(result))

    @property
    def published(self) -> bool:
        """Whether it has published tables."""
        return bool(self.manifest.cells)


@dataclass(frozen=True, eq=False)
class Baseline:
    """Every case by its name, every update from first to last.

    self_tests : number of known answers of each self-test of the harness.
    """

    cases: Mapping[str, RecordedCase]
    history: tuple[Update, ...]
    self_tests: Mapping[str, int] = field(default_factory=dict)

    @property
    def last(self) -> Update:
        """The update that wrote the present numbers."""
        return self.history[-1]


@dataclass(frozen=True)
class Regression:
    """Comparison of a run with the baseline in ``folder``; ``update`` is None where there is no baseline.

    other_versions : (name, then, now) of the machine and each package that differs.
    judged : how what the run judged differs from the manifest.
    """

    folder: str
    update: Update | None
    cases: tuple[CaseDrift, ...]
    other_versions: tuple[tuple[str, str, str], ...] = ()
    judged: tuple[ManifestDifference, ...] = ()

    @property
    def less(self) -> tuple[ManifestDifference, ...]:
        """Differences that are missing, wider or fewer than the manifest records."""
        return tuple(row for row in self.judged if row.less)

    @property
    def beyond(self) -> bool:
        """True where a number is missing or changed by more than any machine explains."""
        return any(case.beyond for case in self.cases)

    @property
    def drifted(self) -> bool:
        """True where a number of the baseline changed or is missing."""
        return any(case.state in (State.DRIFTED, State.GONE) for case in self.cases)

    @property
    def unexplained(self) -> bool:
        """True where it drifted on the machine with the versions of the baseline, or ``beyond`` anywhere."""
        return self.beyond or (self.drifted and not self.other_versions)

    def of(self, name: str) -> CaseDrift | None:
        """The changes of the case ``name``, None where it was not compared."""
        return next((case for case in self.cases if case.name == name), None)


def against(
    results: Sequence[CaseResult], baseline: Baseline, *, whole: bool = False, published: bool = False
) -> tuple[CaseDrift, ...]:
    """The changes of every case; cases that a ``whole`` run or one of all ``published`` lacks are gone."""
    found = [case_drift(result, baseline) for result in results]
    names = {result.name for result in results}
    for name, case in baseline.cases.items():
        if (published if case.published else whole) and name not in names:
            gone = tuple(_unpaired(then, State.GONE) for then in case.numbers)
            found.append(CaseDrift(name, name, gone, "this case was not run"))
    return tuple(found)


def case_drift(result: CaseResult, baseline: Baseline) -> CaseDrift:
    """The changes of one case since ``baseline``."""
    recorded = baseline.cases.get(result.name)
    now = {numbers.key: numbers for numbers in measured(result)}
    then = {numbers.key: numbers for numbers in (recorded.numbers if recorded else ())}
    drifts = [drift(old, now[key]) if key in now else _unpaired(old, State.GONE) for key, old in then.items()]
    drifts += [_unpaired(numbers, State.NEW) for key, numbers in now.items() if key not in then]
    message = "not in the baseline"
    if recorded is not None:
        message = "" if recorded.digest == digest(result.text) else "its case file was changed"
    return CaseDrift(result.name, result.title, tuple(drifts), message)


def regression(
    results: Sequence[CaseResult],
    baseline: Baseline | None,
    folder: str,
    info: RunInfo,
    *,
    whole: bool = False,
    published: bool = False,
    self_tests: Mapping[str, int] | None = None,
) -> Regression:
    """Compare the ``results`` of the run ``info`` with ``baseline`` from ``folder``.

    whole, published : whether every such case was to be run.   self_tests : number of known answers of each.
    """
    if baseline is None:
        return Regression(folder, None, ())
    then = baseline.last
    other = differing({"machine": then.machine, **then.versions}, {"machine": info.machine, **info.versions})
    cases = against(results, baseline, whole=whole, published=published)
    judged = [
        row
        for result in results
        if result.name in baseline.cases
        for row in differences(result, baseline.cases[result.name].manifest)
    ]
    run = {result.name for result in results}
    judged += [
        ManifestDifference(c.name, "the case was not run", 1, True) for c in cases if c.name not in run
    ]
    if self_tests is not None:
        judged += differing_tests(baseline.self_tests, self_tests)
    return Regression(folder, then, cases, other, tuple(judged))


def differing(
    then: Mapping[str, str], now: Mapping[str, str], missing: str = NOT_INSTALLED
) -> tuple[tuple[str, str, str], ...]:
    """(name, then, now) of each text that differs, ``missing`` where one side lacks it."""
    names = dict.fromkeys([*then, *now])
    pairs = ((name, then.get(name, missing), now.get(name, missing)) for name in names)
    return tuple(pair for pair in pairs if pair[1] != pair[2])


def baseline_message(found: Regression) -> str:
    """Comparison of the run with its baseline, in one sentence."""
    if found.update is None:
        return f"There is no baseline in {found.folder}, so this run was not compared."
    counts = {state: sum(case.count(state) for case in found.cases) for state in State}
    parts = [f"{counts[state]} {state}" for state in COUNTED]
    largest = max((c.change for c in found.cases if c.change is not None), default=None)
    by = f"; the largest change is {scientific(largest)} of its scale" if largest is not None else ""
    return f"{', '.join(parts)}, of the {sum(counts.values())} numbers of these cases{by}."


def regression_json(found: Regression) -> dict[str, Any]:
    """The comparison as strict JSON: counts by case, every profile that changed."""
    cases = [
        {
            "name": case.name,
            "state": case.state,
            "message": case.message,
            "change": case.change,
            "beyond": case.beyond,
            **{state: case.count(state) for state in State},
            "profiles": [asdict(drift) for drift in case.drifts if drift.state is not State.SAME],
        }
        for case in found.cases
    ]
    update = found.update
    recorded = None if update is None else {"why": update.why, "when": update.when, "commit": update.commit}
    content = {"folder": found.folder, "recorded": recorded, "drifted": found.drifted}
    judged = [asdict(row) for row in found.judged]
    return plain(content | {"other_versions": found.other_versions, "cases": cases, "manifest": judged})


def updated(
    old: Baseline | None,
    results: Sequence[CaseResult],
    info: RunInfo,
    why: str,
    when: str,
    self_tests: Mapping[str, int] | None = None,
) -> Baseline:
    """The baseline of the ``results`` of the run ``info``, one update more than ``old``.

    Published cases that are not among them are kept.   self_tests : as in ``regression``.
    """
    cases = {result.name: RecordedCase.of(result) for result in results}
    tests = dict(self_tests or {})
    changes: dict[str, tuple[int, float | None]] = {}
    for case in against(results, old, whole=True) if old is not None else ():
        count = sum(case.count(state) for state in (State.DRIFTED, State.GONE, State.NEW))
        if count:
            changes[case.name] = (count, case.change)
    less: tuple[ManifestDifference, ...] = ()
    if old is not None:
        less = regression(results, old, "", info, whole=True, self_tests=tests).less
        cases |= {name: case for name, case in old.cases.items() if case.published and name not in cases}
    numbers = sum(n.count for case in cases.values() for n in case.numbers)
    update = Update(why, when, info.commit, info.machine, dict(info.versions), numbers, changes, less)
    return Baseline(cases, (*(old.history if old is not None else ()), update), tests)


def _unpaired(numbers: Numbers, state: State) -> Drift:
    gone = state is State.GONE
    message = "is no longer there" if gone else "was not there before"
    return Drift(*numbers.key, state, numbers.count, 0, None, message, beyond=gone)


def digest(text: str) -> str:
    """Digest that identifies a case file, 16 hexadecimal digits."""
    return hashlib.sha256(text.encode("utf-8", errors="replace")).hexdigest()[:16]
