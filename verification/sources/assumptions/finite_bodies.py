"""Bodies of finite size in place of half-spaces: a ball of the sphere's radius, a disc bonded to a support.

Ball: series of Legendre polynomials, see ``FiniteBall``. Disc: layers on a rigid solid, whose rim is far
away; it is as thick as the ball's radius, which ball-on-disc tests have (a ball of 10 mm on a disc of 5 mm).
Both contacts, of the bodies and of half-spaces, have the gap of a sphere and are solved by
``integral_equation``.

A rigid ball on a homogeneous disc of thickness t: the approach changes by a/t, radius and peak pressure by
(a/t)^3; an elastic ball adds the changes of the order a/R that ``FiniteBall`` states.
"""

from collections.abc import Mapping
from dataclasses import astuple, dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from verification.problem.array_types import Array
from verification.problem.coated_contact import CoatedContact, keywords
from verification.problem.display_units import prefixed
from verification.problem.gauss_legendre import wavenumber_panels
from verification.sources.assumptions.contact_change import (
    RESOLUTION,
    Change,
    change_between,
    half_spaces,
    require_thick,
)
from verification.sources.references import integral_equation
from verification.sources.references.integral_equation import SPHERE, kernel_wavenumbers
from verification.sources.references.layered_half_space import contact_modulus
from verification.sources.references.solids_in_contact import Solid, compliance

SUMMED, INTEGRATED = 30, 76  # degrees n: a sum below, an integral above, a blend of both between
PANEL, TAIL = 16, 36.0  # Gauss points in a panel of wavenumbers; exponent beyond which coatings are not felt


