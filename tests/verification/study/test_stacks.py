"""Studies of stacks: the swept layer among fixed ones, the largest stress of all of them; templates."""

from pathlib import Path

import pytest
from synthetic_solves import STUDY

from verification.cases.toml_file import CaseError
from verification.commands.study import TEMPLATES, init
from verification.study.largest_stresses import QUANTITIES
from verification.study.study_plan import parse_study, read_study_file
from verification.study.study_point import answer, problem_of

SINGLE = "coating = { nu = 0.25 }"
HELD = '{ E = "400 GPa", nu = 0.25, thickness = 2e-5 }'
STACK = (
    STUDY.replace("modulus_ratio = [0.5, 2.0]", "")
    .replace("[2e-5, 4e-5, 8e-5]", "[2e-5]")
    .replace("cross_check = 5", "cross_check = 0")
)


def study(layers):
    return parse_study(STACK.replace(SINGLE, f"coatings = [{layers}]").encode(), Path("stack.toml"))


@pytest.mark.parametrize(
    ("layers", "thicknesses"),
    [
        ('{ E = "300 GPa", nu = 0.2 }, ' + HELD, (2e-5, 2e-5)),
        (HELD + ', { E = "300 GPa", nu = 0.2 }', (2e-5, 2e-5)),
    ],
)
def test_any_layer_is_swept(layers, thicknesses):
    (solve,) = study(layers).solves()
    problem = problem_of(solve.request, 0.25)
    assert tuple(h for *_, h in problem.coatings) == thicknesses
    swept = 0 if layers.startswith('{ E = "300') else 1
    assert problem.coatings[swept][:2] == (300e9, 0.2)
    assert problem.coatings[1 - swept][:2] == (400e9, 0.25)


@pytest.mark.parametrize(
    ("layers", "said"),
    [
        (HELD, "swept"),
        ('{ nu = 0.2 }, { E = "1 GPa", nu = 0.2 }', "swept"),
        ('{ E = "300 GPa", nu = 0.2 }, { nu = 0.25, thickness = 2e-5 }', "coating 2"),
        ('{ E = "300 GPa", nu = 0.2 }, { E = "4 GPa", nu = 0.25, thickness = 2e-9 }', "um"),
    ],
)
def test_a_bad_stack_is_one_message(layers, said):
    with pytest.raises(CaseError, match=said):
        study(layers)


def test_a_coating_in_two_halves_has_the_stresses_of_the_whole():
    """Both halves of one material: only stresses at the interface between them are more than before."""
    numerics = {"patches": 65, "estimate_uncertainty": False}
    (halves,) = study('{ E = "400 GPa", nu = 0.25 }, ' + HELD).solves()
    contact = halves.request["problem"] | {"coatings": [[400e9, 0.25, 4e-5]]}
    whole = halves.request | {"problem": contact}
    one, two = (answer(r | {"numerics": numerics})["rows"][-1] for r in (whole, halves.request))
    assert (one["status"], two["status"]) == ("solved", "solved")
    same = [q for q in QUANTITIES if q not in ("sigma_xx_base", "sigma_xz_interface", "sigma_zz_interface")]
    for name in same:
        assert two[name] == pytest.approx(one[name], rel=2e-3)
    for name in ("sigma_xx_base", "sigma_xz_interface"):
        assert two[name] >= one[name] * (1 - 1e-3)


@pytest.mark.parametrize("kind", TEMPLATES)
def test_a_template_is_written_once_and_is_a_study(kind, tmp_path, capsys):
    path = tmp_path / "mine.toml"
    assert init(kind, path) == 0
    assert (read_study_file(path).loads is None) == (kind != "load")
    assert init(kind, path) == 2
    assert str(path) in capsys.readouterr().err
