"""Sphere on a coated half-space, frictionless contact: the Fredholm equation of the second kind.

    phi(x) + (2/pi) int_0^a K(x,t) phi(t) dt = (E*/pi) (delta - G(x)),   phi(a) = 0
    W = 2 pi int_0^a phi dt,   K(x,t) = int_0^inf (M(k) - 1) cos(kx) cos(kt) dk

The gap g(r) of the undeformed bodies enters as G(x) = x int_0^x g'(r) / sqrt(x^2 - r^2) dr, Sneddon (1965):
x^2/R of the parabola r^2/2R, x artanh(x/R) of the sphere R - sqrt(R^2 - r^2).

The compliances of flat and ball add up, with E1* and M1 of the layers of each:

    1/E* = sum 1/E1*,   M = E* sum M1/E1*;   of a rigid ball E* = E1* and M = M1 of the flat.

K is smooth, so Gauss-Legendre converges geometrically: no grid in the plane, no elements. Any number of
coatings. With friction q = f p the pressure is unchanged (Goodman's assumption).
Sneddon, Int. J. Engng Sci. 3 (1965) 47-57; Lebedev and Ufliand, PMM 22 (1958) 320-326; Dhaliwal and Rau, Int.
J. Engng Sci. 8 (1970) 843-856; Yu, Sanday and Rath, J. Mech. Phys. Solids 38 (1990) 745-764.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache, cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import brentq

from verification.problem.array_types import Array, Ball, Coatings
from verification.problem.coated_contact import ScalarUncertainty
from verification.problem.gauss_legendre import gauss_legendre, wavenumber_panels
from verification.problem.point_answers import BALL, FLAT, ByFunctions, Points, by_functions
from verification.problem.quantity import SCALARS
from verification.sources.references.axisymmetric_pressure import AbelPressure
from verification.sources.references.hankel_field import HankelField
from verification.sources.references.layered_half_space import bending_length
from verification.sources.references.solids_in_contact import (
    Solid,
    combined_modulus,
    compliance,
    outer_thickness,
    radius_estimate,
    solids_of,
)


@dataclass(frozen=True)
class Gap:
    """Gap of the undeformed bodies, by ``transform(x, R)`` = G(x) [m]; a/R at most ``widest``."""

    transform: Callable[[Any, float], Any]
    widest: float


BLOCK = 4096  # wavenumbers of the kernel summed at once
PARABOLA = Gap(lambda x, R: x**2 / R, np.inf)
SPHERE = Gap(lambda x, R: x * np.arctanh(x / R), 0.9)


# Kernel [m/N] at points of the contact, the last of which is its edge; see ``solve``.
Beyond = Callable[[Array], Array]


@dataclass(frozen=True)
class ExactDiagnostics:
    """Quadrature nodes in the contact and along the wavenumber; load balance of the result."""

    contact_nodes: int
    wavenumbers: int
    load_residual: float


@dataclass(frozen=True, eq=False)
class ExactSolution(ByFunctions):
    """Contact, stresses, displacements; the difference from ``coarser`` gives the uncertainty.

    fields : of the flat, then of an elastic ball.
    stiffness : dW/d delta [N/m], that of a flat punch of the contact radius. Pharr, Oliver and Brotzen,
        J. Mater. Res. 7 (1992) 613-617.
    """

    abel: AbelPressure
    approach: float
    fields: tuple[HankelField, ...]
    diagnostics: ExactDiagnostics
    stiffness: float
    coarser: "ExactSolution | None" = None

    @property
    def contact_radius(self) -> float:
        """a [m]."""
        return self.abel.a

    @property
    def peak_pressure(self) -> float:
        """Largest pressure [Pa], on the axis unless a stiff film bends."""
        return self.abel.peak

    @cached_property
    def uncertainty(self) -> ScalarUncertainty | None:
        """Twice the change when every quadrature is made coarser by a quarter, with the rounding."""
        if self.coarser is None:
            return None
        U = {}
        for name in ("contact_radius", "approach", "peak_pressure", "stiffness"):
            value = getattr(self, name)
            U[name] = 2 * abs(value - getattr(self.coarser, name)) + 1e-12 * value
        return ScalarUncertainty(**U, budget=tuple((n, "quadrature", U[n]) for n in SCALARS))

    @property
    def _rounding(self) -> float:
        # A quadrature sums some 4096 terms; differentiating a series of m terms amplifies rounding by m^3.
        return float(np.finfo(float).eps * max(4096.0, (2.0 * self.abel.c.size) ** 3))

    def pressure(self, x: ArrayLike, y: ArrayLike = 0.0) -> Array:
        """p [Pa], 0 outside the contact."""
        return self.abel.pressure(np.hypot(x, y))

    def stress(
        self, x: ArrayLike, y: ArrayLike, z: ArrayLike, layer: int | None = None, body: str = FLAT
    ) -> Array:
        """sigma[i, j, ...] [Pa] of either body; ``layer`` picks the side of an interface, None the upper one.

        Raises ValueError for the ball where it is rigid.
        """
        return self._field(body).stress(x, y, z, layer)

    def _field(self, body: str) -> HankelField:
        of = dict(zip((FLAT, BALL), self.fields, strict=False))
        if body not in of:
            raise ValueError(f"body = {body!r}; this contact has {' and '.join(of)}")
        return of[body]

    def displacement(self, x: ArrayLike, y: ArrayLike, z: ArrayLike, body: str = FLAT) -> Array:
        """u[i, ...] [m] of either body towards its points at infinity, shape (3,) + points."""
        return self._field(body).displacement(x, y, z)

    def error(self, points: Points | None, quantity: str, value: Any) -> Any:
        """Uncertainty of ``value``: by the coarser quadrature, with the rounding; None without it.

        Of pressure and stress on the surface also by the root at the edge, whose radius is uncertain.
        """
        if self.coarser is None:
            return None
        if points is None:
            return getattr(self.uncertainty, quantity)
        U = 2 * np.abs(value - by_functions(self.coarser, points, quantity))
        if quantity == "displacement":
            return U + self._rounding * self.approach
        U += self._rounding * self.peak_pressure
        root = self._by_radius(points.x, points.y)
        if quantity == "pressure":
            return U + root
        # sigma_rr has the root of p inside; under q = f p, 2 f times that outside.
        return U + np.where(np.asarray(points.z) == 0, (1 + 2 * self.fields[0].friction) * root, 0.0)

    def _by_radius(self, x: ArrayLike, y: ArrayLike) -> Array:
        """Change [Pa] of the root of the pressure at the edge by the uncertain radius."""
        assert self.uncertainty is not None
        a = self.abel.a
        distance, shift = np.abs(1 - np.hypot(x, y) / a), self.uncertainty.contact_radius / a
        return self.abel.edge_slope * np.sqrt(2) * (np.sqrt(distance + shift) - np.sqrt(distance))


def solve(
    *,
    radius: float,
    load: float,
    coatings: Coatings,
    substrate: tuple[float, float],
    friction: float = 0.0,
    ball: Ball | None = None,
    nodes: int = 80,
    panel: int = 16,
    tail: float = 36.0,
    estimate_uncertainty: bool = True,
    gap: Gap = PARABOLA,
    beyond: Beyond | None = None,
) -> ExactSolution:
    """Contact of a sphere of ``radius`` [m] under ``load`` [N]; arguments as in CoatedContact.

    nodes : Gauss-Legendre points in the contact; more where a coating is thin.
    panel, tail : Gauss points a panel of the wavenumbers; exponent at which their integrands are cut.
    gap : of the undeformed bodies, PARABOLA or SPHERE.
    beyond : what the bodies add to half-spaces, B in (E*/pi) int_0^a B(x, t) phi(t) dt on the left side.
    Raises ValueError when no contact radius between 1e-3 and 1e3 of the Hertz radius carries the load, nor
    one below ``gap.widest``.
    """
    solids = solids_of(coatings, substrate, ball)
    guess = radius_estimate(radius, load, combined_modulus(solids), solids)

    def solved(nodes: int, panel: int, tail: float, start: float = guess) -> ExactSolution:
        equation = Equation(radius, solids, guess, nodes, panel, tail, gap, beyond)
        return _under_load(equation, load, friction, panel, tail, start)

    if not estimate_uncertainty:
        return solved(nodes, panel, tail)
    coarser = solved(3 * nodes // 4, 3 * panel // 4, 0.75 * tail)
    return replace(solved(nodes, panel, tail, start=coarser.contact_radius), coarser=coarser)


class Equation:
    """The integral equation of a sphere of ``radius`` [m] on the ``solids``, flat and ball, discretised.

    guess : contact radius [m] that the quadratures are fitted to.   Others as of ``solve``.
    """

    def __init__(
        self,
        radius: float,
        solids: tuple[Solid, ...],
        guess: float,
        nodes: int,
        panel: int,
        tail: float,
        gap: Gap = PARABOLA,
        beyond: Beyond | None = None,
    ) -> None:
        self.radius, self.solids, self.guess, self.gap, self.beyond = radius, solids, guess, gap, beyond
        self.E_star = combined_modulus(solids)
        x, w = gauss_legendre(_contact_nodes(nodes, guess, solids))
        self.s, self.weight = 0.5 * (1 + x), 0.5 * w
        self.k, self.k_weight = kernel_wavenumbers(solids, guess, panel, tail)
        # wavenumbers go as 1/a, so that cos(kx) is that of every radius
        phase = np.multiply.outer(self.k * guess, np.append(self.s, 1.0))
        self.cosine = np.cos(phase, out=phase)

    def at(self, a: float) -> tuple[Array, float, float]:
        """phi at the nodes, approach, stiffness of contact radius ``a`` [m]."""
        x, shrink, unit = a * self.s, self.guess / a, self.E_star / np.pi
        kernel = shrink * self.k_weight * (compliance(self.solids, self.E_star, shrink * self.k) - 1)
        K = (2 / np.pi) * self._transformed(kernel)
        if self.beyond is not None:
            K += unit * self.beyond(np.append(x, a))
        A = np.eye(x.size) + K[:-1, :-1] * (a * self.weight)
        right = unit * np.stack([np.ones_like(x), self.gap.transform(x, self.radius)], axis=1)
        phi: Any = np.linalg.solve(A, right)
        at_edge = float(self.gap.transform(a, self.radius))
        # Nystrom's interpolation gives phi at the edge, where it must vanish.
        edge = unit * np.array([1.0, at_edge]) - (K[-1, :-1] * a * self.weight) @ phi
        delta = edge[1] / edge[0]
        return phi @ np.array([delta, -1.0]), float(delta), self.carried(a, phi[:, 0])

    def _transformed(self, kernel: Array) -> Array:
        """int kernel(k) cos(ks) cos(kt) dk; A^T A of each sign of the kernel is half of a product's work."""
        found = np.zeros(2 * self.cosine.shape[1:])
        for begin in range(0, kernel.size, BLOCK):
            part = kernel[begin : begin + BLOCK, None]
            root = np.sqrt(np.abs(part)) * self.cosine[begin : begin + BLOCK]
            for sign in (1, -1):
                of_sign = root[sign * part[:, 0] > 0]
                found += sign * (of_sign.T @ of_sign)
        return found

    def carried(self, a: float, phi: Array) -> float:
        """2 pi int_0^a phi dt [N]."""
        return float(2 * np.pi * a * (self.weight @ phi))


