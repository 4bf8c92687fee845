"""Change of one profile since the baseline, number by number.

On the machine and with the versions of the baseline a value is the same where

    |now - then| <= max(1e-8 scale, min(U, 1e-6 scale))

and a stated uncertainty within ``SAME``, or, being made of changes of values, by the same rule and at most
``TWOFOLD``. On any machine a value has left its baseline where

    |now - then| > max(U, 5e-11 scale)

and an uncertainty where it is more than four times that of the baseline or less than a quarter, U the stated
uncertainty then.
scale is the largest magnitude of the profile, so that a number near zero needs no digits that it does not
have; of a profile that vanishes (a shear that symmetry forbids) it is a thousandth of the largest profile of
the same source and kind. 1e-6 is three times the largest change of a value within U that another kernel of
OpenBLAS or another number of threads caused: 3e-7, near the contact edge, where a value of the surface
follows the square root of the radius. An uncertainty is the size of a remainder, which may differ twofold
between processors; below 5e-11 scale it is not compared.
"""

from collections import defaultdict
from dataclasses import dataclass, replace
from enum import StrEnum

import numpy as np

from verification.problem.array_types import Array
from verification.problem.line_profile import Profile
from verification.problem.quantity import QUANTITIES
from verification.running.case_result import CaseResult

RELATIVE = 1e-8
KERNEL = 1e-6  # another kernel of BLAS, another number of threads
TOLERANCE = 5e-11
FAINT = 1e-3
FACTOR = 4.0
SAME, TWOFOLD = 1.1, 2.0
# Where points moved further, over the length of the line, their values are not compared.
SHIFT = 1e-6


class State(StrEnum):
    """State of a number since the baseline, the worst first."""

    DRIFTED = "drifted"
    GONE = "gone"
    NEW = "new"
    SAME = "same"


@dataclass(frozen=True, eq=False)
class Numbers(Profile):
    """A profile whose changes count over ``scale`` [SI]."""

    scale: float = 1.0

    @property
    def key(self) -> tuple[str, str, str]:
        """Source, quantity, line."""
        return self.source, self.quantity, self.line

    @property
    def count(self) -> int:
        """Number of values and uncertainties."""
        return self.value.size * (1 if self.uncertainty is None else 2)


@dataclass(frozen=True)
class Drift:
    """Change of one profile: of its ``count`` numbers ``moved`` have changed.

    change : the largest change of a value over its scale, None where there are not two values.
    message : what changed, empty where nothing did.   beyond : changed by more than any machine explains.
    """

    source: str
    quantity: str
    line: str
    state: State
    count: int
    moved: int = 0
    change: float | None = None
    message: str = ""
    beyond: bool = False


def measured(result: CaseResult) -> tuple[Numbers, ...]:
    """The numbers of a result that a baseline stores."""
    largest: dict[tuple[str, str], float] = defaultdict(float)
    for profile in result.profiles:
        key = (profile.source, _kind(profile))
        largest[key] = max(largest[key], _size(profile.value))
    found = []
    for profile in result.profiles:
        kind, scale = _kind(profile), _size(profile.value)
        if kind not in ("scalar", "peak"):
            scale = max(scale, FAINT * largest[profile.source, kind])
        if profile.value.size:
            found.append(Numbers(**vars(profile), scale=scale))
    return tuple(found)


def drift(then: Numbers, now: Numbers) -> Drift:
    """The change of one profile from ``then`` to ``now``."""
    if now.value.shape != then.value.shape:
        message = f"sampled at {now.value.size} points instead of {then.value.size}"
        return Drift(*then.key, State.DRIFTED, then.count, then.count, None, message, beyond=True)
    scale = max(then.scale, np.finfo(float).tiny)
    reach = max(_size(then.position), np.finfo(float).tiny)
    shift = float(np.abs(now.position - then.position).max()) / reach
    change = np.abs(now.value - then.value) / scale
    change = np.where(np.isnan(then.value) & np.isnan(now.value), 0.0, change)
    stated = RELATIVE * scale if then.uncertainty is None else then.uncertainty
    with np.errstate(over="ignore"):
        departure = change / np.fmax(stated / scale, TOLERANCE)
    left = ~(departure <= 1.0)  # a number that became NaN has left
    near = np.fmax(RELATIVE, np.fmin(stated / scale, KERNEL))
    moved = left | ~(change <= near) | (not shift <= SHIFT)
    ratio = _ratio(then, now, TOLERANCE * scale)
    other, twofold, far = (~((ratio >= 1 / factor) & (ratio <= factor)) for factor in (SAME, TWOFOLD, FACTOR))
    if now.uncertainty is not None and then.uncertainty is not None:
        other &= twofold | ~(np.abs(now.uncertainty - then.uncertainty) / scale <= near)
    messages = []
    if not shift <= SHIFT:
        messages.append(f"its points moved by {shift:.1e} of the line")
    elif moved.any():
        messages.append(f"{int(moved.sum())} of {moved.size} values changed")
    if left.any() and shift <= SHIFT:
        messages.append(f"{int(left.sum())} by more than their uncertainty")
    if other.any():
        worst = ratio[np.argmax(np.abs(np.log(ratio)))]
        messages.append(
            f"{int(other.sum())} uncertainties changed, to {worst:.2g} times that of the baseline"
        )
    count = int(moved.sum() + other.sum())
    beyond = bool(not shift <= SHIFT or left.any() or far.any())
    state = State.DRIFTED if count else State.SAME
    found = Drift(*then.key, state, then.count, min(count, then.count), None, "; ".join(messages), beyond)
    if shift > SHIFT:
        return found
    return replace(found, change=float(change.max()) if np.isfinite(change).all() else float("inf"))


def _ratio(then: Numbers, now: Numbers, least: float) -> Array:
    """Uncertainty over that of the baseline, both at least ``least``; infinite where only one states one."""
    if then.uncertainty is None or now.uncertainty is None:
        same = then.uncertainty is now.uncertainty
        return np.full(then.value.shape, 1.0 if same else np.inf)
    old, new = (np.abs(one) for one in (then.uncertainty, now.uncertainty))
    ratio = np.maximum(new, least) / np.fmax(old, least)
    return np.where(np.isnan(old) == np.isnan(new), np.where(np.isnan(new), 1.0, ratio), np.inf)


def _kind(profile: Profile) -> str:
    name = profile.quantity
    return QUANTITIES[name].kind if name in QUANTITIES else name


def _size(values: Array) -> float:
    """Largest finite magnitude."""
    return float(np.abs(values[np.isfinite(values)]).max(initial=0.0))
