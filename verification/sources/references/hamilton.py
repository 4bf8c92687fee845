"""Sliding contact of a sphere on a homogeneous elastic half-space, all six stresses in closed form.

Friction q = f p in +x under Hertz's pressure, which it leaves as it is (Goodman's assumption). The integrals
A_m and B_m of ``hertz`` give every stress, without a division by r. The field is that of Hamilton, Proc.
Inst. Mech. Engrs 197C (1983) 53-59, and Sackfield and Hills, J. Strain Anal. 18 (1983) 107-110, who write it
in real terms.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from verification.problem.array_types import Array
from verification.problem.point_answers import BALL, FLAT
from verification.sources.references.hertz import Hertz, HertzContact, integrals


@dataclass(frozen=True)
class Hamilton(HertzContact):
    """Sphere of ``radius`` [m] under ``load`` [N] on a solid of ``E`` [Pa], ``nu``; q = ``friction`` p.

    Contact radius, approach and pressure are those without friction.
    """

    friction: float

    def __post_init__(self) -> None:
        if not (np.isfinite(self.friction) and self.friction >= 0):
            raise ValueError(f"friction = {self.friction:g}; Coulomb's coefficient is zero or positive")
        super().__post_init__()

    def stress(
        self, x: ArrayLike, y: ArrayLike, z: ArrayLike, layer: int | None = None, body: str = FLAT
    ) -> Array:
        """sigma[i, j, ...] [Pa], shape (3, 3) + points: Hertz and Huber's field and that of the friction.

        The traction on the ball is -q.
        One material: ``layer`` is accepted and has no meaning here. Raises ValueError where z < 0.
        """
        contact = self.seen_from(body)
        normal = Hertz(contact.radius, contact.load, contact.E, contact.nu, ball=contact.ball)
        f = -self.friction if body == BALL else self.friction
        return normal.stress(x, y, z) + f * contact.stress_of_traction(x, y, z)

    def stress_of_traction(self, x: ArrayLike, y: ArrayLike, z: ArrayLike) -> Array:
        """Stress under q = p in +x alone, without the pressure [Pa], shape (3, 3) + points.

            sigma_xx = -[(2 + nu/2) A1 - 3/4 B1] cos theta - [nu/2 A3 + 1/4 B3] cos 3 theta
            sigma_yy = -[(3 nu/2) A1 - 1/4 B1] cos theta   + [nu/2 A3 + 1/4 B3] cos 3 theta
            sigma_xy = -[(1 - nu/2) A1 - 1/4 B1] sin theta - [nu/2 A3 + 1/4 B3] sin 3 theta
            sigma_zz = -B1 cos theta
            sigma_xz = -[A0 - 1/2 B0] - 1/2 B2 cos 2 theta,   sigma_yz = -1/2 B2 sin 2 theta

        Derived from the response of the half-space to each wave of q. Raises ValueError where z < 0.
        """
        x, y, z = np.broadcast_arrays(*(np.asarray(v, dtype=float) for v in (x, y, z)))
        if np.any(z < 0):
            raise ValueError(f"z = {np.min(z):g} m is above the surface; depth counts down from 0")
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
        """u[i, ...] [m] towards points at infinity, shape (3,) + points. Raises ValueError where z < 0."""
        f = -self.friction if body == BALL else self.friction
        return self.seen_from(body)._displaced(x, y, z, f)
