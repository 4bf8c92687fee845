"""Stress in the plane y = 0 under a pressure p1(r) cos(theta), or under that traction in +x.

With phat1 = int p1 J1 r dr, amplitudes of ``layered`` for each wave (those of the shear load with T = 1 and
t = 1), A1 = (3 ll + tt - 2 lt)/4, A3 = (ll - tt + 2 lt)/4, c = +-1 at the two sides of the axis:

    pressure:   sigma_xx = c int [(3 ll + tt)/4 J1 - (ll - tt)/4 J3] phat1 k dk
                sigma_xz = int T/2 (J0 - J2) phat1 k dk
    traction:   sigma_xx = int [A1/2 J0 - (A1 + A3)/2 J2 + A3/2 J4] phat1 k dk
                sigma_xz = -c int [(3 T + t)/4 J1 - (T - t)/4 J3] phat1 k dk

On the surface outside the contact the homogeneous solid of the top layer has, with m = int p1 r^2 dr and
I_n = int phat1 J_n k dk, closed but for I_n,

    pressure:   sigma_xx = c (1 - 2 nu) m/r^3,      traction:   sigma_xx = (4 + nu)/4 I0 - I2 - nu/4 I4.

Derived as the axisymmetric fields of ``hankel``, with one more factor -i cos(alpha) of the wave's direction.
"""

from typing import NamedTuple

import numpy as np

from verification.problem.array_types import Array, Coatings
from verification.sources.assumptions.sliding_coupling import FirstHarmonic
from verification.sources.references.hankel_field import HankelField, bessel


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
    """Stress at depth ``z`` of ``layer`` by p1 cos(theta), then by it as a traction in +x.

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
