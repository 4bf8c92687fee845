"""The operator of two materials against scikit-fem's forms and against exact fields, by harmonic."""

from dataclasses import replace

import numpy as np
import pytest
from code_checked.manufactured_solutions import (
    MATERIALS,
    boundary,
    design_orders,
    elongation,
    shear,
    unit_square,
)
from skfem import Basis, BilinearForm, ElementVector
from skfem.helpers import ddot, sym_grad, trace

from fem_reference.elasticity.axisymmetric import ELEMENTS, Discretisation, strain_operator
from fem_reference.elasticity.linear_system import constrained_solve


def lame(E, nu):
    return E * nu / ((1 + nu) * (1 - 2 * nu)), E / (2 * (1 + nu))


# The weak form as scikit-fem's documentation writes one; the manual shows both.
@BilinearForm
def at_rest(u, v, w):
    """Harmonic 0: strains of the plane (r, z) and u_r / r around it."""
    r = w.x[0]
    volume = (trace(sym_grad(u)) + u[0] / r) * (trace(sym_grad(v)) + v[0] / r)
    return (w.lam * volume + 2 * w.G * (ddot(sym_grad(u), sym_grad(v)) + u[0] * v[0] / r**2)) * r


@BilinearForm
def of_harmonic(u, v, w):
    """Harmonic m >= 1 of (S, V, Z), U = S - V, as tensors in r, theta, z."""
    r, m = w.x[0], w.m

    def strain(u):
        (S, V, Z), ((S_r, S_z), (V_r, V_z), (Z_r, Z_z)) = u, u.grad
        U, rt, tz, rz = S - V, V_r - (V + m * (S - V)) / r, V_z - m * Z / r, S_z - V_z + Z_r
        return np.array(
            [[S_r - V_r, rt / 2, rz / 2], [rt / 2, (U + m * V) / r, tz / 2], [rz / 2, tz / 2, Z_z]]
        )

    eps_u, eps_v = strain(u), strain(v)
    return (w.lam * trace(eps_u) * trace(eps_v) + 2 * w.G * ddot(eps_u, eps_v)) * r


@pytest.mark.parametrize("order", [2, 3, 4])
@pytest.mark.parametrize("harmonic", [0, 1, 2, 5])
def test_stiffness_is_that_of_the_weak_form(order, harmonic):
    d = Discretisation(unit_square(4, skew=0.3), order)
    fields = 3 if harmonic else 2
    element = ElementVector(ELEMENTS[order](), fields)
    expected = 0.0
    for layer, material in enumerate(MATERIALS):
        cells = np.flatnonzero(d.mesh.layer == layer)
        basis = Basis(d.triangulation, element, intorder=2 * order, elements=cells)
        lam, G = lame(*material)
        expected += (of_harmonic if harmonic else at_rest).assemble(basis, lam=lam, G=G, m=harmonic)
    # its unknowns field after field
    number = np.empty(fields * d.N, dtype=int)
    for field in range(fields):
        number[basis.dofs.element_dofs[field::fields]] = d.basis.element_dofs + field * d.N
    place = np.argsort(number)
    K = d.stiffness(MATERIALS, harmonic)
    assert abs(K - expected[place][:, place]).max() < 1e-13 * abs(K).max()
    assert abs(K - K.T).max() < 1e-15 * abs(K).max()


@pytest.mark.parametrize("harmonic", [0, 1, 2, 7])
def test_strains_are_those_of_the_displacement(harmonic):
    """Of a polynomial field, whose derivatives are known, in the components of its harmonic."""
    m, r, U, V, Z = harmonic, 0.7, 0.3, 0.4 if harmonic else 0.0, -0.2
    by_r, by_z = (np.array([u, v if harmonic else 0.0, w]) for u, v, w in ((1.1, 0.6, 0.9), (-0.8, 0.5, 1.3)))
    (U_r, V_r, Z_r), (U_z, V_z, Z_z) = by_r, by_z
    expected = [U_r, (U + m * V) / r, Z_z, U_z + Z_r, V_r - (V + m * U) / r, V_z - m * Z / r]
    fields = [np.array([u + v, v, w]) for u, v, w in (by_r, by_z, (U, V, Z))]
    if not harmonic:
        fields, expected = [one[[0, 2]] for one in fields], expected[:4]
    A_r, A_z, A_0 = strain_operator(harmonic)
    np.testing.assert_allclose(A_r @ fields[0] + A_z @ fields[1] + A_0 @ fields[2] / r, expected, rtol=1e-14)


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
    u = constrained_solve(d.stiffness(MATERIALS, harmonic), given.ravel(), numbers).u
    # rounding: condition of the stiffness matrix, about 1e4, times 1e-16
    np.testing.assert_allclose(u.reshape(exact.shape), exact, rtol=0, atol=1e-11)


def test_manufactured_solution_converges_at_the_design_order():
    found = design_orders()
    assert {(one.order, one.harmonic) for one in found} == {(p, n) for p in (2, 3, 4) for n in (0, 1)}
    for one in found:
        # order + 1 for the displacement, order for its gradient; 0.25 for meshes this coarse
        assert one.displacement > one.order + 1 - 0.25
        assert one.gradient > one.order - 0.25
        assert one.as_designed
        assert not replace(one, gradient=one.order - 0.3).as_designed
