"""The report of a guest: which quantity is wrong, why, how it converges, what it did not answer."""

from collections import Counter
from collections.abc import Sequence
from itertools import zip_longest
from typing import Any

import numpy as np
from markupsafe import Markup

from verification.guests.case_exam import profiles_of
from verification.guests.exam_subjects import exact_profile, exact_radius, reference_of
from verification.guests.examination import Examined
from verification.judging.verdict import Claim, Outcome, Verdict
from verification.page.figures import can_draw
from verification.page.html_page import render_sections
from verification.page.number_text import plain, seconds
from verification.page.page_parts import (
    Cell,
    Gallery,
    Panel,
    Part,
    Row,
    Section,
    Table,
    number,
    outcome_cell,
    row,
    tally,
    words,
)
from verification.page.plots import DASHES, DOTS, MIXED, Curve, Difference, Plot, Trail, draw_curves, panels
from verification.page.source_labels import row_css
from verification.problem.line_profile import coordinate_of
from verification.problem.quantity import QUANTITIES
from verification.running.case_result import CaseResult, RunInfo
from verification.sources.source_record import Style

WORST_FIRST = (
    Outcome.DISAGREES,
    Outcome.NO_RESULT,
    Outcome.INCONCLUSIVE,
    Outcome.AGREES,
    Outcome.UNSUPPORTED,
)
MOST_FIGURES = 12
ROUNDING = 1e-12
MOST_REASONS = 2
GUEST, EXACT = Style("semi"), Style("exact", (), 5.0, 0.35)
DASHED = ((), DASHES, DOTS, MIXED)
OWN = ("semi", "fem")


def page(found: Examined, info: RunInfo) -> str:
    """The whole page as HTML."""
    guest, total = found.guest, found.total
    facts = [
        ("guest", f"{guest.name} {guest.version or ''}".strip()),
        ("way in", guest.callable or " ".join(guest.command or ()) or f"files in {guest.results}"),
        ("uncertainty", _uncertainty(found)),
        ("left out", f"|r - a| < {guest.edge:g} a" if guest.edge else "nothing"),
        *(("note", note) for note in guest.notes),
        ("command", info.command),
        ("machine", info.machine),
    ]
    sections = [_quantities(found), _cases(found), _failures(found), _convergence(found), _missing(found)]
    return render_sections(
        "coatcheck guest",
        f"{guest.name}: {total[Outcome.AGREES]} of {found.answered} comparisons agree, "
        f"{total[Outcome.UNSUPPORTED]} are not supported.",
        facts,
        [section for section in sections if section is not None],
    )


def badge(found: Examined) -> str:
    """A badge with the count of comparisons that agree, as SVG."""
    agree, answered = found.total[Outcome.AGREES], found.answered
    text = f"{agree} of {answered} agree"
    colour = "#2e7d4f" if answered and agree == answered else "#b3261e"
    left, right = 74, 12 + 7 * len(text)
    return Markup(
        '<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="20" role="img" '
        'aria-label="coatcheck: {text}"><rect width="{left}" height="20" fill="#444"/>'
        '<rect x="{left}" width="{right}" height="20" fill="{colour}"/>'
        '<g fill="#fff" font-family="Verdana,sans-serif" font-size="11"><text x="6" y="14">'
        'coatcheck</text><text x="{at}" y="14">{text}</text></g></svg>\n'
    ).format(width=left + right, left=left, right=right, colour=colour, at=left + 6, text=text)


def summary(found: Examined) -> dict[str, Any]:
    """The examination in a few numbers, for a table of several guests.

    differences : the largest of each kind of quantity, by the name of a scalar.   seconds : shortest, longest
    answer at the finest level.   memory : the largest [bytes], None where it is not known.   errors : the
    largest of each kind over its line's largest value, at each level, coarse to fine.
    """
    guest, differences = found.guest, dict[str, float]()
    for _, claim, verdict in found.comparisons:
        if verdict.difference is not None:
            name = _kind(claim.quantity)
            differences[name] = max(differences.get(name, 0.0), verdict.difference)
    judged = [r for r in found.results if any(v.difference is not None for _, v in r.verdicts)]
    own = [s for r in judged for s in r.sources if s.source == guest.name and s.seconds]
    times = [source.seconds for source in own]
    return {
        "guest": guest.name,
        "version": guest.version,
        "cases": len(own),
        "levels": f"{guest.parameter} {', '.join(f'{v:g}' for v in guest.levels)}" if guest.levels else "",
        "agree": found.total[Outcome.AGREES],
        "answered": found.answered,
        "differences": differences,
        "errors": _falling(found),
        "notes": guest.notes,
        "seconds": [min(times, default=0.0), max(times, default=0.0)],
        "memory": max((s.diagnostics["memory"] for s in own if "memory" in s.diagnostics), default=None),
    }


