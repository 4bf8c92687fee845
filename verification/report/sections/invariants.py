"""Invariants of the solutions: the rows of a case, all invariants over all cases."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial

from verification.judging.invariants import Invariant
from verification.judging.verdict import Outcome
from verification.report.material import Material
from verification.report.tables.cells import Cell, Part, Section, Table, number, row, tally
from verification.report.tables.labels import OUTCOMES, row_css, source_label
from verification.report.tables.matrix import outcome_cell
from verification.report.tables.numbers import plain, scientific
from verification.running.result import CaseResult

_NUMBERED = re.compile(r", (?:coating|interface|layer) \d+$|, substrate$")


def invariant_table(found: Sequence[Invariant]) -> Table | None:
    """The invariants of a case, or some of them, the worst first; None where there are none."""
    if not found:
        return None
    rows = [
        row(
            outcome_cell(one.outcome),
            one.name,
            source_label(one.source),
            Cell(one.message, css="reason"),
            number(one.value),
            number(one.bound),
            number(one.margin, partial(scientific, sign=True)),
            number(one.share, _percent),
            css=row_css(one.outcome),
        )
        for one in sorted(found, key=_badness)
    ]
    return Table(
        "Conditions that a solution satisfies by itself. Residual and bound at the point where the "
        "residual takes the largest share of its bound; the bound follows from the uncertainty stated there, "
        "the error of the differences or quadrature, and rounding.",
        ["verdict", "invariant", "source", "condition", "residual", "bound", "margin", "share"],
        rows,
        css="verdicts",
    )


def invariant_cell(result: CaseResult, href: str) -> Cell:
    """The invariants of a case in one cell of the verdict matrix: the worst outcome, how many hold."""
    found = result.invariants
    if not found:
        return Cell("", None, "nothing", "no invariant was evaluated")
    worst = min(found, key=_badness)
    style = OUTCOMES[worst.outcome]
    held = sum(one.outcome is Outcome.AGREES for one in found)
    note = f"{held} of {len(found)} hold; {worst.name} of {source_label(worst.source)}: {worst.message}"
    text = f"{style.letter} {held}" if held == len(found) else f"{style.letter} {held}/{len(found)}"
    return Cell(text, held / len(found), f"verdict {style.css}", note, href)


def section(material: Material) -> Section | None:
    """Every invariant over all cases, by source; None where no case has any."""
    results, anchors = material.contacts, material.anchors
    rows = [(result, one) for result in results for one in result.invariants]
    if not rows:
        return None
    sources = list(dict.fromkeys(one.source for _, one in rows))
    names = list(dict.fromkeys(_family(one) for _, one in rows))
    lines = []
    for name in names:
        cells = []
        for source in sources:
            found = [(n, one) for n, one in rows if (_family(one), one.source) == (name, source)]
            cells += _family_cells(found, anchors)
        lines.append(row(name, *cells))
    held = sum(one.outcome is Outcome.AGREES for _, one in rows)
    tightest = max((one for _, one in rows), key=lambda one: one.share or 0.0)
    text = (
        f"{held} of {len(rows)} invariants hold over {len(results)} cases. The closest to its bound is "
        f"{tightest.name} of {source_label(tightest.source)}, at {_percent(tightest.share)} of it."
    )
    table = Table(
        "How often each invariant holds, its largest residual, and the largest ratio of a residual to its "
        "bound: beyond 100 % the invariant is violated.",
        ["invariant", *["hold", "residual", "share"] * len(sources)],
        lines,
        [("", 1), *((source_label(source), 3) for source in sources)],
        "overview",
    )
    return Section("invariants", "Invariants of every solution", [Part(text, [table])])


def _family_cells(
    found: Sequence[tuple[CaseResult, Invariant]], anchors: Mapping[CaseResult, str]
) -> list[Cell]:
    if not found:
        return [Cell("", css="nothing")] * 3
    case, worst = min(found, key=lambda item: _badness(item[1]))
    held = sum(one.outcome is Outcome.AGREES for _, one in found)
    largest = max((one.value for _, one in found if one.value is not None), default=None)
    css = f"flag {OUTCOMES[worst.outcome].css}"
    href = f"#{anchors[case]}-invariants"
    return [
        replace(tally(held, len(found), css), note=worst.message, href=href),
        number(largest),
        number(worst.share, _percent),
    ]


def _family(one: Invariant) -> str:
    """The name of the invariant without the number of the layer or interface."""
    return _NUMBERED.sub("", one.name)


def _badness(one: Invariant) -> tuple[int, float]:
    return OUTCOMES[one.outcome].rank, -(one.share or 0.0)


def _percent(share: float | None) -> str:
    if share is None:
        return "–"
    if share < 1e-4:
        return "< 0.01 %"
    return f"{100 * share:.0f} %" if share >= 0.1 else f"{plain(100 * share, 2)} %"
