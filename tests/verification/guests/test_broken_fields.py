"""A guest with one broken field of each kind: it costs that quantity, and every other one is judged."""

import runpy
from functools import partial

import numpy as np
import pytest
from guest_exams import prepared, question, verdicts_on

from verification.guests.doors import own_python
from verification.guests.doors.serve_function import values_of
from verification.guests.guest_protocol import VERSION, GuestAnswer
from verification.judging.verdict import Outcome
from verification.problem.quantity import DISPLACEMENTS, PEAKS, STRESSES
from verification.running.json_records import plain
from verification.sources.exact_sources import solve_exactly

NO, NONE, OFF = Outcome.NO_RESULT, Outcome.UNSUPPORTED, Outcome.DISAGREES


def raising(error):
    def function(*points, **of):
        raise error

    return function


def beyond(exact, x, *points, **of):
    """A field of a mesh that ends at 80 um."""
    if np.max(np.abs(x)) > 8e-5:
        raise IndexError("outside the mesh")
    return exact(x, *points, **of)


def without(exact, component, *points, **of):
    sigma = exact(*points, **of)
    sigma[component] = np.nan
    return sigma


# Field, what it becomes, quantities that it costs, their outcome, words of the reason.
BROKEN = {
    "displacement raises": (
        "displacement",
        lambda u: raising(RuntimeError("no mesh")),
        DISPLACEMENTS,
        NO,
        "no mesh",
    ),
    "displacement is not there yet": (
        "displacement",
        lambda u: raising(NotImplementedError()),
        DISPLACEMENTS,
        NONE,
        "",
    ),
    "displacement is None": ("displacement", lambda u: lambda *p: None, DISPLACEMENTS, NONE, "not answered"),
    "pressure of another shape": ("pressure", lambda p: lambda x, y: [1.0], ("pressure",), NO, "shape (1,)"),
    "pressure of text": ("pressure", lambda p: lambda x, y: "none", ("pressure",), NO, "could not convert"),
    "stress raises somewhere": (
        "stress",
        lambda s: partial(beyond, s),
        (*STRESSES, *PEAKS),
        NO,
        "x, y, z = ",
    ),
    "stress lacks a component": (
        "stress",
        lambda s: partial(without, s, (0, 1)),
        ("sigma_xy",),
        NO,
        "no finite",
    ),
    "approach is None": ("approach", lambda v: None, ("approach",), NONE, "not answered"),
    "approach is NaN": ("approach", lambda v: np.nan, ("approach",), NO, "no finite"),
    "peak pressure is text": ("peak_pressure", lambda v: "high", ("peak_pressure",), NO, "high"),
    "radius is zero": ("contact_radius", lambda v: 0.0, ("contact_radius",), OFF, "exceeds"),
    "approach is infinite": ("approach", lambda v: np.inf, ("approach",), NO, "no finite"),
    "displacement is no function": ("displacement", lambda u: 7, DISPLACEMENTS, NO, "callable"),
    "radius in mm": ("contact_radius", lambda v: 1e3 * v, ("contact_radius",), OFF, "exceeds"),
}


@pytest.fixture(scope="module")
def exact(tmp_path_factory):
    case, exam = prepared("01_uncoated_steel", tmp_path_factory.mktemp("exam"))
    solution = solve_exactly(case.problem)
    names = ("contact_radius", "approach", "peak_pressure", "pressure", "stress", "displacement")
    return case, exam, {name: getattr(solution, name) for name in names}


def own_environment(result, problem, asked):
    """The answer of a function in an environment of its own."""
    return own_python.values_of(result, asked.model_dump())


def same_environment(result, problem, asked):
    return plain(values_of(result, problem, asked))


def verdicts(case, exam, result, door):
    asked = question(case, exam)
    answer = GuestAnswer(protocol=VERSION, id=asked.id, **door(result, case.problem, asked))
    return verdicts_on(case, exam, answer)


@pytest.mark.parametrize("door", [same_environment, own_environment])
@pytest.mark.parametrize("name", BROKEN)
def test_a_broken_field_costs_its_own_quantities_alone(exact, name, door):
    case, exam, right = exact
    field, change, quantities, outcome, words = BROKEN[name]
    whole = verdicts(case, exam, right, door)
    found = verdicts(case, exam, right | {field: change(right[field])}, door)
    broken = {key for key in found if found[key].outcome is not whole[key].outcome}
    assert broken
    assert {q for q, _ in broken} <= set(quantities)
    assert {found[key].outcome for key in broken} == {outcome}
    assert all(words in found[key].reason for key in broken)
    agreeing = {q for (q, _), verdict in whole.items() if verdict.outcome is Outcome.AGREES}
    assert {q for q, _ in broken} == agreeing & set(quantities)


@pytest.mark.parametrize("door", [same_environment, own_environment])
def test_keys_that_are_not_there_or_not_known_cost_no_other(exact, door):
    case, exam, right = exact
    whole = verdicts(case, exam, right, door)
    assert verdicts(case, exam, right | {"temperature": 300.0, "mesh": object()}, door) == whole
    found = verdicts(case, exam, {k: v for k, v in right.items() if k != "approach"}, door)
    assert [q for q, line in found if found[q, line] != whole[q, line]] == ["approach"]
    assert found["approach", "contact"].outcome is NONE


@pytest.mark.parametrize("door", [same_environment, own_environment])
def test_uncertainties_that_are_stated_are_those_of_the_answer(exact, door):
    case, exam, right = exact
    stated = {"uncertainty": {"approach": 1e-9}}
    stated["displacement_uncertainty"] = lambda x, y, z: np.full((3, x.size), 1e-12)
    found = door(right | stated, case.problem, question(case, exam))["uncertainty"]
    assert found.pop("contact") == {"approach": 1e-9}
    assert {q for by in found.values() for q in by} == set(DISPLACEMENTS)


def test_a_failure_inside_a_package_names_the_line_of_the_adapter(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine.py").write_text("import numpy as np\n\ndef solve():\n    np.linalg.inv(np.eye(2, 3))\n")
    with pytest.raises(np.linalg.LinAlgError) as error:
        runpy.run_path(str(tmp_path / "mine.py"))["solve"]()
    assert own_python.message(error.value).endswith("(mine.py, line 4)")
