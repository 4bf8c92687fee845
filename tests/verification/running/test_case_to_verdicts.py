"""One case to verdicts: a source that fails, lies or goes silent is a row of the report, never agreement."""

import functools
import json
import time
from dataclasses import replace

import numpy as np
import pytest
from altered_source import Altered
from case_texts import case_text

from verification.cases.case_file import parse_case, read_case, shaped_cases
from verification.judging.verdict import Outcome
from verification.problem.point_answers import Answer, Sampled
from verification.running.case_result import from_json, to_json
from verification.running.contact_run import judge_case, run, solve_case
from verification.sources.references import integral_equation
from verification.sources.references.hertz import Hertz
from verification.sources.source_registry import solvers

CASE = case_text("E = 420e9; nu = 0.25; thickness_over_a_h = 0.5").encode()


def exact(problem, _):
    return solved(problem)


class Remembered(Sampled):
    """A solution that computes each answer once."""

    def __init__(self, solution):
        self.solution, self.known, self.coarser = solution, {}, solution.coarser
        self.uncertainty, self.diagnostics = solution.uncertainty, solution.diagnostics
        self.surface_nodes = solution.surface_nodes

    def sample(self, points, quantity, uncertainty=True):
        places = () if points is None else (points.x, points.y, points.z)
        at = ((np.shape(v), np.asarray(v, dtype=float).tobytes()) for v in places)
        key = (quantity, uncertainty, None if points is None else points.layer, *at)
        if key not in self.known:
            self.known[key] = self.solution.sample(points, quantity, uncertainty)
        return Answer(*(v.copy() if isinstance(v, np.ndarray) else v for v in self.known[key]))


@functools.cache
def solved(problem):
    return Remembered(
        integral_equation.solve(
            radius=problem.radius, load=problem.load, coatings=problem.coatings, substrate=problem.substrate
        )
    )


@pytest.fixture
def case(tmp_path):
    return parse_case(CASE, tmp_path / "two.toml")


def sources(**changed):
    """The exact solution under every name, so that only what a test changes can matter."""
    return {"semianalytic": exact, "fem_reference": exact, "integral_equation": exact} | changed


def failing(message="no"):
    """A source that raises."""

    def solve(problem, numerics=None):
        raise ValueError(message)

    return solve


def verdicts(result, source):
    return [v for claim, v in result.verdicts if source in claim.between]


def judged(case, available):
    """A run without the invariants, for what looks at verdicts alone."""
    return judge_case(case, solve_case(case, available), invariants=False)


def test_sources_that_are_the_same_agree_in_every_claim(case):
    begin = time.perf_counter()
    result = run(case, sources())
    assert result.outcome is Outcome.AGREES
    assert {law.source for law in result.invariants} == set(sources())
    spent = [source.seconds for source in result.sources]
    assert min(spent) > 0
    assert sum(spent) <= result.seconds <= time.perf_counter() - begin
    assert len(result.verdicts) == len(case.claims) == 3 * (4 + 2 + 3 + 2 + 4 * 2 + 9 + 9 + 3)


def test_source_that_raises_is_no_result_with_its_sentence_and_the_others_go_on(case):
    begin = time.perf_counter()
    broken = failing("load balance off by 3e-3 after 200 iterations; widen the grid")
    result = run(case, sources(semianalytic=broken))
    assert all(0 <= source.seconds <= time.perf_counter() - begin for source in result.sources)
    assert {v.outcome for v in verdicts(result, "semianalytic")} == {Outcome.NO_RESULT}
    assert all("balance" in v.reason for v in verdicts(result, "semianalytic"))
    others = [v for claim, v in result.verdicts if "semianalytic" not in claim.between]
    assert {v.outcome for v in others} == {Outcome.AGREES}


@pytest.mark.parametrize("bad", [np.nan, np.inf])
@pytest.mark.parametrize("name", ["stress", "pressure", "stress_uncertainty", "pressure_uncertainty"])
def test_values_that_are_not_finite_never_agree(case, name, bad):
    def broken(problem, numerics):
        def answer(field, *place):
            values = field(*place)
            values[..., 3] = bad
            return values

        return Altered(exact(problem, numerics), **{name: answer})

    result = judged(case, sources(fem_reference=broken))
    touched = [
        v.outcome
        for claim, v in result.verdicts
        if "fem_reference" in claim.between
        and claim.line != "contact"
        and (claim.quantity == "pressure") == ("pressure" in name)
        and not claim.quantity.startswith("u_")
    ]
    assert set(touched) == {Outcome.NO_RESULT}


def test_result_survives_strict_json_to_the_last_bit(case):
    result = run(case, sources(semianalytic=failing()))
    text = json.dumps(to_json(result), allow_nan=False)
    back = from_json(json.loads(text))
    assert json.dumps(to_json(back), allow_nan=False) == text
    for one, other in zip(result.profiles, back.profiles, strict=True):
        assert np.array_equal(one.value, other.value)
    with pytest.raises(ValueError, match="schema"):
        from_json({"schema": "something else"})


def test_hertz_is_asked_where_all_moduli_are_equal(tmp_path):
    text = CASE.replace(b"420e9", b"210e9").replace(b"0.25", b"0.3")
    case = parse_case(text, tmp_path / "same.toml")
    available = sources(hertz=lambda p, _: Hertz(p.radius, p.load, *p.substrate))
    result = run(case, available)
    assert any(claim.between == ("integral_equation", "hertz") for claim, _ in result.verdicts)
    assert result.outcome is Outcome.AGREES
    wrong = sources(hertz=lambda p, _: replace(Hertz(p.radius, p.load, *p.substrate), nu=0.31))
    assert run(case, wrong).outcome is Outcome.DISAGREES


def test_a_case_that_both_methods_fail_ends_without_results_though_a_closed_form_is_left():
    available = dict.fromkeys(("semianalytic", "fem_reference"), failing()) | {"hertz": solvers()["hertz"]}
    result = run(read_case(shaped_cases()["24_ellipse"]), available)
    assert {verdict.outcome for _, verdict in result.verdicts} == {Outcome.NO_RESULT}
