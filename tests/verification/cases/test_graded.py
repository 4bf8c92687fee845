"""Graded coatings: moduli of the sub-layers, their place in a case, refused input."""

from pathlib import Path

import numpy as np
import pytest
from case_texts import case_text

from verification.cases.case_file import parse_case
from verification.cases.graded_coating import GradedCourse, ModulusTable, moduli
from verification.cases.toml_file import CaseError
from verification.desk.contact_answer import answer, with_slicing
from verification.desk.stack_text import described
from verification.study import study_point as point
from verification.study.study_plan import parse_study

TEXT = case_text(
    'layers = 30; E = { course = "exponential", top = "400 GPa", base = "210 GPa" }; nu = 0.25; '
    'thickness = "30 um"; residual_stress = "-1 GPa"',
    'E = "279 GPa"; nu = 0.21; thickness = "1 um"',
)
LINEAR = GradedCourse(course="linear", top=4e11, base=2e11)


def parse(text, over=1):
    return parse_case(text.encode(), Path("mine.toml"), over)


def test_courses_at_the_middle_of_each_sub_layer():
    np.testing.assert_allclose(moduli(LINEAR, 4), [375e9, 325e9, 275e9, 225e9], rtol=1e-14)
    found = moduli(GradedCourse(course="exponential", top=4e11, base=1e11), 2)
    np.testing.assert_allclose(found, [4e11 * 0.25**0.25, 4e11 * 0.25**0.75], rtol=1e-14)
    table = ModulusTable(depth=[0.0, 0.5, 1.0], E=[4e11, 2e11, 2e11])
    np.testing.assert_allclose(moduli(table, 4), [350e9, 250e9, 200e9, 200e9], rtol=1e-14)
    assert moduli(3e11, 1) == (3e11,)


def test_a_graded_coating_is_its_sub_layers_of_one_thickness():
    case = parse(TEXT)
    assert case.layers == {"flat": (30, 1)}
    assert case.residual == {"flat": (-1e9,) * 30 + (0.0,)}
    thickness = [h for _, _, h in case.problem.coatings]
    np.testing.assert_allclose(thickness, [1e-6] * 31, rtol=1e-14)
    assert parse(TEXT, over=2).layers == {"flat": (15, 1)}
    plain = TEXT[: TEXT.index("[[problem")] + TEXT[TEXT.rindex("[[problem") :]
    assert parse(plain).layers == {}


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("layers = 30\n", "", "course"),
        ('E = "279 GPa"', 'E = "279 GPa"\nlayers = 5', "course"),
        ("layers = 30", "layers = 50", "coatings"),
        ("layers = 30", "layers = 1", "coating 1, layers"),
        ('course = "exponential"', 'course = "cubic"', "coating 1, E, course"),
        ('top = "400 GPa"', 'top = "400 Gpa"', "GPa"),
        ('top = "400 GPa", ', "", "missing"),
        ('course = "exponential", top = "400 GPa", base = "210 GPa"', "depth = [0, 1], E = [4e11]",
         "coating 1, E"),
        ('course = "exponential", top = "400 GPa", base = "210 GPa"', "depth = [0, 0.5], E = [4e11, 2e11]",
         "0 to 1"),
        ('course = "exponential", top = "400 GPa", base = "210 GPa"', "depth = [0, 1, 1], E = [4e11, 2e11]",
         "3"),
    ],
)  # fmt: skip
def test_bad_graded_coating_is_one_message_with_its_key(old, new, message):
    with pytest.raises(CaseError) as error:
        parse(TEXT.replace(old, new, 1))
    assert "coating" in str(error.value)
    assert "\n" not in str(error.value)
    assert message in str(error.value)


@pytest.mark.slow
def test_slicing_is_within_its_uncertainty_and_moduli_are_shown_as_typed():
    words = 'course = "linear", top = "130 GPa", base = "300 GPa"'
    text = case_text(f"layers = 12; E = {{ {words} }}; nu = 0.25; thickness_over_a_h = 0.6")
    cases = [parse(text, over=over) for over in (1, 2, 4, 8)]
    fine, *coarser = (answer(one.problem, "semianalytic", layers=one.layers) for one in cases)
    stated = with_slicing(coarser[0], coarser[1:])
    for before, at, finer in zip(coarser[0].extremes, stated.extremes, fine.extremes, strict=True):
        # The error left is at most the last change at first order.
        assert abs(at.value - finer.value) <= 0.6 * at.uncertainty
        assert at.uncertainty > before.uncertainty or at.value == 0
    p0, spread = stated.numbers["peak_pressure"]
    assert abs(p0 - fine.numbers["peak_pressure"][0]) < spread < 0.01 * p0
    assert "E = 130 to 300 GPa, linear, as 12 sub-layers" in "".join(described(cases[0]))


@pytest.mark.slow
def test_a_study_beside_a_graded_coating_solves_half_of_its_sub_layers_too():
    graded = '{ layers = 4, E = { course = "linear", top = 1e11, base = 3e11 }, nu = 0.3, thickness = 1e-5 }'
    text = 'title = "t"\n[problem]\nradius = 1e-2\nload = 20.0\nsubstrate = { E = 2e11, nu = 0.3 }\n'
    text += f"coatings = [{{ E = 4e11, nu = 0.2 }}, {graded}]\n[sweep]\nthickness = [5e-5]\n"
    first = next(parse_study(text.encode(), Path("mine.toml")).solves())
    layers = [len(one["problem"]["coatings"]) for one in (first.request, first.request["halved"])]
    assert layers == [1 + 4, 1 + 2]
    found = point.answer(first.request)["rows"][0]
    half = point.answer(point.halved_request(first.request))["rows"][0]
    for name in ("peak_pressure", "contact_radius"):
        assert found[f"{name}_uncertainty"] > abs(found[name] - half[name]) > 1e-6 * found[name]
