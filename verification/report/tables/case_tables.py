"""The tables of one case: contact, verdicts, uncertainty budget, run times."""

import textwrap
from collections.abc import Iterable, Mapping, Sequence
from functools import partial
from math import isfinite, isinf
from typing import Any

from verification.cases.solid_schema import LIMITS
from verification.desk.answer_stresses import Extreme
from verification.desk.layer_limits import Designed
from verification.judging.verdict import Claim, Outcome, Verdict
from verification.page.number_text import aligned, engineering, plain, scientific
from verification.page.page_parts import Cell, Table, Value, number, outcome_cell, row, table_of
from verification.page.source_labels import OUTCOMES, pair_label, row_css, source_label, symbol_of
from verification.problem.indenter_shape import SHAPES
from verification.problem.line_profile import coordinate_of
from verification.problem.point_answers import BALL, FLAT
from verification.problem.quantity import BALL_PEAKS, PEAKS, QUANTITIES, SCALARS, SLOPES, unit_of
from verification.report.report_words import stated
from verification.report.tables.case_lookup import INDENTERS, layers, scalar, scale
from verification.running.case_result import CaseResult, SourceResult

# A failed source fails every comparison; the list before the figures stays short.
MOST_FAILING = 6
NO_RESULT = Cell("no result", css="no-result")
_FACTS = {
    "pressure": ("uniform pressure q", "Pa"),
    "load_radius": ("radius of the disc a", "m"),
    "radius": ("sphere radius R", "m"),
    "load": ("load W", "N"),
    "friction": ("friction f", ""),
    "a_h": ("Hertz contact radius a_h", "m"),
    "p_h": ("Hertz peak pressure p_h", "Pa"),
    "delta_h": ("Hertz approach delta_h", "m"),
    "dundurs_beta": ("Dundurs' β of the surfaces", ""),
    "S_h": ("Hertz stiffness S_h", "N/m"),
}


def facts(problem: Mapping[str, Any]) -> list[tuple[str, str]]:
    """(name, value) of each parameter and each Hertz scale of a problem."""
    given = {"friction": 0.0, **problem}
    texts, found = _FACTS, []
    if indenter := given.get("indenter"):
        # all numbers but that of the lobes are lengths
        shape, numbers = indenter
        shown = [
            f"{name} = {plain(value) if name == 'lobes' else engineering(value, 'm')}"
            for name, value in zip(SHAPES[shape], numbers, strict=True)
        ]
        found = [("indenter", ", ".join([INDENTERS[shape], *shown]))]
        texts = _FACTS | {"radius": ("radius R of Hertz's scales", "m")}
    return found + [
        (text, engineering(given[name], unit) if unit else plain(given[name]))
        for name, (text, unit) in texts.items()
        if name in given
    ]


def layer_table(result: CaseResult, body: str = FLAT) -> Table:
    """The layers of a body from its surface inwards, in real units and against its bare substrate.

    Thicknesses are over a_h, or over the radius of a prescribed load. With names, residual stresses, limits
    where the case states any.
    """
    problem = result.problem
    length = "a" if "load_radius" in problem else "a_h"
    a_h = scale(problem, "load_radius" if length == "a" else "a_h")
    found, stated_of = layers(problem, body), _stated(result, body)
    rows = []
    for n, (E, nu, h) in enumerate(found):
        over = plain(h / a_h, 3) if a_h > 0 else "–"
        rows.append(
            row(
                "substrate" if n == len(found) - 1 else f"coating {n + 1}",
                Cell(engineering(E, "Pa"), E),
                Cell(plain(E / found[-1][0], 3), E),
                number(nu, plain),
                *(Cell("∞" if isinf(h) else text, h) for text in (engineering(h, "m"), over)),
                *(_stated_cell(values[n]) for values in stated_of.values()),
            )
        )
    caption = "Layers from the surface down."
    if body == BALL:
        caption = "Layers of the ball, from its surface inwards."
    return Table(caption, ["layer", "E", "E / E_s", "nu", "h", f"h / {length}", *stated_of], rows)


