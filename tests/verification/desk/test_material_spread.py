"""Ranges of materials as an interval of the answer; thickness of the sample; growth and mismatch."""

import csv
import json
from pathlib import Path

import pytest
from quick_case import coatcheck

from verification.cases.case_file import parse_case, with_moduli
from verification.cases.materials import SHIPPED
from verification.credibility.model_error import HALF_SPACES, model_error
from verification.desk.case_wording import case_text
from verification.desk.contact_answer import answer
from verification.desk.layer_limits import layer_modes, strengths_of
from verification.desk.material_spread import MaterialRange, ranges_of, spread
from verification.problem.coated_contact import CoatedContact
from verification.problem.display_units import prefixed

FAST = {"estimate_uncertainty": False, "patches": 65}
OPTIONS = {
    "--ball": "6 mm",
    "--load": "20 N",
    "--coating": "DLC 2 um, strength 1 GPa",
    "--substrate": "100Cr6",
}


def case_of(*coatings, **more):
    return parse_case(case_text("6 mm", "20 N", "100Cr6", coatings, **more).encode(), Path("mine"))


def test_an_uncoated_contact_moves_as_hertz_has_it():
    # p0 ~ E*^(2/3): of a flat alone whose E goes from 200 to 220 GPa
    case = case_of()
    first = answer(case.problem, "semianalytic", FAST)
    steel = MaterialRange("100Cr6", 200e9, 220e9, (("flat", 0),))
    found = spread(case, first, (steel,), FAST)
    p0 = case.problem.p_h
    expected = [p0 * (E / 210e9) ** (2 / 3) for E in (200e9, 220e9)]
    assert found.ends["peak_pressure",] == pytest.approx(expected, rel=1e-4)
    assert "100Cr6 200 GPa to 220 GPa" in found.sentence(case, ())


def test_ranges_come_from_names_with_typical_values_and_one_material_moves_together():
    own = ranges_of(case_of("DLC 2 um", "DLC 1 um", "a-C:H 2 um, 120 GPa, 0.25", "Cr 1 um"), SHIPPED)
    assert [(one.name, one.low, one.high, one.places) for one in own] == [
        ("a-C:H", 100e9, 200e9, (("flat", 0), ("flat", 1)))
    ]


@pytest.mark.slow
def test_changes_of_several_materials_add_up_and_a_mismatch_follows_its_modulus():
    coatings = ("DLC 2 um, expansion 3e-6", "ta-C 1 um, expansion 3e-6")
    text = case_text("6 mm", "20 N", "100Cr6, expansion 11e-6", coatings, temperature_change=-300.0)
    steel = parse_case(text.encode(), Path("x"))
    first = answer(steel.problem, "semianalytic", FAST, steel.residual)
    ranges = ranges_of(steel, SHIPPED)
    assert [one.name for one in ranges] == ["a-C:H", "ta-C"]
    alone = [spread(steel, first, (one,), FAST).ends for one in ranges]
    both = spread(steel, first, ranges, FAST)
    key, value = ("flat", "sigma_xx", "surface"), first.extremes[0].value
    for end in (0, 1):
        assert both.ends[key][end] - value == pytest.approx(sum(one[key][end] - value for one in alone))
    assert both.shares[key][0] == "a-C:H"
    # 8e-6 times -300 K times E/(1 - nu)
    moved = with_moduli(steel, {("flat", 0): 200e9}).residual["flat"][0]
    assert moved == pytest.approx(-8e-6 * 300 * 200e9 / 0.75)


@pytest.mark.parametrize(
    ("strength", "said"),
    [
        pytest.param("2 GPa", "holds", marks=pytest.mark.slow),
        pytest.param("1 MPa", "fails", marks=pytest.mark.slow),
        ("middle", "depends"),
    ],
)
def test_a_verdict_over_the_ranges_is_said(strength, said):
    case = case_of("DLC 2 um")
    first = answer(case.problem, "semianalytic", FAST)
    ends = spread(case, first, ranges_of(case, SHIPPED), FAST).ends["flat", "sigma_1", "coating 1"]
    strength = f"{sum(ends) / 2e6} MPa" if strength == "middle" else strength
    judged = case_of(f"DLC 2 um, strength {strength}")
    modes = layer_modes(judged.problem, first, strengths_of(judged.limits), loads=False)
    found = spread(judged, first, ranges_of(judged, SHIPPED), FAST)
    assert f"The verdict {said}" in found.sentence(judged, modes)


