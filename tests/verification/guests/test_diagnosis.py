"""Slips beyond the ten of ``test_common_slips``, planted in exact answers: each is named in one message."""

from dataclasses import replace

import numpy as np
import pytest
from guest_exams import GUEST, prepared, result_of, slips_of

from verification.judging.verdict import Outcome
from verification.sources.exact_sources import solve_exactly

HERTZ, COATED, SLIDING = "01_uncoated_steel", "05_ratio_4", "14_ratio_4_sliding"


@pytest.fixture(scope="module")
def exams(tmp_path_factory):
    """Each case with its exact reference."""
    folder = tmp_path_factory.mktemp("exam")
    return {name: prepared(name, folder) for name in (HERTZ, COATED, SLIDING)}


def messages(exam, quantity=None, change=None):
    """The messages about exact answers with ``change(value, position, contact radius)`` of a ``quantity``."""
    a = exam[1].profile_of["contact_radius", "contact", "integral_equation"].value[0]
    values = {
        (p.quantity, p.line): change(p.value, p.position, a) if p.quantity == quantity else p.value
        for p in exam[1].profiles
    }
    return [str(slip) for slip in slips_of(*exam, values)]


@pytest.mark.parametrize("case", [HERTZ, COATED, SLIDING])
def test_right_answers_have_no_slips(exams, case):
    assert messages(exams[case]) == []


@pytest.mark.parametrize("case", [HERTZ, COATED, SLIDING])
@pytest.mark.parametrize(
    ("quantity", "change", "word"),
    [
        ("approach", lambda v, x, a: -v, "sign"),
        ("sigma_xx", lambda v, x, a: 0 * v, "zero"),
        ("pressure", lambda v, x, a: np.where(np.abs(np.abs(x) - a) < 0.05 * a, 0.5, 1.0) * v, "edge"),
        ("pressure", lambda v, x, a: np.interp(x / 2, x, v), "halved"),
        ("sigma_xx", lambda v, x, a: v + 3e8, "3e+08"),
        ("sigma_xx", lambda v, x, a: 1.1 * v, "1.1"),
    ],
)
def test_a_slip_of_the_output_is_named(exams, case, quantity, change, word):
    first, *_ = messages(exams[case], quantity, change)
    assert quantity in first
    assert word in first


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
    wrong = solve_exactly(change(case.problem))
    names = ("peak_pressure", "contact_radius", "approach")
    values = {(name, "contact"): [getattr(wrong, name)] for name in names}
    x = exam.profile_of["pressure", "surface", "integral_equation"].position
    (slip,) = slips_of(case, exam, values | {("pressure", "surface"): wrong.pressure(x)})
    assert words in str(slip)


def test_a_largest_tension_in_the_zone_that_is_left_out_is_not_asked_for(exams):
    case, exam = exams[SLIDING]
    values = {"largest_tension": [1.0], "tension_place": [0.0], "contact_radius": [1.0]}
    for edge, outcome in ((0.0, Outcome.DISAGREES), (0.05, Outcome.UNSUPPORTED)):
        guest = GUEST.model_copy(update={"edge": edge})
        result = result_of(case, exam, {(q, "contact"): value for q, value in values.items()}, guest)
        found = {c.quantity: v.outcome for c, v in result.verdicts}
        assert {found[q] for q in ("largest_tension", "tension_place")} == {outcome}
        assert found["contact_radius"] is Outcome.DISAGREES
