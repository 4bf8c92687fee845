"""Stresses in the plane below the contact as small pictures, with the difference of both methods.

The raster is a compressed image of a few kilobytes; axes, interfaces, contact and level lines are drawn over
it as vectors in the colours of the page, so that they follow light, dark and print.
"""

import base64
import io
import itertools
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import matplotlib as mpl
import numpy as np
from markupsafe import Markup
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from PIL import Image
from scipy.interpolate import PchipInterpolator

from verification.page.figures import ROLES, Box, Sheet, power_of_ten, round_ticks
from verification.page.number_text import plain, scientific
from verification.page.page_parts import Panel
from verification.page.source_labels import source_label
from verification.problem.array_types import Array
from verification.problem.quantity import IN_PLANE, von_mises
from verification.report.report_words import stated
from verification.sampling.stress_plane import StressPlane
from verification.sources.source_registry import METHODS

LEFT, TOP, RIGHT, BOTTOM = 46.0, 12.0, 56.0, 32.0  # margins around the raster, in units of the drawing
WIDTH = 250.0  # of the raster
PIXELS = 200  # along x
COLOURS = 96
THINNEST = 0.14  # of the height of a picture: what a layer has at least, to be seen
LEVEL: Any = {"colors": "#ffffff", "alpha": 0.6, "linewidths": 0.7, "linestyles": "-"}


@dataclass(frozen=True)
class Scale:
    """Colours for values from ``low`` to ``high``; ``name`` is a map of matplotlib safe for the colour-blind.

    logarithmic : low and high are exponents of ten, so are the values.
    """

    low: float
    high: float
    name: str
    logarithmic: bool = False

    @property
    def ticks(self) -> list[tuple[float, str]]:
        """Values with their labels."""
        if self.logarithmic:
            return [(float(n), power_of_ten(n)) for n in range(round(self.low), round(self.high) + 1)]
        return round_ticks(self.low, self.high, 6)


@dataclass(frozen=True, eq=False)
class Frame:
    """The part of the plane that is drawn, lengths over a_h.

    half : it reaches from -half to half.  depth : from 0 to here.  interfaces : depths.  contact : radius.
    A layer thinner than ``THINNEST`` of the depth is drawn that thick, the others that much thinner.
    """

    half: float
    depth: float
    interfaces: tuple[float, ...]
    contact: float

    @property
    def edges(self) -> list[float]:
        """Depths of the surface, of each interface above the lower end, of the lower end."""
        return [0.0, *(z for z in self.interfaces if z < self.depth), self.depth]

    @property
    def shares(self) -> list[float]:
        """Places of the edges in the drawing, as a share of the height."""
        parts = np.diff(self.edges) / self.depth
        thin = parts < THINNEST
        rest = 1 - THINNEST * thin.sum()
        if not thin.any() or rest < THINNEST:
            return [edge / self.depth for edge in self.edges]
        parts = np.where(thin, THINNEST, parts * rest / max(parts[~thin].sum(), 1e-30))
        return [0.0, *np.cumsum(parts)[:-1].tolist(), 1.0]

    @property
    def stretched(self) -> bool:
        """Whether a layer is drawn thicker than it is."""
        return bool(np.abs(np.array(self.shares) - np.array(self.edges) / self.depth).max() > 1e-9)

    def place(self, z: float) -> float:
        """Place of the depth ``z`` in the drawing, as a share of the height."""
        return float(np.interp(z, self.edges, self.shares))

    @property
    def rows(self) -> int:
        """Pixels along z, as wide as those along x."""
        return max(8, round(PIXELS * self.depth / (2 * self.half)))

    @property
    def height(self) -> float:
        """Height of the raster, in units of the drawing."""
        return WIDTH * self.depth / (2 * self.half)


