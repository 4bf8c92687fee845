"""Figures of a study fit for a paper: each as vector PDF, as PNG, its numbers as CSV.

Lengths over a_h, stresses over p_h, both of the bare substrate; a second axis gives MPa.
"""

import io
import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.backends.backend_pdf import FigureCanvasPdf
from matplotlib.colors import ListedColormap
from matplotlib.contour import QuadContourSet
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import NullFormatter, ScalarFormatter
from scipy.interpolate import PchipInterpolator

from verification.problem.arrays import Array
from verification.problem.quantity import QUANTITIES as QUANTITY
from verification.report.tables.csv import written
from verification.running.store import write_atomically
from verification.sources.registry import SOURCES as RECORDS
from verification.study.criteria import MODES, Judged
from verification.study.curves import Curve
from verification.study.quantities import QUANTITIES
from verification.study.table import SCALARS, SOURCES

# Okabe and Ito's colours, distinct for the colour-blind; dashes distinguish friction.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00", "#000000")
DASHES: tuple[Any, ...] = ("-", (0, (5, 2)), (0, (1.2, 1.4)), (0, (5, 1.5, 1, 1.5)))
DPI = 200
LEAST = 1e-7  # smaller differences are drawn here
NAMES = {
    "sigma_xx_surface": r"largest $\sigma_{xx}$, surface",
    "sigma_xx_base": r"largest $\sigma_{xx}$, base of the coating",
    "sigma_xx_substrate": r"largest $\sigma_{xx}$, top of the substrate",
    "sigma_xz_interface": r"largest $|\sigma_{xz}|$, interface",
    "sigma_zz_interface": r"largest $\sigma_{zz}$, interface",
    "von_mises_coating": "largest von Mises stress, coating",
    "von_mises_substrate": "largest von Mises stress, substrate",
}
_SETTINGS: Any = {
    "font.size": 8,
    "font.family": "DejaVu Sans",
    "axes.linewidth": 0.6,
    "lines.linewidth": 1.3,
    "xtick.direction": "in",
    "ytick.direction": "in",
    "pdf.fonttype": 42,
    "savefig.facecolor": "white",
}


@dataclass(frozen=True)
class Drawn:
    """One figure under its ``name``, the bytes of its ``pdf`` and ``png``, its numbers as ``csv``."""

    name: str
    title: str
    caption: str
    pdf: bytes
    png: bytes
    csv: str


@contextmanager
def sheet(width: float, height: float) -> Iterator[Figure]:
    """An empty figure of ``width`` by ``height`` [mm] in the settings of a paper."""
    with mpl.rc_context(_SETTINGS), warnings.catch_warnings():
        # Curves without one finite number leave an empty frame, without a warning.
        warnings.simplefilter("ignore")
        yield Figure(figsize=(width / 25.4, height / 25.4), layout="constrained")


def drawn(figure: Figure, name: str, title: str, caption: str, rows: Sequence[Sequence[str]]) -> Drawn:
    """``figure`` written both ways; the same figure always gives the same bytes."""
    pdf, png = io.BytesIO(), io.BytesIO()
    FigureCanvasAgg(figure)
    # Laid out once, not again for each format.
    layout = figure.get_layout_engine()
    assert layout is not None
    layout.execute(figure)
    figure.set_layout_engine(None)
    FigureCanvasPdf(figure).print_figure(pdf, format="pdf", metadata={"CreationDate": None})
    FigureCanvasAgg(figure).print_figure(png, format="png", dpi=DPI, metadata={"Software": None})
    return Drawn(name, title, caption, pdf.getvalue(), png.getvalue(), written(rows))


def write_drawn(figure: Drawn, folder: Path) -> None:
    """NAME.pdf, NAME.png, NAME.csv under ``folder``. Raises StoreError where it cannot be written."""
    for kind, data in (("pdf", figure.pdf), ("png", figure.png), ("csv", figure.csv)):
        write_atomically(folder / f"{figure.name}.{kind}", data)


def stress_figures(curves: Sequence[Curve]) -> list[Drawn]:
    """For each failure mode its stress against thickness, compliant beside stiff coatings."""
    p_h = curves[0].p_h
    return [
        _against_thickness(
            curves, f"stress_{name}", name, f"{name}: {MODES[name]}", f"{NAMES[name]} / $p_h$", p_h=p_h
        )
        for name in QUANTITIES
    ]


