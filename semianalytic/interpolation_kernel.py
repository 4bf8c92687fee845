"""Influence of one node of Keys' cubic interpolation of the pressure close below the surface.

Between the nodes of a uniform grid the pressure is the cubic convolution of Keys (1981),

    p(x) = sum_i p_i B(x/d - i) in each direction,   B cubic on |t| < 1 and on 1 < |t| < 2,

which reproduces parabolas. B(t) = int_{t-1/2}^{t+1/2} w, w quadratic between the knots -3/2, -1/2, 1/2, 3/2:
the field under a node is the closed form of a constant rectangle averaged with w(t_x) w(t_y). Fields given
by smooth point-force tables are integrated with B itself. B has the moments 1, 0, 0, 0, -3/10; with the
fourth subtracted as a fourth difference, a node is a point force more than ``NEAR`` patches away.

Source: R. G. Keys, IEEE Trans. Acoust. Speech Signal Process. 29 (1981) 1153-1160, eq. 15.
"""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .point_force import PointForce

__all__ = ["near_influence"]

Array = NDArray[Any]
Field = Callable[[Array, Array], Array]

NEAR = 8  # patches; beyond, the sixth moment of B contributes 2e-6 of the pressure
BLOCK = NEAR + 2  # offsets computed, two more for the fourth difference
POINTLIKE = 16.0  # patches; on a field of this scale the sixth moment of B contributes 1e-6 of it


def near_influence(
    rectangle: Field | None,
    outside: PointForce | None,
    table: PointForce | None,
    dx: float,
    dy: float,
    z: float,
    odd_in_y: Sequence[int],
) -> Callable[[Array, Array], Array]:
    """Influence of unit force on a node, a function of integer offsets (m, n).

    rectangle : field of unit force spread over a rectangle dx x dy, (x, y) -> (components, ...), or None.
    outside : the same for a point force, used beyond NEAR.  table : smooth correction to add, or None.
    z : depth [m].
    """
    blocks: list[Array] = []
    far: list[PointForce] = []  # point forces beyond NEAR
    smooth: list[PointForce] = []  # point forces at any offset
    if rectangle is not None and outside is not None:
        blocks.append(_block_of_rectangle(rectangle, dx, dy, z))
        far.append(outside)
    if table is not None and table.scale > POINTLIKE * max(dx, dy):
        smooth.append(table)
    elif table is not None:
        blocks.append(_block_of_table(table, dx, dy))
        far.append(table)
    half = np.sum(blocks, axis=0)
    mirrored = half[:, :, :0:-1].copy()
    mirrored[list(odd_in_y)] *= -1
    near = _without_fourth_moment(np.concatenate([mirrored, half], axis=2))

    def influence(m: Array, n: Array) -> Array:
        close = np.maximum(np.abs(m), np.abs(n)) <= NEAR
        X, Y = m * dx, n * dy
        total = np.sum([kernel(X, Y) for kernel in far], axis=0)
        total[:, close] = near[:, m[close] + NEAR, n[close] + NEAR]
        return total + sum(kernel(X, Y) for kernel in smooth)

    return influence


