"""Studies of ellipses find the largest stresses that solve finds, without friction in either plane."""

from pathlib import Path

import pytest
from case_texts import study_text

from verification.cases.toml_file import CaseError
from verification.desk.contact_answer import answer as solved
from verification.study.largest_stresses import QUANTITIES
from verification.study.study_engine import forecast
from verification.study.study_plan import parse_study
from verification.study.study_point import answer, problem_of, table_rows

FAST = {"patches": 65, "estimate_uncertainty": False}
NUMERICS = "[semianalytic]\npatches = 65\nestimate_uncertainty = false\n"


def study(frictions, *indenter, radius=""):
    given = (*indenter, "coating = { E = 420e9, nu = 0.25 }")
    text = study_text(
        *given, sweep=f"thickness = [40e-6]; friction = {frictions}", radius=radius, tables=NUMERICS
    )
    return parse_study(text.encode(), Path("ellipse.toml"))


def ellipse(radii, frictions):
    return study(frictions, f'indenter = {{ shape = "ellipsoid", radii = {list(radii)} }}')


def rows_of(found):
    solve = next(found.solves())
    return table_rows(0, solve.key, solve.request, answer(solve.request), solve.places)


@pytest.mark.slow
def test_a_sliding_ellipse_has_the_stresses_of_solve():
    found = ellipse((8e-3, 4e-3), [0.0, 0.25])
    assert [one.source for one in found.solves()] == ["semianalytic", "fem_reference"]
    problem = problem_of(next(found.solves()).request, 0.25)
    expected = solved(problem, "semianalytic", FAST)
    largest = {(at.quantity, at.where): at.value for at in expected.extremes}
    base = next(line for line in expected.courses if line.where == "base of coating 1")
    known = {
        "sigma_xx_surface": largest["sigma_xx", "surface"],
        "sigma_xx_base": base.stress[:2].max(),
        "sigma_xz_interface": largest["|sigma_xz|", "interface 1"],
        "von_mises_coating": largest["von_mises", "coating 1"],
        "von_mises_substrate": largest["von_mises", "substrate"],
    }
    row = rows_of(found)[1]
    assert row["indenter"] == '["ellipsoid", [0.008, 0.004]]'
    for name, value in known.items():
        assert row[name] == pytest.approx(value, abs=1e-4 * row["peak_pressure"]), name


@pytest.mark.slow
def test_exchanging_the_axes_changes_nothing_without_friction():
    one, other = (rows_of(ellipse(radii, [0.0]))[0] for radii in ((8e-3, 4e-3), (4e-3, 8e-3)))
    for name in QUANTITIES:
        assert other[name] == pytest.approx(one[name], abs=1e-6 * one["peak_pressure"]), name


def test_the_forecast_knows_that_ellipses_take_longer(tmp_path):
    _, seconds = forecast(ellipse((8e-3, 4e-3), [0.0]), tmp_path)
    assert seconds > 30


def test_indenters_that_are_no_ellipsoids_are_refused():
    with pytest.raises(CaseError, match="asperities"):
        study([0.0], 'indenter = { shape = "asperities", distance = 1e-4 }', radius="1e-2")