def contact_figure(curves: Sequence[Curve]) -> list[Drawn]:
    """Peak pressure, contact radius and approach against thickness; they do not depend on friction."""
    smallest = min(curve.friction for curve in curves)
    chosen = [curve for curve in curves if curve.friction == smallest]
    scales = {"delta_h": r"\delta_h"}
    found = []
    for name, scale in SCALARS.items():
        label = f"${QUANTITY[name].tex} / {scales.get(scale, scale)}$"
        found.append(_against_thickness(chosen, f"contact_{name}", name, name.replace("_", " "), label))
    return found


def _values(curve: Curve, quantity: str) -> Array:
    return curve.stress[quantity] if quantity in curve.stress else curve.scalar[quantity]


def _against_thickness(
    curves: Sequence[Curve], name: str, quantity: str, title: str, label: str, *, p_h: float | None = None
) -> Drawn:
    sides = [
        ("compliant coating, $E_1 < E_2$", [c for c in curves if c.ratio < 1]),
        ("stiff coating, $E_1 \\geq E_2$", [c for c in curves if c.ratio >= 1]),
    ]
    sides = [(heading, members) for heading, members in sides if members]
    frictions = sorted({c.friction for c in curves})
    ratios = sorted({c.ratio for c in curves})
    colours = {ratio: COLOURS[i % len(COLOURS)] for i, ratio in enumerate(ratios)}
    rows = [["E1/E2", "f", "h / a_h", f"{quantity} over its scale", "source"]]
    checked = any(curve.marks for curve in curves)
    with sheet(170 if len(sides) == 2 else 130, 92 if checked else 68) as figure:
        heights = (3, 1)[: 1 + checked]
        grid = figure.subplots(
            len(heights), len(sides), sharey="row", sharex="col", squeeze=False, height_ratios=heights
        )
        panels = grid[0]
        for axes, (heading, members) in zip(panels, sides, strict=True):
            for curve in members:
                colour = colours[curve.ratio]
                dash = DASHES[frictions.index(curve.friction) % len(DASHES)]
                axes.plot(curve.h, _values(curve, quantity), color=colour, linestyle=dash)
                points = {SOURCES[0]: (curve.h, _values(curve, quantity))}
                for source, marks in curve.marks.items():
                    _mark(axes, *marks[quantity], source, colour)
                    points[source] = marks[quantity]
                rows += [
                    [f"{curve.ratio:g}", f"{curve.friction:g}", f"{x:.9g}", f"{y:.9g}", source]
                    for source, (h, value) in points.items()
                    for x, y in zip(h, value, strict=True)
                ]
            _thickness_axis(axes, heading)
        panels[0].set_ylabel(label)
        if checked:
            for axes in panels:
                axes.set_xlabel("")
            _differences(grid[1], sides, quantity, colours)
        if p_h is not None:
            unit = p_h / 1e6
            second = panels[-1].secondary_yaxis("right", functions=(lambda y: y * unit, lambda y: y / unit))
            second.set_ylabel("MPa")
        _legend(figure, ratios, frictions, {s for c in curves for s in c.marks})
        caption = (
            "Lines: semi-analytical method; circles: finite elements; crosses: the exact reference, at the "
            "cross-checked points; below, how far these are from the lines, over the same scale; dashes 0.5 "
            "percent, dots 0.1."
            if checked
            else "Lines: semi-analytical method; no point was cross-checked."
        )
        return drawn(figure, name, title, caption, rows)


def _differences(
    panels: Sequence[Axes], sides: Sequence[tuple[str, list[Curve]]], quantity: str, colours: dict[float, str]
) -> None:
    """|mark - curve| at every cross-checked thickness, on a logarithmic scale that ends at ``LEAST``."""
    for axes, (_, members) in zip(panels, sides, strict=True):
        for curve in members:
            for source, marks in curve.marks.items():
                at, value = marks[quantity]
                known = np.isin(at, curve.h)
                here = _values(curve, quantity)[np.searchsorted(curve.h, at[known])]
                gap = np.maximum(np.abs(value[known] - here), LEAST)
                _mark(axes, at[known], gap, source, colours[curve.ratio])
        axes.set_yscale("log")
        axes.set_ylim(0.6 * LEAST, 1e-2)
        axes.set_yticks([1e-7, 1e-5, 1e-3])
        axes.axhline(5e-3, color="#666666", linewidth=0.7, linestyle=(0, (4, 2)))
        axes.axhline(1e-3, color="#666666", linewidth=0.7, linestyle=(0, (1, 1.5)))
        _thickness_axis(axes, "")
    panels[0].set_ylabel("difference")


