"""coatcheck solve: options as a case file, table in 100 columns, JSON, figure, exit codes."""

import json
import re
from pathlib import Path

import case_texts
import pytest
from quick_case import coatcheck

from verification.cases.case_file import parse_case
from verification.commands import solve as command
from verification.desk import contact_answer as desk
from verification.desk.case_wording import case_text
from verification.desk.stack_text import stack

WORDS = ["solve", "--ball", "10 mm", "--load", "20 N", "--substrate", "210 GPa, 0.3"]
FAST = [*WORDS, "--friction", "0.25"]


def test_options_are_a_case_file():
    text = case_text(
        "10 mm, 310 GPa, 0.27",
        "20 N",
        "210e9, 0.3",
        ["0.3 um, 280 GPa, 0.21", "2 um, 180 GPa, 0.2"],
        0.15,
        ["1 um, 259 GPa, 0.22"],
    )
    problem = parse_case(text.encode(), Path("options")).problem
    assert problem.coatings == ((280e9, 0.21, 3e-7), (180e9, 0.2, 2e-6))
    assert problem.ball == (310e9, 0.27, ((259e9, 0.22, 1e-6),))
    assert (problem.radius, problem.load, problem.substrate) == (0.01, 20.0, (210e9, 0.3))
    assert problem.friction == 0.15


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ([*WORDS, "--ball-coating", "3 um, 450 GPa, 0.2"], "--ball"),
        (["solve", "05_ratio_4", "--load", "20 N"], "options"),
        (["solve", "--load", "20", "N"], "N: give a file or the options of a problem, not both; quote"),
        (["solve", "none.toml"], "none.toml"),
        ([*WORDS[:-1], '210 GPa", 0.3'], "substrate, E"),
    ],
)
def test_bad_words_end_in_one_message(words, message, tmp_path):
    done = coatcheck(*words, cwd=tmp_path)
    assert done.returncode == 2
    assert message in done.stderr
    assert done.stderr.count("\n") == 1
    assert done.stdout == ""


def test_table_fits_a_hundred_columns(tmp_path, environment):
    environment(COLUMNS="100")
    done = coatcheck(*FAST, cwd=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    lines = done.stdout.splitlines()
    assert max(map(len, lines)) <= 100
    (p0,) = [line for line in lines if line.startswith("p0")]
    assert p0.split()[1:3] == ["MPa", "1272.6"]
    (edge,) = [line for line in lines if line.startswith("sigma_xx")]
    assert edge.split()[1:] == ["surface", "706.92", *edge.split()[3:4], "-86.62", "0.00"]
    assert any(line.split()[:2] == ["4.6", "%"] for line in lines)  # of the model


def test_json_holds_everything_and_the_figure_is_written(tmp_path):
    done = coatcheck(*FAST, "--json", "--plot", "stress.png", cwd=tmp_path)
    assert done.returncode == 0
    content = json.loads(done.stdout, parse_constant=lambda name: pytest.fail(name))
    assert content["answer"]["numbers"]["peak_pressure"][0] == pytest.approx(1272.6e6, rel=1e-4)
    assert {e["quantity"] for e in content["answer"]["extremes"]} == {
        "sigma_xx",
        "sigma_1",
        "von_mises",
        "tau_max",
    }
    assert content["problem"]["friction"] == 0.25
    assert content["warnings"] == []
    assert content["check"] is None
    model = content["model_error"]
    assert {cost["quantity"] for cost in model["costs"]} > {"peak_pressure", "tension"}
    (course,) = content["answer"]["courses"]
    assert len(course["x"]) == len(course["stress"][0])
    assert parse_case(content["case_file"].encode(), Path("again.toml")).problem.radius == 0.01
    assert (tmp_path / "stress.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize("name", ["DLC", "100Cr6", "a-C:H", "tool steel", "WC/C"])
def test_a_solid_may_have_a_name(name):
    text = case_text("10 mm", "20 N", f"{name} 210 GPa, 0.3", ["2 um, 180 GPa, 0.2"])
    case = parse_case(text.encode(), Path("options"))
    assert case.problem.substrate == (210e9, 0.3)
    assert stack(case).endswith(f" / {name}")


def test_check_shows_the_differences_and_fails_beyond_both_uncertainties(tmp_path, monkeypatch):
    def made(problem, source, *_):
        found = desk.answer(problem, "hertz")
        off = 1.0 if source == "semianalytic" else factor
        numbers = {name: (off * value, 1e-6 * value) for name, (value, _) in found.numbers.items()}
        return desk.ContactAnswer(source, 0.1, numbers, found.extremes, found.courses)

    monkeypatch.setattr(command, "answer", made)
    for given, code in ((1 + 1e-6, 0), (1 + 1e-5, 1)):
        factor = given
        done = coatcheck(*FAST, "--check", cwd=tmp_path)
        assert done.returncode == code
        assert re.search(r"p0 +MPa .* \+1\.3e-0[23]", done.stdout)
        assert ("3 of 7" in " ".join(done.stdout.split())) == (code == 1)


def test_a_check_that_is_refused_leaves_the_answer_of_the_patches(tmp_path, monkeypatch):
    def made(problem, source, *_):
        if source == "fem_reference":
            raise ValueError("too many nodes; give thicker films")
        return desk.answer(problem, "hertz")

    monkeypatch.setattr(command, "answer", made)
    alone, checked = (coatcheck(*FAST, *more, cwd=tmp_path) for more in ((), ("--check",)))
    assert (alone.returncode, checked.returncode) == (0, 3)
    said = [line for line in checked.stdout.splitlines() if not line.startswith("time")]
    assert set(said) >= {line for line in alone.stdout.splitlines() if not line.startswith("time")}
    for text in (" ".join(checked.stdout.split()), checked.stderr):
        assert "Not checked, as the finite elements refuse this contact: too many nodes; give thicker" in text
    content = json.loads(coatcheck(*FAST, "--check", "--json", cwd=tmp_path).stdout)
    assert (content["check"], content["differences"]) == (None, [])
    assert content["check_refused"].endswith("too many nodes; give thicker films")


def test_what_cannot_be_solved_is_no_result(tmp_path, monkeypatch):
    def fails(*_):
        raise ValueError("the iteration stopped")

    monkeypatch.setattr(command, "answer", fails)
    done = coatcheck(*FAST, cwd=tmp_path)
    assert done.returncode == 3
    assert "semianalytic" in done.stderr


def test_peak_pressure_of_the_solution_is_compared_with_limits(tmp_path):
    """Under a stiff coating p0 exceeds that of Hertz on the substrate."""
    path = tmp_path / "hard.toml"
    path.write_text(
        case_texts.case_text('E = "420 GPa"; nu = 0.3; thickness = "90 um"; hardness = "1.3 GPa"')
    )
    done = coatcheck("solve", str(path), cwd=tmp_path)
    assert done.returncode == 0
    assert "coating 1, hardness" in done.stderr
    assert coatcheck("solve", str(path), "--strict", cwd=tmp_path).returncode == 2
