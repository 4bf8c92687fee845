"""Constrained solves against dense matrices, and by the factor of a nearby matrix."""

import numpy as np
import pytest

from fem_reference.axisymmetric import Discretisation
from fem_reference.linear_system import constrained_solve
from verification.credibility.manufactured import MATERIALS, unit_square


def problem(harmonic, stretch=1.0, order=3):
    """Matrix, unknowns held, given values, load."""
    d = Discretisation(unit_square(4, skew=0.3).stretched(stretch), order)
    K = d.stiffness(MATERIALS, harmonic)
    fields = K.shape[0] // d.N
    fixed = np.concatenate([field * d.N + d.outer for field in range(fields)] + [d.axis])
    given, load = np.random.default_rng(2).normal(size=(2, K.shape[0], 3))
    return K, fixed, given, load


def dense(K, fixed, given, load):
    free = np.setdiff1d(np.arange(len(given)), fixed)
    A, u = K.toarray(), given.copy()
    u[free] = np.linalg.solve(A[np.ix_(free, free)], load[free] - A[np.ix_(free, fixed)] @ given[fixed])
    return u


@pytest.mark.parametrize("order", [2, 3, 4])
@pytest.mark.parametrize("harmonic", [0, 1])
def test_given_values_are_held_by_forces(order, harmonic):
    K, fixed, given, load = problem(harmonic, order=order)
    found = constrained_solve(K, given, fixed, load)
    # condition of the stiffness matrix, about 1e4, times rounding
    np.testing.assert_allclose(found.u, dense(K, np.unique(fixed), given, load), rtol=0, atol=1e-11)
    np.testing.assert_array_equal(found.u[fixed], given[fixed])
    np.testing.assert_allclose(K @ found.u, load + found.force + found.residual, rtol=0, atol=1e-11)
    free = np.setdiff1d(np.arange(len(given)), fixed)
    assert not found.force[free].any()
    assert not found.residual[fixed].any()
    assert np.abs(found.residual).max() < 1e-11
    one = constrained_solve(K, given[:, 0], fixed, load[:, 0])
    np.testing.assert_allclose(one.u, found.u[:, 0], rtol=0, atol=1e-13)


def test_the_factor_of_a_nearby_matrix_gives_the_same_solution():
    factor = constrained_solve(*(problem(0)[k] for k in (0, 2, 1)), problem(0)[3]).factor
    K, fixed, given, load = problem(0, stretch=1.001)
    by_own, by_nearby = (constrained_solve(K, given, fixed, load, one) for one in (None, factor))
    assert by_nearby.factor is factor
    np.testing.assert_allclose(by_nearby.u, by_own.u, rtol=0, atol=1e-12)


def test_the_factor_of_a_distant_matrix_is_not_used():
    factor = constrained_solve(*(problem(0)[k] for k in (0, 2, 1)), problem(0)[3]).factor
    K, fixed, given, load = problem(0, stretch=1.3)
    found = constrained_solve(K, given, fixed, load, factor)
    assert found.factor is not factor
    np.testing.assert_allclose(found.u, constrained_solve(K, given, fixed, load).u, rtol=0, atol=1e-13)