def _mark(axes: Axes, h: Array, value: Array, source: str, colour: str) -> None:
    marker = RECORDS[source].style.marker
    axes.plot(h, value, marker, color=colour, markerfacecolor="none", markersize=4.5, markeredgewidth=0.8)


def _thickness_axis(axes: Axes, title: str) -> None:
    axes.set_xscale("log")
    axes.xaxis.set_major_formatter(ScalarFormatter())
    axes.xaxis.set_minor_formatter(NullFormatter())
    low, high = axes.get_xlim()
    ticks = (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100)
    axes.set_xticks([tick for tick in ticks if low <= tick <= high])
    axes.set_xlabel(r"coating thickness, $h / a_h$")
    axes.set_title(title, fontsize=8)
    axes.grid(True, linewidth=0.3, color="#cccccc")


def _legend(figure: Figure, ratios: Sequence[float], frictions: Sequence[float], sources: set[str]) -> None:
    def key(label: str, colour: str = "#444444", **style: Any) -> Line2D:
        return Line2D([], [], color=colour, label=label, **style)

    handles = [key(f"$E_1/E_2$ = {r:.4g}", COLOURS[i % len(COLOURS)]) for i, r in enumerate(ratios)]
    if len(frictions) > 1:
        handles += [key(f"f = {f:g}", linestyle=DASHES[i % len(DASHES)]) for i, f in enumerate(frictions)]
    for record in (RECORDS[source] for source in SOURCES[1:] if source in sources):
        marker = record.style.marker
        handles.append(key(record.label, marker=marker, linestyle="none", markerfacecolor="none"))
    _below(figure, handles, min(len(handles), 5))


def _below(figure: Figure, handles: Sequence[Artist], columns: int) -> None:
    figure.legend(handles=handles, loc="outside lower center", ncols=columns, frameon=False)


def use_figures(judgements: Sequence[Judged]) -> list[Drawn]:
    """Stress over strength against thickness, admissible ranges shaded; [] where no strengths are given."""
    chosen = [j for j in judgements if j.limited]
    if not chosen:
        return []
    found = []
    caption = (
        "Green: admissible thicknesses, where every stress stays below its strength. Triangle: the "
        "preferable thickness."
    )
    for ratio in sorted({j.curve.ratio for j in chosen}):
        members = [j for j in chosen if j.curve.ratio == ratio]
        rows = [["E1/E2", "f", "h / a_h", "h [m]", *members[0].modes]]
        with sheet(62 * len(members) + 12, 75) as figure:
            panels = figure.subplots(1, len(members), sharey=True, squeeze=False)[0]
            for axes, judgement in zip(panels, members, strict=True):
                curve = judgement.curve
                for low, high in judgement.admissible:
                    axes.axvspan(low, high, color="#d5efe1", linewidth=0)
                for mode, use in zip(judgement.modes, judgement.utilisation, strict=True):
                    at = list(MODES).index(mode)
                    axes.plot(curve.h, use, color=COLOURS[at], label=mode, marker=".", markersize=3)
                axes.axhline(1.0, color="#c02a2a", linewidth=0.9, linestyle=(0, (4, 2)))
                axes.plot(*judgement.preferable[:2], "v", color="black", markersize=4)
                axes.set_yscale("log")
                axes.set_ylim(0.02, 1.5 * max(1.0, *(float(j.utilisation.max()) for j in members)))
                _thickness_axis(axes, f"$E_1/E_2$ = {ratio:.4g}, f = {curve.friction:g}")
                rows += [
                    [f"{ratio:g}", f"{curve.friction:g}", f"{h:.9g}", f"{h * curve.a_h:.6g}"]
                    + [f"{u:.6g}" for u in judgement.utilisation[:, i]]
                    for i, h in enumerate(curve.h)
                ]
            panels[0].set_ylabel("stress over strength")
            _below(figure, panels[0].get_legend_handles_labels()[0], 3)
            name = f"use_{ratio:.4g}".replace(".", "_")
            found.append(drawn(figure, name, f"Stress over strength, E1/E2 = {ratio:.4g}", caption, rows))
    return found


