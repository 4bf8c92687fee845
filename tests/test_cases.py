"""The shipped cases as tests, one item per comparison: pytest -m cases."""

import functools

import pytest

from verification.cases.case_file import read_case, shipped_cases
from verification.judging.verdict import Outcome
from verification.running.case_result import CaseResult
from verification.running.contact_run import run

CASES = {name: read_case(path) for name, path in shipped_cases().items()}


@functools.cache
def solved(name: str) -> CaseResult:
    return run(CASES[name])


@pytest.mark.cases
@pytest.mark.parametrize(
    ("name", "index"),
    [
        pytest.param(
            name,
            i,
            id=f"{name}-{c.quantity}-{c.line}-{'-'.join(c.between)}",
            marks=pytest.mark.xdist_group(name),
        )
        for name, case in CASES.items()
        for i, c in enumerate(case.claims)
    ],
)
def test_case_agrees(name, index):
    _, verdict = solved(name).verdicts[index]
    assert verdict.outcome is Outcome.AGREES, verdict.reason


@pytest.mark.cases
@pytest.mark.parametrize("name", [pytest.param(name, marks=pytest.mark.xdist_group(name)) for name in CASES])
def test_invariants_of_every_solution_hold(name):
    found = solved(name).invariants
    assert len(found) >= 30
    assert [row.message for row in found if row.outcome is not Outcome.AGREES] == []
