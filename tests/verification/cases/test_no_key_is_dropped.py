"""Nothing that a file states is dropped in silence: each key changes what each command shows, or is refused.

A key that the table below lacks fails too, so that a new one is decided on.
"""

import ast
import typing
from dataclasses import replace
from functools import cache
from pathlib import Path

import pytest
from case_texts import study_text
from pydantic import BaseModel

from verification.cases import case_file
from verification.cases.case_file import parse_case
from verification.cases.toml_file import CaseError
from verification.commands import solve
from verification.credibility.model_error import ModelError
from verification.desk import contact_answer, layer_limits
from verification.judging.invariants import influence_error
from verification.problem.coated_contact import CoatedContact
from verification.running.case_result import to_json
from verification.running.contact_run import run
from verification.sources.source_registry import SOURCES
from verification.study.choice.failure_criteria import Criteria
from verification.study.study_plan import parse_study

CLAIM = """[[claim]]
quantity = "peak_pressure"
line = "contact"
between = ["semianalytic", "fem_reference"]
cap = 1e-3
why = "because"
"""
CASE = {
    "title": '"Mine"',
    "problem.radius": '"5 mm"',
    "problem.load": "20.0",
    "problem.friction": "0.1",
    "problem.substrate.E": "210e9",
    "problem.substrate.nu": "0.3",
    "problem.coatings.E": "300e9",
    "problem.coatings.nu": "0.25",
    "problem.coatings.thickness": "20e-6",
    "problem.ball.E": "310e9",
    "problem.ball.nu": "0.27",
    "problem.ball.coatings.E": "200e9",
    "problem.ball.coatings.nu": "0.25",
    "problem.ball.coatings.thickness": "10e-6",
}
THERMAL = {
    "problem.temperature_change": "-300",
    "problem.substrate.expansion": "12e-6",
    "problem.coatings.expansion": "9e-6",
}
ON_BALL = {"problem.temperature_change": "-300", "problem.ball.expansion": "12e-6"}
ON_BALL |= {"problem.ball.coatings.expansion": "9e-6"}
GRADED = '{ course = "linear", top = 4e11, base = 2e11 }'
TABLE = "{ depth = [0.0, 0.5, 1.0], E = [4e11, 3e11, 2e11] }"
LAYERS = {"problem.coatings.layers": "4"}
ELLIPSE = {"problem.ball": None, "problem.radius": None, "problem.indenter.shape": '"ellipsoid"'}
BENT = {"problem.indenter.radii": "[5e-3, 6e-3]"}
LOBES = {"problem.ball": None, "problem.indenter.shape": '"lobes"', "problem.indenter.lobes": "3"}
LOBES |= {"problem.indenter.amplitude": "1e-9", "problem.indenter.at": "1e-5"}
SPHERES = {"problem.ball": None, "problem.indenter.shape": '"asperities"'}
CLAIMED = {"claim": CLAIM}
# Each key: what stands beside it, two values that have to give different work.
KEYS = {
    "title": ({}, '"Mine"', '"Yours"'),
    "source": ({}, '"me"', '"you"'),
    "resolve": ({}, "false", "true"),
    "problem.radius": ({}, "5e-3", "6e-3"),
    "problem.diameter": ({"problem.radius": None}, "10e-3", "12e-3"),
    "problem.load": ({}, "20", "21"),
    "problem.approach": ({"problem.load": None}, "4e-7", "5e-7"),
    "problem.friction": ({}, "0.1", "0.2"),
    "problem.temperature_change": (THERMAL, "-300", "-400"),
    "problem.indenter.shape": (SPHERES | {"problem.indenter.distance": "1e-5"}, None, '"asperities"'),
    "problem.indenter.radii": (ELLIPSE, "[5e-3, 6e-3]", "[5e-3, 7e-3]"),
    "problem.indenter.against": (ELLIPSE | BENT, "[1e-2, -7e-3]", "[1e-2, -8e-3]"),
    "problem.indenter.distance": (SPHERES, "1e-5", "2e-5"),
    "problem.indenter.lobes": (LOBES, "3", "4"),
    "problem.indenter.amplitude": (LOBES, "1e-9", "2e-9"),
    "problem.indenter.at": (LOBES, "1e-5", "2e-5"),
    "problem.coatings.thickness_over_a_h": ({"problem.coatings.thickness": None}, "0.5", "0.6"),
    "problem.coatings.layers": ({"problem.coatings.E": GRADED}, "4", "5"),
    "problem.coatings.E.course": (LAYERS, GRADED, GRADED.replace("linear", "exponential")),
    "problem.coatings.E.top": (LAYERS, GRADED, GRADED.replace("4e11", "5e11")),
    "problem.coatings.E.base": (LAYERS, GRADED, GRADED.replace("2e11", "1e11")),
    "problem.coatings.E.depth": (LAYERS, TABLE, TABLE.replace("0.5", "0.4")),
    "problem.coatings.E.E": (LAYERS, TABLE, TABLE.replace("3e11", "2e11")),
    "problem.ball.coatings.thickness_over_a_h": ({"problem.ball.coatings.thickness": None}, "0.5", "0.6"),
    "problem.ball.coatings.layers": ({"problem.ball.coatings.E": GRADED}, "4", "5"),
    "semianalytic.patches": ({}, "129", "65"),
    "semianalytic.conversion": ({}, '"split"', '"plain"'),
    "semianalytic.edge_correction": ({}, "true", "false"),
    "semianalytic.approach": ({}, "4e-7", "5e-7"),
    "semianalytic.max_iterations": ({}, "100", "200"),
    "fem_reference.order": ({}, "2", "3"),
    "fem_reference.quality": ({}, '"fast"', '"default"'),
    "claim.quantity": (CLAIMED, CLAIM, CLAIM.replace("peak_pressure", "approach")),
    "claim.line": (CLAIMED, CLAIM, CLAIM.replace("peak_pressure", "pressure").replace("contact", "surface")),
    "claim.between": (CLAIMED, CLAIM, CLAIM.replace("fem_reference", "integral_equation")),
    "claim.cap": (CLAIMED, CLAIM, CLAIM.replace("1e-3", "1e-2")),
    "claim.why": (CLAIMED, CLAIM, CLAIM.replace("because", "since")),
    "claim.edge": (CLAIMED, CLAIM, CLAIM + "edge = 0.01\n"),
}
for solid, expansion in (
    ("substrate", THERMAL),
    ("coatings", THERMAL),
    ("ball", ON_BALL),
    ("ball.coatings", ON_BALL),
):
    KEYS |= {
        f"problem.{solid}.name": ({}, '"A"', '"B"'),
        f"problem.{solid}.hardness": ({}, "1e7", "2e7"),
        f"problem.{solid}.yield_strength": ({}, "1e8", "2e8"),
        f"problem.{solid}.strength": ({}, "1e8", "2e8"),
        f"problem.{solid}.E": ({}, "2.5e11", "2.6e11"),
        f"problem.{solid}.nu": ({}, "0.2", "0.21"),
        f"problem.{solid}.expansion": (expansion, "7e-6", "8e-6"),
    }
