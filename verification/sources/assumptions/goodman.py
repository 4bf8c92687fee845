"""Sliding contact without Goodman's assumption, in powers of the friction coefficient.

The traction q = f p in +x on the flat, -q on an elastic ball, displaces their surfaces normally as well. With
M(k) of ``integral_equation`` and N(k) of the same layers, N -> Dundurs' beta for short waves,

    u_z = (2/E*) int [M + f N (-i cos alpha)] phat e^(i k.x) dk/k      (per wave at the angle alpha to x)
    p = p0(r) + f p1(r) cos(theta) + f^2 [p20(r) + p22(r) cos(2 theta)] + ...,

in polar coordinates about the contact's centre x = f s1, where the gap is r^2/2R + f s1 r cos(theta)/R + ...
The transforms int p0 J0 r dr = int phi0 cos(kt) dt, int p1 J1 r dr = int psi1 sin(kt) dt and
int p20 J0 r dr = int phi2 cos(kt) dt, each over 0 < t < a, satisfy

    phi0 + K phi0 = (E*/pi)(delta0 - x^2/R),          K(x,t) = (2/pi) int (M - 1) cos kx cos kt dk
    psi1 + L psi1 = -(2/pi) int N phat0 sin(kx) dk - (2 E*/pi) s1 x/R,       L with sin kx sin kt
    phi2 + K phi2 = (E*/pi)(delta2 - s1^2/2R) + (1/pi) int N phat1 cos(kx) dk,   phi0, psi1, phi2 (a) = 0:

a pressure that vanishes at the edge fixes delta0, s1, delta2. Radius, approach and peak pressure are even in
f; p22 changes neither to this order. N - beta decays like M - 1; beta itself gives Hilbert transforms over
the contact, taken in closed form but for smooth integrals. They leave psi1 with (a - x) ln(a - x) at the
edge: the first term of the exponent 1/2 + atan(f beta cos theta)/pi of the pressure at a sliding edge,
Johnson, Contact Mechanics (1985), section 8.1. The assumption: Goodman, J. Appl. Mech. 29 (1962) 515-522.

On uncoated bodies, with C = f beta, all of it is closed:

    psi1 ~ -(C/pi)(a^2 - x^2) ln[(a + x)/(a - x)],   phi2 ~ -(C^2/4)(a^2 - x^2) (1 - ln^2[..]/pi^2),
    centre of the contact -C a/pi, of the pressure -3 C a/(2 pi), and at the same load, relative,
    a : (1/18 + 1/(6 pi^2)) C^2,   delta : (1/9 - 1/(6 pi^2)) C^2,
    peak pressure : (-25/144 + 7/(24 pi^2) + pi^2/128) C^2.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.polynomial import legendre

from verification.problem.arrays import Array
from verification.problem.contact import CoatedContact
from verification.sources.references import integral_equation
from verification.sources.references.integral_equation import Solid
from verification.sources.references.layered import LayeredHalfSpace, contact_modulus
from verification.sources.references.quadrature import gauss_legendre

GRADING = 2  # of the nodes towards the edge, where potentials have a logarithm


@dataclass(frozen=True)
class SlidingChange:
    """Change by sliding at the same load, of a contact whose frictionless quantities are those of ``exact``.

    shift, centre : of the contact's centre and of the pressure's, x/a over f.
    contact_radius, approach, peak_pressure : relative change over f^2.
    """

    shift: float
    centre: float
    contact_radius: float
    approach: float
    peak_pressure: float


def sliding_change(problem: CoatedContact, nodes: int = 160) -> SlidingChange:
    """Change of the contact of ``problem`` by the coupling of friction with the normal displacement.

    nodes : quadrature points in the contact, more where a coating is thin.
    Raises ValueError where the largest pressure is off the axis, or the contact is not found.
    """
    return _Expansion(problem, nodes).change


def coupling(solids: tuple[Solid, ...], E_star: float, k: Array) -> Array:
    """N(k): under a traction q in +x each wave has u_z = (2 / (E* k)) N (-i cos alpha) q.

    solids : the flat, then an elastic ball, on which the traction is -q.
    """
    signs = (1.0, -1.0)
    w = [LayeredHalfSpace(*solid, k).amplitudes(0.0, 0, "shear").w for solid in solids]
    return -E_star * k / 2 * np.sum([sign * one for sign, one in zip(signs, w, strict=False)], axis=0)


class _Nodes(NamedTuple):
    """Quadrature over 0 < s < 1, with 1 - s and ln((1 + s)/(1 - s)) to rounding."""

    s: Array
    weight: Array
    rest: Array
    log: Array

    @classmethod
    def graded(cls, count: int) -> "_Nodes":
        x, w = gauss_legendre(count)
        v = 0.5 * (1 - x)
        rest = v**GRADING
        return cls(
            1 - rest, 0.5 * w * GRADING * v ** (GRADING - 1), rest, np.log1p(1 - rest) - GRADING * np.log(v)
        )


class _Expansion:
    """The three potentials at the nodes; lengths over the contact radius a."""

    def __init__(self, problem: CoatedContact, nodes: int) -> None:
        solids: tuple[Solid, ...] = ((problem.coatings, problem.substrate),)
        if problem.ball is not None:
            solids += ((problem.ball[2], problem.ball[:2]),)
        self.E_star = 1 / sum(1 / contact_modulus(*solid) for solid in solids)
        self.exact = integral_equation.solve(
            radius=problem.radius,
            load=problem.load,
            coatings=problem.coatings,
            substrate=problem.substrate,
            ball=problem.ball,
            estimate_uncertainty=False,
        )
        self.a, self.radius, self.beta = self.exact.contact_radius, problem.radius, problem.dundurs_beta
        thinnest = min((h for coatings, _ in solids for _, _, h in coatings), default=self.a)
        self.nodes = _Nodes.graded(int(nodes * (1 + 0.05 * self.a / thinnest)))
        k, weight = integral_equation.kernel_wavenumbers(solids, self.a, 16, 36.0)
        self.k = k * self.a
        # weights of (M - 1) and N - beta; wavenumbers are over 1/a from here on
        self.M = weight * self.a * (integral_equation.compliance(solids, self.E_star, k) - 1)
        self.N = weight * self.a * (coupling(solids, self.E_star, k) - self.beta)
        s = np.concatenate([self.nodes.s, [0.0, 1.0]])
        # columns: the nodes, the axis, the edge
        self.cos, self.sin = np.cos(self.k[:, None] * s), np.sin(self.k[:, None] * s)
        self.even, self.odd = self._operator(self.cos), self._operator(self.sin)

    def _operator(self, wave: Array) -> Array:
        """Nystrom's matrix of K or L: at nodes, axis and edge from values at the nodes."""
        inner = wave[:, :-2] * self.nodes.weight
        return 2 / np.pi * (wave.T * self.M) @ inner

    def _solve(self, operator: Array, right: Array) -> Array:
        """Values at nodes, axis and edge of the solution with ``right`` (points, columns) there."""
        inner = np.linalg.solve(np.eye(operator.shape[1]) + operator[:-2], right[:-2])
        return right - operator @ inner

    @property
    def change(self) -> SlidingChange:
        """The scalars to the order f^2 at the same load; pressures over a/R E*/pi from here on."""
        scale = self.E_star * self.a**2 / (np.pi * self.radius)  # of the potentials [N/m]
        s, weight, log = self.nodes.s, self.nodes.weight, self.nodes.log
        points = np.concatenate([s, [0.0, 1.0]])
        c = self.exact.abel.c / scale
        # psi1 = q ln((1 + s)/(1 - s)) + rest, both parts smooth
        smooth, smooth_slope = _second_kind(c, points)
        phi0, phi0_slope = _series(c, points)
        beta = self.beta / np.pi
        phat0 = self.exact.abel.transform(self.k / self.a) / (scale * self.a)
        hilbert = phi0 * np.append(log, [0.0, 0.0]) / 2 - smooth
        base = -2 * beta * hilbert - 2 / np.pi * self.sin.T @ (self.N * phat0)
        psi = self._solve(self.odd, np.stack([base, -2 * points], axis=1))
        shift = -psi[-1, 0] / psi[-1, 1]
        psi1 = psi @ np.array([1.0, shift])
        phat1 = self.sin[:, :-2] @ (weight * psi1[:-2])
        # derivative of what is left of psi1, term by term
        rest = psi1[:-2] + beta * phi0[:-2] * log
        waves = -2 / np.pi * self.k * (self.N * phat0 + self.M * phat1)
        rest_slope = 2 * beta * smooth_slope[:-2] + self.cos[:, :-2].T @ waves - 2 * shift
        T = np.empty(points.size)
        T[:-2] = self._conjugate(phi0[:-2], phi0_slope[:-2], rest, rest_slope)
        T[-2] = weight @ (psi1[:-2] / s)
        T[-1] = -weight @ (psi1[:-2] * s / (self.nodes.rest * (1 + s)))
        right = beta * T + self.cos.T @ (self.N * phat1) / np.pi
        found = self._solve(self.even, np.stack([right, np.ones(points.size)], axis=1))
        punch = found[:, 1]
        inner = -found[-1, 0] / found[-1, 1]  # (delta2 - s1^2/2R) over a^2/R
        phi2 = found @ np.array([1.0, inner])
        # at the same load: more of the flat punch
        missing = -(weight @ phi2[:-2]) / (weight @ punch[:-2])
        delta = inner + shift**2 / 2 + missing
        slope = -phi0_slope[-1] / punch[-1]  # d delta0 / d ln a
        p0 = self._on_axis(phi0)
        slope1 = self._on_axis_slope(psi1)
        peak = self._on_axis(phi2) + missing * self._on_axis(punch) + slope1**2 / (4 * self._curvature(scale))
        return SlidingChange(
            shift=float(shift),
            centre=float(shift + weight @ (psi1[:-2] * s) / c[0]),
            contact_radius=float(missing / slope),
            approach=float(delta * self.a**2 / self.radius / self.exact.approach),
            peak_pressure=float(peak / p0),
        )

    def _conjugate(self, phi0: Array, phi0_slope: Array, rest: Array, rest_slope: Array) -> Array:
        """PV int psi1(t) t / (t^2 - x^2) dt at the nodes; psi1 = q ln((1+t)/(1-t)) + rest, q = -beta phi0/pi.

        With PV int ln((1+t)/(1-t)) / (t-x) dt over (-1, 1) = (pi^2 - ln^2)/2: Tricomi, Integral Equations
        (1957), section 4.3. What is left are differences over t^2 - x^2, smooth.
        """
        s, weight, far, log = self.nodes
        q, q_slope = -self.beta / np.pi * phi0, -self.beta / np.pi * phi0_slope
        # t^2 - x^2, rows x, columns t
        apart = (far[:, None] - far[None, :]) * (s[:, None] + s[None, :])
        np.fill_diagonal(apart, 1.0)
        of_q = (q[None, :] - q[:, None]) * s / apart
        of_rest = ((rest * s)[None, :] - (rest * s)[:, None]) / apart
        np.fill_diagonal(of_q, q_slope / 2)
        np.fill_diagonal(of_rest, (rest_slope * s + rest) / (2 * s))
        closed = q * (np.pi**2 - log**2) / 4 - rest * log / 2
        return closed + of_q @ (weight * log) + of_rest @ weight

    def _on_axis(self, phi: Array) -> float:
        """p(0) = phi(0)/a + int [phi(0) - phi(t)] / t^2 dt, of -int phi'(t)/t dt plus the edge's phi(a)/a."""
        axis = self._at_axis(phi[:-2])
        return float(axis + self.nodes.weight @ ((axis - phi[:-2]) / self.nodes.s**2))

    def _on_axis_slope(self, psi: Array) -> float:
        """dp1/dr at r = 0: -int (psi/t)'/t dt, with psi(a) = 0."""
        return self._on_axis(np.append(psi[:-2] / self.nodes.s, [np.nan, 0.0]))

    def _at_axis(self, even: Array) -> float:
        """Value on the axis from the two nodes next to it, consistent with them to rounding."""
        first, second = self.nodes.s[:2] ** 2
        return float((even[0] * second - even[1] * first) / (second - first))

    def _curvature(self, scale: float) -> float:
        """c of p0 = p0(0) - c r^2 next to the axis. Raises ValueError where it is not positive."""
        r = np.array([0.0, 0.005, 0.01])
        p = self.exact.abel.pressure(r * self.a) * self.a / scale
        rough = (p[0] - p[1:]) / r[1:] ** 2
        c = float((4 * rough[0] - rough[1]) / 3)
        if c <= 0:
            raise ValueError("the largest pressure is off the axis, where a stiff coating bends")
        return c


