"""Published sources: citation, every table as published beside the values of the methods."""

from collections.abc import Mapping, Sequence
from functools import partial
from typing import Any

import numpy as np

from verification.cases.published_table import RECOMPUTED
from verification.page.number_text import plain, scientific
from verification.page.page_parts import Cell, Part, Section, Table, number, outcome_cell, row, tally
from verification.page.source_labels import row_css, source_label
from verification.problem.line_profile import Profile
from verification.problem.quantity import QUANTITIES
from verification.report.report_words import stated
from verification.running.case_result import CaseResult
from verification.running.published_counts import counts
from verification.sources.source_registry import METHODS, PUBLISHED, REFERENCES


def section(results: Sequence[CaseResult], anchors: Mapping[CaseResult, str]) -> Section | None:
    """Every source at a glance, with the departures of the sources."""
    if not results:
        return None
    parts = [Part("", [_overview(results, anchors)])]
    if departures := _departures(results, anchors):
        parts.append(Part("Departures of the sources", [departures]))
    return Section("published", "Published results", parts)


def _overview(results: Sequence[CaseResult], anchors: Mapping[CaseResult, str]) -> Table:
    rows = []
    sources = tuple(dict.fromkeys(s for result in results for s in _sources(result)))
    for result in results:
        tables = result.published["tables"]
        cells = [
            outcome_cell(result.outcome),
            number(result.published["year"], str),
            Cell(
                ", ".join(dict.fromkeys(table["seen"] for table in tables)),
                note="; ".join(dict.fromkeys(table["read"] for table in tables)),
            ),
            *(number(count, str) for count in counts([result])),
        ]
        for source in sources:
            cells += _method_cells(result, source) if source in _sources(result) else [Cell("–"), Cell("–")]
        head = Cell(result.title, note=result.source, href=f"#{anchors[result]}")
        rows.append(row(head, *cells, css=row_css(result.outcome)))
    counted, departing, recomputed = counts(results)
    return Table(
        stated("published", counted=counted, departing=departing, recomputed=recomputed),
        ["source", "verdict", "year", "seen", "counted", "depart", "recomputed"]
        + ["met", "largest difference"] * len(sources),
        rows,
        [("", 4), ("values", 3), *((source_label(source), 2) for source in sources)],
    )


def _departures(results: Sequence[CaseResult], anchors: Mapping[CaseResult, str]) -> Table:
    rows = []
    for result in results:
        for (file, column, _), items in _columns(result).items():
            found = [
                (abs(size * item["to_si"]) / item["scale"], size, item, n)
                for item in items
                for n, size in enumerate(item["departure"])
                if size
            ]
            if not found:
                continue
            share, size, item, n = max(found, key=lambda one: one[0])
            unit = f" {item['unit']}" if item["unit"] != "1" else ""
            rows.append(
                row(
                    Cell(result.title, href=f"#{anchors[result]}"),
                    f"{column} of {file}",
                    Cell("recomputed" if item["seen"] == RECOMPUTED else "published"),
                    tally(len(found), sum(len(one["text"]) for one in items)),
                    Cell(f"{scientific(size, sign=True)}{unit}", abs(size)),
                    number(share),
                    Cell(item["text"][n].replace("-", "−"), note=f"line {item['rows'][n]}"),
                )
            )
    return Table(
        stated("departures"),
        ["source", "column", "kind", "depart", "largest", "of the scale", "published there"],
        rows,
        css="verdicts",
    )


def _sources(result: CaseResult) -> tuple[str, ...]:
    """Both methods, and the references that were compared."""
    claimed = {source for claim, _ in result.verdicts for source in claim.between}
    return METHODS + tuple(source for source in REFERENCES if source in claimed)


def _method_cells(result: CaseResult, method: str) -> list[Cell]:
    met = total = 0
    for item in result.published["columns"]:
        if not any(method in c.between and c.line == item["line"] for c, _ in result.verdicts):
            continue
        gap, allowed = _gap(result, item, method)
        total += len(item["text"])
        if gap is not None and allowed is not None:
            met += int((np.abs(gap - _listed(item)) <= allowed).sum())
    numbers = [v.difference for c, v in result.verdicts if method in c.between and v.difference is not None]
    css = "verdict agrees" if met == total else "verdict disagrees"
    return [Cell(f"{met} of {total}", met, css), number(max(numbers, default=None))]


def _columns(result: CaseResult) -> dict[tuple[str, str, str], list[dict[str, Any]]]:
    """The lines of each column by (file, column, quantity)."""
    columns: dict[tuple[str, str, str], list[dict[str, Any]]] = {}
    for item in result.published["columns"]:
        columns.setdefault((item["file"], item["column"], item["quantity"]), []).append(item)
    return columns


def _listed(item: Mapping[str, Any]) -> np.ndarray:
    """Listed departures [SI] of a column on a line."""
    return np.array(item["departure"]) * item["to_si"]


def tables(result: CaseResult) -> list[tuple[str, Table]]:
    """One table for each published column, its lines one below the other."""
    return [
        (f"{column} of {file}", _table(result, items))
        for (file, column, _), items in _columns(result).items()
    ]


def _table(result: CaseResult, items: Sequence[Mapping[str, Any]]) -> Table:
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
                number(item["departure"][n] or None, partial(scientific, sign=True)),
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
                    met.append(limit is not None and bool(abs(gap[n] - _listed(item)[n]) <= limit))
            counted = item["counted"][n]
            verdict = Cell("✗", css="verdict disagrees")
            if all(met):
                verdict = Cell("✓", css="verdict agrees")
                if item["departure"][n]:
                    verdict = Cell("departs, not counted", css="verdict inconclusive")
            label = ", ".join(filter(None, (place, item["labels"][n])))
            head = Cell(label, note=f"{item['file']}, line {item['rows'][n]}")
            rows.append(row(head, *cells, verdict, css="" if counted else "inconclusive"))
    quantity = QUANTITIES[first["quantity"]]
    return Table(
        stated("published_column", first=first, meaning=quantity.meaning or quantity.symbol),
        [
            "where",
            f"{first['coordinate']} in {first['position_unit']}",
            "published",
            "departure",
            "U of it",
            *["value", "difference", "U of both"] * len(sources),
            "met",
        ],
        rows,
        [("", 5), *((source_label(source), 3) for source in sources), ("", 1)],
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
