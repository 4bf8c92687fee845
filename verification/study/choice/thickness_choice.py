"""Choice of a thickness: one coating at every friction of its study.

A coating has to bear all frictions, so that of each failure mode the largest utilisation counts. Thicknesses
whose utilisation exceeds the smallest by less than ``tolerance`` are equally good; strengths that scatter are
sampled, and in each sample the mode with the largest utilisation governs.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.interpolate import PchipInterpolator

from verification.problem.array_types import Array
from verification.study.choice.failure_criteria import SAMPLES, Criteria, JudgedCurve, Strength

EVEN = 0.01  # of the smallest utilisation, unless the curves are less certain
HALVED = 4  # at least by as much the error of interpolation falls with half the distance of points
DRAWN, SEED = 20_000, 16  # samples of the strengths; the same each time


@dataclass(frozen=True)
class End:
    """An end ``h`` of a range of thicknesses, over a_h, with its numerical ``uncertainty``.

    mode, friction : what governs there.
    """

    h: float
    uncertainty: float
    mode: str
    friction: float


Range = tuple[End | None, End | None]  # None where the sweep ends


@dataclass(frozen=True)
class Chances:
    """Probabilities from ``DRAWN`` samples of the strengths, at each of some stresses.

    governs : (modes, n), that the mode has the largest utilisation.   fails : (n), that it exceeds 1.
    breaks : (modes, n), that it exceeds 1 in this mode first: a part of ``fails``.
    """

    governs: Array
    fails: Array
    breaks: Array


@dataclass(frozen=True, eq=False)
class Choice:
    """What the curves of one modulus recommend; thicknesses over a_h.

    h, use : dense samples, (frictions, modes, samples) of utilisations.   error : of a utilisation.
    tolerance : above the smallest utilisation ``least``, over it, within which thicknesses are equally good.
    even : the range of these.   ranges : admissible ones, none without strengths.
    """

    judgements: tuple[JudgedCurve, ...]
    criteria: Criteria
    h: Array
    use: Array
    error: float
    tolerance: float
    even: Range
    ranges: tuple[Range, ...]

    @cached_property
    def largest(self) -> Array:
        """The largest utilisation at each of ``h``."""
        return self.use.max(axis=(0, 1))

    @property
    def least(self) -> float:
        """The smallest of ``largest``."""
        return float(self.largest.min())

    @property
    def best(self) -> float:
        """Thickness of ``least``."""
        return float(self.h[self.largest.argmin()])

    def governing(self, h: float) -> tuple[JudgedCurve, str]:
        """The curve of the friction, and the mode, with the largest utilisation at ``h``."""
        at = int(np.abs(np.log(self.h / h)).argmin())
        friction, mode = np.unravel_index(int(self.use[:, :, at].argmax()), self.use.shape[:2])
        return self.judgements[friction], self.judgements[0].modes[mode]

    def chances(self, h: Array) -> Chances:
        """Probabilities at thicknesses ``h``; without strengths a mode governs or it does not."""
        p_h = self.judgements[0].curve.p_h
        stress = self.use.max(axis=0) * np.array([*self.criteria.strengths(p_h).values()])[:, None]
        here = np.array([np.interp(np.log(h), np.log(self.h), one) for one in stress])
        return sampled(here, self.criteria.given())


def sampled(stress: Array, strengths: Mapping[str, Strength]) -> Chances:
    """Probabilities at ``stress`` (modes, n) [Pa] against independent ``strengths`` in the same order.

    Their standard error is at most 0.5/sqrt(DRAWN), 0.4 %.
    """
    strength = strengths_drawn(strengths)
    governs, breaks = np.zeros(stress.shape), np.zeros(stress.shape)
    for k, here in enumerate(stress.T):
        use = here / strength
        mode, beyond = use.argmax(axis=1), use.max(axis=1) > 1
        governs[:, k] = np.bincount(mode, minlength=here.size)
        breaks[:, k] = np.bincount(mode[beyond], minlength=here.size)
    return Chances(governs / DRAWN, breaks.sum(axis=0) / DRAWN, breaks / DRAWN)


def strengths_drawn(strengths: Mapping[str, Strength]) -> Array:
    """Samples of independent ``strengths`` [Pa], (DRAWN, modes); the same each time."""
    shares = np.random.default_rng(SEED).random((DRAWN, len(strengths)))
    return np.stack([s.quantile(shares[:, i]) for i, s in enumerate(strengths.values())], axis=1)


def choice(judgements: Sequence[JudgedCurve], criteria: Criteria) -> Choice:
    """The choice from the curves of one modulus, one for each friction."""
    members = tuple(sorted(judgements, key=lambda j: j.curve.friction))
    low, high = max(j.curve.h[0] for j in members), min(j.curve.h[-1] for j in members)
    h = np.geomspace(low, high, SAMPLES)
    use = np.stack([PchipInterpolator(np.log(j.curve.h), j.utilisation, axis=1)(np.log(h)) for j in members])
    # NaN of curves with too few points to estimate it
    errors = [j.interpolation_error * float(np.abs(j.utilisation).max()) / HALVED for j in members]
    error = float(np.nanmax([*errors, 0.0]))
    largest = use.max(axis=(0, 1))
    least = float(largest.min()) or 1.0
    tolerance = max(EVEN, error / least)
    found = Choice(members, criteria, h, use, error, tolerance, (None, None), ())
    best = int(largest.argmin())
    beyond = largest > least * (1 + tolerance)
    below, above = np.flatnonzero(beyond[:best]), best + np.flatnonzero(beyond[best:])
    even = (
        _end(found, int(below[-1])) if below.size else None,
        _end(found, int(above[0])) if above.size else None,
    )
    ranges = members[0].admissible if members[0].limited else ()
    for j in members[1:]:
        ranges = _overlap(ranges, j.admissible)

    def end(at: float) -> End | None:
        return None if at in (h[0], h[-1]) else _end(found, int(np.abs(h - at).argmin()), at)

    return replace(found, even=even, ranges=tuple((end(low), end(high)) for low, high in ranges))


def _end(found: Choice, k: int, h: float | None = None) -> End:
    """The end at sample ``k``, or at ``h`` beside it; uncertain by the error over its slope."""
    judgement, mode = found.governing(float(found.h[k]))
    slope = abs(np.gradient(found.largest[max(k - 1, 0) : k + 2], found.h[max(k - 1, 0) : k + 2]))[-2:].max()
    step = float(np.diff(found.h[max(k - 1, 0) : k + 1]).max(initial=0.0))
    at = float(found.h[k]) if h is None else h
    return End(at, min(max(found.error / slope if slope else at, step), at), mode, judgement.curve.friction)


def _overlap(
    a: Sequence[tuple[float, float]], b: Sequence[tuple[float, float]]
) -> tuple[tuple[float, float], ...]:
    both = [(max(p, r), min(q, s)) for p, q in a for r, s in b]
    return tuple((low, high) for low, high in both if low < high)
