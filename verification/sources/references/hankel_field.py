"""Stress of a layered half-space under an axisymmetric pressure, by Hankel quadrature.

Normal load, then friction q = f p in +x (the first, second and third harmonics around the axis):

    sigma_rz = -int T phat J1 k dk,   sigma_zz = int S phat J0 k dk
    sigma_xx, sigma_yy = int (ll+tt)/2 phat J0 k dk -+ cos 2theta int (ll-tt)/2 phat J2 k dk
    u_r = -int U phat J1 k dk,         u_z = int w phat J0 k dk
    friction: u_x = f int [-(U+V)/2 J0 + (U-V)/2 cos 2theta J2] phat k dk,
              u_y = f int (U-V)/2 sin 2theta J2 phat k dk,   u_z = -f cos theta int w phat J1 k dk

Amplitudes per wavenumber come from ``layered``; on the surface the homogeneous part, which decays too
slowly for quadrature, is taken in closed form from the Abel potential of the pressure.
Sneddon, Fourier Transforms (1951); sliding derived by rotation of the wave vector's frame.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from math import factorial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import j0, j1

from verification.problem.array_types import Array, Coatings
from verification.problem.evaluation_points import layer_at
from verification.problem.gauss_legendre import wavenumber_panels
from verification.sources.references.layered_half_space import Amplitudes, LayeredHalfSpace, bending_length

CHUNK = 2_000_000  # products of wavenumbers with radii held in memory at once
KEPT = 16  # depths of which the amplitudes are kept, for the other fields at the same points
KEPT_SIZE = 100_000  # wavenumbers of a plane that is kept
MOST = 4_000_000  # wavenumbers: as many need a gigabyte


@dataclass(frozen=True, eq=False)
class HankelField:
    """Stress below ``pressure``, with friction q = f p, in ``coatings`` on ``substrate``.

    pressure : an AbelPressure, UniformDisc or FirstHarmonic.
    nodes : Gauss points a panel; tail : exponent at which the decaying integrands are cut.
    """

    pressure: Any
    coatings: Coatings
    substrate: tuple[float, float]
    friction: float = 0.0
    nodes: int = 16
    tail: float = 36.0
    _kept: dict[tuple[float, int, float], tuple[Array, Array, list[Amplitudes]]] = field(
        default_factory=dict, init=False, repr=False
    )

    def stress(self, x: ArrayLike, y: ArrayLike, z: ArrayLike, layer: int | None = None) -> Array:
        """sigma[i, j, ...] [Pa], shape (3, 3) + points; ``layer`` as in ``layer_at``."""
        return self._by_planes(self._plane, (3, 3), x, y, z, layer)

    def displacement(self, x: ArrayLike, y: ArrayLike, z: ArrayLike) -> Array:
        """u[i, ...] [m] towards infinity, shape (3,) + points."""
        return self._by_planes(self._displaced, (3,), x, y, z, None)

    def _by_planes(
        self,
        field: Callable[[Array, Array, float, int], Array],
        axes: tuple[int, ...],
        x: ArrayLike,
        y: ArrayLike,
        z: ArrayLike,
        layer: int | None,
    ) -> Array:
        """Points of one depth and layer together, by ``field`` (r, theta, depth, layer)."""
        x, y, z = np.broadcast_arrays(*(np.asarray(v, dtype=float) for v in (x, y, z)))
        layers = layer_at(z, self.coatings, layer)
        found, r, theta = np.zeros((*axes, *x.shape)), np.hypot(x, y), np.arctan2(y, x)
        for depth, number in set(zip(z.ravel().tolist(), layers.ravel().tolist(), strict=True)):
            here = (z == depth) & (layers == number)
            found[..., here] = field(r[here], theta[here], depth, number)
        return found

    def _displaced(self, r: Array, theta: Array, z: float, layer: int) -> Array:
        u = np.zeros((3, r.size))
        if z == 0:
            u += self._homogeneous_displacement(r, theta)
            if not self.coatings:
                return u
        k, weighted, (normal, *tangential) = self.waves(r, z, layer)
        J = bessel(k, r, highest=2 if self.friction else 1)
        u_r = -(weighted * normal.U) @ J[1]
        u += np.stack([u_r * np.cos(theta), u_r * np.sin(theta), (weighted * normal.w) @ J[0]])
        if self.friction:
            A, B = tangential
            difference = (weighted * (A.U - B.V)) @ J[2] / 2
            u[0] += self.friction * (np.cos(2 * theta) * difference - (weighted * (A.U + B.V)) @ J[0] / 2)
            u[1] += self.friction * np.sin(2 * theta) * difference
            u[2] -= self.friction * np.cos(theta) * ((weighted * A.w) @ J[1])
        return u

    def _homogeneous_displacement(self, r: Array, theta: Array) -> Array:
        """Surface displacement of the solid of the top material: Johnson (3.18) and (3.75), integrated.

        u_r = -(1 - 2 nu)/(2 G) I1,   u_z = (1 - nu)/G I0,   I_m = int phat(k) J_m(kr) dk
        friction:  u_x = f [(1 - nu/2) I0 + nu/2 cos(2 theta) I2]/G,   u_y = f nu/2 sin(2 theta) I2 / G,
                   u_z = f (1 - 2 nu)/(2 G) cos(theta) I1
        """
        E, nu = self.coatings[0][:2] if self.coatings else self.substrate
        G, f = E / (2 * (1 + nu)), self.friction
        # the load inside r moves the surface towards the axis
        I1 = np.where(r > 0, self.pressure.resultant(r) / np.where(r > 0, r, 1.0), 0.0)
        u_r = -(1 - 2 * nu) / (2 * G) * I1
        u_z = (1 - nu**2) / E * self.pressure.sink(r) - f * u_r * np.cos(theta)
        u = np.stack([u_r * np.cos(theta), u_r * np.sin(theta), u_z])
        if f:
            I0, I2 = (self.pressure.over_circle(order, r) for order in (0, 2))
            u[0] += f / G * ((1 - nu / 2) * I0 + nu / 2 * np.cos(2 * theta) * I2)
            u[1] += f / G * nu / 2 * np.sin(2 * theta) * I2
        return u

    def _plane(self, r: Array, theta: Array, z: float, layer: int) -> Array:
        total = np.zeros((3, 3, r.size))
        if z == 0:
            total += self._homogeneous_surface(r, theta)
            if not self.coatings:
                return total
        k, weighted, (normal, *tangential) = self.waves(r, z, layer)
        radii, at = np.unique(r, return_inverse=True)  # points on both sides of the axis share theirs
        pressed, slid = np.zeros((4, radii.size)), np.zeros((7, radii.size))
        step = max(1, CHUNK // k.size)
        for start in range(0, radii.size, step):
            part = slice(start, start + step)
            J = bessel(k, radii[part], highest=3 if self.friction else 2)
            pressed[:, part] = _of_normal(normal, weighted, J)
            if self.friction:
                slid[:, part] = _of_sliding(tangential, weighted, J)
        total += _normal(pressed[:, at], theta)
        if self.friction:
            total += self.friction * _sliding(slid[:, at], theta)
        return total

    def waves(self, r: Array, z: float, layer: int) -> tuple[Array, Array, list[Amplitudes]]:
        """Wavenumbers, weights of the integrals with k phat(k), amplitudes of each load at depth ``z``.

        On the surface the amplitudes are those in excess of the homogeneous solid of the top material.
        """
        key = (z, layer, float(r.max(initial=0.0)))
        if key in self._kept:
            return self._kept[key]
        if len(self._kept) >= KEPT:
            self._kept.clear()
        found = self._amplitudes(*key)
        if found[0].size <= KEPT_SIZE:
            self._kept[key] = found
        return found

    def _amplitudes(self, z: float, layer: int, r: float) -> tuple[Array, Array, list[Amplitudes]]:
        k, weight = self._wavenumbers(z or 2 * self.coatings[0][2], r)
        solid = LayeredHalfSpace(self.coatings, self.substrate, k)
        loads = ("normal", "shear", "antiplane") if self.friction else ("normal",)
        found = [solid.amplitudes(z, layer, load) for load in loads]
        if z == 0:
            bare = LayeredHalfSpace((), (float(solid.E[0]), float(solid.nu[0])), k)
            known = [bare.amplitudes(z, 0, load) for load in loads]
            found = [
                Amplitudes(**{name: getattr(A, name) - getattr(B, name) for name in vars(A)})
                for A, B in zip(found, known, strict=True)
            ]
        return k, weight * k * self.pressure.transform(k), found

    def _wavenumbers(self, reach: float, r: float) -> tuple[Array, Array]:
        """Gauss panels up to tail/reach, no wider than the oscillation of J(kr) cos(ka), finer near 0."""
        end = (self.tail + 2 * np.log(self.tail)) / reach
        bent = bending_length(self.coatings, self.substrate) if self.coatings else 0.0
        deepest = max(bent, reach, self.pressure.a)
        count = self.nodes * end * (self.pressure.a + r) / 8
        if count > MOST:
            raise ValueError(
                f"depth z = {reach:g} m (on the surface twice the first coating's thickness) with contact "
                f"radius a = {self.pressure.a:g} m needs {count:.2g} wavenumbers; choose z = 0 or a depth "
                "above 1e-4 a, a coating above half of that"
            )
        return wavenumber_panels(end, 1 / deepest, 8 / (self.pressure.a + r), self.nodes)

    def _homogeneous_surface(self, r: Array, theta: Array) -> Array:
        """Surface stress of the homogeneous solid of the top layer's material. Johnson (3.21), (3.75)."""
        nu = self.coatings[0][1] if self.coatings else self.substrate[1]
        p = self.pressure.pressure(r)
        centre = r < 1e-7 * self.pressure.a
        safe = np.where(centre, 1.0, r)
        mean = np.where(centre, p / 2, self.pressure.resultant(r) / safe**2)
        radial, hoop = -p + (1 - 2 * nu) * mean, -2 * nu * p - (1 - 2 * nu) * mean
        sigma = _rotate((radial + hoop) / 2, (radial - hoop) / 2, theta)
        sigma[2, 2] = -p
        if self.friction:
            q1 = self.friction * self.pressure.bessel_integral(1, r)
            q3 = self.friction * self.pressure.bessel_integral(3, r)
            sigma[0, 0] -= (4 + nu) / 2 * q1 * np.cos(theta) + nu / 2 * q3 * np.cos(3 * theta)
            sigma[1, 1] += -3 * nu / 2 * q1 * np.cos(theta) + nu / 2 * q3 * np.cos(3 * theta)
            sigma[0, 1] -= (1 - nu / 2) * q1 * np.sin(theta) + nu / 2 * q3 * np.sin(3 * theta)
            sigma[1, 0] = sigma[0, 1]
            sigma[0, 2] = sigma[2, 0] = -self.friction * p
        return sigma


