"""Three ways in, one face: functions, programs, files give the same verdicts."""

import csv
import json
import shutil
import sys
from itertools import product
from pathlib import Path

import pytest
from guest_exams import guest_in, prepared, question
from pydantic.json_schema import models_json_schema
from quick_case import coatcheck

import verification
from verification.cases.case_file import read_case, shipped_cases
from verification.guests.diagnosis.slip_diagnosis import causes_of
from verification.guests.doors.ask_guest import answered
from verification.guests.doors.file_door import pack, read_answer
from verification.guests.exam_subjects import PLANE, REFERENCE
from verification.guests.guest_protocol import VERSION, GuestAnswer, ProtocolError, Question
from verification.guests.guest_verdicts import judged
from verification.judging.verdict import Outcome
from verification.problem.line_profile import all_lines
from verification.problem.quantity import STRESSES
from verification.running.case_result import SourceResult
from verification.running.contact_run import decide
from verification.sampling.line_sampling import sample, sample_contact
from verification.sources.source_registry import SOURCES

PACKAGE = Path(verification.__file__).parent
EXAMPLES = PACKAGE / "guests" / "examples"
SUPPORTS = "supports = { coatings = 50, friction = true, stress = true }\n"
SERVED = ["-m", "verification.guests.doors.serve_function"]


def filled(path, key, answers):
    """The CSV file at ``path`` with the cells of ``answers`` by column filled in where a row has them."""
    with path.open() as file:
        rows = list(csv.DictReader(file))
    for row in rows:
        row |= {name: repr(float(v[row[key]])) for name, v in answers.items() if row[key] in v}
    with path.open("w") as file:
        writer = csv.DictWriter(file, [*rows[0], *(name for name in answers if name not in rows[0])])
        writer.writeheader()
        writer.writerows(rows)


def fill(folder, question, answer):
    """Fill the files of ``question`` with the values of ``answer``, as a user would."""
    both = (("value", "", answer.values), ("uncertainty", "U ", answer.uncertainty))
    numbers = {name: part.get("contact", {}) for name, _, part in both}
    filled(folder / "contact.csv", "quantity", numbers)
    points: dict = {}
    for _, prefix, part in both:
        number = 0
        for line in question.lines:
            for quantity, values in part.get(line.line, {}).items():
                cells = points.setdefault(prefix + quantity, {})
                cells |= {str(number + i): value for i, value in enumerate(values)}
            number += len(line.x)
    filled(folder / "points.csv", "number", points)


def through_all_doors(method, case, exam, folder):
    """Results of a method as function, as program and as files, at one case."""
    name = f'name = "own"\ntime_limit = 900\n{SUPPORTS}'  # of a machine at work
    command = json.dumps([sys.executable, *SERVED, f"{method}:solve"])
    by_function = guest_in(folder / "function", f'{name}callable = "{method}:solve"')
    by_program = guest_in(folder / "program", f"{name}command = {command}")
    by_files = guest_in(folder / "files", f'{name}results = "answers"')
    results = []
    for guest in (by_function, by_program):
        questions = [question(case, exam, guest)]
        replies = answered(guest, case, questions)
        results.append(judged(guest, case, exam, replies))
    fill(pack(by_files, case, questions[0]), questions[0], replies[-1].answer)
    results.append(judged(by_files, case, exam, answered(by_files, case, questions)))
    return results


def inside_verdicts(name, method, exam):
    """Verdicts as the run inside reaches them, at the points that guests are asked for."""
    case, source = read_case(shipped_cases()[name]), SOURCES[method]
    solution = source.solve(case.problem, case.numerics.get(method, {}))
    places = {p.line: p.position for p in exam.profiles}
    edge = float(exam.profile_of["contact_radius", "contact", REFERENCE].value[0])
    found = list(sample_contact(solution, method))
    for line in all_lines(case.problem):
        found += sample(solution, method, line, places[line.name], case.problem, edge)
    profiles = {(p.quantity, p.line, p.source): p for p in (*exam.profiles, *found)}
    sides = {side: SourceResult(side, 0.0) for side in (method, REFERENCE)}
    claims = [claim for claim in case.claims if claim.between == tuple(sides)]
    return {(c.quantity, c.line): decide(c, profiles, sides, case.problem).outcome for c in claims}


