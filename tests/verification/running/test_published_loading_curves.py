"""Published loading curves: read, refused where malformed, met or not."""

import numpy as np
import pytest
from html_document import Document

from verification.cases.published_file import published_cases, read_published
from verification.judging.verdict import Outcome
from verification.problem.loading_curve import LoadingCurve
from verification.report.report_material import ReportMaterial
from verification.report.report_page import render
from verification.running.case_result import RunInfo, from_json, to_json
from verification.running.published_run import run
from verification.sources.source_registry import EXACT, solvers

SHIPPED = published_cases()
INFO = RunInfo("coatcheck run published", "2026-01-01T00:00:00+00:00", 1.0, 1, None, "a machine", {})
TOML = """
title = "A layer"
source = "nobody"
year = 1900

[problem]
length_unit = "mm"
stress_unit = "MPa"
radius = 10.0
substrate = { E = 1e9, nu = 0.3 }
coatings = [ { E = 2.0, nu = 0.3, thickness = 0.5 } ]

[[table]]
file = "t.csv"
seen = "primary"
read = "written for this test"
at = { contact_radius = "a", unit = "h" }
column = [
    { name = "k", quantity = "kappa", unit = "1" },
    { name = "old", quantity = "kappa", unit = "1" },
    { name = "d", quantity = "approach", unit = "h^2/R", uncertainty = 0.006 },
    { name = "s", quantity = "series_over_kappa", unit = "1", series = [1.0, 0.5] },
]
"""
# kappa of Hayes and others, nu = 0.3; (1 + X + X^2/2)/kappa with it.
CSV = (
    "a,k,old,d,s,old_departure\n0.2,1.206558,1.20,0.03,1.0111,0.0066\n1.0,2.483525,2.50,0.6,1.0066,-0.0165\n"
)


@pytest.fixture
def files(tmp_path):
    """Writes a case of one table and reads it."""

    def read(csv=CSV):
        (tmp_path / "t.csv").write_text(csv)
        (tmp_path / "curve.toml").write_text(TOML)
        return read_published(tmp_path / "curve.toml")

    return read


def test_a_sphere_without_a_load_is_a_loading_curve(files):
    case = files()
    layers = ((2e6, 0.3, 0.5e-3),), (1e15, 0.3)
    assert case.problem == LoadingCurve(10e-3, "contact_radius", (1e-4, 5e-4), *layers)
    kappa, old, approach, series = case.columns
    assert kappa.at.coordinate == "a"
    assert approach.profile.value == pytest.approx(np.array([0.03, 0.6]) * 0.25e-6 / 10e-3, rel=1e-14, abs=0)
    assert approach.profile.uncertainty == pytest.approx(
        np.full(2, 0.006) * 0.25e-6 / 10e-3, rel=1e-14, abs=0
    )
    assert old.departs.all()
    assert series.series == (1.0, 0.5)
    assert {claim.line.rsplit(" ", 1)[1] for claim in case.claims} == {"k", "old", "d", "s"}


def run_exactly(case):
    """The result by the exact reference alone; the verdicts on it by column."""
    result = run(case, {"integral_equation": solvers()["integral_equation"]})
    return result, {c.line.rsplit(" ", 1)[1]: v for c, v in result.verdicts if EXACT[0] in c.between}


def test_every_value_is_judged_and_departures_are_shown(files):
    result, judged = run_exactly(files())
    assert {judged[name].outcome for name in ("k", "s", "old")} == {Outcome.AGREES}
    assert from_json(to_json(result)).problem["control"] == "contact_radius"
    page = render(ReportMaterial([result], INFO))
    assert "Departures" in page
    assert "stiffness" in " ".join(Document(page).whole("figcaption"))
    _, judged = run_exactly(files(csv=CSV.replace("2.483525", "2.483535")))
    assert judged["k"].outcome is Outcome.DISAGREES


@pytest.mark.parametrize(
    "name", [n for n in SHIPPED if isinstance(read_published(SHIPPED[n]).problem, LoadingCurve)]
)
def test_exact_reference_meets_every_shipped_curve(name):
    _, judged = run_exactly(read_published(SHIPPED[name]))
    assert [v.reason for v in judged.values() if v.outcome is not Outcome.AGREES] == []