def _kind(quantity: str) -> str:
    """The kind of a quantity; a number of the contact is one by itself."""
    kind = QUANTITIES[quantity].kind
    return quantity if kind == "scalar" else kind


def _falling(found: Examined) -> dict[str, list[float]]:
    """Largest error of each kind of quantity at each level, over all cases."""
    largest: dict[str, list[float]] = {}
    studied = [one for one in found.results if found.guest.levels and one.name in found.replies]
    for quantity, errors in (pair for one in studied for pair in _errors(found, one).items()):
        name = _kind(quantity)
        largest[name] = [max(pair) for pair in zip(largest.get(name, errors), errors, strict=True)]
    return largest


def _uncertainty(found: Examined) -> str:
    guest = found.guest
    if guest.levels:
        return f"from its refinement study, {guest.parameter} = {', '.join(f'{v:g}' for v in guest.levels)}"
    own = [p for result in found.results for p in result.profiles if p.source == guest.name]
    if any(p.uncertainty is not None for p in own):
        return "as the guest states it"
    return f"none; differences are compared with the claimed {guest.claim:g}" if guest.claim else "none"


def _quantities(found: Examined) -> Section:
    """A row for each quantity, the worst first, with its likely reason: what to look at."""
    reasons = [
        (next(iter(by.values())).message, {quantity for cause in by.values() for quantity, _ in cause.places})
        for by in found.causes.values()
    ]
    rows: list[tuple[int, float, Row]] = []
    for quantity in dict.fromkeys(claim.quantity for _, claim, _ in found.comparisons):
        of = [one for one in found.comparisons if one[1].quantity == quantity]
        if all(v.outcome is Outcome.UNSUPPORTED for _, _, v in of):
            continue
        gap, where = max((v.difference or 0.0, f"{r.title}, {c.line}") for r, c, v in of)
        why = [message for message, quantities in reasons if quantity in quantities]
        reason = [words("; ".join(why[:MOST_REASONS]))] if reasons else []
        cells = (Cell(quantity, note=QUANTITIES[quantity].meaning), *reason, *_counted([v for *_, v in of]))
        worst = _worst([v for *_, v in of])
        rows.append((WORST_FIRST.index(worst), -gap, row(*cells, words(where), css=row_css(worst))))
    rows.sort(key=lambda item: item[:2])
    heads = ["quantity", *(["likely reason"] if reasons else []), *COUNTED, "where"]
    caption = (
        "The largest difference over all cases and lines; relative to the value (p0, a, approach), else to "
        "the smaller of p_h and p0."
    )
    table = Table(caption, heads, [line for _, _, line in rows])
    return Section("quantities", "Which quantity is wrong?", [Part("", [table])])


COUNTED = ("worst", "agree", "largest difference")


def _worst(verdicts: Sequence[Verdict]) -> Outcome:
    return min((v.outcome for v in verdicts), key=WORST_FIRST.index)


def _counted(verdicts: Sequence[Verdict]) -> list[Cell]:
    """Cells of ``COUNTED`` about the comparisons that the guest supports."""
    answered = [v for v in verdicts if v.outcome is not Outcome.UNSUPPORTED]
    agree = sum(v.outcome is Outcome.AGREES for v in answered)
    gap = max((v.difference for v in answered if v.difference is not None), default=None)
    return [outcome_cell(_worst(answered)), tally(agree, len(answered)), number(gap)]


