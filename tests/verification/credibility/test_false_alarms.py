"""Random problems: the same everywhere, valid, as wide as they are said to be; what counts as an alarm."""

import json
from dataclasses import replace
from functools import partial
from pathlib import Path

import pytest
from quick_case import coatcheck
from synthetic_results import INFO, STEEL, contact, crashed, result_of

from verification.cases.case_file import Case, parse_case
from verification.cases.random_problems import (
    FRICTION,
    MOST_COATINGS,
    POISSON,
    RATIO,
    THICKNESS,
    THINNEST,
    draw,
    draw_ellipse,
)
from verification.credibility.false_alarms import counted
from verification.desk.stack_text import outside_verified
from verification.evidence.alarm_record import read_record
from verification.judging.standard_claims import standard_claims
from verification.judging.verdict import Outcome

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


def test_draws_of_films_are_one_or_two_thin_films_under_a_ball_without_coatings():
    cases = [parse_case(draw(7, k, films=True).text.encode(), Path("films.toml")) for k in range(100)]
    assert {len(case.problem.coatings) for case in cases} == {1, 2}
    assert {case.problem.ball is None for case in cases} == {True, False}
    assert not any(case.problem.ball and case.problem.ball[2] for case in cases)
    h = [case.problem.coatings[-1][2] / case.problem.a_h for case in cases]
    assert 0.001 * (1 - 1e-3) <= min(h) < 0.0015 < 0.015 < max(h) <= 0.02 * (1 + 1e-3)
    assert not any(outside_verified(case) for case in cases)


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


def test_whatever_is_not_agreement_is_an_alarm():
    good = result_of(contact((2 * E, NU, 1.0)), name="good", text="title = 'good'\n")
    wrong = result_of(
        contact((4 * E, NU, 1.0)), name="wrong", errors={"semianalytic": 2e-3}, stated={"semianalytic": 0.7}
    )
    vague = result_of(contact((E / 2, NU, 1.0)), name="vague", errors={"semianalytic": 4e-3}, text="x = 1\n")
    dead = crashed(contact((2 * E, NU, 1.0)), "dead", "killed")
    clean = counted([good], 1, INFO)
    assert (clean.alarms, clean.agreeing, clean.problems) == ((), 1, 1)
    assert clean.comparisons == len(good.verdicts)
    empty = replace(good, name="empty", verdicts=())
    found = counted([good, wrong, vague, dead, empty], 1, INFO)
    assert found.agreeing == 1
    outcomes = {alarm.case: set() for alarm in found.alarms}
    for alarm in found.alarms:
        outcomes[alarm.case].add(alarm.outcome)
    assert outcomes["dead"] == outcomes["empty"] == {Outcome.NO_RESULT}
    assert Outcome.INCONCLUSIVE in outcomes["vague"]
    assert Outcome.DISAGREES in outcomes["wrong"]
    assert {alarm.toml for alarm in found.alarms if alarm.case == "vague"} == {"x = 1\n"}
    assert "good" not in outcomes
    assert found.comparisons == sum(len(r.verdicts) for r in (good, wrong, vague, dead))


def test_ratios_count_every_error_over_its_uncertainty():
    problem = contact((4 * E, NU, 1.0))
    within, beyond = (
        counted([result_of(problem, errors={"semianalytic": 2e-3}, stated={"semianalytic": stated})], 1, INFO)
        for stated in (2.0, 0.5)
    )
    found = [next(r for r in one.ratios if r.source == "semianalytic") for one in (within, beyond)]
    for semi in found:
        assert sum(semi.counts) == semi.values > 0
    generous, narrow = found
    assert (generous.within, narrow.within < 1) == (1.0, True)
    assert generous.largest <= 1 < narrow.largest
    assert generous.median > 1.5 * narrow.median  # the exact reference has an uncertainty too


@pytest.mark.slow
def test_the_command_records_what_it_found(tmp_path):
    alarms = partial(coatcheck, "alarms", "--count", "2", "--seed", "1", cwd=tmp_path)
    done = alarms("--record", "--records", "records", "--json")
    assert done.returncode == 0, done.stdout
    record = read_record(tmp_path / "records")
    assert record is not None
    assert (record.problems, record.agreeing, record.alarms) == (2, 2, ())
    assert json.loads(done.stdout)["comparisons"] == record.comparisons > 100
    assert (tmp_path / "reports" / "alarms" / "problems" / "draw_1_001.toml").read_text() == draw(1, 1).text
    stored = tmp_path / "reports" / "alarms" / "cases" / "draw_1_001.json"
    first = stored.stat().st_mtime_ns
    assert alarms("--resume", "--quiet").returncode == 0
    assert stored.stat().st_mtime_ns == first
