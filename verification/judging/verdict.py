"""Verdicts on comparisons, decided by the numerical uncertainty of both sides.

    |A - B| <= U_A + U_B   with   U_A + U_B <= cap

The cap turns vague agreement into INCONCLUSIVE: without it a bad grid, having a large U, would pass.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from verification.judging.outcome import Outcome
from verification.problem.line_profile import Profile


@dataclass(frozen=True)
class Claim:
    """``quantity`` on ``line`` is the same ``between`` two sources.

    cap : largest admissible uncertainty, also the largest admissible difference, as a fraction of the
          comparison's scale, see ``Quantity.divisor``.
    edge : half-width of a zone around the contact edge that this claim leaves out, as a fraction of a.
    """

    quantity: str
    line: str
    between: tuple[str, str]
    cap: float
    why: str
    edge: float = 0.0


@dataclass(frozen=True, eq=False)
class Comparison:
    """Two profiles at the same positions; ``judged`` marks the points the claim speaks of."""

    a: Profile
    b: Profile
    scale: float
    judged: NDArray[np.bool_]

    @property
    def difference(self) -> NDArray[np.float64]:
        """(A - B) / scale at every position."""
        return (self.a.value - self.b.value) / self.scale

    @property
    def uncertainty(self) -> NDArray[np.float64] | None:
        """(U_A + U_B) / scale at every position; None where either side states none."""
        if self.a.uncertainty is None or self.b.uncertainty is None:
            return None
        return (self.a.uncertainty + self.b.uncertainty) / self.scale


@dataclass(frozen=True)
class Judged:
    """Numbers on which a verdict was decided.

    cap : in force, a fraction of ``scale`` [SI].   points : number of judged points.
    extent : first and last of them [m].   gap : widest distance between neighbours [m].
    """

    cap: float
    scale: float
    points: int
    extent: tuple[float, float]
    gap: float


@dataclass(frozen=True)
class Verdict:
    """The outcome of a claim with the figures behind it, as fractions of the comparison's scale.

    difference, uncertainty : largest over the judged points; None where there is no such number.
    margin : smallest of U - |A - B| over the judged points; negative means disagreement.
    worst : position [m] of the point that decides.   judged : None where nothing was compared.
    """

    outcome: Outcome
    reason: str
    difference: float | None = None
    uncertainty: float | None = None
    margin: float | None = None
    worst: float | None = None
    judged: Judged | None = None


def compare(a: Profile, b: Profile, *, scale: float, excluded: NDArray[np.bool_] | None = None) -> Comparison:
    """Hold two profiles of the same quantity, line and positions against each other.

    Raises ValueError when they are not of the same quantity, line and positions.
    """
    if (a.quantity, a.line) != (b.quantity, b.line) or not np.array_equal(a.position, b.position):
        raise ValueError(
            f"{a.quantity} on {a.line} of {a.source} cannot be compared with {b.quantity} on {b.line} "
            f"of {b.source}; sample both at the same positions"
        )
    judged = np.ones(a.position.shape, dtype=bool) if excluded is None else ~excluded
    return Comparison(a, b, scale, judged)


def judge(comparison: Comparison, cap: float) -> Verdict:
    """Decide a comparison; ``cap`` as in Claim.

    NaN or infinity on either side is NO_RESULT, never agreement.
    """
    judged = comparison.judged
    if not judged.any():
        reason = "no point lies outside the zone around the contact edge; refine the line"
        return Verdict(Outcome.NO_RESULT, reason)
    position = comparison.a.position[judged]
    for side in (comparison.a, comparison.b):
        bad = ~np.isfinite(side.value[judged])
        if side.uncertainty is not None:
            bad |= ~np.isfinite(side.uncertainty[judged]) | (side.uncertainty[judged] < 0)
        if bad.any():
            where = f"{bad.sum()} of {bad.size} points, first at {position[bad][0]:.4g} m"
            return Verdict(Outcome.NO_RESULT, f"{side.source} gives no finite {side.quantity} at {where}")
    if not (np.isfinite(comparison.scale) and comparison.scale > 0):
        return Verdict(Outcome.NO_RESULT, f"the scale of the comparison is {comparison.scale:g}")

    along = np.sort(position)
    extent, gap = (float(along[0]), float(along[-1])), float(np.diff(along).max(initial=0.0))
    decided_on = Judged(cap, float(comparison.scale), along.size, extent, gap)
    difference = np.abs(comparison.difference[judged])
    largest = float(difference.max())
    uncertainty = comparison.uncertainty
    if uncertainty is None:
        worst = int(np.argmax(difference))
        silent = [side.source for side in (comparison.a, comparison.b) if side.uncertainty is None]
        outcome = Outcome.DISAGREES if largest > cap else Outcome.INCONCLUSIVE
        reason = f"difference {largest:.2e} {'exceeds' if largest > cap else 'is below'} the cap {cap:.1e}"
        reason += f"; {' and '.join(silent)} states no uncertainty"
        return Verdict(outcome, reason, largest, None, None, float(position[worst]), decided_on)

    U = uncertainty[judged]
    margin = U - difference
    worst = int(np.argmin(margin))
    figures = (largest, float(U.max()), float(margin[worst]))
    if margin[worst] < 0:
        reason = f"difference {difference[worst]:.2e} exceeds the uncertainty {U[worst]:.2e}"
        return Verdict(Outcome.DISAGREES, reason, *figures, float(position[worst]), decided_on)
    if U.max() > cap:
        reason = f"uncertainty {U.max():.2e} exceeds the cap {cap:.1e}; refine the method that dominates it"
        return Verdict(Outcome.INCONCLUSIVE, reason, *figures, float(position[np.argmax(U)]), decided_on)
    reason = f"difference {largest:.2e} within the uncertainty, at most {U.max():.2e}"
    return Verdict(Outcome.AGREES, reason, *figures, float(position[worst]), decided_on)
