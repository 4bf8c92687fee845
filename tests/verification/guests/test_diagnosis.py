"""Slips beyond the ten of ``test_common_slips``, planted in exact answers: each is named in one message."""

from dataclasses import replace

import numpy as np
import pytest
from guest_exams import GUEST, prepared, question

from verification.guests.doors.program_door import Solved
from verification.guests.guest_protocol import VERSION, Answer
from verification.guests.guest_verdicts import judged
from verification.guests.slip_diagnosis import slips
from verification.judging.verdict import Outcome
from verification.problem.coated_contact import CoatedContact
from verification.sources.exact_sources import solve_exactly

HERTZ, COATED, SLIDING = "01_uncoated_steel", "05_ratio_4", "14_ratio_4_sliding"


@pytest.fixture(scope="module")
def exams(tmp_path_factory):
    """Each case with its exact reference."""
    folder = tmp_path_factory.mktemp("exam")
    return {name: prepared(name, folder) for name in (HERTZ, COATED, SLIDING)}


def exact_values(exam):
    values = {}
    for p in exam.profiles:
        one = p.line == "contact"
        values.setdefault(p.line, {})[p.quantity] = float(p.value[0]) if one else p.value
    return values


def messages(exams, name, change):
    """The messages about exact answers that ``change`` has edited in place, or replaced."""
    case, exam = exams[name]
    values = exact_values(exam)
    places = {p.line: p.position for p in exam.profiles}
    values = change(values, places) or values
    asked = {q.line: q.quantities for q in question(case, exam).lines}
    asked["contact"] = list(values["contact"])
    plain = {
        line: {q: np.asarray(v).tolist() for q, v in numbers.items() if q in asked[line]}
        for line, numbers in values.items()
    }
    result = judged(GUEST, case, exam, [Solved(Answer(protocol=VERSION, id="x", values=plain), 0.0)])
    return [str(slip) for slip in slips(result, "g")]


def of_problem(case, exam, problem):
    """Exact values of another ``problem`` at the points of ``exam``."""
    solution = solve_exactly(problem)
    values = {"contact": {n: getattr(solution, n) for n in ("peak_pressure", "contact_radius", "approach")}}
    surface = next(p.position for p in exam.profiles if p.line == "surface")
    return values | {"surface": {"pressure": solution.pressure(surface)}}


def scaled(line, quantity, factor):
    def change(values, places):
        values[line][quantity] = factor * values[line][quantity]

    return change


def every(quantities, function):
    def change(values, places):
        for line, numbers in values.items():
            for quantity in quantities:
                if quantity in numbers and line != "contact":
                    numbers[quantity] = function(numbers[quantity], places[line])

    return change


def edge_only(values, places):
    x, a = places["surface"], values["contact"]["contact_radius"]
    near = np.abs(np.abs(x) - a) < 0.05 * a
    values["surface"]["pressure"] = np.where(near, 0.5, 1.0) * values["surface"]["pressure"]


def doubled_positions(values, places):
    x = places["surface"]
    values["surface"]["pressure"] = np.interp(x / 2, x, values["surface"]["pressure"])


@pytest.mark.parametrize("case", [HERTZ, COATED, SLIDING])
def test_right_answers_have_no_slips(exams, case):
    assert messages(exams, case, lambda values, places: None) == []


@pytest.mark.parametrize("case", [HERTZ, COATED, SLIDING])
@pytest.mark.parametrize(
    ("change", "words"),
    [
        (scaled("contact", "approach", -1.0), ["approach", "sign"]),
        (every(["sigma_xx"], lambda v, x: 0 * v), ["sigma_xx", "zero"]),
        (edge_only, ["pressure", "edge"]),
        (doubled_positions, ["pressure", "halved"]),
        (every(["sigma_xx"], lambda v, x: v + 3e8), ["sigma_xx", "3e+08"]),
        (every(["sigma_xx"], lambda v, x: 1.1 * v), ["sigma_xx", "1.1"]),
    ],
)
def test_a_slip_of_the_output_is_named(exams, case, change, words):
    found = messages(exams, case, change)
    assert found
    assert all(word in found[0] for word in words), found


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda p: replace(p, substrate=(p.substrate[0] * (1 - 0.09) ** 1, 0.3)), "E*"),
        (lambda p: replace(p, radius=2 * p.radius), "diameter"),
        (lambda p: replace(p, load=p.load / 2), "load"),
        (lambda p: replace(p, substrate=(p.substrate[0] / 1e3, 0.3)), "a factor of units?"),
        (lambda p: replace(p, substrate=(p.substrate[0] / 2, 0.3)), "material"),
    ],
)
def test_a_slip_of_the_input_of_hertz_is_one_message(exams, change, words):
    case, exam = exams[HERTZ]
    wrong: CoatedContact = change(case.problem)
    found = messages(exams, HERTZ, lambda values, places: of_problem(case, exam, wrong))
    assert len(found) == 1
    assert words in found[0]


def test_a_largest_tension_in_the_zone_that_is_left_out_is_not_asked_for(exams):
    case, exam = exams[SLIDING]
    values = {"contact": {"largest_tension": 1.0, "tension_place": 0.0, "contact_radius": 1.0}}
    reply = [Solved(Answer(protocol=VERSION, id="x", values=values), 0.0)]
    for edge, outcome in ((0.0, Outcome.DISAGREES), (0.05, Outcome.UNSUPPORTED)):
        guest = GUEST.model_copy(update={"edge": edge})
        found = {c.quantity: v for c, v in judged(guest, case, exam, reply).verdicts}
        assert {found[q].outcome for q in ("largest_tension", "tension_place")} == {outcome}
        assert found["contact_radius"].outcome is Outcome.DISAGREES
