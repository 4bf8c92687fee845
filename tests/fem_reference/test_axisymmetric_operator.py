"""The two-material axisymmetric operator against exact displacement fields, harmonics 0 and 1."""

from dataclasses import replace

import numpy as np
import pytest

from fem_reference.axisymmetric import Discretisation, constrained_solve
from verification.credibility.manufactured_solutions import (
    MATERIALS,
    boundary,
    design_orders,
    elongation,
    shear,
    unit_square,
)


@pytest.mark.parametrize("order", [2, 3, 4])
@pytest.mark.parametrize("harmonic", [0, 1])
def test_constant_strain_across_an_interface_is_exact(order, harmonic):
    d = Discretisation(unit_square(4, skew=0.3), order)
    r, z = d.locations
    # harmonic 1: u_x = g(z), U = g and V = -g, carried as (S, V, Z)
    exact = np.stack([r, elongation(z)[0]] if harmonic == 0 else [0 * r, -shear(z)[0], 0 * r])
    fixed = boundary(d)
    given = np.zeros_like(exact)
    given[:, fixed] = exact[:, fixed]
    numbers = np.concatenate([field * d.N + fixed for field in range(exact.shape[0])])
    u = constrained_solve(d.stiffness(MATERIALS, harmonic), given.ravel(), numbers)
    # rounding: condition of the stiffness matrix, about 1e4, times 1e-16
    np.testing.assert_allclose(u.reshape(exact.shape), exact, rtol=0, atol=1e-11)


@pytest.mark.parametrize("order", [2, 3, 4])
@pytest.mark.parametrize("harmonic", [0, 1])
def test_nested_dissection_solves_as_a_dense_matrix(order, harmonic):
    d = Discretisation(unit_square(4, skew=0.3), order)
    K = d.stiffness(MATERIALS, harmonic)
    dense = K @ np.eye(K.fields * d.N)
    np.testing.assert_allclose(dense, dense.T, rtol=0, atol=1e-14 * np.abs(dense).max())
    fixed = np.unique(np.concatenate([field * d.N + d.outer for field in range(K.fields)] + [d.axis]))
    given, load = np.random.default_rng(2).normal(size=(2, len(dense), 3))
    free = np.setdiff1d(np.arange(len(dense)), fixed)
    expected = given.copy()
    rest = load[free] - dense[np.ix_(free, fixed)] @ given[fixed]
    expected[free] = np.linalg.solve(dense[np.ix_(free, free)], rest)
    # condition of the stiffness matrix, about 1e4, times rounding
    np.testing.assert_allclose(constrained_solve(K, given, fixed, load), expected, rtol=0, atol=1e-11)


def test_manufactured_solution_converges_at_the_design_order():
    found = design_orders()
    assert {(one.order, one.harmonic) for one in found} == {(p, n) for p in (2, 3, 4) for n in (0, 1)}
    for one in found:
        # order + 1 for the displacement, order for its gradient; 0.25 for meshes this coarse
        assert one.displacement > one.order + 1 - 0.25
        assert one.gradient > one.order - 0.25
        assert one.as_designed
        assert not replace(one, gradient=one.order - 0.3).as_designed