@dataclass(frozen=True)
class FiniteBall:
    """Elastic ball in axisymmetric contact: what it adds to the compliance of a half-space.

    radius : [m].   solid : coatings from the surface inwards, then (E, nu).

    The ball is pressed at both poles, so that its equatorial plane stays plane and free of shear; the
    approach is measured to that plane. Vertical pressure p(r) per horizontal area acts on the surface at
    r = R sin(theta), as it acts on the flat, and displaces it vertically by w. With the series
    u_R = sum U_n P_n, u_theta = sum V_n dP_n/dtheta and S_n, T_n of the tractions sigma_RR, sigma_Rtheta,

        w = sum_(n even) (2n+1)/R^2 [g1 C11 q1 + C12/L (g1 q2 + g2 q1) + g2 C22/L q2],   q = int_0^R p g r dr
        (U_n, V_n) = C (S_n, T_n),  L = n(n+1),  g1 = cos(theta) P_n,  g2 = -sin(theta) dP_n/dtheta.

    Abel's operator, which turns J0(kr) into cos(kx), turns P_n(cos(theta)) = 2F1(-n/2, (n+1)/2; 1; (r/R)^2)
    into F_n(x/R), the even solution of Legendre's equation with F_n(0) = 1:

        F_n(s) = 2F1(-n/2, (n+1)/2; 1/2; s^2),   P_n(s)/P_n(0) of even, Q_n(s)/Q_n(0) of odd n,

    so that g1 and g2 become sums of F_n-1 and F_n+1 in the equation of ``integral_equation``. The part
    2/E1* int cos(k R xi) cos(k R xi') / sqrt(cos xi cos xi') dk, x = R sin(xi), is the identity of a
    half-space; what is left is a function of x and t with a logarithm at x = t, of the order 1/(G R).

    Homogeneous, to the order a/R, a ball on a rigid half-space differs at the same load by

        a : (1 - 2 nu)^2/(4 pi (1 - nu)) a/R,   p(0) : -pi (1 - 2 nu)^2/(16 (1 - nu)) a/R,

    the approach by (a/R) ln(R/a) and a/R, for nu = 1/2 by -a/(4R).

    Modes as in Lur'e, Three-Dimensional Problems of the Theory of Elasticity (1964), tested by uniform
    tension and by finite elements; logarithm at a force on a sphere: Sternberg and Rosenthal, J. Appl. Mech.
    19 (1952). The rest is derived here. Pressure normal to the undeformed sphere would drag the ball's
    surface inwards, without a reaction on the flat.

    Raises ValueError where the coatings are as thick as the ball.
    """

    radius: float
    solid: Solid

    def __post_init__(self) -> None:
        if self._core <= 0:
            raise ValueError(
                f"coatings as thick as the ball of radius = {self.radius:g} m; give thinner ones"
            )

    @property
    def _core(self) -> float:
        """Radius inside the coatings [m]."""
        return self.radius - sum(h for _, _, h in self.solid[0])

    def modes(self, n: Array) -> tuple[Array, Array, Array]:
        """C11, C12/L, C22/L [m/Pa] of the surface at degrees ``n`` >= 2 or 0, also between integers."""
        coatings, (E, nu) = self.solid
        R = self._core
        u, t = _regular(n, nu)
        C = (1 + nu) / E * _over(u, t)
        for E, nu, h in reversed(coatings):
            ratio, R = R / (R + h), R + h
            (u, t), (v, s) = _regular(n, nu), _regular(-n - 1, nu)
            C = C * E / (1 + nu)
            inwards = np.stack([ratio ** (n + 1), ratio ** (n - 1)], axis=1)[:, None, :]
            outwards = np.stack([ratio**n, ratio ** (n + 2)], axis=1)[:, None, :]
            outer = -np.linalg.solve(v - C @ s, (u - C @ t) * inwards)
            C = (1 + nu) / E * _over(u + (v * outwards) @ outer, t + (s * outwards) @ outer)
        L = np.where(n > 0, n * (n + 1), 1.0)
        return self.radius * C[:, 0, 0], self.radius * C[:, 0, 1] / L, self.radius * C[:, 1, 1] / L

    def beyond_half_space(self, x: Array) -> Array:
        """Kernel B(x, t) [m/N] of ``integral_equation.solve`` at points ``x`` < R, symmetric.

        Of n points that reach a it has wavenumbers up to n/a, which they resolve; it is smoothed over a/n.
        """
        R, s, a = self.radius, x / self.radius, float(x.max())
        E_star = contact_modulus(*self.solid)
        xi = np.arcsin(s)
        n = np.arange(0.0, INTEGRATED + 1, 2)
        F = _even_solutions(s, INTEGRATED + 1)
        even = np.arange(0, INTEGRATED + 1, 2)
        B = self._series(n, F[even - 1], F[even + 1], _blend(n) * (2 * n + 1) / R**2)
        # k R = n + 1/2
        first = (SUMMED + 0.5) / R
        last = max(x.size / a, 2 * (INTEGRATED + 0.5) / R)
        k, weight = wavenumber_panels(last, first, 3 / a, PANEL)
        # without a smooth end, cos(kx) of the last wavenumber is left over
        weight = weight * _end(k, last)
        wave = np.cos(np.outer(k * R, xi)) / np.sqrt(np.cos(xi))
        B -= 2 / E_star * (wave.T * weight) @ wave
        above = k > first
        n = k[above] * R - 0.5
        # of even n every second one: dn/2 = R dk/2
        weight = weight[above] * (1 - _blend(n)) * k[above]
        B += self._series(n, _waves(xi, n - 1), _waves(xi, n + 1), weight)
        return B - self._coatings_as_half_space(x, last)

    def _series(self, n: Array, below: Array, above: Array, weight: Array) -> Array:
        """sum of g C g over degrees ``n``; F_n-1, F_n+1 : ``below``, ``above``, (n, x)."""
        C11, C12, C22 = (weight * C for C in self.modes(n))
        n = n[:, None]
        # cos P_n and -sin dP_n/dtheta: Abramowitz and Stegun (1964), 8.5.3, 8.5.4
        g1 = ((n + 1) * above + n * below) / (2 * n + 1)
        g2 = n * (n + 1) / (2 * n + 1) * (below - above)
        crossed = (g1.T * C12) @ g2
        return (g1.T * C11) @ g1 + crossed + crossed.T + (g2.T * C22) @ g2

    def _coatings_as_half_space(self, x: Array, last: float) -> Array:
        """2/E1* int (M - 1) cos(kx) cos(kt) dk, which the equation holds already."""
        E_star = contact_modulus(*self.solid)
        k, weight = kernel_wavenumbers((self.solid,), float(x.max()), PANEL, TAIL)
        weight, wave = weight * _end(k, last), np.cos(np.outer(k, x))
        return 2 / E_star * (wave.T * weight * (compliance((self.solid,), E_star, k) - 1)) @ wave


def _regular(n: Array, nu: float) -> tuple[Array, Array]:
    """2 G u and R sigma of the solutions R^(n+1), R^(n-1) at R = 1, as columns; rows U, V and S, T.

    Degree -n - 1 gives those of R^-n, R^(-n-2).
    """
    one = np.ones_like(n)
    u = [[(n + 1) * (n - 2 + 4 * nu), n], [n + 5 - 4 * nu, one]]
    t = [[(n + 1) * (n**2 - n - 2 - 2 * nu), n * (n - 1)], [n**2 + 2 * n - 1 + 2 * nu, n - 1]]
    return np.moveaxis(np.array(u), 2, 0), np.moveaxis(np.array(t), 2, 0)


