"""Numbers that a report displays follow from its report.json, by a script that shares nothing with it."""

import random
import re
from dataclasses import replace

import numpy as np
import pytest
from recomputed_numbers import differing, pages
from synthetic_results import INFO, STEEL, contact, result_of
from synthetic_study import study

from verification.commands.common.known_folders import RECORDS
from verification.credibility.self_tests import SelfTest
from verification.judging.invariants import Invariant
from verification.judging.verdict import Outcome
from verification.regression.baseline_change import regression, updated
from verification.report.report_material import ReportMaterial, gather
from verification.report.report_page import write_report
from verification.sampling.stress_plane import StressPlane

LAW = Invariant("load balance", "semianalytic", 1e-7, 1e-5, Outcome.AGREES, "int p dA = W: off by 1e-07")
ALTERED, NOTICED = 60, 0.85  # numbers altered at once, one on a line; share of them to be noticed


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    results = [
        replace(
            result_of(contact((k * STEEL[0], 0.3, 1.0), friction=f), name=f"{k}", points=31),
            invariants=(LAW,),
        )
        for k, f in ((2, 0.25), (4, 0.0))
    ]
    grid, stress = np.linspace(0.0, 1e-4, 3), np.linspace(-1e9, 1e9, 36).reshape(4, 3, 3)
    drawn = {"semianalytic": (stress,), "fem_reference": (1.001 * stress,)}
    plane = StressPlane(grid, (grid,), 8e-5, drawn, {})
    planes = {result.name: plane for result in results}
    material = ReportMaterial(results, INFO, planes=planes)
    tests = (SelfTest("reader", "reads", True, "1 answer"),)
    baseline = regression(results, updated(None, results, INFO, "first", INFO.started), "b", INFO)
    evidence = gather(RECORDS, material.modelled, tests)
    made = tmp_path_factory.mktemp("report")
    write_report(replace(material, evidence=replace(evidence, accuracy=study(), baseline=baseline)), made, "")
    return made


def test_every_number_of_every_page_follows_from_the_json(folder):
    names = [name for name, _ in pages((folder / "report.html").read_text(encoding="utf-8"))]
    assert {"first", "case-2", "cases", "credibility", "accuracy", "model", "baseline"} < {*names}
    assert list(differing(folder)) == []


def test_a_number_that_is_altered_in_its_last_digit_is_noticed(folder, tmp_path):
    lines = (folder / "report.html").read_text(encoding="utf-8").split("\n")
    cells = {n: re.search(r"(?<=<td class=\" num\")[^>]*>[^<]*\d(?=<| )", one) for n, one in enumerate(lines)}
    for n in random.Random(1).sample([n for n, cell in cells.items() if cell], ALTERED):
        at = cells[n].end() - 1
        lines[n] = f"{lines[n][:at]}{(int(lines[n][at]) + 1) % 10}{lines[n][at + 1 :]}"
    (tmp_path / "report.html").write_text("\n".join(lines), encoding="utf-8")
    (tmp_path / "report.json").write_bytes((folder / "report.json").read_bytes())
    rows = {message.rpartition(" in ")[2] for message in differing(tmp_path)}
    assert NOTICED * ALTERED <= len(rows) <= ALTERED
