"""Change of one profile since the baseline, number by number.

    |now - then| <= 1e-8 scale

scale is the largest magnitude of the profile, so that a number near zero needs no digits that it does not
have; of a profile that vanishes (a shear that symmetry forbids) it is a thousandth of the largest profile of
the same source and kind. A profile is represented by 17 points over its whole length, its root mean square,
which depends on every point, and its largest stated uncertainty. An uncertainty is the size of a remainder
and differs twofold between processors: it has drifted where it changed more than fourfold.
"""

from collections import defaultdict
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from verification.problem.arrays import Array
from verification.problem.profile import Profile
from verification.problem.quantity import QUANTITIES
from verification.running.result import CaseResult

RELATIVE = 1e-8
POINTS = 17
FAINT = 1e-3
FACTOR = 4.0
# Where points moved further, over the length of the line, their values are not compared.
SHIFT = 1e-6


class State(StrEnum):
    """State of a number since the baseline, the worst first."""

    DRIFTED = "drifted"
    GONE = "gone"
    NEW = "new"
    SAME = "same"


@dataclass(frozen=True, eq=False)
class Numbers:
    """The stored numbers of one profile, in SI units.

    scale : divisor of a change of ``value``.   rms : root mean square over all ``size`` points, compared
    where not all of them are stored.   uncertainty : the largest stated one, None where there is none.
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
        """Source, quantity, line."""
        return self.source, self.quantity, self.line

    @property
    def count(self) -> int:
        """Number of values, with root mean square and uncertainty."""
        return self.value.size + self.thinned + (self.uncertainty is not None)

    @property
    def thinned(self) -> bool:
        """True where the profile has more points than are stored."""
        return self.size > self.value.size


@dataclass(frozen=True)
class Drift:
    """Change of one profile: of its ``count`` numbers ``moved`` have changed.

    change : the largest change of a value over its scale, None where there are not two values.
    message : what changed, empty where nothing did.
    """

    source: str
    quantity: str
    line: str
    state: State
    count: int
    moved: int = 0
    change: float | None = None
    message: str = ""


def measured(result: CaseResult, points: int = POINTS) -> tuple[Numbers, ...]:
    """The numbers of a result that a baseline stores: of each profile at most ``points`` values."""
    largest: dict[tuple[str, str], float] = defaultdict(float)
    for profile in result.profiles:
        kind = (profile.source, _kind(profile))
        largest[kind] = max(largest[kind], _size(profile.value))
    return tuple(
        _numbers(profile, FAINT * largest[profile.source, _kind(profile)], points)
        for profile in result.profiles
        if profile.value.size
    )


def drift(then: Numbers, now: Numbers) -> Drift:
    """The change of one profile."""
    if now.size != then.size or now.value.shape != then.value.shape:
        message = f"sampled at {now.size} points instead of {then.size}"
        return Drift(*then.key, State.DRIFTED, then.count, then.count, None, message)
    scale = max(then.scale, np.finfo(float).tiny)
    before, after = then.value, now.value
    if then.thinned:
        before, after = np.append(before, then.rms), np.append(after, now.rms)
    change = np.where(np.isnan(before) & np.isnan(after), 0.0, np.abs(after - before) / scale)
    moved = ~(change <= RELATIVE)  # a number that became NaN has changed
    messages = []
    reach = max(_size(then.position), np.finfo(float).tiny)
    shift = float(np.abs(now.position - then.position).max()) / reach
    if not shift <= RELATIVE:
        messages.append(f"its points moved by {shift:.1e} of the line")
        moved[:] = True
    if moved.any() and shift <= RELATIVE:
        messages.append(f"{int(moved.sum())} of {moved.size} values changed")
    uncertainty = _uncertainty_change(then, now, scale)
    if uncertainty:
        messages.append(uncertainty)
    count = int(moved.sum()) + bool(uncertainty)
    largest = float(change.max()) if np.isfinite(change).all() else float("inf")
    state = State.DRIFTED if count else State.SAME
    comparable = largest if shift <= SHIFT else None
    return Drift(*then.key, state, then.count, count, comparable, "; ".join(messages))


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
    """Largest finite magnitude."""
    return float(np.abs(values[np.isfinite(values)]).max(initial=0.0))


def _uncertainty_change(then: Numbers, now: Numbers, scale: float) -> str:
    """Message on the change of the stated uncertainty; empty where it is below what counts."""
    if then.uncertainty is None or now.uncertainty is None:
        same = then.uncertainty is now.uncertainty
        return "" if same else "only one of the two states an uncertainty"
    ratio = max(now.uncertainty, RELATIVE * scale) / max(then.uncertainty, RELATIVE * scale)
    same = 1 / FACTOR <= ratio <= FACTOR
    return "" if same else f"its stated uncertainty is {ratio:.2g} times that of the baseline"
