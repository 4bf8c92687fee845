"""Inputs as people type them: understood, or one message that names the remedy and nothing written."""

from itertools import permutations
from pathlib import Path

import pytest
from quick_case import coatcheck

from verification.cases.case_file import parse_case
from verification.desk.case_wording import case_text

GIVEN = {
    "--ball": "10 mm, 210 GPa, 0.3",
    "--load": "20 N",
    "--coating": "2 um, 180 GPa, 0.2",
    "--substrate": "210 GPa, 0.3",
    "--friction": "0.15",
}

# Options changed (None leaves one out), and a word of the remedy.
WRONG = [
    ({"--diameter": "20 mm"}, "d = 20 mm"),
    ({"--mu": "0.1"}, "--friction"),
    ({"--nonsense": "1"}, "solve --help"),
    ({"--force": "20 N"}, 'give --load "20 N"'),
    ({"--residual-stress": "-2 GPa"}, "residual -1.5 GPa"),
    ({"--dT": "-400"}, "--temperature-change"),
    ({"--ball": "100Cr6"}, '"100Cr6 d = 6 mm"'),
    (
        {"--ball": "210 GPa, 0.3", "--roller": "R = 5 mm, L = 10 mm"},
        "a cylinder without a crown is not solved",
    ),
    ({"--ball": "210 GPa, 0.3", "--roller": "100Cr6 5 mm, 2 m"}, "its solid is --ball"),
    ({"--ball": "210 GPa, 0.3", "--against": "18 mm, flat"}, "radii of the other body"),
    ({"--ball": None}, "--ball"),
    ({"--friction": "0,15"}, "point"),
    ({"--friction": "3"}, "most"),
    ({"--friction": "nan"}, "finite"),
    ({"--load": "-20"}, "above"),
    ({"--load": "-20 N"}, "load must be above 0, not '-20 N'"),
    ({"--load": "20 Nm"}, 'a force such as "20 N", not'),
    ({"--load": None}, "give --load or --approach, or"),
    ({"--coating": "-2 um, 180 GPa, 0.2"}, "coating 1, thickness must be above 0, not '-2 um'"),
    ({"--coating": "2, 180 GPa, 0.2"}, 'give "2 um"'),
    ({"--coating": "DCL 2 um"}, "did you mean DLC?"),
    ({"--load": "20 kg"}, "20 N"),
    ({"--load": "heavy"}, "20 N"),
    ({"--load": "1,000 N"}, "two readings"),
    ({"--load": "5 lb"}, "lbf"),
    ({"--load": "20 MN"}, "mN"),
    ({"--friction": "15%"}, "without %"),
    ({"--frction": "0.1"}, "--friction"),
    ({"--ball": "steel 6 mm"}, "100Cr6 d = 6 mm, 210 GPa, 0.3"),
    ({"--coating": "diamand 2 um"}, "did you mean diamond"),
    ({"--substrate": "steel"}, "100Cr6 210 GPa, 0.3"),
    ({"--substrate": "steel"}, "100Cr6, mild steel, tool steel or stainless steel?"),
    ({"--coating": "9 x (2 um, 180 GPa, 0.2, 1 um, 200 GPa, 0.2)"}, 'are separated by " / "'),
    ({"--coating": "2 um, 130-300 GPa, 0.2"}, '"130 GPa to 300 GPa" in --coating'),
    ({"--depth": "100 nm"}, ': --depth. Try: --approach "100 nm"'),
    ({"--ball": None, "--radii": "5 mm, flat"}, "a contact along a line is not solved; give a crown"),
    ({"--substrate": "3 um 210 GPa, 0.3"}, "210 GPa"),
    ({"--coating": "a-C:H 3 um 150 GPa 0.25"}, "TiN 3 um, 450 GPa, 0.25"),
    ({"--coating": "10 x (0.2, 1 um, 180 GPa / 1 um, 9 GPa, 0.3)"}, 'E, nu, "1 um, 180 GPa, 0.2"'),
    ({"--coating": "180e9, 0.2, 2e-6"}, 'E, nu, "2e-6, 180e9, 0.2"'),
    ({"--coating": "20 x (2, 180 GPa, 0.2)"}, 'options: coating 1, thickness = 2 looks like um, give "2 um"'),
    ({"--coating": "2 um, 180 GPa, 0.2, -2 GPa"}, "residual -1.5 GPa"),
    ({"--coating": "2 um, 180 GPa, 0.2, strength 2 um"}, "strength must be"),
    ({"--coating": "0 x (2 um, 180 GPa, 0.2)"}, "repeat = 0"),
    ({"--coating": "1 500 nm, 180 GPa, 0.2"}, '"1500 nm"'),
    ({"--load": "1e9 N"}, "load"),
    ({"--ball": "10,5 mm, 210 GPa, 0,3"}, "point"),
    ({"--ball": "10 mm, 210 GPa"}, "radius, E, nu"),
    ({"--ball": "10 mm, 0.3, 210 GPa"}, "nu"),
    ({"--ball": "10 m, 210 GPa, 0.3"}, "--force"),
    ({"--ball": "10, 210e9, 0.3"}, "mm"),
    ({"--ball": "d = 20, 210e9, 0.3"}, "mm"),
    ({"--ball": "10 mm, 210, 0.3"}, "GPa"),
    ({"--ball": "10 mm, 210 GPa, 0.51"}, "0.5"),
    ({"--substrate": "210, 0.3"}, "GPa"),
    ({"--substrate": "210000, 0.3"}, "MPa"),
    ({"--substrate": "210 GPa"}, "E, nu"),
    ({"--substrate": "210 gpa, 0.3"}, "GPa"),
    ({"--substrate": "steel, 0.3"}, "210 GPa"),
    ({"--substrate": "5 TPa, 0.3"}, "--force"),
    ({"--coating": "2, 180e9, 0.2"}, "um"),
    ({"--coating": "0.002, 180e9, 0.2"}, "mm"),
    ({"--coating": "20 mm, 180 GPa, 0.2"}, "--force"),
    ({"--coating": "2 um, 180 GPa"}, "thickness, E, nu"),
    ({"--coating": "1 nm, 180 GPa, 0.2"}, "0.109 um"),
    ({"--plot": "missing/stress.png"}, "create"),
    ({"--plot": "stress.gif"}, ".png"),
]