def governing_figure(judgements: Sequence[Judged]) -> list[Drawn]:
    """The mode that governs over (h/a_h, E1/E2), a panel for each friction; [] for a single modulus.

    Between the solved points, which are dots, each use of strength is read by monotone cubics in log h,
    then by straight lines in log E1/E2.
    """
    frictions = sorted({j.curve.friction for j in judgements})
    grids = [_map([j for j in judgements if j.curve.friction == f]) for f in frictions]
    if any(grid is None for grid in grids):
        return []
    modes = judgements[0].modes
    rows = [["f", "E1/E2", "h / a_h", "largest use", "governing"]]
    with sheet(62 * len(frictions) + 8, 78) as figure:
        panels = figure.subplots(1, len(frictions), sharey=True, squeeze=False)[0]
        for axes, friction, grid in zip(panels, frictions, grids, strict=True):
            assert grid is not None
            h, ratio, use = grid
            governing, largest = use.argmax(axis=0), use.max(axis=0)
            colours = ListedColormap([_pale(COLOURS[list(MODES).index(mode)]) for mode in modes])
            axes.pcolormesh(
                h, ratio, governing, cmap=colours, vmin=-0.5, vmax=len(modes) - 0.5, shading="nearest",
                rasterized=True
            )  # fmt: skip
            lines = axes.contour(h, ratio, largest, levels=6, colors="#555555", linewidths=0.6)
            axes.clabel(lines, fontsize=6, fmt="%.3g", manual=_places(lines, h, ratio))
            if judgements[0].limited:
                axes.contour(h, ratio, largest, levels=[1.0], colors="#c02a2a", linewidths=1.6)
            for judgement in judgements:
                curve = judgement.curve
                if curve.friction == friction:
                    axes.plot(curve.h, np.full_like(curve.h, curve.ratio), ".", color="#222222", ms=1.6)
            axes.set_yscale("log")
            axes.yaxis.set_minor_formatter(NullFormatter())
            axes.set_yticks(sorted({j.curve.ratio for j in judgements}))
            axes.yaxis.set_major_formatter(lambda y, _: f"{y:.3g}")
            _thickness_axis(axes, f"f = {friction:g}")
            rows += [
                [
                    f"{friction:g}",
                    *(f"{x:.6g}" for x in (ratio[i], h[j], largest[i, j])),
                    modes[governing[i, j]],
                ]
                for i in range(0, ratio.size, 4)
                for j in range(0, h.size, 8)
            ]
        panels[0].set_ylabel("$E_1/E_2$")
        handles = [Patch(color=_pale(COLOURS[list(MODES).index(m)]), label=f"{m}: {MODES[m]}") for m in modes]
        _below(figure, handles, 2)
        quantity = "stress over strength, red where it is 1" if judgements[0].limited else "stress over p_h"
        caption = (
            f"Colour: the mode whose stress is largest against its strength. Lines: the largest {quantity}. "
            "Dots: solved points."
        )
        return [drawn(figure, "governing_mode", "Governing failure mode", caption, rows)]


def _places(lines: QuadContourSet, h: Array, ratio: Array) -> list[tuple[float, float]]:
    """A point of each contour line for its number: off the frame, off the numbers of the lines beside it."""
    low, high = np.log(ratio[[0, -1]]) + 0.06 * np.log(ratio[-1] / ratio[0]) * np.array([1, -1])
    found = []
    for i, path in enumerate(lines.get_paths()):
        x, y = np.log(np.asarray(path.vertices).reshape(-1, 2)).T
        inside = np.flatnonzero((y > low) & (y < high))
        if inside.size:
            wanted = np.log(h[0]) + (0.3, 0.5, 0.7)[i % 3] * np.log(h[-1] / h[0])
            at = inside[np.abs(x[inside] - wanted).argmin()]
            found.append((float(np.exp(x[at])), float(np.exp(y[at]))))
    return found


def _pale(colour: str) -> tuple[float, float, float]:
    r, g, b = mpl.colors.to_rgb(colour)
    return (0.45 * r + 0.55, 0.45 * g + 0.55, 0.45 * b + 0.55)


def _map(judgements: Sequence[Judged]) -> tuple[Array, Array, Array] | None:
    """h/a_h, E1/E2, uses of strength (modes, ratios, thicknesses) on a dense grid; None for one modulus."""
    members = sorted(judgements, key=lambda j: j.curve.ratio)
    if len(members) < 2:
        return None
    h = np.geomspace(max(j.curve.h[0] for j in members), min(j.curve.h[-1] for j in members), 240)
    ratio = np.geomspace(members[0].curve.ratio, members[-1].curve.ratio, 120)
    rows = np.stack(
        [PchipInterpolator(np.log(j.curve.h), j.utilisation, axis=1)(np.log(h)) for j in members], axis=1
    )
    known = np.log([j.curve.ratio for j in members])
    at = np.clip(np.searchsorted(known, np.log(ratio)) - 1, 0, known.size - 2)
    share = ((np.log(ratio) - known[at]) / np.diff(known)[at])[:, None]
    return h, ratio, (1 - share) * rows[:, at] + share * rows[:, at + 1]
