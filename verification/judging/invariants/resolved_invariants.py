"""Invariants between solutions: one problem also solved scaled, with equal moduli, thick, thin, under a disc.

Of an elastic ball also with the bodies exchanged, equal, the ball nearly rigid, in place of thick and thin.

They need further solves, so a case has to enable them (``resolve = true``), and both methods solve on coarse
grids and meshes, whose uncertainty bounds each invariant and is capped like any other.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from verification.judging.invariant_verdict import Invariant, decide, failed
from verification.judging.invariants.bonded_deformation import displacement_bound
from verification.judging.invariants.thickness_limits import thick_shift, thin_shift
from verification.problem.array_types import Array, Ball, Coatings
from verification.problem.coated_contact import CoatedContact, ContactSolution, PrescribedLoad
from verification.problem.either_body import on_body
from verification.problem.gauss_legendre import gauss_legendre
from verification.problem.point_answers import BALL, FLAT, Points
from verification.problem.quantity import QUANTITIES, SCALARS
from verification.sources.references.hertz import Hertz
from verification.sources.source_registry import METHODS, SOURCES

Solve = Callable[[CoatedContact | PrescribedLoad], ContactSolution]
Law = Callable[[], Invariant]

# h/a_h, so near to the limit that the remaining effect of the coating is bounded below the caps.
THICK_AT, THIN_AT = 20.0, 0.03
LIMITS = ("thick coating", "thin coating")
BALL_NAMES = ("bodies exchanged", "coating on the ball", "equal bodies", "rigid ball")
NAMES = ("scaling", "reciprocity", "equal moduli", *LIMITS, *BALL_NAMES)
# No powers of two, so that scaled numbers share no digits.
RADIUS, LOAD, MODULUS = 2.7, 0.37, 1.9
APPROACH_CAP = 1e-3
RIGID = 1e8  # E of a ball over that of the flat, beyond which it is rigid to as many digits
PLACES = ((0.0, 0.45), (0.6, 0.3), (-0.6, 1.7), (1.3, 0.3))  # x, z over a_h


def resolved(
    problem: CoatedContact, available: Mapping[str, Callable[..., ContactSolution]]
) -> tuple[Invariant, ...]:
    """Scaling, equal moduli, reciprocity, the limits of the coating or of the ball, of each available method.

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
    solve: Callable[..., ContactSolution],
    numerics: Mapping[str, Any],
    problem: CoatedContact | PrescribedLoad,
) -> ContactSolution:
    return solve(problem, numerics)


def _laws(solve: Solve, finer: Solve, source: str, problem: CoatedContact) -> Iterator[tuple[str, Law]]:
    base: list[ContactSolution] = []

    def once(given: CoatedContact | PrescribedLoad) -> ContactSolution:
        if not base:
            base.append(finer(given))
        return base[0]

    smooth = replace(problem, friction=0.0)
    laws = {
        "scaling": partial(_scaling, finer, once, source, problem),
        "reciprocity": partial(_reciprocity, once, solve, source, problem),
        "equal moduli": partial(_equal_moduli, solve, source, problem),
        "thick coating": partial(_thick, solve, source, smooth),
        "thin coating": partial(_thin, finer, source, smooth),
        "bodies exchanged": partial(_exchanged, once, finer, source, problem),
        "coating on the ball": partial(_coating_on_ball, finer, source, problem),
        "equal bodies": partial(_equal_bodies, solve, source, smooth),
        "rigid ball": partial(_rigid_ball, finer, source, problem),
    }
    assert tuple(laws) == NAMES
    left_out = BALL_NAMES if problem.ball is None else LIMITS
    yield from ((name, law) for name, law in laws.items() if name not in left_out)