def outcomes(result):
    return {(c.quantity, c.line): v.outcome for c, v in result.verdicts}


def check_own(method, name, folder):
    """The verdicts through all doors are equal, and those of the run inside; on the plane they are more."""
    case, exam = prepared(name, folder)
    function, program, files = through_all_doors(method, case, exam, folder)
    assert function.verdicts == program.verdicts == files.verdicts
    inside = inside_verdicts(name, method, exam)
    expected = inside | {(q, PLANE): Outcome.AGREES for q in STRESSES}
    differing = {key for key, outcome in outcomes(function).items() if outcome is not expected[key]}
    # a guest states its uncertainty at fixed points, which next to the edge is that of the contact radius:
    # of the pressure, of the shear f p, of the stresses along the surface
    surfaces = product(("sigma_xx", "sigma_yy", "sigma_xz", "pressure"), ("surface", "ball, surface"))
    assert differing <= set(surfaces)
    assert {outcomes(function)[key] for key in differing} <= {Outcome.INCONCLUSIVE}
    return function


ELLIPTICAL = """
def solve(radius, load, substrate, indenter, coatings=()):
    from verification.sources.references.hertz_ellipse import pressed_ellipsoid
    E, nu = substrate
    found = pressed_ellipsoid(*indenter[1], load, E, {nu})
    names = "contact_radius", "approach", "peak_pressure"
    return dict((name, getattr(found, name)) for name in names)
"""


def test_an_ellipsoid_is_asked_of_a_guest_that_supports_it_and_judged_by_the_closed_form(tmp_path):
    case, exam = prepared("24_ellipse", tmp_path)
    text = 'name = "own"\nclaim = 1e-6\n{}callable = "{}:solve"\n'
    assert "ellipsoid" in guest_in(tmp_path, text.format("", "adapter")).refusal(case.problem)
    for name, nu, outcome in (("right", "nu", Outcome.AGREES), ("wrong", "0.0", Outcome.DISAGREES)):
        (tmp_path / f"{name}.py").write_text(ELLIPTICAL.format(nu=nu))
        guest = guest_in(tmp_path, text.format("supports = { ellipsoid = true }\n", name))
        asked = question(case, exam, guest)
        result = judged(guest, case, exam, answered(guest, case, [asked]))
        assert {one.source for one in result.sources} == {"own", "hertz"}
        assert set(outcomes(result)) == {(q, "contact") for q in asked.contact}
        assert set(outcomes(result).values()) == {outcome}
        slips = [cause.name for cause in causes_of(case, result, "own")]
        assert slips == (["nu = 0 in place of Poisson's ratio"] if name == "wrong" else [])


@pytest.mark.slow
def test_the_semi_analytical_method_gets_the_verdicts_it_has_inside(tmp_path):
    function = check_own("semianalytic", "01_uncoated_steel", tmp_path)
    assert set(outcomes(function).values()) <= {Outcome.AGREES, Outcome.INCONCLUSIVE}


@pytest.mark.slow
@pytest.mark.parametrize(
    "name", ["05_ratio_4", "14_ratio_4_sliding", "08_dlc_chromium_steel", "21_coated_carbide_dlc_steel"]
)
@pytest.mark.parametrize("method", ["semianalytic", "fem_reference"])
def test_own_methods_get_the_verdicts_they_have_inside(tmp_path, method, name):
    check_own(method, name, tmp_path)


