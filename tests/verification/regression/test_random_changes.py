"""A random change of one stored number, from 1.5 times its uncertainty upwards, is noticed.

Drawn from every case of the shipped baseline: a value, a point with all its components, a whole component, an
uncertainty grown or shrunk. Nothing is solved.
"""

from collections import Counter
from dataclasses import replace

import numpy as np
import pytest

from verification.cases.case_file import read_case, shipped_cases
from verification.commands.common.known_folders import BASELINE
from verification.judging.verdict import Outcome
from verification.regression.baseline_file import read_baseline
from verification.regression.number_drift import TOLERANCE, Numbers, State, drift
from verification.running.case_result import SourceResult
from verification.running.contact_run import decide

DRAWS = 2000
KINDS = ("value", "point", "component", "uncertainty")


@pytest.fixture(scope="module")
def cases():
    """Case with its numbers and its profiles, by name."""
    stored = read_baseline(BASELINE)
    assert stored is not None
    found = {}
    for name, path in shipped_cases().items():
        numbers = stored.cases[name].numbers
        found[name] = read_case(path), numbers, {(n.quantity, n.line, n.source): n for n in numbers}
    return found


def changed(numbers: Numbers, kind: str, at: int, size: float, sign: float) -> Numbers:
    """``numbers`` with a change of ``size`` uncertainties, at the point ``at`` or everywhere."""
    least = TOLERANCE * numbers.scale  # below it no change counts, on any machine
    U = np.maximum(numbers.uncertainty, least)
    here = np.arange(U.size) == at % U.size
    if kind != "uncertainty":
        return replace(numbers, value=numbers.value + sign * size * U * (here | (kind == "component")))
    grown = U * (1 + size) if sign > 0 or U[here] < 3 * least else U / (1 + size)
    return replace(numbers, uncertainty=np.where(here, grown, numbers.uncertainty))


def test_every_one_of_2000_random_changes_is_noticed(cases):
    random = np.random.default_rng(14)
    noticed, elsewhere = Counter(), Counter()
    for number in range(DRAWS):
        kind = KINDS[number % len(KINDS)]
        case, stored, profiles = cases[random.choice(sorted(cases))]
        first = stored[random.integers(len(stored))]
        at, size, sign = random.integers(10_000), 1.5 * 10 ** random.uniform(0, 6), random.choice([-1, 1])
        alike = [n for n in stored if (n.source, n.line) == (first.source, first.line)]
        rows = [(n, changed(n, kind, at, size, sign)) for n in (alike if kind == "point" else [first])]
        drifts = [drift(then, now) for then, now in rows]
        moved = dict(profiles)
        for _, now in rows:
            moved[now.quantity, now.line, now.source] = now
        outcomes = dict.fromkeys((n.source for n in stored), SourceResult("", 0.0))
        touched = {(now.quantity, now.line, now.source) for _, now in rows}
        verdicts = [
            decide(claim, moved, outcomes, case.problem).outcome
            for claim in case.claims
            if any((claim.quantity, claim.line, source) in touched for source in claim.between)
        ]
        failing = any(outcome is not Outcome.AGREES for outcome in verdicts)
        elsewhere[kind] += failing or any(d.beyond for d in drifts)
        noticed[kind] += failing or any(d.state is State.DRIFTED for d in drifts)
    assert noticed == dict.fromkeys(KINDS, DRAWS // len(KINDS))
    # Between a quarter and four times, uncertainties differ from machine to machine.
    assert all(elsewhere[kind] == noticed[kind] for kind in KINDS if kind != "uncertainty")
    assert elsewhere["uncertainty"] > 0.9 * noticed["uncertainty"]
