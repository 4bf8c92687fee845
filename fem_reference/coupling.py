"""Two bodies coupled at the surface on which they touch.

The ball is reflected in the surface: with v_z = -u_z of the ball, z into it, both bodies have one axial
displacement w on the contact but for the jump that closes the gap,

    u_z (flat) = w,   v_z (ball) = w - jump,   u_z (flat) + u_z (ball) = jump,

while their radial displacements are independent, since the contact transmits no shear. With T the matrix that
gives a ball's field vector from the unknowns of both, the matrix of the pair is K_flat + T^T K_ball T.
"""

import numpy as np
import scipy.sparse as sp

from .axisymmetric import Discretisation
from .linear_system import Constrained, constrained_solve
from .scaling import LayeredSolid

Body = tuple[LayeredSolid, Discretisation]


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
