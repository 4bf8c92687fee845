"""Invariants of deformation: perfect bonds, Hooke's law, the sphere's shape under the contact."""

from typing import Any

import numpy as np
from scipy.special import ellipk

from verification.judging.invariant_verdict import Invariant, decide, layer_name
from verification.judging.invariants.central_differences import Stencil
from verification.judging.invariants.companion_uncertainty import INNER, followed
from verification.problem.array_types import Array
from verification.problem.coated_contact import CoatedContact, ContactSolution, PrescribedLoad
from verification.problem.either_body import on_body
from verification.problem.gauss_legendre import gauss_legendre
from verification.problem.point_answers import Points

RADII = np.array([0.0, 0.5, 0.9, 1.4])
ANGLE = 0.35
# Of the thinner neighbour; a tenth of a per cent curves a displacement by 1e-6 of its change in the layer.
STEP = 1e-3
# What an evaluation leaves of a displacement in a layer: of the approach, and in the outermost coating of the
# deflection of a half-space of its material, of which a film is what the layers below take away.
EVALUATED = 2e-8
# What it leaves of a displacement at one place, of the approach; places above each other share it.
AT_ONE_PLACE = 3e-9


def bonded_traction(solution: ContactSolution, source: str, problem: CoatedContact, k: int) -> Invariant:
    """sigma_xz, sigma_yz and sigma_zz are the same on both sides of interface ``k``, from 1."""
    x, y, z = _line(solution, problem, k)
    (upper, U_upper), (lower, U_lower) = (
        solution.sample(Points(x, y, z, layer), "stress") for layer in (k - 1, k)
    )
    jump = (upper - lower)[:, 2] / problem.p_h
    bound = None if U_upper is None or U_lower is None else (U_upper + U_lower)[:, 2] / problem.p_h
    law = f"sigma_xz, sigma_yz, sigma_zz pass interface {k} unchanged, over p_h"
    return decide(f"bonded tractions, interface {k}", source, law, jump, bound)


def bonded_displacement(solution: ContactSolution, source: str, problem: CoatedContact, k: int) -> Invariant:
    """u is the same on both sides of interface ``k``, extrapolated from three depths on each side.

    Bounded by the uncertainty of displacements on both sides, the change by the third depth, and below the
    outermost coating plus what an evaluation leaves.
    """
    x, y, z = _line(solution, problem, k)
    thickness = [h for _, _, h in problem.coatings] + [solution.contact_radius]
    step = STEP * min(thickness[k - 1], thickness[k])
    at, error = [], np.zeros((3, x.size))
    for sign in (-1.0, 1.0):
        u = [solution.displacement(x, y, z + sign * n * step) for n in (1, 2, 3)]
        line, parabola = 2 * u[0] - u[1], 3 * u[0] - 3 * u[1] + u[2]
        at.append(parabola)
        error = error + np.abs(parabola - line)
    U, bound = displacement_bound(solution, problem, x, y, z, given_pressure=True), None
    if U is not None:
        E, nu, _ = problem.coatings[0]
        alone = np.pi / 2 * (1 - nu**2) / E * solution.peak_pressure * solution.contact_radius
        bound = (error + 2 * U + (EVALUATED * alone if k == 1 else 0.0)) / solution.approach
    law = f"u passes interface {k} unchanged, over the approach"
    gap = (at[0] - at[1]) / solution.approach
    return decide(f"bonded displacements, interface {k}", source, law, gap, bound)


def hooke(
    solution: ContactSolution, source: str, problem: CoatedContact, layer: int, stencil: Stencil
) -> Invariant:
    """E eps_ij = (1 + nu) sigma_ij - nu sigma_kk delta_ij in ``layer``, strains by differences of u.

    Bounded by the error of the differences and of the evaluation of displacements, which differs between
    places beside each other, plus twice the uncertainty of the stresses, once for the stresses and once,
    over E, for the strains.
    """
    x, y, z = stencil.points
    E, nu = ([c[:2] for c in problem.coatings] + [problem.substrate])[layer]
    u = solution.displacement(x, y, z)
    gradient, error = stencil.gradient(u)
    strain = (gradient + gradient.swapaxes(0, 1)) / 2
    x, y, z = stencil.place
    sigma, U = solution.sample(Points(x, y, z, layer), "stress")
    unit = np.eye(3)[:, :, None]
    residual = E * strain - (1 + nu) * sigma + nu * unit * np.trace(sigma)
    bound = None
    if U is not None:
        left = stencil.propagated(np.full(u.shape, AT_ONE_PLACE * solution.approach))[:2].max(axis=(0, 1))
        # the estimate of a single component may vanish by chance
        error = error.max(axis=(0, 1)) + left
        bound = (E * error + 2 * (1 + nu) * U + 2 * abs(nu) * unit * np.trace(U)) / problem.p_h
    name = layer_name(layer, problem)
    law = f"E eps = (1 + nu) sigma - nu tr sigma in {name}, over p_h"
    return decide(f"Hooke's law, {name}", source, law, residual / problem.p_h, bound)


