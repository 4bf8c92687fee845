"""Plots of a page: curves over a line with their differences, errors over a resolution, a histogram."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from math import ceil, floor, log10
from typing import TYPE_CHECKING

import numpy as np
from markupsafe import Markup

from verification.page.figures import HUGE, ROLES, Sheet, line, marks, power_of_ten, ring, round_ticks
from verification.page.page_parts import Panel
from verification.problem.array_types import Array
from verification.sources.source_record import Style

if TYPE_CHECKING:
    from matplotlib.axes import Axes

FLOOR = 1e-9  # of a difference that is drawn
TOP = 1e-1
UPPER = (42.0, 5.0, 273.0, 112.0)  # left, top, width, height
LOWER = (42.0, 125.0, 273.0, 84.0)
MARKED = 9  # points of a curve that are marked, each source at places of its own
DISTINCT = 0.004  # of the range; curves further apart than this are drawn as lines besides
# Fewer points than this are published or measured values, not computed along the line.
FEW = 25
BOX = (48.0, 5.9, 232.0, 190.4)  # of errors over a resolution: left, top, width, height
# Errors beyond are failures or coincidences; the scale does not extend to them.
SMALLEST, LARGEST = 1e-16, 1e4
APART = 0.075  # of the height of the axes: the least distance between two written slopes
# Dashes of curves side by side, and the style of a setting without one of its own.
DOTS, DASHES, MIXED = (1.0, 1.4), (3.6, 3.0), (4.5, 1.4, 1.0, 1.4)
UNKNOWN = Style("ink", (5.0, 1.5, 1.0, 1.5))
CAP = Style("cap", (6.0, 3.0), 1.0)


@dataclass(frozen=True, eq=False)
class Curve:
    """``value`` over ``position``, both already divided by their scales."""

    position: Array
    value: Array
    style: Style


@dataclass(frozen=True, eq=False)
class Difference:
    """|A - B| over the scale with the uncertainty of both.

    worst : where a verdict failed, ringed on the difference, or on the uncertainty with ``vague``.
    """

    position: Array
    value: Array
    uncertainty: Array | None
    style: Style
    worst: float | None = None
    vague: bool = False


def draw_curves(
    curves: Sequence[Curve],
    differences: Sequence[Difference],
    *,
    label: str,
    coordinate: str,
    cap: float | None = None,
    unjudged: Iterable[tuple[float, float]] = (),
    data: str = "",
) -> Markup:
    """Curves of every source above, their differences on a logarithmic scale below, as inline SVG.

    The broadest curve is a line. Sources that coincide with it have marks, at places of their own, so that
    each can be seen; where one departs it is a line, too.

    coordinate : the label of the axis, e.g. "x / a_h".   unjudged : spans of it excluded from the verdicts.
    cap : the largest admissible uncertainty, drawn as a line.
    """
    positions = [*(curve.position for curve in curves), *(item.position for item in differences)]
    span = _ends([x for x in positions if x.size and (np.abs(x) < HUGE).all()], 0.5)
    low, high = _ends([*(curve.value for curve in curves), np.zeros(1)], 1.0)
    margin = 0.06 * (high - low)
    along = round_ticks(*span, 6)
    figure = Sheet(320, 238)
    upper = figure.chart(UPPER, span, (low - margin, high + margin))
    upper.ticks([(x, "") for x, _ in along], round_ticks(low, high, 5))
    _add_curves(upper.axes, curves, span, DISTINCT * (high - low))
    bottom, top = _exponents(differences)
    lower = figure.chart(LOWER, span, (bottom, top))
    step = 2 if top - bottom <= 8 else 4
    decades = [(at, power_of_ten(at)) for at in np.arange(bottom, top + 0.5, step)]
    lower.ticks(along, decades, coordinate)
    _add_differences(lower.axes, differences, bottom)
    if cap is not None and cap > 0:
        line(lower.axes, np.array(span), np.full(2, log10(cap)), CAP)
    for axes in (upper.axes, lower.axes):
        for left, right in unjudged:
            axes.axvspan(left, right, facecolor=ROLES["zone"], alpha=0.13, linewidth=0)
    if data:
        data += f' data-axis="{UPPER[0]:g} {UPPER[2]:g} {span[0]:.6g} {span[1]:.6g}"'
    return figure.drawing(label, data=data)


def _ends(arrays: Sequence[Array], wide: float) -> tuple[float, float]:
    """The least and the largest value that can be drawn, ``wide`` on either side where they are one."""
    values = np.concatenate([*arrays, np.zeros(0)])
    values = values[np.abs(values) < HUGE]
    low, high = (float(values.min()), float(values.max())) if values.size else (0.5 - wide, 0.5 + wide)
    return (low, high) if high - low > 1e-12 else (low - wide, high + wide)


def _add_curves(axes: Axes, curves: Sequence[Curve], span: tuple[float, float], distinct: float) -> None:
    # Broad full lines first: a dashed one on top leaves both visible.
    found = sorted(curves, key=lambda curve: (bool(curve.style.dash), -curve.style.width))
    base = max(found, key=lambda curve: curve.style.width, default=None)
    for n, curve in enumerate(found):
        few = curve.position.size < FEW
        if few or base is None or curve is base or _apart(curve, base, distinct):
            line(axes, curve.position, curve.value, curve.style, dots=few)
        if curve is not base and not few:
            share = (np.arange(MARKED) + (n + 0.5) / len(found)) / MARKED
            places = span[0] + share * (span[1] - span[0])
            at = np.unique(np.abs(curve.position[:, None] - places).argmin(axis=0))
            marks(axes, curve.position[at], curve.value[at], curve.style)


def _apart(curve: Curve, base: Curve, distinct: float) -> bool:
    """True where the two can be told apart, or cannot be compared."""
    if not np.array_equal(curve.position, base.position):
        return True
    return not (np.abs(curve.value - base.value) < distinct).all()


def _exponents(differences: Sequence[Difference]) -> tuple[float, float]:
    """Exponents of ten at the bottom and at the top of the differences."""
    largest = max((float(np.nanmax(d.value, initial=0.0)) for d in differences), default=0.0)
    top = max(log10(TOP), float(ceil(log10(largest)))) if 0 < largest < HUGE else log10(TOP)
    return log10(FLOOR), top


def _add_differences(axes: Axes, differences: Sequence[Difference], bottom: float) -> None:
    for one in differences:
        if one.uncertainty is not None:
            height, colour = _logarithm(one.uncertainty), ROLES[one.style.colour]
            # Between the methods the band is next to the wider of the others; a third tint would only mix.
            if one.style.colour != "pair":
                axes.fill_between(one.position, bottom, height, facecolor=colour, alpha=0.1, linewidth=0)
            line(axes, one.position, height, Style(one.style.colour, width=0.8, opacity=0.55))
    for one in sorted(differences, key=lambda item: len(item.style.dash)):
        height = _logarithm(one.value)
        line(axes, one.position, height, replace(one.style, opacity=1.0), dots=one.position.size < FEW)
        if one.worst is not None and one.position.size:
            at = int(np.argmin(np.abs(one.position - one.worst)))
            if one.vague and one.uncertainty is not None:
                height = _logarithm(one.uncertainty)
            ring(axes, float(one.position[at]), float(height[at]))


def _logarithm(value: Array) -> Array:
    """log10 of ``value``, never below the floor of the figure; NaN stays a gap."""
    return np.log10(np.where(np.isfinite(value), np.clip(value, FLOOR, HUGE), np.nan))


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
    """A panel of trails; ``label`` describes it to a screen reader, ``note`` is its axis in words.

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
    scale = height[1] - height[0]
    figure = Sheet(320, 235)
    chart = figure.chart(BOX, span, height)
    chart.ticks(
        _clear([(log10(at), f"{at:g}") for at in plot.ticks if span[0] <= log10(at) <= span[1]], span),
        [(at, power_of_ten(at)) for at in np.arange(*height, max(1, ceil(scale / 6)))],
        plot.coordinate,
    )
    ends = []
    # Full lines first: a dashed one on top leaves both visible.
    for trail in sorted(plot.trails, key=lambda trail: bool(trail.style.dash)):
        if trail.drawn:
            points = np.log10(trail.drawn)
            line(chart.axes, points[:, 0], points[:, 1], trail.style, dots=True)
            if trail.note:
                ends.append((points[-1, 1], trail.note, trail.style.colour))
    ends.sort()
    places = _separated([(end[0] - height[0]) / scale for end in ends])
    for at, (_, text, colour) in zip(places, ends, strict=True):
        chart.note(span[1], height[0] + at * scale, text, colour=colour, by=(4, 4))
    return figure.drawing(plot.label)


