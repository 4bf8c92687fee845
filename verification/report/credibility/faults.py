"""What the checks made of the planted faults: score, matrix, survivors."""

from collections import Counter
from collections.abc import Sequence

from verification.credibility.faults.catalogue import GROUPS
from verification.credibility.faults.checks import COLUMNS
from verification.credibility.faults.record import Catch, Record, Seen
from verification.credibility.faults.record import Row as FaultRow
from verification.report.material import Material
from verification.report.tables.cells import Cell, Part, Row, Section, Table
from verification.report.tables.labels import source_label
from verification.report.tables.numbers import plain, scientific, seconds
from verification.report.templates import render_sections

__all__ = ["faults_page", "faults_section", "faults_sentence", "section"]

# Mark, class and words of each way in which a fault may end.
_CATCHES = {
    Catch.DISAGREES: ("✓ caught", "verdict agrees", "a check that must hold does not"),
    Catch.INCONCLUSIVE: (
        "? inconclusive",
        "verdict inconclusive",
        "the uncertainty it leaves exceeds the cap",
    ),
    Catch.DRIFTED: ("~ baseline", "verdict inconclusive", "a number is not that of the baseline"),
    Catch.NO_RESULT: ("∅ no result", "verdict no-result", "the source fails, which tells nothing of why"),
    Catch.SURVIVED: ("✗ survived", "verdict disagrees", "every check passes"),
    Catch.NOT_TRIED: ("∅ not tried", "verdict no-result", "the trial came to nothing"),
}


def faults_sentence(record: Record) -> str:
    """The score in one sentence."""
    said = (
        f"{record.caught} of {len(record.rows)} planted faults are caught "
        f"({plain(100 * record.share, 3)} %), "
        f"{record.as_expected} of them by a check that was named for it before it was tried"
    )
    if record.blanks:
        number = len(record.blanks)
        said += f"; of {number} trials with nothing planted {len(record.alarms) or 'none'} raised an alarm"
    return said + "."


def section(material: Material) -> Section | None:
    """The planted faults on record; None without a record."""
    record = material.evidence.faults
    return None if record is None else faults_section(record)


def faults_section(record: Record) -> Section:
    """Planted faults as a section of any page: how it was done, the score, the matrix, what survived."""
    parts = [Part(_method(record)), Part(faults_sentence(record), [_score(record)])]
    if record.survivors:
        parts.append(Part("What was not caught, why, what would catch it.", [_survivors(record)]))
    groups = [(title, [row for row in record.rows if row.group == key]) for key, title in GROUPS.items()]
    parts.append(Part(_reading(record), [_matrix(rows, title) for title, rows in groups if rows]))
    if record.blanks:
        said = "The same trials with nothing planted: whatever is caught here is a false alarm."
        parts.append(Part(said, [_matrix(record.blanks, "Nothing planted")]))
    failures = [f"{row.name} changes no number; it is not a fault." for row in record.idle]
    failures += [f"{row.name}, in which nothing is planted, is caught: {row.by}" for row in record.alarms]
    failures += [f"{row.name}: {row.failure}" for row in record.rows if row.failure]
    failures += [f"Without any fault already, so that it is no evidence: {said}" for said in record.already]
    return Section("faults", "Planted faults", parts, failures)


def faults_page(record: Record) -> str:
    """The section as a page of its own."""
    facts = (
        ("started", record.started.replace("T", " ").replace("+00:00", " UTC")),
        ("duration", seconds(record.seconds)),
        ("on one core", seconds(record.core_seconds)),
        ("commit", record.commit or "not in a repository"),
        ("machine", record.machine),
        *record.versions.items(),
    )
    said = faults_sentence(record)
    return render_sections(
        "coatcheck faults", said, facts, [faults_section(record)], "Written by coatcheck faults."
    )


def _method(record: Record) -> str:
    return (
        "One mistake at a time is planted in the running code, by exchanging a few words of the function "
        "concerned, and the checks of the default run are put to what comes out. Only the faulty source is "
        "solved again, with the default numerics; the others stand as a clean run left them. Tried on "
        f"{record.started[:10]}, commit {record.commit or 'unknown'}, {seconds(record.core_seconds)} on one "
        "core."
    )


