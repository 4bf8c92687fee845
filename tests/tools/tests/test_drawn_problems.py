"""Random problems: the same everywhere, valid, as wide as they are said to be."""

from functools import partial
from pathlib import Path

import pytest
from drawn_problems import draw, draw_ellipse
from synthetic_results import STEEL

from verification.cases.case_file import Case, parse_case
from verification.cases.drawn_ranges import FRICTION, MOST_COATINGS, POISSON, RATIO, THICKNESS, THINNEST
from verification.desk.stack_text import outside_verified
from verification.judging.standard_claims import standard_claims

E, NU = STEEL


def drawn(seed: int, number: int) -> Case:
    return parse_case(draw(seed, number).text.encode(), Path("draw.toml"))


def test_the_same_seed_draws_the_same_problem_everywhere():
    # written down once; another numpy, another machine has to draw it again
    assert draw(1, 15).text.splitlines()[2:10] == [
        "[problem]",
        "radius = 0.0001714",
        "load = 0.001909",
        "friction = 0.6743",
        "substrate = { E = 50890000000.0, nu = 0.3244 }",
        "[[problem.coatings]]",
        "E = 286600000000.0",
        "nu = 0.3888",
    ]
    assert draw(1, 15) == draw(1, 15)
    assert len({draw(seed, number).text for seed in range(5) for number in range(5)}) == 25


def test_ellipses_are_drawn_either_way_on_one_coating_and_compared_by_two_methods():
    cases = [parse_case(draw_ellipse(7, k).text.encode(), Path("ellipse.toml")) for k in range(100)]
    problems = [case.problem for case in cases]
    assert {len(one.coatings) for one in problems} == {1}
    radii = [one.indenter[1] for one in problems]
    assert {long > short for long, short in radii} == {True, False}
    assert (
        1.5
        < min(max(pair) / min(pair) for pair in radii)
        < max(max(pair) / min(pair) for pair in radii)
        < 8.1
    )
    assert {claim.between for case in cases for claim in case.claims} == {("semianalytic", "fem_reference")}
    elastic = [one.ball for one in problems if one.ball is not None]
    assert 35 < len(elastic) < 65
    assert {len(coatings) for _, _, coatings in elastic} == {0, 1}


@pytest.mark.parametrize(
    "kind", [draw, partial(draw, films=True), draw_ellipse], ids=["round", "films", "ellipses"]
)
def test_no_random_problem_is_beyond_the_range_in_which_the_methods_were_compared(kind):
    cases = [parse_case(kind(7, k).text.encode(), Path("drawn.toml")) for k in range(60)]
    assert {outside_verified(case) for case in cases} == {""}


@pytest.mark.slow
def test_draws_are_valid_cases_with_every_claim_and_fill_their_ranges():
    cases = [drawn(7, number) for number in range(300)]
    assert all(case.claims == standard_claims(case.problem) for case in cases)
    problems = [case.problem for case in cases]
    layers = [(E / p.substrate[0], nu, h / p.a_h) for p in problems for E, nu, h in p.coatings]
    ratios, poisson, depths = (sorted(column) for column in zip(*layers, strict=True))
    # four digits are drawn: a number at the very edge may be rounded over it
    slack = 1 + 1e-3
    assert RATIO[0] / slack <= ratios[0] < 0.022 < 45 < ratios[-1] <= RATIO[1] * slack
    assert POISSON[0] <= poisson[0] < 0.02 < 0.47 < poisson[-1] <= POISSON[1]
    assert THINNEST / slack <= depths[0] <= THINNEST * slack < 9 < depths[-1] <= THICKNESS[1] * slack
    assert {len(p.coatings) for p in problems} == set(range(1, MOST_COATINGS + 1))
    friction = sorted(p.friction for p in problems)
    assert 70 < friction.count(0.0) < 130  # a third
    assert 0.78 < friction[-1] <= FRICTION[1]