def _block_of_rectangle(rectangle: Field, dx: float, dy: float, z: float) -> Array:
    """The rectangle averaged with w w at |m| <= BLOCK, 0 <= n <= BLOCK; (components, 2 BLOCK + 1, BLOCK + 1).

    For integer offsets the edges of the rectangle coincide with knots of w. Next to them the Gauss nodes
    crowd towards the knots, for the logarithms and steps at z = 0, and at 0 < z << d once more towards
    the layer of width z: 1e-8 of the largest influence at any depth.
    """
    cell = np.meshgrid(np.arange(-BLOCK - 1, BLOCK + 2), np.arange(-1, BLOCK + 2), indexing="ij")
    i, j = cell[0].ravel(), cell[1].ravel()
    touched = (np.abs(i) <= 1) & (np.abs(j) <= 1)
    layer = 8 * z / min(dx, dy)
    if 1e-8 < layer < 0.45:
        ends, middle = _crowded(24, layer), _crowded(24, 1 - 2 * layer)
        shift = (1 - layer) / 2
        t = np.concatenate([ends[0] - shift, middle[0], ends[0] + shift])
        crowded = t, np.concatenate([ends[1], middle[1], ends[1]])
    else:
        crowded = _crowded(32, 1.0)
    moments: Array | None = None
    for cells, (t, weight) in ((touched, crowded), (~touched, _gauss(6))):
        # w(s) = w(s + 1) - B'(s + 1/2) = -sum_k B'(s + 1/2 + k), s = c + t in the cells c = -1, 0, 1
        s = np.arange(-1, 2)[:, None] + t
        w = -sum(_keys_slope(s + 0.5 + k) for k in range(3)) * weight
        X, Y = np.broadcast_arrays((i[cells, None, None] - t[:, None]) * dx, (j[cells, None, None] - t) * dy)
        part = np.einsum("acxy,mx,ny->mnac", rectangle(X, Y), w, w, optimize=True)
        if moments is None:
            moments = np.zeros((3, 3, part.shape[2], i.size))
        moments[..., cells] = part
    assert moments is not None
    moments = moments.reshape(3, 3, -1, 2 * BLOCK + 3, BLOCK + 3)
    block = np.zeros((moments.shape[2], 2 * BLOCK + 1, BLOCK + 1))
    for c in (-1, 0, 1):
        for e in (-1, 0, 1):  # offset m uses the cell m - c with the weights of c
            block += moments[c + 1, e + 1, :, 1 - c : 2 * BLOCK + 2 - c, 1 - e : BLOCK + 2 - e]
    return block


def _block_of_table(table: PointForce, dx: float, dy: float) -> Array:
    """A smooth point-force table integrated with B B at the same offsets."""
    m, n = np.meshgrid(np.arange(-BLOCK, BLOCK + 1), np.arange(BLOCK + 1), indexing="ij")
    ratio = max(dx, dy) / table.scale
    # the table is singular at the distance L from panels of half-width d/2: the rule gains L/d digits a point
    inner = (np.abs(m) <= 2) & (n <= 2)  # whose panels touch the axis
    block: Array | None = None
    for where, points in ((inner, int(np.clip(np.ceil(3 + 4 * ratio), 4, 32))), (~inner, 4)):
        s, weight = _gauss(points)
        t = (np.arange(-1.5, 2)[:, None] + s).ravel()
        B = _keys(t) * np.tile(weight, 4)
        X, Y = (m[where, None, None] - t[:, None]) * dx, (n[where, None, None] - t) * dy
        part = np.einsum("ckxy,x,y->ck", table(*np.broadcast_arrays(X, Y)), B, B, optimize=True)
        if block is None:
            block = np.zeros((len(part), *m.shape))
        block[:, where] = part
    assert block is not None
    return block


def _without_fourth_moment(block: Array) -> Array:
    """A block plus 1/80 of its fourth differences in x and in y, two offsets smaller all around."""
    for axis in (1, 2):
        b = np.moveaxis(block, axis, 0)
        fourth = b[:-4] + b[4:] - 4 * (b[1:-3] + b[3:-1]) + 6 * b[2:-2]
        block = np.moveaxis(b[2:-2] + fourth / 80, 0, axis)
    return block


def _keys(t: Array) -> Array:
    """B(t)."""
    t = np.abs(t)
    inner, outer = (1.5 * t - 2.5) * t**2 + 1, ((2.5 - 0.5 * t) * t - 4) * t + 2
    return np.where(t < 1, inner, np.where(t < 2, outer, 0.0))


def _keys_slope(t: Array) -> Array:
    """dB/dt."""
    a = np.abs(t)
    return np.sign(t) * np.where(a < 1, (4.5 * a - 5) * a, np.where(a < 2, (5 - 1.5 * a) * a - 4, 0.0))


def _crowded(n: int, length: float) -> tuple[Array, Array]:
    """Gauss nodes and weights on a side of ``length`` around 0, crowded towards both ends."""
    u, w = np.polynomial.legendre.leggauss(n)
    return length * (15 * u - 10 * u**3 + 3 * u**5) / 16, length * w * 15 * (1 - u**2) ** 2 / 16


def _gauss(n: int) -> tuple[Array, Array]:
    """Nodes and weights on a side of length 1 around 0."""
    s, w = np.polynomial.legendre.leggauss(n)
    return s / 2, w / 2