def bessel(k: Array, r: Array, highest: int) -> list[Array]:
    """J_0 .. J_highest of k r, each of shape (k, r)."""
    kr = k[:, None] * r[None, :]
    J = [j0(kr), j1(kr)]
    small = kr < 2.0
    safe = np.where(small, 1.0, kr)
    for n in range(2, highest + 1):
        # Upward recurrence loses digits where kr is below the order; the series has few terms there.
        J.append(2 * (n - 1) / safe * J[-1] - J[-2])
        J[-1][small] = _ascending(n, kr[small])
    return J


def _ascending(n: int, x: Array) -> Array:
    """J_n of 0 <= ``x`` < 2 by its series in x/2; the terms left out are below 1e-17 of it."""
    square, total = -((x / 2) ** 2), np.ones_like(x)
    for m in range(10, 0, -1):
        total = 1 + square / (m * (m + n)) * total
    return (x / 2) ** n / factorial(n) * total


def _rotate(mean: Array, deviator: Array, theta: Array) -> Array:
    """In-plane tensor with radial and hoop components mean +- deviator, in x and y."""
    sigma = np.zeros((3, 3, theta.size))
    sigma[0, 0] = mean + deviator * np.cos(2 * theta)
    sigma[1, 1] = mean - deviator * np.cos(2 * theta)
    sigma[0, 1] = sigma[1, 0] = deviator * np.sin(2 * theta)
    return sigma


