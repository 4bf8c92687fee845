"""Self-tests of the harness on problems with a known answer."""

from verification.page.page_parts import Cell, Part, Section, Table, row, words
from verification.report.report_material import Material


def section(material: Material) -> Section | None:
    """Each self-test with its requirement and its outcome; None where none was made."""
    tests = material.evidence.self_tests
    if not tests:
        return None
    passed, failed = Cell("✓", 1.0, "verdict agrees"), Cell("✗", 0.0, "verdict disagrees")
    rows = [
        row(test.name, passed if test.passed else failed, words(test.statement), words(test.found))
        for test in tests
    ]
    table = Table("Made before the first case was solved.", ["part", "passed", "requirement", "found"], rows)
    text = (
        "Comparisons check the methods and references. These tests check the parts that read the cases, "
        "sample the solutions, judge and store, against results worked out by hand."
    )
    bad = [test for test in tests if not test.passed]
    failures = [f"{test.name}: {test.found}. The verdicts of this run are not valid." for test in bad]
    return Section("self-tests", "Self-tests of the harness", [Part(text, [table])], failures)