@pytest.mark.parametrize(("changed", "remedy"), WRONG, ids=lambda value: str(value)[:60])
def test_a_wrong_input_is_one_message_with_its_remedy(changed, remedy, tmp_path):
    words = [word for option in (GIVEN | changed).items() if option[1] is not None for word in option]
    done = coatcheck("solve", *words, cwd=tmp_path)
    assert (done.returncode, done.stdout, list(tmp_path.iterdir())) == (2, "", [])
    errors = [line for line in done.stderr.splitlines() if "warning" not in line]
    assert len(errors) == 1
    assert remedy in errors[0]


FILE = """title = "mine"
[problem]
radius = "10 mm"
load = "20 N"
friction = 0.1
substrate = { E = "210 GPa", nu = 0.3 }
[[problem.coatings]]
E = "450 GPa"
nu = 0.22
thickness = "3 um"
"""
LIST = "thickness = [2e-5, 4e-5]"
STUDY = f"""title = "mine"
[problem]
radius = 10e-3
load = 20.0
substrate = {{ E = 210e9, nu = 0.3 }}
coating = {{ E = 420e9, nu = 0.25 }}
[sweep]
{LIST}
"""
# What is typed in place of what, and the whole message after the name of the file.
NO_FORCE = 'load must be a number or a force such as "20 N", not'
NO_LENGTH = 'radius must be a number or a length such as "3 um", not'
NO_TOML = "not TOML: Expected newline or end of document after a statement"
NO_STRESS = 'must be a number or a stress such as "210 GPa", not'
COURSE = (
    '; a graded coating has E = { course = "linear", top = "130 GPa", base = "300 GPa" } in a file, '
    '"130 GPa to 300 GPa" in --coating'
)
TYPED = [
    ("20 N", "1,000 N", f"{NO_FORCE} '1,000 N'; the comma has two readings, give \"1000 N\" or \"1.000 N\""),
    ("20 N", "1,234,567 N", f"{NO_FORCE} '1,234,567 N'; leave out the commas, \"1234567 N\""),
    ("20 N", "0,5 N", f"{NO_FORCE} '0,5 N'; write it with a decimal point, \"0.5 N\""),
    ("20 N", "1.000,5 N", f"{NO_FORCE} '1.000,5 N'; write it with a decimal point, \"1000.5 N\""),
    ("20 N", "1 000 N", f"{NO_FORCE} '1 000 N'; leave out the separators, \"1000 N\""),
    ("20 N", "2x10^1 N", f"{NO_FORCE} '2x10^1 N'; write it as \"2e1 N\""),
    ("20 N", "5 lb", f"{NO_FORCE} '5 lb'; 'lb' is not a unit of force, but of mass; did you mean lbf?"),
    ("20 N", "0.5 kg", f"{NO_FORCE} '0.5 kg'; 'kg' is not a unit of force, but of mass; did you mean kgf?"),
    ("20 N", "20 GPa", f"{NO_FORCE} '20 GPa'; 'GPa' is not a unit of force, but of stress"),
    ("20 N", "20 n", f"{NO_FORCE} '20 n'; the unit 'n' is unknown, did you mean N?"),
    ("20 N", "-20 N", "load must be above 0, not '-20 N'"),
    ("10 mm", "1/4 in", f"{NO_LENGTH} '1/4 in'; write the fraction as \"0.25 in\""),
    ("10 mm", "d = 6 mm", f"{NO_LENGTH} 'd = 6 mm'; give it as diameter = \"6 mm\""),
    (
        "10 mm",
        "d = 1/4 in",
        f"{NO_LENGTH} 'd = 1/4 in'; give it as diameter = \"1/4 in\"; write the fraction as \"0.25 in\"",
    ),
    ("210 GPa", "1.3505 210 GPa", f'substrate, E {NO_STRESS} \'1.3505 210 GPa\'; give "210 GPa" alone, and a '
     'name as name = "..."'),
    ("450 GPa", "130-300 GPa", f"coating 1, E {NO_STRESS} '130-300 GPa'; give one value{COURSE}"),
    ('"450 GPa"', '"3 um"', f"coating 1, E {NO_STRESS} '3 um'; 'um' is not a unit of stress, but of length"),
    ('"450 GPa"\nnu = 0.22\nthickness = "3 um"', '"3 um"\nnu = 0.22\nthickness = "450 GPa"',
     "coating 1 has thickness = 450 GPa and E = 3 um; exchange them"),
    ('"450 GPa"\nnu = 0.22\nthickness = "3 um"', '3e-6\nnu = 0.22\nthickness = 450e9',
     "coating 1 has thickness = 4.5e+11 and E = 3e-06; exchange them"),
    ("nu = 0.22", 'nu = "450 GPa"', "coating 1, nu must be a number without a unit, not '450 GPa'"),
    ("nu = 0.22", 'nu = "0,22"', "coating 1, nu must be a number, not '0,22'; write decimals with a point, "
     "without quotation marks"),
    ("friction = 0.1", 'friction = "10 %"', "friction must be a number, not '10 %'; 10 % is 0.1"),
    ("friction", "frictoin", "frictoin is an unknown key; did you mean friction?"),
    ("friction", "mu", "mu is an unknown key; did you mean friction?"),
    ("load", "Load", "Load is an unknown key; did you mean load?"),
    ("nu = 0.22", "poisson = 0.22", "coating 1, poisson is an unknown key; did you mean nu?"),
    ('E = "450', 'young = "450', "coating 1, young is an unknown key; did you mean E?"),
    ("thickness", "thicknes", "coating 1, thicknes is an unknown key; did you mean thickness?"),
    ("problem.coatings", "problem.coating", "coating is an unknown key; did you mean coatings?"),
    ("friction = 0.1", "frictoin = 0.1\nlaod = 2\nhardness = 7", "frictoin is an unknown key; did you mean "
     "friction? laod is an unknown key; did you mean load? hardness is an unknown key"),
    ('"20 N"', "20 N", f"{NO_TOML} (at line 4, column 11); "
     'a number with a unit is a text in quotation marks, such as "20 N"'),
    ("friction = 0.1", "friction = 0,1", f"{NO_TOML} (at line 5, column 13); "
     "write decimals with a point, such as 0.15"),
    (f"[sweep]\n{LIST}\n", "", "the file has no sweep, which a study has and a case has not: try coatcheck "
     "solve or coatcheck run with it, or change the study that coatcheck study init thickness writes"),
    ("[[problem.coatings]]", "[sweep]\n[[problem.coatings]]",
     "the file has a sweep, which is that of a study: try coatcheck study thickness with it"),
    ("[[problem.coatings]]",
     'coatings = [{ repeat = 9, stack = [{ E = "4 GPa", nu = 0.7, thickness = "2 um" }] }]\n[more]',
     "more is an unknown key; coating 1, nu must be at most 0.5, not 0.7 (and 8 more of the same)"),
    (LIST, 'thickness = ["1 N"]', f"sweep, thickness, value 1 {NO_LENGTH[7:]} "
     "'1 N'; 'N' is not a unit of length, but of force"),
    (LIST, "thicknes = [2e-5]", "sweep, thicknes is an unknown key; did you mean thickness?"),
    ("nu = 0.25", "nu = 0.7", "coating, nu must be at most 0.5, not 0.7"),
]  # fmt: skip


