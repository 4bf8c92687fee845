"""Causes of wrong answers: other problems solved exactly, other places, slips of the output, up to four.

A set of slips is named where it explains every number of the contact that was given and nine tenths of what
failed, and where each of them explains nine tenths of what the others leave. Of several sets the one with the
smallest misfit counts, with a price for every slip.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property, partial
from itertools import combinations
from math import log

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize_scalar

from verification.guests.diagnosis.other_solutions import RIGHT, WrongPlaces, other_values
from verification.guests.diagnosis.wrong_inputs import WrongInput, wrong_inputs
from verification.guests.diagnosis.wrong_outputs import (
    NUMBERS,
    UNITS,
    Key,
    Values,
    WrongOutput,
    wrong_outputs,
)
from verification.guests.exam_subjects import SPHERE, Subject, exact_radius, reference_of
from verification.judging.verdict import Outcome
from verification.problem.array_types import Array
from verification.problem.quantity import SCALARS, STRESSES, unit_of
from verification.running.case_result import CaseResult

EDGE = 0.08  # half-width of the zone around the contact edge where nothing is compared, of a
PRICE = 2.0  # of a slip, in the sum of log misfits
FLOOR = 1e-4  # smallest misfit that counts
MOST, BEAM = 4, 6  # slips in a set, sets that are extended
TIE = 0.05  # difference in the sum of log misfits that does not tell sets apart
PART = 0.1  # of the largest stress on a line
EXPLAINED = 0.1  # of its misfit may remain at a place
SHARE = 0.9  # of the failed comparisons that has to be explained
ALIKE = 0.06  # mean misfit in ln of the contact's numbers, within which another problem is looked at
MOST_INPUTS = 4
STRETCHED = ((2.0, "doubled", "r for 2 r"), (0.5, "halved", "the diameter for a"))
DEPTHS = 8  # of a line downwards


@dataclass(frozen=True)
class Cause:
    """A likely slip by ``name`` with a ``message`` that asks for it, and the ``places`` that it explains."""

    name: str
    message: str
    places: tuple[Key, ...]


@dataclass(frozen=True)
class Misfit:
    """The difference between an answer and what slips make of the exact value, over the larger of both.

    opposite : that of the answer of the opposite sign.   agrees : whether it is within what is admissible.
    """

    size: float
    opposite: float
    agrees: bool


Misfits = dict[Key, Misfit | None]  # None where slips do not say what becomes of a value
Slip = WrongInput | WrongPlaces | WrongOutput


def causes_of(case: Subject, result: CaseResult, guest: str) -> tuple[Cause, ...]:
    """The slips behind the answers of ``guest`` about ``case``; none where no set of them explains enough."""
    found = Diagnosis(case, result, guest)
    return found.causes() if found.wrong else ()


@dataclass(frozen=True, eq=False)
class Diagnosis:
    """The answers of a ``guest`` about one case, held against what slips would make of the exact ones."""

    case: Subject
    result: CaseResult
    guest: str

    @cached_property
    def exact(self) -> Values:
        """The exact values."""
        return self._values_of(reference_of(self.result.problem))

    @cached_property
    def given(self) -> Values:
        """The answers, where all of a line are finite."""
        mine = self._values_of(self.guest)
        return {k: g for k, g in mine.items() if k in self.exact and np.isfinite(g).all()}

    def _values_of(self, source: str) -> Values:
        """The values of ``source``, at a few of the depths of a line, each of which costs an evaluation."""
        own = (p for p in self.result.profiles if p.source == source)
        return {(p.quantity, p.line): p.value[:: self._steps[p.line]] for p in own}

    @cached_property
    def _steps(self) -> dict[str, int]:
        """Every how many points of each line are looked at."""
        steps = {"contact": 1}
        for p in self.result.profiles:
            if p.line not in steps:
                deep = np.ptp(self.case.line(p.line).points(p.position)[2]) > 0
                steps[p.line] = max(1, p.position.size // DEPTHS) if deep else 1
        return steps

    @cached_property
    def positions(self) -> dict[str, Array]:
        """Those along each line."""
        return {p.line: p.position[:: self._steps[p.line]] for p in self.result.profiles}

    @cached_property
    def caps(self) -> dict[Key, float]:
        """The largest admissible difference by place."""
        return {(claim.quantity, claim.line): claim.cap for claim, _ in self.result.verdicts}

    @cached_property
    def _admissible(self) -> dict[Key, float]:
        """The largest admissible difference [SI] by place, smaller where the answers are too small."""
        found = {}
        for claim, verdict in self.result.verdicts:
            key = claim.quantity, claim.line
            if key in self.given and verdict.judged is not None:
                g, e = (float(np.abs(v[key]).max()) for v in (self.given, self.exact))
                found[key] = claim.cap * verdict.judged.scale * (min(1.0, g / e) if e else 1.0)
        return found

    @cached_property
    def wrong(self) -> list[Key]:
        """Marks of the values that differ from the exact one by more than they may."""
        return [
            (claim.quantity, claim.line)
            for claim, verdict in self.result.verdicts
            if verdict.outcome in (Outcome.DISAGREES, Outcome.INCONCLUSIVE)
            and (verdict.difference or 0.0) > claim.cap
            and (claim.quantity, claim.line) in self.given
        ]

    def causes(self) -> tuple[Cause, ...]:
        """The slips of the best set that explains enough, those that explain most first."""
        if self._explains(self._misfits([], ())):  # too little to tell: the noise of a mesh at single points
            return ()
        slips = list(self._slips())
        best = self._best(slips)
        if best is None:
            return ()
        for number in best:
            less = tuple(n for n in best if n != number)
            if less and not self._adds(self._misfits(slips, best), self._misfits(slips, less)):
                best = less
        found = []
        after = self._misfits(slips, best)
        for number in best:
            rest = self._misfits(slips, tuple(n for n in best if n != number))
            places = tuple(k for k in self.wrong if self._right(k, after[k]) and not self._right(k, rest[k]))
            slip = slips[number]
            found.append(Cause(slip.name, _message(slip), places))
        return tuple(sorted(found, key=lambda cause: -len(cause.places)))

    def _adds(self, misfits: Misfits, less: Misfits) -> bool:
        """Whether a set needs a slip, or it explains most of what the others leave, at two places or more."""
        left = [k for k in self.wrong if less[k] is not None and not self._right(k, less[k])]
        good = sum(self._right(k, misfits[k]) for k in left)
        return not self._explains(less) or good >= max(2, SHARE * len(left))

    def _best(self, slips: list[Slip]) -> tuple[int, ...] | None:
        """Numbers of the slips of the set of the least cost that explains enough."""
        beam: list[tuple[int, ...]] = [()]
        cost: dict[tuple[int, ...], float] = {(): self._cost(self._misfits(slips, ()))}
        enough: list[tuple[int, ...]] = []
        for _ in range(MOST):
            longer = {
                tuple(sorted({*one, n}))
                for one in beam
                for n, slip in enumerate(slips)
                if not any(n == other or _exclusive(slip, slips[other]) for other in one)
            }
            least = min(cost.values())
            for one in longer:
                misfits = self._misfits(slips, one)
                cost[one] = self._cost(misfits) + PRICE * len(one)
                if self._explains(misfits):
                    enough.append(one)
            beam = sorted(longer, key=lambda one: cost[one])[:BEAM]
            if not beam or cost[beam[0]] >= least:
                break
        least = min((cost[one] for one in enough), default=0.0)
        alike = [one for one in enough if cost[one] <= least + TIE]
        # What no answer tells apart is a slip of the output: its answers show it.
        return min(
            alike,
            key=lambda one: (sum(not isinstance(slips[n], WrongOutput) for n in one), one),
            default=None,
        )

    def _misfits(self, slips: list[Slip], chosen: tuple[int, ...]) -> Misfits:
        """The misfit at each place if the slips ``chosen`` were made."""
        values = self._values(slips, chosen)
        return {k: self._misfit(k, values) for k in self.given}

    @cached_property
    def _made(self) -> dict[tuple[Slip, ...], Values]:
        return {(): self.exact}

    def _values(self, slips: list[Slip], chosen: tuple[int, ...]) -> Values:
        """Exact values after the slips ``chosen``, in their order."""
        made = tuple(slips[n] for n in chosen)
        if made not in self._made:
            last = made[-1]
            if isinstance(last, WrongOutput):
                self._made[made] = last.change(self._values(slips, chosen[:-1]))
            else:
                self._made[made] = self._solved(made)
        return self._made[made]

    def _solved(self, slips: tuple[Slip, ...]) -> Values:
        """The exact values of another problem, or at other places."""
        problem = next((slip.problem for slip in slips if isinstance(slip, WrongInput)), self.case.problem)
        places = next((slip for slip in slips if isinstance(slip, WrongPlaces)), RIGHT)
        try:
            found = other_values(self.case, problem, self.positions, set(self.given), places)
        except (ValueError, ArithmeticError):  # a problem beyond the reference
            found = {}
        return {k: found.get(k, np.full_like(v, np.nan)) for k, v in self.exact.items()}

    def _misfit(self, key: Key, values: Values) -> Misfit | None:
        """|g - p| over the larger of both, off the edge; None where few are known.

        Of a stress over a part of the largest one on its line in both, since a slip may leave it zero.
        """
        g, p = self.given[key], values[key]
        keep = np.isfinite(p) & self._judged.get(key[1], True)
        if 2 * keep.sum() < g.size / 2 or not keep.any():
            return None
        size = max(float(np.linalg.norm(one[keep])) for one in (g, p))
        if key[0] in STRESSES:
            line = [(q, key[1]) for q in STRESSES if (q, key[1]) in self.given]
            beside = (np.nan_to_num([of[k][keep] for k in line]) for of in (self.given, values))
            size = max(size, PART * min(float(np.linalg.norm(one, axis=1).max()) for one in beside))
        less, more = (float(np.linalg.norm(one[keep])) / (size or 1.0) for one in (g - p, g + p))
        return Misfit(less, more, float(np.abs(g - p)[keep].max()) <= self._admissible.get(key, 0.0))

    @cached_property
    def _judged(self) -> dict[str, NDArray[np.bool_]]:
        """The points of each line on the surface that lie away from the contact edge."""
        a, zone = exact_radius(self.result), max([EDGE, *(c.edge for c, _ in self.result.verdicts)])
        lines = {k: x for k, x in self.positions.items() if k.endswith("surface")}
        return {k: np.abs(np.abs(x) - a) >= zone * a for k, x in lines.items()}

    def _cost(self, misfits: Misfits) -> float:
        """Sum of the logarithms of the misfits; one that is not known counts as before."""
        total = 0.0
        for key, misfit in misfits.items():
            floor = max(FLOOR, self.caps.get(key, 0.0) / 3)
            now = misfit or self._before[key]
            # Of the opposite sign is better than of another size: the sign is the next slip to find.
            total += log(min(max(min(now.size, (1 + now.opposite) / 2), floor), 1.0))
        return total

    @cached_property
    def _before(self) -> dict[Key, Misfit]:
        return {k: self._misfit(k, self.exact) or Misfit(0.0, 0.0, True) for k in self.given}

    def _right(self, key: Key, misfit: Misfit | None) -> bool:
        """Whether a misfit that is left is no error, or a small part of what there was."""
        small = max(EXPLAINED * self._before[key].size, self.caps.get(key, 0.0))
        return misfit is not None and (misfit.agrees or misfit.size <= small)

    def _spoils(self, key: Key, misfit: Misfit) -> bool:
        """Whether a right answer is further from what the slips say than from the exact value."""
        return not self._right(key, misfit) and misfit.size > 2 * self._before[key].size

    def _explains(self, misfits: Misfits) -> bool:
        """Whether every number of the contact and enough of what failed is explained."""
        judged = {k: self._right(k, m) for k, m in misfits.items() if m is not None}
        failed = [k for k in self.wrong if k in judged]
        spoilt = [
            k for k, m in misfits.items() if m is not None and k not in self.wrong and self._spoils(k, m)
        ]
        numbers = all(judged.get(k, True) for k in misfits if k[0] in SCALARS)
        good = sum(judged[k] for k in failed)
        return numbers and 2 * good >= len(self.wrong) and good >= SHARE * (len(failed) + len(spoilt))

    def _slips(self) -> Iterator[Slip]:
        """In the order in which they act: of the input, of the places, of the output."""
        inputs: list[WrongInput] = []
        loads: list[WrongInput] = []
        for one in self._inputs():
            (loads if self.case.load != SPHERE and self._of_load(one) else inputs).append(one)
        yield from inputs
        a, p = exact_radius(self.result), self.case.problem
        if p.friction:
            text = "mirrored in x: is sliding, and the friction q on the solid, along +x?"
            yield WrongPlaces("sliding along -x", text, mirror=-1.0)
        for stretch, how, why in () if inputs else STRETCHED:
            text = f"as if every position were {how}: {why}?"
            yield WrongPlaces(f"positions {how}", text, stretch=stretch)
        key = ("pressure", "surface")
        given = self.given.get(key)
        shift = 0.0 if given is None else fitted_shift(self.positions["surface"], self.exact[key], given, a)
        if shift:
            text = f"shifted by {shift:+.3g} m = {shift / a:+.3g} a in x: half a cell?"
            yield WrongPlaces("shift", text, shift=shift)
        along = ((line, x) for line, x in self.positions.items() if line != "contact")
        points = {line: self.case.line(line).points(x)[:2] for line, x in along}
        yield from wrong_outputs(self.exact, self.given, points)
        # Under a prescribed load every answer is proportional to it.
        for one in loads:
            yield WrongOutput(one.name, partial(_times, one.problem.load / p.load), _message(one))

    def _of_load(self, one: WrongInput) -> bool:
        """Whether only the load is another one."""
        p = self.case.problem
        return replace(one.problem, load=p.load) == p

    def _inputs(self) -> list[WrongInput]:
        """At most a few other problems whose numbers are like the answers, but for a factor."""
        numbers = [k for k in self.given if k[0] in SCALARS and k[1] == "contact"]
        if not any(k in self.wrong for k in self.given):
            return []
        single = list(wrong_inputs(self.case.problem))
        if not numbers or self.case.load != SPHERE:
            return single
        ranked = self._alike(single, numbers)
        if not ranked and not self.case.problem.coatings:
            names = {one.name: one for one in single}
            pairs = []
            for one, two in combinations(names, 2):
                for other in wrong_inputs(names[one].problem):
                    if other.name == two:
                        pairs.append(WrongInput(f"{one}; {two}", other.problem))
            ranked = self._alike(pairs, numbers)
        return ranked

    def _alike(self, inputs: list[WrongInput], numbers: list[Key]) -> list[WrongInput]:
        misfits = []
        for one in inputs:
            try:
                found = other_values(self.case, one.problem, {}, set(numbers))
            except (ValueError, ArithmeticError):
                continue
            rest = [
                _rest_of_factor(k[0], float(self.given[k][0]), float(found[k][0]))
                for k in numbers
                if k in found
            ]
            misfits.append((float(np.mean(rest)), one))
        near = [pair for pair in misfits if pair[0] <= ALIKE]
        return [one for _, one in sorted(near, key=lambda pair: pair[0])[:MOST_INPUTS]]


def _rest_of_factor(quantity: str, given: float, found: float) -> float:
    """|ln(given/found)| beyond the nearest factor that a slip of the output may have made of it."""
    if not given or not found:
        return 1.0
    units = (1.0, *UNITS.get(unit_of(quantity), {}))
    own = (1.0, *(abs(factor) for name, factor in NUMBERS.values() if name == quantity))
    return min(abs(log(abs(given / found) / (u * f))) for u in units for f in own)


def _times(factor: float, values: Values) -> Values:
    return {k: factor * v for k, v in values.items()}


def _exclusive(one: Slip, other: Slip) -> bool:
    """Whether two slips are kinds of one: only one input, one move of the points."""
    return any(isinstance(one, kind) and isinstance(other, kind) for kind in (WrongInput, WrongPlaces))


def _message(slip: Slip) -> str:
    return (not isinstance(slip, WrongInput) and slip.message) or f"{slip.name}?"


def fitted_shift(x: Array, e: Array, g: Array, a: float) -> float:
    """The shift along x [m] by which the form of the exact values ``e`` fits ``g``; 0 where none is clear.

    a : contact radius [m]; at its edge, where the slope of the pressure is infinite, nothing is compared.
    """
    inner = np.abs(x) < (1 - EDGE) * a
    if not e[inner].any() or not g[inner].any():
        return 0.0

    def rest(s: float) -> float:
        moved = np.interp(x[inner] - s, x, e)
        factor = float(g[inner] @ moved) / float(moved @ moved)
        return float(np.linalg.norm(g[inner] - factor * moved))

    found = minimize_scalar(rest, bounds=(-0.3 * a, 0.3 * a), method="bounded", options={"xatol": 1e-9 * a})
    clear = abs(found.x) > 1e-4 * a and rest(found.x) < EXPLAINED * rest(0.0)
    return float(found.x) if clear else 0.0
