"""Solved points of a study that are not elastic: peak pressure above hardness, strains that are not small.

Yielding is a failure mode of the study itself, see ``failure_criteria``.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from verification.cases.plausibility import as_stress, strain_warning
from verification.problem.array_types import Array
from verification.study.study_plan import Study
from verification.study.study_table import SOURCES


def beyond_elastic(study: Study, columns: Mapping[str, NDArray[Any]]) -> tuple[str, ...]:
    """A line for each limit that a point of the table ``columns`` exceeds, with the places where it does.

    The strain of a layer is the largest difference of two principal ones, at most (1 + nu) 2/sqrt(3) times
    the von Mises stress over E; without the factor 2/sqrt(3) it is exact where two of them are equal.
    """
    solved = (columns["source"] == SOURCES[0]) & (columns["status"] == "solved")
    rows = {name: column[solved] for name, column in columns.items()}
    if not solved.any():
        return ()
    p0, found = rows["peak_pressure"].astype(float), []
    for key, value in study.hardness.items():
        if (beyond := p0 > value).any():
            what = (
                f"peak pressure up to {as_stress(p0.max())} is beyond {key} = {as_stress(value)}: not elastic"
            )
            found.append(f"{what}, {_where(study, rows, beyond)}")
    layers = ["substrate"] if study.held else ["substrate", "coating"]
    for layer in layers:
        E, nu = rows[f"{layer}_E"].astype(float), rows[f"{layer}_nu"].astype(float)
        strain = (1 + nu) * rows[f"von_mises_{layer}"].astype(float) / E
        for line in strain_warning(layer, float(np.nanmax(strain))):
            large = np.array([bool(strain_warning(layer, one)) for one in strain.tolist()])
            found.append(f"{line}; {_where(study, rows, large)}")
    return tuple(found)


def _where(study: Study, rows: Mapping[str, NDArray[Any]], chosen: NDArray[np.bool_]) -> str:
    """The range of thicknesses of the ``chosen`` rows, and of loads where these are swept."""

    def ends(name: str) -> Array:
        values = rows[name][chosen].astype(float)
        return np.array([values.min(), values.max()])

    low, high = ends("thickness") / study.units.metre
    text = (
        f"at {low:.3g} to {high:.3g} {study.units.length}"
        if low < high
        else f"at {low:.3g} {study.units.length}"
    )
    if study.loads is None:
        return text
    return f"{text}, from {ends('load')[0]:.3g} N"
