"""Constrained solves: by dense matrices, in single and double precision, by Pardiso of the extra `fast`."""

import sys
from importlib.util import find_spec
from types import SimpleNamespace

import numpy as np
import pytest
import scipy.sparse as sp
from code_checked.manufactured_solutions import MATERIALS, unit_square

from fem_reference import solve
from fem_reference.elasticity import linear_system
from fem_reference.elasticity.axisymmetric import Discretisation
from fem_reference.elasticity.linear_system import ConstrainedFactor, constrained_solve, minimum_degree


def problem(harmonic, order=3):
    """Matrix, given values, unknowns held, load."""
    d = Discretisation(unit_square(4, skew=0.3), order)
    K = d.stiffness(MATERIALS, harmonic)
    fields = K.shape[0] // d.N
    fixed = np.concatenate([field * d.N + d.outer for field in range(fields)] + [d.axis])
    given, load = np.random.default_rng(2).normal(size=(2, K.shape[0], 3))
    return K, given, fixed, load


def dense(K, given, fixed, load):
    free = np.setdiff1d(np.arange(len(given)), fixed)
    A, u = K.toarray(), given.copy()
    u[free] = np.linalg.solve(A[np.ix_(free, free)], load[free] - A[np.ix_(free, fixed)] @ given[fixed])
    return u


@pytest.mark.parametrize("order", [2, 3, 4])
@pytest.mark.parametrize("harmonic", [0, 1])
def test_given_values_are_held_by_forces(order, harmonic):
    K, given, fixed, load = problem(harmonic, order=order)
    found = constrained_solve(K, given, fixed, load)
    # condition of the stiffness matrix, about 1e4, times rounding
    np.testing.assert_allclose(found.u, dense(K, given, np.unique(fixed), load), rtol=0, atol=1e-11)
    np.testing.assert_array_equal(found.u[fixed], given[fixed])
    np.testing.assert_allclose(K @ found.u, load + found.force + found.residual, rtol=0, atol=1e-11)
    free = np.setdiff1d(np.arange(len(given)), fixed)
    assert not found.force[free].any()
    assert not found.residual[fixed].any()
    assert np.abs(found.residual).max() < 1e-11
    one = constrained_solve(K, given[:, 0], fixed, load[:, 0])
    np.testing.assert_allclose(one.u, found.u[:, 0], rtol=0, atol=1e-12 * np.abs(found.u).max())