def _scaling(solve: Solve, base: Solve, source: str, problem: CoatedContact) -> Invariant:
    """Another radius, load and modulus at the same h/a_h and E1/E2: the same dimensionless answer."""
    ratio = (RADIUS * LOAD / MODULUS) ** (1 / 3)  # of the contact radii

    def of(E: float, nu: float, coatings: Coatings) -> Ball:
        return MODULUS * E, nu, tuple((MODULUS * E1, nu1, ratio * h) for E1, nu1, h in coatings)

    E, nu, coatings = of(*problem.substrate, problem.coatings)
    scaled = replace(
        problem,
        radius=RADIUS * problem.radius,
        load=LOAD * problem.load,
        coatings=coatings,
        substrate=(E, nu),
        ball=None if problem.ball is None else of(*problem.ball),
    )
    one, U_one = _dimensionless(base(problem), problem)
    other, U_other = _dimensionless(solve(scaled), scaled)
    factors = f"R x {RADIUS}, W x {LOAD}, E x {MODULUS}"
    law = f"{factors} leave a/a_h, p0/p_h, approach/delta_h, sigma/p_h unchanged"
    return decide("scaling", source, law, one - other, U_one + U_other)


def _equal_moduli(solve: Solve, source: str, problem: CoatedContact) -> Invariant:
    """Coatings of the substrate's material: Hertz's contact, with friction Hamilton's."""
    coatings = tuple((*problem.substrate, h) for _, _, h in problem.coatings)
    same, ball = replace(problem, coatings=coatings), None
    if problem.ball is not None:
        ball = problem.ball[:2]
        same = replace(same, ball=(*ball, tuple((*ball, h) for _, _, h in problem.ball[2])))
    exact = Hertz(problem.radius, problem.load, *problem.substrate, problem.friction, ball=ball)
    found, U = _dimensionless(solve(same), same)
    known, _ = _dimensionless(exact, same)
    law = "coatings of the substrate's moduli give the closed form of the uncoated solid, over its scales"
    return decide("equal moduli", source, law, found - known, U)


def _exchanged(
    base: Solve, solve: Solve, source: str, problem: CoatedContact, name: str = "bodies exchanged"
) -> Invariant:
    """The ball as the flat, the flat as the ball: the same contact, with the stresses exchanged."""
    one, U_one = _dimensionless(base(problem), problem)
    seen = problem.seen_from(BALL)
    other, U_other = _dimensionless(solve(seen), seen, (BALL, FLAT))
    law = f"{name}: a/a_h, p0/p_h, approach/delta_h are unchanged, sigma/p_h is exchanged"
    return decide(name, source, law, one - other, U_one + U_other)


def _coating_on_ball(solve: Solve, source: str, problem: CoatedContact) -> Invariant:
    """The coatings on a ball of the flat's substrate in place of the flat: the same contact."""
    on_flat = replace(problem, ball=(*problem.substrate, ()))
    return _exchanged(solve, solve, source, on_flat, "coating on the ball")


def _equal_bodies(solve: Solve, source: str, problem: CoatedContact) -> Invariant:
    """A ball of the layers of the flat: each body gives half of u_z."""
    equal = replace(problem, ball=(*problem.substrate, problem.coatings))
    found = solve(equal)
    y = found.contact_radius * np.array([0.0, 0.25, 0.5, 0.75, 0.95, 1.2, 1.6])
    zero = np.zeros_like(y)
    flat, ball = (_surface_displacement(on_body(found, body), y) for body in equal.bodies)
    half = np.where(y < found.contact_radius, (found.approach - y**2 / (2 * equal.radius)) / 2, flat)
    U = found.sample(None, "approach").uncertainty + 2 * displacement_bound(found, equal, zero, y, zero)
    law = "a ball of the flat's layers gives half of u_z, over the approach"
    gap = np.concatenate([flat - ball, flat - half]) / found.approach
    return decide("equal bodies", source, law, gap, np.tile(U / found.approach, 2))


def _rigid_ball(solve: Solve, source: str, problem: CoatedContact) -> Invariant:
    """A very stiff ball: the contact of the rigid one, but for a compliance of its modulus."""
    stiff = replace(problem, ball=(RIGID * problem.substrate[0], problem.substrate[1], ()))
    rigid = replace(problem, ball=None)
    one, U_one = _dimensionless(solve(stiff), stiff, (FLAT,))
    other, U_other = _dimensionless(solve(rigid), rigid)
    softest = min(E for E, _, _ in (*problem.coatings, (*problem.substrate, 0.0)))
    bound = U_one + U_other + 4 * problem.substrate[0] / softest / RIGID
    law = f"a ball {RIGID:.0e} times stiffer than the flat gives the numbers of the rigid one"
    return decide("rigid ball", source, law, one - other, bound)


