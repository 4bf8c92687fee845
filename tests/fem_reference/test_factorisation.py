"""Pardiso of the extra ``fast`` against nested dissection; its pattern of blocks, which needs no wheel."""

import numpy as np
import pytest

from fem_reference import dissection, factorisation, solve
from fem_reference.axisymmetric import Discretisation
from fem_reference.dissection import CholeskyFactor, DissectionTree
from fem_reference.factorisation import BlockPattern, PardisoFactor, pardiso_library
from verification.credibility.manufactured_solutions import MATERIALS, unit_square

needs_mkl = pytest.mark.skipif(
    pardiso_library() is None, reason="Pardiso is not compared: the wheel mkl is missing (extra fast)"
)
STEEL = (210e9, 0.3)
CONTACT = {
    "radius": 10e-3,
    "load": 20.0,
    "coatings": ((420e9, 0.25, 70e-6),),
    "substrate": STEEL,
    "order": 2,
    "size": 0.5,
}


def problem(harmonic):
    """Element matrices, their nodes by triangle, unknowns held."""
    d = Discretisation(unit_square(4, skew=0.3), 3)
    K = d.stiffness(MATERIALS, harmonic)
    held = np.zeros(K.fields * d.N, dtype=bool)
    held[d.axis] = held[d.N + d.outer] = True
    held[d.outer[: d.outer.size // 2]] = True
    if harmonic == 1:
        held[2 * d.N + d.outer] = True
    return d, K, held


@pytest.mark.parametrize("harmonic", [0, 1])
def test_blocks_are_those_of_the_matrix(harmonic):
    d, K, held = problem(harmonic)
    pattern = BlockPattern(K.nodes)
    blocks = pattern.assembled(K.elements, held)
    found = np.zeros((d.N, K.fields, d.N, K.fields))
    found[pattern.rows, :, pattern.columns] = blocks
    found[pattern.columns, :, pattern.rows] = blocks.transpose(0, 2, 1)
    dense = K @ np.eye(held.size)
    dense[held] = dense[:, held] = 0.0
    dense[held, held] = 1.0
    by_field = found.transpose(1, 0, 3, 2).reshape(dense.shape)
    np.testing.assert_allclose(by_field, dense, rtol=0, atol=1e-13 * np.abs(dense).max())
    np.testing.assert_array_equal(np.repeat(np.arange(d.N), np.diff(pattern.begins)), pattern.rows)


@pytest.mark.parametrize("triangles", [17, 2**12])
@pytest.mark.parametrize("harmonic", [0, 1])
def test_parts_eliminated_one_after_the_other_give_the_same_bits(harmonic, triangles, monkeypatch):
    d, K, held = problem(harmonic)
    load = np.where(held[:, None], 0.0, np.random.default_rng(1).normal(size=(held.size, 3)))
    at_once = CholeskyFactor(DissectionTree.of(K.nodes, d.leaf), K.elements, held).solve(load)
    monkeypatch.setattr(dissection, "_BRANCH", triangles)
    tree = DissectionTree.of(K.nodes, d.leaf)
    assert (len(tree.branches) == 1) == (triangles >= d.mesh.layer.size)
    dense = K @ np.eye(held.size)
    dense[held] = dense[:, held] = 0.0
    dense[held, held] = 1.0
    expected = np.linalg.solve(dense, load)
    found = CholeskyFactor(tree, K.elements, held).solve(load)
    np.testing.assert_array_equal(found, at_once)
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-11 * np.abs(expected).max())


@needs_mkl
@pytest.mark.parametrize("harmonic", [0, 1])
def test_pardiso_solves_as_nested_dissection(harmonic):
    d, K, held = problem(harmonic)
    load = np.where(held[:, None], 0.0, np.random.default_rng(1).normal(size=(held.size, 3)))
    expected = CholeskyFactor(DissectionTree.of(K.nodes, d.leaf), K.elements, held).solve(load)
    pattern = BlockPattern(K.nodes)
    for _ in range(2):  # the second time in the order of elimination that the first has found
        factor = PardisoFactor(pattern, K.elements, held)
        found = factor.solve(load)
        np.testing.assert_allclose(found, expected, rtol=0, atol=1e-11 * np.abs(expected).max())
        one = factor.solve(load[:, 0])
        np.testing.assert_allclose(one, found[:, 0], rtol=0, atol=1e-13 * np.abs(expected).max())


@needs_mkl
def test_pardiso_refuses_a_matrix_that_is_not_positive_definite():
    _, K, held = problem(0)
    with pytest.raises(np.linalg.LinAlgError):
        PardisoFactor(BlockPattern(K.nodes), -K.elements, held)


@needs_mkl
@pytest.mark.parametrize("ball", [None, (300e9, 0.22, ((250e9, 0.25, 20e-6),))], ids=["rigid", "coated"])
def test_a_contact_has_the_same_numbers_by_either_factorisation(ball, monkeypatch):
    def solved():
        contact = solve(**CONTACT, ball=ball, friction=0.25)
        x = np.linspace(-2, 2, 9) * contact.contact_radius
        scalars = contact.contact_radius, contact.approach, contact.stiffness, contact.peak_pressure
        bodies = ("flat",) if ball is None else ("flat", "ball")
        stresses = [contact.stress(x, 0.0, np.abs(x), body=body) / contact.peak_pressure for body in bodies]
        return np.array(scalars), np.array(stresses)

    scalars, stresses = solved()
    monkeypatch.setattr(factorisation, "pardiso_library", lambda: None)
    expected, expected_stresses = solved()
    np.testing.assert_allclose(scalars, expected, rtol=1e-9, atol=0)
    np.testing.assert_allclose(stresses, expected_stresses, rtol=0, atol=1e-9)
