"""Yielding of each layer and its strain: closed forms, another source, the residual stress, the words."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from case_texts import case_text
from quick_case import coatcheck
from scipy.optimize import minimize_scalar

from verification.cases.case_file import parse_case
from verification.desk.contact_answer import answer
from verification.desk.layer_limits import layer_modes, strain_warnings, strengths_of, verdict
from verification.problem.coated_contact import CoatedContact
from verification.problem.quantity import largest_strain

BARE = CoatedContact(10e-3, 20.0, (), (210e9, 0.3))
SLIDING = CoatedContact(10e-3, 20.0, ((210e9, 0.3, 10e-6),), (210e9, 0.3), 0.25)
FAST = {"estimate_uncertainty": False}


def on_axis(zeta, nu):
    """sigma_rr and sigma_zz over p0 on the axis of a Hertz contact. Johnson (3.45)."""
    rr = -(1 + nu) * (1 - zeta * np.arctan(1 / zeta)) + 0.5 / (1 + zeta**2)
    return rr, -1 / (1 + zeta**2)


@pytest.mark.parametrize("strength", [0.3e9, 0.789e9, 3e9])
def test_load_at_which_a_bare_body_yields_is_johnsons(strength):
    """W = pi^3 R^2 / (6 E*^2) p0^3 with p0 = Y / max|sigma_rr - sigma_zz|, which is 1.6 Y. Johnson (6.10)."""
    share = -minimize_scalar(
        lambda zeta: -abs(np.subtract(*on_axis(zeta, 0.3))), bounds=(0.1, 1.0), options={"xatol": 1e-10}
    ).fun
    exact = np.pi**3 * BARE.radius**2 / (6 * BARE.E_star**2) * (strength / share) ** 3
    strengths = strengths_of({"substrate.yield_strength": strength, "substrate.hardness": 1.0})
    (found,) = layer_modes(BARE, answer(BARE, "semianalytic", FAST), strengths)
    assert found.load == pytest.approx(exact, rel=3e-3)
    assert found.utilisation == pytest.approx(share * BARE.p_h / strength, rel=1e-3)
    assert bool(found.warnings("steel")) == (found.utilisation > 1)


@pytest.mark.slow
@pytest.mark.parametrize("residual", [0.5e9, -0.5e9])
def test_at_the_load_found_another_source_has_the_strength(residual):
    """Of every mode; modes without a strength are none."""
    stress = {"flat": (residual,)}
    limits = {"yield_strength": 0.8e9, "strength": 0.9e9, "adhesion": 0.2e9}
    strengths = strengths_of({f"coatings.0.{name}": value for name, value in limits.items()})
    first = answer(SLIDING, "semianalytic", FAST, stress)
    modes = layer_modes(SLIDING, first, strengths, FAST, stress)
    assert {one.quantity for one in modes} == {"von_mises", "sigma_1", "|sigma_xz|", "sigma_zz"}
    for one in modes:
        if one.quantity == "sigma_zz":  # hardly any tension pulls at a coating of the substrate's material
            continue
        there = answer(replace(SLIDING, load=one.load), "hamilton", residual=stress)
        (found,) = [e for e in there.extremes if (e.quantity, e.where) == (one.quantity, one.where)]
        assert found.value == pytest.approx(one.strength, rel=3e-3)
        assert one.safety * one.utilisation == pytest.approx(1)


def test_residual_stress_beyond_the_strength_needs_no_load():
    """An equibiaxial stress is its own von Mises stress; of three sub-layers the most stressed one counts."""
    stress = {"flat": (-1.0e9, -1.5e9, -0.5e9)}
    problem = replace(SLIDING, coatings=((210e9, 0.3, 3e-6),) * 3)
    first, layers = answer(problem, "hamilton", residual=stress, layers={"flat": (3,)}), {"flat": (3,)}
    strengths = strengths_of({"coatings.0.yield_strength": 1.4e9})
    (coating,) = layer_modes(problem, first, strengths, {}, stress, layers)
    assert coating.load == 0
    assert "residual stress alone" in coating.warnings("film")[0]


@pytest.mark.slow
def test_the_verdict_names_what_fails_first_with_its_margin():
    """The first failure is the mode of the lowest load; the highest utilisation is nearest to its limit."""
    film = 'name = "TiN"; E = "450 GPa"; nu = 0.25; thickness = "3 um"; yield_strength = "9 GPa"'
    film += '; adhesion = "{} MPa"'
    for adhesion, said in ((300, "Verdict: holds."), (50, "Verdict: interface 1 shears off.")):
        case = parse_case(case_text(film.format(adhesion), more="friction = 0.2").encode(), Path("mine.toml"))
        first = answer(case.problem, "semianalytic", FAST)
        modes = layer_modes(case.problem, first, strengths_of(case.limits), FAST)
        text = verdict(case, modes)
        assert text.startswith(said)
        lowest = min((one for one in modes if one.load), key=lambda one: one.load)
        assert lowest.quantity == "|sigma_xz|"
        assert f"First failure at {lowest.load:.3g} N: interface 1 shears off" in text
        assert f"safety factor {lowest.safety:.3g}" in text
        assert "First yield at" in text
    assert verdict(case, ()) == ""


def test_largest_strain_is_an_eigenvalue_of_hookes_law():
    E, nu = 3e9, 0.41
    xx, yy, zz, xz = s = np.random.default_rng(4).normal(size=(4, 300))
    zero = np.zeros(300)
    sigma = np.moveaxis(np.array([[xx, zero, xz], [zero, yy, zero], [xz, zero, zz]]), -1, 0)
    strain = ((1 + nu) * sigma - nu * np.trace(sigma, axis1=1, axis2=2)[:, None, None] * np.eye(3)) / E
    exact = np.abs(np.linalg.eigvalsh(strain)).max(axis=1)
    np.testing.assert_allclose(largest_strain(s, E, nu), exact, rtol=1e-12)


def test_a_soft_film_is_strained_though_its_substrate_is_not():
    """A film far thinner than its contact is wide is compressed between two stiff bodies without widening:

    e_zz = -p0 (1 + nu)(1 - 2 nu) / (E (1 - nu))
    """
    E, nu = 0.5e9, 0.3
    problem = CoatedContact(50e-3, 200.0, ((E, nu, 5e-6),), (70e9, 0.33))
    found = answer(problem, "semianalytic", FAST)
    film, _ = found.strains
    p0 = found.numbers["peak_pressure"][0]
    assert film.value == pytest.approx(p0 * (1 + nu) * (1 - 2 * nu) / (E * (1 - nu)), rel=0.01)
    assert problem.p_h / problem.E_star < 0.02
    assert film.value > 0.1
    case = replace(parse_case(case_text(title="mine").encode(), Path("mine.toml")), problem=problem)
    (line,) = strain_warnings(case, found)
    assert line.startswith("coating 1 is strained by")


@pytest.mark.slow
def test_solve_judges_each_layer_by_its_own_stress(tmp_path):
    """A film under 1.6 times its yield strength may be elastic; --strict refuses one that is not."""
    coating = 'name = "Ag"; E = "83 GPa"; nu = 0.37; thickness = "10 um"; yield_strength = "{} MPa"'
    for strength, code in ((250, 0), (200, 2)):
        path = tmp_path / "film.toml"
        path.write_text(case_text(coating.format(strength), load="1.9", more="friction = 0.05"))
        done = coatcheck("solve", str(path), "--strict", cwd=tmp_path)
        assert done.returncode == code, done.stderr
        assert ("coating 1 (Ag) yields" in done.stderr) == bool(code)
        if not code:
            lines = [line.split() for line in done.stdout.splitlines()]
            (row,) = [line for line in lines if line[:4] == ["coating", "1", "(Ag)", "yields"]]
            used, begins = float(row[-3].rstrip("%")), float(row[-1])
            assert used < 100
            assert begins > 1.9
