"""What every figure of the report shares: stand-in colours, letters, frames, the way into the page."""

import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from io import StringIO
from typing import Any

import matplotlib as mpl
from markupsafe import Markup
from matplotlib.axes import Axes
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure

from verification.report.figures.svg import compact

__all__ = ["HEX", "canvas", "inline", "look"]

# matplotlib draws with these stand-ins; the style sheet gives each role its colour, light and dark.
_ROLES = ("ink", "grid", "semi", "fem", "exact", "hertz", "pair", "other", "cap", "zone")
HEX = {role: f"#0102{number:02x}" for number, role in enumerate(_ROLES, start=16)}
_SETTINGS: Any = {
    "svg.fonttype": "none",
    "svg.hashsalt": "coatcheck",
    "path.simplify": True,
    "path.simplify_threshold": 0.25,
    "axes.linewidth": 0.7,
    "xtick.major.size": 0,
    "ytick.major.size": 0,
    "font.size": 11,
    "axes.unicode_minus": True,
}


@contextmanager
def canvas(width: float, height: float) -> Iterator[Figure]:
    """An empty figure of that size in points, to be drawn on in the report's settings."""
    with mpl.rc_context(_SETTINGS), warnings.catch_warnings():
        # A figure of nothing but NaN has no limits; it stays empty and the verdict says why.
        warnings.simplefilter("ignore")
        figure = Figure(figsize=(width / 72, height / 72), dpi=72)
        FigureCanvasSVG(figure)
        yield figure


def inline(figure: Figure, *, key: str, label: str) -> Markup:
    """``figure`` as inline SVG in the colours of the page; ``key`` makes identifiers unique there."""
    written = StringIO()
    figure.savefig(written, format="svg", metadata={"Date": None}, transparent=True)
    return compact(
        written.getvalue(), key=key, colours={value: role for role, value in HEX.items()}, label=label
    )


def look(axes: Axes) -> None:
    """Grid, ticks and spines as every figure has them."""
    axes.set_facecolor("none")
    axes.grid(True, color=HEX["grid"], linewidth=0.6)
    axes.tick_params(colors=HEX["ink"], labelsize=10.5, pad=3)
    for spine in axes.spines.values():
        spine.set_color(HEX["grid"])
