"""One profile held against what it was, number by number.

    |now - then| <= 1e-8 scale

scale is the largest magnitude of the profile the number belongs to, so that a number near zero is not asked
for digits it does not have; a profile that is all but zero (a shear that symmetry forbids) takes a
thousandth of the largest profile of its source and kind instead. Of each profile are kept 17 points over
its whole length, its root mean square, into which every point enters, and its largest stated uncertainty:
the size of an uncertainty is that of a remainder, differs twofold between processors, and drifts where it
leaves a factor of four.
"""

from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from verification.problem.arrays import Array
from verification.problem.profile import Profile
from verification.problem.quantity import QUANTITIES
from verification.running.result import CaseResult

__all__ = ["FACTOR", "POINTS", "RELATIVE", "Drift", "Numbers", "State", "drift", "measured"]

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
    name = profile.quantity
    return QUANTITIES[name].kind if name in QUANTITIES else name


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
