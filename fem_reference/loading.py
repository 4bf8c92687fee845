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
    return float(2 * np.pi * discretisation.contact_load(traction).sum())


def solve_traction(
    discretisation: Discretisation, solid: LayeredSolid, harmonic: int, traction: Traction
) -> np.ndarray:
    """Field vector (see ``axisymmetric``) under ``traction`` within the mesh's contact radius.

    traction : r -> pressure (harmonic 0) or traction in +x (harmonic 1)
    """
    d = discretisation
    force = d.contact_load(traction)
    zero = np.zeros(d.N)
    if harmonic == 0:
        load, on_axis = np.stack([zero, force]), [0]
    else:
        load, on_axis = np.stack([force, -2 * force, zero]), [0, 2]
    given, fixed = np.zeros(load.shape), np.zeros(load.shape, dtype=bool)
    given[:, d.outer] = solid.far_fields(harmonic, 2 * np.pi * force.sum(), d.locations[:, d.outer])
    for field in on_axis:
        given[field, d.axis], fixed[field, d.axis] = 0.0, True
    fixed[:, d.outer] = True
    K = d.skeleton(solid.materials, harmonic)
    fixed.reshape(-1)[K.inner] = True
    return K.extended(constrained_solve(K.matrix, given.ravel(), np.flatnonzero(fixed), load.ravel()).u)