def _thick(solve: Solve, source: str, problem: CoatedContact) -> Invariant:
    """A very thick coating: Hertz's contact of the coating's material, on a base that is displaced."""
    E, nu, _ = problem.coatings[0]
    alone = replace(problem, coatings=(), substrate=(E, nu))
    thick = replace(problem, coatings=((E, nu, THICK_AT * alone.a_h),))
    found = solve(thick)
    base, eta = thick_shift(thick, alone)
    scales = np.array([alone.a_h, alone.p_h, alone.delta_h])
    answers = (found.sample(None, name) for name in ("contact_radius", "peak_pressure", "approach"))
    values, U = (np.array(column) for column in zip(*answers, strict=True))
    values = (values - [0.0, 0.0, base]) / scales
    # A gap changed by eta of the approach has a curvature changed by twice that; a and p0 vary as its powers
    # 1/3 and 2/3.
    bent = np.array([2 / 3, 4 / 3, 1.0]) * eta
    bound = U / scales + bent
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
    approach, U = found.sample(None, "approach")
    gap = approach / thin.delta_h - 1 - first
    law = f"h = {THIN_AT:g} a_h gives the approach of Hertz of the substrate but for its first-order change"
    bound = U / thin.delta_h + 2 * first**2
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
        t, w = gauss_legendre(n)
        phi = np.pi / 4 * (t + 1)
        r = contact.contact_radius * np.sin(phi)
        area = 2 * np.pi * r * contact.contact_radius * np.pi / 4 * w * np.cos(phi) / work
        s = disc.load_radius * (t + 1) / 2
        patch = np.pi * s * disc.load_radius * w / work
        p, U_p = contact.sample(Points(0 * r, r), "pressure")
        u_disc, u = _surface_displacement(pressed, r), _surface_displacement(contact, s)
        U = area @ (U_p * np.abs(u_disc) + p * displacement_bound(pressed, disc, 0 * r, r, 0 * r))
        U += disc.pressure * patch @ displacement_bound(contact, problem, 0 * s, s, 0 * s)
        return float(area @ (p * u_disc) - disc.pressure * patch @ u), float(U)

    (gap, bound), (coarser, _) = works(32), works(24)
    law = "int p u_disc dA = int p_disc u dA with a uniform disc, over W times the approach"
    return decide("reciprocity", source, law, gap, bound + abs(gap - coarser))


def _surface_displacement(solution: ContactSolution, y: Array) -> Array:
    return solution.displacement(np.zeros_like(y), y, np.zeros_like(y))[2]


def _dimensionless(
    solution: ContactSolution, problem: CoatedContact, bodies: tuple[str, ...] = ()
) -> tuple[Array, Array]:
    """a/a_h, p0/p_h, approach/delta_h, the stresses over p_h at ``PLACES`` of ``bodies``, the uncertainties.

    bodies : all in their order, unless given.
    """
    scalars = [(name, getattr(problem, QUANTITIES[name].scale)) for name in SCALARS]
    x, z = problem.a_h * np.array(PLACES).T
    y = 0.2 * np.abs(x)
    answers = [(solution.sample(None, name), scale) for name, scale in scalars]
    fields = [np.array([one.value / scale for one, scale in answers])]
    bounds = [np.array([(one.uncertainty or 0.0) / scale for one, scale in answers])]
    for body in bodies or problem.bodies:
        sigma, U_sigma = on_body(solution, body).sample(Points(x, y, z), "stress")
        if U_sigma is None:
            raise ValueError("states no uncertainty that would bound the invariant")
        fields.append((sigma / problem.p_h).ravel())
        bounds.append((U_sigma / problem.p_h).ravel())
    return np.concatenate(fields), np.concatenate(bounds)
