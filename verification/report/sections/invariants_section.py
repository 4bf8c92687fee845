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
    return Table(
        stated("invariant_rows"),
        ["invariant", "condition", *(source_label(source) for source in sources)],
        rows,
        css="verdicts",
    )


def _share_cell(one: Invariant | None) -> Cell:
    if one is None:
        return Cell("")
    if one.outcome is Outcome.AGREES:
        return number(one.share, _percent)
    style = OUTCOMES[one.outcome]
    note = f"residual {scientific(one.value)}, bound {scientific(one.bound)}"
    return Cell(f"{style.mark} {_percent(one.share)}", one.share, f"verdict {style.css}", note)


def section(results: Sequence[CaseResult], anchors: Mapping[CaseResult, str]) -> Section | None:
    """Every invariant over all cases, by source; None where no case has any."""
    rows = [(result, one) for result in results for one in result.invariants]
    if not rows:
        return None
    sources = list(dict.fromkeys(one.source for _, one in rows))
    families: dict[str, dict[str, list[tuple[CaseResult, Invariant]]]] = {}
    for result, one in rows:
        # the name of the invariant without the number of the layer or interface
        family = families.setdefault(_NUMBERED.sub("", one.name), {})
        family.setdefault(one.source, []).append((result, one))
    lines = [
        row(name, *(cell for source in sources for cell in _family_cells(family.get(source, []), anchors)))
        for name, family in families.items()
    ]
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


def _badness(one: Invariant) -> tuple[int, float]:
    return OUTCOMES[one.outcome].rank, -(one.share or 0.0)


def _percent(share: float | None) -> str:
    if share is None:
        return "–"
    if share < 1e-4:
        return "< 0.01 %"
    return f"{100 * share:.0f} %" if share >= 0.1 else f"{plain(100 * share, 2)} %"