def sphere(solution: ContactSolution, source: str, problem: CoatedContact) -> Invariant:
    """The surface follows the sphere: u_z + r^2/2R = delta in the contact, more outside.

    u_z is the sum of both bodies' where the ball is elastic. At right angles to sliding, where friction lifts
    nothing. Bounded by the uncertainties of the approach and of displacements.
    """
    inside, outside = np.array([0.0, 0.25, 0.5, 0.75, 0.95]), np.array([1.05, 1.2, 1.6])
    y = solution.contact_radius * np.concatenate([inside, outside])
    zero = np.zeros_like(y)
    bodies = [(on_body(solution, body), problem.seen_from(body)) for body in problem.bodies]
    u = sum(one.displacement(zero, y, zero)[2] for one, _ in bodies)
    gap = (u + y**2 / (2 * problem.radius) - solution.approach) / solution.approach
    residual = np.where(y <= solution.contact_radius, gap, np.minimum(gap, 0.0))
    stated, bound = solution.sample(None, "approach").uncertainty, None
    if stated is not None:
        U = sum(displacement_bound(one, seen, zero, y, zero) for one, seen in bodies)
        bound = (stated + U) / solution.approach
    law = "u_z + r^2/2R = approach in the contact, no less outside, over the approach"
    return decide("sphere", source, law, residual, bound)


def reciprocity(solution: ContactSolution, source: str, problem: CoatedContact) -> Invariant:
    """Betti's reciprocity of normal and tangential load.

    On the surface u_z is odd in x by the tangential load alone, u_x by the normal load alone, and
    odd part of u_z = -f times odd part of u_x, since q = f p.
    """
    x = solution.contact_radius * np.array([0.3, 0.6, 0.9, 1.3, 2.0])
    y = 0.2 * x
    zero = np.zeros_like(x)
    ahead, behind = (solution.displacement(side * x, y, zero) for side in (1.0, -1.0))
    odd = (ahead - behind) / 2
    U, bound = displacement_bound(solution, problem, x, y, zero, given_pressure=True), None
    if U is not None:
        bound = (1 + problem.friction) * U / solution.approach
    law = "u_z odd in x, by sliding, is -f times u_x odd in x, by the load; over the approach"
    residual = (odd[2] + problem.friction * odd[0]) / solution.approach
    return decide("reciprocity of load and sliding", source, law, residual, bound)


def displacement_bound(
    solution: ContactSolution,
    problem: CoatedContact | PrescribedLoad,
    x: Array,
    y: Array,
    z: Array,
    *,
    given_pressure: bool = False,
) -> Any:
    """Uncertainty of displacements at points [m]: that of the approach, plus the displacement under U_p,

        u(r) = 4/(pi E*) int U_p(s) K(m) s/(r+s) ds,   m = 4 r s/(r+s)^2

    on the half-space of the most compliant material, with K the complete elliptic integral, Johnson (3.96),
    plus, where a solution has coarser companions, their change, which then replaces U_p near the edge. For an
    invariant that holds under any pressure, ``given_pressure``, U_p does not enter. None where no uncertainty
    is stated.
    """
    stated = solution.sample(None, "approach").uncertainty
    if stated is None:
        return None
    U = np.full(np.shape(x), float(stated))
    change = followed(solution, lambda s: s.displacement(x, y, z))
    if not given_pressure:
        U += _under_uncertainty(solution, problem, x, y, 1.0 if change is None else INNER)
    return U if change is None else U + change.max(axis=0)


def _under_uncertainty(
    solution: ContactSolution, problem: CoatedContact | PrescribedLoad, x: Array, y: Array, reach: float
) -> Array:
    """Displacement under U_p [m] of the part of the contact within ``reach`` of its radius."""
    a = solution.contact_radius
    t, w = gauss_legendre(64)
    phi = np.pi / 4 * (t + 1)
    # The uncertainty is largest at the edge, and extends beyond it.
    s = a * np.concatenate([np.sin(phi), 1 + 0.05 * (t + 1)])
    weight = a * np.concatenate([np.pi / 4 * w * np.cos(phi), 0.05 * w])
    U = solution.sample(Points(s * np.cos(ANGLE), s * np.sin(ANGLE)), "pressure").uncertainty
    if reach < 1:
        U = np.where(s < reach * a, U, 0.0)
    E_star = min(E / (1 - nu**2) for E, nu in [c[:2] for c in problem.coatings] + [problem.substrate])
    r = np.hypot(x, y)
    along = r[:, None] + s
    deflection = (ellipk(4 * r[:, None] * s / along**2) * s / along) @ (weight * U)
    return 4 / (np.pi * E_star) * deflection


def _line(solution: ContactSolution, problem: CoatedContact, k: int) -> tuple[Array, Array, Array]:
    r = solution.contact_radius * RADII
    return r * np.cos(ANGLE), r * np.sin(ANGLE), np.full(r.shape, problem.interfaces[k - 1])
