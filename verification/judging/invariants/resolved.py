"""Invariants between solutions: one problem also solved scaled, with equal moduli, thick, thin, under a disc.

They need further solves, so a case has to enable them (``resolve = true``), and both methods solve on coarse
grids and meshes, whose uncertainty bounds each invariant and is capped like any other.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
from numpy.polynomial import legendre

from verification.judging.invariant import Invariant, decide, failed
from verification.judging.invariants.bond import displacement_bound
from verification.judging.invariants.limits import thick_shift, thin_shift
from verification.problem.arrays import Array
from verification.problem.contact import CoatedContact, PrescribedLoad, Solution, stress_with_uncertainty
from verification.problem.quantity import QUANTITIES, SCALARS
from verification.sources.references.hamilton import Hamilton
from verification.sources.registry import METHODS, SOURCES

Solve = Callable[[CoatedContact | PrescribedLoad], Solution]
Law = Callable[[], Invariant]

# h/a_h, so near to the limit that the remaining effect of the coating is bounded below the caps.
THICK_AT, THIN_AT = 20.0, 0.03
NAMES = ("scaling", "reciprocity", "equal moduli", "thick coating", "thin coating")
# No powers of two, so that scaled numbers share no digits.
RADIUS, LOAD, MODULUS = 2.7, 0.37, 1.9
APPROACH_CAP = 1e-3
PLACES = ((0.0, 0.45), (0.6, 0.3), (-0.6, 1.7), (1.3, 0.3))  # x, z over a_h


def resolved(
    problem: CoatedContact, available: Mapping[str, Callable[..., Solution]]
) -> tuple[Invariant, ...]:
    """Scaling, equal moduli, thick and thin limit, reciprocity of each method that is available.

    problem : with one coating at least.   available : solvers by name, as in ``run.solvers``.
    One that raises an exception is NO_RESULT with its message.
    """
    found = []
    for source in (name for name in METHODS if name in available):
        solve, record = available[source], SOURCES[source]
        coarse = partial(_solved, solve, record.coarse)
        finer = partial(_solved, solve, record.coarse_stress)
        for name, law in _laws(coarse, finer, source, problem):
            try:
                found.append(law())
            except Exception as error:  # as in ``check``, a row of the report
                found.append(failed(name, source, error))
    return tuple(found)


def _solved(
    solve: Callable[..., Solution], numerics: Mapping[str, Any], problem: CoatedContact | PrescribedLoad
) -> Solution:
    return solve(problem, numerics)


def _laws(solve: Solve, finer: Solve, source: str, problem: CoatedContact) -> Iterator[tuple[str, Law]]:
    base: list[Solution] = []

    def once(given: CoatedContact | PrescribedLoad) -> Solution:
        if not base:
            base.append(finer(given))
        return base[0]

    smooth = replace(problem, friction=0.0)
    laws = (
        partial(_scaling, finer, once, source, problem),
        partial(_reciprocity, once, solve, source, problem),
        partial(_equal_moduli, solve, source, problem),
        partial(_thick, solve, source, smooth),
        partial(_thin, finer, source, smooth),
    )
    yield from zip(NAMES, laws, strict=True)


def _scaling(solve: Solve, base: Solve, source: str, problem: CoatedContact) -> Invariant:
    """Another radius, load and modulus at the same h/a_h and E1/E2: the same dimensionless answer."""
    E, nu = problem.substrate
    scaled = CoatedContact(
        RADIUS * problem.radius, LOAD * problem.load, (), (MODULUS * E, nu), problem.friction
    )
    ratio = scaled.a_h / problem.a_h
    scaled = replace(scaled, coatings=tuple((MODULUS * E, nu, ratio * h) for E, nu, h in problem.coatings))
    one, U_one = _dimensionless(base(problem), problem)
    other, U_other = _dimensionless(solve(scaled), scaled)
    factors = f"R x {RADIUS}, W x {LOAD}, E x {MODULUS}"
    law = f"{factors} leave a/a_h, p0/p_h, approach/delta_h, sigma/p_h unchanged"
    return decide("scaling", source, law, one - other, U_one + U_other)


def _equal_moduli(solve: Solve, source: str, problem: CoatedContact) -> Invariant:
    """Coatings of the substrate's material: Hertz's contact, with friction Hamilton's."""
    coatings = tuple((*problem.substrate, h) for _, _, h in problem.coatings)
    same = replace(problem, coatings=coatings)
    exact = Hamilton(problem.radius, problem.load, *problem.substrate, problem.friction)
    found, U = _dimensionless(solve(same), same)
    known, _ = _dimensionless(exact, same)
    law = "coatings of the substrate's moduli give the closed form of the uncoated solid, over its scales"
    return decide("equal moduli", source, law, found - known, U)