def _cases(found: Examined) -> Section:
    """A row for each case with an answer: worst verdict, largest difference, time, memory."""
    rows: list[Row] = []
    for result in found.results:
        verdicts = [v for _, v in result.verdicts]
        if all(v.outcome is Outcome.UNSUPPORTED for v in verdicts):
            continue
        mine = [s for s in result.sources if s.source == found.guest.name and s.seconds]
        memory = mine[0].diagnostics.get("memory") if mine else None
        taken = number(mine[0].seconds if mine else None, seconds)
        shown = number(memory and memory / 1e6, "{:.0f} MB".format)
        rows.append(row(result.title, *_counted(verdicts), taken, shown))
    caption = "Comparisons with the exact reference by case; time and peak memory at the finest level."
    table = Table(caption, ["case", *COUNTED, "time", "memory"], rows)
    lead = f"{len(rows)} of {len(found.results)} cases; the others are not supported."
    return Section("cases", "Cases", [Part(lead if len(rows) < len(found.results) else "", [table])])


def _failures(found: Examined) -> Section | None:
    """Figures of the error along the line, of the comparisons that are furthest off."""
    bad = [one for one in found.comparisons if one[2].outcome in (Outcome.DISAGREES, Outcome.INCONCLUSIVE)]
    bad.sort(key=lambda item: -(item[2].difference or 0.0))
    failures = sorted({f"{r.title}: {s.failure}" for r in found.results for s in r.sources if s.failure})
    if not bad and not failures:
        return None
    by: dict[str, list[tuple[CaseResult, Claim, Verdict]]] = {}
    for one in bad:
        if one[1].line != "contact":
            by.setdefault(one[1].quantity, []).append(one)
    # Every quantity once before one is shown again.
    ranked = [one for turn in zip_longest(*by.values()) for one in turn if one is not None]
    figures = [_figure(found.guest.name, *one) for one in ranked[:MOST_FIGURES]] if can_draw() else []
    parts = [] if can_draw() else [Part("Figures are left out: they need matplotlib, of the extra report.")]
    if figures:
        legend = [(Markup('<span class="s-semi">—</span>'), "guest"), (Markup("<span>━</span>"), "exact")]
        caption = (
            "Above the values of guest and exact reference over the scale, below their difference with its "
            "uncertainty on a logarithmic scale; a ring marks the deciding point, a dashed line the claim."
        )
        text = "Values along the line: of each quantity the largest difference, then the others."
        parts.append(Part(text, gallery=Gallery(legend, figures, caption)))
    rows = [
        row(
            result.title,
            outcome_cell(verdict.outcome),
            claim.quantity,
            claim.line,
            Cell(_ratio(found.guest.name, result, claim)),
            number(verdict.difference),
            number(verdict.uncertainty),
            number(claim.cap),
            words(verdict.reason),
            css=row_css(verdict.outcome),
        )
        for result, claim, verdict in bad
    ]
    heads = ["case", "verdict", "quantity", "line", "guest / exact", "difference", "U", "claim", "reason"]
    parts.append(Part("", [Table("Every comparison that does not agree.", heads, rows)]))
    return Section("failures", "What does not agree", parts, failures)


def _ratio(guest: str, result: CaseResult, claim: Claim) -> str:
    """Least-squares factor between the guest and the exact values; 1 where only the pattern differs."""
    mine = result.profile_of.get((claim.quantity, claim.line, guest))
    exact = exact_profile(result, claim.quantity, claim.line)
    if mine is None or exact is None or not np.isfinite(mine.value).all() or not exact.value.any():
        return "–"
    return plain(float(mine.value @ exact.value / (exact.value @ exact.value)), 6)


def _figure(guest: str, result: CaseResult, claim: Claim, verdict: Verdict) -> Panel:
    mine, exact = (
        result.profile_of[claim.quantity, claim.line, s] for s in (guest, reference_of(result.problem))
    )
    a = exact_radius(result)
    top = float(np.abs(exact.value).max()) or 1.0
    x = exact.position / a
    difference = np.abs(mine.value - exact.value) / top
    uncertainty = None if mine.uncertainty is None else mine.uncertainty / top
    worst = None if verdict.worst is None else verdict.worst / a
    figure = draw_curves(
        [Curve(x, exact.value / top, EXACT), Curve(x, mine.value / top, GUEST)],
        [Difference(x, difference, uncertainty, GUEST, worst, verdict.outcome is Outcome.INCONCLUSIVE)],
        label=f"{claim.quantity} on {claim.line} of {result.title}",
        coordinate=f"{coordinate_of(claim.line)} / a",
        cap=claim.cap,
        unjudged=[(1 - claim.edge, 1 + claim.edge)] if claim.edge else (),
    )
    return Panel(f"{claim.quantity}, {claim.line}", figure, result.title, "fails")