for solid in ("coatings", "ball.coatings"):
    KEYS[f"problem.{solid}.adhesion"] = ({}, "1e8", "2e8")
    KEYS[f"problem.{solid}.residual_stress"] = ({}, "-1e9", "-2e9")
    KEYS[f"problem.{solid}.thickness"] = ({}, "11e-6", "12e-6")
COURSES = ("course", "top", "base", "depth", "E")
SAME = {f"problem.ball.coatings.E.{key}" for key in COURSES}  # read by the same class as those of the flat


def keys_of(model, before=""):
    """Every key of a file by its path, without the numbers of list entries."""
    for name, field in model.model_fields.items():
        key = f"{before}{field.alias or name}"
        parts = list(inner(field.annotation))
        if not parts or name == "E":
            yield key
        for part in parts:
            yield from keys_of(part, f"{key}.")


def inner(annotation):
    """The tables that a key may hold."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        yield annotation
    for part in typing.get_args(annotation):
        yield from inner(part)


QUADRATURE = cache(influence_error.surface_coefficient)  # of the same layers for most keys
KNOWN = set(keys_of(case_file._CaseFile))


def file_of(keys):
    """TOML of ``keys``; None leaves a key, or all below it, out."""
    gone = tuple(key for key, value in keys.items() if value is None)
    lines, claims = [], keys.get("claim", "")
    for key, value in keys.items():
        if value is None or key == "claim" or key.startswith(tuple(f"{one}." for one in gone)):
            continue
        tables, name = key.rsplit(".", 1) if "." in key else ("", key)
        lines.append((tables, f"{name} = {value}"))
    text = "".join(f"{line}\n" for table, line in lines if not table)
    for table in dict.fromkeys(table for table, _ in lines if table):
        head = f"[[{table}]]" if table.endswith("coatings") else f"[{table}]"
        text += f"{head}\n" + "".join(f"{line}\n" for at, line in lines if at == table)
    return text + claims


def both(key):
    """The two files of a ``key``."""
    beside, first, second = KEYS[key]
    place = "claim" if key.startswith("claim") else key if ".E." not in key else key.rpartition(".")[0]
    return [file_of(CASE | beside | {place: value}) for value in (first, second)]


@cache
def made_up(bodies, layers):
    """An answer with the layers of a problem: coatings of the substrate's own material."""
    steel, film = (210e9, 0.3), (210e9, 0.3, 5e-6)
    ball = (*steel, (film,) * bodies[1]) if len(bodies) > 1 else None
    problem = CoatedContact(5e-3, 20.0, (film,) * bodies[0], steel, 0.1, ball)
    return contact_answer.answer(problem, "hertz", {}, None, ast.literal_eval(layers))


