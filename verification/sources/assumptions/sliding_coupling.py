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
    a : (1/18 + 1/(6 pi^2)) C^2,   delta : (1/9 - 1/(6 pi^2)) C^2,   p(0) : (-17/72 + 1/(6 pi^2)) C^2,
    peak pressure : (-25/144 + 7/(24 pi^2) + pi^2/128) C^2.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial import Chebyshev, legendre
from numpy.polynomial.chebyshev import chebpts1
from numpy.typing import ArrayLike
from scipy.interpolate import CubicSpline
from scipy.optimize import minimize_scalar

from verification.problem.array_types import Array, Coatings
from verification.problem.coated_contact import CoatedContact, keywords
from verification.problem.gauss_legendre import gauss_legendre
from verification.sources.references import integral_equation, solids_in_contact
from verification.sources.references.hankel_field import HankelField, bessel
from verification.sources.references.integral_equation import ExactSolution, Solid
from verification.sources.references.layered_half_space import LayeredHalfSpace

GRADING = 4  # of the nodes towards the edge, where potentials have a logarithm


@dataclass(frozen=True)
class SlidingChange:
    """Change by sliding at the same load, of a contact whose frictionless quantities are those of ``exact``.

    shift, centre : of the contact's centre and of the pressure's, x/a over f.
    contact_radius, approach : relative change over f^2.
    pressure_on_axis : change of p(0) over f^2 [Pa]; ``SlidingExpansion.peak_change`` has that of the peak.
    """

    shift: float
    centre: float
    contact_radius: float
    approach: float
    pressure_on_axis: float


@dataclass(frozen=True, eq=False)
class FirstHarmonic:
    """The pressure p1(r) cos(theta) by psi1 [N/m], with int p1 J1(kr) r dr = int_0^a psi1 sin(kt) dt.

    s, weight, far : quadrature over s = t/a in (0, 1), with 1 - s to rounding, (nodes,).
    psi, slope : psi1 and d psi1/ds at the nodes.
    """

    a: float
    s: Array
    weight: Array
    far: Array
    psi: Array
    slope: Array

    def transform(self, k: Array) -> Array:
        """phat1(k) [N], shape of ``k``."""
        return self.a * np.sin(np.multiply.outer(k * self.a, self.s)) @ (self.weight * self.psi)

    @property
    def moment(self) -> float:
        """int p1 r^2 dr = 2 int psi1 t dt [N m]: that of p1 cos(theta) about the y axis over pi."""
        return float(2 * self.a**2 * (self.weight @ (self.psi * self.s)))

    def bessel_integral(self, order: int, r: Array) -> Array:
        """int_0^inf phat1(k) J_order(kr) k dk [Pa] at r >= a, for even ``order``; shape of ``r``.

        = int_0^a psi1'(t) cos(order asin(t/r)) / sqrt(r^2 - t^2) dt.
        """
        sine = self.a * self.s / np.asarray(r, dtype=float)[..., None]
        root = np.sqrt((r[..., None] - self.a + self.a * self.far) * (r[..., None] + self.a * self.s))
        return (np.cos(order * np.arcsin(sine)) / root) @ (self.weight * self.slope)


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


