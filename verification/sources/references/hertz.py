"""Hertz contact of a sphere, rigid or elastic, on a homogeneous elastic half-space, at rest or sliding.

Friction q = f p in +x, on the ball in -x, leaves the pressure as it is (Goodman's assumption). The field of
sliding is that of Hamilton, Proc. Inst. Mech. Engrs 197C (1983) 53-59, and Sackfield and Hills, J. Strain
Anal. 18 (1983) 107-110, who write it in real terms.

Axes: origin at first contact, ``z`` into the body in question. Stress is positive in tension, pressure
positive in compression, hence sigma_zz = -p at z = 0. SI units.

H. Hertz, J. reine angew. Math. 92 (1882) 156-171; M. T. Huber, Ann. Phys. 319 (1904) 153-163, for the field
off the axis; K. L. Johnson, Contact Mechanics, Cambridge University Press, 1985.

With lengths over a, zeta = z - i, R = sqrt(r^2 + zeta^2), tau = r / (R + zeta) the integrals over wavenumbers

    L_m^n = int_0^inf k^n J_m(kr) e^(-k zeta) dk:   L_m^0 = tau^m / R,   L_m^-1 = tau^m / m,
    L_m^-2 = r (L_(m-1)^-1 + L_(m+1)^-1) / 2m,      L_0^-1 = -ln(zeta + R),   L_0^-2 = zeta ln(zeta + R) - R,
    L_m^-3 = r (L_(m-1)^-2 + L_(m+1)^-2) / 2m,      L_0^-3 = (r^2 - 2 zeta^2) ln(zeta + R) / 4 + 3 zeta R / 4

give, from phat(k) = p0 (sin k - k cos k) / k^3,

    A_m = int phat J_m e^(-kz) k dk     = p0 (Im L_m^-2 - Re L_m^-1)
    B_m = int phat J_m e^(-kz) z k^2 dk = p0 z (Im L_m^-1 - Re L_m^0)
    C_m = int phat J_m e^(-kz) dk       = p0 (Im L_m^-3 - Re L_m^-2)
"""

from dataclasses import dataclass, field, replace
from typing import ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from verification.problem.array_types import Array
from verification.problem.coated_contact import ScalarUncertainty
from verification.problem.point_answers import BALL, FLAT, ByFunctions

Complex = NDArray[np.complex128]


