"""Invariants of the solutions: the rows of a case, all invariants over all cases."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import replace

from verification.judging.invariants import Invariant
from verification.judging.verdict import Outcome
from verification.page.number_text import plain, scientific
from verification.page.page_parts import Cell, Part, Section, Table, number, row, tally
from verification.page.source_labels import OUTCOMES, row_css, source_label
from verification.report.report_words import stated
from verification.running.case_result import CaseResult

_NUMBERED = re.compile(r", (?:coating|interface|layer) \d+$|, substrate$")


def invariant_table(found: Sequence[Invariant]) -> Table | None:
    """The invariants of a case, or some of them, a row each; None where there are none."""
    if not found:
        return None
    sources = list(dict.fromkeys(one.source for one in found))
    rows = []
    for name in dict.fromkeys(one.name for one in sorted(found, key=_badness)):
        mine = {one.source: one for one in found if one.name == name}
        first = min(mine.values(), key=_badness)
        cells = [_share_cell(mine.get(source)) for source in sources]
        rows.append(row(name, Cell(first.message, css="reason"), *cells, css=row_css(first.outcome)))
    heads = ["invariant", "condition", *map(source_label, sources)]
    return Table(stated("invariant_rows"), heads, rows, css="verdicts")


def _share_cell(one: Invariant | None) -> Cell:
    if one is None or one.outcome is Outcome.AGREES:
        return Cell("") if one is None else number(one.share, _percent)
    style = OUTCOMES[one.outcome]
    note = f"residual {scientific(one.value)}, bound {scientific(one.bound)}"
    return Cell(f"{style.mark} {_percent(one.share)}", one.share, f"verdict {style.css}", note)


def section(results: Sequence[CaseResult], anchors: Mapping[CaseResult, str]) -> Section | None:
    """Every invariant over all cases, by source; None where no case has any."""
    found = [(result, one) for result in results for one in result.invariants]
    if not found:
        return None
    sources = list(dict.fromkeys(one.source for _, one in found))
    # the names of the invariants without the number of the layer or interface
    names = dict.fromkeys(_NUMBERED.sub("", one.name) for _, one in found)
    rows = []
    for name in names:
        mine = [(result, one) for result, one in found if _NUMBERED.sub("", one.name) == name]
        rows.append(
            row(name, *(c for s in sources for c in _cells([m for m in mine if m[1].source == s], anchors)))
        )
    held = sum(one.outcome is Outcome.AGREES for _, one in found)
    tightest = max((one for _, one in found), key=lambda one: one.share or 0.0)
    text = stated(
        "all_invariants",
        held=held,
        total=len(found),
        cases=len(results),
        tightest=tightest.name,
        source=source_label(tightest.source),
        share=_percent(tightest.share),
    )
    heads = ["invariant", *["hold", "residual", "share"] * len(sources)]
    groups = [("", 1), *((source_label(source), 3) for source in sources)]
    table = Table(stated("invariants"), heads, rows, groups, "overview")
    return Section("invariants", "Invariants of every solution", [Part(text, [table])])


def _cells(found: Sequence[tuple[CaseResult, Invariant]], anchors: Mapping[CaseResult, str]) -> list[Cell]:
    if not found:
        return [Cell("", css="nothing")] * 3
    case, worst = min(found, key=lambda item: _badness(item[1]))
    held = sum(one.outcome is Outcome.AGREES for _, one in found)
    largest = max((one.value for _, one in found if one.value is not None), default=None)
    shown = tally(held, len(found), f"flag {OUTCOMES[worst.outcome].css}")
    href = f"#{anchors[case]}-invariants"
    return [replace(shown, note=worst.message, href=href), number(largest), number(worst.share, _percent)]


def _badness(one: Invariant) -> tuple[int, float]:
    return OUTCOMES[one.outcome].rank, -(one.share or 0.0)


def _percent(share: float | None) -> str:
    if share is None:
        return "–"
    if share < 1e-4:
        return "< 0.01 %"
    return f"{100 * share:.0f} %" if share >= 0.1 else f"{plain(100 * share, 2)} %"
