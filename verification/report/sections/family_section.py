"""Coatings that differ in their modulus alone, one plot for each quantity.

The plots of O'Sullivan and King, J. Tribol. 110 (1988) 235-240: lengths over a_h, stresses over p_h, a curve
for each E1/E2 at one thickness, without friction or with one coefficient.
"""

from collections.abc import Sequence
from itertools import zip_longest
from typing import NamedTuple

import numpy as np
from markupsafe import Markup

from verification.page.embedded_csv import written
from verification.page.number_text import plain
from verification.page.page_parts import Cell, Gallery, Panel, Part, Section, Table, number, row
from verification.page.source_labels import source_label, source_style
from verification.page.svg_plot import HUGE, Axes, drawing, round_ticks
from verification.problem.array_types import Array
from verification.problem.quantity import QUANTITIES, SCALARS
from verification.report.figures.line_panels import FIRST, swatch
from verification.report.report_material import Material
from verification.report.tables.case_lookup import coordinate, layers, scalar, scale, sources_with_profiles
from verification.running.case_result import CaseResult
from verification.sources.source_record import Style
from verification.sources.source_registry import CLOSED

WIDTH, HEIGHT = 320, 260
BOX = (48.0, 6.5, 265.6, 215.8)  # left, top, width, height
MARKED = 7  # points of a curve that are marked
LABEL = np.array([9.0, -7.0])  # from a point to the middle of the text beside it, in units of the drawing
DASHED = ((), (6.0, 2.0), (3.0, 2.0), (1.0, 1.6), (6.0, 2.0, 1.0, 2.0))
SMALLEST = 3  # fewer than this many moduli are no family


class Member(NamedTuple):
    """A case with its E1/E2."""

    ratio: float
    result: CaseResult


def section(material: Material) -> Section | None:
    """The families among the cases of the run."""
    return family_section(material.contacts)


def family_section(results: Sequence[CaseResult], anchor: str = "family") -> Section | None:
    """A gallery for every family among the cases; None where there is none.

    A family: one coating, one thickness over a_h, one nu throughout, one friction, and three or more E1/E2,
    the uncoated solid as E1/E2 = 1.
    """
    parts = []
    for (thickness, friction, nu), members in sorted(_families(results).items()):
        if len(members) < SMALLEST:
            continue
        ratios = ", ".join(plain(member.ratio, 3) for member in members)
        sliding = f"sliding with f = {friction:g}" if friction else "frictionless"
        text = (
            f"One coating of h = {thickness:g} a_h, nu = {nu:g}, {sliding}, for E1/E2 = {ratios}: the "
            "configuration of O'Sullivan and King (1988), lengths over a_h, stresses over p_h."
        )
        parts.append(Part(text, [_numbers(members)], _gallery(members)))
    return Section(anchor, "Pressure and stress against the coating's modulus", parts) if parts else None


def _families(results: Sequence[CaseResult]) -> dict[tuple[float, float, float], list[Member]]:
    """Members by thickness over a_h, friction and nu, in the order of their moduli."""
    coated: dict[tuple[float, float, float], dict[float, Member]] = {}
    bare: dict[tuple[float, float], Member] = {}
    for result in results:
        solid, a_h = layers(result), float(scale(result, "a_h"))
        friction = result.problem.get("friction")
        if not solid or len({nu for _, nu, _ in solid}) > 1 or not a_h > 0 or not isinstance(friction, float):
            continue
        nu = solid[0][1]
        if len(solid) == 1:
            bare.setdefault((friction, nu), Member(1.0, result))
        elif len(solid) == 2:
            ratio = solid[0][0] / solid[1][0]
            key = (round(solid[0][2] / a_h, 6), friction, nu)
            coated.setdefault(key, {}).setdefault(ratio, Member(ratio, result))
    for (_, friction, nu), members in coated.items():
        if (friction, nu) in bare:
            members.setdefault(1.0, bare[friction, nu])
    return {key: [members[ratio] for ratio in sorted(members)] for key, members in coated.items()}


def _gallery(members: Sequence[Member]) -> Gallery:
    shown = [
        (quantity, line)
        for quantity, line in FIRST
        if any(p.quantity == quantity and p.line == line for m in members for p in m.result.profiles)
    ]
    panels = [
        Panel(f"{QUANTITIES[quantity].symbol} / p_h", figure, f"on {line}", "")
        for quantity, line in shown
        if (figure := _draw(members, quantity, line))
    ]
    sources = dict.fromkeys(s for m in members for s in sources_with_profiles(m.result))
    broad = [s for s in sources if source_style(s).width > 3] or list(sources)[:1]
    legend = [
        (swatch(Style("ink"), marked=False), source_label(s))
        if s in broad
        else (swatch(source_style(s), marked=True), source_label(s))
        for s in sources
    ]
    caption = (
        "Lines: the best reference, E1/E2 beside each; marks: the methods, which lie on the lines. Their "
        "differences are on the pages of the cases."
    )
    return Gallery(legend, panels, caption, _curves_csv(members, shown))


