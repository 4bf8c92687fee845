"""Published sources: citation, every table as published beside the values of the methods."""

from collections.abc import Mapping, Sequence
from functools import partial
from typing import Any

import numpy as np

from verification.cases.published_table import RECOMPUTED
from verification.page.number_text import plain, scientific
from verification.page.page_parts import Cell, Part, Section, Table, number, outcome_cell, row, tally
from verification.page.source_labels import row_css, source_label
from verification.problem.array_types import Array
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
        seen, read = (dict.fromkeys(table[key] for table in tables) for key in ("seen", "read"))
        cells = [
            outcome_cell(result.outcome),
            number(result.published["year"], str),
            Cell(", ".join(seen), note="; ".join(read)),
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
    claimed = [(claim, verdict) for claim, verdict in result.verdicts if method in claim.between]
    lines = {claim.line for claim, _ in claimed}
    met = [_gaps(result, item, method)[2] for item in result.published["columns"] if item["line"] in lines]
    good, total = (sum(map(count, met)) for count in (np.sum, len))
    css = "verdict agrees" if good == total else "verdict disagrees"
    largest = max((v.difference for _, v in claimed if v.difference is not None), default=None)
    return [Cell(f"{good} of {total}", good, css), number(largest)]


def _columns(result: CaseResult) -> dict[tuple[str, str, str], list[dict[str, Any]]]:
    """The lines of each column by (file, column, quantity)."""
    columns: dict[tuple[str, str, str], list[dict[str, Any]]] = {}
    for item in result.published["columns"]:
        columns.setdefault((item["file"], item["column"], item["quantity"]), []).append(item)
    return columns


def _gaps(result: CaseResult, item: Mapping[str, Any], method: str) -> tuple[Array, Array, Array]:
    """Method less published value, the sum of both uncertainties [SI], and where the value is met.

    NaN where there is no number; a listed departure of the source is met with it.
    """
    mine, theirs = (_profile(result, item, source) for source in (method, PUBLISHED))
    gap = allowed = np.full(len(item["text"]), np.nan)
    if mine is not None and theirs is not None:
        gap = mine.value - theirs.value
        if mine.uncertainty is not None and theirs.uncertainty is not None:
            allowed = mine.uncertainty + theirs.uncertainty
    return gap, allowed, np.abs(gap - np.array(item["departure"]) * item["to_si"]) <= allowed


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
        source = _profile(result, item, PUBLISHED)
        stated_U = None if source is None else source.uncertainty
        methods = [(_profile(result, item, method), *_gaps(result, item, method)) for method in sources]
        for n, text in enumerate(item["text"]):
            U = None if stated_U is None else float(stated_U[n])
            cells = [
                number(item["position"][n], partial(plain, digits=6)),
                Cell(text.replace("-", "−"), float(text)),
                number(item["departure"][n] or None, partial(scientific, sign=True)),
                Cell(_in(U, item), U),
            ]
            for profile, gap, allowed, _ in methods:
                value = None if profile is None else float(profile.value[n]) / item["to_si"]
                cells += [
                    number(value, partial(plain, digits=7)),
                    Cell(_in(float(gap[n]), item, signed=True), abs(float(gap[n]))),
                    Cell(_in(float(allowed[n]), item)),
                ]
            verdict = Cell("✗", css="verdict disagrees")
            asked = [
                ok[n]
                for method, (profile, _, _, ok) in zip(sources, methods, strict=True)
                if method in METHODS or profile is not None
            ]
            if all(asked):
                verdict = Cell("✓", css="verdict agrees")
                if item["departure"][n]:
                    verdict = Cell("departs, not counted", css="verdict inconclusive")
            label = ", ".join(filter(None, (place, item["labels"][n])))
            head = Cell(label, note=f"{item['file']}, line {item['rows'][n]}")
            rows.append(row(head, *cells, verdict, css="" if item["counted"][n] else "inconclusive"))
    quantity = QUANTITIES[first["quantity"]]
    heads = [
        "where",
        f"{first['coordinate']} in {first['position_unit']}",
        "published",
        "departure",
        "U of it",
    ]
    return Table(
        stated("published_column", first=first, meaning=quantity.meaning or quantity.symbol),
        [*heads, *["value", "difference", "U of both"] * len(sources), "met"],
        rows,
        [("", 5), *((source_label(source), 3) for source in sources), ("", 1)],
        "verdicts",
    )


def _in(value: float | None, item: Mapping[str, Any], signed: bool = False) -> str:
    """A difference [SI] in the published unit; a signed one in its sign convention."""
    if value is None or np.isnan(value):
        return "–"
    return scientific(value / item["to_si"] if signed else value / abs(item["to_si"]), sign=signed)


def _profile(result: CaseResult, item: Mapping[str, Any], source: str) -> Profile | None:
    return result.profile_of.get((item["quantity"], item["line"], source))
