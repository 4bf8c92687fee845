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

Every radial function is tabulated once per depth over asinh(r / L), which resolves r = 0 as well as large r.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from .frf import Load, displacement_frf, stress_frf
from .hankel import NEAR, LogGrid, hankel, log_grid, near_axis
from .inputs import Body

__all__ = [
    "PointForce",
    "displacement_below",
    "displacement_from_lines",
    "stress_below",
    "stress_from_lines",
]

Array = NDArray[Any]
Field = Callable[[Array, Array], Array]

_INNER = np.linspace(0, NEAR, 60, endpoint=False)  # r / L of the table, as dense as beyond


@dataclass(frozen=True)
class PointForce:
    """Field at one depth of a normal force 1 with a tangential force ``friction``, as radial tables."""

    radial: CubicSpline
    scale: float
    friction: float
    combine: Callable[[Array, Array, Array, float], Array]

    def __call__(self, x: Array, y: Array) -> Array:
        """Components at offsets (x, y) [m] from the force; (6 or 3,) + shape of ``x``.

        Stress xx, yy, zz, xy, xz, yz [1/m^2]; displacement x, y, z [m/N].
        """
        r = np.hypot(x, y)
        table = self.radial(np.arcsinh(r / self.scale))
        r = np.maximum(r, np.finfo(float).tiny)  # on the axis the harmonics m > 0 vanish by their tables
        return self.combine(np.moveaxis(table, -1, 0), x / r, y / r, self.friction)


def stress_below(z: Array, layer: int, scale: float, body: Body, *, excess: bool = False) -> list[PointForce]:
    """Stress below a point force at each depth ``z`` of one layer.

    z : (nz,) [m].  scale : L [m] such that the response decays at least like exp(-k L).
    body : the layers, and the friction.  excess : leave out the homogeneous half-space of the first coating.
    """
    grid = _grid(body, scale)
    k = grid.wavenumbers / scale

    def response(load: Load) -> Array:
        return stress_frf(k, z, layer, **body.layers, load=load, excess=excess)

    zz, Lz, LL, TT = response("normal")
    columns = [
        _radial(F, m, scale, grid) for F, m in ((zz, 0), ((LL + TT) / 2, 0), (Lz, 1), ((LL - TT) / 2, 2))
    ]
    if body.friction:
        zz, Lz, LL, TT = response("in-plane")
        A, B = response("anti-plane")
        D = (LL - TT) / 2
        pairs = ((zz, 1), ((LL + TT) / 2, 1), (Lz + A, 0), (Lz - A, 2), (D - B, 1), (D + B, 3))
        columns += [_radial(F, m, scale, grid) for F, m in pairs]
    return _tabulate(columns, grid, scale, body.friction, _combine_stress)


def displacement_below(
    z: Array, layer: int, scale: float, body: Body, *, excess: bool = False
) -> list[PointForce]:
    """Displacement below a point force at each depth ``z`` of one layer; arguments as in `stress_below`."""
    grid = _grid(body, scale)
    k = grid.wavenumbers / scale

    def response(load: Load) -> Array:
        return displacement_frf(k, z, layer, **body.layers, load=load, excess=excess)

    uz, U = response("normal")
    columns = [_radial(F, m, scale, grid, over_k=True) for F, m in ((uz, 0), (U, 1))]
    if body.friction:
        uz, U = response("in-plane")
        (V,) = response("anti-plane")
        columns += [_radial(F, m, scale, grid, over_k=True) for F, m in ((uz, 1), (U + V, 0), (U - V, 2))]
    return _tabulate(columns, grid, scale, body.friction, _combine_displacement)


