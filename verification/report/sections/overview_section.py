"""All cases in one table: verdict, counts, largest difference."""

from verification.judging.verdict import Outcome
from verification.page.page_parts import Cell, Part, Section, Table, number, outcome_cell, row, tally
from verification.page.source_labels import symbol_of
from verification.regression.baseline_section import state_cell
from verification.report.report_material import ReportMaterial
from verification.report.tables.case_lookup import case_cell


def section(material: ReportMaterial) -> Section | None:
    """Every case with its verdicts and its largest difference; None without a case."""
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
    return Section("cases", "All cases", [Part("", [table])])
