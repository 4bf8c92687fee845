"""The answers of the harness to questions whose answer is known."""

from verification.report.material import Material
from verification.report.tables.cells import Cell, Part, Row, Section, Table

__all__ = ["section"]


def section(material: Material) -> Section | None:
    """Each self-test with its requirement and its outcome; None where none was made."""
    tests = material.evidence.self_tests
    if not tests:
        return None
    rows = [
        Row(
            Cell(test.name),
            [
                Cell("✓", 1.0, "verdict agrees") if test.passed else Cell("✗", 0.0, "verdict disagrees"),
                Cell(test.sentence, css="words"),
                Cell(test.found, css="words"),
            ],
        )
        for test in tests
    ]
    table = Table(
        "Asked before the first case was solved.", ["part", "passed", "what must hold", "found"], rows
    )
    said = (
        "Methods and references watch each other; what reads the cases, samples the solutions, judges and "
        "stores is watched by questions whose answer was worked out by hand."
    )
    bad = [test for test in tests if not test.passed]
    failures = [f"{test.name}: {test.found}. The verdicts of this run mean nothing." for test in bad]
    return Section("self-tests", "Self-tests of the harness", [Part(said, [table])], failures)