@pytest.mark.parametrize(("old", "new", "message"), TYPED, ids=lambda value: str(value)[:40])
def test_a_slip_in_a_file_is_one_message_as_a_person_would_say_it(old, new, message, tmp_path):
    text, command = (FILE, ["solve"]) if old in FILE else (STUDY, ["study", "thickness"])
    path = tmp_path / "mine.toml"
    path.write_text(text.replace(old, new, 1), encoding="utf-8")
    done = coatcheck(*command, str(path), cwd=tmp_path)
    assert (done.returncode, done.stdout, list(tmp_path.iterdir())) == (2, "", [path])
    assert done.stderr == f"coatcheck: {path}: {message}\n"


def test_any_other_order_of_a_layer_is_told_the_right_one():
    words = ("2 um", "180 GPa", "0.2")
    for order in [*permutations(words)][1:]:
        given = ", ".join(order)
        with pytest.raises(ValueError, match=f'"{given}": the order is .*, "{", ".join(words)}"$'):
            case_text("7 mm", "20 N", "210 GPa, 0.3", [given])


NAMED = [
    ("TiN 2 um, 450 GPa, 0.25, strength 2 GPa, residual -1.5 GPa", "coating", "TiN", 2e-6),
    ("10 x (TiN 100 nm, 450 GPa, 0.25 / CrN 200 nm, 250 GPa, 0.22)", "coating", "TiN", 1e-7),
    ("100Cr6 d = 6 mm, 210 GPa, 0.3", "ball", "100Cr6", 3e-3),
    ("Si3N4 6 mm, 310 GPa, 0.27", "ball", "Si3N4", 6e-3),
    ("6 mm diameter, 210 GPa, 0.3", "ball", "", 3e-3),
    ("Ø 0.25 inch, 210 GPa, 0.3", "ball", "", 0.003175),
    ("1.3505 210 GPa, 0.3", "substrate", "1.3505", 210e9),
    ("M2 HSS 60 HRC 220 GPa, 0.3", "substrate", "M2 HSS 60 HRC", 220e9),
    ("AISI 52100 210 GPa, 0.3", "substrate", "AISI 52100", 210e9),
    ("Ti-6Al-4V 114 GPa, 0.34", "substrate", "Ti-6Al-4V", 114e9),
    ("316L, 193e9, 0.27", "substrate", "316L", 193e9),
    ("30 Msi, 0.3", "substrate", "", 30e6 * 4.4482216152605 / 0.0254**2),
    ("210000 N/mm2, 0.3", "substrate", "", 210e9),
    ("DLC, 3 um, 150 GPa, 0.25", "coating", "DLC", 3e-6),
    ("TiN: 3 microns, 450 GPa, 0.25", "coating", "TiN", 3e-6),
    ("3 um DLC", "coating", "DLC", 3e-6),
    ("DLC, 3 um", "coating", "DLC", 3e-6),
    ("3 um, DLC", "coating", "DLC", 3e-6),
    ("DLC 3 um, E = 150 GPa, nu = 0.25", "coating", "DLC", 3e-6),
    ("6 mm 100Cr6", "ball", "100Cr6", 6e-3),
    ("100Cr6, d = 6 mm", "ball", "100Cr6", 3e-3),
]