@dataclass(frozen=True)
class Hertz(ByFunctions):
    """Sphere of ``radius`` [m] under ``load`` [N] on a solid of ``E`` [Pa], ``nu``; q = ``friction`` p.

    ball : (E [Pa], nu) of the sphere, None where it is rigid.
    Raises ValueError naming the quantity that is out of range.
    """

    radius: float
    load: float
    E: float
    nu: float
    friction: float = 0.0
    ball: tuple[float, float] | None = field(default=None, kw_only=True)
    diagnostics: ClassVar[None] = None

    def __post_init__(self) -> None:
        for name in ("radius", "load", "E"):
            if not getattr(self, name) > 0:
                raise ValueError(f"{name} = {getattr(self, name):g}; Hertz needs it positive")
        if not -1 < self.nu <= 0.5:
            raise ValueError(f"nu = {self.nu:g}; an isotropic solid has -1 < nu <= 0.5")
        if self.ball is not None and not (self.ball[0] > 0 and -1 < self.ball[1] <= 0.5):
            raise ValueError(f"ball = {self.ball}; Hertz needs E > 0 and -1 < nu <= 0.5")
        if not (np.isfinite(self.friction) and self.friction >= 0):
            raise ValueError(f"friction = {self.friction:g}; Coulomb's coefficient is zero or positive")

    @property
    def E_star(self) -> float:
        """Contact modulus [Pa], 1/E* = (1 - nu^2)/E of the solid plus that of the ball. Johnson (4.20)."""
        if self.ball is None:
            return self.E / (1 - self.nu**2)
        return 1 / ((1 - self.nu**2) / self.E + (1 - self.ball[1] ** 2) / self.ball[0])

    def _seen_from(self, body: str) -> tuple[Self, float]:
        """The contact with ``body`` as the solid, and q/p on it. Raises ValueError where it is rigid."""
        if body == FLAT:
            return self, self.friction
        if body != BALL or self.ball is None:
            raise ValueError(f"body = {body!r}; this contact has an elastic {FLAT} alone")
        E, nu = self.ball
        return replace(self, E=E, nu=nu, ball=(self.E, self.nu)), -self.friction

    @property
    def contact_radius(self) -> float:
        """a = (3 W R / 4 E*)^(1/3) [m]. Johnson (4.22)."""
        return (3 * self.load * self.radius / (4 * self.E_star)) ** (1 / 3)

    @property
    def approach(self) -> float:
        """delta = a^2 / R [m]. Johnson (4.23)."""
        return self.contact_radius**2 / self.radius

    @property
    def stiffness(self) -> float:
        """dW/d delta = 2 E* a [N/m], from W = 4/3 E* sqrt(R) delta^(3/2)."""
        return 2 * self.E_star * self.contact_radius

    @property
    def peak_pressure(self) -> float:
        """p0 = 3 W / (2 pi a^2) [Pa]. Johnson (4.24)."""
        return 3 * self.load / (2 * np.pi * self.contact_radius**2)

    @property
    def uncertainty(self) -> ScalarUncertainty:
        """Zero: exact."""
        return ScalarUncertainty()

    def pressure(self, x: ArrayLike, y: ArrayLike = 0.0) -> Array:
        """p = p0 sqrt(1 - r^2/a^2) inside the contact, 0 outside [Pa]. Johnson (3.39)."""
        r = np.hypot(x, y)
        return self.peak_pressure * np.sqrt(np.maximum(1 - (r / self.contact_radius) ** 2, 0))

    def stress(
        self, x: ArrayLike, y: ArrayLike, z: ArrayLike, layer: int | None = None, body: str = FLAT
    ) -> Array:
        """sigma[i, j, ...] [Pa], shape (3, 3) + points: that of the pressure and that of the friction.

        One material: ``layer`` is accepted and has no meaning here. Raises ValueError where z < 0.
        """
        contact, f = self._seen_from(body)
        normal = contact._stress_of_pressure(*_below(x, y, z))
        return normal + f * contact.stress_of_traction(x, y, z) if f else normal

    def _stress_of_pressure(self, x: Array, y: Array, z: Array) -> Array:
        """Stress without friction [Pa], shape (3, 3) + points. Huber (1904); on the surface Johnson (3.43).

        w^2 = [r^2+z^2-a^2 + sqrt((r^2+z^2-a^2)^2 + 4 a^2 z^2)] / 2,   s = z/w
        sigma_zz = -p0 s^3 a^2 w^2 / (w^4 + a^2 z^2)
        sigma_rz = -p0 r z^2 a^2 w / ((w^4 + a^2 z^2) (a^2 + w^2))
        """
        a, p0, nu = self.contact_radius, self.peak_pressure, self.nu
        r, theta = np.hypot(x, y) / a, np.arctan2(y, x)
        z = z / a
        # With lengths over a. The root is taken so that nothing cancels inside the contact.
        d = r**2 + z**2 - 1
        root = np.hypot(d, 2 * z)
        w2 = np.where(d >= 0, (d + root) / 2, 2 * z**2 / np.where(d >= 0, 1.0, root - d))
        w = np.sqrt(w2)
        # On the surface inside the contact z and w vanish together, where s^2 = z^2/w^2 = (root - d)/2.
        s = np.sqrt(np.where(d >= 0, 2 * z**2 / np.where(root + d > 0, root + d, 1.0), (root - d) / 2))
        arc = np.arctan2(1.0, w)
        # (1 - s^3)/r^2 is 0/0 on the axis, where its limit is 3 / (2 (1 + z^2)) for s -> 1.
        near = r < 1e-4
        ring = np.where(near, 1.5 / (1 + z**2), (1 - s**3) / np.where(near, 1.0, r**2))
        size = np.where((size := w2 * w2 + z**2) == 0, 1.0, size)
        lens = w2 * s / size * s**2
        lens = np.where(w2 == 0, np.sqrt(np.maximum(-d, 0.0)), lens)
        radial = (1 - 2 * nu) / 3 * ring + lens + s * (w2 * (1 - nu) / (1 + w2) + (1 + nu) * w * arc - 2)
        hoop = -(1 - 2 * nu) / 3 * ring - s * (2 * nu + w2 * (1 - nu) / (1 + w2) - (1 + nu) * w * arc)
        shear = -r * z**2 * w / size / (1 + w2)
        sigma = np.zeros((3, 3, *x.shape))
        mean, deviator = p0 * (radial + hoop) / 2, p0 * (radial - hoop) / 2
        sigma[0, 0] = mean + deviator * np.cos(2 * theta)
        sigma[1, 1] = mean - deviator * np.cos(2 * theta)
        sigma[0, 1] = sigma[1, 0] = deviator * np.sin(2 * theta)
        sigma[2, 2] = -p0 * lens
        sigma[0, 2] = sigma[2, 0] = p0 * shear * np.cos(theta)
        sigma[1, 2] = sigma[2, 1] = p0 * shear * np.sin(theta)
        return sigma

    def stress_of_traction(self, x: ArrayLike, y: ArrayLike, z: ArrayLike) -> Array:
        """Stress under q = p in +x alone, without the pressure [Pa], shape (3, 3) + points.

            sigma_xx = -[(2 + nu/2) A1 - 3/4 B1] cos theta - [nu/2 A3 + 1/4 B3] cos 3 theta
            sigma_yy = -[(3 nu/2) A1 - 1/4 B1] cos theta   + [nu/2 A3 + 1/4 B3] cos 3 theta
            sigma_xy = -[(1 - nu/2) A1 - 1/4 B1] sin theta - [nu/2 A3 + 1/4 B3] sin 3 theta
            sigma_zz = -B1 cos theta
            sigma_xz = -[A0 - 1/2 B0] - 1/2 B2 cos 2 theta,   sigma_yz = -1/2 B2 sin 2 theta

        Derived from the response of the half-space to each wave of q. Raises ValueError where z < 0.
        """
        x, y, z = _below(x, y, z)
        a, nu = self.contact_radius, self.nu
        theta = np.arctan2(y, x)
        (A0, A1, _, A3), (B0, B1, B2, B3), _ = integrals(np.hypot(x, y) / a, z / a)
        third = nu / 2 * A3 + B3 / 4
        sigma = np.zeros((3, 3, *x.shape))
        sigma[0, 0] = -((2 + nu / 2) * A1 - 0.75 * B1) * np.cos(theta) - third * np.cos(3 * theta)
        sigma[1, 1] = -(1.5 * nu * A1 - 0.25 * B1) * np.cos(theta) + third * np.cos(3 * theta)
        sigma[0, 1] = -((1 - nu / 2) * A1 - 0.25 * B1) * np.sin(theta) - third * np.sin(3 * theta)
        sigma[2, 2] = -B1 * np.cos(theta)
        sigma[0, 2] = -(A0 - 0.5 * B0) - 0.5 * B2 * np.cos(2 * theta)
        sigma[1, 2] = -0.5 * B2 * np.sin(2 * theta)
        for i, j in ((1, 0), (2, 0), (2, 1)):
            sigma[i, j] = sigma[j, i]
        return self.peak_pressure * sigma

    def displacement(self, x: ArrayLike, y: ArrayLike, z: ArrayLike, body: str = FLAT) -> Array:
        """u[i, ...] [m] towards points at infinity, shape (3,) + points. With c = p0 a (1 + nu)/E:

            u_r = -c [(1 - 2 nu) C1 - z A1],    u_z = c [2 (1 - nu) C0 + z A0]
            friction:  u_x = c f [(2 - nu) C0 - z A0 / 2 + (nu C2 + z A2 / 2) cos 2 theta],
                u_y = c f (nu C2 + z A2 / 2) sin 2 theta,    u_z = c f [(1 - 2 nu) C1 + z A1] cos theta

        Derived from the response of the half-space to each wave of p and q: Boussinesq and Cerruti, Johnson
        (3.19), (3.75). Raises ValueError where z < 0.
        """
        (contact, f), (x, y, z) = self._seen_from(body), _below(x, y, z)
        a, nu, theta = contact.contact_radius, contact.nu, np.arctan2(y, x)
        z = z / a
        (A0, A1, A2, _), _, (C0, C1, C2) = integrals(np.hypot(x, y) / a, z)
        u_r = -((1 - 2 * nu) * C1 - z * A1)
        second = nu * C2 + z * A2 / 2
        u = np.stack(
            [
                u_r * np.cos(theta) + f * ((2 - nu) * C0 - z * A0 / 2 + second * np.cos(2 * theta)),
                u_r * np.sin(theta) + f * second * np.sin(2 * theta),
                2 * (1 - nu) * C0 + z * A0 + f * ((1 - 2 * nu) * C1 + z * A1) * np.cos(theta),
            ]
        )
        return contact.peak_pressure * a * (1 + nu) / contact.E * u


