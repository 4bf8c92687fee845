"""The names that a user of the package meets first: read_case, solve, compare."""

import pytest
from quick_case import QUICK

import verification
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
