"""Invariants in a result: what they do to its outcome, its files and its page."""

from dataclasses import replace

from synthetic_results import contact, result_of

from verification.judging.invariants import Invariant
from verification.judging.verdict import Outcome
from verification.report.sections.invariants_section import invariant_table, section

HOLDS = Invariant("load balance", "semianalytic", 1e-7, 1e-5, Outcome.AGREES, "int p dA = W: off by 1e-07")
CLOSE = Invariant(
    "equilibrium, coating 1", "hertz", 8e-6, 1e-5, Outcome.AGREES, "div sigma = 0: off by 8e-06"
)
BROKEN = Invariant("equilibrium, substrate", "hertz", 3e-5, 1e-5, Outcome.DISAGREES, "div sigma = 0: off")
LOST = Invariant("sphere", "fem_reference", None, None, Outcome.NO_RESULT, "RuntimeError: no such plane")


SOUND = replace(result_of(contact(), points=31), invariants=(HOLDS, CLOSE))
SLIPPED = replace(SOUND, invariants=(HOLDS, CLOSE, BROKEN, LOST))


def test_broken_invariant_makes_the_case_disagree_though_every_comparison_agrees():
    assert SOUND.outcome is Outcome.AGREES
    assert SLIPPED.outcome is Outcome.DISAGREES
    assert replace(SOUND, invariants=(HOLDS, LOST)).outcome is Outcome.NO_RESULT


def test_table_begins_with_what_is_broken_then_with_the_closest_to_its_bound():
    table = invariant_table(SLIPPED.invariants)
    assert table.columns[2:] == ["semi-analytical", "Hertz", "finite elements"]
    shown = {row.head.text: [cell.text for cell in row.cells[1:]] for row in table.rows}
    assert list(shown.items()) == [
        ("equilibrium, substrate", ["", "✗ 300 %", ""]),
        ("sphere", ["", "", "∅ –"]),
        ("equilibrium, coating 1", ["", "80 %", ""]),
        ("load balance", ["1 %", "", ""]),
    ]
    assert table.rows[0].css == "disagrees"
    assert invariant_table(()) is None


def test_section_gathers_the_layers_of_a_law_over_all_cases():
    found = section([SOUND, SLIPPED], {SOUND: "case-sound", SLIPPED: "case-slipped"})
    assert "4 of 6" in found.parts[0].text
    rows = {row.head.text: row for row in found.parts[0].tables[0].rows}
    assert set(rows) == {"load balance", "equilibrium", "sphere"}
    held = next(cell for cell in rows["equilibrium"].cells if cell.text)
    assert (held.text, held.href) == ("2 of 3", "#case-slipped-invariants")
    assert section([replace(SOUND, invariants=())], {}) is None
