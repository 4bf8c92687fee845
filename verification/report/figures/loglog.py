"""Figures of an error over a resolution, both logarithmic, with the slope written beside each curve."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import ceil, floor, log10
from typing import Any

import numpy as np
from markupsafe import Markup

from verification.report.figures.canvas import HEX, canvas, inline, look
from verification.sources.source import Style

__all__ = ["Trail", "decades", "draw_loglog"]

WIDTH, HEIGHT = 320, 235
# Anything beyond is a failure or a luck that no picture should stretch for.
SMALLEST, LARGEST = 1e-16, 1e4
# Of the height of the axes: what keeps one written slope clear of the next.
APART = 0.075


@dataclass(frozen=True)
class Trail:
    """One curve: ``error`` over ``resolution``, the ``note`` written at its right end."""

    resolution: tuple[float, ...]
    error: tuple[float, ...]
    style: Style
    note: str = ""

    @property
    def drawn(self) -> list[tuple[float, float]]:
        """The points that have a place on logarithmic axes."""
        pairs = zip(self.resolution, self.error, strict=True)
        return [(x, min(max(e, SMALLEST), LARGEST)) for x, e in pairs if 1e-9 < x < 1e9 and np.isfinite(e)]


def decades(trails: Sequence[Trail]) -> tuple[float, float]:
    """Whole powers of ten that hold every error, so that panels side by side share one scale."""
    errors = [log10(e) for trail in trails for _, e in trail.drawn]
    # A tenth of a decade keeps a point off the frame.
    low, high = floor(min(errors, default=-9.0) - 0.1), ceil(max(errors, default=-1.0) + 0.1)
    return float(low), float(max(high, low + 1))


def draw_loglog(
    trails: Sequence[Trail],
    *,
    key: str,
    label: str,
    coordinate: str,
    height: tuple[float, float],
    ticks: Sequence[float],
) -> Markup:
    """One figure as inline SVG.

    height : exponents of ten at the bottom and at the top.   ticks : resolutions written below.
    coordinate : what runs along the axis.   key : makes identifiers unique on a page.
    """
    with canvas(WIDTH, HEIGHT) as figure:
        axes = figure.add_axes((0.15, 0.165, 0.725, 0.81))
        places = [x for trail in trails for x, _ in trail.drawn] or [1.0, 10.0]
        margin = 0.04 * max(log10(max(places) / min(places)), 0.5)
        axes.set_xlim(log10(min(places)) - margin, log10(max(places)) + margin)
        axes.set_ylim(*height)
        look(axes)
        shown = [tick for tick in ticks if axes.get_xlim()[0] <= log10(tick) <= axes.get_xlim()[1]]
        axes.set_xticks([log10(tick) for tick in shown], [f"{tick:g}" for tick in shown])
        step = max(1, ceil((height[1] - height[0]) / 6))
        exponents = np.arange(height[0], height[1] + 0.5, step)
        axes.set_yticks(exponents, [f"1e{exponent:.0f}".replace("-", "−") for exponent in exponents])
        ends = []
        # Full lines first: a dashed one on top leaves both to be seen.
        for trail in sorted(trails, key=lambda trail: bool(trail.style.dash)):
            points = trail.drawn
            if not points:
                continue
            dashes: dict[str, Any] = {"dashes": trail.style.dash} if trail.style.dash else {}
            axes.plot(
                [log10(x) for x, _ in points],
                [log10(e) for _, e in points],
                color=HEX[trail.style.colour],
                linewidth=trail.style.width,
                marker="o",
                markersize=3.5,
                markeredgewidth=0,
                **dashes,
            )
            if trail.note:
                last = (log10(points[-1][1]) - height[0]) / (height[1] - height[0])
                ends.append((last, trail.note, trail.style.colour))
        for at, (_, note, colour) in zip(
            _spread([end[0] for end in sorted(ends)]), sorted(ends), strict=True
        ):
            axes.text(1.015, at, note, transform=axes.transAxes, va="center", color=HEX[colour])
        axes.set_xlabel(coordinate, labelpad=1, color=HEX["ink"])
        return inline(figure, key=key, label=label)


def _spread(places: Sequence[float]) -> list[float]:
    """Increasing ``places`` moved apart as little as it takes, all of them between 0 and 1."""
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
