"""Numbers of the baseline, case by case: what each source gave, how far apart."""

from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np

from verification.problem.arrays import Array
from verification.problem.quantity import QUANTITIES
from verification.regression.baseline import Baseline
from verification.regression.drift import Numbers
from verification.regression.record import read_baseline

FOLDER = Path(__file__).parents[1] / "regression" / "shipped"


@cache
def baseline() -> Baseline:
    """The baseline of the package."""
    found = read_baseline(FOLDER)
    assert found is not None
    return found


@dataclass(frozen=True, eq=False)
class Pair:
    """``quantity`` on ``line`` of two sources; all fractions of ``scale`` [SI].

    difference, uncertainty : |A - B|, U_A + U_B, at each point of ``position`` [m].
    """

    quantity: str
    line: str
    between: tuple[str, str]
    cap: float
    scale: float
    position: Array
    difference: Array
    uncertainty: Array

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
            a, b = (known[key] for key in keys)
            U = _uncertainty(a) + _uncertainty(b)
            scale = alike.judged.scale
            difference = np.abs(a.value - b.value) / scale
            pair = (quantity, alike.line, (first, second), alike.judged.cap, scale, a.position)
            found.append(Pair(*pair, difference, U / scale))
    return tuple(found)


def _uncertainty(n: Numbers) -> Array:
    return np.zeros_like(n.value) if n.uncertainty is None else n.uncertainty


def largest(case: str, between: tuple[str, str] | None, *kinds: str) -> float | None:
    """The largest difference of a case over its scale among quantities of these ``kinds``."""
    found = [p.worst for p in pairs(case) if p.kind in kinds and between in (None, p.between)]
    return max(found, default=None)