class SlidingExpansion:
    """Terms of the contact of ``problem`` in powers of its friction coefficient.

    nodes : quadrature points in the contact, more where a coating is thin.
    solved : numerical parameters of ``integral_equation.solve``; ``panel``, ``tail`` are those here too.
    exact : the contact without friction, by the parameters ``solved``, where it is there already.
    Lengths are over the contact radius a, potentials over E* a^2/(pi R).
    Raises ValueError where no contact radius is found.
    """

    def __init__(
        self,
        problem: CoatedContact,
        nodes: int = 200,
        solved: Mapping[str, Any] | None = None,
        exact: ExactSolution | None = None,
    ) -> None:
        solids = solids_in_contact.solids_of(problem.coatings, problem.substrate, problem.ball)
        self.problem, self.beta = problem, problem.dundurs_beta
        solved = {"panel": 16, "tail": 36.0, **(solved or {})}
        self.exact = exact or integral_equation.solve(
            **keywords(problem), estimate_uncertainty=False, **solved
        )
        self.a = a = self.exact.contact_radius
        E_star = solids_in_contact.combined_modulus(solids)
        self.scale = E_star * a**2 / (np.pi * problem.radius)
        outer = solids_in_contact.outer_thickness(solids, a)
        self.nodes = _Nodes.graded(int(nodes * (1 + 0.05 * a / outer)))
        self.points = np.append(self.nodes.s, 1.0)  # with the edge
        k, weight = integral_equation.kernel_wavenumbers(solids, a, solved["panel"], solved["tail"])
        self.k = k * a
        # M - 1 and N - beta with the weights of k
        self.M = weight * a * (solids_in_contact.compliance(solids, E_star, k) - 1)
        self.N = weight * a * (coupling(solids, E_star, k) - self.beta)
        self.cos, self.sin = np.cos(np.outer(self.k, self.points)), np.sin(np.outer(self.k, self.points))
        self.c = self.exact.abel.c / self.scale
        self.phi0, self.phi0_slope = _series(self.c, self.points)

    def _solve(self, wave: Array, right: Array) -> Array:
        """Solution with ``right`` (points, columns), by Nystrom's method; ``wave`` : cos kx or sin kx."""
        operator = 2 / np.pi * (wave.T * self.M) @ (wave[:, :-1] * self.nodes.weight)
        inner = np.linalg.solve(np.eye(operator.shape[1]) + operator[:-1], right[:-1])
        return right - operator @ inner

    @cached_property
    def _first(self) -> tuple[Array, float, Array]:
        """psi1 at the nodes, the shift s1 over a, N phat0 + (M - 1) phat1 along the wavenumber."""
        coupled = self.N * self.exact.abel.transform(self.k / self.a) / (self.scale * self.a)
        smooth, _ = _second_kind(self.c, self.points)
        log = np.append(self.nodes.log, 0.0)  # times phi0 = 0 at the edge
        right = -self.beta / np.pi * (self.phi0 * log - 2 * smooth) - 2 / np.pi * self.sin.T @ coupled
        psi = self._solve(self.sin, np.stack([right, -2 * self.points], axis=1))
        shift = float(-psi[-1, 0] / psi[-1, 1])
        psi1 = psi[:-1] @ np.array([1.0, shift])
        return psi1, shift, coupled + self.M * self._transform(psi1)

    def _first_at(self, s: Array, far: Array) -> tuple[Array, Array, Array]:
        """psi1 at ``s``, 1 - s = ``far``; its derivative; that of psi1 + (beta/pi) phi0 ln[(1 + s)/(1 - s)].

        The logarithm is that of the Hilbert transform of phi0, sum c_n Q_2n; the rest is smooth.
        """
        _, shift, _ = self._first
        smooth, smooth_slope = _second_kind(self.c, s)
        phi0, phi0_slope = _series(self.c, s)
        q, q_slope, log = -self.beta / np.pi * phi0, -self.beta / np.pi * phi0_slope, np.log((1 + s) / far)
        layers, layers_slope = self._by_layers(s), self._by_layers.deriv()(s)
        rest = 2 * self.beta / np.pi * smooth - layers - 2 * shift * s
        slope = 2 * self.beta / np.pi * smooth_slope - layers_slope - 2 * shift
        # q / (1 - s), next to the edge by its derivative
        quotient = np.where(far < 1e-8, -q_slope, q / far)
        return q * log + rest, slope + q_slope * log + 2 * quotient / (1 + s), slope

    @cached_property
    def _by_layers(self) -> Chebyshev:
        """(2/pi) int [N phat0 + (M - 1) phat1] sin(ks) dk over s = x/a: a polynomial with one point a node.

        Smooth over the outer coating's thickness, to which the number of nodes is fitted.
        """
        _, _, waves = self._first
        s = 0.5 * (1 + chebpts1(self.nodes.s.size))
        values = 2 / np.pi * np.sin(np.multiply.outer(s, self.k)) @ waves
        return Chebyshev.interpolate(lambda _: values, s.size - 1, domain=[0, 1])

    def _transform(self, psi: Array) -> Array:
        return self.sin[:, :-1] @ (self.nodes.weight * psi)

    @cached_property
    def first(self) -> FirstHarmonic:
        """The pressure of the first order, about the centre of the contact."""
        s, weight, far, _ = self.nodes
        psi, slope, _ = self._first_at(s, far)
        return FirstHarmonic(self.a, s, weight, far, self.scale * psi, self.scale * slope)

    def first_pressure(self, r: Array) -> Array:
        """p1 [Pa] at 0 < r < a [m]: -r int_r^a (psi1/t)' / sqrt(t^2 - r^2) dt; shape of ``r``."""
        w, weight, _, _ = _Nodes.graded(48)
        inner = 1 - (r[:, None] / self.a) ** 2
        # t^2 - r^2 = (1 - r^2) w^2
        t = np.sqrt(1 - inner * (1 - w**2))
        psi, slope, _ = self._first_at(t, inner * (1 - w**2) / (1 + t))
        integrand = (slope - psi / t) / t**2 * np.sqrt(inner)
        return -self.scale / self.a**2 * r * (integrand @ weight)

    @cached_property
    def change(self) -> SlidingChange:
        """Scalars to the order f^2 at the same load."""
        s, weight, far, _ = self.nodes
        psi1, shift, _ = self._first
        slope = self._first_at(s, far)[2]
        conjugate = np.append(self._conjugate(psi1, slope), -weight @ (psi1 * s / (far * (1 + s))))
        right = self.beta / np.pi * conjugate + self.cos.T @ (self.N * self._transform(psi1)) / np.pi
        found = self._solve(self.cos, np.stack([right, np.ones(right.size)], axis=1))
        punch = found[:, 1]
        inner = -found[-1, 0] / found[-1, 1]  # delta2 - s1^2/2R
        phi2 = found @ np.array([1.0, inner])
        # the load of a flat punch restores the load at the contact radius without friction, then the radius
        missing = -(weight @ phi2[:-1]) / (weight @ punch[:-1])
        widening = -self.phi0_slope[-1] / punch[-1]  # d delta0 / d ln a
        return SlidingChange(
            shift=shift,
            centre=float(shift + weight @ (psi1 * s) / self.c[0]),
            contact_radius=float(missing / widening),
            approach=float((inner + shift**2 / 2 + missing) * self._unit / self.exact.approach),
            pressure_on_axis=self.scale / self.a * self._on_axis(phi2 + missing * punch),
        )

    @property
    def _unit(self) -> float:
        """Unit of displacements, a^2/R [m]."""
        return self.a**2 / self.problem.radius

    def _conjugate(self, psi1: Array, rest_slope: Array) -> Array:
        """PV int psi1(t) t / (t^2 - x^2) dt at the nodes; psi1 = q ln((1+t)/(1-t)) + rest, q = -beta phi0/pi.

        With PV int ln((1+t)/(1-t)) / (t-x) dt over (-1, 1) = (pi^2 - ln^2)/2: Tricomi, Integral Equations
        (1957), section 4.3. What is left are differences over t^2 - x^2, smooth.
        """
        s, weight, far, log = self.nodes
        q, q_slope = (-self.beta / np.pi * part[:-1] for part in (self.phi0, self.phi0_slope))
        rest = psi1 - q * log
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
        """p(0) = -int phi'(t)/t dt, and phi(a)/a of the edge: phi(0) + int [phi(0) - phi(t)] / t^2 dt.

        phi(0) from the two nodes next to the axis, so that it is consistent with them to rounding.
        """
        s, inner = self.nodes.s, phi[:-1]
        axis = (inner[0] * s[1] ** 2 - inner[1] * s[0] ** 2) / (s[1] ** 2 - s[0] ** 2)
        return float(axis + self.nodes.weight @ ((axis - inner) / s**2))

    def peak_change(self, friction: float) -> tuple[float, float]:
        """Relative change of the largest pressure with f p1 + f^2 p20(0) added to p0, then its x/a.

        The peak moves along x by the order f; where p0 is nearly flat, far. Exact to f^2 where p0 peaks on
        the axis; to f where it peaks on a ring, since p20 and p22 vary by the order f^2 over the contact.
        """
        abel, x = self.exact.abel, np.linspace(0.0, 0.98, 50) * self.a
        p1 = CubicSpline(np.concatenate([-x[:0:-1], x]), _odd(self.first_pressure(x[1:])))

        def pressure(at: ArrayLike) -> Array:
            return abel.pressure(np.abs(at)) + friction * p1(at)

        grid = np.concatenate([-x[:0:-1], x])
        best = int(np.argmax(pressure(grid)))
        bounds = grid[max(best - 1, 0)], grid[min(best + 1, grid.size - 1)]
        found = minimize_scalar(
            lambda at: -float(pressure(at)), bounds=bounds, method="bounded", options={"xatol": 1e-9 * self.a}
        )
        place, top = max(((found.x, -found.fun), (grid[best], pressure(grid[best]))), key=lambda one: one[1])
        change = (top + friction**2 * self.change.pressure_on_axis) / abel.peak - 1
        return float(change), float(place / self.a)


