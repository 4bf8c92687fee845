"""One invariant of one solution with the bound that decides it."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from verification.judging.verdict import Outcome

__all__ = ["CAP", "ROUNDING", "Invariant", "absent", "decide"]


# A field is a sum of some thousand terms, each good to one unit in the last place.
ROUNDING = 4096 * float(np.finfo(float).eps)
# Of p_h, like the cap on a comparison of stresses: a law checked no closer than this is not checked.
CAP = 5e-3


@dataclass(frozen=True)
class Invariant:
    """``name`` holds for ``source`` where ``value`` does not exceed ``bound``, both dimensionless.

    value, bound : at the point that decides; None where there is no such number.
    message : the law, the residual, the bound.
    """

    name: str
    source: str
    value: float | None
    bound: float | None
    outcome: Outcome
    message: str

    @property
    def share(self) -> float | None:
        """value / bound; beyond 1 the law is broken."""
        return None if self.value is None or not self.bound else self.value / self.bound

    @property
    def margin(self) -> float | None:
        """bound - value; negative where the law is broken."""
        return None if self.value is None or self.bound is None else self.bound - self.value


def decide(
    name: str, source: str, law: str, residual: ArrayLike, bound: ArrayLike | None, cap: float = CAP
) -> Invariant:
    """The invariant from its ``residual`` at any points and the ``bound`` at each, over one scale.

    Decided where the residual takes the largest share of its bound. A residual or bound that is no number
    is NO_RESULT; a bound beyond ``cap``, or None since nothing is stated, leaves it INCONCLUSIVE.
    """
    r = np.abs(np.asarray(residual, dtype=float)).ravel()
    if r.size == 0 or not np.isfinite(r).all():
        lost = int(r.size - np.isfinite(r).sum())
        return absent(name, source, f"{law}: not finite at {lost} of {r.size} points")
    if bound is None:
        worst = float(r.max())
        said = f"{law}: off by {worst:.1e}; no uncertainty is stated that would bound it"
        return Invariant(name, source, worst, None, Outcome.INCONCLUSIVE, said)
    U = np.broadcast_to(np.asarray(bound, dtype=float), np.shape(residual)).ravel() + ROUNDING
    if not np.isfinite(U).all() or U.min() < 0:
        return absent(name, source, f"{law}: the uncertainty it is held against is not a number everywhere")
    at = int(np.argmax(r / U))
    value, allowed = float(r[at]), float(U[at])
    said = f"{law}: off by {value:.1e} where {allowed:.1e} is allowed"
    if value > allowed:
        return Invariant(name, source, value, allowed, Outcome.DISAGREES, said)
    if U.max() > cap:
        said = f"{law}: bounded by {U.max():.1e} only, beyond the cap {cap:.1e}"
        return Invariant(name, source, float(r[U.argmax()]), float(U.max()), Outcome.INCONCLUSIVE, said)
    return Invariant(name, source, value, allowed, Outcome.AGREES, said)


def absent(name: str, source: str, reason: str) -> Invariant:
    """An invariant that came to nothing."""
    return Invariant(name, source, None, None, Outcome.NO_RESULT, reason)
