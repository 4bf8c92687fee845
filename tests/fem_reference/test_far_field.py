"""Point forces on a half-space: equations of equilibrium, free surface, reciprocity."""

import numpy as np
import pytest

from fem_reference.scaling import boussinesq, cerruti

E, NU = 3.0, 0.2
X = np.random.default_rng(4).uniform([[-1], [-1], [0.5]], [[1], [1], [2.5]], (3, 6))
SURFACE = np.stack([X[0], X[1] + 2, np.zeros(6)])
STEP = 1e-2


def normal(x):
    u_r, u_z = boussinesq(r := np.hypot(x[0], x[1]), x[2], E, NU)
    return np.stack([u_r * x[0] / r, u_r * x[1] / r, u_z])


def tangential(x):
    U, V, Z = cerruti(r := np.hypot(x[0], x[1]), x[2], E, NU)
    cos, sin = x[:2] / r
    return np.stack([U * cos**2 - V * sin**2, (U + V) * sin * cos, Z * cos])


def derivative(f, axis):
    """Central differences of the fourth order."""
    shift = STEP * np.eye(3)[axis].reshape(3, *[1] * (X.ndim - 1))
    return lambda x: (8 * (f(x + shift) - f(x - shift)) - f(x + 2 * shift) + f(x - 2 * shift)) / (12 * STEP)


def strain(f):
    return lambda x: np.stack([derivative(f, k)(x) for k in range(3)], axis=1)


def stress(f):
    """Hooke's law, (3, 3, n)."""

    def sigma(x):
        e = strain(f)(x)
        e = (e + e.transpose(1, 0, 2)) / 2
        return E / (1 + NU) * (e + NU / (1 - 2 * NU) * np.eye(3)[:, :, None] * np.einsum("iin->n", e))

    return sigma


@pytest.mark.parametrize("field", [normal, tangential])
def test_point_forces_are_in_equilibrium_below_a_free_surface(field):
    divergence = sum(derivative(lambda x, k=k: stress(field)(x)[:, k], k)(X) for k in range(3))
    scale = np.abs(stress(field)(X)).max()
    assert np.abs(divergence).max() < 1e-4 * scale
    assert np.abs(stress(field)(SURFACE)[2]).max() < 1e-4 * np.abs(stress(field)(SURFACE)).max()


def test_point_forces_are_of_unit_size_and_reciprocal():
    r = np.array([0.5, 2.0])
    u_r, u_z = boussinesq(r, 0 * r, E, NU)
    np.testing.assert_allclose(u_z, (1 - NU**2) / (np.pi * E * r), rtol=1e-14)
    # u_z at r e_x of a unit force in x at the origin is u_x at the origin of a unit force in z at r e_x
    np.testing.assert_allclose(cerruti(r, 0 * r, E, NU)[2], -u_r, rtol=1e-14)
