"""A study file becomes its points; whatever is wrong with it is one message."""

from itertools import pairwise
from pathlib import Path

import pytest
from synthetic_solves import STUDY

from verification.cases.toml_file import CaseError
from verification.study.study_plan import parse_study, read_study_file, shipped_studies, thicknesses_between

PATH = Path("mine.toml")


def test_default_study_is_four_ratios_by_24_thicknesses_by_three_frictions():
    study = read_study_file(shipped_studies()["default"])
    assert [E / study.substrate[0] for E in study.moduli] == [0.25, 0.5, 2.0, 4.0]
    assert len(study.thicknesses) == 24
    assert study.frictions == (0.0, 0.25, 0.5)
    assert study.points == 288
    a_h = (0.75 * study.load * study.radius * (1 - 0.3**2) / 210e9) ** (1 / 3)
    assert study.thicknesses[0] == pytest.approx(0.05 * a_h, rel=1e-12, abs=0)
    assert study.thicknesses[-1] == pytest.approx(5 * a_h, rel=1e-12, abs=0)


def test_thicknesses_crowd_around_their_geometric_middle():
    h = thicknesses_between(0.05, 5.0, 25)
    ratios = [b / a for a, b in pairwise(h)]
    assert (h[0], h[-1]) == (0.05, 5.0)
    assert h[12] == pytest.approx(0.5, rel=1e-12)
    assert min(ratios) == pytest.approx(min(ratios[11:13]))
    assert ratios[0] == pytest.approx(max(ratios))
    assert max(ratios) > 1.2 * min(ratios) > 1


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("radius = 10e-3", "radios = 10e-3", "radios"),
        ("load = 20.0", 'load = "heavy"', "load"),
        ("load = 20.0", "load = 1e12", "load"),
        ("nu = 0.25", "nu = 0.25, expansion = 1e-5", "coating"),
        ("nu = 0.25", "nu = 0.25, expansion = 1e-5, residual_stress = 1e9", "both"),
        ("[sweep]", "[sweep]\nload = { from = 1.0, to = 9.0, count = 5 }", "load"),
        ("nu = 0.25", "nu = 0.25, E = 1e9", "sweep.modulus_ratio"),
        ("modulus_ratio = [0.5, 2.0]", "", "sweep.modulus_ratio"),
        ("modulus_ratio = [0.5, 2.0]", "modulus_ratio = [5e4]", "5e+04"),
        ("[2e-5, 4e-5, 8e-5]", "[2e-5, 4.0]", "sweep.thickness"),
        ("[2e-5, 4e-5, 8e-5]", '["1 N"]', "sweep, thickness, value 1"),
        ("[2e-5, 4e-5, 8e-5]", "{ from = 2e-5, to = 1e-5, count = 3 }", "sweep, thickness"),
        ("[2e-5, 4e-5, 8e-5]", "[2e-5]\nthickness_over_a_h = [1.0]", "thickness"),
        ("friction = [0.0, 0.25]", "friction = [-0.1]", "sweep, friction, value 1"),
        ("[sweep]", "[semianalytic]\npatches = 5\n[sweep]", "semianalytic, patches"),
        ("[2e-5, 4e-5, 8e-5]", "{ from = 1e-5, to = 1e-4, count = 99999 }", "points"),
        ("[sweep]", "[sweep", "TOML"),
    ],
)
def test_bad_study_is_one_sentence_with_file_and_key(old, new, said):
    text = STUDY.replace(old, new, 1)
    if "99999" in new:
        text = text.replace("[0.0, 0.25]", f"{[0.1] * 200}")
    with pytest.raises(CaseError) as caught:
        parse_study(text.encode(), PATH)
    message = str(caught.value)
    assert message.startswith("mine.toml")
    assert said in message
    assert "\n" not in message


def test_all_errors_of_a_file_are_one_message():
    text = STUDY.replace("nu = 0.25", "nu = 0.6").replace("load = 20.0", "load = -1.0")
    text = text.replace("cross_check = 5", "cross_check = 2.5")
    with pytest.raises(CaseError) as caught:
        parse_study(text.encode(), PATH)
    unknown = [f"surplus_{k}" for k in range(7)]
    with pytest.raises(CaseError) as listed:
        parse_study(("".join(f"{key} = 1\n" for key in unknown) + text).encode(), PATH)
    assert all(f"{key} is an unknown key" in str(listed.value) for key in unknown)
    for key in ("coating, nu", "load", "sweep, cross_check"):
        assert key in str(caught.value)
