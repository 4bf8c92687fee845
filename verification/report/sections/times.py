"""Run times of every source in every case."""

from verification.report.material import Material
from verification.report.tables.cells import Cell, Part, Section, Table, number, row
from verification.report.tables.labels import source_label
from verification.report.tables.matrix import case_cell
from verification.report.tables.numbers import seconds
from verification.running.result import SourceResult


def section(material: Material) -> Section | None:
    """Seconds of every source in every case; None without a case."""
    if not material.results:
        return None
    # A case whose process died as a whole has its time in the last column.
    names = list(dict.fromkeys(s.source for r in material.results for s in r.sources if s.source != "case"))
    rows = []
    for result in material.results:
        times = {source.source: source for source in result.sources}
        cells = [_time_cell(times.get(name)) for name in names]
        head = case_cell(result, f"#{material.anchors[result]}")
        rows.append(row(head, *cells, number(result.seconds, seconds)))
    table = Table(
        "Wall-clock seconds of each source including its uncertainty estimate; the case in total.",
        ["case", *(source_label(name) for name in names), "case in total"],
        rows,
    )
    return Section("times", "Run times", [Part("", [table])])


def _time_cell(source: SourceResult | None) -> Cell:
    if source is None:
        return Cell("", css="nothing")
    if source.failure is not None:
        return Cell(f"failed, {seconds(source.seconds)}", source.seconds, "verdict no-result", source.failure)
    return number(source.seconds, seconds)
