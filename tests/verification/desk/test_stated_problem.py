"""A problem is stated once: by its load or its approach, in its own units, with limits in its own radius."""

import json
import re
import shlex
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from case_texts import case_text
from quick_case import coatcheck

import semianalytic
from verification.cases.case_file import parse_case, read_case, shipped_cases
from verification.cases.toml_file import CaseError
from verification.desk.contact_answer import answer
from verification.desk.stack_text import described, outside_verified
from verification.problem.coated_contact import CoatedContact
from verification.running.contact_run import keywords_of
from verification.sources.exact_sources import solve_exactly
from verification.sources.source_registry import METHODS

SEED = 6101
LENGTHS = {"nm": 1e-9, "um": 1e-6, "mm": 1e-3}
STRESSES = {"Pa": 1.0, "kPa": 1e3, "MPa": 1e6}
FORCES = {"nN": 1e-9, "uN": 1e-6, "mN": 1e-3, "N": 1.0, "kN": 1e3}
GEL = "--ball '5 um' --load '1 nN' --coating 'gel 10 um, 10 kPa, 0.49' --substrate '70 GPa, 0.22'"


def parsed(text):
    return parse_case(text.encode(), Path("mine.toml"))


def drawn(number, coatings):
    """A case file with the mark PRESSED in place of its load or approach, and an approach [m]."""
    random = np.random.default_rng([SEED, number])

    def between(low, high):
        return float(f"{np.exp(random.uniform(np.log(low), np.log(high))):.4g}")

    def layer(below):
        thickness = f"thickness_over_a_h = {between(0.03, 6)}"
        if random.uniform() < 0.5:
            thickness = f"thickness = {between(0.03, 6) * np.sqrt(radius * approach)}"
        return f"E = {below * between(0.03, 30)}; nu = {between(0.05, 0.5)}; {thickness}"

    radius, E, ball = between(5e-9, 0.1), between(1e9, 5e11), between(1e9, 5e11)
    approach = radius * between(1e-5, 0.05)
    on_ball = ", ".join(f"{{ {layer(ball).replace(';', ',')} }}" for _ in range(min(coatings, 1)))
    more = f"friction = {random.uniform(0, 0.5)}"
    if random.uniform() < 0.5:
        more += f"; ball = {{ E = {ball}, nu = {between(0.05, 0.49)}, coatings = [{on_ball}] }}"
    layers = [layer(E) for _ in range(coatings)]
    return case_text(*layers, radius=radius, load="PRESSED", E=E, more=more), approach


@pytest.mark.parametrize("number", range(12))
def test_a_problem_stated_by_its_approach_is_that_of_the_load_found(number):
    """Hertz's load without layers; with them the load at which the exact approach is the one given."""
    text, approach = drawn(number, coatings=number % 4)
    given = parsed(text.replace("load = PRESSED", f"approach = {approach}"))
    problem = given.problem
    if not number % 4:
        hertz = 4 / 3 * problem.E_star * np.sqrt(problem.radius) * approach**1.5
        assert problem.load == pytest.approx(hertz, rel=1e-11)
    else:
        assert solve_exactly(problem).approach == pytest.approx(approach, rel=1e-11)
    same = parsed(text.replace("PRESSED", repr(problem.load)))
    assert (same.problem, same.warnings) == (problem, given.warnings)
    assert [line for line in described(given) if "given approach" not in line] == described(same)
    # Each method is pressed by one of them: the semi-analytical one by the approach, in a run.
    assert keywords_of(given, METHODS[0]) == {"approach": approach}
    assert keywords_of(given, METHODS[1]) == keywords_of(same, METHODS[0]) == {}


def test_the_shipped_case_has_its_load_again():
    case = read_case(shipped_cases()["32_given_approach"])
    assert case.problem.load == 20.0
    found = answer(case.problem, METHODS[0])
    value, U = found.numbers["approach"]
    assert abs(value - case.approach) <= U