def _clear(found: Sequence[tuple[float, str]], span: tuple[float, float]) -> list[tuple[float, str]]:
    """Ticks whose texts would print over the one before lose theirs."""
    kept: list[tuple[float, str]] = []
    free = span[0] - 1.0
    for at, text in found:
        half = 3.4 * len(text) * (span[1] - span[0]) / BOX[2]  # a digit has 6.2 units, half a one between
        kept.append((at, text if at - half >= free else ""))
        free = at + half if kept[-1][1] else free
    return kept


def draw_histogram(edges: Sequence[float], counts: Sequence[int], label: str) -> Markup:
    """Shares of ``counts`` between ``edges``, exponents of ten; a line at 1."""
    share = np.array(counts) / max(sum(counts), 1)
    top = 1.1 * float(share.max(initial=0.01))
    figure = Sheet(320, 235)
    chart = figure.chart(BOX, (edges[0], edges[-1]), (0.0, top))
    exponents = [float(e) for e in range(ceil(edges[0]), floor(edges[-1]) + 1)]
    heights = [(0.0, "0"), (top / 1.1, f"{top / 1.1:.2g}")]
    chart.ticks([(e, power_of_ten(e)) for e in exponents], heights, "error/U")
    chart.axes.stairs(share, edges, fill=True, facecolor=ROLES["semi"], alpha=0.4)
    line(chart.axes, np.zeros(2), np.array([0.0, top]), Style("cap", DASHES))
    return figure.drawing(label)


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
