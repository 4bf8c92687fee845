"""Numbers of the baseline, case by case: what each source gave, how far apart."""

from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np

from verification.judging.verdict import Comparison, Outcome, compare, judge
from verification.problem.array_types import Array
from verification.problem.line_profile import Profile
from verification.problem.quantity import QUANTITIES
from verification.regression.baseline_change import Baseline
from verification.regression.baseline_file import read_baseline
from verification.regression.number_drift import Numbers

FOLDER = Path(__file__).parents[1] / "regression" / "shipped"


@cache
def baseline() -> Baseline:
    """The baseline of the package."""
    found = read_baseline(FOLDER)
    assert found is not None
    return found


@dataclass(frozen=True, eq=False)
class Pair:
    """``comparison`` of a ``quantity`` on a ``line`` of two sources."""

    quantity: str
    line: str
    between: tuple[str, str]
    cap: float
    comparison: Comparison

    @property
    def position(self) -> Array:
        """Places of the values [m]."""
        return self.comparison.a.position

    @property
    def difference(self) -> Array:
        """|A - B| over the scale of the comparison at each point."""
        return np.abs(self.comparison.difference)

    @property
    def uncertainty(self) -> Array:
        """U_A + U_B over that scale at each point, 0 where none is stated."""
        U = self.comparison.uncertainty
        return np.zeros_like(self.position) if U is None else U

    @property
    def agrees(self) -> bool:
        """The verdict on the numbers of the baseline."""
        return judge(self.comparison, self.cap).outcome is Outcome.AGREES

    @property
    def kind(self) -> str:
        """Kind of the quantity."""
        return QUANTITIES[self.quantity].kind

    @property
    def worst(self) -> float:
        """The largest difference."""
        return float(self.difference.max())


def values(case: str) -> dict[tuple[str, str, str], Numbers]:
    """Numbers of a case by source, quantity, line."""
    return {one.key: one for one in baseline().cases[case]}


@cache
def pairs(case: str) -> tuple[Pair, ...]:
    """Every comparison of a case, in the order of its manifest."""
    known, found = values(case), []
    for alike in baseline().manifests[case].comparisons:
        for quantity, first, second in alike.pairs:
            keys = [(first, quantity, alike.line), (second, quantity, alike.line)]
            if not all(key in known for key in keys):
                continue
            a, b = (_profile(known[key]) for key in keys)
            comparison = compare(a, b, scale=alike.judged.scale)
            found.append(Pair(quantity, alike.line, (first, second), alike.judged.cap, comparison))
    return tuple(found)


def _profile(n: Numbers) -> Profile:
    return Profile(n.quantity, n.line, n.position, n.value, n.source, n.uncertainty)


def largest(case: str, between: tuple[str, ...] | None, *kinds: str) -> float | None:
    """The largest difference of a case over its scale among quantities of these ``kinds``."""
    found = [p.worst for p in pairs(case) if p.kind in kinds and between in (None, p.between)]
    return max(found, default=None)
