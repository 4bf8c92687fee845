"""A solution as a plain object: pickled, sliding with another friction, stress with its uncertainty."""

import pickle
from functools import lru_cache

import numpy as np
import pytest

from fem_reference import solve, solve_prescribed

R, W, E, NU = 10e-3, 20.0, 210e9, 0.3
A = 8e-5
COATED = ((2 * E, 0.25, 0.5 * A),)
X, Y, Z = (
    A * np.array(v) for v in ([0.0, -1.2, 0.3, 0.4, 0.0], [0.0, 0.2, 0.5, 0.0, 0.0], [0, 0, 0.2, 0.5, 1.1])
)
KINDS = ("sphere", "uniform pressure", "pressure as a function")


def parabola(r):
    return 1e9 * (1 - (r / A) ** 2)


@lru_cache
def solved(kind, friction=0.0, **keywords):
    common = {"coatings": COATED, "substrate": (E, NU), "friction": friction, "size": 0.5, "order": 2}
    if kind == "sphere":
        return solve(radius=R, load=W, **common, **keywords)
    pressure = 1e9 if kind == "uniform pressure" else parabola
    return solve_prescribed(pressure=pressure, load_radius=A, **common, **keywords)


def assert_same(one, other):
    """Equal to the last bit in all but the time."""
    for name in ("contact_radius", "approach", "peak_pressure", "stiffness", "stiffness_uncertainty"):
        assert getattr(one, name) == getattr(other, name), name
    assert one.uncertainty == other.uncertainty
    assert one.diagnostics.history == other.diagnostics.history
    for function in ("pressure", "pressure_uncertainty"):
        np.testing.assert_array_equal(getattr(one, function)(X, Y), getattr(other, function)(X, Y))
    for function in ("stress", "stress_uncertainty", "displacement"):
        np.testing.assert_array_equal(getattr(one, function)(X, Y, Z), getattr(other, function)(X, Y, Z))


@pytest.mark.parametrize("friction", [0.0, 0.25])
@pytest.mark.parametrize("kind", KINDS)
def test_a_pickled_solution_has_the_same_values(kind, friction):
    s = solved(kind, friction)
    data = pickle.dumps(s)
    assert_same(pickle.loads(data), s)
    # matrices and search trees are computed again on use, in place of being stored
    assert len(pickle.dumps(s)) < 2 * len(data)
    assert_same(pickle.loads(pickle.dumps(s)), s)


@pytest.mark.parametrize("kind", KINDS)
def test_another_friction_gives_the_solution_of_that_friction(kind):
    rest, sliding = solved(kind), solved(kind, 0.25)
    assert_same(rest.with_friction(0.25), sliding)
    assert_same(solved(kind, -0.4).with_friction(0.25), sliding)
    assert_same(sliding.with_friction(0.0), rest)
    assert_same(pickle.loads(pickle.dumps(rest)).with_friction(0.25), sliding)
    assert sliding.with_friction(0.0).state.tangential is None
    assert rest.with_friction(0.25).diagnostics.seconds > rest.diagnostics.seconds


def test_another_friction_needs_no_estimate_and_has_to_be_finite():
    rest = solved("sphere", estimate_uncertainty=False)
    sliding = solved("sphere", 0.25, estimate_uncertainty=False)
    np.testing.assert_array_equal(rest.with_friction(0.25).stress(X, Y, Z), sliding.stress(X, Y, Z))
    with pytest.raises(ValueError, match="friction = nan"):
        rest.with_friction(float("nan"))
    with pytest.raises(ValueError, match="estimate_uncertainty=True"):
        rest.stress_with_uncertainty(X, Y, Z)


@pytest.mark.parametrize("layer", [None, 0, 1])
def test_stress_with_its_uncertainty_equals_both_apart(layer):
    s = solved("sphere", 0.25)
    z = Z if layer is None else np.full(X.shape, COATED[0][2])
    stress, uncertainty = s.stress_with_uncertainty(X, Y, z, layer)
    np.testing.assert_array_equal(stress, s.stress(X, Y, z, layer))
    np.testing.assert_array_equal(uncertainty, s.stress_uncertainty(X, Y, z, layer))