@pytest.mark.parametrize(("text", "option", "name", "value"), NAMED)
def test_names_and_units_beside_numbers_are_understood(text, option, name, value):
    given = {"ball": "7 mm", "substrate": "210 GPa, 0.3", "coating": "3 um, 180 GPa, 0.2"} | {option: text}
    words = case_text(given["ball"], "20 N", given["substrate"], [given["coating"]])
    case = parse_case(words.encode(), Path("options"))
    contact, layer = case.problem, case.problem.coatings[0]
    assert len(contact.coatings) == (20 if "10 x" in text else 1)
    assert case.limits == ({"coatings.0.strength": 2e9} if "strength" in text else {})
    assert case.residual == ({"flat": (-1.5e9,)} if "residual" in text else {})
    found = {"ball": contact.radius, "substrate": contact.substrate[0], "coating": layer[2]}
    assert found[option] == pytest.approx(value, rel=1e-12)
    body, at = {"ball": ("ball", -1), "substrate": ("flat", -1), "coating": ("flat", 0)}[option]
    assert case.names[body][at] == name


def test_a_ball_with_its_size_lies_in_its_race():
    words = ("5 N", "100Cr6")
    race = case_text("100Cr6 d = 9.525 mm", *words, against="18.2 mm, -4.9 mm")
    radii = {"radii": "4.7625 mm, 4.7625 mm", "against": "18.2 mm, -4.9 mm"}
    stated = [
        parse_case(text.encode(), Path("options")) for text in (race, case_text("100Cr6", *words, **radii))
    ]
    assert stated[0].problem == stated[1].problem
    rigid = case_text("4.7625 mm", *words, against="18.2 mm, -4.9 mm")
    assert parse_case(rigid.encode(), Path("options")).problem.ball is None


