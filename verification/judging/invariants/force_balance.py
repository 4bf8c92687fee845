"""Invariants of forces: load balance, surface tractions, equilibrium inside each layer."""

import numpy as np

from verification.judging.invariant_verdict import Invariant, decide, layer_name
from verification.judging.invariants.central_differences import Stencil
from verification.judging.invariants.companion_uncertainty import INNER, followed
from verification.problem.array_types import Array
from verification.problem.coated_contact import CoatedContact, ContactSolution
from verification.problem.gauss_legendre import gauss_legendre
from verification.problem.point_answers import Points

# Of the contact radius.
SURFACE = np.array([-1.2, -0.9, -0.5, 0.0, 0.25, 0.5, 0.75, 0.9, 1.1, 1.3])
# Off the mirror planes of a square grid.
ANGLE = 0.35
# The field varies over its distance from the contact edge; four steps stay within an eighth of that.
PART_OF_REACH = 1 / 32


def load_balance(solution: ContactSolution, source: str, problem: CoatedContact) -> Invariant:
    """Load balance: int p dA = W, out to 1.1 a.

    Bounded by the integral of the pressure's uncertainty, near the edge by the change over coarser companions
    where that is less, plus the change by a coarser quadrature.
    """
    fine, coarse = (_load(solution, problem, n) for n in (40, 28))
    bound = None
    if fine[1] is not None:
        bound = fine[1]
        change = followed(solution, lambda s: np.array(_load(s, problem, 40)[0]))
        if change is not None:
            bound = min(bound, (_load(solution, problem, 40, INNER)[1] or 0.0) + float(change))
        bound += abs(fine[0] - coarse[0])
    return decide("load balance", source, "int p dA = W, over W", fine[0] - 1, bound)


def _load(
    solution: ContactSolution, problem: CoatedContact, n: int, reach: float = np.inf
) -> tuple[float, float | None]:
    """int p dA and, within ``reach`` of a, int U_p dA over W, None where none is stated.

    By Gauss points in phi of r = a sin(phi) and in an outer ring.
    """
    a = solution.contact_radius
    s, w = gauss_legendre(n)
    phi = np.pi / 4 * (s + 1)
    ring = a * (1 + 0.05 * (s + 1))
    r = np.concatenate([a * np.sin(phi), ring])
    weight = np.concatenate([np.pi / 4 * w * a**2 * np.sin(phi) * np.cos(phi), 0.05 * a * w * ring])
    turn = 2 * np.pi * (np.arange(8) + 0.3) / 8
    x, y = r[:, None] * np.cos(turn), r[:, None] * np.sin(turn)
    weight = weight[:, None] * 2 * np.pi / 8 / problem.load
    p, U = solution.sample(Points(x, y), "pressure")
    within = np.where(r < reach * a, 1.0, 0.0)[:, None]
    return float((weight * p).sum()), None if U is None else float((weight * within * U).sum())


def surface(solution: ContactSolution, source: str, problem: CoatedContact) -> tuple[Invariant, ...]:
    """sigma_zz = -p, sigma_xz = -f p, sigma_yz = 0 in the contact; no traction outside it.

    On y = 0 and at ``ANGLE`` from it, at the same radii, where a circumferential traction shows too. Bounded
    by the uncertainties of stress and pressure at the same points, on y = 0 nodes of the solution.
    """
    x = solution.contact_radius * SURFACE
    nodes = solution.surface_nodes
    x = nodes[np.abs(nodes[:, None] - x).argmin(axis=0)]
    inside = np.tile(np.abs(x) < solution.contact_radius, 2)
    x, y = np.outer([1.0, np.cos(ANGLE)], x).ravel(), np.outer([0.0, np.sin(ANGLE)], x).ravel()
    f, p_h = problem.friction, problem.p_h
    p, Up = solution.sample(Points(x, y), "pressure")
    stress, spread = solution.sample(Points(x, y, 0.0, 0), "stress")
    p = p / p_h
    sigma = stress[:, 2] / p_h
    normal, shear = sigma[2] + p, np.stack([sigma[0] + f * p, sigma[1]])
    free = np.concatenate([sigma, p[None]])
    bounds: list[Array | None] = [None, None, None]
    if spread is not None:
        U, Up = spread[:, 2] / p_h, Up / p_h
        bounds = [
            (U[2] + Up)[inside],
            np.stack([U[0] + f * Up, U[1]])[:, inside],
            np.concatenate([U, Up[None]])[:, ~inside],
        ]
    laws = (
        ("surface pressure", "sigma_zz = -p at z = 0, over p_h", normal[inside]),
        ("surface shear", "sigma_xz = -f p, sigma_yz = 0 at z = 0, over p_h", shear[:, inside]),
        ("free surface", "no traction outside the contact, over p_h", free[:, ~inside]),
    )
    return tuple(decide(n, source, law, r, bound) for (n, law, r), bound in zip(laws, bounds, strict=True))


def places_in(layer: int, solution: ContactSolution, problem: CoatedContact) -> Stencil:
    """Stencils under the contact, in the substrate also beside it, with steps that stay inside ``layer``."""
    a = solution.contact_radius
    top = (0.0, *problem.interfaces)[layer]
    coated = layer < len(problem.coatings)
    thickness = problem.coatings[layer][2] if coated else 2 * a
    r = a * (np.array([0.5]) if coated else np.array([0.5, 1.3]))
    z = np.full(r.shape, top + 0.4 * thickness)
    across = PART_OF_REACH * np.hypot(r - a, z)
    # The same for both places, since every further depth costs an evaluation.
    down = np.full(r.shape, min(across.min(), 0.08 * thickness))
    return Stencil(np.stack([r * np.cos(ANGLE), r * np.sin(ANGLE), z]), np.stack([across, across, down]))


def equilibrium(
    solution: ContactSolution, source: str, problem: CoatedContact, layer: int, stencil: Stencil
) -> Invariant:
    """sigma_ij,j = 0 inside ``layer``, as the force on a slab of the vertical step's height.

    Bounded by the error of the differences, the largest of the three equations since in one of them it may
    pass through zero, plus the propagated uncertainty of the stresses, at each point the largest of the
    places and of the farthest points at their depth.
    """
    x, y, z = stencil.points
    height = stencil.step[2] / problem.p_h
    gradient, error = stencil.gradient(solution.stress(x, y, z, layer=layer))
    force = np.einsum("jijn->in", gradient) * height
    cx, cy, cz = stencil.corners
    corners, bound = solution.sample(Points(cx, cy, cz, layer), "stress").uncertainty, None
    if corners is not None:
        U = np.broadcast_to(corners.max(axis=-1, keepdims=True), (3, 3, x.size))
        differences = np.einsum("jijn->in", error).max(axis=0)
        bound = (np.einsum("jijn->in", stencil.propagated(U)) + differences) * height
    name = layer_name(layer, problem)
    law = f"div sigma = 0 in {name}, times the step over p_h"
    return decide(f"equilibrium, {name}", source, law, force, bound)
