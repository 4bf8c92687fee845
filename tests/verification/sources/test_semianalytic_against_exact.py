"""The semi-analytical contact at its default numerics against the exact integral equation."""

from functools import cache

import numpy as np
import pytest

import semianalytic
from verification.problem.point_answers import Points
from verification.sources.references import integral_equation

R, W = 10e-3, 20.0
E, NU = 210e9, 0.3
A_H = (0.75 * W * R * (1 - NU**2) / E) ** (1 / 3)
P_H = 1.5 * W / (np.pi * A_H**2)
STEEL = (E, NU)

QUICK = [
    ((10 * E, 0.2, 0.1 * A_H),),
    ((0.1 * E, 0.4, 0.3 * A_H),),
    ((4 * E, NU, A_H),),
    ((2 * E, 0.2, 0.2 * A_H), (1.3 * E, 0.25, 0.1 * A_H)),
]


@cache
def ours_at_rest(coatings):
    return semianalytic.solve(radius=R, load=W, coatings=coatings, substrate=STEEL)


@pytest.mark.parametrize("coatings", QUICK)
def test_default_contact_meets_the_exact_one(coatings):
    ours = ours_at_rest(coatings)
    exact = integral_equation.solve(radius=R, load=W, coatings=coatings, substrate=STEEL)
    # the figures asked of the default numerics
    assert ours.approach == pytest.approx(exact.approach, rel=1e-5)
    assert ours.peak_pressure == pytest.approx(exact.peak_pressure, rel=2e-5)
    assert ours.contact_radius == pytest.approx(exact.contact_radius, rel=5e-4)
    for name in ("approach", "contact_radius", "peak_pressure"):
        U = getattr(ours.uncertainty, name) + getattr(exact.uncertainty, name)
        assert abs(getattr(ours, name) - getattr(exact, name)) <= U
    x = ours.surface_nodes
    error = np.abs(ours.pressure(x) - exact.pressure(x))
    assert np.all(
        error
        <= ours.sample(Points(x), "pressure").uncertainty + exact.sample(Points(x), "pressure").uncertainty
    )
    away = np.abs(np.abs(x) - exact.contact_radius) > 2 * ours.diagnostics.patch_size
    assert error[away].max() <= 1e-4 * exact.peak_pressure


@pytest.mark.parametrize(
    ("coatings", "off_plane", "friction"),
    [
        (QUICK[1], 0, 0.25),
        (QUICK[2], 9, 0.25),
        (((0.1 * E, 0.45, 0.3 * A_H),), 9, 0.5),
        (((2 * E, 0.25, 10 * A_H),), 9, 0.0),
    ],
)
def test_stress_meets_the_exact_one(coatings, off_plane, friction):
    problem = {"radius": R, "load": W, "coatings": coatings, "substrate": STEEL, "friction": friction}
    # sliding adds a linear part; that it equals a solve with friction is a law of tests/semianalytic
    ours, exact = ours_at_rest(coatings).with_friction(friction), integral_equation.solve(**problem)
    a, d = exact.contact_radius, ours.diagnostics.patch_size
    line = np.linspace(-4, 4, 41)
    beside = np.random.default_rng(4).uniform(-1.2, 1.2, (2, off_plane))
    x, y = np.concatenate([[line, 0 * line], beside], axis=1) * a
    away = np.abs(np.hypot(x, y) - a) > 3 * d
    x, y = x[away], y[away]
    depths = [(0.0, None), (1.5 * d, None), (0.2 * a, None), (a, None), (10 * a, None)]
    interfaces = np.cumsum([h for _, _, h in coatings])
    depths += [(h, upper + side) for upper, h in enumerate(interfaces) for side in (0, 1)]
    for z, layer in depths:
        found, bound = ours.sample(Points(x, y, z, layer), "stress")
        expected = exact.stress(x, y, z, layer)
        # the figure asked away from the contact edge
        np.testing.assert_allclose(found, expected, atol=2e-4 * P_H, rtol=0)
        assert np.all(np.abs(found - expected) <= bound + 1e-6 * P_H)
