"""Residual stress of coatings: closed forms of mismatch, of the sum; what a file may say of it."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from case_texts import case_text

from verification.cases.case_file import parse_case
from verification.cases.toml_file import CaseError
from verification.desk.contact_answer import answer
from verification.problem.coated_contact import CoatedContact
from verification.problem.quantity import first_principal, von_mises
from verification.sources.source_registry import SOURCES
from verification.study.friction_planes import in_plane

STRESS = -2e9
SLIDING = CoatedContact(10e-3, 20.0, ((210e9, 0.3, 10e-6),), (210e9, 0.3), 0.25)
FILE = case_text(
    'E = "180 GPa"; nu = 0.2; thickness = "2 um"; expansion = 2e-6',
    'E = "280 GPa"; nu = 0.21; thickness = "1 um"; residual_stress = "150 MPa"',
    more="temperature_change = -300; "
    'ball = { E = "210 GPa", nu = 0.3, coatings = [{ E = "180 GPa", nu = 0.2, thickness = "1 um" }] }',
).replace("nu = 0.3 }", "nu = 0.3, expansion = 12e-6 }", 1)


def parse(text):
    return parse_case(text.encode(), Path("dlc.toml"))


@pytest.fixture(scope="module")
def both():
    """The same contact without and with a residual stress in its coating."""
    return answer(SLIDING, "hamilton"), answer(SLIDING, "hamilton", residual={"flat": (STRESS,)})


def at(found, quantity, where):
    (one,) = [e for e in found.extremes if (e.quantity, e.where) == (quantity, where)]
    return one


def test_mismatch_of_expansion_is_that_of_a_thin_film():
    """A film that would shrink less than its substrate is compressed: E/(1 - nu) (alpha_s - alpha) dT."""
    residual = parse(FILE).residual
    assert residual["flat"] == pytest.approx((180e9 / 0.8 * 10e-6 * -300, 150e6), rel=1e-14)
    assert residual["ball"] == (0.0,)
    # of growth and of mismatch together
    both = parse(FILE.replace("expansion = 2e-6", 'expansion = 2e-6\nresidual_stress = "-1 GPa"')).residual
    assert both["flat"] == pytest.approx((residual["flat"][0] - 1e9, 150e6), rel=1e-14)
    # Hooke: biaxial stress with the strain of the substrate, free in z.
    E, nu, sigma = 180e9, 0.2, residual["flat"][0]
    assert (sigma - nu * sigma) / E + 2e-6 * -300 == pytest.approx(12e-6 * -300, rel=1e-12, abs=0)


def test_tension_at_the_trailing_edge_is_the_sum(both):
    """p0 ((1 - 2 nu)/3 + f pi (4 + nu)/8) of Hamilton and Goodman plus the residual stress."""
    found = at(both[1], "sigma_xx", "surface")
    exact = SLIDING.p_h * ((1 - 0.6) / 3 + 0.25 * np.pi * 4.3 / 8) + STRESS
    assert found.value == pytest.approx(exact, rel=1e-6)
    assert found.value < 0  # shown as it is, not as 0
    assert found.x == pytest.approx(-SLIDING.a_h, rel=1e-6)


def test_it_adds_within_its_coating_alone(both):
    plain, total = both
    base = "base of coating 1"
    assert at(total, "sigma_xx", base).value == pytest.approx(
        at(plain, "sigma_xx", base).value + STRESS, rel=1e-6
    )
    for where in ("interface 1", "substrate", "top of substrate"):
        pairs = [(a, b) for a, b in zip(plain.extremes, total.extremes, strict=True) if a.where == where]
        assert pairs
        assert all(a == b or (np.isnan(a.x) and np.isnan(b.x)) for a, b in pairs)
    surface, base, below = (b.stress - a.stress for a, b in zip(plain.courses, total.courses, strict=True))
    for change in (surface, base):
        np.testing.assert_allclose(change[:2], STRESS, rtol=1e-9)
        np.testing.assert_array_equal(change[2:], 0.0)
    np.testing.assert_array_equal(below, 0.0)


@pytest.mark.parametrize("stress", [-2e9, 1.5e9])
def test_principal_and_von_mises_stress_are_those_of_the_summed_tensor(stress):
    found = answer(SLIDING, "hamilton", residual={"flat": (stress,)})
    solution, a = SOURCES["hamilton"].solve(SLIDING, {}), SLIDING.a_h
    x, z = np.meshgrid(np.linspace(-2, 2, 401) * a, np.linspace(0, 10e-6, 41), indexing="ij")
    sigma = in_plane(solution.stress(x.ravel(), 0.0, z.ravel(), layer=0))
    sigma[:2] += stress
    for quantity, measure in (("sigma_1", first_principal), ("von_mises", von_mises)):
        largest = at(found, quantity, "coating 1")
        excess = largest.value - measure(sigma).max()
        assert -largest.uncertainty <= excess <= 5e-3 * (abs(stress) + SLIDING.p_h)


@pytest.mark.slow
def test_of_a_coated_ball_it_belongs_to_the_ball():
    problem = replace(SLIDING, coatings=(), ball=(210e9, 0.3, ((180e9, 0.2, 10e-6),)))
    plain = answer(problem, "semianalytic")
    total = answer(problem, "semianalytic", residual={"flat": (), "ball": (STRESS,)})
    for a, b in zip(plain.extremes, total.extremes, strict=True):
        if (a.body, a.where, a.quantity) == ("ball", "surface", "sigma_xx"):
            assert b.value == pytest.approx(a.value + STRESS, rel=1e-12)
        if a.body == "flat":
            assert a == b


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (", expansion = 12e-6", "", "coating 1"),
        ("temperature_change = -300\n", "", "coating 1"),
        ('"150 MPa"', '"150 um"', "coating 2, residual_stress"),
        ("-300", '"-300 K"', "temperature_change"),
        ("expansion = 2e-6", "expansion = 2.0", "coating 1, expansion"),
    ],
)
def test_bad_files_end_in_one_message(old, new, message):
    assert old in FILE
    with pytest.raises(CaseError) as error:
        parse(FILE.replace(old, new, 1))
    assert message in str(error.value)
