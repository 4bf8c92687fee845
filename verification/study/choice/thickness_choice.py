"""Choice of a thickness: one coating at every friction of its study.

A coating has to bear all frictions, so that of each failure mode the largest utilisation counts. Thicknesses
whose utilisation exceeds the smallest by less than ``tolerance`` are equally good; strengths that scatter are
sampled, and in each sample the mode with the largest utilisation governs.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.interpolate import PchipInterpolator

from verification.problem.array_types import Array
from verification.study.choice.failure_criteria import Criteria, Strength
from verification.study.thickness_curves import ThicknessCurve

SAMPLES = 4001  # of an interpolated curve
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
    """Recommendation by the curves of one modulus, one for each friction; thicknesses over a_h.

    modes : of the criterion.   h, use : dense samples, (frictions, modes, samples) of utilisations.
    bound : the largest utilisation at each of h by stresses that include their uncertainty.
    error : of a utilisation, by interpolation.
    """

    curves: tuple[ThicknessCurve, ...]
    criteria: Criteria
    modes: tuple[str, ...]
    h: Array
    use: Array
    bound: Array
    error: float

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

    @property
    def tolerance(self) -> float:
        """The excess over the smallest utilisation, over it, within which thicknesses are equally good."""
        return max(EVEN, self.error / (self.least or 1.0))

    @cached_property
    def even(self) -> Range:
        """The range of equally good thicknesses."""
        best, limit = int(self.largest.argmin()), (self.least or 1.0) * (1 + self.tolerance)
        beyond = np.flatnonzero(self.largest > limit).tolist()
        below, above = [k for k in beyond if k < best], [k for k in beyond if k > best]
        return self._end(below[-1]) if below else None, self._end(above[0]) if above else None

    @cached_property
    def ranges(self) -> tuple[Range, ...]:
        """Ranges where ``bound`` is at most 1, their ends by linear interpolation; none without strengths."""
        if not self.criteria.limited:
            return ()
        inside, h = self.bound <= 1, self.h
        starts = np.flatnonzero(inside & ~np.append(False, inside[:-1]))
        ends = np.flatnonzero(inside & ~np.append(inside[1:], False))
        return tuple(
            (self._crossing(i - 1) if i else None, self._crossing(j) if j < h.size - 1 else None)
            for i, j in zip(starts.tolist(), ends.tolist(), strict=True)
        )

    def _crossing(self, k: int) -> End:
        """The end between samples k and k + 1, where the utilisation is 1."""
        (low, high), (before, after) = self.h[k : k + 2], self.bound[k : k + 2]
        at = float(low + (high - low) * (1 - before) / (after - before))
        return self._end(int(np.abs(self.h - at).argmin()), at)

    def _end(self, k: int, h: float | None = None) -> End:
        """The end at sample ``k``, or at ``h`` beside it; uncertain by the error over its slope."""
        near = slice(max(k - 1, 0), k + 2)
        slope = abs(np.gradient(self.largest[near], self.h[near]))[-2:].max()
        step = float(np.diff(self.h[max(k - 1, 0) : k + 1]).max(initial=0.0))
        at = float(self.h[k]) if h is None else h
        U = min(max(self.error / slope if slope else at, step), at)
        return End(at, U, *self.governing(float(self.h[k])))

    def governing(self, h: float) -> tuple[str, float]:
        """The mode with the largest utilisation at ``h``, and the friction at which it is."""
        at = int(np.abs(np.log(self.h / h)).argmin())
        friction, mode = np.unravel_index(int(self.use[:, :, at].argmax()), self.use.shape[:2])
        return self.modes[mode], self.curves[friction].friction

    def chances(self, h: Array) -> Chances:
        """Probabilities at thicknesses ``h``; without strengths a mode governs or it does not."""
        counted = [*self.criteria.strengths(self.curves[0].p_h).values()]
        stress = self.use.max(axis=0) * np.array(counted)[:, None]
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


def choice(curves: Sequence[ThicknessCurve], criteria: Criteria) -> Choice:
    """The choice from the ``curves`` of one modulus, each interpolated by monotone cubics in log h.

    Raises ValueError for a curve of fewer than two points.
    """
    members = tuple(sorted(curves, key=lambda one: one.friction))
    if (fewest := min(one.h.size for one in members)) < 2:
        raise ValueError(f"{fewest} thickness solved; a criterion needs two, sweep more")
    strengths = criteria.strengths(members[0].p_h)
    scale = criteria.safety * members[0].p_h / np.array([*strengths.values()])[:, None]
    h = np.geomspace(max(one.h[0] for one in members), min(one.h[-1] for one in members), SAMPLES)
    use, bound, errors = [], [], [0.0]
    for one in members:
        s, stress = np.log(one.h), np.array([one.value[mode] for mode in strengths])
        U = np.nan_to_num([one.uncertainty[mode] for mode in strengths])
        use.append(PchipInterpolator(s, scale * stress, axis=1)(np.log(h)))
        bound.append(PchipInterpolator(s, scale * (stress + U), axis=1)(np.log(h)))
        errors.append(interpolation_error(s, scale * stress) / HALVED)
    largest = np.stack(bound).max(axis=(0, 1))
    return Choice(members, criteria, tuple(strengths), h, np.stack(use), largest, float(np.nanmax(errors)))


def interpolation_error(s: Array, values: Array) -> float:
    """Largest error of interpolating an inner point of ``values`` over ``s`` from the others; NaN of too few.

    A point left out doubles the interval, so this exceeds the error of the whole curve.
    """
    worst = 0.0 if s.size >= 4 else float("nan")
    for i in range(1, s.size - 1):
        others = np.arange(s.size) != i
        interpolated = PchipInterpolator(s[others], values[..., others], axis=-1)(s[i])
        worst = max(worst, float(np.abs(interpolated - values[..., i]).max())) if worst == worst else worst
    return worst
