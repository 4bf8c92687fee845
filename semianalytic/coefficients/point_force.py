"""Influence coefficients of a point force on the layered half-space (Boussinesq, Cerruti).

A normal force 1 and a tangential force f in +x at the origin give, with the response functions of unit
traction in the frame of the wave vector (zz, Lz, LL, TT of `frf.stress_frf`; A = s_Tz, B = s_LT of the
anti-plane part), S = (LL + TT)/2, D = (LL - TT)/2 and H_m the Hankel transform of order m,

    s_zz = H0[zz] - f cos t H1[zz]
    s_xz = -cos t H1[Lz] - f (H0[Lz + A] - cos 2t H2[Lz - A]) / 2
    s_yz = -sin t H1[Lz] + f sin 2t H2[Lz - A] / 2
    (s_xx + s_yy)/2 = H0[S] - f cos t H1[S]
    (s_xx - s_yy)/2 = -cos 2t H2[D] - f (cos t H1[D - B] - cos 3t H3[D + B]) / 2
    s_xy            = -sin 2t H2[D] - f (sin t H1[D - B] - sin 3t H3[D + B]) / 2

(x, y) = r (cos t, sin t); the terms without f use the response to p = 1, those with f the response to
T0 = 1, t = 1. Displacements follow the same pattern, with U = u_L and V = u_T:

    u_z = H0[u_z] - f cos t H1[u_z]     u_x = -cos t H1[U] - f (H0[U + V] - cos 2t H2[U - V]) / 2
                                        u_y = -sin t H1[U] + f sin 2t H2[U - V] / 2

Every radial function of the layers is tabulated once per depth over asinh(r / L), which resolves r = 0 as
well as large r. Those of a homogeneous half-space are in closed form, K. L. Johnson, Contact Mechanics,
Cambridge University Press, 1985, sections 3.2 and 3.6: derivatives of V = 1/rho, of chi = ln(rho + z) and of
F1 = z ln(rho + z) - rho.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from semianalytic import numbers
from semianalytic.coefficients.frf import Load, displacement_frf, stress_frf
from semianalytic.coefficients.hankel import LONG, USUAL, hankel, near_axis
from semianalytic.inputs import Body

Array = NDArray[Any]
Response = Callable[[Load], Array]

_INNER = np.linspace(
    0, numbers.NEAR_AXIS, numbers.NEAR_AXIS_RADII, endpoint=False
)  # r / L of the table, as dense as beyond


@dataclass(frozen=True)
class PointForce:
    """Radial functions at one depth below a point force, a spline over asinh(r / scale)."""

    radial: CubicSpline
    scale: float


def stress_below(z: Array, layer: int, scale: float, body: Body, *, excess: bool = False) -> list[PointForce]:
    """Stress below a point force at each depth ``z`` of one layer.

    z : (nz,) [m].  scale : L [m] such that the response decays at least like exp(-k L).
    body : the layers, and the friction.  excess : leave out the homogeneous half-space of the first coating.
    """
    return _tables(stress_frf, stress_columns, z, layer, scale, body, excess=excess, over_k=False)


def displacement_below(
    z: Array, layer: int, scale: float, body: Body, *, excess: bool = False
) -> list[PointForce]:
    """Displacement below a point force at each depth ``z`` of one layer; arguments as in `stress_below`."""
    return _tables(displacement_frf, displacement_columns, z, layer, scale, body, excess=excess, over_k=True)


def _tables(
    frf: Callable[..., Array],
    columns: Callable[[Response, float], list[tuple[Array, int]]],
    z: Array,
    layer: int,
    scale: float,
    body: Body,
    *,
    excess: bool,
    over_k: bool,
) -> list[PointForce]:
    """Splines through the radial functions, at scale times ``_INNER`` and all radii beyond; some are kept."""
    key = (frf.__name__, body.friction, z.tobytes(), layer, scale, excess)
    if key in body.tables:
        found: list[PointForce] = body.tables[key]
        return found
    # a film E, h stretches on a base E' over a length h E/E', bends over less
    moduli = [material[0] for material in body.materials]
    grid = USUAL if sum(body.thickness) * max(moduli) / min(moduli) / scale < 1e4 else LONG
    beyond = grid.radii >= numbers.NEAR_AXIS
    response = partial(frf, grid.wavenumbers / scale, z, layer, **body.layers, excess=excess)
    responses, orders = zip(*columns(lambda load: response(load=load), body.friction), strict=True)
    radial = np.empty((len(orders), z.size, _INNER.size + np.count_nonzero(beyond)))
    for order in set(orders):  # those of one order together, with the transform's coefficients
        some = np.equal(orders, order)
        F = np.array(responses)[some]
        radial[some, :, : _INNER.size] = near_axis(F, order, scale, scale * _INNER, over_k=over_k, grid=grid)
        radial[some, :, _INNER.size :] = hankel(F, order, scale, over_k=over_k, grid=grid)[..., beyond]
    nodes = np.arcsinh(np.concatenate([_INNER, grid.radii[beyond]]))
    found = [PointForce(CubicSpline(nodes, table), scale) for table in np.moveaxis(radial, 0, -1)]
    while len(body.tables) >= numbers.KEPT_TABLES:
        del body.tables[next(iter(body.tables))]
    body.tables[key] = found
    return found


def stress_columns(response: Response, friction: float) -> list[tuple[Array, int]]:
    """Responses F to transform, with the order m: those to p = 1, then with friction to T0 = 1, t = 1.

    response(load) : the amplitudes of `frf.stress_frf`, stacked along the first index.
    """
    zz, Lz, LL, TT = response("normal")
    columns = [(zz, 0), ((LL + TT) / 2, 0), (Lz, 1), ((LL - TT) / 2, 2)]
    if friction:
        zz, Lz, LL, TT = response("in-plane")
        A, B = response("anti-plane")
        D = (LL - TT) / 2
        columns += [(zz, 1), ((LL + TT) / 2, 1), (Lz + A, 0), (Lz - A, 2), (D - B, 1), (D + B, 3)]
    return columns


def displacement_columns(response: Response, friction: float) -> list[tuple[Array, int]]:
    """Displacement by `frf.displacement_frf`, in columns as `stress_columns` gives the stress."""
    uz, U = response("normal")
    columns = [(uz, 0), (U, 1)]
    if friction:
        uz, U = response("in-plane")
        (V,) = response("anti-plane")
        columns += [(uz, 1), (U + V, 0), (U - V, 2)]
    return columns


def directions(c: Array, s: Array) -> Array:
    """Harmonics 1, cos t, sin t, .. cos 3t, sin 3t of the direction (c, s), (7,) + shape of ``c``."""
    c2, s2 = c * c - s * s, 2 * c * s
    return np.stack([np.ones_like(c), c, s, c2, s2, c * c2 - s * s2, s * c2 + c * s2])


def combine_stress(table: Array, harmonics: Array, f: float) -> Array:
    """xx, yy, zz, xy, xz, yz from the radial functions and the harmonics of the direction."""
    Z, S, T, D = table[:4]
    one, c1, s1, c2, s2, c3, s3 = harmonics
    mean, half, zz, xy = S * one, -D * c2, Z * one, -D * s2
    xz, yz = -T * c1, -T * s1
    if f:
        Z1, S1, A0, B2, E1, G3 = f * table[4:]
        mean, zz = mean - S1 * c1, zz - Z1 * c1
        half = half - (E1 * c1 - G3 * c3) / 2
        xy = xy - (E1 * s1 - G3 * s3) / 2
        xz, yz = xz - (A0 * one - B2 * c2) / 2, yz + B2 * s2 / 2
    return np.stack([mean + half, mean - half, zz, xy, xz, yz])


def combine_displacement(table: Array, harmonics: Array, f: float) -> Array:
    """x, y, z from the radial functions and the harmonics of the direction."""
    W, U = table[:2]
    one, c1, s1, c2, s2, *_ = harmonics
    ux, uy, uz = -U * c1, -U * s1, W * one
    if f:
        W1, A0, B2 = f * table[2:]
        ux = ux - (A0 * one - B2 * c2) / 2
        uy, uz = uy + B2 * s2 / 2, uz - W1 * c1
    return np.stack([ux, uy, uz])


def half_space_stress(r: Array, z: Array, nu: float, friction: float) -> Array:
    """Radial functions of a point force on a homogeneous half-space [1/m^2], (4 or 10, n).

    Johnson (1985) eqs. 3.19 and 3.77.  r > 0, z >= 0 [m].
    """
    rho = np.hypot(r, z)
    w, r3, r5, e = rho + z, rho**3, rho**5, 1 - 2 * nu
    g = 1 / (r3 * w) + 1 / (rho * w) ** 2
    across, shear = 3 * r * r * z / r5, 3 * r * z * z / r5
    columns = [-3 * z**3 / r5, (e * z / r3 - across) / 2, shear, (across - e * r * r * g) / 2]
    if friction:
        h = 3 / (r5 * w) + 3 / (rho**4 * w * w) + 2 / (rho * w) ** 3
        s = 1 / (r3 * w * w) + 2 / (rho * rho * w**3)
        third = -(r**3) * (nu * s + z * h / 2)
        first = 2 * r * (1 / r3 - 2 * nu / (rho * w * w) - z * g) - third
        columns += [shear, (1 + nu) * r / r3 - shear / 2, across, -across, first, third]
    return np.array(columns) / (2 * np.pi)


def half_space_displacement(r: Array, z: Array, E: float, nu: float, friction: float) -> Array:
    """Displacement [m/N] in a half-space, (2 or 5, n). Johnson (1985) eqs. 3.18 and 3.76."""
    rho = np.hypot(r, z)
    w, r3, e = rho + z, rho**3, 1 - 2 * nu
    columns = [2 * (1 - nu) / rho + z * z / r3, r * (e / (rho * w) - z / r3)]
    if friction:
        second = r * r * (1 / r3 - e / (rho * w * w))
        columns += [-r * (z / r3 + e / (rho * w)), -2 / rho - 2 * e / w - second, second]
    return np.array(columns) * ((1 + nu) / (2 * np.pi * E))
