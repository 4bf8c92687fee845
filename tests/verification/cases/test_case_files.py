"""Case files: good ones are read to the letter, bad ones end in one message with file and key."""

import math
from pathlib import Path

import pytest

from verification.cases.case_file import parse_case, read_case, shipped_cases
from verification.cases.toml_file import CaseError
from verification.judging.standard_claims import standard_claims

GOOD = """
title = "Stiff coating"
[problem]
radius = 10e-3
load = 20
substrate = { E = 210e9, nu = 0.3 }
[[problem.coatings]]
E = 420e9
nu = 0.3
thickness = 70e-6
"""


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


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("thickness = 70e-6", "thickness = -70e-6", "problem.coatings.0.thickness"),
        ("thickness = 70e-6", "thickness = 0.0", "problem.coatings.0.thickness"),
        ("thickness = 70e-6", "", "problem.coatings.0"),
        ("thickness = 70e-6", "thickness = 70e-6\nthickness_over_a_h = 1.0", "problem.coatings.0"),
        ("nu = 0.3 }", "nu = 0.6 }", "problem.substrate.nu"),
        ("nu = 0.3 }", "nu = 0.5 }", "problem.substrate.nu"),
        ("nu = 0.3 }", "}", "not TOML"),
        ("E = 210e9, nu = 0.3", "E = 210e9", "problem.substrate.nu"),
        ("radius = 10e-3", "", "problem.radius"),
        ("radius = 10e-3", "radius = nan", "problem.radius"),
        ("radius = 10e-3", "radius = inf", "problem.radius"),
        ("radius = 10e-3", "radius = true", "problem.radius"),
        ("radius = 10e-3", "radius = 1e-300", "contact radius"),
        ("radius = 10e-3", "radius = 10e-3\nhardness = 7", "problem.hardness"),
        ("load = 20", 'load = "heavy"', "problem.load"),
        ('title = "Stiff coating"', 'title = "Stiff coating"\nlaws = true', "resolve"),
        ("load = 20", "load = 0", "problem.load"),
        ("load = 20", "load = -0.0", "problem.load"),
        ("load = 20", "load = 1e30", "problem.load"),
        ("load = 20", "load = [20]", "problem.load"),
        ('title = "Stiff coating"', "", "missing"),
        ('title = "Stiff coating"', "title = 7", "title must be text"),
        ("[problem]", "[problems]", "problem.load"),
        ("E = 420e9", "E = 420e20", "moduli differ"),
        (
            "[problem]",
            "[semianalytic]\npatches = 1e3\n[problem]",
            "semianalytic.patches",
        ),
        ("[problem]", "[fem_reference]\norder = 9\n[problem]", "fem_reference.order"),
    ],
)
def test_bad_key_is_named(old, new, said):
    assert old in GOOD
    with pytest.raises(CaseError) as error:
        parse(GOOD.replace(old, new, 1))
    message = str(error.value)
    assert message.startswith("mine.toml: ")
    assert said in message
    assert "\n" not in message


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


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("sigma_xx", "sigma_rr", "claim.0.quantity"),
        ("interface 1", "interface 2", "claim.0.line"),
        ('"fem_reference"]', '"abaqus"]', "claim.0.between"),
        ('"fem_reference"]', '"semianalytic"]', "claim.0.between"),
        ('"fem_reference"]', '"hertz"]', "claim.0.between"),
        ("cap = 0.005", "cap = 0", "claim.0.cap"),
        ('why = "peak on the axis"', "", "claim.0.why"),
    ],
)
def test_claim_that_cannot_be_judged_is_refused(old, new, said):
    with pytest.raises(CaseError, match=said.replace(".", r"\.")):
        parse(GOOD + CLAIM.replace(old, new, 1))


@pytest.mark.parametrize(
    "raw", [b"", b"\xff\xfe\x00", b"title = ", b"[" * 5000, b"a = " + b"[" * 3000, b"\x00" * 100]
)
def test_what_is_no_case_file_is_refused(raw):
    with pytest.raises(CaseError, match=r"^mine\.toml: "):
        parse(raw)


def test_missing_file_and_directory_are_refused(tmp_path):
    with pytest.raises(CaseError, match="no such file"):
        read_case(tmp_path / "none.toml")
    with pytest.raises(CaseError, match="directory"):
        read_case(tmp_path)


def test_every_shipped_case_is_good_and_states_its_source():
    cases = [read_case(path) for path in shipped_cases().values()]
    assert len(cases) >= 12
    for case in cases:
        assert case.source != "no source stated"
        assert math.isfinite(case.problem.a_h)
