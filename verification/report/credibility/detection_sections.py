"""What the checks detect: planted faults, self-tests of the harness."""

from collections import Counter
from collections.abc import Callable, Sequence
from functools import partial

from verification.credibility.self_tests import SelfTest
from verification.evidence.fault_record import COLUMNS, GROUPS, Catch, FaultRow, Record
from verification.evidence.first_notice import Noticed, kinds, method_score, noticed, of_method, unused
from verification.page.number_text import plain, scientific, seconds
from verification.page.page_parts import Cell, Part, Section, Table, Value, row, table_of, words
from verification.page.source_labels import source_label
from verification.report.report_words import stated

# Mark, class and words of each outcome of a planted fault.
_CATCHES = {
    Catch.DISAGREES: ("✓ detected", "verdict agrees", "a check that must hold does not"),
    Catch.INCONCLUSIVE: (
        "? inconclusive",
        "verdict inconclusive",
        "the uncertainty it leaves exceeds the cap",
    ),
    Catch.DRIFTED: ("~ baseline", "verdict inconclusive", "a number differs from the baseline"),
    Catch.NO_RESULT: ("∅ no result", "verdict no-result", "the source fails without a reason"),
    Catch.SURVIVED: ("✗ survived", "verdict disagrees", "every check passes"),
    Catch.NOT_TRIED: ("∅ not tried", "verdict no-result", "the trial failed"),
}


def faults_message(record: Record) -> str:
    """The score as a message."""
    text = (
        f"{record.caught} of {len(record.tried)} planted faults are detected "
        f"({plain(100 * record.share, 3)} %), "
        f"{record.as_predicted} of them by the check predicted before the trial"
    )
    if untried := len(record.rows) - len(record.tried):
        text += f"; {untried} were not tried"
    if of_method(record):
        found, count = method_score(record)
        text += (
            f". In the semi-analytical method, {found} of {count} are noticed by a comparison, an invariant "
            f"or a judged study (first {kinds(record)})"
        )
    if record.controls:
        text += (
            f"; of {len(record.controls)} negative controls {len(record.alarms) or 'none'} raised an alarm"
        )
    return text + "."


def faults_section(record: Record) -> Section:
    """Planted faults as a section of any page: method, share detected, survivors, checks of each fault."""
    made = {
        "date": record.started[:10],
        "commit": record.commit or "unknown",
        "time": seconds(record.core_seconds),
    }
    parts = [Part(stated("planting", **made)), Part(faults_message(record), [_score(record)])]
    if never := [fault for fault in of_method(record) if unused(fault)]:
        names = "; ".join(f"{fault.name}: {fault.description}" for fault in never)
        parts.append(
            Part(f"No run executes what these faults change, an argument for a further case. {names}.")
        )
    if survivors := _survivors(record):
        parts.append(
            Part("Faults that were not detected, with the reason and a possible check.", [survivors])
        )
    if record.controls:
        text = "Negative controls, the same trials with nothing planted: any detection is a false alarm."
        parts.append(Part(text, [_controls(record.controls)]))
    columns = "; ".join(f"“{title}”: {text}" for title, text in COLUMNS.items())
    explained = stated("cells", blind=sum(map(_only_coated, record.rows)), columns=columns)
    parts.append(Part(explained, title="Faults against checks"))
    parts += [
        Part("", [_matrix(rows, title)], folded=f"{title}, {len(rows)} faults")
        for title, rows in _groups(record)
    ]
    failures = [f"{one.name} changes no number, so it is not a fault." for one in record.idle]
    failures += [f"{one.name}, a negative control, is detected: {one.by}" for one in record.alarms]
    failures += [f"{one.name}: {one.failure}" for one in record.rows if one.failure]
    failures += [
        f"Fails without any fault, so that it is no evidence: {check}" for check in record.failing_clean
    ]
    return Section("faults", "Planted faults", parts, failures)


def _only_coated(row: FaultRow) -> bool:
    """True where comparisons on uncoated cases all pass and some on coated ones do not."""
    bare = [seen for column, seen in row.columns.items() if column.startswith("bare")]
    coated = [seen for column, seen in row.columns.items() if column.startswith("coated")]
    passed = all(seen.disagree + seen.inconclusive + seen.no_result == 0 for seen in bare)
    return bool(bare) and passed and any(seen.disagree + seen.inconclusive for seen in coated)


def _groups(record: Record) -> list[tuple[str, Sequence[FaultRow]]]:
    """Title and faults of each group that has any."""
    groups = ((title, [row for row in record.rows if row.group == key]) for key, title in GROUPS.items())
    return [(title, faults) for title, faults in groups if faults]


