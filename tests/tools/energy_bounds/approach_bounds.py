"""Stiffness of a flat punch with the approach of a paraboloid, between bounds at a fixed contact radius.

With K_ij = <p_i, w_j> of the displacements w = 1 and r^2/2R on r < a, the paraboloid's load is

    W = K_11 delta - K_12 = e.K y,   e = (1, 0), y = (delta, -1)

Displacements give U >= K, stresses L <= K as quadratic forms. With M = (U + L)/2 and D = U - L

    L_11 <= K_11 <= U_11,   |W - e.M y| <= (e.D e)^(1/2) (y.D y)^(1/2) / 2

The load rises with delta, so that delta lies between the two roots of the equality. Prager and Synge, Quart.
Appl. Math. 5 (1947) 241-269. At the radius of the contact without load at its edge this is the contact's
approach, which depends on the radius to second order only.
"""

import numpy as np

from energy_bounds.half_space_mesh import half_space
from energy_bounds.lower_bounds import lower_bound
from energy_bounds.tensor_energy import virtual_work
from energy_bounds.upper_bounds import upper_bound
from verification.evidence.enclosure_record import EnergyBounds
from verification.problem.coated_contact import CoatedContact

VIRTUAL_WORK = 1e-9  # largest relative defect of sigma : e against the pressure's work


def bound(
    problem: CoatedContact, a: float, degree: int = 6, edge: float = 1e-5, far: float = 1e8
) -> EnergyBounds:
    """Bounds of a rigid paraboloid under the load of ``problem`` at contact radius ``a`` [m].

    degree : of the polynomials.   edge : smallest piece over a.   far : end of the mesh over a.
    Raises ValueError where the mesh is too coarse for a bound of the approach, or cannot be made.
    """
    if problem.ball is not None:
        raise ValueError("bounds are of a rigid sphere; this problem has an elastic ball")
    E, nu = problem.substrate
    coatings = tuple((modulus / E, nu_i, h / a) for modulus, nu_i, h in problem.coatings)
    solid = half_space(coatings, nu, degree, edge, far)
    above = upper_bound(solid)
    below, work = lower_bound(solid)
    r, z = solid.points()
    weights = 2 * np.pi * r.place * r.weight, z.weight
    defect = np.abs(virtual_work(below.components, above.components, weights) - work).max()
    if not defect <= VIRTUAL_WORK * work[0, 0]:
        raise ValueError(f"virtual work is off by {defect / work[0, 0]:.1e}: no equilibrium")
    U = above.matrix + np.diag(above.rounding.sum(axis=1))
    L = below.matrix - np.diag(below.rounding.sum(axis=1))
    load, unit = problem.load * problem.radius / (E * a**3), a**2 / problem.radius
    low, high = approach_bounds(U, L, load)
    return EnergyBounds(
        (float(E * a * L[0, 0]), float(E * a * U[0, 0])),
        (low * unit, high * unit),
        float((load + above.matrix[0, 1]) / above.matrix[0, 0] * unit),
        float((above.rounding + below.rounding)[0].sum() / U[0, 0]),
        above.unknowns + below.unknowns,
    )


def approach_bounds(U: np.ndarray, L: np.ndarray, load: float) -> tuple[float, float]:
    """Roots of (e.M y - load)^2 = (e.D e) (y.D y)/4, lower then upper."""
    M, D = (U + L) / 2, U - L
    middle = (load + M[0, 1]) / M[0, 0]
    y = np.array([middle, -1])
    # of the distance from the middle
    A, B, C = M[0, 0] ** 2 - D[0, 0] ** 2 / 4, -D[0, 0] * (D[0] @ y) / 2, -D[0, 0] * (y @ D @ y) / 4
    if not (A > 0 and C <= 0 and D[0, 0] >= 0):
        raise ValueError("the bounds of the stiffness are too wide for one of the approach; refine the mesh")
    low, high = sorted((-B + sign * np.sqrt(B * B - 4 * A * C)) / (2 * A) for sign in (-1, 1))
    return float(middle + low), float(middle + high)
