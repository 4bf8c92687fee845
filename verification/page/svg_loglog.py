"""Figures of an error over a resolution, both logarithmic, with the slope written beside each curve."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import ceil, floor, log10

import numpy as np
from markupsafe import Markup

from verification.page.page_parts import Panel
from verification.page.svg_plot import Axes, drawing, power_of_ten
from verification.sources.source_record import Style

WIDTH, HEIGHT = 320, 235
BOX = (48.0, 5.9, 232.0, 190.4)  # left, top, width, height
# Errors beyond are failures or coincidences; the scale does not extend to them.
SMALLEST, LARGEST = 1e-16, 1e4
# Of the height of the axes: the least distance between two written slopes.
APART = 0.075
# Dashes of curves side by side, and the style of a setting without one of its own.
DOTS, DASHES, MIXED = (1.0, 1.4), (3.6, 3.0), (4.5, 1.4, 1.0, 1.4)
UNKNOWN = Style("ink", (5.0, 1.5, 1.0, 1.5))


@dataclass(frozen=True)
class Trail:
    """One curve: ``error`` over ``resolution``, the ``note`` written at its right end."""

    resolution: tuple[float, ...]
    error: tuple[float, ...]
    style: Style
    note: str = ""

    @property
    def drawn(self) -> list[tuple[float, float]]:
        """The points within logarithmic axes."""
        pairs = zip(self.resolution, self.error, strict=True)
        return [(x, min(max(e, SMALLEST), LARGEST)) for x, e in pairs if 1e-9 < x < 1e9 and np.isfinite(e)]


@dataclass(frozen=True)
class Plot:
    """A panel of curves; ``label`` describes it to a screen reader, ``note`` is its axis in words.

    coordinate : the label of the horizontal axis.   ticks : resolutions written below.
    """

    title: str
    label: str
    note: str
    coordinate: str
    ticks: Sequence[float]
    trails: Sequence[Trail]


def panels(plots: Sequence[Plot]) -> list[Panel]:
    """The ``plots`` side by side on one scale of errors."""
    errors = [log10(e) for plot in plots for trail in plot.trails for _, e in trail.drawn]
    # A tenth of a decade keeps a point off the frame.
    low, high = floor(min(errors, default=-9.0) - 0.1), ceil(max(errors, default=-1.0) + 0.1)
    height = float(low), float(max(high, low + 1))
    return [Panel(plot.title, _drawn(plot, height), plot.note) for plot in plots]


def _drawn(plot: Plot, height: tuple[float, float]) -> Markup:
    """One figure; ``height`` holds the exponents of ten at the bottom and at the top."""
    places = [x for trail in plot.trails for x, _ in trail.drawn] or [1.0, 10.0]
    margin = 0.04 * max(log10(max(places) / min(places)), 0.5)
    span = log10(min(places)) - margin, log10(max(places)) + margin
    axes = Axes(BOX, span, height)
    step = max(1, ceil((height[1] - height[0]) / 6))
    axes.ticks(
        [(log10(tick), f"{tick:g}") for tick in plot.ticks if span[0] <= log10(tick) <= span[1]],
        [(exponent, power_of_ten(exponent)) for exponent in np.arange(height[0], height[1] + 0.5, step)],
        plot.coordinate,
    )
    ends = []
    # Full lines first: a dashed one on top leaves both visible.
    for trail in sorted(plot.trails, key=lambda trail: bool(trail.style.dash)):
        if trail.drawn:
            points = np.log10(trail.drawn)
            axes.line(points[:, 0], points[:, 1], trail.style, dots=True)
            if trail.note:
                ends.append((points[-1, 1], trail.note, trail.style.colour))
    ends.sort()
    scale = height[1] - height[0]
    for at, (_, note, colour) in zip(
        _separated([(end[0] - height[0]) / scale for end in ends]), ends, strict=True
    ):
        axes.text(span[1], height[0] + at * scale, note, colour=colour, by=(4, 4))
    return drawing(WIDTH, HEIGHT, plot.label, axes)


def draw_histogram(edges: Sequence[float], counts: Sequence[int], label: str) -> Markup:
    """Shares of ``counts`` between ``edges``, exponents of ten; a line at 1."""
    share = np.array(counts) / max(sum(counts), 1)
    top = 1.1 * float(share.max(initial=0.01))
    axes = Axes(BOX, (edges[0], edges[-1]), (0.0, top))
    exponents = [float(e) for e in range(ceil(edges[0]), floor(edges[-1]) + 1)]
    axes.ticks(
        [(e, power_of_ten(e)) for e in exponents], [(0.0, "0"), (top / 1.1, f"{top / 1.1:.2g}")], "error/U"
    )
    axes.band(np.repeat(edges, 2)[1:-1], 0.0, np.repeat(share, 2), "semi", 0.4)
    axes.line(np.zeros(2), np.array([0.0, top]), Style("cap", DASHES))
    return drawing(WIDTH, HEIGHT, label, axes)


def _separated(places: Sequence[float]) -> list[float]:
    """Increasing ``places`` moved apart as little as needed, all of them between 0 and 1."""
    found = list(places)
    for _ in range(50):
        for i in range(1, len(found)):
            lack = APART - (found[i] - found[i - 1])
            if lack > 0:
                found[i - 1] -= lack / 2
                found[i] += lack / 2
        found = [
            min(max(place, i * APART), 1 - (len(found) - 1 - i) * APART) for i, place in enumerate(found)
        ]
    return found
