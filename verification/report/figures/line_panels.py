"""The figures of a case: one panel for each quantity on each line."""

from typing import Any

import numpy as np
from markupsafe import Markup, escape

from verification.judging.verdict import Outcome
from verification.page.number_text import scientific
from verification.page.page_parts import Panel
from verification.page.plots import Curve, Difference, draw_curves
from verification.page.source_labels import pair_label, pair_style, source_label, source_style, symbol_of
from verification.problem.line_profile import coordinate_of
from verification.problem.quantity import QUANTITIES
from verification.report.report_words import stated
from verification.report.tables.case_lookup import (
    contact_radius,
    difference,
    reference_source,
    scale,
    sources_with_profiles,
)
from verification.running.case_result import CaseResult
from verification.sources.source_record import Style
from verification.sources.source_registry import METHODS

MOST_FAILING = 6  # panels of comparisons that do not agree, besides the chosen ones
MOST = 9  # fewer where all agree: any other is drawn on the page itself, from its numbers
# What is looked at first, on the flat.
FIRST = (
    ("pressure", "surface"),
    ("sigma_xx", "surface"),
    ("sigma_xx", "axis"),
    ("sigma_xx", "interface 1, upper side"),
    ("sigma_xx", "interface 1, lower side"),
    ("sigma_xz", "interface 1, upper side"),
)
# Marks of single points, open, in units of the drawing; by the shapes of ``Style.marker``.
MARKS = {
    "o": "m-2.6 0a2.6 2.6 0 1 0 5.2 0a2.6 2.6 0 1 0-5.2 0z",
    "^": "m0-3.1l3 5.2h-6z",
    "s": "m-2.4-2.4h4.8v4.8h-4.8z",
    "+": "m-3 0h6m-3-3v6",
}


def case_figures(result: CaseResult) -> dict[str, Any] | None:
    """Panels of what does not agree, then of what is looked at first; None of a case without profiles.

    They have a legend for the curves, one for the differences, and a caption.
    """
    drawable = {(p.quantity, p.line) for p in result.profiles if p.line != "contact"}
    bad = dict.fromkeys((c.quantity, c.line) for c, v in result.verdicts if v.outcome is not Outcome.AGREES)
    failing = [place for place in bad if place in drawable][:MOST_FAILING]
    places = list(dict.fromkeys([*failing, *(place for place in FIRST if place in drawable)]))[:MOST]
    places = places[: len(places) // 3 * 3] if len(places) > 3 else places  # whole rows of three
    if not places:
        return None
    pairs = dict.fromkeys(pair for quantity, line in places for pair in _pairs(result, line, quantity))
    shown_by = {profile.source for profile in result.profiles if (profile.quantity, profile.line) in places}
    sources = [source for source in sources_with_profiles(result) if source in shown_by]
    base = max(sources, key=lambda source: source_style(source).width)
    shown = [(claim, verdict) for claim, verdict in result.verdicts if (claim.quantity, claim.line) in places]
    together = all(verdict.outcome is Outcome.AGREES for _, verdict in shown)
    return {
        "panels": [_panel(result, line, quantity) for quantity, line in places],
        "curves": [(swatch(source_style(s), marked=s != base), source_label(s)) for s in sources],
        "differences": [(swatch(pair_style(pair)), pair_label(pair)) for pair in pairs],
        "caption": stated(
            "panels", base=source_label(base), together=together, edge=any(claim.edge for claim, _ in shown)
        ),
    }


def swatch(style: Style, *, marked: bool = False) -> Markup:
    """A short piece of a line as the figures draw it, or its mark."""
    if marked:
        path = f'<path d="M18 5{MARKS[style.marker]}" class="point s-{style.colour}"/>'
    else:
        dash = " ".join(f"{length * style.width:.1f}" for length in style.dash) or "none"
        path = (
            f'<path d="M1 5h34" class="s-{style.colour}" stroke-width="{style.width}" '
            f'stroke-dasharray="{dash}" stroke-opacity="{style.opacity}"/>'
        )
    return Markup(f'<svg class="swatch" viewBox="0 0 36 10" aria-hidden="true">{path}</svg>')


def _pairs(result: CaseResult, line: str, quantity: str) -> list[tuple[str, str]]:
    """The claimed pairs that are drawn: methods with each other, sources with the reference source."""
    best = reference_source(result)
    claimed = [c.between for c, _ in result.verdicts if (c.quantity, c.line) == (quantity, line)]
    # not a method with another source than the reference
    return [pair for pair in dict.fromkeys(claimed) if best in pair or len(set(pair) & set(METHODS)) != 1]


def _panel(result: CaseResult, line: str, quantity: str) -> Panel:
    unit = QUANTITIES[quantity].scale if quantity in QUANTITIES else "p_h"
    a_h, size = scale(result.problem, "a_h"), scale(result.problem, unit)
    curves = [
        Curve(profile.position / a_h, profile.value / size, source_style(profile.source))
        for profile in result.profiles
        if (profile.quantity, profile.line) == (quantity, line)
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
        failed = verdict.outcome is not Outcome.AGREES
        worst = verdict.worst / a_h if failed and verdict.worst is not None else None
        vague = verdict.outcome is Outcome.INCONCLUSIVE
        differences.append(Difference(first.position / a_h, gap, uncertainty, pair_style(pair), worst, vague))
    cap = min((claim.cap for claim, _ in claims), default=None)
    edge = max((claim.edge for claim, _ in claims), default=0.0)
    figure = draw_curves(
        curves,
        differences,
        label=f"{symbol_of(quantity)} on {line} by every source, with differences, {result.name}",
        coordinate=f"{coordinate_of(line)} / a_h",
        cap=cap,
        unjudged=_unjudged(edge, contact_radius(result), a_h, curves),
        data=f'data-quantity="{escape(quantity)}" data-line="{escape(line)}"',
    )
    bad = [v for _, v in claims if v.outcome is not Outcome.AGREES]
    largest = max((v.difference for _, v in claims if v.difference is not None), default=None)
    note = f"largest difference {scientific(largest)}" if claims else "not compared"
    if bad:
        note = f"{len(bad)} of {len(claims)} do not agree, difference {scientific(largest)}"
    return Panel(f"{symbol_of(quantity)} / {unit}, {line}", figure, note, "fails" if bad else "")


def _unjudged(edge: float, a: float | None, a_h: float, curves: list[Curve]) -> list[tuple[float, float]]:
    if not edge or a is None or not curves:
        return []
    inner, outer = a * (1 - edge) / a_h, a * (1 + edge) / a_h
    low = min(float(np.min(curve.position, initial=0.0)) for curve in curves)
    high = max(float(np.max(curve.position, initial=0.0)) for curve in curves)
    return [span for span in ((-outer, -inner), (inner, outer)) if span[1] > low and span[0] < high]