def work_of(text, command, capsys, monkeypatch):
    """What a command shows of a file, from made-up solutions that depend on all that they are given."""
    try:
        case = replace(parse_case(text.encode(), Path("mine.toml")), text="")
    except CaseError as error:
        return str(error).split(":")[1:3]  # refused, by key
    given = []

    def solved(source):
        def answer(problem, numerics):
            given.append((source, repr(problem), sorted(numerics.items())))
            return SOURCES["hertz"].solve(replace(problem, indenter=None), {})

        return answer

    if command == "run":
        monkeypatch.setattr(influence_error, "surface_coefficient", QUADRATURE)
        found = to_json(run(case, {name: solved(name) for name in ("semianalytic", "fem_reference")}))
        for result in found["sources"]:
            result["seconds"] = 0.0
        return repr((found | {"seconds": 0.0}, given))
    asked = []

    def answer(problem, source, numerics=None, residual=None, layers=None):
        asked.append((repr(problem), source, repr(numerics), repr(residual), repr(layers)))
        bodies = tuple(len(problem.seen_from(body).coatings) for body in problem.bodies)
        return made_up(bodies, repr(layers))

    for module in (solve, layer_limits):
        monkeypatch.setattr(module, "answer", answer)
    monkeypatch.setattr(solve, "model_error", lambda problem, sample=None: ModelError(()))
    path = Path("mine.toml")
    path.write_text(text)
    solve.solve("mine.toml", force=True)
    shown = capsys.readouterr()
    lines = [line for line in shown.out.splitlines() if not line.startswith("time:")]
    return repr((asked, lines, shown.err))


def test_every_key_of_a_case_file_is_in_the_table():
    assert KNOWN - KEYS.keys() - SAME == set()


