"""Displacement of the solid under prescribed surface tractions of harmonic 0 or 1.

A pressure p(r) loads harmonic 0. A traction q(r) in +x loads harmonic 1,

    q_r = q cos(theta),   q_theta = -q sin(theta),   virtual work  int q (U - V) r dr = int q (S - 2 V) r dr,

so sliding friction q = f p needs no third dimension.
"""

from collections.abc import Callable

import numpy as np

from .axisymmetric import Discretisation
from .linear_system import constrained_solve
from .scaling import LayeredSolid

__all__ = ["resultant", "solve_traction"]

Traction = Callable[[np.ndarray], np.ndarray]


def resultant(discretisation: Discretisation, traction: Traction) -> float:
    """Total force 2 pi int traction(r) r dr over the surface inside the mesh's contact radius."""
    d = discretisation
    return float(2 * np.pi * d.surface_load(_inside(d), traction).sum())


def solve_traction(
    discretisation: Discretisation, solid: LayeredSolid, harmonic: int, traction: Traction
) -> np.ndarray:
    """Field vector (see ``axisymmetric``) under ``traction`` within the mesh's contact radius.

    traction : r -> pressure (harmonic 0) or traction in +x (harmonic 1)
    """
    d, N = discretisation, discretisation.N
    force = d.surface_load(_inside(d), traction)
    far_displacement = solid.far_displacement if harmonic == 0 else solid.far_sliding
    far = 2 * np.pi * force.sum() * far_displacement(*d.locations[:, d.outer])
    zero = np.zeros(N)
    if harmonic == 0:
        load = np.concatenate([zero, force])
        fixed_fields: tuple[tuple[int, np.ndarray], ...] = ((0, far[0]), (1, far[1]))
        on_axis: tuple[int, ...] = (0,)
    else:
        load = np.concatenate([force, -2 * force, zero])
        fixed_fields = ((0, far[0] + far[1]), (1, far[1]), (2, far[2]))
        on_axis = (0, 2)
    given = np.zeros(load.size)
    for field, values in fixed_fields:
        given[field * N + d.outer] = values
    for field in on_axis:
        given[field * N + d.axis] = 0.0
    K = d.skeleton(solid.materials, harmonic)
    fixed = [field * N + d.outer for field, _ in fixed_fields] + [field * N + d.axis for field in on_axis]
    fixed.append(K.inner.ravel())
    solved = constrained_solve(K.matrix, given, np.concatenate(fixed), load)
    return K.extended(solved.u)


def _inside(d: Discretisation) -> np.ndarray:
    a = d.mesh.contact_radius
    return d.facets(lambda x: (x[1] == 0) & (x[0] < a))