def rasterised(x: Array, depths: Sequence[Array], values: Sequence[Array], frame: Frame) -> Array:
    """Values at the centres of the pixels, (rows, PIXELS), from those at ``x`` and the depths of each layer.

    Linear along x, along z monotone cubics; never across an interface.
    """
    columns = frame.half * (2 * (np.arange(PIXELS) + 0.5) / PIXELS - 1)
    middles = (np.arange(frame.rows) + 0.5) / frame.rows
    rows = np.interp(middles, frame.shares, frame.edges)
    owner = np.searchsorted(frame.shares[1:-1], middles)
    out = np.full((frame.rows, PIXELS), np.nan)
    for k, (z, value) in enumerate(zip(depths, values, strict=True)):
        mine = owner == k
        if mine.any() and np.isfinite(value).all():
            down = PchipInterpolator(z, value, axis=0)(np.clip(rows[mine], z[0], z[-1]))
            out[mine] = np.stack([np.interp(columns, x, row) for row in down])
    return out


def draw_field(raster: Array, frame: Frame, scale: Scale, *, label: str) -> Markup:
    """One field as inline SVG; lengths over a_h.

    raster : as from ``rasterised``, NaN is drawn grey.
    """
    raster_of, bar = (LEFT, TOP, WIDTH, frame.height), (LEFT + WIDTH + 8, TOP, 10.0, frame.height)
    figure = Sheet(LEFT + WIDTH + RIGHT, TOP + frame.height + BOTTOM)
    chart = figure.chart(raster_of, (-frame.half, frame.half), (1.0, 0.0))
    chart.ticks(round_ticks(-frame.half, frame.half, 5), _depths(frame), "x / a_h")
    chart.note(-frame.half, 0.0, "z / a_h", by=(-LEFT + 4, -2), colour="muted")
    if not scale.logarithmic:
        _level_lines(chart.axes, raster, frame, scale)
    for at in frame.shares[1:-1]:
        for colour, width in (("#ffffff", 2.4), ("#101418", 0.9)):
            chart.axes.axhline(at, color=colour, linewidth=width)
    half = min(frame.contact, frame.half)
    contact: Any = {"color": ROLES["cap"], "linewidth": 4, "clip_on": False, "solid_capstyle": "butt"}
    chart.axes.plot([-half, half], [-3.5 / frame.height] * 2, **contact)
    colours = figure.chart(bar, (0.0, 1.0), (scale.low, scale.high))
    for value, text in scale.ticks:
        colours.note(1.0, value, text, by=(4, 3.5))
    levels = np.linspace(scale.high, scale.low, COLOURS)[:, None]
    return figure.drawing(
        label, css="figure field", under=_image(raster, scale, raster_of) + _image(levels, scale, bar)
    )


def _depths(frame: Frame) -> list[tuple[float, str]]:
    """Ticks along z: the edges of the layers, then round numbers that keep clear of them."""
    apart = 11.0 / frame.height
    found: list[tuple[float, str]] = []
    wanted = [(z, f"{z:.2g}") for z in frame.edges[:-1]] + round_ticks(0.0, frame.depth, 5)
    for z, text in wanted:
        at = frame.place(z)
        if all(abs(at - other) >= apart for other, _ in found):
            found.append((at, text))
    return found


def _image(raster: Array, scale: Scale, box: Box) -> str:
    """The values as an image that carries itself; a logarithmic one nearly so, at a quarter of the size."""
    colours = mpl.colormaps[scale.name].resampled(COLOURS).with_extremes(bad="#808080")
    shown = ScalarMappable(Normalize(scale.low, scale.high), colours)
    pixels = shown.to_rgba(np.ma.masked_invalid(raster), bytes=True)[..., :3]
    written = io.BytesIO()
    quality: Any = {"lossless": not scale.logarithmic, "quality": 90 if scale.logarithmic else 100}
    Image.fromarray(np.ascontiguousarray(pixels)).save(written, "WEBP", method=4, **quality)
    left, top, width, height = box
    return (
        f'<image x="{left:g}" y="{top:g}" width="{width:g}" height="{height:.1f}" preserveAspectRatio="none" '
        f'href="data:image/webp;base64,{base64.b64encode(written.getvalue()).decode()}"/>'
    )


