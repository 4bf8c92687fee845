"""The stored baseline that every run is held against, number by number.

    |now - then| <= 1e-8 scale

scale is the largest magnitude of the profile the number belongs to, so that a number near zero is not asked
for digits it does not have; a profile that is all but zero (a shear that symmetry forbids) takes a
thousandth of the largest profile of its source and kind instead. Of each profile are kept 17 points over
its whole length, its root mean square, into which every point enters, and its largest stated uncertainty:
the size of an uncertainty is that of a remainder, differs twofold between processors, and drifts where it
leaves a factor of four.
"""

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from enum import StrEnum
from typing import Any

import numpy as np
from numpy.typing import NDArray

from verification.profile import Profile
from verification.quantity import QUANTITIES
from verification.result import CaseResult, RunInfo, plain

__all__ = [
    "FACTOR",
    "RELATIVE",
    "Baseline",
    "CaseDrift",
    "Drift",
    "Numbers",
    "Regression",
    "State",
    "Update",
    "against",
    "case_drift",
    "digest",
    "measured",
    "regression",
    "regression_json",
    "updated",
]

Array = NDArray[np.float64]
RELATIVE = 1e-8
POINTS = 17
FAINT = 1e-3
FACTOR = 4.0
# Points further from where they were, over the length of the line, have values of their own.
SHIFT = 1e-6


class State(StrEnum):
    """What became of a number since the baseline; the worst comes first."""

    DRIFTED = "drifted"
    GONE = "gone"
    NEW = "new"
    SAME = "same"


@dataclass(frozen=True, eq=False)
class Numbers:
    """What is kept of one profile, in SI units.

    scale : what a change of ``value`` is measured by.   rms : root mean square over all ``size`` points,
    a number of its own where not all of them are kept.
    uncertainty : the largest that is stated, None where there is none.
    """

    source: str
    quantity: str
    line: str
    position: Array
    value: Array
    scale: float
    rms: float
    size: int
    uncertainty: float | None

    @property
    def key(self) -> tuple[str, str, str]:
        """What it is: source, quantity, line."""
        return self.source, self.quantity, self.line

    @property
    def count(self) -> int:
        """How many numbers these are: the values, the root mean square, the uncertainty."""
        return self.value.size + self.thinned + (self.uncertainty is not None)

    @property
    def thinned(self) -> bool:
        """True where the profile has more points than are kept."""
        return self.size > self.value.size


@dataclass(frozen=True)
class Drift:
    """What became of one profile: ``count`` numbers, of which ``moved`` are not what they were.

    change : the largest change of a value over its scale, None where there are not two values.
    said : what happened, in words; empty where nothing did.
    """

    source: str
    quantity: str
    line: str
    state: State
    count: int
    moved: int = 0
    change: float | None = None
    said: str = ""


@dataclass(frozen=True)
class CaseDrift:
    """What became of one case, profile by profile; ``said`` where it concerns the case as a whole."""

    name: str
    title: str
    drifts: tuple[Drift, ...]
    said: str = ""

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
        """How many numbers came to ``state``."""
        return sum(
            d.moved if state is State.DRIFTED else d.count - d.moved
            for d in self.drifts
            if d.state is state or (d.state is State.DRIFTED and state is State.SAME)
        )


