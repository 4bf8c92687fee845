"""Displacement of a solid under surface tractions of harmonic 0 or 1, or pressed down; of two that touch.

A pressure p(r) loads harmonic 0. A traction q(r) in +x loads harmonic 1,

    q_r = q cos(theta),   q_theta = -q sin(theta),   virtual work  int q (U - V) r dr = int q (S - 2 V) r dr,

so sliding friction q = f p needs no third dimension.

Of two bodies the ball is reflected in the surface: with v_z = -u_z of the ball, z into it, both have one
axial displacement w on the contact but for the jump that closes the gap,

    u_z (flat) = w,   v_z (ball) = w - jump,   u_z (flat) + u_z (ball) = jump,

while their radial displacements are independent, since the contact transmits no shear. With T the matrix that
gives a ball's field vector from the unknowns of both, the matrix of the pair is K_flat + T^T K_ball T.
"""

from collections.abc import Callable

import numpy as np
import scipy.sparse as sp

from fem_reference.elasticity.axisymmetric import Discretisation
from fem_reference.elasticity.linear_system import Constrained, constrained_solve
from fem_reference.scaling import LayeredSolid

Body = tuple[LayeredSolid, Discretisation]


def solve_traction(
    d: Discretisation, solid: LayeredSolid, harmonic: int, traction: Callable[[np.ndarray], np.ndarray]
) -> np.ndarray:
    """Field vector (see ``axisymmetric``) under ``traction`` within the mesh's contact radius.

    traction : r -> pressure (harmonic 0) or traction in +x (harmonic 1)
    """
    force, zero = d.contact_load(traction), np.zeros(d.N)
    load = np.concatenate([zero, force] if harmonic == 0 else [force, -2 * force, zero])
    return solve_fields(d, solid, harmonic, 2 * np.pi * force.sum(), load=load)[0]


def solve_fields(
    d: Discretisation,
    solid: LayeredSolid,
    harmonic: int,
    far: float | np.ndarray,
    *,
    load: np.ndarray | None = None,
    u_z: np.ndarray | None = None,
) -> tuple[np.ndarray, Constrained]:
    """Field vectors (n,) or (n, columns) under the ``load`` or with ``u_z`` on the contact, and how found.

    far : force whose far field is prescribed, number or (columns,).  load : as the field vectors
    u_z : at the contact nodes (nodes, columns), for harmonic 0
    """
    fields, on_axis = (2, [0]) if harmonic == 0 else (3, [0, 2])
    given = np.zeros((fields, d.N, *np.shape(far)))
    fixed = np.zeros((fields, d.N), dtype=bool)
    if u_z is not None:
        given[1, d.contact], fixed[1, d.contact] = u_z, True
    given[:, d.outer] = solid.far_fields(harmonic, far, d.locations[:, d.outer])
    fixed[:, d.outer] = True
    for field in on_axis:
        given[field, d.axis], fixed[field, d.axis] = 0.0, True
    K = d.skeleton(solid.materials, harmonic)
    fixed.reshape(-1)[K.inner] = True
    solved = constrained_solve(K.matrix, given.reshape(-1, *np.shape(far)), np.flatnonzero(fixed), load)
    return K.extended(solved.u), solved


def solve_pair(
    bodies: tuple[Body, Body], jump: np.ndarray, far: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray, Constrained]:
    """Displacements of flat and ball, several cases in columns.

    bodies : layers and elements of flat and ball, with the same nodes on the surface
    jump : of u_z at the contact nodes (nodes, columns).  far : load whose far field is prescribed, (columns,)
    Returns the field vectors (2 N, columns) of flat and ball, the nodal forces (nodes, columns) on the flat,
    and how they were found. Raises ValueError where the surfaces differ.
    """
    (_, flat), (_, ball) = bodies
    one, two = (d.locations[0, d.surface] for d in (flat, ball))
    if one.shape != two.shape or not np.allclose(one, two, rtol=1e-12, atol=0):
        raise ValueError("the meshes of flat and ball have different nodes on the surface")
    n_flat, n_ball = 2 * flat.N, 2 * ball.N
    # unknown of the pair for each of the ball: on the contact that of the flat
    numbers = np.ones(n_ball, dtype=int)
    numbers[ball.N + ball.contact] = 0
    n = n_flat + numbers.sum()
    numbers = n_flat - 1 + np.cumsum(numbers)
    numbers[ball.N + ball.contact] = flat.N + flat.contact
    sign = np.repeat([1.0, -1.0], ball.N)
    T = sp.csc_matrix((sign, (np.arange(n_ball), numbers)), shape=(n_ball, n))
    K_flat, K_ball = (d.skeleton(solid.materials, 0) for solid, d in bodies)
    on_flat = K_flat.matrix[:, flat.N + flat.contact].T  # K is symmetric

    given = np.zeros((n, far.size))
    fixed = [K_flat.inner.ravel(), numbers[K_ball.inner.ravel()]]
    sides = ((flat, np.arange(n_flat), 1.0), (ball, numbers, -1.0))
    for (d, number, axial), (solid, _) in zip(sides, bodies, strict=True):
        u_r, u_z = solid.far_fields(0, far, d.locations[:, d.outer])
        given[number[d.outer]], given[number[d.N + d.outer]] = u_r, axial * u_z
        given[number[d.axis]] = 0.0
        fixed += [number[d.outer], number[d.N + d.outer], number[d.axis]]
    apart = np.zeros((n_ball, far.size))
    apart[ball.N + ball.contact] = jump
    load = -(T.T @ (K_ball.matrix @ apart))
    K = T.T @ K_ball.matrix @ T
    K_flat.matrix.resize(n, n)
    solved = constrained_solve(K + K_flat.matrix, given, np.concatenate(fixed), load)
    of_flat = solved.u[:n_flat]
    of_ball = T @ solved.u + apart
    return K_flat.extended(of_flat), K_ball.extended(of_ball), on_flat @ of_flat, solved
