"""Figures drawn by matplotlib as inline SVG, in the colours of the page: light, dark, print.

Lengths are in units of the drawing, of which matplotlib has 72 to its inch.
"""

from __future__ import annotations

import io
import re
from collections.abc import Sequence
from functools import lru_cache
from importlib.util import find_spec
from math import ceil, floor, isfinite, log10
from pathlib import Path
from typing import TYPE_CHECKING, Any
from zlib import crc32

import numpy as np
from markupsafe import Markup, escape

from verification.page.symbol_text import drawn, unicode
from verification.problem.array_types import Array
from verification.running.checked_files import write_atomically
from verification.sources.source_record import Style

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

# Each role of the style sheet with the colour that stands for it until the figure is written.
ROLES = {
    role: f"#{0xC0FFE0 + number:06x}"
    for number, role in enumerate(
        ("ink", "muted", "paper", "grid", "semi", "fem", "exact", "hertz", "pair", "other", "cap", "zone")
    )
}
# In figures for print: what follows the page, where one of them is shown on it.
PRINT = {"ink": "#000000", "paper": "#ffffff", "grid": "#cccccc", "muted": "#444444", "agrees": "#d5efe1"}
HUGE = 1e12  # larger numbers are failures; a curve has a gap there
_SETTINGS: Any = {"svg.fonttype": "none", "svg.hashsalt": "coatcheck", "path.simplify_threshold": 0.15}
_NUMBER = re.compile(r"(\d\.\d)\d+")
_PATH = re.compile(r' d="([^"]*)"')
_BARE = re.compile(r"<g>\s*((?:<(?:path|text|use)\b[^>]*(?:/>|>[^<]*</text>)\s*)*)</g>")
Box = tuple[float, float, float, float]  # left, top, width, height


def save(figure: Figure, path: Path) -> None:
    """Write a figure for print as PNG, PDF or SVG, by the suffix of ``path``. Raises StoreError."""
    content = io.BytesIO()
    figure.savefig(content, format=path.suffix.lower()[1:], dpi=200, facecolor="white")
    write_atomically(path, content.getvalue())


def can_draw() -> bool:
    """Whether matplotlib, of the extra ``report``, is installed; without it a page has its tables alone."""
    return find_spec("matplotlib") is not None


@lru_cache(maxsize=16)
def _empty(width: float, height: float) -> tuple[Figure, dict[Box, Axes]]:
    """A figure with its axes by their boxes, used again: to make axes takes most of the time."""
    from matplotlib.figure import Figure

    return Figure(figsize=(width / 72, height / 72), frameon=False), {}


class Chart:
    """A pair of axes in a frame: ``axes`` takes what matplotlib draws, texts and grid are SVG of the page.

    x, y : values at the ends of the axes.
    """

    def __init__(self, axes: Axes, box: Box, x: tuple[float, float], y: tuple[float, float]) -> None:
        self.axes, self.box, self.x, self.y = axes, box, x, y
        axes.set(visible=True, xlim=x, ylim=y)
        left, top, width, height = (f"{n:.1f}" for n in box)
        self.grid = [f"M{left} {top}h{width}v{height}h-{width}z"]
        self.texts: list[str] = []

    def place(self, x: float, y: float) -> tuple[float, float]:
        """A point in units of the drawing."""
        left, top, width, height = self.box
        u, v = (x - self.x[0]) / (self.x[1] - self.x[0]), (self.y[1] - y) / (self.y[1] - self.y[0])
        return left + width * u, top + height * v

    def ticks(
        self, x: Sequence[tuple[float, str]] = (), y: Sequence[tuple[float, str]] = (), label: str = ""
    ) -> None:
        """Grid lines with their texts at values of both axes, and the ``label`` below."""
        left, top, width, height = self.box
        bottom = top + height
        for value, text in x:
            u, _ = self.place(value, 0.0)
            self.grid.append(f"M{u:.1f} {top:.1f}v{height:.1f}")
            self.write(u, bottom + 11, text, "middle")
        for value, text in y:
            _, v = self.place(0.0, value)
            self.grid.append(f"M{left:.1f} {v:.1f}h{width:.1f}")
            self.write(left - 3, min(v + 4, bottom), text, "end")  # at the corner both labels meet
        self.write(left + width / 2, bottom + 23, label, "middle")

    def note(
        self, x: float, y: float, text: str, *, by: tuple[float, float] = (3, -3), colour: str = "ink"
    ) -> None:
        """``text`` beside a point, ``by`` units to the right and down."""
        u, v = self.place(x, y)
        self.write(u + by[0], v + by[1], text, "start", colour)

    def write(self, u: float, v: float, text: str, anchor: str, colour: str = "ink") -> None:
        """``text`` at a place in units of the drawing."""
        if text and isfinite(u + v):
            aligned = f' text-anchor="{anchor}"' if anchor != "start" else ""
            self.texts.append(
                f'<text x="{u:.1f}" y="{v:.1f}" class="f-{colour}"{aligned}>{drawn(text)}</text>'
            )