def _odd(values: Array) -> Array:
    """``values`` on one side of the axis, continued to an odd function: both sides with 0 between."""
    return np.concatenate([-values[::-1], [0.0], values])


def _series(c: Array, s: Array) -> tuple[Array, Array]:
    """sum c_n P_2n(s) with its derivative."""
    full = np.zeros(2 * c.size - 1)
    full[::2] = c
    return np.asarray(legendre.legval(s, full)), np.asarray(legendre.legval(s, legendre.legder(full)))


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


class PlaneStress(NamedTuple):
    """sigma_xx, sigma_xz [Pa] at points of the plane y = 0."""

    xx: Array
    xz: Array


def first_harmonic(
    pressure: FirstHarmonic,
    coatings: Coatings,
    substrate: tuple[float, float],
    x: Array,
    z: float,
    layer: int,
    nodes: int = 16,
    tail: float = 36.0,
) -> tuple[PlaneStress, PlaneStress]:
    """Stress in the plane y = 0 at depth ``z`` of ``layer`` by p1 cos(theta), then by it as a traction in +x.

    With phat1 = int p1 J1 r dr, amplitudes of ``layered_half_space`` for each wave (those of the shear load
    with T = 1 and t = 1), A1 = (3 ll + tt - 2 lt)/4, A3 = (ll - tt + 2 lt)/4, c = +-1 at the two sides of the
    axis:

        pressure:   sigma_xx = c int [(3 ll + tt)/4 J1 - (ll - tt)/4 J3] phat1 k dk
                    sigma_xz = int T/2 (J0 - J2) phat1 k dk
        traction:   sigma_xx = int [A1/2 J0 - (A1 + A3)/2 J2 + A3/2 J4] phat1 k dk
                    sigma_xz = -c int [(3 T + t)/4 J1 - (T - t)/4 J3] phat1 k dk

    On the surface outside the contact the homogeneous solid of the top layer has, with m = int p1 r^2 dr and
    I_n = int phat1 J_n k dk, closed but for I_n,

        pressure:   sigma_xx = c (1 - 2 nu) m/r^3,      traction:   sigma_xx = (4 + nu)/4 I0 - I2 - nu/4 I4.

    Derived like the axisymmetric fields of ``hankel_field``, with one more factor -i cos(alpha) of the wave's
    direction.

    x : (n,) [m]; on the surface outside the contact, |x| >= a, where both tractions vanish.
    nodes, tail : of the quadrature, as of ``HankelField``.
    Raises ValueError for points of the contact on the surface.
    """
    r, side = np.abs(x), np.sign(x)
    total = np.zeros((4, r.size))
    if z == 0:
        if np.any(r < (1 - 1e-12) * pressure.a):
            raise ValueError(f"|x| = {r.min():g} m lies in the contact; give points outside it, or below")
        r = np.maximum(r, pressure.a)
        nu = coatings[0][1] if coatings else substrate[1]
        I0, I2, I4 = (pressure.bessel_integral(n, r) for n in (0, 2, 4))
        total[0] = side * (1 - 2 * nu) * pressure.moment / r**3
        total[2] = (4 + nu) / 4 * I0 - I2 - nu / 4 * I4
    if z > 0 or coatings:
        # of the pressure, this needs no more than its transform and radius
        field = HankelField(pressure, coatings, substrate, 1.0, nodes, tail)
        k, w, (N, A, B) = field.waves(r, z, layer)
        J = bessel(k, r, highest=4)
        A1, A3 = (3 * A.ll + A.tt - 2 * B.lt) / 4, (A.ll - A.tt + 2 * B.lt) / 4
        total[0] += side * ((w * (3 * N.ll + N.tt) / 4) @ J[1] - (w * (N.ll - N.tt) / 4) @ J[3])
        total[1] += (w * N.T / 2) @ (J[0] - J[2])
        total[2] += (w * A1 / 2) @ J[0] - (w * (A1 + A3) / 2) @ J[2] + (w * A3 / 2) @ J[4]
        total[3] -= side * ((w * (3 * A.T + B.t) / 4) @ J[1] - (w * (A.T - B.t) / 4) @ J[3])
    return PlaneStress(*total[:2]), PlaneStress(*total[2:])