def _convergence(found: Examined) -> Section | None:
    """Error against the exact reference over the levels of the refinement study."""
    guest = found.guest
    if not guest.levels:
        return None
    plots, rows = [], []
    errors = [(one.title, _errors(found, one)) for one in found.results if one.name in found.replies]
    quantities = dict.fromkeys(name for _, by in errors for name in by)
    for quantity in quantities:
        trails = []
        for n, (title, by) in enumerate(errors):
            if quantity not in by:
                continue
            style = Style(OWN[n % 2], DASHED[n // 2 % 4])
            order = _order(guest.levels, by[quantity])
            trails.append(Trail(guest.levels, by[quantity], style, "" if order is None else f"{order:.1f}"))
            rows.append(row(title, quantity, *(number(e) for e in by[quantity]), number(order, plain)))
        label = f"error of {quantity} over {guest.parameter}"
        plots.append(Plot(quantity, label, "error, order at the end", guest.parameter, guest.levels, trails))
    heads = ["case", "quantity", *(f"{guest.parameter} = {v:g}" for v in guest.levels), "order"]
    table = Table(
        "Largest error against the exact reference, order observed over the last two levels.", heads, rows
    )
    caption = "A curve for each case; the observed order is written at its end."
    gallery = Gallery([], panels(plots), caption) if can_draw() else None
    return Section("convergence", "Convergence against the exact solution", [Part("", [table], gallery)])


def _errors(found: Examined, result: CaseResult) -> dict[str, tuple[float, ...]]:
    """Largest error of each quantity at each level over the case's largest value of its kind.

    Of a surface line outside the zone left out.
    """
    guest, exact, a = found.guest, result.profile_of, exact_radius(result)
    errors: dict[str, list[float]] = {}
    scales: dict[str, float] = {}
    for p in result.profiles:
        if p.source == reference_of(result.problem) and p.value.size:
            scales[_kind(p.quantity)] = max(scales.get(_kind(p.quantity), 0.0), float(np.abs(p.value).max()))
    for reply in found.replies[result.name]:
        largest: dict[str, float] = {}
        for p in profiles_of(reply.answer, result, guest):
            true = exact[p.quantity, p.line, reference_of(result.problem)]
            judged = np.abs(np.abs(true.position) - a) >= guest.edge * a
            scale = scales[_kind(p.quantity)]
            gap = np.abs(p.value - true.value)[judged | (p.line == "contact")]
            if scale and gap.size:
                largest[p.quantity] = max(largest.get(p.quantity, 0.0), float(gap.max()) / scale)
        for quantity, value in largest.items():
            errors.setdefault(quantity, []).append(value)
    return {q: tuple(values) for q, values in errors.items() if len(values) == len(guest.levels)}


def _order(levels: Sequence[float], errors: Sequence[float]) -> float | None:
    """Observed over the last two levels; None where the finest error is rounding."""
    first, last = errors[-2:]
    ratio = max(levels[-1] / levels[-2], levels[-2] / levels[-1])
    return float(np.log(first / last) / np.log(ratio)) if first > 0 and last > ROUNDING else None


def _missing(found: Examined) -> Section | None:
    """Questions that the guest did not answer, with the reason."""
    missing = (one for one in found.comparisons if one[2].outcome is Outcome.UNSUPPORTED)
    reasons = Counter((verdict.reason, claim.quantity) for _, claim, verdict in missing)
    if not reasons:
        return None
    by: dict[str, list[str]] = {}
    for (reason, quantity), count in reasons.items():
        by.setdefault(reason, []).append(f"{quantity} ({count})")
    rows = [row(words(reason), words(", ".join(names))) for reason, names in by.items()]
    table = Table("Quantities with the number of comparisons.", ["reason", "not answered"], rows)
    known = [row(name, words(reason)) for name, reason in found.known]
    parts = [Part("", [table])]
    if known:
        parts.append(Part("", [Table("Known failures.", ["comparison", "reason"], known)]))
    return Section("missing", "What it did not answer", parts)