def test_init_writes_a_guest_that_runs_as_it_is(tmp_path):
    for words in (["mine"], ["mine_too", "--program"]):
        assert coatcheck("guest", "init", *words, cwd=tmp_path).returncode == 0
        done = coatcheck("guest", "check", words[0], cwd=tmp_path)
        assert done.returncode == 0, done.stdout + done.stderr
        assert "4 of 4" in done.stdout
    assert coatcheck("guest", "init", "mine", cwd=tmp_path).returncode == 2


@pytest.mark.parametrize(
    ("first", "last", "code"),
    [
        # in an environment of its own, with numpy alone
        (
            f"python = {json.dumps(sys.executable)}\n",
            "",
            "import sys\nassert 'pydantic' not in sys.modules and 'scipy' not in sys.modules\n",
        ),
        # N, mm, MPa are consistent
        ("", '\n[units]\nlength = "mm"\nstress = "MPa"\n', ""),
    ],
    ids=["own environment", "own units"],
)
def test_the_example_gets_its_verdicts_in_its_own_environment_and_in_its_own_units(
    tmp_path, first, last, code
):
    for name, before, after in (("guest.toml", first, last), ("adapter.py", "", code)):
        (tmp_path / name).write_text(before + (EXAMPLES / "start" / name).read_text() + after)
    done = coatcheck("guest", "check", ".", cwd=tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "4 of 4" in done.stdout


UNDER_DISC = """
def solve(pressure=None, load_radius=None, substrate=None, **sphere):
    if pressure is None:
        raise NotImplementedError("no sphere")
    def displacement(x, y, z):
        return np.array([0 * x, 0 * x, 0 * x + 4 / np.pi * pressure * load_radius / substrate[0]])
    return {"displacement": displacement}
"""


@pytest.mark.slow
def test_a_function_of_another_environment_is_asked_under_a_disc(tmp_path):
    supports = 'supports = { loads = ["disc"] }'
    text = f'name = "d"\ncallable = "adapter:solve"\nclaim = 0.01\n{supports}\n'
    found = []
    for python in ("", f"python = {json.dumps(sys.executable)}\n"):
        (tmp_path / "adapter.py").write_text(f"import numpy as np\n{UNDER_DISC}")
        (tmp_path / "guest.toml").write_text(python + text)
        done = coatcheck("guest", "run", ".", "01_uncoated_steel", "--json", cwd=tmp_path)
        found.append(json.loads(done.stdout)["cases"])
    assert found[0] == found[1]
    assert "NO_RESULT" not in found[0]["01_uncoated_steel_disc"]


def test_judge_judges_what_was_packed(tmp_path):
    assert coatcheck("guest", "pack", "mine", "01_uncoated_steel", cwd=tmp_path).returncode == 0
    done = coatcheck("guest", "judge", "mine", "--json", cwd=tmp_path)
    assert json.loads(done.stdout)["cases"].keys() == {"01_uncoated_steel"}
    shutil.rmtree(tmp_path / "mine" / "answers")
    assert coatcheck("guest", "judge", "mine", cwd=tmp_path).returncode == 2


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "missing"),
        ('name = "x"', "callable"),
        ('name = "x"\ncallable = "a"', "module:function"),
        ('name = "x"\ncallable = "a:b"\ncommand = ["c"]', "one"),
        ('name = "hertz"\ncallable = "a:b"', "coatcheck"),
        ('name = "x"\ncallable = "a:b"\nclaim = 2', "claim"),
        ('name = "x"\ncallable = "a:b"\n[refine]\nn = [1, 2]', "refine, n list"),
        ('name = "x"\ncallable = "a:b"\n[refine]\nn = [1, 4, 2]', "coarse"),
        ('name = "x"\ncallable = "a:b"\n[known]\n"p" = "why"', "case/quantity"),
        ('name = "x"\ncallable = "a:b"\n[units]\nlength = "furlong"', "units, length"),
        ('name = "x"\ncallable = "a:b"\nfrobnicate = 1', "frobnicate"),
    ],
)
def test_a_guest_file_that_cannot_be_used_is_code_2_with_one_message(tmp_path, text, words):
    (tmp_path / "g").mkdir()
    (tmp_path / "g" / "guest.toml").write_text(text)
    done = coatcheck("guest", "run", "g", cwd=tmp_path)
    assert done.returncode == 2
    assert words in done.stderr
    assert len(done.stderr.strip().splitlines()) == 1


