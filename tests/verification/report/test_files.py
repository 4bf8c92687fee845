"""The files of a report: whole or not at all, strict JSON, JUnit XML that fails where the run failed."""

import json
from xml.etree import ElementTree

import numpy as np
import pytest
from synthetic_results import INFO, STEEL, contact, result_of, showcase

from verification.regression.junit_xml import junit_xml
from verification.report import report_page as report_files
from verification.report.report_material import ReportMaterial
from verification.report.report_page import write_report
from verification.running import checked_files
from verification.running.case_result import SCHEMA, from_json
from verification.running.checked_files import StoreError

JUNIT = junit_xml([], INFO)


@pytest.fixture(scope="module")
def results():
    # Disagreement with inconclusive approach, NaN, crashed; few points, for only the files matter here.
    chosen = showcase(points=31)
    return [chosen[number] for number in (4, 9, 11)]


def test_a_report_is_three_files_and_nothing_else(tmp_path, results):
    page = write_report(ReportMaterial(results, INFO), tmp_path / "new" / "folder", JUNIT)
    assert page == tmp_path / "new" / "folder" / "report.html"
    assert {path.name for path in page.parent.iterdir()} == {"report.html", "report.json", "junit.xml"}


def test_an_earlier_report_survives_whatever_goes_wrong(tmp_path, results, monkeypatch):
    write_report(ReportMaterial([], INFO), tmp_path, JUNIT)
    before = {path.name: path.read_bytes() for path in tmp_path.iterdir()}

    def full(_):
        raise OSError(28, "No space left on device")

    for place, name, fault, error in (
        (checked_files.os, "fsync", full, StoreError),
        (report_files, "render", lambda _: 1 / 0, ZeroDivisionError),
    ):
        with monkeypatch.context() as patched:
            patched.setattr(place, name, fault)
            with pytest.raises(error):
                write_report(ReportMaterial(results, INFO), tmp_path, JUNIT)
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == before


def test_a_title_that_is_no_text_costs_no_report(tmp_path):
    # Lone surrogates are legal in JSON, so they can come back from a stored result.
    write_report(
        ReportMaterial([result_of(contact(), title="half \ud800 pair", points=11)], INFO), tmp_path, JUNIT
    )
    assert "half ? pair" in (tmp_path / "report.html").read_text(encoding="utf-8")


def test_json_is_strict_versioned_and_complete(tmp_path, results):
    write_report(ReportMaterial(results, INFO), tmp_path, JUNIT)
    text = (tmp_path / "report.json").read_text()
    data = json.loads(text, parse_constant=pytest.fail)
    assert data["schema"] == SCHEMA == "coatcheck-report/1"
    assert data["run"]["command"] == INFO.command
    assert data["run"]["versions"] == INFO.versions
    assert [case["name"] for case in data["cases"]] == [result.name for result in results]
    for case, result in zip(data["cases"], results, strict=True):
        back = from_json(case)
        assert back.outcome is result.outcome
        for ours, theirs in zip(result.profiles, back.profiles, strict=True):
            assert np.array_equal(ours.value, theirs.value, equal_nan=True)


def test_junit_survives_characters_that_xml_forbids():
    result = result_of(
        contact((2 * STEEL[0], 0.3, 1.0)),
        name="a\x00b\ufffe",
        title="]]>&<\x1b[31m",
        failures={"fem_reference": "bell \x07 and half a pair \ud800"},
        points=11,
    )
    root = ElementTree.fromstring(junit_xml([result], INFO).encode())
    assert root.find("testsuite").get("name") == "a\ufffdb\ufffd"
    message = root.find(".//error").get("message")
    assert "bell \ufffd and half a pair \ufffd" in message
