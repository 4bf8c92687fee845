"""Quantities of a solution at any points of the solid."""

from typing import cast

import numpy as np

from verification.problem.array_types import Array
from verification.problem.coated_contact import (
    CoatedContact,
    PrescribedLoad,
    Solution,
    stress_with_uncertainty,
)
from verification.problem.evaluation_points import Points
from verification.problem.loading_curve import LoadingCurve
from verification.problem.quantity import EXTREMES, QUANTITIES
from verification.sources.loading_solution import Loading


def values(
    solution: Solution | Loading,
    quantity: str,
    at: Points,
    problem: CoatedContact | PrescribedLoad | LoadingCurve,
    series: tuple[float, ...] = (),
) -> tuple[Array, Array | None]:
    """``quantity`` [SI, tension positive] of a solution at points, with its uncertainty if one is stated.

        eps_ij = [(1 + nu) sigma_ij - nu sigma_kk delta_ij] / E

    A displacement is as uncertain as the one at the origin, where the solution's approach is taken, unless
    the solution says more. series : coefficients, where the quantity asks for some.
    """
    if isinstance(problem, LoadingCurve):
        return cast(Loading, solution).quantity(quantity, at.along, series)
    assert not isinstance(solution, Loading)
    stated = solution.uncertainty
    if quantity in EXTREMES:
        top, wide = _extreme(solution, quantity)
        return np.full(at.x.shape, top), None if wide is None else np.full(at.x.shape, wide)
    record = QUANTITIES[quantity]
    if record.kind == "scalar":
        wide = record.uncertainty(solution, problem)
        value = np.full(at.x.shape, record.value(solution, problem))
        return value, None if wide is None else np.full(at.x.shape, wide)
    if quantity == "pressure":
        p = solution.pressure(at.x, at.y)
        return p, None if stated is None else solution.pressure_uncertainty(at.x, at.y)
    if record.kind == "displacement":
        i = "xyz".index(quantity[-1])
        u = solution.displacement(at.x, at.y, at.z)[i]
        if hasattr(solution, "displacement_uncertainty"):
            return u, solution.displacement_uncertainty(at.x, at.y, at.z)[i]
        return u, None if stated is None else np.full(u.shape, float(stated.approach))
    value, uncertainty = np.empty(at.x.shape), np.empty(at.x.shape)
    moduli = [(E, nu) for E, nu, _ in problem.coatings] + [problem.substrate]
    for layer in sorted(set(at.layer.tolist())):
        here = at.layer == layer
        place = (at.x[here], at.y[here], at.z[here])
        weight = _weights(quantity, *moduli[layer])
        sigma, U = stress_with_uncertainty(solution, *place, layer=layer)
        value[here] = np.einsum("ij,ij...->...", weight, sigma)
        if U is not None:
            uncertainty[here] = np.einsum("ij,ij...->...", np.abs(weight), U)
    return value, None if stated is None else uncertainty


def _extreme(solution: Solution, quantity: str) -> tuple[float, float | None]:
    """The largest tau = |sigma_zz - sigma_xx|/2, where a parabola through three points has its top."""
    z = solution.contact_radius * np.linspace(0.3, 0.7, 21)
    sigma = solution.stress(0.0, 0.0, z)
    tau = np.abs(sigma[2, 2] - sigma[0, 0]) / 2
    top = int(np.clip(tau.argmax(), 1, z.size - 2))
    low, here, high = tau[top - 1 : top + 2].tolist()
    share = 2.0 if quantity == "von_mises_max" else 1.0
    value = share * (here + (high - low) ** 2 / (8 * (2 * here - low - high)))
    if solution.uncertainty is None:
        return value, None
    U = solution.stress_uncertainty(0.0, 0.0, z[[top]])
    return value, share * float(U[2, 2, 0] + U[0, 0, 0]) / 2


def _weights(quantity: str, E: float, nu: float) -> Array:
    """The quantity as a sum of weights times stresses, (3, 3)."""
    if quantity == "sigma_kk":
        return np.eye(3)
    if quantity == "sigma_zz - sigma_xx":
        return np.diag([-1.0, 0.0, 1.0])
    record = QUANTITIES[quantity]
    weight = np.zeros((3, 3))
    weight[record.component] = 1.0
    return weight if record.kind == "stress" else ((1 + nu) * weight - nu * np.eye(3)) / E
