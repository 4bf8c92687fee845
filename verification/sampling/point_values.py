"""Quantities of a solution at any points of the solid."""

from dataclasses import replace
from typing import cast

import numpy as np

from verification.problem.array_types import Array
from verification.problem.coated_contact import CoatedContact, ContactSolution, PrescribedLoad
from verification.problem.evaluation_points import TablePoints
from verification.problem.loading_curve import LoadingCurve
from verification.problem.point_answers import EDGE, FIXED, Points
from verification.problem.quantity import EXTREMES, QUANTITIES
from verification.sampling.largest_tension import BESIDE
from verification.sources.loading_solution import Loading


def values(
    solution: ContactSolution | Loading,
    quantity: str,
    at: TablePoints,
    problem: CoatedContact | PrescribedLoad | LoadingCurve,
    series: tuple[float, ...] = (),
    edge: float | None = None,
) -> tuple[Array, Array | None]:
    """``quantity`` [SI, tension positive] of a solution at points, with its uncertainty if one is stated.

        eps_ij = [(1 + nu) sigma_ij - nu sigma_kk delta_ij] / E

    series : coefficients, where the quantity asks for some.   edge : exact contact radius [m], beside which
    points are taken at the same share of the way to the solution's own edge; None for none.
    """
    if isinstance(problem, LoadingCurve):
        of_curve = replace(cast(Loading, solution), series=series).sample(Points(at.along), quantity)
        return of_curve.value, of_curve.uncertainty
    assert not isinstance(solution, Loading)
    if quantity in EXTREMES:
        return _everywhere(at, *_extreme(solution, quantity))
    record = QUANTITIES[quantity]
    if record.kind == "scalar":
        return _everywhere(at, *solution.sample(None, quantity))
    if quantity == "pressure":
        p, U = solution.sample(_beside_edge(solution, at, edge), "pressure")
        return p, U
    if record.kind == "displacement":
        i = "xyz".index(quantity[-1])
        u, U = solution.sample(Points(at.x, at.y, at.z), "displacement")
        return u[i], None if U is None else U[i]
    value, uncertainty, stated = np.empty(at.x.shape), np.empty(at.x.shape), True
    moduli = [(E, nu) for E, nu, _ in problem.coatings] + [problem.substrate]
    for layer in sorted(set(at.layer.tolist())):
        here = np.flatnonzero(at.layer == layer)
        weight = _weights(quantity, *moduli[layer])
        places = replace(_beside_edge(solution, at.part(here.tolist()), edge), layer=layer)
        sigma, U = solution.sample(places, "stress")
        value[here] = np.einsum("ij,ij...->...", weight, sigma)
        stated = U is not None
        if stated:
            uncertainty[here] = np.einsum("ij,ij...->...", np.abs(weight), U)
    return value, uncertainty if stated else None


def _everywhere(at: TablePoints, value: float, U: float | None) -> tuple[Array, Array | None]:
    return np.full(at.x.shape, value), None if U is None else np.full(at.x.shape, U)


def _beside_edge(solution: ContactSolution, at: TablePoints, edge: float | None) -> Points:
    """The points, those beside the exact ``edge`` [m] at the same share of the way to the solution's own.

    At a fixed x next to the edge an error da of the radius changes the pressure by q sqrt(2 da/a), whatever
    the method; the radius is a quantity of its own.
    """
    if edge is None:
        return Points(at.x, at.y, at.z)
    near = np.hypot(np.hypot(at.x, at.y) - edge, at.z) <= BESIDE * edge
    ratio = np.where(near, float(solution.contact_radius) / edge, 1.0)
    return Points(at.x * ratio, at.y * ratio, at.z, frame=np.where(near, EDGE, FIXED))


def _extreme(solution: ContactSolution, quantity: str) -> tuple[float, float | None]:
    """The largest weighted sum of stresses on the axis, where a parabola through three points has its top."""
    z = solution.contact_radius * np.linspace(0.3, 0.7, 21)
    weights = np.array(QUANTITIES[quantity].weights)
    along = np.abs(np.einsum("i,iij->j", weights, solution.stress(0.0, 0.0, z)))
    top = int(np.clip(along.argmax(), 1, z.size - 2))
    low, here, high = along[top - 1 : top + 2].tolist()
    value = here + (high - low) ** 2 / (8 * (2 * here - low - high))
    U = solution.sample(Points(0.0, 0.0, z[[top]]), "stress").uncertainty
    return value, None if U is None else float(np.einsum("i,iij->j", np.abs(weights), U)[0])


def _weights(quantity: str, E: float, nu: float) -> Array:
    """The quantity as a sum of weights times stresses, (3, 3)."""
    record = QUANTITIES[quantity]
    if record.weights is not None:
        return np.diag(record.weights)
    weight = np.zeros((3, 3))
    weight[record.component] = 1.0
    return weight if record.kind == "stress" else ((1 + nu) * weight - nu * np.eye(3)) / E