def _reading(record: Record) -> str:
    columns = "; ".join(f"“{title}”: {said}" for title, said in COLUMNS.items())
    blind = sum(_only_coated(row) for row in record.rows)
    said = (
        f"{blind} faults pass every comparison of the uncoated cases, with Hertz and Hamilton too, and are "
        "caught on coated cases alone. "
        if blind
        else ""
    )
    return (
        f"{said}Each cell counts the checks that do not pass, of those that were made: ✓ a disagreement, "
        "? an uncertainty beyond its cap, ∅ no result. An empty cell is a check that was not made, since the "
        f"fault does not reach it. The columns: {columns}."
    )


def _only_coated(row: FaultRow) -> bool:
    """True where comparisons on uncoated cases all pass and some on coated ones do not."""
    bare = [seen for column, seen in row.columns.items() if column.startswith("bare")]
    coated = [seen for column, seen in row.columns.items() if column.startswith("coated")]
    passed = all(seen.disagree + seen.inconclusive + seen.no_result == 0 for seen in bare)
    return bool(bare) and passed and any(seen.disagree + seen.inconclusive for seen in coated)


def _score(record: Record) -> Table:
    shown = [catch for catch in Catch if any(row.catch is catch for row in record.rows)]
    rows = []
    groups = [(title, [row for row in record.rows if row.group == key]) for key, title in GROUPS.items()]
    groups = [(title, rows) for title, rows in groups if rows]
    if len(groups) > 1:
        groups.append(("All", list(record.rows)))
    for title, members in groups:
        count = Counter(row.catch for row in members)
        cells = [Cell(str(len(members)), len(members))]
        cells += [Cell(str(count[catch] or "–"), count[catch]) for catch in shown]
        caught, named = sum(row.caught for row in members), sum(row.as_expected for row in members)
        cells.append(Cell(f"{plain(100 * caught / len(members), 3)} %", caught / len(members)))
        cells.append(Cell(str(named), named))
        rows.append(Row(Cell(title), cells))
    return Table(
        "How the faults of each group were noticed. As foretold: by a check that was named for the fault "
        "before it was tried.",
        ["group", "faults", *(str(catch) for catch in shown), "caught in all", "as foretold"],
        rows,
    )


def _survivors(record: Record) -> Table:
    rows = [
        Row(
            Cell(row.name, note=row.sentence),
            [
                _catch_cell(row),
                Cell(row.sentence, css="words"),
                Cell(row.reason or row.failure or "nobody has said why", css="words"),
                Cell(row.cure or "–", css="words"),
            ],
        )
        for row in record.survivors
    ]
    columns = ["fault", "outcome", "what is wrong", "why it survives", "what would catch it"]
    return Table("Survivors.", columns, rows)


def _matrix(rows: Sequence[FaultRow], caption: str) -> Table:
    made = []
    for row in rows:
        cells = [
            Cell(row.sentence, css="words"),
            Cell(source_label(row.where)),
            _catch_cell(row),
            Cell("✓" if row.as_expected else "–", note=row.by),
            *(_seen_cell(row.columns.get(column)) for column in COLUMNS),
            Cell(scientific(row.change), row.change, note=f"{row.changed}; {seconds(row.seconds)}"),
        ]
        made.append(Row(Cell(row.name, note=row.by), cells))
    columns = ["fault", "what is wrong", "in", "outcome", "as foretold", *COLUMNS, "change"]
    spans = [("", 5), ("checks that do not pass", len(COLUMNS)), ("", 1)]
    return Table(caption, columns, made, spans, "faults")


def _catch_cell(row: FaultRow) -> Cell:
    text, css, said = _CATCHES[row.catch]
    return Cell(text, float(list(Catch).index(row.catch)), css, row.by or said)


def _seen_cell(seen: Seen | None) -> Cell:
    if seen is None:
        return Cell("", None, "nothing", "not made")
    parts = [("✓", seen.disagree), ("?", seen.inconclusive), ("∅", seen.no_result)]
    text = " ".join(f"{mark}{count}" for mark, count in parts if count)
    if not text:
        return Cell(f"0/{seen.made}", 0.0, note=f"all {seen.made} pass")
    css = "agrees" if seen.disagree else "inconclusive" if seen.inconclusive else "no-result"
    return Cell(f"{text}/{seen.made}", seen.disagree + seen.inconclusive, f"verdict {css}", seen.said)
