"""Figures of the first page follow from report.json, by a script that shares nothing with the report."""

from dataclasses import replace

import pytest
from recomputed_numbers import differing
from synthetic_results import INFO, STEEL, contact, result_of

from verification.commands.common.known_folders import RECORDS
from verification.credibility.self_tests import SelfTest
from verification.judging.invariants import Invariant
from verification.judging.verdict import Outcome
from verification.report.report_material import ReportMaterial, gather
from verification.report.report_page import write_report

LAW = Invariant("load balance", "semianalytic", 1e-7, 1e-5, Outcome.AGREES, "int p dA = W: off by 1e-07")


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    results = [
        replace(
            result_of(contact((k * STEEL[0], 0.3, 1.0), friction=f), name=f"{k}", points=31),
            invariants=(LAW,),
        )
        for k, f in ((2, 0.25), (4, 0.0))
    ]
    material = ReportMaterial(results, INFO)
    tests = (SelfTest("reader", "reads", True, "1 answer"),)
    evidence = gather(RECORDS, material.modelled, tests)
    made = tmp_path_factory.mktemp("report")
    write_report(replace(material, evidence=evidence), made, "")
    return made


def test_figures_of_the_first_page_are_those_of_the_json(folder):
    assert list(differing(folder)) == []


@pytest.mark.parametrize(
    ("shown", "wrong", "row"),
    [
        (" comparisons of 2 cases", "1 comparisons of 2 cases", ""),
        ("</span> all 2</td>", "</span> all 3</td>", "laws"),
    ],
)
def test_a_figure_that_is_off_is_found(folder, tmp_path, shown, wrong, row):
    page = (folder / "report.html").read_text(encoding="utf-8")
    assert shown in page
    (tmp_path / "report.html").write_text(page.replace(shown, wrong, 1), encoding="utf-8")
    (tmp_path / "report.json").write_bytes((folder / "report.json").read_bytes())
    (message,) = differing(tmp_path)
    assert message.startswith(row)
