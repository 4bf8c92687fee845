"""What the run judged, with the caps beside the uncertainties that methods usually state."""

from collections.abc import Mapping, Sequence

from verification.page.number_text import plain, scientific
from verification.page.page_parts import Cell, Part, Row, Table, number, row, words
from verification.page.source_labels import source_label
from verification.regression.manifest import Manifest, manifest_message, manifest_of
from verification.regression.usual_uncertainty import Ability
from verification.report.report_material import Material
from verification.report.tables.case_lookup import scale
from verification.running.case_result import CaseResult
from verification.sources.source_registry import METHODS

_JUDGED = (
    "What the verdicts of this run were decided on. It is recorded with the baseline. Where a comparison, an "
    "invariant, a source, a self-test or a point is missing, a cap, a scale or a gap between points wider, "
    "a line shorter or the largest bound of an invariant more than four times as large, the run fails with "
    "exit code 6, on any machine."
)
_CAPS = (
    "An uncertainty above its cap makes a comparison inconclusive. The caps beside the largest uncertainty "
    "that each method states in the cases of the baseline, both over the scale of the comparison; cap/U is "
    "what it could grow by unnoticed if there were no baseline. A run fails where an uncertainty is "
    "more than four times that of the baseline at any point."
)


def manifest_parts(material: Material) -> list[Part]:
    """Two folds: what was judged of each case; caps beside usual uncertainties."""
    rows = [line for result in material.results for line in _rows(result, material.anchors)]
    columns = ["case", "line", "quantities", "comparisons", "cap", "points", "from, over a_h", "to", "gap"]
    parts = [Part(_JUDGED, [Table("What was judged.", columns, rows)], folded="Manifest: what was judged")]
    beside = material.evidence.baseline
    if beside is not None and beside.abilities:
        parts.append(Part(_CAPS, [_caps(beside.abilities)], folded="Caps beside usual uncertainties"))
    return parts


def short_message(material: Material) -> str:
    """Counts of what was judged, with what the manifest finds."""
    found = [manifest_of(result) for result in material.results]
    comparisons = sum(len(group.pairs) for one in found for group in one.comparisons)
    tests = material.evidence.self_tests
    text = f"{comparisons} comparisons, {sum(len(one.invariants) for one in found)} invariants"
    text += (
        f", {sum(test.answers for test in tests)} known answers of {len(tests)} self-tests" if tests else ""
    )
    beside = material.evidence.baseline
    if beside is None or beside.update is None:
        return f"{text}; no manifest to compare with"
    return f"{text}; {manifest_message(beside.judged) or 'nothing less than recorded, nothing more'}"


def _rows(result: CaseResult, anchors: Mapping[CaseResult, str]) -> list[Row]:
    """A row for each line of a contact, one for all lines of a published case, one for the invariants."""
    manifest, length = manifest_of(result), scale(result, "a_h") if not result.published else 0.0
    head = Cell(result.title, note=result.name, href=f"#{anchors[result]}")
    lines = dict.fromkeys("" if result.published else group.line for group in manifest.comparisons)
    rows = [_row(head, line, manifest, length) for line in lines]
    names = list(dict.fromkeys(name for name, *_ in manifest.invariants))
    if names:
        caps = _range([cap for _, _, cap, *_ in manifest.invariants])
        count = len(manifest.invariants)
        rows.append(
            row(head, "invariants", words(", ".join(names)), number(count, str), caps, "", "", "", "")
        )
    return rows


def _row(head: Cell, line: str, manifest: Manifest, a_h: float) -> Row:
    groups = [group for group in manifest.comparisons if line in ("", group.line)]
    pairs = [pair for group in groups for pair in group.pairs]
    judged = [group.judged for group in groups]
    quantities = ", ".join(dict.fromkeys(pair[0] for pair in pairs))
    points = {one.points for one in judged}
    counted = ", ".join(f"{count} {name}" for name, count in manifest.cells.items())
    extent = ["", "", ""]
    if a_h > 0 and line != "contact":
        first, last = min(one.extent[0] for one in judged), max(one.extent[1] for one in judged)
        extent = [plain(v / a_h, 3) for v in (first, last, max(one.gap for one in judged))]
    return row(
        head,
        line or f"all; {counted}",
        words(quantities),
        number(len(pairs), str),
        _range([one.cap for one in judged]),
        f"{min(points)} to {max(points)}" if len(points) > 1 else str(*points),
        *extent,
    )


def _factor(value: float) -> str:
    return plain(value, 2) if value < 1000 else scientific(value)


def _range(caps: Sequence[float]) -> str:
    low, high = scientific(min(caps)), scientific(max(caps))
    return low if low == high else f"{low} to {high}"


def _caps(found: Sequence[Ability]) -> Table:
    rows = []
    for one in sorted(found, key=lambda item: item.problems):
        cells = []
        for source in METHODS:
            U = one.usual.get(source)
            cells += [number(U), number(one.cap / U if U else None, _factor)]
        grown = [U / one.usual[s] for s, U in one.now.items() if one.usual.get(s)]
        largest = number(max(grown, default=None), lambda v: plain(v, 3))
        rows.append(row(one.problems, one.quantity, one.line, number(one.cap), *cells, largest))
    groups = [("", 4), *((source_label(source), 2) for source in METHODS), ("", 1)]
    columns = ["problems", "quantity", "line", "cap", *["usual U", "cap/U"] * len(METHODS), "U now/usual"]
    return Table("Caps and usual uncertainties.", columns, rows, groups)
