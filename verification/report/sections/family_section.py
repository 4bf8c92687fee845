"""Coatings that differ in their modulus alone, one plot for each quantity.

The plots of O'Sullivan and King, J. Tribol. 110 (1988) 235-240: lengths over a_h, stresses over p_h, a curve
for each E1/E2 at one thickness, without friction or with one coefficient.
"""

from collections.abc import Sequence
from itertools import zip_longest

import numpy as np
from markupsafe import Markup

from verification.page.figures import HUGE, Sheet, line, round_ticks
from verification.page.number_text import plain
from verification.page.page_parts import Cell, Gallery, Panel, Part, Section, Table, number, row, written
from verification.page.source_labels import source_label
from verification.problem.array_types import Array
from verification.problem.line_profile import coordinate_of
from verification.problem.quantity import QUANTITIES, SCALARS
from verification.report.figures.line_panels import FIRST, swatch
from verification.report.tables.case_lookup import (
    layers,
    reference_source,
    scalar,
    scale,
    sources_with_profiles,
)
from verification.running.case_result import CaseResult
from verification.sources.source_record import Style
from verification.sources.source_registry import CLOSED

WIDTH, HEIGHT = 320, 260
BOX = (48.0, 6.5, 265.6, 215.8)  # left, top, width, height
DASHED = ((), (6.0, 2.0), (3.0, 2.0), (1.0, 1.6), (6.0, 2.0, 1.0, 2.0))
SMALLEST = 3  # fewer than this many moduli are no family

Members = dict[float, CaseResult]  # by E1/E2, ascending
Curves = dict[float, tuple[Array, Array]]  # by E1/E2


def section(results: Sequence[CaseResult]) -> Section | None:
    """A gallery for every family among the ``results``; None where there is none.

    A family: one coating, one thickness over a_h, one nu throughout, one friction, and three or more E1/E2,
    the uncoated solid as E1/E2 = 1.
    """
    parts = []
    for (thickness, friction, nu), members in sorted(_families(results).items()):
        if len(members) < SMALLEST:
            continue
        sliding = f"sliding with f = {friction:g}" if friction else "frictionless"
        text = (
            f"One coating of h = {thickness:g} a_h, nu = {nu:g}, {sliding}, for E1/E2 = "
            f"{', '.join(plain(ratio, 3) for ratio in members)}: the configuration of O'Sullivan and King "
            "(1988), lengths over a_h, stresses over p_h."
        )
        parts.append(Part(text, [_numbers(members)], _gallery(members)))
    return Section("family", "Pressure and stress against the coating's modulus", parts) if parts else None


def _families(results: Sequence[CaseResult]) -> dict[tuple[float, float, float], Members]:
    """Members by thickness over a_h, friction and nu."""
    coated: dict[tuple[float, float, float], Members] = {}
    bare: dict[tuple[float, float], CaseResult] = {}
    for result in results:
        solid, a_h = layers(result.problem), float(scale(result.problem, "a_h"))
        friction = result.problem.get("friction")
        if not solid or len({nu for _, nu, _ in solid}) > 1 or not a_h > 0 or not isinstance(friction, float):
            continue
        nu = solid[0][1]
        if len(solid) == 1:
            bare.setdefault((friction, nu), result)
        elif len(solid) == 2:
            key = (round(solid[0][2] / a_h, 6), friction, nu)
            coated.setdefault(key, {}).setdefault(solid[0][0] / solid[1][0], result)
    for (_, friction, nu), members in coated.items():
        if (friction, nu) in bare:
            members.setdefault(1.0, bare[friction, nu])
    return {key: dict(sorted(members.items())) for key, members in coated.items()}


def _gallery(members: Members) -> Gallery:
    styles = {ratio: Style("ink", DASHED[n % len(DASHED)], 1.3) for n, ratio in enumerate(members)}
    panels, columns = [], []
    for quantity, place in FIRST:
        curves: Curves = {}
        for ratio, result in members.items():
            profile = result.profile_of.get((quantity, place, reference_source(result) or ""))
            if profile is not None:
                a_h, p_h = (scale(result.problem, name) for name in ("a_h", "p_h"))
                x, y = curves[ratio] = profile.position / a_h, profile.value / p_h
                what = f"E1/E2 = {plain(ratio, 3)}, {place}"
                columns.append([f"{coordinate_of(place)} / a_h, {what}", *(f"{v:.6g}" for v in x)])
                columns.append([f"{quantity} / p_h, {what}", *(f"{v:.6g}" for v in y)])
        if curves:
            figure = _draw(curves, styles, quantity, place)
            panels.append(Panel(f"{QUANTITIES[quantity].symbol} / p_h", figure, f"on {place}"))
    legend = [(swatch(style), f"E1/E2 = {plain(ratio, 3)}") for ratio, style in styles.items()]
    caption = "The best reference of each case; the methods coincide with it, see the pages of the cases."
    return Gallery(legend, panels, caption, written(list(zip_longest(*columns, fillvalue=""))))


def _numbers(members: Members) -> Table:
    """The contact's scalars over their Hertz scales, by every source."""
    scalars = [QUANTITIES[name] for name in SCALARS]
    every = dict.fromkeys(s for result in members.values() for s in sources_with_profiles(result))
    sources = [s for s in every if s not in CLOSED]  # which hold for the uncoated member only
    rows = []
    for ratio, result in members.items():
        found = [
            (scalar(result, q.name, s), scale(result.problem, q.scale)) for s in sources for q in scalars
        ]
        cells = [number(float(one[0] / size) if one else None, "{:.6f}".format) for one, size in found]
        rows.append(row(Cell(plain(ratio, 3), ratio, note=result.title), *cells))
    return Table(
        "Scalars of the contact over the Hertz scales of the bare substrate.",
        ["E1/E2", *(f"{q.symbol} / {q.scale}" for _ in sources for q in scalars)],
        rows,
        [("", 1), *((source_label(source), len(scalars)) for source in sources)],
    )


def _draw(curves: Curves, styles: dict[float, Style], quantity: str, place: str) -> Markup:
    (left, right), (low, high) = (_ends([pair[i] for pair in curves.values()]) for i in (0, 1))
    margin = 0.09 * (high - low)
    figure = Sheet(WIDTH, HEIGHT)
    chart = figure.chart(BOX, (left, right), (low - margin, high + margin))
    chart.ticks(round_ticks(left, right, 6), round_ticks(low, high, 6), f"{coordinate_of(place)} / a_h")
    for ratio, (x, y) in curves.items():
        line(chart.axes, x, y, styles[ratio])
    return figure.drawing(f"{quantity} on {place} for every E1/E2")


def _ends(arrays: Sequence[Array]) -> tuple[float, float]:
    """The least and the largest value that can be drawn; -1 and 1 where they do not differ."""
    values = np.concatenate(arrays)
    values = values[np.abs(values) < HUGE]
    return (float(values.min()), float(values.max())) if values.size and np.ptp(values) > 0 else (-1.0, 1.0)