def test_stacks_part_where_a_layer_ends():
    for between in (" / ", "/", "/ "):
        text = case_text(
            "6 mm", "5 N", "100Cr6", [f"5 x (WC/C 100 nm, 200 GPa, 0.2{between}CrN 100nm{between}DLC 1 um)"]
        )
        names = parse_case(text.encode(), Path("options")).names["flat"]
        assert names == (*5 * ("WC/C", "CrN", "DLC"), "100Cr6")


def test_likely_slips_that_are_valid_have_one_line_each():
    def read(*changes):
        text = FILE
        for old, new in changes:
            text = text.replace(old, new, 1)
        return parse_case(text.encode(), Path("mine.toml"))

    assert read(('"10 mm"', '"3 mm"')).remarks == read(('radius = "10', 'diameter = "20')).remarks == ()
    (line,) = read(('"10 mm"', '"6 mm"')).remarks
    assert line == '6 mm is a usual diameter of balls; if it is yours, give "d = 6 mm", in a file diameter'
    heated = (("nu = 0.22", "nu = 0.22\nexpansion = 2e-6"), ("nu = 0.3", "nu = 0.3, expansion = 12e-6"))
    (line,) = read(*heated, ("friction = 0.1", "temperature_change = 400")).warnings
    assert "2.31 GPa of tension; cooling from deposition is negative, -400" in line
    assert read(*heated, ("friction = 0.1", "temperature_change = -400")).warnings == ()


def test_implausible_numbers_are_solved_with_force_and_a_warning(tmp_path):
    words = ["solve", "--ball", "2 m", "--load", "20 N", "--substrate", "210 GPa, 0.3"]
    assert coatcheck(*words, cwd=tmp_path).returncode == 2
    done = coatcheck(*words, "--force", cwd=tmp_path)
    assert done.returncode == 0
    assert "radius = 2 m" in done.stderr


def test_a_stiff_ball_on_a_soft_incompressible_flat_is_solved_as_stated(tmp_path):
    words = ["solve", "--load", "1 mN", "--substrate", "2 MPa, 0.5", "--friction", "0.1", "--ball"]
    done = coatcheck(*words, "10 mm, 210 GPa, 0.3", cwd=tmp_path)
    assert (done.returncode, done.stderr.count("rigid")) == (0, 0)


def test_an_indenter_that_is_no_ellipsoid_is_refused_by_solve(tmp_path):
    done = coatcheck("solve", "27_two_asperities", cwd=tmp_path)
    assert done.returncode == 2
    assert "indenter" in done.stderr
    assert not list(tmp_path.iterdir())