def _over(u: Array, t: Array) -> Array:
    """u t^-1 of each degree."""
    return np.asarray(np.linalg.solve(t.swapaxes(1, 2), u.swapaxes(1, 2)), dtype=float).swapaxes(1, 2)


def _even_solutions(s: Array, highest: int) -> Array:
    """F_0 .. F_highest at 0 <= s < 1, (n, s), by the recurrence of P_n and Q_n."""
    z = np.append(s, 0.0)
    P, Q = [np.ones_like(z), z], [np.arctanh(z), z * np.arctanh(z) - 1]
    for n in range(1, highest):
        for f in (P, Q):
            f.append(((2 * n + 1) * z * f[-1] - n * f[-2]) / (n + 1))
    return np.array([f[:-1] / f[-1] for f in (pair[n % 2] for n, pair in enumerate(zip(P, Q, strict=True)))])


def _waves(xi: Array, n: Array) -> Array:
    """F_n(sin xi) of large real ``n``, (n, xi), to (tan(xi)/n)^3, by Liouville and Green's approximation.

    y = F sqrt(cos xi) has y'' + [(n + 1/2)^2 + 1/(4 cos^2 xi)] y = 0.
    """
    m, tan = (n + 0.5)[:, None], np.tan(xi)
    return np.cos(m * xi + tan / (8 * m)) * (1 - tan**2 / (16 * m**2)) / np.sqrt(np.cos(xi))


def _blend(n: Array) -> Array:
    """Share of the sum at degree ``n``, the rest is that of the integral."""
    return _fall((n - SUMMED) / (INTEGRATED - SUMMED))


def _end(k: Array, last: float) -> Array:
    """Share of wavenumber ``k`` in the kernel."""
    return _fall(2 * k / last - 1)


def _fall(x: Array) -> Array:
    """From 1 at x <= 0 to 0 at x >= 1 with three continuous derivatives."""
    x = np.clip(x, 0.0, 1.0)
    return 1 - x**4 * (35 - 84 * x + 70 * x**2 - 20 * x**3)


THICKNESS = 1.0  # of the disc with its coatings, over the ball's radius
RIGID = 1e9  # modulus of the support over that of the disc
# Fine and coarse; what the quadratures leave is mostly common to both contacts.
RESOLUTIONS: tuple[dict[str, Any], ...] = (RESOLUTION, {"nodes": 30, "panel": 6, "tail": 13.5})
ROUNDING = 1e-8  # of the root for the contact radius, of the support's modulus


def of_half_spaces(problem: CoatedContact, thickness: float = THICKNESS) -> tuple[Change, Change]:
    """From half-spaces to the ball itself and a disc of ``thickness`` over R, both with the sphere's gap.

    Returns the change, then its uncertainty: twice its difference from one with nodes and wavenumbers fewer
    by a quarter. The friction of ``problem`` leaves the pressure unchanged in both contacts.
    Raises ValueError where the coatings are as thick as the disc, an outer one is thinner than ``THINNEST``,
    and as ``integral_equation`` does.
    """
    require_thick(problem)
    fine, coarse = (change_at(problem, thickness, resolution) for resolution in RESOLUTIONS)
    uncertainty: list[Any] = [
        None if one is None else 2 * abs(one - other) + ROUNDING
        for one, other in zip(astuple(fine), astuple(coarse), strict=True)
    ]
    return fine, Change(*uncertainty)


def change_at(problem: CoatedContact, thickness: float, resolution: Mapping[str, Any]) -> Change:
    """Change as of ``of_half_spaces``, by the parameters ``resolution`` of ``integral_equation.solve``."""
    solve = partial(integral_equation.solve, gap=SPHERE, estimate_uncertainty=False, **resolution)
    beyond = None
    if problem.ball is not None:
        E, nu, coatings = problem.ball
        beyond = FiniteBall(problem.radius, (coatings, (E, nu))).beyond_half_space
    disc = on_disc(problem, thickness * problem.radius)
    return change_between(half_spaces(problem, SPHERE, **resolution), solve(**keywords(disc), beyond=beyond))


def on_disc(problem: CoatedContact, thickness: float) -> CoatedContact:
    """This contact on a disc of ``thickness`` [m], coatings included, bonded to a rigid support.

    Raises ValueError where the coatings are as thick as the disc.
    """
    coated = sum(h for _, _, h in problem.coatings)
    if coated >= thickness:
        sizes = prefixed(coated, "m"), prefixed(thickness, "m")
        raise ValueError("coatings of {} on a disc of {}; make the disc thicker".format(*sizes))
    E, nu = problem.substrate
    layers = (*problem.coatings, (E, nu, thickness - coated))
    return replace(problem, coatings=layers, substrate=(RIGID * E, nu))
