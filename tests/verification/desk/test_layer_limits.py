"""Yielding of each layer and its strain: closed forms, another source, the residual stress, the words."""

from dataclasses import replace

import numpy as np
import pytest
from case_texts import case_text
from quick_case import coatcheck
from scipy.optimize import minimize_scalar

from verification.desk.contact_answer import answer
from verification.desk.layer_limits import layer_limits, yield_strengths
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
    strengths = yield_strengths({"substrate.yield_strength": strength, "substrate.hardness": 1.0})
    (found,) = layer_limits(BARE, answer(BARE, "semianalytic", FAST), strengths)
    assert found.yields_from == pytest.approx(exact, rel=3e-3)
    assert found.utilisation == pytest.approx(share * BARE.p_h / strength, rel=1e-3)
    assert bool(found.warnings("steel")) == (found.utilisation > 1)


@pytest.mark.parametrize("residual", [0.5e9, -0.5e9])
def test_at_the_load_found_another_source_has_the_yield_strength(residual):
    stress, strength = {"flat": (residual,)}, 0.8e9
    strengths = {("flat", "coating 1"): strength}
    first = answer(SLIDING, "semianalytic", FAST, stress)
    coating, substrate = layer_limits(SLIDING, first, strengths, FAST, stress)
    assert (coating.where, substrate.yield_strength) == ("coating 1", None)
    there = answer(replace(SLIDING, load=coating.yields_from), "hamilton", residual=stress)
    (found,) = [e for e in there.extremes if (e.quantity, e.where) == ("von_mises", "coating 1")]
    assert found.value == pytest.approx(strength, rel=3e-3)


def test_residual_stress_beyond_the_strength_needs_no_load():
    """An equibiaxial stress is its own von Mises stress; of three sub-layers the most stressed one counts."""
    stress = {"flat": (-1.0e9, -1.5e9, -0.5e9)}
    problem = replace(SLIDING, coatings=((210e9, 0.3, 3e-6),) * 3)
    first, layers = answer(problem, "hamilton", residual=stress, layers={"flat": (3,)}), {"flat": (3,)}
    coating, _ = layer_limits(problem, first, {("flat", "coating 1"): 1.4e9}, {}, stress, layers)
    assert coating.yields_from == 0
    assert "residual stress alone" in coating.warnings("film")[0]


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
    film, substrate = layer_limits(problem, found, {})
    p0 = found.numbers["peak_pressure"][0]
    assert film.strain == pytest.approx(p0 * (1 + nu) * (1 - 2 * nu) / (E * (1 - nu)), rel=0.01)
    assert problem.p_h / problem.E_star < 0.02
    assert film.strain > 0.1
    assert "strained by" in film.warnings("film")[0]
    assert substrate.warnings("steel") == ()


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
            (row,) = [line.split() for line in done.stdout.splitlines() if "%" in line and "(Ag)" in line]
            used, begins = float(row[-2].rstrip("%")), float(row[-1])
            assert used < 100
            assert begins > 1.9