def _level_lines(axes: Axes, raster: Array, frame: Frame, scale: Scale) -> None:
    """Lines of equal value at the ticks, broken at interfaces where the value jumps."""
    rows, columns = raster.shape
    x = frame.half * (2 * (np.arange(columns) + 0.5) / columns - 1)
    z = (np.arange(rows) + 0.5) / rows
    levels = [value for value, _ in scale.ticks]
    bounds = [round(rows * share) for share in frame.shares]
    for low, high in itertools.pairwise(bounds):
        part = raster[low:high]
        if high - low >= 3 and np.isfinite(part).all() and any(part.min() < v < part.max() for v in levels):
            axes.contour(x, z[low:high], part, levels, **LEVEL)


SHOWN = ("von_mises", "sigma_xx", "sigma_xz")
TITLES = {"von_mises": "von Mises"}
LOWEST, HIGHEST = -8.0, -3.0  # exponents of the difference over p_h; the same in all cases, to be compared


def pictures(plane: StressPlane | None, a_h: float, p_h: float, case: str = "") -> dict[str, Any] | None:
    """Von Mises stress, sigma_xx and sigma_xz side by side, below them the differences of both methods.

    With caption; None where there is nothing to draw.
    """
    if plane is None or not plane.stress or not a_h > 0 or not p_h > 0:
        return None
    sources = [name for name in METHODS if name in plane.stress]
    x, depths = plane.x / a_h, [z / a_h for z in plane.depths]
    bottoms = [float(z[-1]) for z in depths]
    frame = Frame(float(x[-1]), bottoms[-1], tuple(bottoms[:-1]), plane.radius / a_h)

    def panel(values: Sequence[Array], colours: Scale, title: str, label: str, note: str) -> Panel:
        return Panel(
            title, draw_field(rasterised(x, depths, values, frame), frame, colours, label=label), note
        )

    fields, gaps = [], []
    for quantity in SHOWN:
        by = {s: [_quantity(sigma, quantity) / p_h for sigma in plane.stress[s]] for s in sources}
        source, shown = next(iter(by.items()))
        title, name = f"{TITLES.get(quantity, quantity)} / p_h", source_label(source)
        values = np.concatenate([f.ravel() for f in shown])
        known = values[np.isfinite(values)]
        span = f"{plain(known.min(), 3)} to {plain(known.max(), 3)}" if known.size else "not finite"
        label = f"{title} by {name}, {case}"
        fields.append(panel(shown, _colours(quantity, shown), title, label, f"{name}, {span}"))
        if len(sources) == 2:
            apart = [np.abs(one - other) for one, other in zip(*by.values(), strict=True)]
            largest = max(float(g.max()) for g in apart)
            exponents = [np.log10(np.maximum(g, 10.0 ** (LOWEST - 1))) for g in apart]
            top = max(HIGHEST, float(np.ceil(np.log10(largest)))) if 0 < largest < np.inf else HIGHEST
            colours = Scale(LOWEST, top, "cividis", logarithmic=True)
            label = f"difference of both methods in {title}, logarithmic, {case}"
            note = f"largest {scientific(largest)}"
            gaps.append(panel(exponents, colours, f"difference in {title}", label, note))
    return {
        "panels": [*fields, *gaps],
        "caption": stated("pictures", stretched=frame.stretched, both=len(sources) == 2),
        "failures": [(source_label(name), message) for name, message in plane.failures.items()],
    }


def _quantity(sigma: Array, name: str) -> Array:
    return von_mises(sigma) if name == "von_mises" else sigma[list(IN_PLANE).index(name)]


def plane_difference(plane: StressPlane, scale: float) -> float | None:
    """Largest difference of the methods in any stress anywhere in the plane, over ``scale``."""
    if len(plane.stress) != 2 or not scale > 0:
        return None
    pairs = zip(*plane.stress.values(), strict=True)
    largest = np.max([np.abs(one - other).max() for one, other in pairs]) / scale
    return float(largest) if np.isfinite(largest) else None


def _colours(quantity: str, values: Sequence[Array]) -> Scale:
    """One scale for both methods: from zero up for von Mises, even about zero for the others."""
    largest = max(
        (float(np.max(np.abs(v), initial=0.0)) for v in values if np.isfinite(v).all()), default=1.0
    )
    largest = largest or 1.0
    if quantity == "von_mises":
        return Scale(0.0, largest, "viridis")
    return Scale(-largest, largest, "RdBu_r")