@pytest.mark.parametrize("order", [2, 3, 4])
@pytest.mark.parametrize("harmonic", [0, 1])
def test_unknowns_inside_triangles_follow_from_those_on_their_sides(order, harmonic):
    d = Discretisation(unit_square(4, skew=0.3), order)
    K, given, fixed, load = problem(harmonic, order=order)
    skeleton = d.skeleton(MATERIALS, harmonic)
    inner = skeleton.inner.ravel()
    assert inner.size == d.mesh.layer.size * (K.shape[0] // d.N) * (order - 1) * (order - 2) // 2
    load[inner] = given[inner] = 0.0
    expected = constrained_solve(K, given, fixed, load)
    found = constrained_solve(skeleton.matrix, given, np.concatenate([fixed, inner]), load)
    np.testing.assert_allclose(skeleton.extended(found.u), expected.u, rtol=0, atol=1e-11)
    held = np.unique(fixed)
    np.testing.assert_allclose(found.force[held], expected.force[held], rtol=0, atol=1e-11)


@pytest.mark.parametrize(("steps", "expected"), [(30, [np.float32]), (1, [np.float32, np.float64])])
def test_one_load_in_single_precision_is_refined_or_solved_in_double(steps, expected, monkeypatch):
    monkeypatch.setattr(linear_system, "_PARDISO", False)
    K, given, fixed, load = problem(1)
    precisions = []
    factorised = linear_system.factorised
    monkeypatch.setattr(linear_system, "factorised", lambda A: precisions.append(A.dtype) or factorised(A))
    monkeypatch.setattr(linear_system.chosen, "MOST_STEPS", steps)
    found = constrained_solve(K, given[:, 0], fixed, load[:, 0])
    assert precisions == expected
    np.testing.assert_allclose(found.residual, 0.0, rtol=0, atol=1e-11)
    np.testing.assert_allclose(found.u, dense(K, given, np.unique(fixed), load)[:, 0], rtol=0, atol=1e-11)


class DensePardiso:
    """Pardiso's face for symmetric positive definite matrices, of which it takes the upper triangle alone."""

    def __init__(self, mtype):
        assert mtype == 2
        self.libmkl = SimpleNamespace(_name="mkl", MKL_Set_Threading_Layer=lambda layer: None)
        self.free_memory, self.set_iparm = (lambda everything: None), (lambda which, value: None)

    def factorize(self, upper):
        assert sp.tril(upper, -1).nnz == 0
        whole = upper.toarray() + sp.triu(upper, 1).toarray().T
        self.factor = np.linalg.cholesky(whole)

    def solve(self, upper, load):
        return np.linalg.solve(self.factor.T, np.linalg.solve(self.factor, load))


def test_pardiso_is_given_the_upper_triangle_of_the_stiffness(monkeypatch, environment):
    monkeypatch.setitem(sys.modules, "pypardiso", SimpleNamespace(PyPardisoSolver=DensePardiso))
    monkeypatch.setattr(linear_system, "_PARDISO", True)
    environment(PYPARDISO_MKL_RT="mkl")
    K, given, fixed, load = problem(1)
    found = constrained_solve(K, given, fixed, load)
    np.testing.assert_allclose(found.u, dense(K, given, np.unique(fixed), load), rtol=0, atol=1e-11)


needs_pardiso = pytest.mark.skipif(
    find_spec("pypardiso") is None, reason="Pardiso is not compared: pypardiso is missing (extra fast)"
)


@needs_pardiso
@pytest.mark.parametrize("harmonic", [0, 1])
def test_pardiso_solves_as_superlu(harmonic, monkeypatch):
    by_pardiso = constrained_solve(*problem(harmonic))
    monkeypatch.setattr(linear_system, "_PARDISO", False)
    by_superlu = constrained_solve(*problem(harmonic))
    np.testing.assert_allclose(by_pardiso.u, by_superlu.u, rtol=0, atol=1e-11)


@needs_pardiso
@pytest.mark.parametrize("ball", [None, (300e9, 0.22, ((250e9, 0.25, 20e-6),))], ids=["rigid", "coated"])
def test_a_contact_has_the_same_numbers_by_either_factorisation(ball, monkeypatch):
    def solved():
        coatings, steel = ((420e9, 0.25, 70e-6),), (210e9, 0.3)
        problem = {"radius": 10e-3, "load": 20.0, "coatings": coatings, "substrate": steel, "ball": ball}
        contact = solve(**problem, friction=0.25, order=2, size=0.5)
        x = np.linspace(-2, 2, 9) * contact.contact_radius
        scalars = contact.contact_radius, contact.approach, contact.stiffness, contact.peak_pressure
        bodies = ("flat",) if ball is None else ("flat", "ball")
        stresses = [contact.stress(x, 0.0, np.abs(x), body=body) / contact.peak_pressure for body in bodies]
        return np.array(scalars), np.array(stresses)

    scalars, stresses = solved()
    monkeypatch.setattr(linear_system, "_PARDISO", False)
    expected, expected_stresses = solved()
    np.testing.assert_allclose(scalars, expected, rtol=1e-9, atol=0)
    np.testing.assert_allclose(stresses, expected_stresses, rtol=0, atol=1e-9)


def test_the_compliance_is_that_part_of_the_inverse_and_the_order_fills_little():
    """On a square grid: the inverse of a dense matrix, in an order that fills less than row by row."""
    line = sp.diags([-1.0, 2.1, -1.0], [-1, 0, 1], shape=(30, 30))
    K = sp.kronsum(line, line).tocsc()
    order, kept = minimum_degree(K), np.array([17, 3, 850])
    found = ConstrainedFactor.of(K, order, kept)
    exact = np.linalg.inv(K.toarray())[np.ix_(kept, kept)]
    np.testing.assert_allclose(found.compliance, exact, rtol=1e-12)
    assert np.array_equal(np.sort(order), np.arange(900))
    row_by_row = ConstrainedFactor.of(K, np.arange(900), kept)
    assert found.factor.nnz < 0.7 * row_by_row.factor.nnz
    np.testing.assert_allclose(row_by_row.compliance, exact, rtol=1e-12)
