"""Ball of finite radius on a disc: patch test, closed forms, rates, limits, finite elements."""

from dataclasses import astuple, replace

import numpy as np
import pytest

import semianalytic
from semianalytic.numbers import STILL
from verification.problem.coated_contact import CoatedContact, keywords
from verification.sources.assumptions.contact_change import FLOOR
from verification.sources.assumptions.finite_bodies import (
    RESOLUTIONS,
    FiniteBall,
    change_at,
    of_half_spaces,
    on_disc,
)

E, NU, R = 210e9, 0.3, 10e-3
RIGID = (1e9 * E, 0.3)
FINE = ({"nodes": 80}, {"nodes": 60})


def contact(width, ball=None, substrate=(E, NU), coating=None):
    """a_h/R = ``width``; ``coating`` : E1/E2, h/a_h."""
    one = CoatedContact(R, 1.0, (), substrate, 0.0, ball)
    one = replace(one, load=4 / 3 * one.E_star * width**3 * R**2)
    if coating is None:
        return one
    return replace(one, coatings=((coating[0] * substrate[0], NU, coating[1] * one.a_h),))


def ball_on_rigid(width, nu):
    return contact(width, (E, nu, ()), RIGID)


def scalars(problem, thickness=1.0):
    return np.array(astuple(change_at(problem, thickness, {"nodes": 32}))[:3])


@pytest.mark.parametrize("coatings", [(), ((E, NU, 0.1 * R), (E, NU, 0.01 * R))])
def test_uniform_tension_is_exact(coatings):
    ball = FiniteBall(R, (coatings, (E, NU)))
    C11, C12, C22 = ball.modes(np.array([0.0, 2.0]))
    # sigma_zz = 1: S = cos^2 = 1/3 P0 + 2/3 P2, T = -sin cos = 1/3 dP2/dtheta
    assert C11[0] / 3 == pytest.approx((1 - 2 * NU) * R / (3 * E), rel=1e-13)
    assert C11[1] * 2 / 3 + 6 * C12[1] / 3 == pytest.approx((1 + NU) * R * 2 / (3 * E), rel=1e-13)
    assert C12[1] * 2 / 3 + 6 * C22[1] / 3 == pytest.approx((1 + NU) * R / (3 * E), rel=1e-13)


def test_coated_ball_under_uniform_pressure_is_lames():
    # shell 1 around core 2 under p = 1: the interface pressure makes u equal on both sides
    E1, nu1, E2, nu2, c = 2 * E, 0.2, E, 0.35, 0.8
    core = (1 - 2 * nu2) / E2
    inner, outer = (1 - 2 * nu1) / E1, (1 + nu1) / (2 * E1)
    # u/r of the shell at c under (interface p, outer 1): Timoshenko and Goodier (1970), art. 136
    hollow = 1 - c**3
    interface = (inner + outer) / hollow / (core + (inner * c**3 + outer) / hollow)
    surface = (inner + outer * c**3 - interface * c**3 * (inner + outer)) / hollow
    found = FiniteBall(1.0, (((E1, nu1, 1 - c),), (E2, nu2))).modes(np.array([0.0]))[0]
    assert found == pytest.approx(surface, rel=1e-13)


def test_ball_changes_radius_and_peak_in_proportion_to_its_closed_form():
    small, large = (scalars(ball_on_rigid(width, NU)) for width in (1e-3, 1e-2))
    curvature = (1 - 2 * NU) ** 2 / (1 - NU)
    assert small[0] / 1e-3 == pytest.approx(curvature / (4 * np.pi), rel=5e-3)
    assert small[2] / 1e-3 == pytest.approx(-np.pi / 16 * curvature, rel=5e-3)
    assert np.log10(large / small)[[0, 2]] == pytest.approx(1.0, rel=0.05)
    # of the approach there is a logarithm: 2/(3 pi) curvature (a/R) ln(R/a)
    slope = (small[1] / 1e-3 - large[1] / 1e-2) / np.log(10)
    assert slope == pytest.approx(2 / (3 * np.pi) * curvature, rel=0.05)


def test_incompressible_ball_changes_radius_and_peak_with_the_square():
    small, large = (scalars(ball_on_rigid(width, 0.5)) for width in (3e-3, 3e-2))
    assert small[1] == pytest.approx(-3e-3 / 4, rel=5e-3)
    assert np.log10(large / small) == pytest.approx([2.0, 1.0, 2.0], rel=0.05)


def test_disc_changes_the_approach_in_proportion_and_the_peak_with_the_cube_of_its_thickness():
    thick, thin = (scalars(contact(0.1), thickness=t) for t in (10.0, 2.5))
    assert np.log(thin / thick) / np.log(4) == pytest.approx([3.0, 1.0, 3.0], rel=0.05)
    assert scalars(contact(0.01), thickness=1e4) == pytest.approx(0.0, abs=1e-6)


def test_coating_of_the_balls_own_material_changes_nothing():
    x = np.linspace(0.0, 0.1 * R, 9)
    bare, coated = (FiniteBall(R, (layer, (E, NU))) for layer in ((), ((E, NU, 0.05 * R),)))
    kernel = bare.beyond_half_space(x)
    assert coated.beyond_half_space(x) == pytest.approx(kernel, rel=1e-9)
    assert kernel == pytest.approx(kernel.T, rel=1e-12)


@pytest.mark.slow
def test_uncertainty_contains_finer_quadrature(monkeypatch):
    problem, limits = contact(0.1, (0.5 * E, NU, ()), coating=(4.0, 0.5)), (1e-4, 2e-5)
    found = []
    for resolutions in (RESOLUTIONS, FINE, ({"nodes": 130},) * 2):
        monkeypatch.setattr("verification.sources.assumptions.finite_bodies.RESOLUTIONS", resolutions)
        found.append([np.array(astuple(one)) for one in of_half_spaces(problem)])
    *tried, (finest, _) = found
    for (change, uncertainty), limit in zip(tried, limits, strict=True):
        assert np.all(np.abs(change - finest) <= uncertainty)
        assert max(uncertainty) < limit


@pytest.mark.slow
def test_semianalytical_contact_confirms_the_disc(monkeypatch):
    monkeypatch.setattr("verification.sources.assumptions.finite_bodies.RESOLUTIONS", FINE)
    problem = contact(0.1, coating=(4.0, 0.5))
    half, disc = (
        semianalytic.solve(**keywords(one), gap="sphere", patches=33, estimate_uncertainty=False)
        for one in (problem, on_disc(problem, R))
    )
    change, _ = of_half_spaces(problem)
    rests = STILL * half.diagnostics.patch_size / half.contact_radius  # where the edge of both comes to rest
    for name in ("contact_radius", "approach", "peak_pressure"):
        found = getattr(disc, name) / getattr(half, name) - 1
        assert found == pytest.approx(getattr(change, name), rel=1e-6, abs=rests)
    before, after = (one.stress(-one.contact_radius, 0.0, 0.0)[0, 0] for one in (half, disc))
    assert (after - before) / (FLOOR * half.peak_pressure) == pytest.approx(
        change.tension, rel=1e-6, abs=rests / FLOOR
    )
