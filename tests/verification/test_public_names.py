"""The names that a user of the package meets first: read_case, solve, compare."""

import inspect
import pydoc
from xml.etree import ElementTree

import pytest
from quick_case import QUICK

import semianalytic
import verification
from verification.desk.case_wording import case_text
from verification.judging.outcome import Outcome
from verification.sources.references import integral_equation


def test_a_shipped_case_and_its_file_are_read_and_solved_alike(tmp_path):
    case = verification.read_case("05_ratio_4")
    path = tmp_path / "same.toml"
    path.write_text(case.text, encoding="utf-8")
    assert verification.read_case(path).problem == case.problem
    p = case.problem
    exact = integral_equation.solve(
        radius=p.radius, load=p.load, coatings=p.coatings, substrate=p.substrate, friction=p.friction
    )
    assert verification.solve(case, "integral_equation").peak_pressure == exact.peak_pressure
    quick = verification.solve(case.problem, patches=65, accuracy=None)
    assert quick.peak_pressure == pytest.approx(exact.peak_pressure, rel=1e-4)


@pytest.mark.parametrize(
    ("source", "numerics"),
    [("semianalytic", {"patches": 65, "accuracy": None}), ("fem_reference", {"quality": "fast"})],
)
def test_words_with_units_state_a_problem_and_a_notebook_shows_its_solution(source, numerics):
    words = {"ball": "10 mm", "load": "20 N", "substrate": "210 GPa, 0.3", "coatings": "70 um, 420 GPa, 0.25"}
    case = verification.state(**words)
    assert case.problem == verification.state(**words | {"ball": 0.01, "load": 20}).problem
    found = verification.solve(case, source, **numerics)
    shown = ElementTree.fromstring(f"<div>{found._repr_html_()}</div>")
    rows = {cells[0].text: cells[1:] for row in shown.iter("tr") if (cells := row.findall("td"))}
    for label, value in (
        ("peak pressure [MPa]", found.peak_pressure / 1e6),
        ("approach [µm]", found.approach / 1e-6),
    ):
        assert float(rows[label][0].text) == pytest.approx(value, rel=1e-5)
        assert float(rows[label][1].text) > 0
    for line in shown.iter("polyline"):  # p0 stands 105 above the axis, at the middle of 131 points
        assert float(line.get("points").split()[65].split(",")[1]) == pytest.approx(25, abs=0.1)


def test_the_help_of_a_solution_names_arrays_as_its_code_does():
    text = pydoc.plain(pydoc.render_doc(semianalytic.Solution))
    assert "stress(self, x: 'ArrayLike', y: 'ArrayLike'" in text
    assert "numpy._typing" not in text + pydoc.plain(pydoc.render_doc(semianalytic.solve))
    assert "collections.abc" not in pydoc.plain(pydoc.render_doc(verification.state))


def test_a_source_that_does_not_solve_a_problem_is_refused_with_those_that_do():
    with pytest.raises(ValueError, match="solved by semianalytic, fem_reference, integral_equation"):
        verification.solve(verification.read_case("05_ratio_4"), "hertz")
    with pytest.raises(ValueError, match=r"missing\.toml"):
        verification.read_case("missing.toml")


def test_compare_judges_the_claims_of_a_case(tmp_path):
    path = tmp_path / "quick.toml"
    path.write_text(QUICK, encoding="utf-8")
    found = verification.compare(verification.read_case(path))
    assert [verdict.outcome for _, verdict in found.verdicts] == [Outcome.AGREES]


def test_a_problem_in_python_takes_every_word_of_the_command_line():
    words, known = (set(inspect.signature(one).parameters) for one in (case_text, verification.state))
    assert words - known == {"materials"}
    rolled = verification.state(roller="R = 5 mm, crown 2 m", load="10 N", substrate="210 GPa, 0.3")
    assert rolled.problem.indenter == ("ellipsoid", (5e-3, 2.0))