def _curves_csv(members: Sequence[Member], shown: Sequence[tuple[str, str]]) -> str:
    """Every curve drawn, lengths over a_h, stresses over p_h."""
    columns = []
    for member in members:
        a_h, p_h = scale(member.result, "a_h"), scale(member.result, "p_h")
        for profile in member.result.profiles:
            if (profile.quantity, profile.line) in shown:
                what = f"E1/E2 = {plain(member.ratio, 3)}, {profile.source}, {profile.line}"
                along = [f"{x:.6g}" for x in profile.position / a_h]
                columns.append([f"{coordinate(profile.line)} / a_h, {what}", *along])
                name = "p" if profile.quantity == "pressure" else profile.quantity
                columns.append([f"{name} / p_h, {what}", *(f"{v:.6g}" for v in profile.value / p_h)])
    return written(list(zip_longest(*columns, fillvalue="")))


def _numbers(members: Sequence[Member]) -> Table:
    """The contact's scalars over their Hertz scales, by every source."""
    scalars = [QUANTITIES[name] for name in SCALARS]
    sources = [
        s
        for s in dict.fromkeys(s for m in members for s in sources_with_profiles(m.result))
        if s not in CLOSED  # which hold for the uncoated member only
    ]
    rows = []
    for member in members:
        cells = []
        for source in sources:
            for quantity in scalars:
                found = scalar(member.result, quantity.name, source)
                value = None if found is None else float(found[0] / scale(member.result, quantity.scale))
                cells.append(number(value, "{:.6f}".format))
        rows.append(row(Cell(plain(member.ratio, 3), member.ratio, note=member.result.title), *cells))
    return Table(
        "Scalars of the contact over the Hertz scales of the bare substrate.",
        ["E1/E2", *(f"{q.symbol} / {q.scale}" for _ in sources for q in scalars)],
        rows,
        [("", 1), *((source_label(source), len(scalars)) for source in sources)],
    )


def _draw(members: Sequence[Member], quantity: str, line: str) -> Markup:
    """The reference curve of every member, its E1/E2 beside it, with marks of the other sources."""
    curves: list[tuple[Array, Array, Style, bool]] = []
    texts: list[tuple[Array, Array, str]] = []
    for n, member in enumerate(members):
        a_h, p_h = scale(member.result, "a_h"), scale(member.result, "p_h")
        found = [p for p in member.result.profiles if (p.quantity, p.line) == (quantity, line)]
        for profile in sorted(found, key=lambda p: -source_style(p.source).width):
            x, y = profile.position / a_h, profile.value / p_h
            y = np.where(np.abs(y) < HUGE, y, np.nan)
            base = profile.source == max(found, key=lambda p: source_style(p.source).width).source
            style = Style("ink", DASHED[n % len(DASHED)], 1.3) if base else source_style(profile.source)
            curves.append((x, y, style, base))
            if base:
                texts.append((x, y, plain(member.ratio, 3)))
    values = np.concatenate([y[np.isfinite(y)] for _, y, _, _ in curves] or [np.zeros(0)])
    places = np.concatenate([x[np.abs(x) < HUGE] for x, _, _, _ in curves] or [np.zeros(0)])
    (low, high), span = _ends(values, (-1.0, 1.0)), _ends(places, (0.0, 1.0))
    margin = 0.09 * (high - low)
    axes = Axes(BOX, span, (low - margin, high + margin))
    axes.ticks(round_ticks(*span, 6), round_ticks(low, high, 6), f"{coordinate(line)} / a_h")
    for x, y, style, base in curves:
        if base:
            axes.line(x, y, style)
        else:
            offset = 0.25 if style.marker == "o" else 0.75
            at = np.unique(np.abs(x[:, None] - _spread(x, offset)).argmin(axis=0))
            axes.marks(x[at], y[at], style)
    for (u, v), text in zip(_clear(axes, texts), texts, strict=True):
        axes.text(u, v, text[2])
    return drawing(WIDTH, HEIGHT, f"{quantity} on {line} for every E1/E2", axes)


def _spread(x: Array, offset: float) -> Array:
    """Evenly spaced places of marks over the extent of ``x``."""
    return np.nanmin(x) + (np.arange(MARKED) + offset) / MARKED * np.ptp(x)


def _clear(axes: Axes, curves: Sequence[tuple[Array, Array, str]]) -> list[tuple[float, float]]:
    """A point of each curve for its label, far from the other curves and from the labels before."""
    drawn = [axes.place(x, y) for x, y, _ in curves]
    written = np.full((1, 2), 1e4)
    found = []
    for n, points in enumerate(drawn):
        if not len(points):
            found.append((np.nan, np.nan))
            continue
        middles = points + LABEL
        others = np.concatenate([written, *(some for m, some in enumerate(drawn) if m != n)])
        gaps = np.abs(middles[:, None, :] - others[None]) / np.array([1.6, 1.0])  # a text is wider than high
        room = np.nan_to_num(np.hypot(gaps[..., 0], gaps[..., 1]), nan=np.inf).min(axis=1)
        usable = np.isfinite(points).all(axis=1) & (points[:, 0] < BOX[0] + BOX[2] - 24)
        best = int(np.argmax(np.where(usable, room, -1.0)))
        written = np.concatenate([written, middles[best : best + 1]])
        found.append((float(curves[n][0][best]), float(curves[n][1][best])))
    return found


def _ends(values: np.ndarray, otherwise: tuple[float, float]) -> tuple[float, float]:
    """The least and the largest of ``values``; ``otherwise`` where they do not differ."""
    return (float(values.min()), float(values.max())) if values.size and np.ptp(values) > 0 else otherwise
