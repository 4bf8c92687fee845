"""A stored run: its report is written from its directory alone, and names the command of each case."""

import shlex
from dataclasses import replace

import pytest
from alarms import counted
from synthetic_results import INFO, STEEL, contact, result_of
from synthetic_study import study

from verification.commands.report import report
from verification.credibility.self_tests import SelfTest
from verification.evidence.alarm_record import AlarmRecord, write_record
from verification.regression.baseline_change import regression, updated
from verification.regression.junit_xml import junit_xml
from verification.report.report_material import ReportMaterial, gather, stored_material
from verification.report.report_page import write_report
from verification.report.sections.case_page import rerun_command
from verification.running.case_result import to_json
from verification.running.checked_files import write_checked
from verification.running.stored_fields import plane_path, write_plane
from verification.sampling.stress_plane import sample_plane
from verification.sources.references.hertz import Hertz

RESULTS = [
    result_of(contact((2 * STEEL[0], 0.3, 1.0)), name="z_first", text="the case file", points=11),
    result_of(contact(), name="a_second", points=11, failures={"fem_reference": "no"}),
]


@pytest.fixture
def run(tmp_path):
    """The directory of a run with evidence of every kind, as it is when the run ends."""
    folder = tmp_path / "run"
    for result in RESULTS:
        write_checked(folder / "cases" / f"{result.name}.json", to_json(result))
    plane = sample_plane((), {"fem_reference": Hertz(10e-3, 20.0, *STEEL)})
    write_plane(plane_path(folder, "z_first"), plane, "the case file")
    write_record(tmp_path / "records", AlarmRecord((counted(RESULTS, "round contacts", 1, INFO),)))
    baseline = updated(None, RESULTS[:1], INFO, "first", INFO.started)
    material, _ = stored_material(folder)
    evidence = replace(
        gather(tmp_path / "records"),
        accuracy=study(),
        baseline=regression(RESULTS, baseline, "elsewhere", INFO, whole=True),
        self_tests=(SelfTest("reader", "reads", True, "1 answer"),),
    )
    # As a run has them: each result read back from its file, in the order of the command.
    results = material.results[::-1]
    junit = junit_xml(results, INFO, evidence.baseline, {"reader": ""})
    write_report(ReportMaterial(results, INFO, evidence, material.planes), folder, junit)
    return folder


def test_the_report_of_a_stored_run_is_that_of_the_run(run, tmp_path, monkeypatch, capsys):
    names = ("report.html", "report.json", "junit.xml")
    before = {name: (run / name).read_bytes() for name in names}
    for mark in (b'id="baseline"', b'id="credibility"', b'id="self-tests"'):
        assert mark in before["report.html"]
    (tmp_path / "empty").mkdir()
    monkeypatch.chdir(tmp_path / "empty")
    (tmp_path / "records" / "alarms.json").unlink()
    assert report(run) == 0
    assert capsys.readouterr().out == f"{run / 'report.html'}\n"
    assert {name: (run / name).read_bytes() for name in names} == before


def test_another_baseline_and_other_records_replace_those_of_the_run(run, tmp_path):
    before = (run / "report.html").read_text()
    assert report(run, baseline=tmp_path / "none", records=tmp_path / "none", quiet=True) == 0
    after = (run / "report.html").read_text()
    assert "“first”" in before
    assert "“first”" not in after
    assert "Not measured" in after
    assert 'id="semi-analytical-accuracy"' in after


def test_a_case_solved_since_has_no_evidence_of_the_run(run):
    material, whole = stored_material(run)
    assert whole
    assert [result.name for result in material.results] == ["z_first", "a_second"]
    other = replace(RESULTS[0], seconds=99.0)
    write_checked(run / "cases" / "z_first.json", to_json(other))
    material, whole = stored_material(run)
    assert not whole
    assert material.evidence.baseline is None
    assert "stopped" in material.info.command


@pytest.mark.parametrize(
    ("name", "command", "words"),
    [
        ("05_ratio_4", "coatcheck run", ["05_ratio_4"]),
        ("05_ratio_4", "coatcheck run 05_ratio_4 mine.toml", ["05_ratio_4"]),
        ("05_ratio_4", "coatcheck run drafts/05_ratio_4.toml", ["drafts/05_ratio_4.toml"]),
        ("mine", "coatcheck run 05_ratio_4 mine.toml", ["mine.toml"]),
        ("my case", "coatcheck run 'a folder/my case.toml'", ["a folder/my case.toml"]),
        ("$(reboot)", "coatcheck run '$(reboot).toml'", ["$(reboot).toml"]),
        ("-rf", "coatcheck run -- -rf.toml", ["./-rf.toml"]),
        ("mine", "coatcheck run, stopped before its report or of several runs", ["mine.toml"]),
        ("mine", "coatcheck run 'no end", ["mine.toml"]),
    ],
)
def test_the_command_names_the_file_as_a_shell_takes_it(name, command, words):
    assert shlex.split(rerun_command(name, command)) == ["coatcheck", "run", *words]
