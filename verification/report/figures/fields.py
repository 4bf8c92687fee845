"""Stresses in the plane below the contact: both methods beside their difference."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import zip_longest

import numpy as np

from verification.problem.arrays import Array
from verification.problem.quantity import IN_PLANE, von_mises
from verification.report.figures.raster import Frame, Scale, draw_field, rasterised
from verification.report.tables.cells import Panel
from verification.report.tables.csv import embedded, written
from verification.report.tables.labels import source_label
from verification.report.tables.lookup import scale as scale_of
from verification.report.tables.lookup import slug
from verification.report.tables.numbers import plain, scientific
from verification.running.result import CaseResult
from verification.sampling.plane import Plane
from verification.sources.registry import METHODS

SHOWN = ("von_mises", "sigma_xx", "sigma_xz")
TITLES = {"von_mises": "von Mises"}
SEQUENTIAL, DIVERGING, DIFFERENCE = "viridis", "RdBu_r", "cividis"
FLOOR, TOP = -8.0, -3.0  # exponents of the difference over p_h; the same in all cases, to be compared
EVERY = 3  # of the columns in the table of numbers


@dataclass(frozen=True)
class Pictures:
    """Panels in rows of ``across``, one row a quantity, with caption, and the numbers behind as CSV."""

    panels: tuple[Panel, ...]
    across: int
    caption: str
    csv: str
    file: str
    failures: tuple[tuple[str, str], ...]


def pictures(result: CaseResult, plane: Plane | None) -> Pictures | None:
    """Von Mises stress, sigma_xx and sigma_xz by every method; None where there is nothing to draw."""
    a_h, p_h = float(scale_of(result, "a_h")), float(scale_of(result, "p_h"))
    if plane is None or not plane.stress or not a_h > 0 or not p_h > 0:
        return None
    failures = tuple((source_label(name), message) for name, message in plane.failures.items())
    sources = [name for name in METHODS if name in plane.stress]
    bottoms = [float(z[-1]) / a_h for z in plane.depths]
    frame = Frame(float(plane.x[-1]) / a_h, bottoms[-1], tuple(bottoms[:-1]), plane.radius / a_h)
    panels = [panel for quantity in SHOWN for panel in _row(plane, quantity, sources, frame, a_h, p_h)]
    return Pictures(
        tuple(panels),
        len(panels) // len(SHOWN),
        _caption(plane, sources),
        embedded(plane_csv(plane)),
        f"{slug(result.name)}-plane.csv",
        failures,
    )


def plane_csv(plane: Plane) -> str:
    """Position, layer, stresses of every source at every third x; SI units in the column heads."""
    x = plane.x[::EVERY]
    columns = [["layer"], ["x [m]"], ["z [m]"]]
    for k, z in enumerate(plane.depths):
        columns[0] += [str(k)] * (z.size * x.size)
        columns[1] += [f"{v:.6g}" for v in np.tile(x, z.size)]
        columns[2] += [f"{v:.6g}" for v in np.repeat(z, x.size)]
    for source, layers in plane.stress.items():
        for name in (*IN_PLANE, "von_mises"):
            values = np.concatenate([_quantity(sigma, name)[:, ::EVERY].ravel() for sigma in layers])
            columns.append([f"{name} [Pa] {source}", *(f"{v:.6g}" for v in values)])
    return written(list(zip_longest(*columns, fillvalue="")))


def _quantity(sigma: Array, name: str) -> Array:
    return von_mises(sigma) if name == "von_mises" else sigma[list(IN_PLANE).index(name)]


def _row(
    plane: Plane, quantity: str, sources: Sequence[str], frame: Frame, a_h: float, p_h: float
) -> list[Panel]:
    """A panel a method on one scale of colours, then the difference of the two."""
    x, depths = plane.x / a_h, [z / a_h for z in plane.depths]
    fields = {s: [_quantity(sigma, quantity) / p_h for sigma in plane.stress[s]] for s in sources}
    colours = _colours(quantity, [f for some in fields.values() for f in some])
    title = f"{TITLES.get(quantity, quantity)} / p_h"
    panels = []
    for source, some in fields.items():
        values = np.concatenate([f.ravel() for f in some])
        known = values[np.isfinite(values)]
        span = f"{plain(known.min(), 3)} to {plain(known.max(), 3)}" if known.size else "not finite"
        drawn = draw_field(
            rasterised(x, depths, some, frame), frame, colours, label=f"{title} by {source_label(source)}"
        )
        panels.append(Panel(f"{title}, {source_label(source)}", drawn, span, ""))
    if len(sources) == 2:
        panels.append(_difference(fields, x, depths, frame, title))
    return panels


def _difference(
    fields: dict[str, list[Array]],
    x: Array,
    depths: Sequence[Array],
    frame: Frame,
    title: str,
) -> Panel:
    gaps = [np.abs(one - other) for one, other in zip(*fields.values(), strict=True)]
    largest = max((float(g.max()) for g in gaps), default=0.0)
    with np.errstate(divide="ignore"):
        exponents = [np.log10(np.maximum(g, 10.0 ** (FLOOR - 1))) for g in gaps]
    top = max(TOP, float(np.ceil(np.log10(largest)))) if 0 < largest < np.inf else TOP
    colours = Scale(FLOOR, top, DIFFERENCE, logarithmic=True)
    drawn = draw_field(
        rasterised(x, depths, exponents, frame, smooth=False),
        frame,
        colours,
        label=f"difference of both methods in {title}, logarithmic",
        lines=False,
    )
    return Panel(f"|difference| of {title}", drawn, f"largest {scientific(largest)}", "")


def _colours(quantity: str, values: Sequence[Array]) -> Scale:
    """One scale for both methods: from zero up for von Mises, even about zero for the others."""
    largest = max(
        (float(np.max(np.abs(v), initial=0.0)) for v in values if np.isfinite(v).all()), default=1.0
    )
    largest = largest or 1.0
    if quantity == "von_mises":
        return Scale(0.0, largest, SEQUENTIAL)
    return Scale(-largest, largest, DIVERGING)


def _caption(plane: Plane, sources: Sequence[str]) -> str:
    points = sum(z.size for z in plane.depths) * plane.x.size
    text = (
        "Plane y = 0, lengths over a_h, stresses over p_h, tension positive; the red bar is the contact, "
        f"lines across are interfaces. {points} points on {sum(z.size for z in plane.depths)} depths, "
        "interfaces from either side; between them the colours are interpolated. "
    )
    if len(sources) == 2:
        text += (
            "Both methods are taken at the same points, nodes of the semi-analytical grid, and drawn with "
            "one scale of colours; level lines at its ticks. The difference is logarithmic, its scale from "
            f"{scientific(10.0**FLOOR, 1)} the same in every case."
        )
    return text