@dataclass(frozen=True)
class Update:
    """One recorded change of the baseline: its reason in words, the run it was taken from.

    changes : by case, how many numbers were not what they had been, with their largest change over scale.
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
    """The numbers of every case, the digest of its file, every update from the first to the last."""

    cases: Mapping[str, tuple[Numbers, ...]]
    digests: Mapping[str, str]
    history: tuple[Update, ...]

    @property
    def last(self) -> Update:
        """The update that the present numbers come from."""
        return self.history[-1]


@dataclass(frozen=True)
class Regression:
    """A run held against the baseline in ``folder``; ``update`` is None where there was none to hold it to.

    other_versions : (name, then, now) of what the digits may come from.
    """

    folder: str
    update: Update | None
    cases: tuple[CaseDrift, ...]
    other_versions: tuple[tuple[str, str, str], ...] = ()

    @property
    def drifted(self) -> bool:
        """True where a number of the baseline is not what it was, or not there."""
        return any(case.state in (State.DRIFTED, State.GONE) for case in self.cases)

    def of(self, name: str) -> CaseDrift | None:
        """What became of the case ``name``."""
        return next((case for case in self.cases if case.name == name), None)


def measured(result: CaseResult, points: int = POINTS) -> tuple[Numbers, ...]:
    """The numbers of a result that enter a baseline: of each profile ``points`` values at most."""
    largest: dict[tuple[str, str], float] = {}
    for profile in result.profiles:
        kind = (profile.source, _kind(profile))
        largest[kind] = max(largest.get(kind, 0.0), _size(profile.value))
    return tuple(
        _numbers(profile, FAINT * largest[profile.source, _kind(profile)], points)
        for profile in result.profiles
        if profile.value.size
    )


def against(
    results: Sequence[CaseResult], baseline: Baseline, *, whole: bool, points: int = POINTS
) -> tuple[CaseDrift, ...]:
    """What became of every case; where the run is ``whole``, cases it lacks are gone.

    points : as the baseline was ``measured`` with.
    """
    found = [case_drift(result, baseline, points) for result in results]
    names = {result.name for result in results}
    for name, numbers in baseline.cases.items():
        if whole and name not in names:
            gone = tuple(_gone(then) for then in numbers)
            found.append(CaseDrift(name, name, gone, "this case was not run"))
    return tuple(found)


def case_drift(result: CaseResult, baseline: Baseline, points: int = POINTS) -> CaseDrift:
    """What became of one case since ``baseline``."""
    now = {numbers.key: numbers for numbers in measured(result, points)}
    stored = baseline.cases.get(result.name)
    if stored is None:
        drifts = tuple(_new(numbers) for numbers in now.values())
        return CaseDrift(result.name, result.title, drifts, "not in the baseline")
    then = {numbers.key: numbers for numbers in stored}
    drifts = tuple(drift(old, now[key]) if key in now else _gone(old) for key, old in then.items())
    drifts += tuple(_new(numbers) for key, numbers in now.items() if key not in then)
    changed = baseline.digests.get(result.name) != digest(result.text)
    return CaseDrift(result.name, result.title, drifts, "its case file was changed" if changed else "")


def drift(then: Numbers, now: Numbers) -> Drift:
    """What became of one profile."""
    if now.size != then.size or now.value.shape != then.value.shape:
        said = f"sampled at {now.size} points instead of {then.size}"
        return Drift(*then.key, State.DRIFTED, then.count, then.count, None, said)
    scale = max(then.scale, np.finfo(float).tiny)
    before, after = then.value, now.value
    if then.thinned:
        before, after = np.append(before, then.rms), np.append(after, now.rms)
    change = np.where(np.isnan(before) & np.isnan(after), 0.0, np.abs(after - before) / scale)
    moved = ~(change <= RELATIVE)  # a NaN that was a number has changed, too
    words = []
    reach = max(_size(then.position), np.finfo(float).tiny)
    shift = float(np.abs(now.position - then.position).max()) / reach
    if not shift <= RELATIVE:
        words.append(f"its points moved by {shift:.1e} of the line")
        moved[:] = True
    if moved.any() and shift <= RELATIVE:
        words.append(f"{int(moved.sum())} of {moved.size} values changed")
    spread = _spread_changed(then, now, scale)
    if spread:
        words.append(spread)
    count = int(moved.sum()) + bool(spread)
    largest: float | None = float(change.max()) if np.isfinite(change).all() else float("inf")
    if not shift <= SHIFT:
        largest = None
    state = State.DRIFTED if count else State.SAME
    return Drift(*then.key, state, then.count, count, largest, "; ".join(words))


def regression(
    results: Sequence[CaseResult], baseline: Baseline | None, folder: str, info: RunInfo, *, whole: bool
) -> Regression:
    """The run ``info`` with its ``results`` held against ``baseline``, which lies in ``folder``."""
    if baseline is None:
        return Regression(folder, None, ())
    then = baseline.last
    pairs = [("machine", then.machine, info.machine)]
    names = dict.fromkeys([*then.versions, *info.versions])
    pairs += [(n, then.versions.get(n, "none"), info.versions.get(n, "none")) for n in names]
    other = tuple((name, old, new) for name, old, new in pairs if old != new)
    return Regression(folder, then, against(results, baseline, whole=whole), other)


def regression_json(found: Regression) -> dict[str, Any]:
    """A run beside its baseline as strict JSON: counts by case, then each profile that is not the same."""
    cases = [
        {
            "name": case.name,
            "state": case.state,
            "said": case.said,
            "change": case.change,
            **{state: case.count(state) for state in State},
            "profiles": [asdict(drift) for drift in case.drifts if drift.state is not State.SAME],
        }
        for case in found.cases
    ]
    update = found.update
    recorded = None if update is None else {"why": update.why, "when": update.when, "commit": update.commit}
    return plain(
        {
            "folder": found.folder,
            "recorded": recorded,
            "drifted": found.drifted,
            "other_versions": found.other_versions,
            "cases": cases,
        }
    )


def updated(
    old: Baseline | None, results: Sequence[CaseResult], info: RunInfo, why: str, when: str
) -> Baseline:
    """The baseline of ``results`` of the run ``info``, with one line more of history than ``old``."""
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


def _numbers(profile: Profile, faint: float, points: int) -> Numbers:
    size = profile.value.size
    kept = np.unique(np.linspace(0, size - 1, min(size, points)).round().astype(int))
    scale = _size(profile.value) if _kind(profile) == "scalar" else max(_size(profile.value), faint)
    return Numbers(
        profile.source,
        profile.quantity,
        profile.line,
        profile.position[kept],
        profile.value[kept],
        scale,
        float(np.sqrt(np.mean(profile.value**2))),
        size,
        None if profile.uncertainty is None else float(np.abs(profile.uncertainty).max()),
    )


def _kind(profile: Profile) -> str:
    return QUANTITIES.get(profile.quantity, profile.quantity)


def _size(values: Array) -> float:
    """The largest magnitude of what is finite."""
    return float(np.abs(values[np.isfinite(values)]).max(initial=0.0))


def _spread_changed(then: Numbers, now: Numbers, scale: float) -> str:
    """In words how the stated uncertainty changed; empty where it did not, or is below all that counts."""
    if then.uncertainty is None or now.uncertainty is None:
        same = then.uncertainty is now.uncertainty
        return "" if same else "states an uncertainty, or none, other than before"
    before, after = (max(u, RELATIVE * scale) for u in (then.uncertainty, now.uncertainty))
    ratio = after / before
    return "" if 1 / FACTOR <= ratio <= FACTOR else f"its stated uncertainty is {ratio:.2g} times what it was"


def _gone(then: Numbers) -> Drift:
    return Drift(*then.key, State.GONE, then.count, 0, None, "is no longer there")


def _new(now: Numbers) -> Drift:
    return Drift(*now.key, State.NEW, now.count, 0, None, "was not there before")


def digest(text: str) -> str:
    """What a case file is known by."""
    return hashlib.sha256(text.encode("utf-8", errors="replace")).hexdigest()[:16]
