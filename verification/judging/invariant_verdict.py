"""An invariant of one solution, decided by a bound."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from verification.judging.verdict import Outcome
from verification.problem.coated_contact import CoatedContact

# A field is a sum of some thousand terms, each good to one unit in the last place.
ROUNDING = 4096 * float(np.finfo(float).eps)
# Largest admissible bound, dimensionless: with a larger one an invariant is INCONCLUSIVE. Five times the cap
# of a comparison of stresses, since a bound adds the uncertainties of several stresses and of differences.
CAP = 5e-3


@dataclass(frozen=True)
class Invariant:
    """``name`` holds for ``source`` where ``value`` does not exceed ``bound``, both dimensionless.

    value, bound : at the deciding point; None where there is no such number.
    message : the law, the residual, the bound.
    cap : largest admissible bound.   points : number of residuals; 0 where there is no result.
    widest : the largest bound at any point, None where there is none.
    """

    name: str
    source: str
    value: float | None
    bound: float | None
    outcome: Outcome
    message: str
    cap: float = CAP
    points: int = 0
    widest: float | None = None

    @property
    def share(self) -> float | None:
        """value / bound; beyond 1 the invariant is violated."""
        return None if self.value is None or not self.bound else self.value / self.bound

    @property
    def margin(self) -> float | None:
        """bound - value; negative where the invariant is violated."""
        return None if self.value is None or self.bound is None else self.bound - self.value


def decide(
    name: str, source: str, law: str, residual: ArrayLike, bound: ArrayLike | None, cap: float = CAP
) -> Invariant:
    """The invariant ``law`` from its ``residual`` at any points and the ``bound`` at each, dimensionless.

    The point with the largest |residual|/bound decides. A residual or bound that is not finite is NO_RESULT;
    a bound above ``cap``, or None where no uncertainty is stated, is INCONCLUSIVE.
    """
    r = np.abs(np.asarray(residual, dtype=float)).ravel()
    if r.size == 0 or not np.isfinite(r).all():
        lost = int(r.size - np.isfinite(r).sum())
        return absent(name, source, f"{law}: not finite at {lost} of {r.size} points")
    if bound is None:
        worst = float(r.max())
        message = f"{law}: residual {worst:.1e}; no uncertainty is stated to bound it"
        return Invariant(name, source, worst, None, Outcome.INCONCLUSIVE, message, cap, r.size)
    U = np.broadcast_to(np.asarray(bound, dtype=float), np.shape(residual)).ravel() + ROUNDING
    if not np.isfinite(U).all() or U.min() < 0:
        return absent(name, source, f"{law}: the bound is not finite everywhere")
    at = int(np.argmax(r / U))
    value, allowed, widest = float(r[at]), float(U[at]), float(U.max())
    message = f"{law}: residual {value:.1e}, bound {allowed:.1e}"
    if value > allowed:
        return Invariant(name, source, value, allowed, Outcome.DISAGREES, message, cap, r.size, widest)
    if widest > cap:
        message = f"{law}: bound {widest:.1e} exceeds the cap {cap:.1e}"
        value = float(r[U.argmax()])
        return Invariant(name, source, value, widest, Outcome.INCONCLUSIVE, message, cap, r.size, widest)
    return Invariant(name, source, value, allowed, Outcome.AGREES, message, cap, r.size, widest)


def absent(name: str, source: str, reason: str) -> Invariant:
    """An invariant without a result, for ``reason``."""
    return Invariant(name, source, None, None, Outcome.NO_RESULT, reason)


def failed(name: str, source: str, error: Exception) -> Invariant:
    """An invariant whose evaluation raised ``error``."""
    return absent(name, source, f"{type(error).__name__}: {' '.join(str(error).split())[:300]}")


def layer_name(layer: int, problem: CoatedContact) -> str:
    """ "coating 1", "coating 2", ... or "substrate"."""
    return f"coating {layer + 1}" if layer < len(problem.coatings) else "substrate"
