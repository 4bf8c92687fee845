"""The study of effective-modulus formulas and the page that shows it."""

from dataclasses import replace
from unittest import mock

import numpy as np
import pytest

from verification.report.report_material import Evidence, Material
from verification.report.report_page import render
from verification.running.case_result import RunInfo
from verification.running.checked_files import read_checked
from verification.study import formula_errors as effective_study
from verification.study.formula_errors import EffectiveStudy, curves, from_json, measure, to_json

INFO = RunInfo("coatcheck run published", "2026-01-01T00:00:00+00:00", 1.0, 1, None, "a machine", {})


@pytest.fixture(scope="module")
def balls():
    return curves(points=3)


@pytest.fixture(scope="module")
def study(balls):
    """A map coarse enough for a test, curves of elastic balls too."""
    with mock.patch.object(effective_study, "curves", return_value=balls):
        return measure(points=5)


def test_the_study_says_what_it_found(study):
    exact = np.array(study.exact)
    for name, table in study.formulas:
        middle = np.array(table)[2] / exact[2] - 1
        # E1/E2 = 1; of Hay and Crawford's formula see above.
        assert np.abs(middle).max() < (0.02 if name.startswith("Hay") else 1e-9), name
    by_name = {name: np.array(table) / exact - 1 for name, table in study.formulas}
    # To first order exact, Gao's formula fails where moduli differ much: its authors say so.
    assert np.abs(by_name["Gao, Chiu and Lee 1992"]).max() > 5
    assert np.abs(by_name["Perriot and Barthel 2004"]).max() < 0.2


def test_the_study_survives_json(study, tmp_path):
    back = from_json(to_json(study))
    assert to_json(back) == to_json(study)
    with pytest.raises(ValueError, match="run"):
        from_json(to_json(study) | {"schema": "other"})


def test_a_number_that_is_not_finite_does_not_end_the_study(study, tmp_path, monkeypatch):
    spoiled = replace(study, exact=((float("nan"),) * 5, *study.exact[1:]))
    monkeypatch.setattr(effective_study, "measure", lambda: spoiled)
    effective_study.main(tmp_path / "study.json")
    back = from_json(read_checked(tmp_path / "study.json"))
    assert np.array_equal(back.exact, spoiled.exact, equal_nan=True)
    assert render(Material([], INFO, Evidence(formulas=back)))
    assert from_json(to_json(EffectiveStudy())) == EffectiveStudy()


def test_it_runs_in_a_process_of_its_own(tmp_path, monkeypatch, study):
    monkeypatch.setattr(effective_study, "measure", lambda: study)
    task = effective_study.task(tmp_path)
    task.work()
    assert task.read(read_checked(task.path)).ratio == study.ratio
    assert task.failed("was killed", 2.0) == EffectiveStudy(failure="was killed", seconds=2.0)


def test_page_shows_maps_limits_and_moduli_side_by_side(study):
    page = render(Material([], INFO, Evidence(formulas=study)))
    for name, _ in study.formulas:
        assert name in page
    assert page.count("Numbers as CSV") == 1
    failed = replace(EffectiveStudy(), failure="its process <died>")
    assert "process" in render(Material([], INFO, Evidence(formulas=failed)))


def test_the_usual_correction_is_exact_for_a_rigid_ball_alone(balls):
    for curve in balls:
        errors = [abs(curve.usual / value - 1) for value in curve.value]
        assert errors == sorted(errors, reverse=True)
        assert errors[-1] < 0.025 < errors[0] + 0.01
