"""Case files: good ones are read to the letter, bad ones end in one message with file and key."""

import math
from pathlib import Path

import pytest
from case_texts import case_text

from verification.cases.case_file import parse_case, read_case, shipped_cases
from verification.cases.toml_file import CaseError
from verification.judging.standard_claims import standard_claims

GOOD = case_text("E = 420e9; nu = 0.3; thickness = 70e-6")


def parse(text):
    return parse_case(text.encode() if isinstance(text, str) else text, Path("mine.toml"))


def test_good_case_is_read_in_si_units():
    case = parse(GOOD)
    assert case.problem.coatings == ((420e9, 0.3, 70e-6),)
    assert case.problem.load == 20.0
    assert case.name == "mine"
    assert case.claims == standard_claims(case.problem)


def test_thickness_may_be_given_in_contact_radii():
    case = parse(GOOD.replace("thickness = 70e-6", "thickness_over_a_h = 2"))
    assert case.problem.coatings[0][2] == pytest.approx(2 * case.problem.a_h, rel=1e-15, abs=0)


CLAIM = """
[[claim]]
quantity = "sigma_xx"
line = "interface 1, upper side"
between = ["semianalytic", "fem_reference"]
cap = 0.005
why = "peak on the axis"
"""


def test_claims_of_the_file_replace_the_standard_ones():
    case = parse(GOOD + CLAIM)
    assert [(c.quantity, c.line, c.cap) for c in case.claims] == [
        ("sigma_xx", "interface 1, upper side", 0.005)
    ]


def test_missing_file_and_directory_are_refused(tmp_path):
    with pytest.raises(CaseError, match="none"):
        read_case(tmp_path / "none.toml")
    with pytest.raises(CaseError, match="directory"):
        read_case(tmp_path)


def test_every_shipped_case_is_good_and_states_its_source():
    cases = [read_case(path) for path in shipped_cases().values()]
    assert len(cases) >= 12
    for case in cases:
        assert case.source != "no source stated"
        assert math.isfinite(case.problem.a_h)
