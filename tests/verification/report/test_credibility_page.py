"""The credibility page: every figure computed or from a record, what is missing said, imports really read."""

from dataclasses import replace

import pytest
from alarms import counted
from synthetic_results import INFO, STEEL, contact, result_of
from synthetic_study import study

from verification.credibility.model_error import Cost, ModelError
from verification.evidence import alarm_record, code_record, judged_source
from verification.evidence.alarm_record import AlarmRecord
from verification.evidence.enclosure_record import SHIPPED
from verification.evidence.fault_record import Catch, FaultRow, Record, write_record
from verification.evidence.judged_source import is_older, source_hash
from verification.judging.verdict import Outcome
from verification.page.page_parts import Part, Section
from verification.problem.quantity import SCALARS, SLOPES
from verification.report.credibility import credibility_statement
from verification.report.credibility.detection_sections import faults_section
from verification.report.report_material import Evidence, ReportMaterial, gather
from verification.report.report_page import render
from verification.report.sections import first_page
from verification.report.sections.accuracy_section import coverage_table
from verification.running import provenance
from verification.running.case_result import CaseResult
from verification.sources.source_record import Independence
from verification.sources.source_registry import independence

E, NU = STEEL


def fault(name: str = "f", catch: Catch = Catch.DISAGREES, **more: str) -> FaultRow:
    named = catch is Catch.DISAGREES
    of = (name, "frf", f"{name} is wrong", "semianalytic", catch, named, "", {}, 1.0, "", 2.0, ())
    return FaultRow(*of, **more)


EMPTY = Record((), (), "2026-10-09T08:00:00+00:00", 60.0, 90.0, "c0ffee123456", "m", {})  # of faults
RESULTS = [
    result_of(contact(), name="bare", points=33),
    result_of(contact((2 * E, NU, 1.0), (4 * E, 0.2, 0.5)), name="two", points=33),
]


@pytest.fixture(scope="module")
def evidence(tmp_path_factory) -> Evidence:
    folder = tmp_path_factory.mktemp("records")
    code_record.write_record(folder, code_record.read_record(SHIPPED))
    return gather(folder)


def section(evidence: Evidence, results: list[CaseResult] = RESULTS, **more) -> Section:
    material = ReportMaterial(results, INFO, replace(evidence, **more))
    found = credibility_statement.section(material, coverage_table(material.contacts))
    assert found is not None
    return found


def part(found: Section, title: str) -> Part:
    return next(p for p in found.parts if p.title.startswith(title))


def said(found: Part) -> str:
    cells = [c.text for t in found.tables for r in t.rows for c in (r.head, *r.cells)]
    return " | ".join([found.text, *cells])


def test_what_was_never_measured_is_said(evidence):
    found = section(evidence)
    assert found.failures == ()
    for title in ("Planted", "False"):
        assert part(found, title).text.startswith("Not measured")
    empty = section(Evidence(failures=("the source is not here",)), [])
    assert empty.failures == ("the source is not here",)
    assert part(empty, "Independence").text.startswith("Not measured")


def test_figures_of_a_record_carry_date_and_commit(evidence, tmp_path):
    vague = result_of(contact((E / 2, NU, 1.0)), name="vague", points=33, errors={"semianalytic": 4e-3})
    info = replace(INFO, started="2026-10-09T08:00:00+00:00", commit="c0ffee123456")
    made = counted([RESULTS[0], vague], "round contacts", 1, info)
    record = AlarmRecord((made,))
    alarm_record.write_record(tmp_path, record)
    known = gather(tmp_path)
    assert known.alarms == record
    found = section(known)
    assert made.vague == {"vague"}
    missing = replace(made.alarms[0], outcome=Outcome.NO_RESULT)
    both = replace(made, alarms=(*made.alarms, missing))
    assert (both.wrong, both.vague) == ({"vague"}, set())
    many = replace(made, alarms=(*made.alarms * credibility_statement.MOST, missing))
    shown = section(known, alarms=AlarmRecord((many,)))
    assert "no result" in said(shown.parts[-2])  # the false alarm before those inconclusive
    text = said(part(found, "False"))
    assert f"{record.wrong} of 2 round contacts raised a false alarm" in text
    assert f"at most {100 * record.rate:.2g} %" in text
    assert all(word in text for word in ("2026-10-09", "c0ffee12", str(made.comparisons)))
    assert made.alarms[0].reason in said(found.parts[-2])


def test_the_fault_score_and_its_survivors_come_from_the_record(tmp_path):
    rows = [fault(f"fault_{n}") for n in range(19)]
    rows.append(fault("shy", Catch.SURVIVED, reason="no case sees it", remedy="a thicker film would"))
    write_record(tmp_path, replace(EMPTY, rows=tuple(rows)))
    found = gather(tmp_path)
    assert found.failures == ()
    text = " ".join(said(one) for one in faults_section(found.faults).parts)
    assert "19 of 20" in text
    assert "Date 2026-10-09, commit c0ffee123456" in text
    assert all(words in text for words in (rows[-1].reason, rows[-1].remedy))


