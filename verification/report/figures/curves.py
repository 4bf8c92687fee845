"""Figures of one quantity on one line: every source overlaid, the differences below."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from math import ceil, floor, log10
from typing import Any

import numpy as np
from markupsafe import Markup
from matplotlib.axes import Axes
from numpy.typing import NDArray

from verification.report.figures.canvas import HEX, canvas, inline, look
from verification.sources.source import Style

__all__ = ["FLOOR", "Curve", "Difference", "draw"]

FLOOR = 1e-9
TOP = 1e-1
WIDTH, HEIGHT = 320, 300

# Fewer points than this were printed or measured, not computed along the line.
FEW = 25
# Beyond this a number is a failure, and a picture of it would only break.
HUGE = 1e12


@dataclass(frozen=True, eq=False)
class Curve:
    """``value`` over ``position``, both already divided by their scales."""

    position: NDArray[np.float64]
    value: NDArray[np.float64]
    style: Style


@dataclass(frozen=True, eq=False)
class Difference:
    """|A - B| over the scale with the uncertainty of both.

    worst : where a verdict failed, ringed on the difference, or on the uncertainty with ``vague``.
    """

    position: NDArray[np.float64]
    value: NDArray[np.float64]
    uncertainty: NDArray[np.float64] | None
    style: Style
    worst: float | None = None
    vague: bool = False


def draw(
    curves: Sequence[Curve],
    differences: Sequence[Difference],
    *,
    key: str,
    label: str,
    coordinate: str,
    cap: float | None = None,
    unjudged: Iterable[tuple[float, float]] = (),
) -> Markup:
    """One figure as inline SVG: curves above, differences below on a logarithmic scale.

    coordinate : what runs along the axis, e.g. "x / a_h".   unjudged : spans of it no verdict speaks of.
    cap : the largest admissible uncertainty, drawn as a line.   key : makes identifiers unique on a page.
    """
    with canvas(WIDTH, HEIGHT) as figure:
        upper = figure.add_axes((0.15, 0.485, 0.835, 0.495))
        lower = figure.add_axes((0.15, 0.135, 0.835, 0.31))
        span = _span(curves, differences)
        _draw_curves(upper, curves, span)
        _draw_differences(lower, differences, span, cap)
        for axes in (upper, lower):
            for left, right in unjudged:
                axes.axvspan(left, right, color=HEX["zone"], alpha=0.13, linewidth=0)
        lower.set_xlabel(coordinate, labelpad=1, color=HEX["ink"])
        return inline(figure, key=key, label=label)


def _span(curves: Sequence[Curve], differences: Sequence[Difference]) -> tuple[float, float]:
    positions = [curve.position for curve in curves] + [item.position for item in differences]
    ends = [(float(x.min()), float(x.max())) for x in positions if x.size and (np.abs(x) < HUGE).all()]
    low, high = min((e[0] for e in ends), default=0.0), max((e[1] for e in ends), default=1.0)
    return (low, high) if high > low else (low - 0.5, high + 0.5)


def _draw_curves(axes: Axes, curves: Sequence[Curve], span: tuple[float, float]) -> None:
    finite = [curve.value[np.abs(curve.value) < HUGE] for curve in curves]
    values = np.concatenate([*finite, np.zeros(1)]) if curves else np.zeros(1)
    low, high = float(values.min()), float(values.max())
    if high - low < 1e-12:
        low, high = low - 1.0, high + 1.0
    margin = 0.06 * (high - low)
    _frame(axes, span, (low - margin, high + margin))
    # Broad full lines first: a dashed one on top leaves both to be seen.
    for curve in sorted(curves, key=lambda curve: (bool(curve.style.dash), -curve.style.width)):
        _line(axes, curve.position, curve.value, curve.style, curve.style.opacity)
    axes.set_xticklabels([])
    axes.set_yticks(ticks := _round_ticks(low, high, 5), [_short(tick) for tick in ticks])


def _draw_differences(
    axes: Axes, differences: Sequence[Difference], span: tuple[float, float], cap: float | None
) -> None:
    largest = max((float(np.nanmax(d.value, initial=0.0)) for d in differences), default=0.0)
    top = log10(TOP) if not 0 < largest < HUGE else max(log10(TOP), float(ceil(log10(largest))))
    bottom = log10(FLOOR)
    _frame(axes, span, (bottom, top))
    step = 2 if top - bottom <= 8 else 4
    ticks = np.arange(bottom, top + 0.5, step)
    axes.set_yticks(ticks, [f"1e{tick:.0f}".replace("-", "−") for tick in ticks])
    for difference in differences:
        if difference.uncertainty is not None:
            height = _logarithm(difference.uncertainty)
            colour = HEX[difference.style.colour]
            band = axes.fill_between(difference.position, bottom, height, linewidth=0.8)
            # Between the methods the band is next to the wider of the others; a third tint would only mix.
            band.set_facecolor((colour, 0.0 if difference.style.colour == "pair" else 0.1))
            band.set_edgecolor((colour, 0.55))
    for difference in sorted(differences, key=lambda item: len(item.style.dash)):
        height = _logarithm(difference.value)
        _line(axes, difference.position, height, difference.style, 1.0)
        if difference.worst is not None and difference.position.size:
            at = int(np.argmin(np.abs(difference.position - difference.worst)))
            if difference.vague and difference.uncertainty is not None:
                height = _logarithm(difference.uncertainty)
            if np.isfinite(height[at]):
                axes.plot(
                    difference.position[at],
                    height[at],
                    marker="o",
                    markersize=8,
                    fillstyle="none",
                    color=HEX["cap"],
                    markeredgewidth=1.6,
                    clip_on=False,
                )
    if cap is not None and cap > 0:
        axes.axhline(log10(cap), color=HEX["cap"], linewidth=1.0, dashes=(6, 3))


def _frame(axes: Axes, span: tuple[float, float], height: tuple[float, float]) -> None:
    axes.set_xlim(*span)
    axes.set_ylim(*height)
    look(axes)
    axes.set_xticks(ticks := _round_ticks(*span, 6), [_short(tick) for tick in ticks])


def _line(
    axes: Axes, position: NDArray[np.float64], value: NDArray[np.float64], style: Style, opacity: float
) -> None:
    look: dict[str, Any] = {"color": HEX[style.colour], "alpha": opacity}
    if position.size < FEW:
        look |= {"marker": "o", "markersize": 3.5, "markeredgewidth": 0}
    if style.dash:
        look["dashes"] = style.dash
    axes.plot(position, np.where(np.abs(value) < HUGE, value, np.nan), linewidth=style.width, **look)


def _logarithm(value: NDArray[np.float64]) -> NDArray[np.float64]:
    """log10 of ``value``, never below the floor of the figure; NaN stays a gap."""
    return np.log10(np.where(np.isfinite(value), np.clip(value, FLOOR, HUGE), np.nan))


def _round_ticks(low: float, high: float, count: int) -> list[float]:
    """At most ``count`` + 1 ticks at 1, 2 or 5 times a power of ten."""
    raw = (high - low) / count
    power = 10.0 ** floor(log10(raw))
    step = next(s * power for s in (1, 2, 5, 10) if s * power >= raw * (1 - 1e-9))
    first, last = ceil(low / step - 1e-9), floor(high / step + 1e-9)
    return [number * step for number in range(first, last + 1)]


def _short(tick: float) -> str:
    return f"{tick:.6g}".replace("-", "−")