def _score(record: Record) -> Table:
    shown = [kind for kind in Noticed if any(noticed(fault) is kind for fault in record.rows)]
    groups = _groups(record)
    rows = []
    for title, faults in [*groups, *([("All", record.rows)] if len(groups) > 1 else [])]:
        counted = Counter(map(noticed, faults))
        share = sum(fault.caught for fault in faults) / len(faults)
        cells = [Cell(str(counted[kind] or "–"), counted[kind]) for kind in shown]
        cells.append(Cell(f"{plain(100 * share, 3)} %", share))
        rows.append(row(title, len(faults), *cells, sum(fault.as_predicted for fault in faults)))
    heads = ["group", "faults", *map(str, shown), "detected", "predicted check"]
    return Table(stated("noticed"), heads, rows)


def _survivors(record: Record) -> Table:
    return table_of(
        "Survivors.",
        record.survivors,
        [
            ("fault", lambda fault: Cell(fault.name, note=fault.description)),
            ("outcome", _catch_cell),
            ("fault planted", lambda fault: words(fault.description)),
            ("reason", lambda fault: words(fault.reason or fault.failure or "not known")),
            ("possible check", lambda fault: words(fault.remedy or "–")),
        ],
    )


def _matrix(faults: Sequence[FaultRow], caption: str) -> Table:
    columns: list[tuple[str, Callable[[FaultRow], Value]]] = [
        ("fault", lambda fault: Cell(fault.name, note=fault.by)),
        ("fault planted", lambda fault: words(fault.description)),
        ("in", lambda fault: source_label(fault.where)),
        ("outcome", _catch_cell),
        ("predicted check", lambda fault: Cell("✓" if fault.as_predicted else "–", note=fault.by)),
        *((name, partial(_seen_cell, column=name)) for name in COLUMNS),
        (
            "change",
            lambda fault: Cell(
                scientific(fault.change), fault.change, note=f"{fault.changed}; {seconds(fault.seconds)}"
            ),
        ),
    ]
    spans = [("", 5), ("checks that do not pass", len(COLUMNS)), ("", 1)]
    return table_of(caption, faults, columns, spans, "faults")


def _controls(controls: Sequence[FaultRow]) -> Table:
    """Trials with nothing planted: silence is right, a detection is a false alarm."""
    silent = Cell("✓ no alarm", 1.0, "verdict agrees")
    return table_of(
        "Nothing planted.",
        controls,
        [
            ("control", lambda one: one.name),
            ("solved again", lambda one: words(one.description)),
            (
                "outcome",
                lambda one: Cell("✗ false alarm", 0.0, "verdict disagrees", one.by) if one.caught else silent,
            ),
            ("checks", lambda one: sum(seen.made for seen in one.columns.values())),
        ],
    )


def _catch_cell(row: FaultRow) -> Cell:
    text, css, meaning = _CATCHES[row.catch]
    return Cell(text, float(list(Catch).index(row.catch)), css, row.by or meaning)


def _seen_cell(fault: FaultRow, column: str) -> Cell:
    seen = fault.columns.get(column)
    if seen is None:
        return Cell("", None, "nothing", "not made")
    parts = [("✓", seen.disagree), ("?", seen.inconclusive), ("∅", seen.no_result)]
    text = " ".join(f"{mark}{count}" for mark, count in parts if count)
    if not text:
        return Cell(f"0/{seen.made}", 0.0, note=f"all {seen.made} pass")
    css = "agrees" if seen.disagree else "inconclusive" if seen.inconclusive else "no-result"
    return Cell(f"{text}/{seen.made}", seen.disagree + seen.inconclusive, f"verdict {css}", seen.message)


def self_tests_section(tests: Sequence[SelfTest]) -> Section | None:
    """Each self-test with its requirement and its outcome; None where none was made."""
    if not tests:
        return None
    passed, failed = Cell("✓", 1.0, "verdict agrees"), Cell("✗", 0.0, "verdict disagrees")
    table = table_of(
        "Made before the first case was solved.",
        tests,
        [
            ("part", lambda test: test.name),
            ("passed", lambda test: passed if test.passed else failed),
            ("requirement", lambda test: words(test.statement)),
            ("found", lambda test: words(test.found)),
        ],
    )
    bad = [test for test in tests if not test.passed]
    failures = [f"{test.name}: {test.found}. The verdicts of this run are not valid." for test in bad]
    return Section("self-tests", "Self-tests of the harness", [Part(stated("self_tests"), [table])], failures)