TWICE = [
    (case_text(more="approach = 1e-6"), ("load = 20", "approach = 1e-06")),
    (case_text().replace("load = 20\n", ""), ("load", "approach")),
    (case_text(tables="[semianalytic]\napproach = 1e-6\n"), ("semianalytic", "approach", "[problem]")),
    (case_text().replace("load = 20", 'approach = "20 mm"'), ("approach = 20 mm", "radius")),
    (case_text(more="temperature_change = -300"), ("temperature_change", "expansion")),
]


@pytest.mark.parametrize(("text", "named"), TWICE, ids=range(len(TWICE)))
def test_what_is_stated_twice_or_to_no_effect_is_refused(text, named):
    with pytest.raises(CaseError) as error:
        parsed(text)
    assert all(key in str(error.value) for key in named), error.value


def test_the_shape_of_an_indenter_is_stated_once():
    shape = ("ellipsoid", (0.01, 0.04))
    steel: dict = {"load": 20.0, "coatings": (), "substrate": (210e9, 0.3), "indenter": shape}
    assert CoatedContact(radius=0.02, **steel).indenter == shape
    with pytest.raises(ValueError, match=r"radius = 0.01 m.*0.02 m"):
        CoatedContact(radius=0.01, **steel)
    with pytest.raises(ValueError, match=r"gap = 'sphere'.*ellipsoid"):
        semianalytic.solve(radius=0.02, gap="sphere", **steel)


def test_a_film_is_thick_in_the_radius_of_its_own_contact():
    gel = case_text("E = 10e3; nu = 0.49; thickness = 10e-6", radius="5e-6", load="1e-9", E="70e9")
    said = outside_verified(parsed(gel))
    assert "coating 1, h = 15 a, outside" in said
    assert "a_h" not in said
    assert "h =" not in outside_verified(parsed(gel.replace("10e-6", "3e-6")))


def test_every_solid_beyond_the_range_of_the_comparisons_is_named():
    case = parsed(case_text("E = 210e9; nu = -0.2; thickness = 70e-6"))
    assert outside_verified(case) == "coating 1, nu = -0.2, outside 0 to 0.49"
    beyond = replace(case.problem, friction=0.9, coatings=6 * case.problem.coatings, ball=(3e9, 0.5, ()))
    assert outside_verified(replace(case, problem=beyond)) == (
        "friction f = 0.9, outside 0 to 0.8; 6 coatings, outside 0 to 5; coating 1 and 5 more, nu = -0.2, "
        "outside 0 to 0.49; ball, nu = 0.5, outside 0 to 0.49"
    )


def test_a_film_under_an_ellipse_is_thin_beside_its_short_half_axis():
    case = parsed(case_text("E = 630e9; nu = 0.3; thickness = 2e-6", radius="9.8e-3"))
    problem = replace(case.problem, radius=(20e-3 * 4.8e-3) ** 0.5, indenter=("ellipsoid", (20e-3, 4.8e-3)))
    assert outside_verified(case) == ""
    thin = outside_verified(replace(case, problem=problem))
    assert re.fullmatch(r"coating 1, h = 0\.0\d+ of the short half axis, outside 0\.1 to 2", thin)
    sliding = outside_verified(replace(case, problem=replace(problem, friction=0.6)))
    assert sliding.startswith("friction f = 0.6, outside 0 to 0.5; coating 1")
    slender = replace(problem, indenter=("ellipsoid", (40e-3, 2.4e-3)))
    said = outside_verified(replace(case, problem=slender))
    assert said.startswith("half axes about 6.5 to 1, outside 1 to 4; coating 1, h")
    assert outside_verified(replace(case, problem=replace(slender, coatings=()))) == ""


# The contact that was shown under 1000 N, an AFM tip, a small tip, a gel under a bead.
SHOWN = [
    ("--ball '25 mm, 20 GPa, 0.3' --approach '4 mm' --substrate '20 GPa, 0.3'", "mm MPa kN"),
    ("--ball '20 nm' --load '20 nN' --coating '2 nm, 70 GPa, 0.2' --substrate '160 GPa, 0.28'", "nm MPa nN"),
    (
        "--ball '10 um' --load '5 mN' --coating 'TiN 2 um, 450 GPa, 0.2' --substrate '210 GPa, 0.3'",
        "um MPa mN",
    ),
    (GEL, "um Pa nN"),
]


