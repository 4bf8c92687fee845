"""Enclosures of the contact under a given load: radius by the sign of load(a) - W at both ends.

With f = d f1 - f2 of ``equation`` and E1* of the first material,

    d = f2(1)/f1(1),  approach = d a^2/R,  load = 2 E1* a^3/R (d I1 - I2),  I = int_0^1 f ds            (C1)
    stiffness of the flat punch = 2 E1* a I1
    p(0) = E1* a/(pi R) [2 - (2/pi) int m kappa Si(kappa) F dkappa]                                      (C2)
    sigma_xx(0, 0, z) = E1* a/(pi R) int A(kappa) kappa F dkappa                                         (C3)
    d load/d a = -2 E1* a^2/R f'(1) I1/f1(1),  f'(1) = -2 + (2/pi) int m kappa sin(kappa) F dkappa       (C4)

    p(r) = E1* a/(pi R) [2 sqrt(1 - s^2) - (2/pi) int m kappa F Y dkappa],   s = r/a
    Y = int_s^1 sin(kappa t)/sqrt(t^2 - s^2) dt

(C2) is p(0) = -int phi'(t)/t dt; on the surface (C3) has A less the homogeneous solid's, which gives
-(1 + 2 nu1)/2 p(0), Johnson, Contact Mechanics (1985), (3.46). (C4): the derivative of the equation with
respect to a, where phi(a) = 0, has the right side d delta/d a alone; derived here, after Mossakovskii, PMM 27
(1963) 418-427.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from flint import acb, arb, ctx

from enclosures_made.enclosed_integrals import of_bounded, panels
from enclosures_made.enclosed_response import LayeredSolid
from enclosures_made.fredholm_enclosure import Equation, Waves, equation, waves
from verification.problem.coated_contact import CoatedContact

EXCESS, SURFACE, UPPER, LOWER = range(4)
STEPS = 30
NEAR = 2.0**-30  # relative radius of the ball of radii for which the panels of the proof hold


@dataclass(frozen=True, repr=False)
class Enclosed:
    """Balls in SI of one problem: pressure and sigma_xx on the axis, the pressure at the radii of a profile.

    stiffness : dW/d delta, that of a flat punch of the contact radius.
    interface : sigma_xx on the (upper, lower) side of the first one, None where uncoated.
    """

    contact_radius: arb
    approach: arb
    stiffness: arb
    pressure: arb
    surface: arb
    interface: tuple[arb, arb] | None
    profile: tuple[arb, ...] = ()
    bits: int = 0
    terms: int = 0


def enclose(problem: CoatedContact, radii: Sequence[float] = ()) -> Enclosed:
    """Enclosures of a rigid sphere's contact; the numbers of ``problem`` are taken as exact.

    radii : radii [m] of a profile of the pressure.
    Raises ValueError where a bound cannot be proven.
    """
    if problem.ball is not None:
        raise ValueError("enclosures are of a rigid sphere; this problem has an elastic ball")
    if not problem.coatings:
        return _hertz(problem, radii)
    solid = LayeredSolid(problem.coatings, problem.substrate)
    bits = ctx.prec
    try:
        a, terms = _near(problem, solid)
        ctx.prec = _bits(terms)
        # the panels of the guess prove nothing; they lead to where those of the proof have to hold
        a, _ = _newton(problem, solid, a, waves(panels(solid, a), terms), float(a) * NEAR / 16)
        around = arb(a.mid(), (a * NEAR).upper())
        table = waves(panels(solid, around), terms)
        a, reach = _newton(problem, solid, a, table, 0.0)
        W = arb(problem.load)
        while True:
            low, high = (a - reach).mid(), (a + reach).mid()
            if not (around.lower() < low and high < around.upper()):
                raise ValueError(f"the load could not be enclosed near a = {float(a):g} m")
            ends = [_edge(problem, equation(solid, end, table)).load for end in (low, high)]
            if ends[0] < W < ends[1]:
                break
            reach = 4 * reach
        return _quantities(problem, solid, equation(solid, low.union(high), table), radii)
    finally:
        ctx.prec = bits


def _bits(terms: int) -> int:
    """Precision: the recurrences of spherical Bessel functions lose some 1.2 bits an order."""
    return 128 + int(2.6 * terms)


def _modulus(problem: CoatedContact) -> arb:
    """E1* = E1/(1 - nu1^2) of the first material."""
    E, nu = (arb(value) for value in (*problem.coatings, problem.substrate)[0][:2])
    return E / (1 - nu * nu)


def _hertz(problem: CoatedContact, radii: Sequence[float]) -> Enclosed:
    """a^3 = 3 W R/(4 E*), delta = a^2/R, p0 = 2 E* a/(pi R): Johnson (4.22) to (4.24)."""
    R, W, E_star, nu = arb(problem.radius), arb(problem.load), _modulus(problem), arb(problem.substrate[1])
    a = (3 * W * R / (4 * E_star)).root(3)
    p = 2 * E_star * a / (arb.pi() * R)
    profile = tuple(p * (1 - (arb(r) / a) ** 2).nonnegative_part().sqrt() for r in radii)
    return Enclosed(a, a * a / R, 2 * E_star * a, p, -(1 + 2 * nu) / 2 * p, None, profile, ctx.prec)


def _near(problem: CoatedContact, solid: LayeredSolid) -> tuple[arb, int]:
    """Radius near that of the contact with the number of terms for it; neither needs to be proven."""
    ctx.prec = 64
    R, W, E_star = problem.radius, problem.load, float(_modulus(problem))
    a = problem.a_h
    for _ in range(40):
        M = 1 + float(solid.amplitudes(acb(2 / a)).excess.real)
        a = 0.5 * (a + (3 * W * R * M / (4 * E_star)) ** (1 / 3))
    # the kernel is analytic within 2 h of the real axis, so that coefficients fall like exp(-2 n asinh(2h/a))
    rate = 2 * math.asinh(2 * problem.coatings[0][2] / a)
    return arb(a), int(56 / rate) + 16


def _newton(
    problem: CoatedContact, solid: LayeredSolid, a: arb, table: Waves, enough: float
) -> tuple[arb, arb]:
    """Radius under the load with the half width of a bracket of it; stops at steps below ``enough`` [m]."""
    for _ in range(STEPS):
        edge = _edge(problem, equation(solid, a, table))
        step = ((arb(problem.load) - edge.load) / edge.slope).mid()
        reach = 4 * (edge.load.rad() / edge.slope).abs_upper() + a * arb(2) ** -90
        a = (a + step).mid()
        if abs(step) < reach or abs(step) < enough:
            return a, reach
    raise ValueError(f"no contact radius after {STEPS} steps of Newton's method")


@dataclass(frozen=True, repr=False)
class _Edge:
    d: arb
    f1: arb
    load: arb
    slope: arb
    stiffness: arb


def _edge(problem: CoatedContact, at: Equation) -> _Edge:
    """(C1) and (C4)."""
    kappa = at.waves.panels.kappa
    two_pi = 2 / arb.pi()
    edge = at.integral(EXCESS, [k.cos() for k in kappa], 0)
    tilt = at.integral(EXCESS, [k * k.sin() for k in kappa], 1)
    f1, f2 = (1 - two_pi * value for value in edge)
    d = f2 / f1
    I1, I2 = (g.y[0] + arb(0, g.error) for g in at.solutions)
    R, E_star, a = arb(problem.radius), _modulus(problem), at.a
    load = 2 * E_star * a**3 / R * (d * I1 - I2)
    slope = -2 * E_star * a * a / R * (-2 + two_pi * (d * tilt[0] - tilt[1])) * I1 / f1
    return _Edge(d, f1, load, slope, 2 * E_star * a * I1)


def _quantities(
    problem: CoatedContact, solid: LayeredSolid, at: Equation, radii: Sequence[float]
) -> Enclosed:
    """(C1) to (C3) at a ball of radii; raises ValueError where the load might not rise with the radius."""
    edge, kappa, terms = _edge(problem, at), at.waves.panels.kappa, at.waves.c.ncols()
    if not (edge.slope > 0 and edge.f1 > 0):
        raise ValueError("the load could not be shown to rise with the contact radius")
    R, E_star, a, nu = arb(problem.radius), _modulus(problem), at.a, solid.nu[0]
    scale = E_star * a / (arb.pi() * R)

    def of(pair: tuple[arb, arb]) -> arb:
        return edge.d * pair[0] - pair[1]

    # |x Si(x)| <= |x|^2 cosh(Im x), since |sin(x t)/t| <= |x| cosh(Im x) for t <= 1
    p = scale * (2 - 2 / arb.pi() * of(at.integral(EXCESS, [k * k.si() for k in kappa], 2)))
    surface, *interface = (scale * of(at.integral(i, kappa, 1)) for i in (SURFACE, UPPER, LOWER))
    surface = surface - (1 + 2 * nu) / 2 * p
    profile = []
    for r in radii:
        s = arb(r) / a
        reach = (1 - s * s).nonnegative_part().sqrt()
        factor = [k * _ring(k, s, reach) for k in kappa]
        profile.append(scale * (2 * reach - 2 / arb.pi() * of(at.integral(EXCESS, factor, 2))))
    return Enclosed(
        a,
        edge.d * a * a / R,
        edge.stiffness,
        p,
        surface,
        (interface[0], interface[1]),
        tuple(profile),
        ctx.prec,
        terms,
    )


def _ring(kappa: arb, s: arb, reach: arb) -> arb:
    """int_s^1 sin(kappa t)/sqrt(t^2 - s^2) dt, with u^2 = t^2 - s^2 up to ``reach``; 0 outside the contact.

    |Im t| <= |Im u| for real s, and |sin(kappa t)/t| <= kappa cosh(kappa Im t).
    """
    if reach.is_zero():
        return reach

    def value(u: arb) -> arb:
        t = (s * s + u * u).sqrt()
        return (kappa * t).sin() / t

    return of_bounded(value, reach, lambda b: kappa * (kappa * b).cosh())
