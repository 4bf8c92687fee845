"""Stresses in the plane below the contact, with the difference of both methods."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import zip_longest

import numpy as np

from verification.page.embedded_csv import written
from verification.page.number_text import plain, scientific
from verification.page.page_parts import Panel
from verification.page.source_labels import source_label
from verification.page.svg_raster import Frame, Scale, draw_field, rasterised
from verification.problem.array_types import Array
from verification.problem.quantity import IN_PLANE, von_mises
from verification.report.tables.case_lookup import scale as scale_of
from verification.report.tables.case_lookup import slug
from verification.running.case_result import CaseResult
from verification.sampling.stress_plane import Plane
from verification.sources.source_registry import METHODS

SHOWN = ("von_mises", "sigma_xx", "sigma_xz")
TITLES = {"von_mises": "von Mises"}
SEQUENTIAL, DIVERGING, DIFFERENCE = "viridis", "RdBu_r", "cividis"
FLOOR, TOP = -8.0, -3.0  # exponents of the difference over p_h; the same in all cases, to be compared
EVERY = 3  # of the columns in the table of numbers


@dataclass(frozen=True)
class Pictures:
    """The quantities side by side, below them their differences, with caption and the numbers as CSV."""

    panels: tuple[Panel, ...]
    caption: str
    csv: str
    file: str
    failures: tuple[tuple[str, str], ...]


def pictures(result: CaseResult, plane: Plane | None) -> Pictures | None:
    """Von Mises stress, sigma_xx and sigma_xz by every method; None where there is nothing to draw."""
    a_h, p_h = float(scale_of(result, "a_h")), float(scale_of(result, "p_h"))
    if plane is None or not plane.stress or not a_h > 0 or not p_h > 0:
        return None
    sources = [name for name in METHODS if name in plane.stress]
    x, depths = plane.x / a_h, [z / a_h for z in plane.depths]
    bottoms = [float(z[-1]) for z in depths]
    frame = Frame(float(x[-1]), bottoms[-1], tuple(bottoms[:-1]), plane.radius / a_h)

    def panel(values: Sequence[Array], colours: Scale, title: str, label: str, note: str) -> Panel:
        smooth = not colours.logarithmic
        raster = rasterised(x, depths, values, frame, smooth=smooth)
        return Panel(title, draw_field(raster, frame, colours, label=label, lines=smooth), note, "")

    fields, gaps = [], []
    for quantity in SHOWN:
        by = {s: [_quantity(sigma, quantity) / p_h for sigma in plane.stress[s]] for s in sources}
        source, shown = next(iter(by.items()))
        title, name = f"{TITLES.get(quantity, quantity)} / p_h", source_label(source)
        values = np.concatenate([f.ravel() for f in shown])
        known = values[np.isfinite(values)]
        span = f"{plain(known.min(), 3)} to {plain(known.max(), 3)}" if known.size else "not finite"
        fields.append(panel(shown, _colours(quantity, shown), title, f"{title} by {name}", f"{name}, {span}"))
        if len(sources) == 2:
            apart = [np.abs(one - other) for one, other in zip(*by.values(), strict=True)]
            largest = max((float(g.max()) for g in apart), default=0.0)
            exponents = [np.log10(np.maximum(g, 10.0 ** (FLOOR - 1))) for g in apart]
            top = max(TOP, float(np.ceil(np.log10(largest)))) if 0 < largest < np.inf else TOP
            colours = Scale(FLOOR, top, DIFFERENCE, logarithmic=True)
            label = f"difference of both methods in {title}, logarithmic"
            note = f"largest {scientific(largest)}"
            gaps.append(panel(exponents, colours, f"difference in {title}", label, note))
    return Pictures(
        (*fields, *gaps),
        _caption(sources, frame),
        plane_csv(plane),
        f"{slug(result.name)}-plane.csv",
        tuple((source_label(name), message) for name, message in plane.failures.items()),
    )


def plane_csv(plane: Plane) -> str:
    """Position, layer, stresses of every source at every third x; SI units in the column heads."""
    x = plane.x[::EVERY]
    columns = [["layer"], ["x [m]"], ["z [m]"]]
    for k, z in enumerate(plane.depths):
        columns[0] += [str(k)] * (z.size * x.size)
        columns[1] += [f"{v:.5g}" for v in np.tile(x, z.size)]
        columns[2] += [f"{v:.5g}" for v in np.repeat(z, x.size)]
    for source, layers in plane.stress.items():
        for name in (*IN_PLANE, "von_mises"):
            values = np.concatenate([_quantity(sigma, name)[:, ::EVERY].ravel() for sigma in layers])
            columns.append([f"{name} [Pa] {source}", *(f"{v:.5g}" for v in values)])
    return written(list(zip_longest(*columns, fillvalue="")))


def _quantity(sigma: Array, name: str) -> Array:
    return von_mises(sigma) if name == "von_mises" else sigma[list(IN_PLANE).index(name)]


def plane_difference(plane: Plane, scale: float) -> tuple[float, str] | None:
    """Largest difference of the methods anywhere in the plane over ``scale``, with the stress it is of."""
    if len(plane.stress) != 2 or not scale > 0:
        return None
    one, other = plane.stress.values()
    gaps = [np.abs(a - b).max(axis=(1, 2)) for a, b in zip(one, other, strict=True) if a.size]
    largest = np.max(gaps, axis=0) / scale if gaps else np.zeros(1)
    if not np.isfinite(largest).all():
        return None
    return float(largest.max()), list(IN_PLANE)[int(largest.argmax())]


def _colours(quantity: str, values: Sequence[Array]) -> Scale:
    """One scale for both methods: from zero up for von Mises, even about zero for the others."""
    largest = max(
        (float(np.max(np.abs(v), initial=0.0)) for v in values if np.isfinite(v).all()), default=1.0
    )
    largest = largest or 1.0
    if quantity == "von_mises":
        return Scale(0.0, largest, SEQUENTIAL)
    return Scale(-largest, largest, DIVERGING)


def _caption(sources: Sequence[str], frame: Frame) -> str:
    text = (
        "Plane y = 0; the red bar is the contact, lines across are interfaces, where stresses may jump. "
        "Level lines at the ticks of the colour bar. "
    )
    if frame.stretched:
        text += "Thin layers are drawn thicker than they are: read z off the axis. "
    if len(sources) == 2:
        text += (
            "Below, the difference of the methods at the same points, on one logarithmic scale in every case."
        )
    return text
