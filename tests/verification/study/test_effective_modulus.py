"""Effective-modulus formulas and simple limits against the exact stiffness, and the page that shows them."""

from dataclasses import replace
from unittest import mock

import numpy as np
import pytest
from html_document import Document

from verification.report.material import Evidence, Material
from verification.report.page import render
from verification.running.result import RunInfo
from verification.running.store import read_checked
from verification.sources.references.effective_modulus import (
    FORMULAS,
    I0,
    I1,
    perriot_barthel,
    perriot_barthel_x0,
)
from verification.sources.references.flat_punch import pressed
from verification.sources.references.layer_limits import spring_bed, squeezed_film, thick
from verification.study import formulas as effective_study
from verification.study.formulas import EffectiveStudy, from_json, measure, to_json
from verification.study.usual_correction import curves

INFO = RunInfo("coatcheck run published", "2026-01-01T00:00:00+00:00", 1.0, 1, None, "a machine", {})


@pytest.fixture(scope="module")
def balls():
    return curves(points=3)


@pytest.fixture(scope="module")
def study(balls):
    """A map coarse enough for a test, curves of elastic balls too."""
    with mock.patch.object(effective_study, "curves", return_value=balls):
        return measure(points=5)


@pytest.mark.parametrize("formula", FORMULAS, ids=lambda formula: formula.name)
def test_formulas_end_at_film_and_substrate(formula):
    film, base = (3.0, 0.2), (1.0, 0.4)
    thin, thick_film = formula.modulus(film, base, np.array([1e-7, 1e7]))
    assert thin == pytest.approx(1.0 / (1 - 0.4**2), rel=1e-5)
    assert thick_film == pytest.approx(3.0 / (1 - 0.2**2), rel=1e-5)
    same = formula.modulus(base, base, np.array([0.1, 1.0, 10.0]))
    # Hay and Crawford's F, fitted to stiff films, stays where there is no film at all.
    off = 0.02 if formula.name.startswith("Hay") else 1e-12
    assert same == pytest.approx(1.0 / (1 - 0.4**2), rel=off)


def test_perriot_and_barthel_end_at_film_and_substrate():
    thin, thick_film = perriot_barthel((3.0, 0.3), (1.0, 0.3), np.array([1e-8, 1e8]), 1.2)
    assert (thin, thick_film) == pytest.approx((1 / 0.91, 3 / 0.91), rel=1e-6)
    assert perriot_barthel_x0(1.0) == pytest.approx(10**-0.093)


@pytest.mark.parametrize("nu", [0.1, 0.3, 0.5])
def test_gao_chiu_lee_1992_weight_is_the_first_derivative_of_the_exact_stiffness(nu):
    step = 1e-4
    for h in (0.3, 1.0, 3.0):
        up, down = (np.log((1 + s) * pressed(1.0, ((1 + s, nu, h),), (1.0, nu)).kappa) for s in (step, -step))
        # Central differences leave out the square of the step.
        assert (up - down) / (2 * step) == pytest.approx(float(I0(np.array(h), nu)), abs=2 * step**2)
    assert I1(np.array([1e-9, 1e9])) == pytest.approx([0, 1], abs=1e-6)


def test_thin_and_thick_limits_are_approached():
    rigid = (1e9, 0.3)
    for nu in (0.0, 0.3):
        off = []
        for a in (20.0, 40.0):
            found = pressed(a, ((1.0, nu, 1.0),), rigid)
            S, W = spring_bed(a, 1.0, nu, 1.0)
            off.append((2 * a * found.kappa / (1 - nu**2) / S - 1, found.load / W - 1))
        # The edge of the contact is left out: h/a of the whole, so half as much at twice the radius.
        assert np.array(off[0]) / np.array(off[1]) == pytest.approx([2, 2], rel=0.05)
    off = []
    for a in (25.0, 50.0):
        found = pressed(a, ((1.0, 0.5, 1.0),), rigid)
        off.append(found.load / squeezed_film(a, 1.0, 1.0)[1] - 1)
    assert 1.7 < off[0] / off[1] < 2.5
    for ratio in (0.25, 4.0):
        exact = [pressed(a, ((ratio, 0.3, 1.0),), (1.0, 0.3)).kappa for a in (0.05, 0.1)]
        laws = [thick(a, ((ratio, 0.3, 1.0),), (1.0, 0.3)) for a in (0.05, 0.1)]
        hertz, first = np.array(
            [[k / law - 1 for law in pair] for k, pair in zip(exact, laws, strict=True)]
        ).T
        assert hertz[1] / hertz[0] == pytest.approx(2, rel=0.15)
        # With the first correction what is left falls with the third power of a/h.
        assert first[1] / first[0] == pytest.approx(8, rel=0.15)


def test_the_study_says_what_it_found(study):
    assert max(study.weights) < 1e-7
    exact = np.array(study.exact)
    for name, table in study.formulas:
        middle = np.array(table)[2] / exact[2] - 1
        # E1/E2 = 1; of Hay and Crawford's formula see above.
        assert np.abs(middle).max() < (0.02 if name.startswith("Hay") else 1e-9), name
    by_name = {name: np.array(table) / exact - 1 for name, table in study.formulas}
    # To first order exact, Gao's formula fails where moduli differ much: its authors say so.
    assert np.abs(by_name["Gao, Chiu and Lee 1992"]).max() > 5
    assert np.abs(by_name["Perriot and Barthel 2004"]).max() < 0.2
    assert {one.problem["friction"] for one in study.family} == {0.0, 0.25}


def test_the_study_survives_json(study, tmp_path):
    back = from_json(to_json(study))
    assert to_json(back) == to_json(study)
    with pytest.raises(ValueError, match="run it again"):
        from_json(to_json(study) | {"schema": "other"})


def test_a_weight_that_is_not_a_number_does_not_end_the_study(study, tmp_path, monkeypatch):
    spoiled = replace(study, weights=(float("nan"), 1e-9))
    monkeypatch.setattr(effective_study, "measure", lambda: spoiled)
    effective_study.main(str(tmp_path / "study.json"))
    back = from_json(read_checked(tmp_path / "study.json"))
    assert np.array_equal(back.weights, spoiled.weights, equal_nan=True)
    assert "not finite" in render(Material([], INFO, Evidence(formulas=back)))
    assert from_json(to_json(EffectiveStudy())) == EffectiveStudy()


def test_it_runs_in_a_process_of_its_own(tmp_path, monkeypatch, study):
    monkeypatch.setattr(effective_study, "measure", lambda: study)
    task = effective_study.task(tmp_path)
    effective_study.main(task.command[-1])
    assert task.read(read_checked(task.path)).ratio == study.ratio
    assert task.failed("was killed", 2.0) == EffectiveStudy(failure="was killed", seconds=2.0)


def test_page_shows_maps_limits_and_moduli_side_by_side(study):
    page = render(Material([], INFO, Evidence(formulas=study)))
    for name, _ in study.formulas:
        assert name in page
    shown = " ".join(Document(page).whole("p"))
    assert "sliding with f = 0.25, for E1/E2 = 0.25, 0.5, 1, 2, 4" in shown
    assert page.count("Numbers as CSV") >= 4
    failed = replace(EffectiveStudy(), failure="its process <died>")
    assert "its process &lt;died&gt;" in render(Material([], INFO, Evidence(formulas=failed)))


def test_the_usual_correction_is_exact_for_a_rigid_ball_alone(balls):
    for curve in balls:
        errors = [abs(curve.usual / value - 1) for value in curve.value]
        assert errors == sorted(errors, reverse=True)
        assert errors[-1] < 0.025 < errors[0] + 0.01
