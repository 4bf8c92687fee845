"""Two elastic bodies: published digits, closed forms, limits, by both methods and the exact reference."""

from dataclasses import replace
from functools import lru_cache

import numpy as np
import pytest

import fem_reference
import semianalytic
from verification.problem.coated_contact import CoatedContact, keywords
from verification.problem.either_body import on_body
from verification.problem.point_answers import BALL, FLAT
from verification.sources.references import integral_equation
from verification.sources.references.hertz import Hertz

SOURCES = (semianalytic, fem_reference, integral_equation)
E, STEEL = 210e9, (210e9, 0.3)
BARE = CoatedContact(10e-3, 20.0, (), STEEL, ball=(*STEEL, ()))
A = BARE.a_h
FLAT_COATED = replace(BARE, coatings=((2 * E, 0.3, 0.5 * A),))
BOTH_COATED = replace(FLAT_COATED, ball=(*STEEL, ((0.5 * E, 0.25, 0.3 * A),)))
# An alumina ball slides on steel: two materials, beta not zero.
SLIDING = replace(BARE, friction=0.3, ball=(370e9, 0.22, ()))
X, Y, Z = A * np.array([[0.0, -0.9, 0.4, 1.3, 1.0], [0.0, 0.2, 0.3, -0.5, 0.0], [0.0, 0.1, 0.45, 0.7, 0.0]])
NUMBERS = ("contact_radius", "peak_pressure", "approach")


@lru_cache
def solved(source, problem, size=0.25):
    numerics = {"size": size} if source is fem_reference else {}
    return source.solve(**keywords(problem), **numerics)


def over_scales(source, problem):
    found = solved(source, problem, 0.16)
    scales = (problem.a_h, problem.p_h, problem.delta_h)
    return [getattr(found, name) / scale for name, scale in zip(NUMBERS, scales, strict=True)]


# Six digits by a program that shares nothing with this one.
@pytest.mark.parametrize("source", SOURCES)
@pytest.mark.parametrize(
    ("problem", "digits"),
    [(FLAT_COATED, (0.942370, 1.094780, 0.957244)), (BOTH_COATED, (1.025361, 0.984324, 1.013859))],
)
def test_digits_of_an_independent_program(source, problem, digits):
    # half of the last digit; patches find the contact radius to 1e-5
    assert over_scales(source, problem) == pytest.approx(
        digits, abs=1e-5 if source is semianalytic else 1.1e-6
    )


@pytest.mark.parametrize("source", SOURCES)
def test_uncoated_bodies_are_those_of_hertz_and_hamilton(source):
    assert over_scales(source, SLIDING) == pytest.approx((1, 1, 1), abs=1e-6)
    exact = Hertz(10e-3, 20.0, *STEEL, 0.3, ball=(370e9, 0.22))
    assert exact.contact_radius == pytest.approx(SLIDING.a_h, rel=1e-14, abs=0)
    for body in (FLAT, BALL):
        error = solved(source, SLIDING).stress(X, Y, Z, body=body) - exact.stress(X, Y, Z, body=body)
        assert np.abs(error).max() < 2e-4 * SLIDING.p_h
    assert Hertz(10e-3, 20.0, *STEEL, ball=(370e9, 0.22)).peak_pressure == pytest.approx(SLIDING.p_h)


@pytest.mark.parametrize(
    "source", [pytest.param(one, marks=[pytest.mark.slow] * (one is fem_reference)) for one in SOURCES]
)
def test_the_ball_seen_as_the_flat_has_its_stresses(source):
    problem = replace(BOTH_COATED, friction=0.2)
    one, other = solved(source, problem), solved(source, problem.seen_from(BALL))
    assert problem.seen_from(BALL).seen_from(BALL) == problem
    for name in NUMBERS:
        assert getattr(one, name) == pytest.approx(getattr(other, name), rel=5e-6, abs=0)
    change = on_body(one, BALL).stress(X, Y, Z) - other.stress(X, Y, Z)
    assert np.abs(change).max() < 2e-4 * problem.p_h


@pytest.mark.slow
@pytest.mark.parametrize("method", [semianalytic, fem_reference])
def test_shear_on_the_ball_opposes_that_on_the_flat(method):
    found, problem = solved(method, replace(BOTH_COATED, friction=0.2)), BOTH_COATED
    x = found.contact_radius * np.array([-0.6, 0.2])
    for body, sign in ((FLAT, -1), (BALL, 1)):
        sigma = found.stress(x, 0.0, 0.0, body=body)
        assert sigma[0, 2] == pytest.approx(sign * 0.2 * found.pressure(x), abs=1e-7 * problem.p_h)
        assert sigma[2, 2] == pytest.approx(-found.pressure(x), abs=1e-7 * problem.p_h)


@pytest.mark.parametrize("source", SOURCES)
def test_a_rigid_ball_has_no_stress(source):
    with pytest.raises(ValueError, match="body = 'ball'"):
        solved(source, replace(FLAT_COATED, ball=None)).stress(0.0, 0.0, A, body=BALL)


def test_scales_and_beta_are_those_of_both_bodies():
    assert BARE.E_star == pytest.approx(replace(BARE, ball=None).E_star / 2)
    assert BARE.dundurs_beta == 0
    assert SLIDING.dundurs_beta == -SLIDING.seen_from(BALL).dundurs_beta != 0
    # Johnson (5.3) with an infinite modulus: (1 - 2 nu) / (2 (1 - nu))
    assert replace(BARE, ball=None).dundurs_beta == pytest.approx(0.4 / 1.4)