def _thick(solve: Solve, source: str, problem: CoatedContact) -> Invariant:
    """A very thick coating: Hertz's contact of the coating's material, on a base that is displaced."""
    E, nu, _ = problem.coatings[0]
    alone = replace(problem, coatings=(), substrate=(E, nu))
    thick = replace(problem, coatings=((E, nu, THICK_AT * alone.a_h),))
    found = solve(thick)
    base, eta = thick_shift(thick, alone)
    scales = np.array([alone.a_h, alone.p_h, alone.delta_h])
    values = np.array([found.contact_radius, found.peak_pressure, found.approach - base]) / scales
    U = found.uncertainty
    # A gap changed by eta of the approach has a curvature changed by twice that; a and p0 vary as its powers
    # 1/3 and 2/3.
    bent = np.array([2 / 3, 4 / 3, 1.0]) * eta
    bound = np.array([U.contact_radius, U.peak_pressure, U.approach]) / scales + bent
    law = f"h = {THICK_AT:g} a_h gives Hertz of the coating, plus the displacement of the base"
    return decide("thick coating", source, law, values - 1, bound)


def _thin(solve: Solve, source: str, problem: CoatedContact) -> Invariant:
    """A very thin coating: Hertz's contact of the substrate with a first-order change of the approach.

    The second order is minus the square of the first, over the approach, to a few per cent from h = 0.01 a_h
    down; twice that is allowed.
    """
    E, nu, _ = problem.coatings[0]
    thin = replace(problem, coatings=((E, nu, THIN_AT * problem.a_h),))
    found = solve(thin)
    first = thin_shift(thin) / thin.delta_h
    gap = found.approach / thin.delta_h - 1 - first
    law = f"h = {THIN_AT:g} a_h gives the approach of Hertz of the substrate but for its first-order change"
    bound = found.uncertainty.approach / thin.delta_h + 2 * first**2
    return decide("thin coating", source, law, gap, bound, cap=APPROACH_CAP)


def _reciprocity(base: Solve, solve: Solve, source: str, problem: CoatedContact) -> Invariant:
    """Betti's reciprocity of the contact with a uniform disc: int p u_disc dA = int p_disc u dA.

    Over W times the approach, along x = 0, where friction causes no u_z.
    """
    contact = base(problem)
    disc = problem.under_disc(problem.p_h, 0.6 * contact.contact_radius)
    pressed = solve(disc)
    work = problem.load * contact.approach

    def works(n: int) -> tuple[float, float]:
        t, w = legendre.leggauss(n)
        phi = np.pi / 4 * (t + 1)
        r = contact.contact_radius * np.sin(phi)
        area = 2 * np.pi * r * contact.contact_radius * np.pi / 4 * w * np.cos(phi) / work
        s = disc.load_radius * (t + 1) / 2
        patch = np.pi * s * disc.load_radius * w / work
        p, U_p = contact.pressure(0 * r, r), contact.pressure_uncertainty(0 * r, r)
        u_disc, u = _surface_displacement(pressed, r), _surface_displacement(contact, s)
        U = area @ (U_p * np.abs(u_disc) + p * displacement_bound(pressed, disc, 0 * r, r, 0 * r))
        U += disc.pressure * patch @ displacement_bound(contact, problem, 0 * s, s, 0 * s)
        return float(area @ (p * u_disc) - disc.pressure * patch @ u), float(U)

    (gap, bound), (coarser, _) = works(32), works(24)
    law = "int p u_disc dA = int p_disc u dA with a uniform disc, over W times the approach"
    return decide("reciprocity", source, law, gap, bound + abs(gap - coarser))


def _surface_displacement(solution: Solution, y: Array) -> Array:
    return solution.displacement(np.zeros_like(y), y, np.zeros_like(y))[2]


def _dimensionless(solution: Solution, problem: CoatedContact) -> tuple[Array, Array]:
    """a/a_h, p0/p_h, approach/delta_h and the stresses over p_h at ``PLACES``, with their uncertainties."""
    scalars = [(QUANTITIES[name], getattr(problem, QUANTITIES[name].scale)) for name in SCALARS]
    x, z = problem.a_h * np.array(PLACES).T
    y = 0.2 * np.abs(x)
    values = [quantity.value(solution, problem) / scale for quantity, scale in scalars]
    U = [(quantity.uncertainty(solution, problem) or 0.0) / scale for quantity, scale in scalars]
    sigma, U_sigma = stress_with_uncertainty(solution, x, y, z)
    if U_sigma is None:
        raise ValueError("states no uncertainty that would bound the invariant")
    over = [(field / problem.p_h).ravel() for field in (sigma, U_sigma)]
    return np.concatenate([values, over[0]]), np.concatenate([U, over[1]])
