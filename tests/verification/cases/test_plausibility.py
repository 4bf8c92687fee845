"""Implausible numbers: a line each with the likely slip; none where nothing is wrong."""

from pathlib import Path

import pytest
from case_texts import case_text, study_text

from verification.cases.case_file import parse_case, read_case, shipped_cases
from verification.cases.plausibility import warnings_of
from verification.cases.toml_file import CaseError
from verification.problem.coated_contact import CoatedContact
from verification.study.study_plan import parse_study, read_study_file, shipped_studies

CASE = case_text(
    "E = {coating}; nu = 0.22; thickness = {thickness}",
    radius="{radius}",
    load="{load}",
    more="ball = {{ E = {ball}, nu = 0.27 }}",
).replace("{ E = 210e9, nu = 0.3 }", "{{ E = {E}, nu = 0.3{more} }}")
STUDY = study_text(
    "coating = {{ E = {coating}, nu = 0.22 }}",
    sweep="thickness = [{thickness}]",
    radius="{radius}",
    load="{load}",
    tables="[criteria.strength]\nsigma_xx_surface = {strength}\n",
).replace("{ E = 210e9, nu = 0.3 }", "{{ E = {E}, nu = 0.3{more} }}")
GOOD = {
    "radius": "10e-3",
    "load": "20",
    "E": "210e9",
    "ball": "310e9",
    "coating": "450e9",
    "thickness": "3e-6",
    "strength": "2.5e9",
    "more": "",
}


def found(template, **changed):
    """What is told of a file: its warnings, or the message that refuses it."""
    text = template.format(**GOOD | changed).encode()
    try:
        read = parse_study if template is STUDY else parse_case
        return list(read(text, Path("mine.toml")).warnings)
    except CaseError as error:
        return [str(error)]


# Ten typical files, each with one slip of a unit; the message has to lead to it.
SLIPS = [
    (CASE, {"E": "210"}, "substrate, E", "GPa"),
    (CASE, {"E": "210000", "coating": "450000", "ball": "310000"}, "substrate, E", "MPa"),
    (CASE, {"ball": "310"}, "ball, E", "GPa"),
    (CASE, {"coating": "450"}, "coating 1, E", "GPa"),
    (CASE, {"thickness": "3"}, "coating 1, thickness", "um"),
    (CASE, {"thickness": "0.003"}, "coating 1, thickness", "mm"),
    (CASE, {"radius": "10"}, "radius", "mm"),
    (CASE, {"load": "20000"}, "load", "radius"),
    (STUDY, {"thickness": "3"}, "thickness", "um"),
    (STUDY, {"strength": "2.5"}, "criteria.strength.sigma_xx_surface", "GPa"),
    (CASE, {"thickness": '"3 mm"'}, "thickness", "unit"),
    (STUDY, {"radius": "10"}, "radius", "mm"),
    (CASE, {"more": ", hardness = 1.5"}, "substrate, hardness = 1.5 Pa", 'give "1.5 GPa"'),
    (CASE, {"more": ", yield_strength = 400"}, "substrate, yield_strength = 400 Pa", 'give "400 MPa"'),
    (STUDY, {"more": ", hardness = 8"}, "substrate, hardness = 8 Pa", 'give "8 GPa"'),
]


@pytest.mark.parametrize(("template", "changed", "key", "unit"), SLIPS)
def test_slip_of_a_unit_is_refused_or_warned_of(template, changed, key, unit):
    lines = found(template, **changed)
    assert any(key in line and unit in line for line in lines), lines
    assert all("\n" not in line for line in lines)


def test_nothing_is_told_of_the_shipped_files():
    for path in shipped_cases().values():
        assert read_case(path).warnings == (), path
    for path in shipped_studies().values():
        assert read_study_file(path).warnings == (), path


def test_lengths_are_in_the_units_of_the_contact():
    (line,) = warnings_of(CoatedContact(5e-6, 1e-9, ((1e9, 0.4, 2e-6),), (7e9, 0.22)))
    assert "thickness = 2000 nm is 136 contact radii" in line
