"""Figures of one quantity on one line: every source overlaid, the differences below."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from math import ceil, log10

import numpy as np
from markupsafe import Markup

from verification.page.svg_plot import HUGE, Axes, drawing, power_of_ten, round_ticks
from verification.problem.array_types import Array
from verification.sources.source_record import Style

FLOOR = 1e-9
TOP = 1e-1
WIDTH, HEIGHT = 320, 238
UPPER = (42.0, 5.0, 273.0, 112.0)  # left, top, width, height
LOWER = (42.0, 125.0, 273.0, 84.0)
MARKED = 9  # points of a curve that are marked, each source at places of its own
APART = 0.004  # of the range; curves further apart than this are drawn as lines besides
CAP = Style("cap", (6.0, 3.0), 1.0)

# Fewer points than this are published or measured values, not computed along the line.
FEW = 25


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


def draw(
    curves: Sequence[Curve],
    differences: Sequence[Difference],
    *,
    label: str,
    coordinate: str,
    cap: float | None = None,
    unjudged: Iterable[tuple[float, float]] = (),
    data: str = "",
) -> Markup:
    """One figure as inline SVG: curves above, differences below on a logarithmic scale.

    The broadest curve is a line. Sources that coincide with it have marks, at places of their own, so that
    each can be seen; where one departs it is a line, too.

    coordinate : the label of the axis, e.g. "x / a_h".   unjudged : spans of it excluded from the verdicts.
    cap : the largest admissible uncertainty, drawn as a line.
    """
    span = _span(curves, differences)
    upper, lower = _draw_curves(curves, span), _draw_differences(differences, span, cap)
    for axes in (upper, lower):
        for left, right in unjudged:
            axes.zone(left, right)
    along = round_ticks(*span, 6)
    upper.ticks([(x, "") for x, _ in along])
    lower.ticks(along, label=coordinate)
    left, _, width, _ = UPPER
    if data:
        data += f' data-axis="{left:g} {width:g} {span[0]:.6g} {span[1]:.6g}"'
    return drawing(WIDTH, HEIGHT, label, upper, lower, data=data)


def _span(curves: Sequence[Curve], differences: Sequence[Difference]) -> tuple[float, float]:
    positions = [*(curve.position for curve in curves), *(item.position for item in differences)]
    ends = [(float(x.min()), float(x.max())) for x in positions if x.size and (np.abs(x) < HUGE).all()]
    low, high = min((e[0] for e in ends), default=0.0), max((e[1] for e in ends), default=1.0)
    return (low, high) if high > low else (low - 0.5, high + 0.5)


def _draw_curves(curves: Sequence[Curve], span: tuple[float, float]) -> Axes:
    finite = [curve.value[np.abs(curve.value) < HUGE] for curve in curves]
    values = np.concatenate([*finite, np.zeros(1)])
    low, high = float(values.min()), float(values.max())
    if high - low < 1e-12:
        low, high = low - 1.0, high + 1.0
    margin = 0.06 * (high - low)
    axes = Axes(UPPER, span, (low - margin, high + margin))
    axes.ticks(y=round_ticks(low, high, 5))
    # Broad full lines first: a dashed one on top leaves both visible.
    found = sorted(curves, key=lambda curve: (bool(curve.style.dash), -curve.style.width))
    base = max(found, key=lambda curve: curve.style.width, default=None)
    for n, curve in enumerate(found):
        few = curve.position.size < FEW
        if few or base is None or curve is base or _apart(curve, base, high - low):
            axes.line(curve.position, curve.value, curve.style, dots=few)
        if curve is not base and not few:
            share = (np.arange(MARKED) + (n + 0.5) / len(found)) / MARKED
            places = span[0] + share * (span[1] - span[0])
            at = np.unique(np.abs(curve.position[:, None] - places).argmin(axis=0))
            axes.marks(curve.position[at], curve.value[at], curve.style)
    return axes


def _apart(curve: Curve, base: Curve, extent: float) -> bool:
    """True where the two can be told apart, or cannot be compared."""
    if not np.array_equal(curve.position, base.position):
        return True
    return not (np.abs(curve.value - base.value) < APART * extent).all()


def _draw_differences(
    differences: Sequence[Difference], span: tuple[float, float], cap: float | None
) -> Axes:
    largest = max((float(np.nanmax(d.value, initial=0.0)) for d in differences), default=0.0)
    top = log10(TOP) if not 0 < largest < HUGE else max(log10(TOP), float(ceil(log10(largest))))
    bottom = log10(FLOOR)
    axes = Axes(LOWER, span, (bottom, top))
    step = 2 if top - bottom <= 8 else 4
    axes.ticks(y=[(tick, power_of_ten(tick)) for tick in np.arange(bottom, top + 0.5, step)])
    for difference in differences:
        if difference.uncertainty is not None:
            colour = difference.style.colour
            # Between the methods the band is next to the wider of the others; a third tint would only mix.
            tint = 0.0 if colour == "pair" else 0.1
            axes.band(difference.position, bottom, _logarithm(difference.uncertainty), colour, tint)
    for difference in sorted(differences, key=lambda item: len(item.style.dash)):
        height = _logarithm(difference.value)
        few = difference.position.size < FEW
        axes.line(difference.position, height, replace(difference.style, opacity=1.0), dots=few)
        if difference.worst is not None and difference.position.size:
            at = int(np.argmin(np.abs(difference.position - difference.worst)))
            if difference.vague and difference.uncertainty is not None:
                height = _logarithm(difference.uncertainty)
            axes.ring(difference.position[at], height[at])
    if cap is not None and cap > 0:
        axes.line(np.array(span), np.full(2, log10(cap)), CAP)
    return axes


def _logarithm(value: Array) -> Array:
    """log10 of ``value``, never below the floor of the figure; NaN stays a gap."""
    return np.log10(np.where(np.isfinite(value), np.clip(value, FLOOR, HUGE), np.nan))
