"""Invariants of a contact under an indenter that is no sphere: its gap and its load."""

import numpy as np

from verification.judging.invariant_verdict import Invariant, decide
from verification.problem.array_types import Array
from verification.problem.coated_contact import CoatedContact, ContactSolution
from verification.problem.gauss_legendre import gauss_legendre
from verification.problem.indenter_shape import height_of
from verification.problem.point_answers import Points

WIDEST = 4.0  # of the contact radius: no contact beyond
RINGS, ANGLES = 60, 96  # of the quadrature over the plane
PLACES = 2.0 * (np.arange(9) + 0.5) / 9  # of the contact radius, at each of ``TURNS``
TURNS = np.pi * np.array([0.03, 0.21, 0.47, 0.68, 0.93])
CLEAR = 0.2  # of the contact radius around a point where the contact neither begins nor ends


def gap(solution: ContactSolution, source: str, problem: CoatedContact) -> Invariant:
    """The surface follows the indenter: u_z + height = approach in the contact, no less outside.

    Away from the edge, without the part of u_z that sliding adds, which is odd in x and left out of the gap.
    Bounded by the uncertainties of the approach and of displacements.
    """
    a, least = solution.contact_radius, 1e-6 * solution.peak_pressure
    r, theta = (v.ravel() for v in np.meshgrid(a * PLACES, TURNS))
    turn = np.linspace(0, 2 * np.pi, 9)
    x, y = r * np.cos(theta), r * np.sin(theta)
    beside = solution.pressure(x[:, None] + CLEAR * a * np.cos(turn), y[:, None] + CLEAR * a * np.sin(turn))
    loaded = np.greater(beside, least)
    inside, outside = np.all(loaded, axis=1), np.all(~loaded, axis=1)
    clear = np.flatnonzero(inside | outside)
    x, y, inside = x[clear], y[clear], np.asarray(inside)[clear]
    lifted: Array | float = 0.0
    bound: Array | float | None = solution.sample(None, "approach").uncertainty
    for body in problem.bodies:
        u, U = solution.sample(Points(x, y, body=body), "displacement")
        if problem.friction:
            opposite = solution.sample(Points(-x, y, body=body), "displacement", False).value
            u = (u + opposite) / 2
        lifted = lifted + u[2]
        bound = None if bound is None or U is None else bound + U[2]
    left = (
        lifted + height_of(problem.indenter, problem.radius)(x, y) - solution.approach
    ) / solution.approach
    residual = np.where(inside, left, np.minimum(left, 0.0))
    bound = None if bound is None else bound / solution.approach
    law = "u_z + height = approach in the contact, no less outside, over the approach"
    return decide("indenter", source, law, residual, bound)


def load_balance(solution: ContactSolution, source: str, problem: CoatedContact) -> Invariant:
    """Load balance: int p dA = W, by rings around the origin; bounded by the change by a coarser quadrature.

    The pressure falls to zero like a square root at an edge that crosses the rings: twice as many rings as
    ``RINGS`` err by 5e-4, and may change by less.
    """
    fine, coarse = (_load(solution, problem, n) for n in (8, 4))
    bound = 2 * abs(fine - coarse) + 1e-4
    return decide("load balance", source, "int p dA = W, over W", fine - 1, bound)


def _load(solution: ContactSolution, problem: CoatedContact, finer: int) -> float:
    s, w = gauss_legendre(finer * RINGS)
    r = WIDEST * solution.contact_radius * (s + 1) / 2
    theta = 2 * np.pi * (np.arange(finer * ANGLES) + 0.3) / (finer * ANGLES)
    x, y = r[:, None] * np.cos(theta), r[:, None] * np.sin(theta)
    p = solution.pressure(x, y).mean(axis=1)
    return float((p * r * w).sum() * WIDEST * solution.contact_radius * np.pi / problem.load)
