"""Both methods against published tables: the right numbers agree, wrong ones do not."""

import time
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from verification.cases.published_file import published_cases, read_published
from verification.cases.published_table import FOLDER
from verification.judging.verdict import Outcome
from verification.problem.coated_contact import PrescribedLoad
from verification.problem.evaluation_points import TablePoints
from verification.problem.point_answers import Points
from verification.running.published_run import failed, run
from verification.sampling.point_values import values
from verification.sources.limit_extrapolation import extrapolated
from verification.sources.source_registry import solvers

SHIPPED = published_cases()
DISC = PrescribedLoad(1e6, 0.1, (), (1e9, 0.3))


@pytest.fixture(scope="module")
def disc():
    """The homogeneous half-space under a uniform disc by the quick method."""
    return semianalytic(DISC)


@cache
def semianalytic(problem):
    """The quick method, which solves each problem once for all tests."""
    return solvers()["semianalytic"](problem)


def on_axis(z):
    return TablePoints.of(np.zeros_like(z), np.zeros_like(z), z, (), None, "m", 1.0)


@pytest.mark.parametrize(
    ("name", "method"),
    [
        ("ellea1_halfspace_off_axis", "fem_reference"),
        ("ellea1_halfspace_off_axis", "semianalytic"),
        ("amadeus_three_layer_single_wheel", "semianalytic"),
    ],
)
def test_published_tables_are_met(name, method):
    case = read_published(SHIPPED[name])
    claims = tuple(claim for claim in case.claims if method in claim.between)
    result = run(
        replace(case, claims=claims),
        {method: semianalytic if method == "semianalytic" else solvers()[method]},
    )
    assert [v.reason for _, v in result.verdicts if v.outcome is not Outcome.AGREES] == []
    assert len(result.verdicts) == len(case.columns)


@pytest.mark.cases
@pytest.mark.parametrize("name", SHIPPED)
def test_every_published_table_is_met_by_both_methods(name):
    result = run(read_published(SHIPPED[name]))
    assert [v.reason for _, v in result.verdicts if v.outcome is not Outcome.AGREES] == []


def test_strains_follow_from_hookes_law_of_the_layer(disc):
    # Ahlvin and Ulery: eps_z = q (1 + nu)/E [(1 - 2 nu) A + B] at z/R = 1, compression positive.
    A, B, nu, E = 0.292893, 0.353553, 0.3, 1e9
    found, spread = values(disc, "eps_zz", on_axis(np.array([0.1])), DISC)
    assert found == pytest.approx([-1e6 * (1 + nu) / E * ((1 - 2 * nu) * A + B)], rel=1e-4)
    assert 0 < spread[0] < 1e-3 * abs(found[0])


@pytest.mark.parametrize(
    ("name", "file", "old", "new", "column"),
    [
        # The disagreement of several programs must not excuse one of them.
        ("amadeus_three_layer_single_wheel", "amadeus_three_layer_single_wheel.csv", "251.7", "201.7", "R3"),
        ("amadeus_three_layer_single_wheel", "amadeus_three_layer_single_wheel.csv", "185.3", "185.8", "R4"),
        # Five in the last digit, of a value that counts and of one that departs.
        ("jones_1962", "jones_1962_three_layer.csv", "0.12173,", "0.12178,", "table_memory"),
        ("jones_1962", "jones_1962_three_layer.csv", "1.97428,", "1.97423,", "table_memory"),
        # A departure that is not that of the source.
        ("jones_1962", "jones_1962_three_layer.csv", "2.82e-05", "5.64e-05", "table_memory"),
    ],
)
def test_a_changed_cell_of_a_shipped_file_disagrees(tmp_path, name, file, old, new, column):
    text = (FOLDER / file).read_text()
    assert text.count(old) == 1
    (tmp_path / file).write_text(text.replace(old, new))
    (tmp_path / f"{name}.toml").write_text(SHIPPED[name].read_text())
    result = run(read_published(tmp_path / f"{name}.toml"), {"semianalytic": semianalytic})
    bad = [c.line for c, v in result.verdicts if v.outcome is Outcome.DISAGREES]
    assert len(bad) == 1
    assert bad[0].endswith(f"column {column}")


def test_a_method_that_fails_leaves_its_sentence():
    def refuses(problem):
        raise ValueError("pressure = 1; not today")

    case = read_published(SHIPPED["ellea1_halfspace_axis"])
    begin = time.perf_counter()
    result = run(case, {"semianalytic": refuses})
    assert all(0 <= source.seconds <= time.perf_counter() - begin for source in result.sources)
    assert {v.outcome for _, v in result.verdicts} == {Outcome.NO_RESULT}
    assert all("today" in v.reason for c, v in result.verdicts if "semianalytic" in c.between)
    assert failed(case, "was killed", 1.0).outcome is Outcome.NO_RESULT


def test_incompressible_solid_is_reached_by_extrapolation():
    soft = replace(DISC, substrate=(1e9, 0.5))
    carried, direct = extrapolated(soft, semianalytic), semianalytic(soft)
    z = np.array([0.03, 0.1, 0.3])
    gap = np.abs(carried.stress(0.0, 0.0, z) - direct.stress(0.0, 0.0, z))
    assert (gap <= carried.sample(Points(0.0, 0.0, z), "stress").uncertainty).all()
    # The formula is linear in nu on a homogeneous solid, so nothing but rounding is left.
    assert gap.max() <= 1e-6 * DISC.pressure
    assert carried.approach == pytest.approx(direct.approach, rel=1e-5)
    assert carried.uncertainty.approach >= abs(carried.approach - direct.approach)
    assert extrapolated(DISC, lambda problem: problem) is DISC
