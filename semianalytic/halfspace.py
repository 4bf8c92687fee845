"""Closed forms of a half-space: Love's rectangle under pressure, the point forces of Boussinesq and Cerruti.

Under unit pressure on a rectangle the surface deflects by u_z = (1-nu)/(2 pi G) V, V = int int 1/rho with rho
= |point - source|: a sum over its corners, which loses digits as (distance/side)^2; beyond ``FAR`` sides a
series of its moments. A point force has the same with the derivatives of 1/rho, chi = ln(rho + z) and F1 = z
ln(rho + z) - rho, V = 1/rho:

    normal       4 pi G u_x = -(1-2nu) chi_x - z V_x,         4 pi G u_z = 2(1-nu) V - z V_z
    Johnson 3.18 2 pi s_xx = 2nu V_z - (1-2nu) chi_xx - z V_xx,   2 pi s_xy = -(1-2nu) chi_xy - z V_xy
    3.19         2 pi s_zz = V_z - z V_zz,                        2 pi s_xz = -z V_xz
    in +x        4 pi G u = [2V + 2nu F1_xx - z chi_xx,  2nu F1_xy - z chi_xy,  (1-2nu) chi_x - z V_x]
    3.76         2 pi s_xx = 2(1+nu) V_x + 2nu F1_xxx - z chi_xxx,    2 pi s_zz = -z V_xz
    3.77         2 pi s_yy = 2nu V_x + 2nu F1_xyy - z chi_xyy,        2 pi s_yz = -z V_xy
                 2 pi s_xy = V_y + 2nu F1_xxy - z chi_xxy,            2 pi s_xz = V_z - z V_xx

Axes: z into the solid, origin at the force or the centre of the rectangle. Stress positive in tension. SI.

Sources
-------
A. E. H. Love, Phil. Trans. R. Soc. A 228 (1929) 377-420.
K. L. Johnson, Contact Mechanics, Cambridge University Press, 1985, sections 3.2, 3.3 and 3.6.
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.floating]
Field = Callable[[Array, Array, Array, float], tuple[Array, ...]]

FAR = 25.0  # sides; where the errors of closed form and series cross
TINY = 1e-100  # floor of squared lengths: real infinities (edges at z = 0) become finite, alike on both sides


def point_stress(x: Array, y: Array, z: Array, nu: float, *, tangential: bool = True) -> Array:
    """Stress xx, yy, zz, xy, xz, yz of a normal and of a tangential unit force at the origin [1/m^2], (2, 6,
    n).

    Johnson (1985) eqs. 3.19 and 3.77.  x, y, z : [m], not the origin.  tangential : 0 in its place if False.
    """
    return _points(_normal_stress_point, _tangential_stress_point, x, y, z, nu, tangential) / (2 * np.pi)


def point_displacement(
    x: Array, y: Array, z: Array, E: float, nu: float, *, tangential: bool = True
) -> Array:
    """Displacement of the same forces [m/N], (2, 3, n). Johnson (1985) eqs. 3.18 and 3.76."""
    u = _points(_normal_displacement_point, _tangential_displacement_point, x, y, z, nu, tangential)
    return u * ((1 + nu) / (2 * np.pi * E))


def _points(normal: Field, shear: Field, x: Array, y: Array, z: Array, nu: float, tangential: bool) -> Array:
    of_normal = np.array(normal(x, y, z, nu))
    return np.array([of_normal, shear(x, y, z, nu) if tangential else np.zeros_like(of_normal)])


def surface_deflection(n: int, d: float, depth: float = 0.0) -> Array:
    """Potential V of a square of side d at the centres of a grid of squares.

        V(i d, j d, depth),  i, j = 0..n-1;   u_z = (1-nu)/(2 pi G) V at depth 0

    Nearer than ``FAR`` sides Love (1929) eq. 4, with every corner value used by the four squares that share
    it. Beyond, 1/rho and its even derivatives of orders 2, 4 times the moments of the square: no
    cancellation, within 5e-12 of every entry however large the table.

    d, depth [m].  Returns V [m], shape (n, n).
    """
    V: Array = np.empty((n, n))
    near = min(int(np.ceil(np.sqrt(max((FAR * d) ** 2 - depth**2, 0.0)) / d)), n)
    i, j = np.triu_indices(n)
    far = j >= near
    i, j = i[far], j[far]
    V[i, j] = V[j, i] = _potential_series(i * d, j * d, depth, d * d)
    X = (np.arange(near + 1) - 0.5) * d
    corner = _potential_corner(X[:, None], X[None, :], depth)
    V[:near, :near] = np.diff(np.diff(corner, axis=0), axis=1)
    return V


def _potential_series(x: Array, y: Array, z: float, a: float) -> Array:
    """V to the fourth moments of a square of area a: the mean of a Taylor series of 1/rho, by Horner in
    rho^-2."""
    x2, y2 = x * x, y * y
    s = 1 / (x2 + (y2 + z * z))
    sum_ = (105 / 1920 * a * a) * x2 * x2 + (105 / 1920 * a * a) * y2 * y2
    sum_ += (105 / 576 * a * a * x2) * y2
    for of_square, constant in (
        (-(a / 1920 * 90 + a / 576 * 15) * a, 0.0),
        (a / 8, (a * a + a * a) * 9 / 1920 + a * a * 3 / 576),
        (0.0, -(a + a) / 24),
        (0.0, 1.0),
    ):
        sum_ *= s
        sum_ += of_square * x2 + (of_square * y2 + constant)
    sum_ *= np.sqrt(s)
    sum_ *= a
    return sum_


def _potential_corner(X: Array, Y: Array, z: float) -> Array:
    """V."""
    sx, sy = np.maximum(X * X + z * z, TINY), np.maximum(Y * Y + z * z, TINY)
    rho = np.sqrt(np.maximum(sx + Y * Y, TINY))
    V: Array = X * np.asinh(Y / np.sqrt(sx)) + Y * np.asinh(X / np.sqrt(sy)) - z * np.atan2(X * Y, z * rho)
    return V


def _normal_stress_point(X: Array, Y: Array, z: Array, nu: float) -> tuple[Array, ...]:
    rho = np.sqrt(X * X + Y * Y + z * z)
    w, r3, r5 = rho + z, rho**3, rho**5
    g = 1 / (r3 * w) + 1 / (rho * w) ** 2
    e, V_z = 1 - 2 * nu, -z / r3
    return (
        2 * nu * V_z - e * (1 / (rho * w) - X * X * g) - z * (3 * X * X / r5 - 1 / r3),
        2 * nu * V_z - e * (1 / (rho * w) - Y * Y * g) - z * (3 * Y * Y / r5 - 1 / r3),
        -3 * z**3 / r5,
        e * X * Y * g - 3 * X * Y * z / r5,
        -3 * X * z * z / r5,
        -3 * Y * z * z / r5,
    )


def _tangential_stress_point(X: Array, Y: Array, z: Array, nu: float) -> tuple[Array, ...]:
    rho = np.sqrt(X * X + Y * Y + z * z)
    w, r3, r5 = rho + z, rho**3, rho**5
    g = 1 / (r3 * w) + 1 / (rho * w) ** 2
    h = 3 / (r5 * w) + 3 / (rho**4 * w * w) + 2 / (rho * w) ** 3
    s = 1 / (r3 * w * w) + 2 / (rho * rho * w**3)
    V_x, V_y, V_xz = -X / r3, -Y / r3, 3 * X * z / r5
    chi_xyy = -X * g + X * Y * Y * h
    F_xyy = X / (rho * w * w) - X * Y * Y * s
    F_xxy = Y / (rho * w * w) - X * X * Y * s
    return (
        2 * (1 + nu) * V_x - 2 * nu * (F_xyy + V_x) + z * (chi_xyy + V_xz),
        2 * nu * (V_x + F_xyy) - z * chi_xyy,
        -z * V_xz,
        V_y + 2 * nu * F_xxy - z * (X * X * Y * h - Y * g),
        -3 * X * X * z / r5,
        -3 * X * Y * z / r5,
    )


def _normal_displacement_point(X: Array, Y: Array, z: Array, nu: float) -> tuple[Array, ...]:
    rho = np.sqrt(X * X + Y * Y + z * z)
    lateral = -(1 - 2 * nu) / (rho * (rho + z)) + z / rho**3
    return X * lateral, Y * lateral, 2 * (1 - nu) / rho + z * z / rho**3


def _tangential_displacement_point(X: Array, Y: Array, z: Array, nu: float) -> tuple[Array, ...]:
    rho = np.sqrt(X * X + Y * Y + z * z)
    w = rho + z
    e = 1 - 2 * nu
    cross = 1 / rho**3 - e / (rho * w * w)
    return 1 / rho + e / w + X * X * cross, X * Y * cross, X * z / rho**3 + e * X / (rho * w)