def test_a_damaged_record_is_named_and_its_figure_is_not_measured(tmp_path):
    (tmp_path / "alarms.json").write_text("{")
    found = section(gather(tmp_path))
    assert any("alarms.json" in message for message in found.failures)
    assert part(found, "False").text.startswith("Not measured")


def test_figures_of_this_run_follow_its_results(evidence):
    def shares(found: Section, title: str) -> set[float | None]:
        (table,) = part(found, title).tables
        return {cell.sort for row in table.rows for cell in row.cells if " of " in cell.text}

    good = section(evidence, accuracy=study())
    assert shares(good, "Comparison") == shares(good, "Solution") == {1.0}
    bold = result_of(
        contact((4 * E, NU, 1.0)), points=33, errors={"semianalytic": 2e-3}, stated={"semianalytic": 0.7}
    )
    bad = section(evidence, [*RESULTS, bold])
    assert min(shares(bad, "Comparison")) < 1 > min(shares(bad, "Solution"))
    ranges = said(part(good, "Intended"))
    assert "2 to 4" in ranges  # E1/E2
    assert "0.5 to 1" in ranges  # h/a_h


def test_a_record_is_older_where_the_source_that_it_judges_differs_without_git_too(tmp_path, monkeypatch):
    folder = tmp_path / "installed" / "semianalytic"
    folder.mkdir(parents=True)
    for name in ("judged", "other"):
        (folder / f"{name}.py").write_text("1")
    monkeypatch.setattr(provenance, "ROOT", folder.parent)
    monkeypatch.setitem(judged_source.JUDGED, "faults", ("semianalytic.judged",))
    record = replace(EMPTY, source=source_hash("faults"))
    (folder / "other.py").write_text("2")
    provenance.fingerprint.cache_clear()
    assert not is_older("faults", record)
    (folder / "judged.py").write_text("2")
    provenance.fingerprint.cache_clear()
    assert is_older("faults", record)
    assert is_older("faults", EMPTY)  # of a version that kept no hash
    provenance.fingerprint.cache_clear()


def test_an_old_record_is_marked_on_its_page_and_on_the_first(evidence):
    for older in ((), ("faults",)):
        record = replace(EMPTY, rows=(fault(),))
        text = render(ReportMaterial(RESULTS, INFO, replace(evidence, faults=record, older=older)))
        assert text.count(" older ") == (2 if older else 0)
        assert "2026-10-09, c0ffee12" in text


def test_comparisons_are_counted_by_what_their_sources_share_and_no_contact_twice():
    def counted(*results) -> dict[str, str]:
        return {item.name: item.value for item in first_page.agreements(ReportMaterial(results, INFO))}

    def total(found) -> int:
        return sum(int(found[kind].split()[-1]) for kind in Independence if kind in found)

    assert total(counted(*RESULTS)) == sum(len(result.verdicts) for result in RESULTS)
    still, sliding = (
        result_of(contact((2 * E, NU, 1.0), friction=f), name=f"f = {f}", points=33) for f in (0.0, 0.25)
    )
    both = counted(still, sliding)
    again = int(both["not counted again"])
    assert total(both) + again == len(still.verdicts) + len(sliding.verdicts)
    repeats = [c for c, _ in sliding.verdicts if c.quantity in (*SCALARS, *SLOPES, "pressure")]
    assert again == len(repeats) > 0
    assert "not counted again" not in counted(
        still, replace(sliding, problem={**sliding.problem, "load": 21.0})
    )


def test_what_both_methods_share_is_read_from_their_source(evidence, tmp_path, monkeypatch):
    said = dict(first_page.shared(ReportMaterial(RESULTS, INFO, evidence)))
    first, second = evidence.parts[:2]
    assert (
        said["code"] == f"none, by {sum(p.statements for p in evidence.parts)} imports; both use numpy, scipy"
    )
    assert said["special functions"] == "none"
    assert said["quadrature nodes"] == "numpy.polynomial.legendre.leggauss"
    both = (replace(first, functions=("scipy.special.j0",)), replace(second, functions=("scipy.special.j0",)))
    parts = (*both, replace(first, forbidden=("a imports b",)))
    wrong = replace(evidence, code=replace(evidence.code, parts=parts))
    said = dict(first_page.shared(ReportMaterial(RESULTS, INFO, wrong)))
    assert (said["code"], said["special functions"]) == ("a imports b", "scipy.special.j0")


def test_the_largest_cost_of_an_assumption_names_its_case(evidence):
    costs = {
        r.name: ModelError((Cost("small strains", "tension", c, 0.0),))
        for r, c in zip(RESULTS, (0.01, -0.057), strict=True)
    }
    (row,) = first_page.model_costs(ReportMaterial(RESULTS, INFO, replace(evidence, models=costs)))
    assert (row.value, row.note) == ("5.7 % of the tension at the trailing edge", RESULTS[1].title)


def test_kinds_of_independence():
    assert independence(("semianalytic", "integral_equation")) is Independence.EQUATION
    assert independence(("semianalytic", "fem_reference")) is Independence.NOTHING
    assert independence(("fem_reference", "hertz")) is Independence.CLOSED
    assert independence(("fem_reference", "published")) is Independence.PRINT
