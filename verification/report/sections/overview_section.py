"""All cases in one table: verdict, counts, largest difference, seconds of every source."""

from verification.judging.verdict import Outcome
from verification.page.number_text import seconds
from verification.page.page_parts import Cell, Part, Section, Table, number, outcome_cell, row, tally
from verification.page.source_labels import source_label, symbol_of
from verification.regression.baseline_section import state_cell
from verification.report.report_material import Material
from verification.report.tables.case_lookup import case_cell
from verification.running.case_result import SourceResult


def section(material: Material) -> Section | None:
    """Every case with its verdicts, largest difference, seconds of its sources; None without a case."""
    results = material.results
    if not results:
        return None
    found = material.evidence.baseline
    states = {one.name: state_cell(one) for one in found.cases} if found else {}
    rows = []
    for result in results:
        agreeing = sum(v.outcome is Outcome.AGREES for _, v in result.verdicts)
        holding = sum(one.outcome is Outcome.AGREES for one in result.invariants)
        gaps = [(v.difference, c) for c, v in result.verdicts if v.difference is not None]
        gap, claim = max(gaps, key=lambda pair: pair[0], default=(None, None))
        rows.append(
            row(
                case_cell(result, f"#{material.anchors[result]}"),
                outcome_cell(result.outcome),
                tally(agreeing, len(result.verdicts)) if result.verdicts else Cell("none", 0.0),
                tally(holding, len(result.invariants)) if result.invariants else Cell("–"),
                *([states.get(result.name, Cell("not in it"))] if states else []),
                number(gap),
                Cell("" if claim is None else f"{symbol_of(claim.quantity)}, {claim.line}"),
            )
        )
    heads = ["case", "verdict", "comparisons", "invariants", *(["baseline"] if states else [])]
    table = Table("A column head sorts the table.", [*heads, "largest |A − B|", "in"], rows, css="all-cases")
    return Section("cases", "All cases", [Part("", [table]), _times(material)])


def _times(material: Material) -> Part:
    # A case whose process died as a whole has its time in the last column.
    found = [s.source for result in material.results for s in result.sources if s.source != "case"]
    names = list(dict.fromkeys(found))
    rows = []
    for result in material.results:
        times = {source.source: source for source in result.sources}
        cells = [_time_cell(times.get(name)) for name in names]
        head = case_cell(result, f"#{material.anchors[result]}")
        rows.append(row(head, *cells, number(result.seconds, seconds)))
    table = Table(
        "Wall-clock time of each source with its uncertainty estimate; the case in total.",
        ["case", *(source_label(name) for name in names), "in total"],
        rows,
    )
    return Part("", [table], folded="Times")


def _time_cell(source: SourceResult | None) -> Cell:
    if source is None:
        return Cell("", css="nothing")
    if source.failure is not None:
        return Cell(f"failed, {seconds(source.seconds)}", source.seconds, "verdict no-result", source.failure)
    return number(source.seconds, seconds)
