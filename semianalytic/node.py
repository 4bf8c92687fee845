"""Influence of one node of a smoothly interpolated pressure on points close below the surface.

Between the nodes of a uniform grid the pressure is the cubic convolution of Keys (1981),

    p(x) = sum_i p_i B(x/d - i) in each direction,   B cubic on |t| < 1 and on 1 < |t| < 2,

which reproduces parabolas. B(t) = int_{t-1/2}^{t+1/2} w, w quadratic between the knots -3/2, -1/2, 1/2, 3/2:
the field under a node is the closed form of a constant rectangle averaged with w(t_x) w(t_y). Fields known
as smooth point-load tables are integrated with B itself. B has the moments 1, 0, 0, 0: more than ``NEAR``
patches away a node is a point force.

Source: R. G. Keys, IEEE Trans. Acoust. Speech Signal Process. 29 (1981) 1153-1160, eq. 15.
"""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .pointload import PointLoad

__all__ = ["near_influence"]

Array = NDArray[Any]
Field = Callable[[Array, Array], Array]

NEAR = 8  # patches; beyond, the fourth moment of B is worth 2e-5 of the pressure
POINTLIKE = 3.0  # patches; nodes of a field of this scale act as points, aliases exp(-6 pi)


def near_influence(
    rectangle: Field | None,
    outside: PointLoad | None,
    table: PointLoad | None,
    dx: float,
    dy: float,
    odd_in_y: Sequence[int],
) -> Callable[[Array, Array], Array]:
    """Influence of unit force on a node, a function of integer offsets (m, n).

    rectangle : field of unit force spread over a rectangle dx x dy, (x, y) -> (components, ...), or None.
    outside : the same for a point force, used beyond NEAR.  table : what has to be added, smooth, or None.
    """
    blocks, far = [], []
    if rectangle is not None and outside is not None:
        blocks.append(_block_of_rectangle(rectangle, dx, dy))
        far.append(outside)
    if table is not None:
        blocks.append(_block_of_table(table, dx, dy))
        far.append(table)
    half = np.sum(blocks, axis=0)
    mirrored = half[:, :, :0:-1].copy()
    mirrored[list(odd_in_y)] *= -1
    near = np.concatenate([mirrored, half], axis=2)

    def influence(m: Array, n: Array) -> Array:
        close = np.maximum(np.abs(m), np.abs(n)) <= NEAR
        X, Y = m * dx, n * dy
        total = np.sum([kernel(X, Y) for kernel in far], axis=0)
        total[:, close] = near[:, m[close] + NEAR, n[close] + NEAR]
        return total

    return influence


def _block_of_rectangle(rectangle: Field, dx: float, dy: float) -> Array:
    """The rectangle averaged with w w at |m| <= NEAR, 0 <= n <= NEAR; (components, 2 NEAR + 1, NEAR + 1).

    For integer offsets the edges of the rectangle come to lie on knots of w. Next to them the Gauss nodes
    crowd towards the knots: logarithms and steps at z = 0 to 1e-7, the layer at z = d/20 to 1e-5.
    """
    cell = np.meshgrid(np.arange(-NEAR - 1, NEAR + 2), np.arange(-1, NEAR + 2), indexing="ij")
    i, j = cell[0].ravel(), cell[1].ravel()
    touched = (np.abs(i) <= 1) & (np.abs(j) <= 1)
    u, weight = np.polynomial.legendre.leggauss(24)
    crowded = (15 * u - 10 * u**3 + 3 * u**5) / 16, weight * 15 * (1 - u**2) ** 2 / 16
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
    moments = moments.reshape(3, 3, -1, 2 * NEAR + 3, NEAR + 3)
    block = np.zeros((moments.shape[2], 2 * NEAR + 1, NEAR + 1))
    for c in (-1, 0, 1):
        for e in (-1, 0, 1):  # offset m takes the cell m - c with the weights of c
            block += moments[c + 1, e + 1, :, 1 - c : 2 * NEAR + 2 - c, 1 - e : NEAR + 2 - e]
    return block


def _block_of_table(table: PointLoad, dx: float, dy: float) -> Array:
    """A smooth point-load table integrated with B B at the same offsets."""
    m, n = np.meshgrid(np.arange(-NEAR, NEAR + 1), np.arange(NEAR + 1), indexing="ij")
    ratio = max(dx, dy) / table.scale
    if ratio * POINTLIKE < 1:
        return table(m * dx, n * dy)
    # nearest singularity at the distance L from panels of half-width d/2
    s, weight = _gauss(int(np.clip(np.ceil(2 + 3 * ratio), 3, 10)))
    t = (np.arange(-1.5, 2)[:, None] + s).ravel()
    B = _keys(t) * np.tile(weight, 4)
    X, Y = np.broadcast_arrays((m[..., None, None] - t[:, None]) * dx, (n[..., None, None] - t) * dy)
    return np.einsum("cmnxy,x,y->cmn", table(X, Y), B, B, optimize=True)


def _keys(t: Array) -> Array:
    """B(t)."""
    t = np.abs(t)
    inner, outer = (1.5 * t - 2.5) * t**2 + 1, ((2.5 - 0.5 * t) * t - 4) * t + 2
    return np.where(t < 1, inner, np.where(t < 2, outer, 0.0))


def _keys_slope(t: Array) -> Array:
    """dB/dt."""
    a = np.abs(t)
    return np.sign(t) * np.where(a < 1, (4.5 * a - 5) * a, np.where(a < 2, (5 - 1.5 * a) * a - 4, 0.0))


def _gauss(n: int) -> tuple[Array, Array]:
    """Nodes and weights on a side of length 1 around 0."""
    s, w = np.polynomial.legendre.leggauss(n)
    return s / 2, w / 2
