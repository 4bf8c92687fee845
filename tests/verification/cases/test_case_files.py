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


CLAIM = """
[[claim]]
quantity = "sigma_xx"
line = "interface 1, upper side"
between = ["semianalytic", "fem_reference"]
cap = 0.005
why = "peak on the axis"
"""


def test_claims_of_the_file_replace_the_standard_ones():
    case = parse(GOOD)
    assert (case.name, case.claims) == ("mine", standard_claims(case.problem))
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