def stress_from_lines(field: Field, reach: Array, friction: float) -> PointForce:
    """Radial tables of a point force away from it, from its stress on the two axes.

    field(x, y) : xx, yy, zz, xy, xz, yz below a normal and below a tangential unit force, (2, 6, n).
    reach : radii [m] of the table, increasing; the first is the unit of its scale.
    """
    zero = np.zeros_like(reach)
    (xx, yy, zz, _, xz, _), (xx_t, yy_t, zz_t, _, xz_t, _) = field(reach, zero)
    _, (_, _, _, xy_90, xz_90, _) = field(zero, reach)
    columns = [zz, (xx + yy) / 2, -xz, (yy - xx) / 2]
    if friction:
        E_less_G, E_plus_G = yy_t - xx_t, -2 * xy_90
        columns += [-zz_t, -(xx_t + yy_t) / 2, -xz_t - xz_90, xz_t - xz_90]
        columns += [(E_plus_G + E_less_G) / 2, (E_plus_G - E_less_G) / 2]
    return _outer(columns, reach, friction, _combine_stress)


def displacement_from_lines(field: Field, reach: Array, friction: float) -> PointForce:
    """As `stress_from_lines`, from the displacements (2, 3, n)."""
    zero = np.zeros_like(reach)
    (ux, _, uz), (ux_t, _, uz_t) = field(reach, zero)
    _, (ux_90, _, _) = field(zero, reach)
    columns = [uz, -ux]
    if friction:
        columns += [-uz_t, -ux_t - ux_90, ux_t - ux_90]
    return _outer(columns, reach, friction, _combine_displacement)


def _outer(columns: list[Array], reach: Array, friction: float, combine: Callable) -> PointForce:
    table = np.stack(columns, axis=-1)
    return PointForce(CubicSpline(np.arcsinh(reach / reach[0]), table), float(reach[0]), friction, combine)


def _grid(body: Body, scale: float) -> LogGrid:
    """Grid of the transforms: a film E, h stretches on a base E' over a length h E/E', bends over less."""
    moduli = [material[0] for material in body.materials]
    return log_grid(sum(body.thickness) * max(moduli) / min(moduli) / scale)


def _tabulate(
    columns: list[Array], grid: LogGrid, scale: float, friction: float, combine: Callable
) -> list[PointForce]:
    """Splines through the radial functions (nz, nr, columns)."""
    tables = np.stack(columns, axis=-1)
    nodes = np.arcsinh(np.concatenate([_INNER, grid.radii[grid.radii >= NEAR]]))
    return [PointForce(CubicSpline(nodes, table), scale, friction, combine) for table in tables]


def _radial(F: Array, order: int, scale: float, grid: LogGrid, *, over_k: bool = False) -> Array:
    """The transform at scale times ``_INNER`` and all radii beyond, (nz, nr)."""
    inner = near_axis(F, order, scale, scale * _INNER, over_k=over_k, grid=grid)
    outer = hankel(F, order, scale, over_k=over_k, grid=grid)[:, grid.radii >= NEAR]
    return np.concatenate([inner, outer], axis=1)


def _combine_stress(table: Array, c: Array, s: Array, f: float) -> Array:
    """xx, yy, zz, xy, xz, yz from the radial functions and the direction (c, s)."""
    Z, S, T, D = table[:4]
    cos2, sin2 = c * c - s * s, 2 * c * s
    mean, half, zz, xy = S, -cos2 * D, Z, -sin2 * D
    xz, yz = -c * T, -s * T
    if f:
        Z1, S1, A0, B2, E1, G3 = f * table[4:]
        cos3, sin3 = c * cos2 - s * sin2, s * cos2 + c * sin2
        mean, zz = mean - c * S1, zz - c * Z1
        half = half - (c * E1 - cos3 * G3) / 2
        xy = xy - (s * E1 - sin3 * G3) / 2
        xz, yz = xz - (A0 - cos2 * B2) / 2, yz + sin2 * B2 / 2
    return np.stack([mean + half, mean - half, zz, xy, xz, yz])


def _combine_displacement(table: Array, c: Array, s: Array, f: float) -> Array:
    """x, y, z from the radial functions and the direction (c, s)."""
    W, U = table[:2]
    ux, uy, uz = -c * U, -s * U, W
    if f:
        W1, A0, B2 = f * table[2:]
        ux = ux - (A0 - (c * c - s * s) * B2) / 2
        uy, uz = uy + c * s * B2, uz - c * W1
    return np.stack([ux, uy, uz])