@pytest.mark.parametrize("command", ["run", pytest.param("solve", marks=pytest.mark.slow)])
@pytest.mark.parametrize("key", sorted(KEYS.keys() & KNOWN))
def test_each_key_changes_what_a_command_works_with(key, command, capsys, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    if command == "solve" and key.split(".")[0] in ("claim", "fem_reference", "resolve"):
        pytest.skip("named as a table for coatcheck run")
    first, second = (work_of(text, command, capsys, monkeypatch) for text in both(key))
    refused = command == "solve" and "solve answers for balls" in first
    assert refused or first != second


STUDY = study_text(
    'coating = { E = "300 GPa", nu = 0.25 }',
    'ball = { E = "310 GPa", nu = 0.27, coatings = [{ E = 2e11, nu = 0.25, thickness = 1e-6 }] }',
    sweep='thickness = ["2 um", "5 um"]',
)
COATING, HELD = "nu = 0.25 }\nball", "nu = 0.25 }]\nball"
STACK = STUDY.replace("coating = {", "coatings = [{ nu = 0.2, E = 2e11, thickness = 1e-6 }, {").replace(
    COATING, HELD
)


@pytest.mark.parametrize(
    ("file", "old", "new", "refused"),
    [
        (STUDY, "title =", 'source = "me"\ntitle =', ""),
        (STUDY, "load =", "approach = 1e-6 #", "problem approach differs"),
        (STUDY, "nu = 0.3 }", 'nu = 0.3, name = "HSS" }', ""),
        (STUDY, "nu = 0.3 }", 'nu = 0.3, hardness = "9 GPa" }', ""),
        (STUDY, "nu = 0.3 }", 'nu = 0.3, yield_strength = "3 GPa" }', ""),
        (STUDY, "nu = 0.3 }", "nu = 0.3, expansion = 12e-6 }", "substrate.expansion"),
        (STUDY, COATING, 'nu = 0.25, name = "TiN" }\nball', ""),
        (STUDY, COATING, 'nu = 0.25, hardness = "25 GPa" }\nball', ""),
        (STUDY, COATING, 'nu = 0.25, yield_strength = "9 GPa" }\nball', ""),
        (STUDY, COATING, 'nu = 0.25, strength = "2 GPa" }\nball', "coating.strength"),
        (STUDY, COATING, 'nu = 0.25, residual_stress = "-1 GPa" }\nball', ""),
        (STUDY, COATING, "nu = 0.25, expansion = 9e-6 }\nball", "expansion"),
        (STUDY, "[sweep]", "temperature_change = -300\n[sweep]", "temperature_change"),
        (STUDY, "nu = 0.27,", 'nu = 0.27, name = "Si3N4",', ""),
        (STUDY, "nu = 0.27,", 'nu = 0.27, hardness = "15 GPa",', ""),
        (STUDY, "nu = 0.27,", 'nu = 0.27, yield_strength = "9 GPa",', "ball.yield_strength"),
        (STUDY, "nu = 0.27,", "nu = 0.27, expansion = 3e-6,", "ball: leave"),
        (STUDY, "thickness = 1e-6", 'thickness = 1e-6, name = "DLC"', ""),
        (STUDY, "thickness = 1e-6", 'thickness = 1e-6, yield_strength = "9 GPa"', "coatings.0.yield"),
        (STUDY, "thickness = 1e-6", "thickness = 1e-6, residual_stress = -1e9", "ball: leave"),
        (STACK, "thickness = 1e-6 }, {", 'thickness = 1e-6, name = "WC" }, {', ""),
        (STACK, "thickness = 1e-6 }, {", "thickness = 1e-6, hardness = 9e9 }, {", ""),
        (STACK, "thickness = 1e-6 }, {", "thickness = 1e-6, yield_strength = 9e9 }, {", "coatings.0.yield"),
    ],
)
def test_each_key_beside_the_moduli_changes_a_study_or_is_refused(file, old, new, refused):
    def study(text):
        found = parse_study(text.encode(), Path("mine.toml"))
        return replace(found, text="", criteria=Criteria()), found.criteria.strength

    assert old in file
    changed = file.replace(old, new, 1)
    if refused:
        with pytest.raises(CaseError, match=refused):
            study(changed)
    else:
        assert study(changed) != study(file)