def _of_normal(A: Amplitudes, weighted: Array, J: list[Array]) -> Array:
    """Integrals over the wavenumber of which ``_normal`` consists, (4, r)."""
    mean, deviator = (weighted * (A.ll + A.tt) / 2) @ J[0], -(weighted * (A.ll - A.tt) / 2) @ J[2]
    return np.stack([mean, deviator, (weighted * A.S) @ J[0], -(weighted * A.T) @ J[1]])


def _normal(integrals: Array, theta: Array) -> Array:
    mean, deviator, axial, sigma_rz = integrals
    sigma = _rotate(mean, deviator, theta)
    sigma[2, 2] = axial
    sigma[0, 2] = sigma[2, 0] = sigma_rz * np.cos(theta)
    sigma[1, 2] = sigma[2, 1] = sigma_rz * np.sin(theta)
    return sigma


def _of_sliding(loads: Sequence[Amplitudes], weighted: Array, J: list[Array]) -> Array:
    """Integrals over the wavenumber of which ``_sliding`` consists, (7, r).

    loads : A in-plane, B anti-plane.
    """
    A, B = loads
    first = (3 * A.ll + A.tt - 2 * B.lt, A.ll + 3 * A.tt + 2 * B.lt, A.ll - A.tt - 2 * B.lt, 4 * A.S)
    return np.stack(
        [
            *(np.stack(first) * weighted / 4 @ J[1]),
            (weighted * (A.ll - A.tt + 2 * B.lt)) @ J[3] / 4,
            (weighted * (A.T - B.t)) @ J[2] / 2,
            -((weighted * (A.T + B.t)) @ J[0]) / 2,
        ]
    )


def _sliding(integrals: Array, theta: Array) -> Array:
    """Response to unit q_x: in-plane, times i cos(alpha), with anti-plane, times sin(alpha)."""
    along, across, sheared, axial, third, difference, mean = integrals
    c1, s1, c2, s2, c3, s3 = (f(n * theta) for n in (1, 2, 3) for f in (np.cos, np.sin))
    sigma = np.zeros((3, 3, theta.size))
    sigma[0, 0] = -c1 * along + c3 * third
    sigma[1, 1] = -c1 * across - c3 * third
    sigma[0, 1] = -s1 * sheared + s3 * third
    sigma[2, 2] = -c1 * axial
    sigma[0, 2] = mean + c2 * difference
    sigma[1, 2] = s2 * difference
    for i, j in ((1, 0), (2, 0), (2, 1)):
        sigma[i, j] = sigma[j, i]
    return sigma
