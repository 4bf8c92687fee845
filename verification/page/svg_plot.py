"""Plots as compact inline SVG in the colour roles of the style sheet: they follow light, dark, print."""

from collections.abc import Iterator, Sequence
from functools import cache
from math import ceil, floor, isfinite, log10

import contourpy
import numpy as np
from markupsafe import Markup, escape

from verification.page.symbol_text import drawn, unicode
from verification.problem.array_types import Array
from verification.sources.source_record import Style

# Marks of single points, open, in units of the drawing; by the shapes of ``Style.marker``.
MARKS = {
    "o": "m-2.6 0a2.6 2.6 0 1 0 5.2 0a2.6 2.6 0 1 0-5.2 0z",
    "^": "m0-3.1l3 5.2h-6z",
    "s": "m-2.4-2.4h4.8v4.8h-4.8z",
    "+": "m-3 0h6m-3-3v6",
}
# Larger numbers are failures; a curve has a gap there.
HUGE = 1e12
FAR = 1e4  # units; nothing is drawn farther off than this
STRAIGHT = 0.09  # units; a point nearer than this to the chord of its neighbours is left out


class Axes:
    """One pair of axes: curves clipped to the frame, ticks and labels around it.

    box : left, top, width, height in units of the drawing.   x, y : values at the ends of the axes.
    """

    def __init__(
        self, box: tuple[float, float, float, float], x: tuple[float, float], y: tuple[float, float]
    ) -> None:
        self.box, self.x, self.y = box, x, y
        self._grid: list[str] = []
        self._inside: list[str] = []
        self._around: list[str] = []

    def place(self, x: Array | float, y: Array | float) -> Array:
        """Points in units of the drawing, (n, 2); NaN for what is not finite or larger than ``HUGE``."""
        left, top, width, height = self.box
        with np.errstate(all="ignore"):
            u = left + width * (np.asarray(x, dtype=float) - self.x[0]) / (self.x[1] - self.x[0])
            v = top + height * (self.y[1] - np.asarray(y, dtype=float)) / (self.y[1] - self.y[0])
            points = np.stack(np.broadcast_arrays(u, v), axis=-1).reshape(-1, 2)
            ends = np.stack(np.broadcast_arrays(x, y), axis=-1).reshape(-1, 2)
            return np.where(np.abs(ends) < HUGE, np.clip(points, -FAR, FAR), np.nan)

    def line(self, x: Array, y: Array, style: Style, *, dots: bool = False) -> None:
        """A curve, with a dot at each point where asked for."""
        points = self.place(x, y)
        dash = " ".join(f"{length * style.width:.4g}" for length in style.dash)
        more = f' stroke-dasharray="{dash}"' if dash else ""
        more += f' stroke-opacity="{style.opacity:g}"' if style.opacity != 1 else ""
        if path := polyline(points):
            self._inside.append(
                f'<path d="{path}" class="s-{style.colour}" stroke-width="{style.width:g}"{more}/>'
            )
        if dots:
            marks = "".join(f"M{u:.1f} {v:.1f}h0" for u, v in points[np.isfinite(points).all(axis=1)])
            self._inside.append(f'<path d="{marks}" class="dots s-{style.colour}"/>')

    def marks(self, x: Array, y: Array, style: Style) -> None:
        """Single points of a curve, each with the mark of its style."""
        path = "".join(
            f"M{u:.1f} {v:.1f}{MARKS[style.marker]}" for u, v in self.place(x, y) if isfinite(u + v)
        )
        if path:
            self._inside.append(f'<path d="{path}" class="point s-{style.colour}"/>')

    def band(self, x: Array, low: float, high: Array, colour: str, opacity: float) -> None:
        """The area between ``low`` and ``high``, in a gap of ``high`` interrupted."""
        paths = []
        for u, v in _runs(np.stack([np.asarray(x, dtype=float), high], axis=1)):
            outline = self.place(np.concatenate([u[:1], u, u[-1:]]), np.concatenate([[low], v, [low]]))
            paths.append(polyline(outline) + "z")
        self._inside.append(
            f'<path d="{"".join(paths)}" class="f-{colour} s-{colour}" fill-opacity="{opacity:g}" '
            'stroke-opacity=".55" stroke-width=".8"/>'
        )

    def add(self, element: str) -> None:
        """Any SVG element, in units of the drawing, clipped to the frame."""
        self._inside.append(element)

    def zone(self, low: float, high: float) -> None:
        """A vertical strip."""
        (a, _), (b, _) = self.place(np.array([low, high]), 0.0)
        _, top, _, height = self.box
        self._inside.append(
            f'<rect x="{a:.1f}" y="{top:.1f}" width="{b - a:.1f}" height="{height:.1f}" class="f-zone" '
            'fill-opacity=".13"/>'
        )

    def filled(
        self, x: Array, y: Array, z: Array, low: float, high: float, colour: str, shade: float
    ) -> None:
        """The area where ``z`` (y, x) lies between ``low`` and ``high``."""
        if not ((z > low).any() and (z <= high).any()):
            return
        generator = contourpy.contour_generator(x, y, z, fill_type="OuterOffset")
        path = "".join(
            polyline(self.place(*ring.T)) + "z"
            for points, offsets in zip(*generator.filled(low, high), strict=True)
            for ring in np.split(np.asarray(points), np.asarray(offsets)[1:-1])
        )
        self._inside.append(
            f'<path d="{path}" class="f-{colour}" fill-rule="evenodd" fill-opacity="{shade:g}"/>'
        )

    def contour(self, x: Array, y: Array, z: Array, level: float, text: str) -> None:
        """The line on which ``z`` (y, x) equals ``level``, ``text`` in the middle of its longest part."""
        lines = [np.asarray(line) for line in contourpy.contour_generator(x, y, z).lines(level)]
        for line in lines:
            self.line(line[:, 0], line[:, 1], Style("ink", width=0.9))
        if lines:
            longest = max(lines, key=len)
            x_text, y_text = longest[len(longest) // 2]
            self.text(x_text, y_text, text)

    def ring(self, x: float, y: float) -> None:
        """A ring around one point."""
        ((u, v),) = self.place(x, y)
        if isfinite(u) and isfinite(v):
            self._around.append(
                f'<circle cx="{u:.1f}" cy="{v:.1f}" r="4" class="ring s-cap" stroke-width="1.6"/>'
            )

    def text(
        self, x: float, y: float, text: str, *, colour: str = "ink", by: tuple[float, float] = (3, -3)
    ) -> None:
        """``text`` beside a point, ``by`` units off."""
        ((u, v),) = self.place(x, y)
        self._write(u + by[0], v + by[1], text, "", colour)

    def ticks(
        self, x: Sequence[tuple[float, str]] = (), y: Sequence[tuple[float, str]] = (), label: str = ""
    ) -> None:
        """Grid lines with their texts at values of both axes, and the ``label`` below."""
        left, top, width, height = self.box
        bottom = top + height
        for value, text in x:
            ((u, _),) = self.place(value, 0.0)
            self._grid.append(f"M{u:.1f} {top:.1f}v{height:.1f}")
            self._write(u, bottom + 11, text, "middle")
        for value, text in y:
            ((_, v),) = self.place(0.0, value)
            self._grid.append(f"M{left:.1f} {v:.1f}h{width:.1f}")
            # at the corner both labels meet
            self._write(left - 3, min(v + 4, bottom), text, "end")
        self._write(left + width / 2, bottom + 23, label, "middle")

    def _write(self, u: float, v: float, text: str, anchor: str, colour: str = "ink") -> None:
        if text and isfinite(u) and isfinite(v):
            aligned = f' text-anchor="{anchor}"' if anchor else ""
            self._around.append(
                f'<text x="{u:.1f}" y="{v:.1f}" class="f-{colour}"{aligned}>{drawn(text)}</text>'
            )

    def markup(self) -> str:
        """The axes as SVG elements; an element of its own clips what lies beyond the frame."""
        left, top, width, height = (f"{n:.1f}" for n in self.box)
        grid = "".join([*self._grid, f"M{left} {top}h{width}v{height}h-{width}z"])
        return (
            f'<path d="{grid}" class="s-grid" stroke-width=".6"/><svg x="{left}" y="{top}" width="{width}" '
            f'height="{height}" viewBox="{left} {top} {width} {height}">{"".join(self._inside)}</svg>'
            f"{''.join(self._around)}"
        )


def drawing(width: float, height: float, label: str, *axes: Axes, data: str = "") -> Markup:
    """A figure of ``width`` by ``height`` units; ``label`` describes it to a screen reader.

    data : further attributes, escaped, for the script of the page.
    """
    inner = "".join(one.markup() for one in axes)
    return Markup(
        f'<svg class="figure" viewBox="0 0 {width:g} {height:g}" role="img" '
        f'aria-label="{escape(unicode(label))}"{f" {data}" if data else ""}>'
        f"{inner}</svg>"
    )


def polyline(points: Array) -> str:
    """``points`` (n, 2) as the data of a path, in tenths of a unit relative to the point before.

    A NaN interrupts it; what lies on a straight line between others is left out.
    """
    written = []
    for u, v in _runs(points):
        tenths = np.round(10 * _simplified(np.stack([u, v], axis=1))).astype(int)
        steps = np.diff(tenths, axis=0)
        steps = steps[steps.any(axis=1)].tolist()
        if steps:
            x, y = tenths[0].tolist()
            written.append(f"M{_tenths(x)} {_tenths(y)}l")
            written.append(" ".join(f"{_tenths(a)} {_tenths(b)}" for a, b in steps).replace(" -", "-"))
    return "".join(written)


def _runs(points: Array) -> Iterator[tuple[Array, Array]]:
    """The parts of ``points`` (n, 2) between those that are not finite, as two columns."""
    bad = np.flatnonzero(~np.isfinite(points).all(axis=1))
    for part in np.split(points, bad):
        whole = part[np.isfinite(part).all(axis=1)]
        if len(whole) > 1:
            yield whole[:, 0], whole[:, 1]


def _simplified(points: Array) -> Array:
    """``points`` without those nearer than ``STRAIGHT`` to the chord of their neighbours, by turns."""
    for start in (1, 2) * 4:
        before, middle, after = points[start - 1 : -2 : 2], points[start:-1:2], points[start + 1 :: 2]
        if not len(middle):
            break
        chord = after - before
        away = middle - before
        square = np.maximum((chord**2).sum(axis=1), 1e-12)
        share = np.clip((away * chord).sum(axis=1) / square, 0, 1)[:, None]
        keep = np.ones(len(points), dtype=bool)
        keep[start:-1:2] = np.hypot(*(away - share * chord).T) > STRAIGHT
        points = points[keep]
    return points


@cache
def _tenths(value: int) -> str:
    """0.1 times ``value`` in as few characters as a path needs."""
    return f"{value / 10:g}".replace("0.", ".", 1) if abs(value) < 10 else f"{value / 10:.15g}"


def round_ticks(low: float, high: float, count: int) -> list[tuple[float, str]]:
    """At most ``count`` + 1 ticks at 1, 2 or 5 times a power of ten, with their labels."""
    raw = (high - low) / count
    power = 10.0 ** floor(log10(raw))
    step = next(s * power for s in (1, 2, 5, 10) if s * power >= raw * (1 - 1e-9))
    first, last = ceil(low / step - 1e-9), floor(high / step + 1e-9)
    ticks = [number * step for number in range(first, last + 1)]
    return [(tick, f"{tick:.6g}".replace("-", "−")) for tick in ticks]


def power_of_ten(exponent: float) -> str:
    """A tick label such as 1e−4."""
    return f"1e{exponent:.0f}".replace("-", "−")