def _under_load(
    equation: Equation, load: float, friction: float, panel: int, tail: float, start: float
) -> ExactSolution:
    """The contact whose radius carries ``load``, sought from ``start`` [m]."""
    guess, gap, radius = equation.guess, equation.gap, equation.radius
    at = cache(equation.at)  # the root that is found was asked for before

    def excess(log_a: float) -> float:
        a = float(np.exp(log_a))
        carried = equation.carried(a, at(a)[0])
        if not carried > 0:
            raise ValueError(
                f"{load:g} N on a = {a:g} m: the layers' compliance loses its digits; check the moduli"
            )
        return float(np.log(carried / load))

    widest = np.log(gap.widest * radius)
    low = high = min(np.log(start), widest)
    span = min(0.6 * abs(excess(low)) + 1e-9, np.log(1.5))  # the load goes about as a^3
    while excess(low) > 0 and low > np.log(guess) - 7:
        low, span = low - span, 1.5 * span
    while excess(high) < 0 and high < min(np.log(guess) + 7, widest):
        high, span = min(high + span, widest), 1.5 * span
    if not excess(low) <= 0 <= excess(high):
        raise ValueError(
            f"load = {load:g} N is carried by no contact radius near {guess:g} m; check the moduli"
        )
    a = float(np.exp(brentq(excess, low, high, xtol=1e-15, rtol=4 * np.finfo(float).eps)))
    phi, delta, stiffness = at(a)
    abel = AbelPressure.from_nodes(a, equation.s, equation.weight, phi)
    # the traction on the ball is -q
    fields = tuple(
        HankelField(abel, *solid, sign * friction, panel, tail)
        for solid, sign in zip(equation.solids, (1.0, -1.0), strict=False)
    )
    diagnostics = ExactDiagnostics(equation.s.size, equation.k.size, abs(abel.load / load - 1))
    return ExactSolution(abel, delta, fields, diagnostics, stiffness)


def _contact_nodes(nodes: int, a: float, solids: tuple[Solid, ...]) -> int:
    """The kernel varies over the outer coating's thickness, so thin ones need nodes in proportion to a/h."""
    return int(nodes + 3 * a / outer_thickness(solids, a) * nodes / 80)


def kernel_wavenumbers(solids: tuple[Solid, ...], a: float, panel: int, tail: float) -> tuple[Array, Array]:
    """Gauss panels up to where M - 1 ~ (k h)^2 exp(-2 k h) is negligible; finer near 0."""
    coated = [solid for solid in solids if solid[0]]
    if not coated:
        return np.ones(1), np.zeros(1)
    end = (tail + 2 * np.log(tail)) / (2 * outer_thickness(solids, a))
    bent = max(bending_length(*solid) for solid in coated)
    return wavenumber_panels(end, 0.5 / bent, 3.0 / a, panel)
