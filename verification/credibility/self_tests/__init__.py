"""Known answers put to the harness itself before its verdicts are believed.

Methods and references watch each other; nothing but this watches what reads the cases, samples the solutions,
judges and stores. Each self-test knows by hand what has to come out, that of the exact reference by proven
enclosures. All together take a second, so that every run makes them.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from verification.credibility.self_tests.known_files import of_case_file, of_published_table, of_store
from verification.credibility.self_tests.known_outputs import of_codes, of_junit, of_regression
from verification.credibility.self_tests.known_runs import of_coverage, of_invariants, of_runs
from verification.credibility.self_tests.known_samples import of_points_of_tables, of_sampling
from verification.credibility.self_tests.known_verdicts import TEST, of_enclosures, of_judging, of_points
from verification.credibility.self_tests.stand_ins import Answers


@dataclass(frozen=True)
class SelfTest:
    """``name`` of a part of the harness, the ``statement`` that must hold, what was ``found``.

    answers : number of known answers that it gave.
    """

    name: str
    statement: str
    passed: bool
    found: str
    answers: int = 0


def self_tests() -> tuple[SelfTest, ...]:
    """All of them, in the order in which a case runs through the harness."""
    return tuple(_tried(name, statement, ask) for name, statement, ask in _TESTS)


def _tried(name: str, statement: str, ask: Callable[[], Answers]) -> SelfTest:
    asked = 0
    try:
        for what, found, wanted in ask():
            asked += 1
            close = isinstance(wanted, float) and np.isclose(found, wanted, rtol=1e-9, atol=0)
            if not close and found != wanted:
                found = f"{what}: {found}, where it has to be {wanted}"
                return SelfTest(name, statement, False, found, asked)
    except Exception as error:  # whatever a part of the harness fails with is the answer
        message = f"{type(error).__name__}: {' '.join(str(error).split())[:300]}"
        return SelfTest(name, statement, False, message, asked)
    return SelfTest(name, statement, True, f"{asked} known answers", asked)


_TESTS: tuple[tuple[str, str, Callable[[], Answers]], ...] = (
    ("case file", "a case file means the lengths, moduli, scales worked out by hand", of_case_file),
    ("printed table", "a printed table means the SI values, signs worked out by hand", of_published_table),
    ("sampling", "every profile holds its own component, side, place, uncertainty", of_sampling),
    ("sampling of tables", "every column holds its own quantity at its own place", of_points_of_tables),
    ("judging", "differences, uncertainties, caps of every kind get the verdict they must", of_judging),
    ("judged points", "one bad point decides, and only points that count", of_points),
    ("whole runs", "runs with a method known to be right, off, vague, dead come out so", of_runs),
    ("coverage", "every line is judged over its length, in its scale, under its cap", of_coverage),
    ("invariants", "what all sources share is found by the invariants of each", of_invariants),
    ("storing", "what is stored comes back to the last digit or not at all", of_store),
    ("regression", "a number that moved, a U that grew, a check that is gone are noticed", of_regression),
    (TEST, "its values lie in proven enclosures, widened to 1e-10", of_enclosures),
    ("exit codes", "every outcome of a run ends with its code", of_codes),
    ("JUnit", "every check is a test, and what does not agree is a failure there", of_junit),
)
