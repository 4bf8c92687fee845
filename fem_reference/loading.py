"""Displacement of the solid under surface tractions of harmonic 0 or 1, or pressed down on the contact.

A pressure p(r) loads harmonic 0. A traction q(r) in +x loads harmonic 1,

    q_r = q cos(theta),   q_theta = -q sin(theta),   virtual work  int q (U - V) r dr = int q (S - 2 V) r dr,

so sliding friction q = f p needs no third dimension.
"""

from collections.abc import Callable

import numpy as np

from .axisymmetric import Discretisation
from .linear_system import Constrained, constrained_solve
from .scaling import LayeredSolid


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