@pytest.mark.parametrize(("words", "units"), SHOWN, ids=["ball", "afm", "tip", "gel"])
def test_every_number_shown_is_in_the_units_of_the_contact(words, units, tmp_path):
    """The text, read back with its units, is the JSON, which is in SI; no other unit of a kind appears."""
    length, stress, force = units.split()
    done = coatcheck("solve", *shlex.split(words), cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    content = json.loads(coatcheck("solve", *shlex.split(words), "--json", cwd=tmp_path).stdout)
    assert content["units"] == {"length": "m", "stress": "Pa", "force": "N"}
    assert content["given"] == ({"approach": 0.004} if "--approach" in words else "load")
    text = done.stdout
    (load,) = re.findall(r"; W = ([\d.]+) (\S+),", text)
    assert load[1] == force
    assert float(load[0]) * FORCES[force] == pytest.approx(content["problem"]["load"], rel=1e-3)
    table = [line.split() for line in text.splitlines()]
    for symbol, (value, U) in zip(
        ("p0", "a", "approach"), content["answer"]["numbers"].values(), strict=True
    ):
        (row,) = [line for line in table if line[:1] == [symbol]]
        assert row[1] == (stress if symbol == "p0" else length)
        scale = (STRESSES | LENGTHS)[row[1]]
        assert float(row[2]) * scale == pytest.approx(value, rel=1e-4, abs=10 * U)
    (head,) = [line for line in text.splitlines() if line.startswith("largest ")]
    assert head.split()[2:] == [stress, "±", stress, "x", length, "z", length]
    places = [
        line for line in table if line[:1] == ["von_mises"] and "ball," not in line and "ball" not in line
    ]
    largest = [
        e for e in content["answer"]["extremes"] if e["quantity"] == "von_mises" and e["body"] == "flat"
    ]
    for row, at in zip(places, largest, strict=True):
        assert float(row[-4]) * STRESSES[stress] == pytest.approx(at["value"], rel=1e-3)
        near = 1e-3 * content["answer"]["numbers"]["contact_radius"][0]
        assert [float(word) * LENGTHS[length] for word in row[-2:]] == pytest.approx(
            [at["x"], at["z"]], abs=near
        )
    sentence = " ".join(text.split("\n\n")[1].split())
    assert set(re.findall(r"\b[\d.]+ ([numkM]?Pa|[num]m)\b", sentence)) == {length, stress}


def test_a_soft_thick_film_is_measured_in_its_own_radius(tmp_path):
    """10 um of gel are 2700 radii of the contact on bare glass, 15 of its own; no --force is needed."""
    done = coatcheck("solve", *shlex.split(GEL), "--json", cwd=tmp_path)
    content = json.loads(done.stdout)
    problem = parsed(content["case_file"]).problem
    assert 1e-5 / problem.a_h > 2000
    exact = solve_exactly(problem)
    assert 1e-5 / exact.contact_radius == pytest.approx(15, rel=0.05)
    for name, (value, U) in content["answer"]["numbers"].items():
        assert abs(value - getattr(exact, name)) <= U
    assert not [line for line in content["warnings"] if "radii" in line]


@pytest.mark.parametrize(("factor", "fits"), [(0.98, True), (1.02, False)])
def test_limits_of_thickness_hold_where_the_message_puts_them(factor, fits):
    """The thickness that the message names is accepted, for a stiff coating on a soft substrate too."""
    stiff = "E = 420e9; nu = 0.3; thickness = {}"
    with pytest.raises(CaseError) as error:
        parsed(case_text(stiff.format("9e-3"), E="1e9", load="1e-9", radius="10"))
    ((most, unit),) = re.findall(r"support [\d.e-]+ \w+ to ([\d.e+]+) (\w+)", str(error.value))
    text = case_text(stiff.format(factor * float(most) * LENGTHS[unit]), E="1e9", load="1e-9", radius="10")
    if fits:
        assert parsed(text).problem.coatings
    else:
        with pytest.raises(CaseError):
            parsed(text)
