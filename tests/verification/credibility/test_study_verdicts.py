"""The parts of the method are judged: each meets its limit, and what spoils a part does not."""

from contextlib import ExitStack
from dataclasses import replace
from functools import partial
from types import SimpleNamespace

import pytest
from faults_planted import short_study
from faults_planted.fault_catalogue import FAULTS
from faults_planted.fault_planting import planted

from verification.credibility.exact_errors import FILMS, HERTZ, ExactError
from verification.credibility.refinement_studies import Refinement, RefinementLevel
from verification.credibility.study_verdicts import STAIRCASE, verdicts
from verification.judging.outcome import Outcome
from verification.regression.run_exit_codes import run_code

FINE = {"p0": 1e-6, "a": 1e-6, "approach": 1e-6, "pressure": 1e-4, "stress": 1e-6}

AGREEING = SimpleNamespace(outcome=Outcome.AGREES)
SAME = SimpleNamespace(less=(), unexplained=())  # a run that equals its baseline
SLIPS = (
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


def staircase(last=FINE):
    """A staircase study of second order, of first order in the pressure."""
    levels = [
        RefinementLevel(
            f"N = {n}",
            float(n),
            1.0,
            {q: e * (257 / n) ** (1 if q == "pressure" else 2) for q, e in FINE.items()},
        )
        for n in (33, 65, 129)
    ]
    return Refinement(
        "semianalytic", "coated", STAIRCASE, (*levels, RefinementLevel("N = 257", 257.0, 1.0, dict(last)))
    )


@pytest.fixture(scope="module")
def clean():
    return short_study.quick()


def test_every_part_meets_its_limit(clean):
    assert [row.name for row in clean if row.outcome is not Outcome.AGREES] == []
    assert {row.name.partition(":")[0] for row in clean} == {"coated", "uncoated", "compliant film", *FILMS}


@pytest.mark.parametrize(
    ("fault", "part"),
    [
        ("few_polynomials", "compliant film: split conversion, corrected edge: a, N = 129"),
        pytest.param("step_outside_contact", "coated: patches alone: iterations", marks=pytest.mark.slow),
        pytest.param("grid_too_small", "coated: patches alone: iterations", marks=pytest.mark.slow),
        pytest.param(
            "levels_alike", "coated: grids of the uncertainty: ratio of patches", marks=pytest.mark.slow
        ),
    ],
)
def test_the_edge_of_a_film_the_iterations_and_the_grids_are_judged(fault, part):
    with planted(FAULTS[fault].changes):
        assert part in [row.name for row in short_study.quick() if row.outcome is Outcome.DISAGREES]


def test_a_dozen_plausible_slips_at_once_exit_with_1():
    with ExitStack() as stack:
        for name in SLIPS:
            stack.enter_context(planted(FAULTS[name].changes))
        studies = [row.outcome for row in short_study.quick()]
    assert run_code([AGREEING], SAME, passed=True, studies=studies) == 1


def test_an_error_beyond_its_limit_and_an_order_below_disagree():
    assert {row.outcome for row in verdicts([staircase()])} == {Outcome.AGREES}
    rows = verdicts([staircase(FINE | {"p0": 1e-4, "pressure": 1e-3})])
    bad = {row.name.rpartition(": ")[2] for row in rows if row.outcome is Outcome.DISAGREES}
    assert bad == {"p0, N = 257", "order of p0", "order of pressure"}
    (disc,) = verdicts(errors=[ExactError(HERTZ, "coated", "stress, inside", 2e-8)])
    assert disc.outcome is Outcome.DISAGREES


def test_a_study_that_fails_is_no_result():
    failed = replace(staircase(), failure="N = 257: not settled")
    outcomes = [row.outcome for row in verdicts([failed], failures=["discs: no grid fits"])]
    assert outcomes == [Outcome.NO_RESULT, Outcome.NO_RESULT]


def test_the_exit_code_of_a_run_counts_the_studies():
    code = partial(run_code, [AGREEING], SAME, passed=True)
    assert code(studies=[Outcome.AGREES]) == 0
    assert code(studies=[Outcome.AGREES, Outcome.DISAGREES]) == 1
    assert code(studies=[Outcome.NO_RESULT]) == 3
