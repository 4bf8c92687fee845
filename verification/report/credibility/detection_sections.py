"""Sections on what the checks detect: planted faults, self-tests of the harness."""

from collections import Counter
from collections.abc import Sequence

from verification.credibility.self_tests import SelfTest
from verification.evidence.fault_record import COLUMNS, GROUPS, Catch, FaultRow, Record
from verification.evidence.first_notice import Noticed, by_place, noticed, score, unused
from verification.page.number_text import scientific, seconds
from verification.page.page_parts import Cell, Part, Section, Table, row, table_of, tally, words
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


def faults_section(record: Record) -> Section:
    """Planted faults as a section of any page: method, share detected, survivors, checks of each fault."""
    places = {name: score(rows) for name, rows in by_place(record).items() if name != "harness"}
    parts = [
        Part(stated("planting", record=record, time=seconds(record.core_seconds))),
        Part(stated("fault_score", record=record, places=places), [_score(record)]),
    ]
    if never := [fault for fault in record.rows if unused(fault)]:
        names = "; ".join(f"{fault.name}: {fault.description}" for fault in never)
        parts.append(
            Part(f"No run executes what these faults change, an argument for a further case. {names}.")
        )
    if record.survivors:
        text = "Faults that were not detected, with the reason and a possible check."
        parts.append(Part(text, [_survivors(record)]))
    if record.controls:
        text = "Negative controls, the same trials with nothing planted: any detection is a false alarm."
        parts.append(Part(text, [_controls(record.controls)]))
    columns = "; ".join(f"“{title}”: {text}" for title, text in COLUMNS.items())
    blind = sum(row.only_coated for row in record.rows)
    parts.append(Part(stated("cells", columns=columns, blind=blind), title="Faults against checks"))
    parts += [
        Part("", [_matrix(rows, title)], folded=f"{title}, {len(rows)} faults")
        for title, rows in _groups(record)
    ]
    failures = [f"{one.name} changes no number, so it is not a fault." for one in record.idle]
    failures += [f"{one.name}, a negative control, is detected: {one.by}" for one in record.alarms]
    failures += [f"{one.name}: {one.failure}" for one in record.rows if one.failure]
    failures += [f"Fails without any fault, so that it is no evidence: {one}" for one in record.failing_clean]
    return Section("faults", "Planted faults", parts, failures)


def _groups(record: Record) -> list[tuple[str, Sequence[FaultRow]]]:
    """Title and faults of each group that has any."""
    groups = ((title, [row for row in record.rows if row.group == key]) for key, title in GROUPS.items())
    return [(title, faults) for title, faults in groups if faults]


def _score(record: Record) -> Table:
    """Faults by what they are in, with what notices them first."""
    counted = {name: (rows, Counter(map(noticed, rows))) for name, rows in by_place(record).items()}
    counted["all"] = list(record.rows), Counter(map(noticed, record.rows))
    kinds = [kind for kind in Noticed if counted["all"][1][kind]]
    rows = [
        row(
            place,
            len(faults),
            *(found[kind] for kind in kinds),
            tally(sum(one.caught for one in faults), len(faults)),
            sum(one.as_predicted for one in faults),
        )
        for place, (faults, found) in counted.items()
    ]
    heads = ["in", "faults", *map(str, kinds), "detected", "predicted check"]
    return Table(stated("noticed"), heads, rows)


def _survivors(record: Record) -> Table:
    return table_of(
        "Survivors.",
        record.survivors,
        [
            ("fault", lambda fault: fault.name),
            ("outcome", _catch_cell),
            ("fault planted", lambda fault: words(fault.description)),
            ("reason", lambda fault: words(fault.reason or fault.failure or "not known")),
            ("possible check", lambda fault: words(fault.remedy or "–")),
        ],
    )


def _matrix(faults: Sequence[FaultRow], caption: str) -> Table:
    return table_of(
        caption,
        faults,
        [
            ("fault", lambda fault: fault.name),
            ("fault planted", lambda fault: words(fault.description)),
            ("in", lambda fault: source_label(fault.where)),
            ("outcome", _catch_cell),
            ("checks that do not pass", lambda fault: words(_seen(fault))),
            ("predicted check", lambda fault: Cell("✓" if fault.as_predicted else "–", note=fault.by)),
            ("change", lambda fault: Cell(scientific(fault.change), fault.change, note=fault.changed)),
        ],
        css="faults",
    )


def _seen(fault: FaultRow) -> str:
    """The checks that do not pass, of those that were made, column by column."""
    found = []
    for name, seen in fault.columns.items():
        parts = [("✓", seen.disagree), ("?", seen.inconclusive), ("∅", seen.no_result)]
        if text := " ".join(f"{mark}{count}" for mark, count in parts if count):
            found.append(f"{name} {text}/{seen.made}")
    return "; ".join(found) or "none"


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


def _catch_cell(fault: FaultRow) -> Cell:
    text, css, meaning = _CATCHES[fault.catch]
    return Cell(text, float(list(Catch).index(fault.catch)), css, fault.by or meaning)


def self_tests_section(tests: Sequence[SelfTest]) -> Section | None:
    """Each self-test with its requirement and its outcome; None where none was made."""
    if not tests:
        return None
    table = table_of(
        "Made before the first case was solved.",
        tests,
        [
            ("part", lambda test: test.name),
            (
                "passed",
                lambda test: (
                    Cell("✓", 1.0, "verdict agrees") if test.passed else Cell("✗", 0.0, "verdict disagrees")
                ),
            ),
            ("requirement", lambda test: words(test.statement)),
            ("found", lambda test: words(test.found)),
        ],
    )
    bad = [test for test in tests if not test.passed]
    failures = [f"{test.name}: {test.found}. The verdicts of this run are not valid." for test in bad]
    return Section("self-tests", "Self-tests of the harness", [Part(stated("self_tests"), [table])], failures)