def _stated(result: CaseResult, body: str) -> dict[str, list[Any]]:
    """Statements of a case on each layer of a body beside its problem, by heads of columns."""
    known, count = result.stated, len(layers(result.problem, body))
    sublayers = [*(known.get("layers", {}).get(body) or [1] * (count - 1)), 1]
    coating = [i for i, n in enumerate(sublayers) for _ in range(n)]  # that each layer belongs to
    before, base = (f"{BALL}.", BALL) if body == BALL else ("", "substrate")
    places = [f"{before}coatings.{i}" for i in coating[: count - 1]] + [base]
    names, limits = known.get("names", {}).get(body, ()), known.get("limits", {})
    found: dict[str, list[Any]] = {
        "name": [names[i] or "" for i in coating] if any(names) else [],
        "residual stress": [*known.get("residual", {}).get(body, ()), 0.0],
    }
    found |= {name.replace("_", " "): [limits.get(f"{at}.{name}") for at in places] for name in LIMITS}
    return {head: values for head, values in found.items() if any(values)}


def _stated_cell(value: Any) -> Value:
    return value or "" if value is None or isinstance(value, str) else Cell(engineering(value, "Pa"), value)


def stress_table(result: CaseResult, found: Designed) -> Table:
    """The largest stresses of a case with its residual stresses, then how far each is from its strength."""
    limits = {(one.body, one.where, one.quantity): one for one in found.limits}
    a_h = scale(result.problem, "a_h")

    def used(at: Extreme) -> Value:
        one = limits.get((at.body, at.where, at.quantity))
        return "" if one is None else Cell(f"{one.utilisation:.0%} of its {one.of}; {one.begins}")

    return table_of(
        "By the semi-analytical method, with residual stresses.",
        found.extremes,
        [
            ("largest", lambda at: symbol_of(at.quantity)),
            ("place", lambda at: at.where if at.body == FLAT else f"{at.body}, {at.where}"),
            ("value", lambda at: Cell(engineering(at.value, "Pa", 4), at.value)),
            ("±", lambda at: Cell(engineering(at.uncertainty, "Pa", 1), at.uncertainty)),
            ("x / a_h", lambda at: number(at.x / a_h, "{:.3g}".format)),
            ("z / a_h", lambda at: number(at.z / a_h, "{:.3g}".format)),
            ("strength", used),
        ],
    )


def contact_tables(result: CaseResult) -> list[Table]:
    """The numbers of the contact, then of an elastic ball those of its own surface."""
    tables = [_contact_table(result, SCALARS + SLOPES + PEAKS, stated("contact_numbers"))]
    if layers(result.problem, BALL):
        tables.append(_contact_table(result, BALL_PEAKS, "The surface of the ball."))
    return [table for table in tables if table]


def _contact_table(result: CaseResult, quantities: Sequence[str], caption: str) -> Table:
    """Numbers of a contact, a column each: by every source, then the differences."""
    names = [q for q in quantities if any(scalar(result, q, s.source) for s in result.sources)]
    heads, columns = [], []
    for quantity in names:
        found = [scalar(result, quantity, source.source) for source in result.sources]
        unit, texts = aligned(found, unit_of(quantity))
        heads.append(f"{QUANTITIES[quantity].symbol} [{unit}]" if unit else QUANTITIES[quantity].symbol)
        columns.append([Cell(t, float(p[0])) if p else NO_RESULT for t, p in zip(texts, found, strict=True)])
    rows = [
        row(source_label(s.source), *(column[n] for column in columns), css="failed" if s.failure else "")
        for n, s in enumerate(result.sources)
    ]
    verdicts = {(c.quantity, c.between): v for c, v in result.verdicts if c.line == "contact"}
    for pair in dict.fromkeys(between for _, between in verdicts):
        judged = [verdicts.get((quantity, pair)) for quantity in names]
        gaps = [Cell("–") if v is None else _judged_cell(v, v.difference) for v in judged]
        rows.append(row(pair_label(pair), *gaps, css="gap"))
        rows.append(row("U of both", *(None if v is None else v.uncertainty for v in judged), css="bound"))
    return Table(caption, ["source", *heads], rows if names else [], css="numbers")


def _judged_cell(verdict: Verdict, value: float | None) -> Cell:
    """A difference; with the mark and the colour of its verdict where it does not agree."""
    style = OUTCOMES[verdict.outcome]
    if verdict.outcome is Outcome.AGREES:
        return number(value)
    return Cell(f"{style.mark} {scientific(value)}", value, f"verdict {style.css}", verdict.reason)


