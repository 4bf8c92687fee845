"""The two methods and the references know nothing of each other."""

import subprocess
import sys
from dataclasses import fields
from inspect import signature
from pathlib import Path

import pytest

import fem_reference
import semianalytic
from verification.problem.coated_contact import CoatedContact
from verification.sources.references import integral_equation

ROOT = Path(__file__).resolve().parent.parent


@pytest.mark.parametrize("solve", [semianalytic.solve, fem_reference.solve, integral_equation.solve])
def test_every_solver_takes_the_same_problem(solve):
    names = [field.name for field in fields(CoatedContact) if field.name != "indenter"]  # of a sphere
    assert list(signature(solve).parameters)[: len(names)] == names


@pytest.mark.parametrize("solve", [semianalytic.solve, fem_reference.solve_shape])
def test_both_methods_take_the_shape_of_an_indenter(solve):
    names = [field.name for field in fields(CoatedContact)]
    taken = list(signature(solve).parameters)
    assert set(names) <= set(taken)
    assert not {"start", "pressure"} & set(taken), "a method that is given another one's answer"


def test_import_contracts_are_kept():
    done = subprocess.run(
        [str(Path(sys.executable).parent / "lint-imports")],
        cwd=ROOT,
        capture_output=True,
        text=True,
        timeout=120,
    )
    assert done.returncode == 0, done.stdout
