"""The figures of a case: one panel for each quantity on each line."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from markupsafe import Markup, escape

from verification.judging.verdict import Claim, Outcome
from verification.page.number_text import scientific
from verification.page.page_parts import Panel
from verification.page.source_labels import pair_label, pair_style, source_label, source_style, symbol_of
from verification.page.svg_curves import Curve, Difference, draw
from verification.page.svg_plot import MARKS
from verification.problem.line_profile import ON_BALL, coordinate_of
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
MOST = 9
# What is looked at first, on the flat.
FIRST = (
    ("pressure", "surface"),
    ("sigma_xx", "surface"),
    ("sigma_xx", "axis"),
    ("sigma_xx", "interface 1, upper side"),
    ("sigma_xx", "interface 1, lower side"),
    ("sigma_xz", "interface 1, upper side"),
)
CHOSEN = (
    *FIRST,
    ("sigma_zz", "axis"),
    ("sigma_xx", f"{ON_BALL}surface"),
    ("u_z", "oblique surface"),
)


@dataclass(frozen=True)
class CaseFigures:
    """The panels of one case, with a legend each for the curves and for the differences."""

    panels: tuple[Panel, ...]
    curves: tuple[tuple[Markup, str], ...]
    differences: tuple[tuple[Markup, str], ...]
    caption: str


def case_figures(result: CaseResult) -> CaseFigures | None:
    """Panels of what does not agree, then of what is looked at first; None of a case without profiles."""
    drawable = {(p.quantity, p.line) for p in result.profiles if p.line != "contact"}
    bad = [
        (c.quantity, c.line)
        for c, v in result.verdicts
        if v.outcome is not Outcome.AGREES and (c.quantity, c.line) in drawable
    ]
    chosen = [place for place in CHOSEN if place in drawable]
    places = list(dict.fromkeys([*list(dict.fromkeys(bad))[:MOST_FAILING], *chosen]))
    places = places[: max(MOST, MOST_FAILING)]
    places = places[: len(places) // 3 * 3] if len(places) > 3 else places  # whole rows of three
    if not places:
        return None
    pairs = list(dict.fromkeys(pair for quantity, line in places for pair in _pairs(result, line, quantity)))
    sources = [s for s in sources_with_profiles(result) if any(p.source == s for p in result.profiles)]
    base = next((s for s in sources if source_style(s).width > 3), None)
    return CaseFigures(
        tuple(_panel(result, line, quantity) for quantity, line in places),
        tuple((swatch(source_style(s), marked=s != base), source_label(s)) for s in sources),
        tuple((swatch(pair_style(pair)), pair_label(pair)) for pair in pairs),
        _caption(result, places),
    )


def swatch(style: Style, *, marked: bool = False) -> Markup:
    """A short piece of a line as the figures draw it, or its mark."""
    if marked:
        return Markup(
            '<svg class="swatch" viewBox="0 0 36 10" aria-hidden="true">'
            '<path d="M18 5{}" class="point s-{}"/></svg>'
        ).format(MARKS[style.marker], style.colour)
    dash = " ".join(f"{length * style.width:.1f}" for length in style.dash)
    return Markup(
        '<svg class="swatch" viewBox="0 0 36 10" aria-hidden="true"><path d="M1 5h34" class="s-{}" '
        'stroke-width="{}" stroke-dasharray="{}" stroke-opacity="{}"/></svg>'
    ).format(style.colour, style.width, dash or "none", style.opacity)


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
    a_h = scale(result, "a_h")
    unit = QUANTITIES[quantity].scale if quantity in QUANTITIES else "p_h"
    curves = [
        Curve(profile.position / a_h, profile.value / scale(result, unit), source_style(profile.source))
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
        failed = verdict.outcome is not Outcome.AGREES and verdict.worst is not None
        worst = verdict.worst / a_h if failed and verdict.worst is not None else None
        vague = verdict.outcome is Outcome.INCONCLUSIVE
        differences.append(Difference(first.position / a_h, gap, uncertainty, pair_style(pair), worst, vague))
    cap = min((claim.cap for claim, _ in claims), default=None)
    zones = _unjudged(result, [claim for claim, _ in claims], curves)
    figure = draw(
        curves,
        differences,
        label=f"{symbol_of(quantity)} on {line} by every source, with differences",
        coordinate=f"{coordinate_of(line)} / a_h",
        cap=cap,
        unjudged=zones,
        data=f'data-quantity="{escape(quantity)}" data-line="{escape(line)}"',
    )
    bad = [(c, v) for c, v in claims if v.outcome is not Outcome.AGREES]
    largest = max((v.difference for _, v in claims if v.difference is not None), default=None)
    note = f"largest difference {scientific(largest)}"
    if bad:
        note = f"{len(bad)} of {len(claims)} do not agree, difference {scientific(largest)}"
    title = f"{symbol_of(quantity)} / {unit}, {line}"
    return Panel(title, figure, note if claims else "not compared", "fails" if bad else "")


def _unjudged(result: CaseResult, claims: list[Claim], curves: list[Curve]) -> list[tuple[float, float]]:
    edge = max((claim.edge for claim in claims), default=0.0)
    a, a_h = contact_radius(result), scale(result, "a_h")
    if not edge or a is None or not curves:
        return []
    inner, outer = a * (1 - edge) / a_h, a * (1 + edge) / a_h
    low = min(float(np.min(curve.position, initial=0.0)) for curve in curves)
    high = max(float(np.max(curve.position, initial=0.0)) for curve in curves)
    return [span for span in ((-outer, -inner), (inner, outer)) if span[1] > low and span[0] < high]


def _caption(result: CaseResult, places: Sequence[tuple[str, str]]) -> str:
    """What to see in the panels."""
    verdicts = [v for c, v in result.verdicts if (c.quantity, c.line) in places]
    together = all(v.outcome is Outcome.AGREES for v in verdicts)
    edge = any(claim.edge for claim, _ in result.verdicts if (claim.quantity, claim.line) in places)
    return stated("panels", together=together, edge=edge)