def comparison_table(compared: Sequence[tuple[Claim, Verdict]]) -> Table:
    """Largest difference and largest U of every pair of sources, a row for each quantity on each line."""
    verdicts = {(c.quantity, c.line, c.between): (c, v) for c, v in compared}
    pairs = list(dict.fromkeys(between for _, _, between in verdicts))
    rows = []
    for quantity, line in dict.fromkeys((quantity, line) for quantity, line, _ in verdicts):
        found = [verdicts.get((quantity, line, pair)) for pair in pairs]
        cap = next((one[0].cap for one in found if one), None)
        cells: list[Cell | str | float | None] = [line, number(cap, partial(scientific, digits=1))]
        for one in found:
            cells += [_judged_cell(one[1], one[1].difference), one[1].uncertainty] if one else ["", ""]
        rows.append(row(symbol_of(quantity), *cells))
    return Table(
        stated("compared"),
        ["quantity", "line", "cap on U", *["|A − B|", "U"] * len(pairs)],
        rows,
        [("", 3), *((pair_label(pair), 2) for pair in pairs)],
        "comparisons",
    )


def failing_table(compared: Sequence[tuple[Claim, Verdict]], a_h: float) -> Table:
    """The comparisons that do not agree, the worst first; ``MOST_FAILING`` of them."""
    bad = [item for item in compared if item[1].outcome is not Outcome.AGREES]
    more = f" The worst {MOST_FAILING} of {len(bad)}." if len(bad) > MOST_FAILING else ""

    def where(claim: Claim, verdict: Verdict) -> Cell:
        known = verdict.worst is not None and claim.line != "contact" and a_h
        text = f"{coordinate_of(claim.line)} = {plain((verdict.worst or 0.0) / a_h, 3)} a_h" if known else ""
        return Cell(text, verdict.worst)

    return table_of(
        f"Comparisons that do not agree.{more}",
        sorted(bad, key=lambda item: _badness(item[1]))[:MOST_FAILING],
        [
            ("verdict", lambda item: outcome_cell(item[1].outcome)),
            ("quantity", lambda item: Cell(symbol_of(item[0].quantity), note=item[0].why)),
            ("line", lambda item: item[0].line),
            ("between", lambda item: pair_label(item[0].between)),
            ("max |A − B|", lambda item: item[1].difference),
            ("max U", lambda item: item[1].uncertainty),
            ("cap", lambda item: item[0].cap),
            ("at", lambda item: where(*item)),
            ("reason", lambda item: Cell(item[1].reason, css="reason")),
        ],
        css="verdicts",
        row_css=lambda item: row_css(item[1].outcome),
    )


def _badness(verdict: Verdict) -> tuple[int, float]:
    margin = verdict.margin if verdict.margin is not None else 0.0
    return OUTCOMES[verdict.outcome].rank, margin if isfinite(margin) else 0.0


def budget_table(result: CaseResult) -> Table:
    """Uncertainty budget: a row for each numerical parameter of each method."""
    rows = []
    for source in result.sources:
        for quantity, name, value in source.budget:
            parts = [U for q, _, U in source.budget if q == quantity]
            largest = max(filter(isfinite, parts), default=0.0)
            dominant = "dominant" if value == largest > 0 and len(parts) > 1 else ""
            found = scalar(result, quantity, source.source)
            size = abs(found[0]) if found else scale(result.problem, "p_h")
            cells = [
                Cell(name, css=dominant),
                Cell(engineering(value, unit_of(quantity), 2), value),
                Cell(scientific(value / size if size else None), value),
                Cell("◀ dominates" if dominant else "", css="dominant"),
            ]
            rows.append(row(source_label(source.source), symbol_of(quantity), *cells))
    return Table(stated("budget"), ["source", "quantity", "parameter", "uncertainty", "relative", ""], rows)


def diagnostics_table(sources: Iterable[SourceResult]) -> Table:
    """Diagnostics of each source: iterations, residuals, unknowns."""
    rows = [
        row(source_label(source.source), name.replace("_", " "), _shown(value))
        for source in sources
        for name, value in source.diagnostics.items()
    ]
    return Table("Diagnostics reported by each source, in SI units.", ["source", "diagnostic", "value"], rows)


def _shown(value: Any) -> str:
    if isinstance(value, float):
        return plain(value)
    if isinstance(value, list | tuple):
        if len(value) > 6:
            return f"{len(value)} values, first {_shown(value[0])}, last {_shown(value[-1])}"
        return ", ".join(map(_shown, value))
    if isinstance(value, dict):
        return ", ".join(f"{key} {_shown(item)}" for key, item in value.items())
    return textwrap.shorten(str(value), 300)
