"""The figures of a case: one panel for each quantity on each line."""

from dataclasses import dataclass

import numpy as np
from markupsafe import Markup

from verification.judging.verdict import Claim, Outcome
from verification.problem.quantity import DISPLACEMENTS, QUANTITIES
from verification.report.figures.curves import FLOOR, Curve, Difference, draw
from verification.report.tables.cells import Panel
from verification.report.tables.labels import pair_label, pair_style, source_label, source_style
from verification.report.tables.lookup import (
    claimed_quantities,
    contact_radius,
    coordinate,
    difference,
    reference_source,
    scale,
    sources_with_profiles,
)
from verification.report.tables.numbers import scientific
from verification.running.result import CaseResult
from verification.sources.record import Style
from verification.sources.registry import METHODS


@dataclass(frozen=True)
class LineFigures:
    """The panels of one line, with a legend each for the curves and for the differences."""

    panels: tuple[Panel, ...]
    curves: tuple[tuple[Markup, str], ...]
    differences: tuple[tuple[Markup, str], ...]
    caption: str


def line_figures(result: CaseResult, line: str) -> LineFigures:
    """Everything drawn about ``line``."""
    quantities = claimed_quantities(result, line)
    panels = tuple(_panel(result, line, q) for q in quantities)
    sources = [s for s in sources_with_profiles(result) if any(p.source == s for p in _on(result, line))]
    pairs = list(dict.fromkeys(pair for q in quantities for pair in _pairs(result, line, q)))
    return LineFigures(
        panels,
        tuple((swatch(source_style(source)), source_label(source)) for source in sources),
        tuple((swatch(pair_style(pair)), pair_label(pair)) for pair in pairs),
        _caption(result, line),
    )


def swatch(style: Style) -> Markup:
    """A short piece of a line as the figures draw it."""
    dash = " ".join(f"{length * style.width:.1f}" for length in style.dash)
    return Markup(
        '<svg class="swatch" viewBox="0 0 36 10" aria-hidden="true"><path d="M1 5h34" class="s-{}" '
        'stroke-width="{}" stroke-dasharray="{}" stroke-opacity="{}"/></svg>'
    ).format(style.colour, style.width, dash or "none", style.opacity)


def _on(result: CaseResult, line: str) -> list:
    return [profile for profile in result.profiles if profile.line == line]


def _pairs(result: CaseResult, line: str, quantity: str) -> list[tuple[str, str]]:
    """The claimed pairs that are drawn: methods with each other, sources with the reference source."""
    best = reference_source(result)
    claimed = [c.between for c, _ in result.verdicts if (c.quantity, c.line) == (quantity, line)]
    return [
        pair
        for pair in dict.fromkeys(claimed)
        if best in pair or set(pair) <= set(METHODS) or not set(pair) & set(METHODS)
    ]


def _panel(result: CaseResult, line: str, quantity: str) -> Panel:
    a_h, unit = scale(result, "a_h"), _scale_of(quantity)
    curves = [
        Curve(profile.position / a_h, profile.value / scale(result, unit), source_style(profile.source))
        for profile in _on(result, line)
        if profile.quantity == quantity
    ]
    claims = [(c, v) for c, v in result.verdicts if (c.quantity, c.line) == (quantity, line)]
    differences = []
    for pair in _pairs(result, line, quantity):
        verdict = next(v for claim, v in claims if claim.between == pair)
        first, second = (result.profile_of.get((quantity, line, source)) for source in pair)
        found = difference(result, first, second)
        if found is None or first is None:
            continue
        gap, uncertainty = found
        failed = verdict.outcome is not Outcome.AGREES and verdict.worst is not None
        worst = verdict.worst / a_h if failed and verdict.worst is not None else None
        vague = verdict.outcome is Outcome.INCONCLUSIVE
        differences.append(Difference(first.position / a_h, gap, uncertainty, pair_style(pair), worst, vague))
    cap = min((claim.cap for claim, _ in claims), default=None)
    zones = _unjudged(result, [claim for claim, _ in claims], curves)
    figure = draw(
        curves,
        differences,
        label=f"{quantity} on {line} by every source, with differences",
        coordinate=f"{coordinate(line)} / a_h",
        cap=cap,
        unjudged=zones,
    )
    bad = [(c, v) for c, v in claims if v.outcome is not Outcome.AGREES]
    largest = max((v.difference for _, v in claims if v.difference is not None), default=None)
    note = f"largest judged difference {scientific(largest)}"
    if bad:
        note = f"{len(bad)} of {len(claims)} do not agree, difference {scientific(largest)}"
    title = f"{QUANTITIES[quantity].symbol if quantity in QUANTITIES else quantity} / {unit}"
    return Panel(title, figure, note if claims else "not compared", "fails" if bad else "")


def _scale_of(quantity: str) -> str:
    return QUANTITIES[quantity].scale if quantity in QUANTITIES else "p_h"


def _unjudged(result: CaseResult, claims: list[Claim], curves: list[Curve]) -> list[tuple[float, float]]:
    edge = max((claim.edge for claim in claims), default=0.0)
    a, a_h = contact_radius(result), scale(result, "a_h")
    if not edge or a is None or not curves:
        return []
    inner, outer = a * (1 - edge) / a_h, a * (1 + edge) / a_h
    low = min(float(np.min(curve.position, initial=0.0)) for curve in curves)
    high = max(float(np.max(curve.position, initial=0.0)) for curve in curves)
    return [span for span in ((-outer, -inner), (inner, outer)) if span[1] > low and span[0] < high]


def _caption(result: CaseResult, line: str) -> str:
    displaced = any(profile.quantity in DISPLACEMENTS for profile in _on(result, line))
    also = (", displacements in units of delta_h", ", of delta_h and approach for displacements")
    above, below = also if displaced else ("", "")
    text = (
        f"Above: the quantity in units of p_h{above} over {coordinate(line)} / a_h, tension positive. Below: "
        f"|A − B| over the smaller of p_h and p0{below}, logarithmic, from {scientific(FLOOR, 1)}; the thin "
        "line that bounds a tint is U_A + U_B, and a difference below its own line agrees; red dashes: the "
        "cap on U."
    )
    edges = [claim.edge for claim, _ in result.verdicts if claim.line == line and claim.edge]
    if edges:
        text += f" Grey: within {100 * max(edges):.0f} % of the contact edge, not judged."
    failed = any(claim.line == line and v.outcome is not Outcome.AGREES for claim, v in result.verdicts)
    return text + (" A red ring marks the point that decides a failed comparison." if failed else "")
