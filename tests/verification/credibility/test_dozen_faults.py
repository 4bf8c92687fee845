"""A dozen faults of the semi-analytical method at once never leave a run that passes."""

from contextlib import ExitStack
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from verification.cases.case_file import read_case, shipped_cases
from verification.credibility import accuracy_study
from verification.credibility.faults.fault_catalogue import FAULTS
from verification.credibility.faults.fault_planting import PlantError, planted
from verification.credibility.faults.first_notice import METHOD
from verification.judging.outcome import Outcome
from verification.regression.run_exit_codes import run_code
from verification.running.contact_run import judge_case, solve_case
from verification.sources.source_registry import solvers

CASES = ("01_uncoated_steel", "14_ratio_4_sliding")
LEFT_OUT = "fem_reference"  # for time: its comparisons could but disagree in addition
BESIDE = SimpleNamespace(less=(), unexplained=())  # a run that equals its baseline
NAMED = (
    "coefficients_one_percent",
    "remainder_doubled",
    "edge_not_corrected",
    "transform_normalised_by_patches",
    "distant_offsets_cut",
    "surface_shear_sign",
    "boussinesq_nu",
    "rings_one_percent",
    "harmonics_not_multiplied",
    "load_off",
    "gap_recomputed_too_steep",
    "half_space_twice",
)


def code():
    """The exit code of the judged studies and two cases, with whatever is planted.

    The studies come first: nothing outranks a disagreement, so that the cases need not be solved after one.
    """
    studies = [row.outcome for row in accuracy_study.quick()]
    results = [SimpleNamespace(outcome=Outcome.AGREES)]
    for name in CASES if Outcome.DISAGREES not in studies else ():
        case = read_case(shipped_cases()[name])
        kept = tuple(claim for claim in case.claims if LEFT_OUT not in claim.between)
        case = replace(case, claims=kept, resolve=False)
        available = {source: solve for source, solve in solvers(case.problem).items() if source != LEFT_OUT}
        results.append(judge_case(case, solve_case(case, available)))
    return run_code(results, BESIDE, passed=True, studies=studies)


def dozen(seed):
    """Twelve faults of the method that fit the code together, drawn at random."""
    names = [name for name, fault in FAULTS.items() if fault.group in METHOD]
    chosen = []
    for name in np.random.default_rng(seed).permutation(names):
        try:
            with ExitStack() as stack:
                for one in (*chosen, name):
                    stack.enter_context(planted(FAULTS[one].changes))
        except PlantError:
            continue
        chosen.append(str(name))
        if len(chosen) == 12:
            return chosen
    raise AssertionError("fewer than twelve faults fit together")


def exit_code_with(names):
    with ExitStack() as stack:
        for name in names:
            stack.enter_context(planted(FAULTS[name].changes))
        return code()


@pytest.mark.slow
def test_nothing_planted_exits_with_0():
    assert code() == 0


def test_a_dozen_plausible_slips_exit_with_1():
    assert exit_code_with(NAMED) == 1


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(8))
def test_any_dozen_exits_with_1(seed):
    names = dozen(seed)
    assert exit_code_with(names) == 1, names
