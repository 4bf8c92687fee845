"""Figures of a study at the width of a column: each as vector PDF, as SVG, its numbers as CSV.

Lengths and stresses are in the units of the study; second axes give them over a_h, p_h of the substrate.
"""

import io
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backends.backend_pdf import FigureCanvasPdf
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import LogLocator, NullFormatter, ScalarFormatter
from scipy.interpolate import PchipInterpolator

from verification.cases.unit_numbers import Units
from verification.page.page_parts import written
from verification.problem.array_types import Array
from verification.problem.quantity import QUANTITIES as QUANTITY
from verification.running.checked_files import write_atomically
from verification.sources.source_registry import SOURCES as RECORDS
from verification.study.choice.failure_criteria import MODES
from verification.study.choice.thickness_choice import Choice
from verification.study.largest_stresses import QUANTITIES
from verification.study.study_table import SCALARS, SCALES, SOURCES
from verification.study.thickness_curves import ThicknessCurve

# Okabe and Ito's colours, distinct for the colour-blind; dashes distinguish friction.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00", "#000000")
COLOUR_OF = dict(zip(MODES, COLOURS, strict=True))
DASHES: tuple[Any, ...] = ("-", (0, (5, 2)), (0, (1.2, 1.4)), (0, (5, 1.5, 1, 1.5)))
COLUMN, LEFT, TOP, BOTTOM, ROW = 88.0, 15.0, 9.5, 9.0, 3.7  # mm; a row of the legend
NAMES = {
    "sigma_xx_surface": r"largest $\sigma_{xx}$, surface",
    "sigma_xx_base": r"largest $\sigma_{xx}$, base",
    "sigma_xx_substrate": r"largest $\sigma_{xx}$, substrate",
    "sigma_xz_interface": r"largest $|\sigma_{xz}|$, interface",
    "sigma_zz_interface": r"largest $\sigma_{zz}$, interface",
    "von_mises_coating": "von Mises, coating",
    "von_mises_substrate": "von Mises, substrate",
}
_SETTINGS: Any = {
    "font.size": 7,
    "font.family": "DejaVu Sans",
    "axes.linewidth": 0.6,
    "lines.linewidth": 1.2,
    "xtick.direction": "in",
    "ytick.direction": "in",
    "pdf.fonttype": 42,
    "svg.hashsalt": "coatcheck",
    "savefig.facecolor": "white",
    "axes.grid": True,
    "grid.linewidth": 0.3,
    "grid.color": "#cccccc",
}


@dataclass(frozen=True)
class Drawn:
    """One figure under its ``name``, the bytes of its ``pdf`` and ``svg``, its numbers as ``csv``."""

    name: str
    title: str
    caption: str
    pdf: bytes
    svg: bytes
    csv: str


@contextmanager
def sheet(height: float, legend: int = 0, right: float = 13.5) -> Iterator[Figure]:
    """An empty figure of a column's width and a ``height`` [mm] in the settings of a paper.

    legend : rows of keys under it.   right : margin [mm].
    Margins are fixed: to measure every label instead takes longer than all the rest.
    """
    with mpl.rc_context(_SETTINGS), warnings.catch_warnings():
        # Curves without one finite number leave an empty frame, without a warning.
        warnings.simplefilter("ignore")
        total = height + ROW * legend
        figure = Figure(figsize=(COLUMN / 25.4, total / 25.4))
        figure.subplots_adjust(
            left=LEFT / COLUMN,
            right=1 - right / COLUMN,
            top=1 - TOP / total,
            bottom=(BOTTOM + ROW * legend) / total,
            hspace=0.16,
        )
        yield figure


def drawn(
    figure: Figure, name: str, title: str, caption: str, rows: Sequence[Sequence[str | float]]
) -> Drawn:
    """``figure`` written both ways; the same figure always gives the same bytes.

    rows : its numbers, heads first.
    """
    pdf, svg = io.BytesIO(), io.BytesIO()
    FigureCanvasPdf(figure).print_figure(pdf, format="pdf", metadata={"CreationDate": None}, dpi=300)
    FigureCanvasSVG(figure).print_figure(svg, format="svg", metadata={"Date": None}, dpi=200)
    numbers = written([[one if isinstance(one, str) else f"{one:.9g}" for one in row] for row in rows])
    return Drawn(name.replace(".", "_"), title, caption, pdf.getvalue(), svg.getvalue(), numbers)


def write_drawn(figure: Drawn, folder: Path) -> None:
    """NAME.pdf, NAME.svg, NAME.csv under ``folder``. Raises StoreError where it cannot be written."""
    for kind, data in (("pdf", figure.pdf), ("svg", figure.svg), ("csv", figure.csv)):
        write_atomically(folder / f"{figure.name}.{kind}", data)


