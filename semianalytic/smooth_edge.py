"""What constant patches miss of a pressure with a smooth edge.

Constant patches carry the pressure at their centres. Near the edge, where p falls like the square root of the
distance, the pressure f of ``edge_shape`` replaces them: each patch is divided into parts, whose mean
pressures follow from f^2, nearly linear across a part even where the edge cuts it. Near the patch the
deflection of the parts is that of their own influence coefficients; farther away that of 3 x 3 constant
patches with the same moments up to the second. Inside, differences of p^2 give the moments. Both share the
patches in between.

Indices count the patches held: of a quarter grid those at x >= 0, y >= 0 (``grid``).
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import distance_transform_cdt, maximum_filter

from semianalytic.edge_shape import Shape
from semianalytic.grid import Grid, Window

__all__ = ["NEAR", "PARTS", "EdgePatches", "beyond_centres", "edge_patches", "near_influence", "patch_mean"]

Array = NDArray[np.floating]
Indices = NDArray[np.intp]

# Share of a patch that is integrated by parts, by its depth in contact: 0 beside a loaded patch, 1 beside an
# unloaded one, ... The two representations differ by 1e-3 of the change of p over a patch; a long taper keeps
# the sum of the differences below 2e-7 of the deflection, four steps of a quarter gave 1e-6.
FULL, TAPER = 3, 8
SHARES = np.concatenate([np.ones(FULL + 1), 1 - np.arange(1, TAPER + 1) / (TAPER + 1)])
PARTS = 11  # of a patch a side, odd
AT_ONCE = 4000  # patches at the edge: with their parts 100 megabytes
NEARLY = 4  # depth from which a quadratic of f^2 gives the means of all parts, to 1e-6 of them
NEAR = 4  # within which the deflection is that of the parts, beyond it that of their moments


# Places in a patch, in patches from its centre: of the parts, their faces, two Gauss points in each.
MIDDLES = (np.arange(PARTS) - PARTS // 2) / PARTS
FACES = np.arange(PARTS + 1) / PARTS - 0.5
ACROSS = (MIDDLES[:, None] + np.array([-0.5, 0.5]) / 3**0.5 / PARTS).ravel()


@dataclass(frozen=True, eq=False)
class EdgePatches:
    """The patches near the edge and the pressure in them.

    i, j : indices, (k,).  centre : f at the centres [Pa], (k,).  parts : means of f over PARTS x PARTS parts
    [Pa], (k, PARTS^2), or over the whole patch, (k, 1).  share : integrated by parts, (k,).  misfit : largest
    distance by which the patches' pressure misses f near the edge, in patches where f^2 is steepest.
    """

    i: Indices
    j: Indices
    centre: Array
    parts: Array
    share: Array
    misfit: float

    def embedded(self, i0: int, j0: int) -> "EdgePatches":
        """The same on a grid of which the patches were a window that begins at i0, j0."""
        return replace(self, i=self.i + i0, j=self.j + j0)

    @property
    def averaged(self) -> "EdgePatches":
        """The same with one mean a patch, all that is needed once the rounds are over."""
        return replace(self, parts=self.parts.mean(axis=1, keepdims=True))


def edge_patches(shape: Shape, p: Array, grid: Grid, window: Window) -> EdgePatches:
    """The patches of a window near the edge of ``shape``.  p : pressure of the patches [Pa], on the
    window."""
    loaded = np.pad(grid.whole(p) > 0, 1)
    depth = distance_transform_cdt(loaded, metric="chessboard")
    beside = maximum_filter(loaded, 3)
    depth, beside = (field[1:-1, 1:-1][tuple(slice(-m, None) for m in p.shape)] for field in (depth, beside))
    i, j = np.nonzero(beside & (depth < SHARES.size))
    share = SHARES[depth[i, j]]
    x, y = (grid.x[part] for part in window.slices)
    quadratic = np.concatenate(
        [_quadratic(shape, x[i[k]], y[j[k]], grid.d) for k in _some(np.arange(i.size))]
    )
    c = quadratic[:, 0]
    slope = np.hypot(quadratic[:, 1], quadratic[:, 2])
    held = p[i, j]
    at_edge = (depth[i, j] >= 1) & (depth[i, j] <= 2)
    missed = np.abs(held**2 - c)[at_edge] / slope[at_edge].max(initial=np.finfo(float).tiny)
    centre = np.sqrt(np.maximum(c, 0))
    parts = np.empty((i.size, PARTS**2))
    for k in _some(np.arange(i.size)):
        parts[k] = _smooth_parts(quadratic[k])
    # the edge cuts these along x, or along y
    along_x = np.abs(quadratic[:, 1]) >= np.abs(quadratic[:, 2])
    for group, swap in ((along_x, False), (~along_x, True)):
        at_x, at_y = (ACROSS, FACES) if swap else (FACES, ACROSS)
        for k in _some(np.flatnonzero(group & (depth[i, j] < NEARLY))):
            faces = shape.square(
                x[i[k]][:, None, None] + at_x[:, None] * grid.d, y[j[k]][:, None, None] + at_y * grid.d
            )
            parts[k] = _cut_parts(
                faces.swapaxes(1, 2) if swap else faces, quadratic[k, 5 if swap else 3], swap
            )
    return EdgePatches(i, j, centre, parts, share, float(missed.max(initial=0.0)))


def _quadratic(shape: Shape, x: Array, y: Array, d: float) -> Array:
    """f^2 = c0 + c1 x + c2 y + c3 x^2 + c4 x y + c5 y^2 around patch centres, in patches, (k, 6)."""
    offset = np.array([-0.5, 0, 0.5]) * d
    square = shape.square(x[:, None, None] + offset[:, None], y[:, None, None] + offset)
    c = square[:, 1, 1]
    return np.stack(
        [
            c,
            square[:, 2, 1] - square[:, 0, 1],
            square[:, 1, 2] - square[:, 1, 0],
            2 * (square[:, 2, 1] + square[:, 0, 1] - 2 * c),
            square[:, 2, 2] + square[:, 0, 0] - square[:, 2, 0] - square[:, 0, 2],
            2 * (square[:, 1, 2] + square[:, 1, 0] - 2 * c),
        ],
        axis=-1,
    )


def _some(k: Indices) -> list[Indices]:
    """Patches in groups of at most ``AT_ONCE``."""
    return np.array_split(k, -(-k.size // AT_ONCE)) if k.size else []


def _smooth_parts(quadratic: Array) -> Array:
    """Mean of f over PARTS x PARTS parts of every patch inside, (k, PARTS^2).

    quadratic : f^2 of `_quadratic`, (k, 6).
    The mean follows from f^2 and its derivatives at the centre of a part.
    """
    square = quadratic @ _terms(MIDDLES, MIDDLES)
    slope2 = (quadratic[:, 1] ** 2 + quadratic[:, 2] ** 2)[:, None]
    bend = (quadratic[:, 3] + quadratic[:, 5])[:, None]
    square += (bend - slope2 / (4 * np.maximum(square, slope2 / 16))) / (12 * PARTS**2)
    return np.sqrt(np.maximum(square, 0))


def _cut_parts(square: Array, bend: Array, swap: bool) -> Array:
    """The same of patches that the edge cuts, or nearly, from f^2 at the faces of the parts along one axis.

    Exact for f^2 linear along that axis, with two Gauss points across.

    square : f^2 at ``FACES`` and ``ACROSS``, (k, PARTS + 1, 2 PARTS).  bend : half its second derivative
    along the axis, in patches, (k,).  swap : the axis is y.
    """
    square = square - bend[:, None, None] / (6 * PARTS**2)  # its mean over a part is that of a chord
    root = np.sqrt(np.maximum(square, 0))
    u, v = root[:, :-1], root[:, 1:]
    total = u + v
    p = (total * total - u * v) / np.maximum(total, np.finfo(float).tiny)
    low, high = square[:, :-1], square[:, 1:]
    cut = (low > 0) != (high > 0)  # loaded on a part of its length
    p[cut] *= (v[cut] ** 2 - u[cut] ** 2) / (high[cut] - low[cut])
    p = (p[:, :, ::2] + p[:, :, 1::2]) / 3
    return (p.transpose(0, 2, 1) if swap else p).reshape(-1, PARTS**2)


def _terms(x: Array, y: Array) -> Array:
    """1, x, y, x^2, x y, y^2 at all x and y, (6, x.size y.size)."""
    x, y = (v.ravel() for v in np.meshgrid(x, y, indexing="ij"))
    return np.stack([np.ones_like(x), x, y, x * x, x * y, y * y])


def beyond_centres(
    edge: EdgePatches, p: Array, grid: Grid, deflection: Callable[[Array], Array], near: Array
) -> tuple[Array, float]:
    """Deflection [m] that constant patches miss, on the window, and what they miss of the load [N].

    p : [Pa], on the window.  deflection : K p.  near : `near_influence`.
    """
    weight, own = grid.weight(p.shape), _own(p.shape, grid)
    bend, mx, my = (moment * own for moment in _smooth(p, edge, grid))
    moments = np.zeros((p.shape[0] + 2, p.shape[1] + 2))
    moments[1:-1, 1:-1] = bend
    moments[2:, 1:-1] += mx / 2
    moments[:-2, 1:-1] -= mx / 2
    moments[1:-1, 2:] += my / 2
    moments[1:-1, :-2] -= my / 2
    u = np.zeros((p.shape[0] + 2 * NEAR, p.shape[1] + 2 * NEAR))
    for k in _some(np.arange(edge.i.size)):
        i, j = edge.i[k], edge.j[k]
        sources = edge.parts[k] * (edge.share[k] * own[i, j])[:, None]
        for (di, dj), share in _stencil().items():
            moments[i + 1 + di, j + 1 + dj] += sources @ share
        for (di, dj), at_offset in zip(np.ndindex(2 * NEAR + 1, 2 * NEAR + 1), near @ sources.T, strict=True):
            u[i + di, j + dj] += at_offset
    moments = _folded(moments, 1, grid)
    moments[edge.i, edge.j] -= edge.share * edge.centre
    lost = edge.share * (edge.parts.mean(axis=1) - edge.centre)
    bend /= own
    missing = float((bend if weight is None else weight * bend).sum())
    missing += float((lost if weight is None else weight[edge.i, edge.j] * lost).sum())
    return deflection(moments) + _folded(u, NEAR, grid), missing * grid.d**2


def _own(shape: tuple[int, int], grid: Grid) -> Array:
    """1, halved for each axis of a quarter that runs through a patch, which is then its own mirror image."""
    own = np.ones(shape)
    if grid.quarter and grid.n % 2:
        own[0] /= 2
        own[:, 0] /= 2
    return own


def _folded(field: Array, width: int, grid: Grid) -> Array:
    """A field with ``width`` patches more around the window: of a quarter, its mirror images added."""
    if grid.quarter:
        for _ in range(2):
            if grid.n % 2:
                field[width : 2 * width + 1] += field[width::-1]
            else:
                field[width : 2 * width] += field[width - 1 :: -1]
            field = field.T
    return field[width:-width, width:-width]


def patch_mean(edge: EdgePatches, p: Array, grid: Grid) -> Array:
    """Means over the patches of the pressure p [Pa] given at their centres: the whole load."""
    mean: Array = p + _smooth(p, edge, grid)[0]
    mean[edge.i, edge.j] += edge.share * (edge.parts.mean(axis=1) - p[edge.i, edge.j])
    return mean


@lru_cache
def _stencil() -> dict[tuple[int, int], Array]:
    """Shares of the parts that 3 x 3 constant patches need for the same moments up to the second."""
    n = (np.arange(PARTS) - PARTS // 2) / PARTS
    x, y = (v.ravel() for v in np.meshgrid(n, n, indexing="ij"))
    xx, yy = (v**2 + (1 / PARTS**2 - 1) / 12 for v in (x, y))
    stencil = {(0, 0): 1 - xx - yy}
    for s in (1, -1):
        stencil |= {(s, 0): (xx + s * x) / 2, (0, s): (yy + s * y) / 2}
        stencil |= {(s, t): s * t * x * y / 4 for t in (1, -1)}
    return {offset: weight / PARTS**2 for offset, weight in stencil.items()}


def near_influence(of_patch: Array, of_part: Array) -> Array:
    """Deflection [m/Pa] at the centres around a patch by its parts, less that of patches of equal moments.

    of_patch : influence coefficients of a patch, at least (NEAR + 2, NEAR + 2).  of_part : those of a part,
    at least ((NEAR + 1) PARTS, (NEAR + 1) PARTS).  Returns ((2 NEAR + 1)^2, PARTS^2).
    """
    o = np.arange(-NEAR, NEAR + 1)
    m = np.abs(o[:, None] * PARTS - (np.arange(PARTS) - PARTS // 2))
    table = of_part[m[:, None, :, None], m[None, :, None, :]].reshape(o.size**2, PARTS**2)
    for (a, b), weight in _stencil().items():
        table -= of_patch[np.abs(o - a)[:, None], np.abs(o - b)].reshape(-1, 1) * weight
    return table


def _smooth(p: Array, edge: EdgePatches, grid: Grid) -> tuple[Array, Array, Array]:
    """Mean beyond the centre value, lap p/24, and first moments, grad p/12 [Pa], where p is integrated whole.

    By differences of p^2; of the share of the patches that is not integrated by parts.
    """
    square = grid.ringed(p) ** 2
    rest = np.where(p > 0, 1.0, 0.0)
    rest[edge.i, edge.j] *= 1 - edge.share
    inverse = np.divide(1, p, out=np.zeros_like(p), where=rest > 0)
    px = (square[2:, 1:-1] - square[:-2, 1:-1]) * inverse / 4
    py = (square[1:-1, 2:] - square[1:-1, :-2]) * inverse / 4
    bend = (
        square[2:, 1:-1] + square[:-2, 1:-1] + square[1:-1, 2:] + square[1:-1, :-2] - 4 * square[1:-1, 1:-1]
    )
    bend = bend * inverse / 2 - (px * px + py * py) * inverse
    return bend / 24 * rest, px / 12 * rest, py / 12 * rest
