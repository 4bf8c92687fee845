"""The contact radius and the load of a contact, from the compliance of its layers and the exact reference."""

from collections.abc import Callable
from functools import lru_cache
from math import exp, log

import numpy as np

from verification.problem.coated_contact import CoatedContact
from verification.sources.exact_sources import solve_exactly
from verification.sources.references.solids_in_contact import (
    combined_modulus,
    compliance,
    radius_estimate,
    solids_of,
)

MOST, CLOSE = 40, 1e-12  # solves for one load; relative error of the approach that ends them
HERTZ = 1.5  # d ln W / d ln delta of Hertz, from which that of layers differs by less than a factor of two


@lru_cache(maxsize=64)
def own_radius(problem: CoatedContact) -> float:
    """Contact radius [m] to some per cent, its layers included; of a contact without layers Hertz's.

    Of an indenter that is no sphere that of the sphere of ``problem.radius``.
    """
    if problem.homogeneous:
        return problem.a_h
    solids = solids_of(problem.coatings, problem.substrate, problem.ball)
    return radius_estimate(problem.radius, problem.load, combined_modulus(solids), solids)


def load_of_approach(approach: float, contact: Callable[[float], CoatedContact]) -> float:
    """Load [N] under which the sphere has this ``approach`` [m], by the integral equation, in twelve digits.

    contact : the problem under a load [N], on which its thicknesses may depend.
    Raises ValueError where no load is found.
    """
    load = 1.0
    for _ in range(3):  # the layers' own thicknesses may depend on the load
        load = _estimate(approach, contact(load))
    known: list[tuple[float, float]] = []  # ln W, ln of the approach over the one given
    for _ in range(MOST):
        found = solve_exactly(contact(load), {"estimate_uncertainty": False})
        known.append((log(load), log(found.approach / approach)))
        if abs(known[-1][1]) < CLOSE:
            return float(f"{load:.12g}")  # the same on every machine
        slope = HERTZ
        if len(known) > 1:
            (W, gap), (W_before, gap_before) = known[-1], known[-2]
            slope = (W - W_before) / (gap - gap_before) if gap != gap_before else HERTZ
        load = exp(known[-1][0] - min(max(slope, 0.5 * HERTZ), 2 * HERTZ) * known[-1][1])
    raise ValueError(f"approach = {approach:g} m is reached under no load near {load:g} N; check the moduli")


def _estimate(approach: float, problem: CoatedContact) -> float:
    """Hertz's load for the modulus that waves as long as the contact see."""
    solids = solids_of(problem.coatings, problem.substrate, problem.ball)
    E_star, a = combined_modulus(solids), (problem.radius * approach) ** 0.5
    M = float(compliance(solids, E_star, np.array([2 / a]))[0])
    return 4 / 3 * E_star / M * a * approach