def stress_figures(curves: Sequence[ThicknessCurve], units: Units) -> list[Drawn]:
    """For each failure mode its stress against thickness, compliant above stiff coatings."""
    return [
        _against_thickness(curves, units, f"stress_{name}", [name], f"{name}: {MODES[name]}")
        for name in QUANTITIES
    ]


def contact_figure(curves: Sequence[ThicknessCurve], units: Units) -> list[Drawn]:
    """Peak pressure, contact radius and approach against thickness; they do not depend on friction."""
    smallest = min(curve.friction for curve in curves)
    chosen = [curve for curve in curves if curve.friction == smallest]
    title = "Peak pressure, contact radius, approach"
    return [_against_thickness(chosen, units, "contact", list(SCALARS), title)]


def _against_thickness(
    curves: Sequence[ThicknessCurve], units: Units, name: str, quantities: Sequence[str], title: str
) -> Drawn:
    sides = [
        ("compliant coating, $E_1 < E_2$", [c for c in curves if c.ratio < 1]),
        ("stiff coating, $E_1 \\geq E_2$", [c for c in curves if c.ratio >= 1]),
    ]
    sides = [(heading, members) for heading, members in sides if members]
    # A panel for each quantity holds all coatings, or one for each side a single quantity.
    panels_of = [
        (quantity, heading if len(sides) == 2 else "", members)
        for quantity in quantities
        for heading, members in (sides if len(quantities) == 1 else [("", list(curves))])
    ]
    frictions = sorted({c.friction for c in curves})
    ratios = sorted({c.ratio for c in curves})
    colours = {ratio: COLOURS[i % len(COLOURS)] for i, ratio in enumerate(ratios)}
    thickness = f"h [{units.length}]"
    rows: list[Sequence[str | float]] = [
        ["E1/E2", "f", "h / a_h", thickness, "quantity", "over its scale", "value", "unit", "source"]
    ]
    keys = _keys(ratios, frictions, {s for c in curves for s in c.marks})
    with sheet(TOP + BOTTOM + 40.5 * len(panels_of), -(-len(keys) // 3)) as figure:
        panels = figure.subplots(len(panels_of), 1, sharex=True, squeeze=False)[:, 0]
        for axes, (quantity, heading, members) in zip(panels, panels_of, strict=True):
            scale = SCALES[quantity]
            unit, one_unit = (units.stress, units.pascal) if scale == "p_h" else (units.length, units.metre)
            size = getattr(curves[0], scale) / one_unit
            for curve in members:
                colour, h = colours[curve.ratio], curve.a_h / units.metre
                dash = DASHES[frictions.index(curve.friction) % len(DASHES)]
                axes.plot(curve.h * h, curve.value[quantity] * size, color=colour, linestyle=dash)
                points = {SOURCES[0]: (curve.h, curve.value[quantity])}
                for source, marks in curve.marks.items():
                    at, value = points[source] = marks[quantity]
                    _mark(axes, at * h, value * size, source, colour)
                rows += [
                    [curve.ratio, curve.friction, x, x * h, quantity, y, y * size, unit, source]
                    for source, (at, value) in points.items()
                    for x, y in zip(at, value, strict=True)
                ]
            axes.set_ylabel(f"{NAMES.get(quantity) or f'${QUANTITY[quantity].tex}$'} [{unit}]")
            _beside(axes, size, f"over ${scale}$".replace("delta", r"\delta"))
            if heading:
                axes.text(0.5, 0.94, heading, transform=axes.transAxes, ha="center", va="top")
                axes.margins(y=0.2)
        thickness_axes(list(panels), curves[0].a_h / units.metre, units)
        below(figure, keys, 3)
        return drawn(figure, name, title, "", rows)


def _mark(axes: Axes, h: Array, value: Array, source: str, colour: str) -> None:
    marker = RECORDS[source].style.marker
    axes.plot(h, value, marker, color=colour, markerfacecolor="none", markersize=4, markeredgewidth=0.7)


def _beside(axes: Axes, size: float, label: str) -> None:
    """A second vertical axis for the values over ``size``."""
    second = axes.secondary_yaxis("right", functions=_over(size))
    second.set_ylabel(label)
    second.yaxis.set_major_formatter(lambda value, _: _short(value))


def _short(value: float) -> str:
    """A number beside an axis: a power of ten common to all would lie on the numbers of the axis above."""
    if not 0 < abs(value) < 0.01:
        return f"{value:.4g}"
    digits, power = f"{value:.2e}".split("e")
    return f"{float(digits):g}e{int(power)}"


def _over(size: float) -> tuple[Callable[[Any], Any], Callable[[Any], Any]]:
    """Functions of a second axis: from a value to that over ``size``, and back."""
    return (lambda value: value / size), (lambda value: value * size)


def thickness_axes(panels: Sequence[Axes], a_h: float, units: Units) -> None:
    """Logarithmic thickness below the last of ``panels``, over ``a_h`` above the first."""
    for axes in panels:
        axes.set_xscale("log")
    top = panels[0].secondary_xaxis("top", functions=_over(a_h))
    top.set_xlabel("$h / a_h$")
    low, high = panels[0].get_xlim()
    subs = (1.0, 2.0, 5.0) if high > 8 * low else (1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0)
    for axis in (top.xaxis, panels[-1].xaxis):
        axis.set_major_locator(LogLocator(subs=subs))
        axis.set_major_formatter(ScalarFormatter())
        axis.set_minor_formatter(NullFormatter())
    panels[-1].set_xlabel(f"coating thickness h [{units.length}]")


def _keys(ratios: Sequence[float], frictions: Sequence[float], sources: set[str]) -> list[Line2D]:
    def key(label: str, colour: str = "#444444", **style: Any) -> Line2D:
        return Line2D([], [], color=colour, label=label, **style)

    handles = [key(f"$E_1/E_2$ = {r:.4g}", COLOURS[i % len(COLOURS)]) for i, r in enumerate(ratios)]
    if len(frictions) > 1:
        handles += [key(f"f = {f:g}", linestyle=DASHES[i % len(DASHES)]) for i, f in enumerate(frictions)]
    for record in (RECORDS[source] for source in SOURCES[1:] if source in sources):
        marker = record.style.marker
        handles.append(key(record.label, marker=marker, linestyle="none", markerfacecolor="none"))
    return handles


def below(figure: Figure, handles: Sequence[Artist], columns: int) -> None:
    """The legend of a figure under it, in at most so many columns."""
    figure.legend(
        handles=handles,
        loc="lower center",
        ncols=min(columns, len(handles)),
        borderaxespad=0.2,
        labelspacing=0.35,
        frameon=False,
        fontsize=6.5,
        columnspacing=1.2,
        handlelength=2.2,
    )


def draw_use(axes: Axes, x: Array, use: Mapping[str, Array]) -> None:
    """Stress over strength of each mode along ``x``, with the line where they are equal."""
    for mode, one in use.items():
        axes.plot(x, one, color=COLOUR_OF[mode], label=mode)
    axes.axhline(1.0, color="#c02a2a", linewidth=0.9, linestyle=(0, (4, 2)))
    axes.set_ylabel("stress over strength")


def draw_shares(axes: Axes, x: Array, shares: Mapping[str, Array], rest: float | None = None) -> None:
    """Probabilities of each mode along ``x``, stacked; ``rest``, of no single mode, below them in grey."""
    colours = [pale(COLOUR_OF[mode]) for mode in shares]
    stacked = [*shares.values()]
    if rest is not None:
        colours, stacked = [mpl.colors.to_rgba("#bbbbbb"), *colours], [np.full(x.shape, rest), *stacked]
    axes.stackplot(x, *stacked, colors=colours, linewidth=0)
    axes.set_ylim(0, 1)


def use_figures(choices: Sequence[Choice], units: Units) -> list[Drawn]:
    """Stress over strength against thickness, admissible ranges shaded; [] where no strengths are given.

    For strengths that scatter the probability that each mode governs too, and that any fails.
    """
    return [_use(choice, units) for choice in choices if choice.criteria.limited]


def _use(choice: Choice, units: Units) -> Drawn:
    curve, modes = choice.curves[0], choice.modes
    size = curve.a_h / units.metre
    scattered = choice.criteria.scatters
    use = dict(zip(modes, choice.use.max(axis=0), strict=True))
    some = np.linspace(0, choice.h.size - 1, 81).astype(int)
    h = choice.h[some] * size
    heads, numbers = ["h / a_h", f"h [{units.length}]", *modes], [choice.h, choice.h * size, *use.values()]
    columns = [one[some] for one in numbers]
    with sheet(72 + 38 * scattered, (len(modes) + scattered + 1) // 2, right=4) as figure:
        panels = figure.subplots(1 + scattered, 1, sharex=True, squeeze=False)[:, 0]
        axes = panels[0]
        for pair in choice.ranges:
            ends = [edge if end is None else end.h for end, edge in zip(pair, choice.h[[0, -1]], strict=True)]
            axes.axvspan(ends[0] * size, ends[1] * size, color="#d5efe1", linewidth=0)
        draw_use(axes, choice.h * size, use)
        axes.set_yscale("log")
        axes.set_ylim(0.02, 1.5 * max(1.0, max(float(one.max()) for one in use.values())))
        caption = (
            "Largest over all frictions; below 0.02 not drawn. Green: admissible thicknesses, where every "
            "stress stays below its strength"
            + (f", the {100 * choice.criteria.fractile:g} % fractile." if scattered else ".")
        )
        if scattered:
            chances = choice.chances(choice.h[some])
            draw_shares(panels[1], h, dict(zip(modes, chances.governs, strict=True)))
            panels[1].plot(h, chances.fails, color="black", label="coating fails")
            panels[1].set_ylabel("probability")
            caption += (
                " Below: probability that each mode governs; line: that any stress exceeds its strength."
            )
            heads += [*(f"{mode} governs" for mode in modes), "fails"]
            columns += [*chances.governs, chances.fails]
        thickness_axes(list(panels), size, units)
        handles = [line for one in panels for line in one.get_legend_handles_labels()[0] if line in one.lines]
        below(figure, handles, 2)
        title = f"Stress over strength, E1/E2 = {curve.ratio:.4g}"
        return drawn(figure, f"use_{curve.ratio:.4g}", title, caption, [heads, *np.transpose(columns)])


def governing_figure(choices: Sequence[Choice], units: Units) -> list[Drawn]:
    """The mode that governs over (h, E1/E2), the largest over frictions; [] for a single modulus.

    Between the solved points, which are dots, each use of strength is read by monotone cubics in log h,
    then by straight lines in log E1/E2.
    """
    if len(choices) < 2:
        return []
    first = choices[0]
    modes, size = first.modes, first.curves[0].a_h / units.metre
    over, ratio, use = _map(choices)
    h, governing, largest = over * size, use.argmax(axis=0), use.max(axis=0)
    with sheet(78, len(modes), right=4) as figure:
        axes = figure.subplots(1, 1)
        axes.grid(visible=False)
        colours = ListedColormap([pale(COLOUR_OF[mode]) for mode in modes])
        axes.pcolormesh(
            h, ratio, governing, cmap=colours, vmin=-0.5, vmax=len(modes) - 0.5, shading="nearest",
            rasterized=True
        )  # fmt: skip
        lines = axes.contour(h, ratio, largest, levels=6, colors="#444444", linewidths=0.6)
        axes.clabel(lines, fontsize=6, fmt="%.3g")
        if first.criteria.limited:
            axes.contour(h, ratio, largest, levels=[1.0], colors="#c02a2a", linewidths=1.6)
        for curve in (one.curves[0] for one in choices):
            axes.plot(curve.h * size, np.full_like(curve.h, curve.ratio), ".", color="#444444", ms=1.6)
        axes.set_yscale("log")
        axes.yaxis.set_minor_formatter(NullFormatter())
        axes.set_yticks(sorted({one.curves[0].ratio for one in choices}))
        axes.yaxis.set_major_formatter(lambda y, _: f"{y:.3g}")
        axes.set_ylabel("$E_1/E_2$")
        thickness_axes([axes], size, units)
        handles = [Patch(color=pale(COLOUR_OF[m]), label=f"{m}: {MODES[m]}") for m in modes]
        below(figure, handles, 1)
        rows: list[Sequence[str | float]] = [
            ["E1/E2", "h / a_h", f"h [{units.length}]", "largest use", "governing"]
        ]
        rows += [
            [ratio[i], over[j], h[j], largest[i, j], modes[governing[i, j]]]
            for i in range(0, ratio.size, 4)
            for j in range(0, h.size, 8)
        ]
        quantity = "stress over strength, red where it is 1" if first.criteria.limited else "stress over p_h"
        caption = (
            "Colour: the mode whose stress is largest against its strength, at the worst friction. Lines: "
            f"the largest {quantity}. Dots: solved points."
        )
        return [drawn(figure, "governing_mode", "Governing failure mode", caption, rows)]


def pale(colour: str) -> tuple[float, float, float, float]:
    """A ``colour`` for areas, through which the page shows, light or dark."""
    return mpl.colors.to_rgba(colour, 0.45)


def _map(choices: Sequence[Choice]) -> tuple[Array, Array, Array]:
    """h/a_h, E1/E2, uses of strength (modes, ratios, thicknesses) on a dense grid."""
    members = sorted(choices, key=lambda one: one.curves[0].ratio)
    h = np.geomspace(max(one.h[0] for one in members), min(one.h[-1] for one in members), 240)
    known = np.log([one.curves[0].ratio for one in members])
    ratio = np.exp(np.linspace(known[0], known[-1], 120))
    rows = np.stack(
        [PchipInterpolator(np.log(one.h), one.use.max(axis=0), axis=1)(np.log(h)) for one in members], axis=1
    )
    at = np.clip(np.searchsorted(known, np.log(ratio)) - 1, 0, known.size - 2)
    share = ((np.log(ratio) - known[at]) / np.diff(known)[at])[:, None]
    return h, ratio, (1 - share) * rows[:, at] + share * rows[:, at + 1]
