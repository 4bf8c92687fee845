"""Published sources: citation, every table as published beside the values of the methods."""

from collections.abc import Mapping, Sequence
from functools import partial
from typing import Any

import numpy as np

from verification.problem.profile import Profile
from verification.problem.quantity import QUANTITIES
from verification.report.material import Material
from verification.report.tables.cells import Cell, Part, Section, Table, number, row
from verification.report.tables.labels import row_css, source_label
from verification.report.tables.matrix import outcome_cell
from verification.report.tables.numbers import plain, scientific
from verification.running.result import CaseResult
from verification.sources.registry import METHODS, PUBLISHED, REFERENCES


def _sources(result: CaseResult) -> tuple[str, ...]:
    """Both methods, and the references that were compared."""
    claimed = {source for claim, _ in result.verdicts for source in claim.between}
    return METHODS + tuple(source for source in REFERENCES if source in claimed)


def section(material: Material) -> Section | None:
    """Every source at a glance: year, how it was read, values that count, verdict of each method."""
    if not material.published:
        return None
    rows = []
    sources = tuple(dict.fromkeys(s for result in material.published for s in _sources(result)))
    for result in material.published:
        columns = result.published["columns"]
        counted = sum(sum(item["counted"]) for item in columns)
        total = sum(len(item["counted"]) for item in columns)
        cells = [
            outcome_cell(result.outcome),
            number(result.published["year"], str),
            Cell(
                "primary" if result.published["primary_read"] else "second-hand",
                note=result.published["read"],
            ),
            number(counted, str),
            number(total - counted, str),
        ]
        for source in sources:
            cells += _method_cells(result, source) if source in _sources(result) else [Cell("–"), Cell("–")]
        head = Cell(result.title, note=result.source, href=f"#{material.anchors[result]}")
        rows.append(row(head, *cells, css=row_css(result.outcome)))
    table = Table(
        "A method meets a value when the difference is within the digitisation uncertainty of the source "
        "plus the uncertainty of the method. Values known to be misprints, or second-hand where better ones "
        "are available, are shown below and never counted. Differences are over the pressure for stresses, "
        "over the largest published value for displacements, strains and loading curves, over the value for "
        "scalars of a contact.",
        ["source", "verdict", "year", "read", "values", "not counted"]
        + ["met", "largest difference"] * len(sources),
        rows,
        [("", 6), *((source_label(source), 2) for source in sources)],
    )
    return Section("published", "Published results", [Part("", [table])])


def _method_cells(result: CaseResult, method: str) -> list[Cell]:
    met = total = 0
    for item in result.published["columns"]:
        counted = np.array(item["counted"], dtype=bool)
        if not any(method in c.between and c.line == item["line"] for c, _ in result.verdicts):
            continue
        gap, allowed = _gap(result, item, method)
        total += int(counted.sum())
        if gap is not None and allowed is not None:
            met += int((np.abs(gap) <= allowed)[counted].sum())
    numbers = [v.difference for c, v in result.verdicts if method in c.between and v.difference is not None]
    css = "verdict agrees" if met == total else "verdict disagrees"
    return [Cell(f"{met} of {total}", met, css), number(max(numbers, default=None))]


def tables(result: CaseResult) -> list[tuple[str, Table]]:
    """One table for each published column, its lines one below the other."""
    columns: dict[tuple[str, str, str], list[dict[str, Any]]] = {}
    for item in result.published["columns"]:
        columns.setdefault((item["file"], item["column"], item["quantity"]), []).append(item)
    return [
        (f"{column} of {file}", _table(result, column, quantity, items))
        for (file, column, quantity), items in columns.items()
    ]


def _table(result: CaseResult, column: str, quantity: str, items: Sequence[Mapping[str, Any]]) -> Table:
    first, sources = items[0], _sources(result)
    rows = []
    for item in items:
        place = item["line"].split(f", {item['file'].removesuffix('.csv')}")[0]
        methods = {
            method: (_profile(result, item, method), *_gap(result, item, method)) for method in sources
        }
        source = _profile(result, item, PUBLISHED)
        for n, text in enumerate(item["text"]):
            uncertainty = None if source is None or source.uncertainty is None else source.uncertainty[n]
            cells = [
                number(item["position"][n], partial(plain, digits=6)),
                Cell(text.replace("-", "−"), float(text)),
                Cell(_in(uncertainty, item), uncertainty),
            ]
            met = []
            for method in sources:
                profile, gap, allowed = methods[method]
                if method not in METHODS and profile is None:
                    cells += [Cell("–")] * 3
                elif profile is None or gap is None:
                    cells += [Cell("no result", css="no-result"), Cell("–"), Cell("–")]
                    met.append(False)
                else:
                    limit = None if allowed is None else float(allowed[n])
                    cells += [
                        number(float(profile.value[n]) / item["to_si"], partial(plain, digits=7)),
                        Cell(_in(float(gap[n]), item, signed=True), abs(float(gap[n]))),
                        Cell(_in(limit, item)),
                    ]
                    met.append(limit is not None and bool(abs(gap[n]) <= limit))
            verdict = Cell("✓", css="verdict agrees") if all(met) else Cell("✗", css="verdict disagrees")
            counted = item["counted"][n]
            if not counted:
                why = item.get("why_not", ("misprint",) * len(item["text"]))[n]
                verdict = Cell(f"{why}, not counted", css="verdict inconclusive")
            label = ", ".join(filter(None, (place, item["labels"][n])))
            head = Cell(label, note=f"{item['file']}, line {item['rows'][n]}")
            rows.append(row(head, *cells, verdict, css="" if counted else "inconclusive"))
    unit = f" in {first['unit']}" if first["unit"] != "1" else ""
    meaning = (QUANTITIES[quantity].meaning or QUANTITIES[quantity].symbol) + (
        " here, of the other sign" if first["to_si"] < 0 else " here"
    )
    return Table(
        f"{column}{unit}, as published ({meaning}): "
        "the difference of each method from it, and the sum of both uncertainties.",
        [
            "where",
            f"{first['coordinate']} in {first['position_unit']}",
            "published",
            "digitisation U",
            *["value", "difference", "U of both"] * len(sources),
            "met",
        ],
        rows,
        [("", 4), *((source_label(source), 3) for source in sources), ("", 1)],
        "verdicts",
    )


def _in(value: float | None, item: Mapping[str, Any], signed: bool = False) -> str:
    """A difference [SI] in the published unit; a signed one in its sign convention."""
    if value is None:
        return "–"
    return scientific(value / item["to_si"] if signed else value / abs(item["to_si"]), sign=signed)


def _gap(
    result: CaseResult, item: Mapping[str, Any], method: str
) -> tuple[np.ndarray | None, np.ndarray | None]:
    """Method less published value, and the sum of both uncertainties [SI]; None where one is missing."""
    mine, theirs = _profile(result, item, method), _profile(result, item, PUBLISHED)
    if mine is None or theirs is None:
        return None, None
    if mine.uncertainty is None or theirs.uncertainty is None:
        return mine.value - theirs.value, None
    return mine.value - theirs.value, mine.uncertainty + theirs.uncertainty


def _profile(result: CaseResult, item: Mapping[str, Any], source: str) -> Profile | None:
    return result.profile_of.get((item["quantity"], item["line"], source))
