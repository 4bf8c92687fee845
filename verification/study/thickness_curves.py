"""The table of a study as curves over the thickness, one for each modulus at each friction.

The rows of the other sources are marks beside the curve.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from verification.problem.array_types import Array
from verification.study.largest_stresses import QUANTITIES
from verification.study.study_table import SCALES, SOURCES


@dataclass(frozen=True, eq=False)
class ThicknessCurve:
    """Quantities over ``h``, the thickness over a_h, in increasing order; p_h [Pa], a_h and delta_h [m].

    value : each of QUANTITIES over p_h, each of SCALARS over its scale.   uncertainty : of QUANTITIES.
    marks : by source, by quantity the (h, value) of cross-checked points.
    failures : (h, message) of points that could not be solved.
    """

    ratio: float
    friction: float
    p_h: float
    a_h: float
    delta_h: float
    h: Array
    value: Mapping[str, Array]
    uncertainty: Mapping[str, Array]
    marks: Mapping[str, Mapping[str, tuple[Array, Array]]]
    failures: tuple[tuple[float, str], ...]

    @property
    def label(self) -> str:
        """The curve in a legend."""
        return f"E1/E2 = {self.ratio:.4g}, f = {self.friction:g}"


@dataclass(frozen=True)
class CrossCheck:
    """Largest difference of ``source`` from the semi-analytical method in ``quantity``.

    largest : |difference| over a_h, delta_h, of a pressure or stress over the smaller of p_h and p0.
    stated : sum of the uncertainties at that point, over the same.
    """

    source: str
    quantity: str
    points: int
    largest: float
    stated: float
    ratio: float
    h: float
    friction: float


def curves(columns: Mapping[str, NDArray[Any]]) -> tuple[ThicknessCurve, ...]:
    """Every curve of a table, by modulus, then by friction."""
    keys = sorted(set(zip(columns["modulus_ratio"].tolist(), columns["friction"].tolist(), strict=True)))
    return tuple(_curve(columns, *key) for key in keys)


def cross_checks(columns: Mapping[str, NDArray[Any]]) -> tuple[CrossCheck, ...]:
    """The largest difference of each other source by quantity; a source that solved nothing is absent."""
    point, solved, found = columns["point"], columns["status"] == "solved", []
    first, *others = (np.flatnonzero((columns["source"] == source) & solved) for source in SOURCES)
    for source, rows in zip(SOURCES[1:], others, strict=True):
        _, its, lead = np.intersect1d(point[rows], point[first], return_indices=True)
        if not its.size:
            continue
        here, beside = rows[its], first[lead]
        smaller = np.minimum(columns["p_h"][here], columns["peak_pressure"][here])
        for quantity, scale in SCALES.items():
            over = smaller if scale == "p_h" else columns[scale][here]
            difference = np.abs(columns[quantity][here] - columns[quantity][beside]) / over
            uncertainty = columns[f"{quantity}_uncertainty"]
            i = int(np.nanargmax(difference))
            largest = float(difference[i])
            stated = float((uncertainty[here[i]] + uncertainty[beside[i]]) / over[i])
            place = (columns[name][here[i]] for name in ("modulus_ratio", "thickness_over_a_h", "friction"))
            ratio, h, friction = map(float, place)
            found.append(CrossCheck(source, quantity, here.size, largest, stated, ratio, h, friction))
    return tuple(found)


def _curve(columns: Mapping[str, NDArray[Any]], ratio: float, friction: float) -> ThicknessCurve:
    mine = (columns["modulus_ratio"] == ratio) & (columns["friction"] == friction)
    solved = mine & (columns["status"] == "solved")
    lead = columns["source"] == SOURCES[0]
    rows = _by_thickness(columns, solved & lead)
    p_h, a_h, delta_h = (float(columns[name][np.flatnonzero(mine)[0]]) for name in ("p_h", "a_h", "delta_h"))

    def take(name: str) -> Array:
        return columns[name][rows].astype(float)

    marks = {}
    for source in SOURCES[1:]:
        checked = _by_thickness(columns, solved & (columns["source"] == source))
        if checked.size:
            h = columns["thickness_over_a_h"][checked]
            marks[source] = {q: (h, columns[f"{q}_over_{s}"][checked]) for q, s in SCALES.items()}
    return ThicknessCurve(
        ratio,
        friction,
        p_h,
        a_h,
        delta_h,
        take("thickness_over_a_h"),
        {q: take(f"{q}_over_{scale}") for q, scale in SCALES.items()},
        {q: take(f"{q}_uncertainty") / p_h for q in QUANTITIES},
        marks,
        tuple(
            (float(columns["thickness_over_a_h"][i]), str(columns["failure"][i]))
            for i in np.flatnonzero(mine & lead & (columns["status"] != "solved"))
        ),
    )


def _by_thickness(columns: Mapping[str, NDArray[Any]], chosen: NDArray[np.bool_]) -> NDArray[np.int_]:
    rows = np.flatnonzero(chosen)
    return rows[np.argsort(columns["thickness_over_a_h"][rows], kind="stable")]
