"""A study file becomes its points; whatever is wrong with it is one message."""

from itertools import pairwise
from pathlib import Path

import pytest
from synthetic_solves import STUDY

from verification.cases.toml_file import CaseError
from verification.study.study_plan import parse_study, thicknesses_between

PATH = Path("mine.toml")


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
        ("nu = 0.25", "nu = 0.25, adhesion = 1e9", "coating.adhesion"),
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
        ("load = 20.0", "", "load"),
        ("[sweep]", "[criteria]\nstrength = { sigma_xx_surface = -1.0 }\n[sweep]", "sigma_xx_surface"),
        ("[sweep]", "[criteria]\nstrength = { hardness = 1e9 }\n[sweep]", "criteria, strength, hardness"),
        ("[sweep]", "[criteria]\nminimise = []\n[sweep]", "criteria, minimise"),
        ("[sweep]", "[criteria]\nsafety = 0.5\n[sweep]", "criteria, safety"),
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
