"""Wrong inputs of coatcheck solve, each one message that names the remedy; nothing is written."""

import pytest
from quick_case import coatcheck

GIVEN = {
    "--ball": "10 mm, 210 GPa, 0.3",
    "--load": "20 N",
    "--coating": "2 um, 180 GPa, 0.2",
    "--substrate": "210 GPa, 0.3",
    "--friction": "0.15",
}

# Options changed (None leaves one out), and a word of the remedy.
WRONG = [
    ({"--diameter": "20 mm"}, "d = 20 mm"),
    ({"--mu": "0.1"}, "--friction"),
    ({"--nonsense": "1"}, "solve --help"),
    ({"--ball": None}, "--ball"),
    ({"--friction": "0,15"}, "point"),
    ({"--friction": "3"}, "most"),
    ({"--friction": "nan"}, "finite"),
    ({"--load": "-20"}, "above"),
    ({"--load": "20 kg"}, "20 N"),
    ({"--load": "heavy"}, "20 N"),
    ({"--load": "1e9 N"}, "load"),
    ({"--ball": "10,5 mm, 210 GPa, 0,3"}, "point"),
    ({"--ball": "10 mm, 210 GPa"}, "radius, E, nu"),
    ({"--ball": "10 mm, 0.3, 210 GPa"}, "nu"),
    ({"--ball": "10 m, 210 GPa, 0.3"}, "--force"),
    ({"--ball": "10, 210e9, 0.3"}, "mm"),
    ({"--ball": "d = 20, 210e9, 0.3"}, "mm"),
    ({"--ball": "10 mm, 210, 0.3"}, "GPa"),
    ({"--ball": "10 mm, 210 GPa, 0.5"}, "0.49"),
    ({"--substrate": "210, 0.3"}, "GPa"),
    ({"--substrate": "210000, 0.3"}, "MPa"),
    ({"--substrate": "210 GPa"}, "E, nu"),
    ({"--substrate": "210 gpa, 0.3"}, "GPa"),
    ({"--substrate": "steel, 0.3"}, "210 GPa"),
    ({"--substrate": "5 TPa, 0.3"}, "--force"),
    ({"--coating": "2, 180e9, 0.2"}, "um"),
    ({"--coating": "0.002, 180e9, 0.2"}, "mm"),
    ({"--coating": "20 mm, 180 GPa, 0.2"}, "--force"),
    ({"--coating": "2 um, 180 GPa"}, "thickness, E, nu"),
    ({"--coating": "2 um, 2 MPa, 0.49"}, "smallest"),
    ({"--coating": "1 nm, 180 GPa, 0.2"}, "0.109 um"),
    ({"--plot": "missing/stress.png"}, "create"),
    ({"--plot": "stress.gif"}, ".png"),
]


@pytest.mark.parametrize(("changed", "remedy"), WRONG, ids=lambda value: str(value)[:60])
def test_a_wrong_input_is_one_message_with_its_remedy(changed, remedy, tmp_path):
    words = [word for option in (GIVEN | changed).items() if option[1] is not None for word in option]
    done = coatcheck("solve", *words, cwd=tmp_path)
    assert (done.returncode, done.stdout, list(tmp_path.iterdir())) == (2, "", [])
    errors = [line for line in done.stderr.splitlines() if "warning" not in line]
    assert len(errors) == 1
    assert remedy in errors[0]


def test_implausible_numbers_are_solved_with_force_and_a_warning(tmp_path):
    words = ["solve", "--ball", "2 m", "--load", "20 N", "--substrate", "210 GPa, 0.3"]
    assert coatcheck(*words, cwd=tmp_path).returncode == 2
    done = coatcheck(*words, "--force", cwd=tmp_path)
    assert done.returncode == 0
    assert "radius = 2 m" in done.stderr


def test_a_ball_far_stiffer_than_the_flat_is_rigid(tmp_path):
    words = ["solve", "--load", "1 mN", "--substrate", "2 MPa, 0.49", "--friction", "0.1", "--ball"]
    elastic = coatcheck(*words, "10 mm, 210 GPa, 0.3", cwd=tmp_path)
    assert (elastic.returncode, elastic.stderr.count("rigid")) == (0, 1)


def test_an_indenter_that_is_no_ball_is_refused_by_solve(tmp_path):
    done = coatcheck("solve", "24_ellipse", cwd=tmp_path)
    assert done.returncode == 2
    assert "indenter" in done.stderr
    assert not list(tmp_path.iterdir())