def _below(x: ArrayLike, y: ArrayLike, z: ArrayLike) -> tuple[Array, ...]:
    """Points as arrays of one shape. Raises ValueError where z < 0."""
    x, y, z = np.broadcast_arrays(*(np.asarray(v, dtype=float) for v in (x, y, z)))
    if np.any(z < 0):
        raise ValueError(f"z = {np.min(z):g} m is above the surface; depth counts down from 0")
    return x, y, z


def integrals(r: Array, z: Array) -> tuple[list[Array], list[Array], list[Array]]:
    """A_m / p0 and B_m / p0 for m = 0 .. 3, C_m / p0 for m = 0 .. 2 at ``r``, ``z`` over a."""
    zeta = z - 1j
    R = _root(r, z)
    log = np.log(zeta + R)
    tau = r / (zeta + R)
    powers: list[Complex] = [-log] + [tau**m / m for m in range(1, 5)]
    second = [zeta * log - R] + [r / (2 * m) * (powers[m - 1] + powers[m + 1]) for m in range(1, 4)]
    # z/R vanishes towards the edge, where z and R are both zero.
    z_over_R = np.where(R == 0, 0.0, z / np.where(R == 0, 1.0, R))
    A = [second[m].imag - powers[m].real for m in range(4)]
    B = [z * powers[m].imag - (tau**m * z_over_R).real for m in range(4)]
    third = [(r**2 - 2 * zeta**2) / 4 * log + 0.75 * zeta * R]
    third += [r / (2 * m) * (second[m - 1] + second[m + 1]) for m in (1, 2)]
    C = [third[m].imag - second[m].real for m in range(3)]
    return A, B, C


def _root(r: Array, z: Array) -> Complex:
    """R = sqrt(r^2 + (z - i)^2) with Re R >= 0 >= Im R, which on the surface is the limit from below it."""
    d = (r - 1) * (r + 1) + z**2
    size = np.hypot(d, 2 * z)
    # The larger part first, without a difference; the product of both is z.
    larger = np.sqrt((size + np.abs(d)) / 2)
    smaller = z / np.where(larger == 0, 1.0, larger)
    return np.where(d >= 0, larger - 1j * smaller, smaller - 1j * larger)