@pytest.mark.slow
def test_the_command_shows_the_range_and_writes_every_number(tmp_path):
    options = [part for pair in OPTIONS.items() for part in pair]
    done = coatcheck("solve", *options, "--spread", "--csv", "out.csv", "--json", cwd=tmp_path)
    content = json.loads(done.stdout)
    rows = list(csv.DictReader((tmp_path / "out.csv").read_text().splitlines()))
    assert len(rows) == 3 + len(content["answer"]["extremes"])
    assert [row["quantity"] for row in rows[:2]] == ["peak_pressure", "contact_radius"]
    for row in rows:
        value, low, high = (float(row[head]) for head in ("value", "lowest", "highest"))
        assert low <= value <= high
    assert float(rows[0]["highest"]) == pytest.approx(content["spread"]["ends"]["peak_pressure"][1])
    plain = coatcheck("solve", *options, cwd=tmp_path)
    assert "100 GPa to 200 GPa: see what follows with --spread" in " ".join(plain.stdout.split())
    assert plain.stdout.index("the model itself") < plain.stdout.index("source: typical values: 100Cr6")


@pytest.mark.parametrize(
    ("more", "said"),
    [
        (["--coating", "2 um, 150 GPa, 0.25", "--spread"], "no material given by name has a range"),
        (["--csv", "out.txt"], "has to end in .csv, .xlsx"),
        (["--csv", "none/out.csv"], "no folder none"),
        (["--thickness-of-sample", "1 um"], "above 2 um"),
        (["--thickness-of-sample", "1 GPa"], "--thickness-of-sample"),
        (["--temperature-change=-200"], "temperature_change"),
    ],
)
def test_wrong_options_are_one_message_and_write_nothing(more, said, tmp_path):
    options = OPTIONS if "--coating" not in more else {k: v for k, v in OPTIONS.items() if k != "--coating"}
    done = coatcheck("solve", *(part for pair in options.items() for part in pair), *more, cwd=tmp_path)
    assert (done.returncode, done.stdout) == (2, "")
    assert said in done.stderr
    assert list(tmp_path.iterdir()) == []


def test_a_thin_sample_costs_what_its_thickness_makes_it_cost():
    # a rigid ball on a disc of thickness t: the approach changes by about a/t
    problem = CoatedContact(5e-3, 20.0, (), (210e9, 0.3))
    costs = {}
    for t in (0.5e-3, 1e-3, 2e-3):
        error = model_error(problem, sample=t)
        title = f"half-spaces for the ball and a disc of {prefixed(t, 'm')}"
        costs[t] = error.largest(("approach",), title).size
        assert error.largest(assumption=HALF_SPACES) is None
    assert costs[0.5e-3] == pytest.approx(2 * costs[1e-3], rel=0.05)
    assert costs[1e-3] == pytest.approx(2 * costs[2e-3], rel=0.05)
    thin = model_error(problem, sample=0.5e-3)
    assert any("a disc of 500 um" in line for line in thin.warnings()) == (costs[0.5e-3] > 0.05)


def test_stress_of_growth_and_of_mismatch_add_up():
    words = ("TiN 2 um, 450 GPa, 0.25, residual -1.5 GPa, expansion 9e-6",)
    text = case_text("6 mm", "20 N", "steel 210 GPa, 0.3, expansion 12e-6", words, temperature_change=-400.0)
    residual = parse_case(text.encode(), Path("both")).residual["flat"][0]
    # E/(1 - nu) (alpha_s - alpha) dT = 600 GPa times 3e-6 times -400
    assert residual == pytest.approx(-1.5e9 - 0.72e9)