class Sheet:
    """An empty figure of ``width`` by ``height`` units."""

    def __init__(self, width: float, height: float) -> None:
        self._figure, self._known = _empty(width, height)
        self._charts: list[Chart] = []
        for axes in self._known.values():
            axes.set_visible(False)
            for artist in (*axes.lines, *axes.collections, *axes.patches):
                artist.remove()

    def chart(self, box: Box, x: tuple[float, float], y: tuple[float, float]) -> Chart:
        """Axes in ``box``; ``x``, ``y`` are the values at their ends."""
        if box not in self._known:
            left, top, width, height = box
            whole_width, whole_height = 72 * self._figure.get_size_inches()
            share = left / whole_width, 1 - (top + height) / whole_height
            self._known[box] = self._figure.add_axes((*share, width / whole_width, height / whole_height))
            self._known[box].axis("off")
        self._charts.append(Chart(self._known[box], box, x, y))
        return self._charts[-1]

    def drawing(self, label: str, *, css: str = "figure", data: str = "", under: str = "") -> Markup:
        """The figure as inline SVG, see ``inline``."""
        grid = "".join(line for chart in self._charts for line in chart.grid)
        below = f'<path d="{grid}" class="s-grid" stroke-width=".6"/>{under}'
        texts = "".join(text for chart in self._charts for text in chart.texts)
        return inline(written(self._figure), label, css=css, data=data, under=below, over=texts)


def line(axes: Axes, x: Array, y: Array, style: Style, *, dots: bool = False) -> None:
    """A curve with gaps where it is not finite or ``HUGE``, with a dot at each point where asked for."""
    known = (np.abs(x) < HUGE) & (np.abs(y) < HUGE)
    dash = (0, style.dash) if style.dash else "-"
    colour = ROLES[style.colour]
    x, y = np.where(known, x, np.nan), np.where(known, y, np.nan)
    axes.plot(x, y, color=colour, linestyle=dash, linewidth=style.width, alpha=style.opacity)
    if dots:
        axes.plot(x, y, "o", color=colour, markersize=3.2, markeredgewidth=0)


def marks(axes: Axes, x: Array, y: Array, style: Style) -> None:
    """Single points of a curve, each with the open mark of its style."""
    more: Any = {"markerfacecolor": ROLES["paper"], "markeredgewidth": 1.2, "markersize": 5.2}
    known = np.abs(y) < HUGE
    axes.plot(x[known], y[known], style.marker, color=ROLES[style.colour], **more)


def ring(axes: Axes, x: float, y: float) -> None:
    """A red ring around one point, whole at the frame too."""
    more: Any = {"markerfacecolor": "none", "markeredgewidth": 1.6, "markersize": 8, "clip_on": False}
    if np.isfinite([x, y]).all():
        axes.plot([x], [y], "o", color=ROLES["cap"], **more)


def written(figure: Figure) -> str:
    """The SVG of a ``figure``; the same figure always gives the same text."""
    import matplotlib as mpl
    from matplotlib.backends.backend_svg import FigureCanvasSVG

    out = io.StringIO()
    with mpl.rc_context(_SETTINGS):
        FigureCanvasSVG(figure).print_svg(out, metadata={"Date": None})
    return out.getvalue()


def inline(
    svg: str, label: str, *, css: str = "figure", data: str = "", under: str = "", over: str = ""
) -> Markup:
    """The SVG of matplotlib for a page: compact, its colours those of the page, its symbols typeset.

    label : what it shows, for a screen reader.   data : further attributes, escaped.
    under, over : further SVG.
    """
    box = re.search(r'viewBox="([^"]*)"', svg)
    assert box is not None
    body = re.sub(r"<metadata>.*?</metadata>|<defs>\s*<style.*?</defs>", "", svg, count=2, flags=re.DOTALL)
    body = re.sub(r"<!--.*?-->", "", body[body.index(">", body.index("<svg")) + 1 :], flags=re.DOTALL)
    body = re.sub(r'<g id="[^"]*">', "<g>", body)
    body = re.sub(r' transform="rotate\(-?0 [^"]*"', "", body)
    body = _PATH.sub(lambda found: f' d="{_shortened(found[1])}"', body)
    for role, colour in (*ROLES.items(), *PRINT.items()):
        body = body.replace(colour, f"var(--{role})")
    for _ in range(4):  # groups within groups
        body = _BARE.sub(r"\1", body)
    # names of clipped areas and of marks: figures of a page must not take each other's, so labels differ
    own = f"{crc32((label + body).encode()):08x}"
    body = re.sub(r'(id="|url\(#|href="#)([pmDC][0-9A-Za-z_-]+)', rf"\1f{own}\2", body)
    body = re.sub(r">\s+<", "><", body[: body.rindex("</svg>")])
    more = f" {data}" if data else ""
    return Markup(
        f'<svg class="{css}" viewBox="{box[1]}" role="img" aria-label="{escape(unicode(label))}"{more}>'
        f"{under}{body}{over}</svg>"
    )


def _shortened(path: str) -> str:
    """The data of a path in tenths of a unit."""
    return _NUMBER.sub(r"\1", path).replace(" \n", "").replace("L ", "L").replace("M ", "M")


def round_ticks(low: float, high: float, count: int) -> list[tuple[float, str]]:
    """At most ``count`` + 1 ticks at 1, 2 or 5 times a power of ten, with their labels."""
    raw = (high - low) / count
    power = 10.0 ** floor(log10(raw))
    step = next(s * power for s in (1, 2, 5, 10) if s * power >= raw * (1 - 1e-9))
    first, last = ceil(low / step - 1e-9), floor(high / step + 1e-9)
    return [(n * step, f"{n * step:.6g}".replace("-", "−")) for n in range(first, last + 1)]


def power_of_ten(exponent: float) -> str:
    """A tick label such as 1e−4."""
    return f"1e{exponent:.0f}".replace("-", "−")
