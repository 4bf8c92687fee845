"""Figure of the benchmark's history: each ratio, commit by commit."""

from collections.abc import Sequence
from math import ceil
from pathlib import Path

from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator

from bench.history import BenchRun
from verification.desk.answer_figure import COLOURS, save

__all__ = ["draw", "write"]


def write(runs: Sequence[BenchRun], path: Path) -> None:
    """Write the figure; see ``solved.save``."""
    save(lambda: draw(runs), path)


def draw(runs: Sequence[BenchRun]) -> Figure:
    """A panel for each thing measured over, logarithmic; what is asked is dotted.  runs : at least one."""
    latest = {(figure.name, figure.over): figure for run in runs for figure in run.figures}
    panels = list(dict.fromkeys(over for _, over in latest))
    columns = min(2, len(panels))
    rows = ceil(len(panels) / columns)
    figure = Figure(figsize=(6.5 * columns, 2.9 * rows), layout="constrained")
    grid = figure.subplots(rows, columns, squeeze=False).ravel()
    at = range(1, len(runs) + 1)
    for axes, over in zip(grid, panels, strict=False):
        shown = [one for one in latest.values() if one.over == over]
        for n, one in enumerate(shown):
            colour, dash = COLOURS[n % len(COLOURS)], ("-", "--", ":")[n // len(COLOURS) % 3]
            medians = [run.median(one) for run in runs]
            values = [float("nan") if value is None else value for value in medians]
            axes.semilogy(at, values, dash, marker="o", markersize=3, color=colour, label=one.name)
            if one.asked is not None:
                axes.axhline(one.asked, color=colour, linewidth=0.8, linestyle=":")
        axes.yaxis.set_major_formatter("{x:g}")
        axes.yaxis.set_minor_formatter("{x:g}")
        axes.yaxis.set_minor_locator(LogLocator(subs=(2, 5)))
        axes.set_title(f"over {over}")
        axes.set_xticks(at, [run.short for run in runs], rotation=45 if len(runs) > 6 else 0)
        axes.set_xlim(0.5, len(runs) + 0.5)
        axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False, fontsize=7)
    for axes in grid[len(panels) :]:
        axes.remove()
    return figure