def test_exit_codes_of_a_guest(tmp_path):
    shutil.copytree(EXAMPLES / "program", tmp_path / "g")
    adapter, description = tmp_path / "g" / "adapter.py", tmp_path / "g" / "guest.toml"
    command = json.dumps([sys.executable, "-S", "-E", "adapter.py"])
    right, text = adapter.read_text(), f'name = "g"\ncommand = {command}\nclaim = 1e-6\n'

    def code(program=right, guest=text):
        adapter.write_text(program)
        description.write_text(guest)
        done = coatcheck("guest", "run", "g", "01_uncoated_steel", "05_ratio_4", "--json", cwd=tmp_path)
        found.update(json.loads(done.stdout))
        return done.returncode

    found = {}
    assert code() == 0
    first, second = (found["cases"][name] for name in ("01_uncoated_steel", "05_ratio_4"))
    assert first["AGREES"] == 4
    assert set(second) == {"UNSUPPORTED"}
    skipped = (tmp_path / "g" / "report" / "junit.xml").read_text().count("<skipped")
    assert skipped == first["UNSUPPORTED"] + second["UNSUPPORTED"]
    wrong = right.replace('"contact_radius": a', '"contact_radius": 2 * a')
    assert code(wrong) == 1
    known = f'{text}[known]\n"01_*/contact_radius" = "reported"\n'
    assert code(wrong, known) == 0
    assert code(right, known) == 1  # a known failure that agrees
    assert found["unexpected"] == [["01_uncoated_steel/contact_radius/contact", "reported"]]
    assert code("raise RuntimeError('no licence')") == 3
    assert code(right, text.replace("claim = ", "# claim = ")) == 4


def test_files_that_are_filled_in_wrongly_are_named(tmp_path):
    case, exam = prepared("01_uncoated_steel", tmp_path)
    guest = guest_in(tmp_path / "files", f'name = "f"\nresults = "answers"\nclaim = 0.01\n{SUPPORTS}')
    asked = question(case, exam, guest)
    folder = pack(guest, case, asked)

    def answer(name, old, new):
        """What is read where the packed file ``name`` has ``new`` for ``old``."""
        path = folder / name
        packed = path.read_text()
        path.write_text(packed.replace(old, new, 1))
        try:
            return read_answer(guest, case, asked)
        finally:
            path.write_text(packed)

    assert answer("contact.csv", "", "").unsupported is not None
    given = answer("contact.csv", "contact_radius,m,", "contact_radius,m,8.66e-5")
    assert given.values == {"contact": {"contact_radius": 8.66e-5}}
    wrong = answer("contact.csv", "contact_radius,m,", "contact_radius,m,wide")
    assert "contact.csv" in wrong.failed["contact"]["contact_radius"]
    last = (folder / "points.csv").read_text().splitlines()[-1]
    with pytest.raises(ProtocolError, match="once"):
        answer("points.csv", last, "")
    assert "pressure" in answer("points.csv", "0,,,,-", "0,1e9,,,-").failed["surface"]["pressure"]


def test_the_schema_of_the_package_is_that_of_the_code():
    _, definitions = models_json_schema(
        [(Question, "validation"), (GuestAnswer, "validation")],
        title="coatcheck guest protocol",
        description=VERSION,
    )
    schema = {"$schema": "https://json-schema.org/draft/2020-12/schema", **definitions}
    assert json.loads((PACKAGE / "guests" / "protocol.schema.json").read_text()) == schema