def _series(c: Array, s: Array) -> tuple[Array, Array]:
    """sum c_n P_2n(s) with its derivative."""
    full = np.zeros(2 * c.size - 1)
    full[::2] = c
    return legendre.legval(s, full), legendre.legval(s, legendre.legder(full))


def _second_kind(c: Array, s: Array) -> tuple[Array, Array]:
    """sum c_n W_2n-1(s) with its derivative; Q_n = P_n ln((1+s)/(1-s))/2 - W_n-1.

    Abramowitz and Stegun (1964), 8.6.19, by the recurrence of Q_n:

    (n+1) W_n = (2n+1) s W_n-1 - n W_n-2,   W_0 = 1,   W_-1 = 0.
    """
    total, slope = np.zeros_like(s), np.zeros_like(s)
    older, newer = np.zeros_like(s), np.ones_like(s)  # W_-1, W_0
    d_older, d_newer = np.zeros_like(s), np.zeros_like(s)
    for n in range(1, 2 * c.size - 1):
        # newer is W_(n-1), that of Q_n
        if n % 2 == 0:
            total += c[n // 2] * newer
            slope += c[n // 2] * d_newer
        d_older, d_newer = d_newer, ((2 * n + 1) * (newer + s * d_newer) - n * d_older) / (n + 1)
        older, newer = newer, ((2 * n + 1) * s * newer - n * older) / (n + 1)
    return total, slope
