"""Deflection and load that constant patches miss of a pressure with a smooth edge.

Constant patches carry the pressure at their centres. At the edge, where p falls like the square root of the
distance, the pressure f of ``edge_shape`` replaces them: each patch is divided into parts, whose mean
pressures follow from f^2, nearly linear across a part even where the edge cuts it. Inside, differences of p^2
give a quadratic pressure in each patch. Near the patch the deflection of both is that of their own influence
coefficients; farther away that of 3 x 3 constant patches with the same moments up to the second.

Indices count the patches held: of a quarter grid those at x >= 0, y >= 0 (``grid``).
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import distance_transform_cdt, maximum_filter

from semianalytic import numbers
from semianalytic.edge.edge_shape import Shape
from semianalytic.patches.grid import Grid, Window

Array = NDArray[np.floating]
Indices = NDArray[np.intp]


# Places in a patch, in patches from its centre: of the parts, their faces.
MIDDLES = (np.arange(numbers.PARTS) - numbers.PARTS // 2) / numbers.PARTS
FACES = np.arange(numbers.PARTS + 1) / numbers.PARTS - 0.5
NODES = np.linspace(-0.5, 0.5, numbers.SQUARE_NODES)


@dataclass(frozen=True, eq=False)
class EdgePatches:
    """The patches near the edge and the pressure in them.

    i, j : indices, (k,).  centre : f at the centres [Pa], (k,).  parts : means of f over PARTS x PARTS parts
    [Pa], (k, PARTS^2), or over the whole patch, (k, 1).  inner : the innermost of them, (k,).  misfit :
    largest distance by which the patches' pressure misses f near the edge, in patches where f^2 is steepest.
    """

    i: Indices
    j: Indices
    centre: Array
    parts: Array
    inner: NDArray[np.bool_]
    misfit: float


def edge_patches(shape: Shape, p: Array, grid: Grid, window: Window) -> EdgePatches:
    """The patches of a window near the edge of ``shape``.  p : pressure of the patches [Pa], on the
    window."""
    loaded = np.pad(grid.whole(p) > 0, 1)
    depth = distance_transform_cdt(loaded, metric="chessboard")
    beside = maximum_filter(loaded, 3)
    depth, beside = (field[1:-1, 1:-1][tuple(slice(-m, None) for m in p.shape)] for field in (depth, beside))
    i, j = np.nonzero(beside & (depth <= numbers.PARTED))
    x, y = (grid.x[part] for part in window.slices)
    # smooth across the edge: the polynomial through these points gives f^2 all over the patch
    square = shape.square(x[i][:, None, None] + NODES[:, None] * grid.d, y[j][:, None, None] + NODES * grid.d)
    c = square[:, 2, 2]
    slopes = square[:, 4, 2] - square[:, 0, 2], square[:, 2, 4] - square[:, 2, 0]
    slope = np.hypot(*slopes)
    at_edge = (depth[i, j] >= 1) & (depth[i, j] <= 2)
    missed = np.abs(p[i, j] ** 2 - c)[at_edge] / slope[at_edge].max(initial=np.finfo(float).tiny)
    parts = np.empty((i.size, numbers.PARTS**2))
    along_x = np.abs(slopes[0]) >= np.abs(slopes[1])
    for cut, axes in ((along_x, (0, 1, 2)), (~along_x, (0, 2, 1))):  # by the edge, along x, along y
        k = np.flatnonzero(cut)
        together = numbers.CACHE // numbers.PARTS**2
        for some in (k[first : first + together] for first in range(0, k.size, together)):
            parts.reshape(-1, numbers.PARTS, numbers.PARTS)[some] = _parts(
                square[some].transpose(axes)
            ).transpose(axes)
    centre = np.sqrt(np.maximum(c, 0))
    return EdgePatches(i, j, centre, parts, depth[i, j] == numbers.PARTED, float(missed.max(initial=0.0)))


def _parts(square: Array) -> Array:
    """Mean of f over the parts of patches that the edge cuts along one axis or not, (k, PARTS, PARTS).

    Exact for f^2 linear along that axis, at the middle across.  square : f^2 at ``NODES`` x ``NODES``, that
    axis first.
    """
    c = square[:, 2, 2]
    bend = 2 * (square[:, 4, 2] + square[:, 0, 2] - 2 * c)  # half the second derivative, in patches
    at_faces = (square.reshape(-1, NODES.size**2) @ _AT_FACES).reshape(-1, FACES.size, numbers.PARTS)
    at_faces -= bend[:, None, None] / (6 * numbers.PARTS**2)  # its mean over a part is that of a chord
    root = np.sqrt(np.maximum(at_faces, 0))
    u, v = root[:, :-1], root[:, 1:]
    total = u + v
    p = total - u * v / np.maximum(total, np.finfo(float).tiny)
    low, high = at_faces[:, :-1], at_faces[:, 1:]
    cut = (low > 0) != (high > 0)  # loaded on a part of its length
    p[cut] *= (v[cut] ** 2 - u[cut] ** 2) / (high[cut] - low[cut])
    mean: Array = 2 / 3 * p
    return mean


def _interpolation(x: Array) -> Array:
    """Values at x of the polynomials that are 1 at one of ``NODES`` and 0 at the others, (5, x.size)."""
    values = np.ones((NODES.size, x.size))
    for k, node in enumerate(NODES):
        for other in np.delete(NODES, k):
            values[k] *= (x - other) / (node - other)
    return values


def _terms(x: Array, y: Array) -> Array:
    """1, x, y, x^2, x y, y^2 at all x and y, (6, x.size y.size)."""
    x, y = (v.ravel() for v in np.meshgrid(x, y, indexing="ij"))
    return np.stack([np.ones_like(x), x, y, x * x, x * y, y * y])


_AT_FACES = np.kron(_interpolation(FACES), _interpolation(MIDDLES))
# Means over the parts of a pressure 1 in x, y, x^2/2, x y, y^2/2.
_FIELDS = _terms(MIDDLES, MIDDLES)[1:] * np.array([1, 1, 0.5, 1, 0.5])[:, None]
_FIELDS[[2, 4]] += 1 / (24 * numbers.PARTS**2)


def beyond_centres(
    edge: EdgePatches, p: Array, grid: Grid, deflection: Callable[[Array], Array], near: Array
) -> tuple[Array, float]:
    """Deflection [m] that constant patches miss, on the window, and what they miss of the load [N].

    p : [Pa], on the window.  deflection : K p.  near : `near_influence`.
    """
    weight, own = grid.weight(p.shape), _own(p.shape, grid)
    nx, ny = p.shape
    fields = _derivatives(p, edge, grid) * own
    moments = np.zeros((nx + 2, ny + 2))
    u = np.zeros((nx + 2 * numbers.NEAR_PARTS, ny + 2 * numbers.NEAR_PARTS))
    for (di, dj), of_parts in _stencil().items():
        moments[1 + di : 1 + di + nx, 1 + dj : 1 + dj + ny] += np.tensordot(_FIELDS @ of_parts, fields, 1)
    around = [*np.ndindex(2 * numbers.NEAR_PARTS + 1, 2 * numbers.NEAR_PARTS + 1)]
    for (di, dj), of_fields in zip(around, near @ _FIELDS.T, strict=True):
        u[di : di + nx, dj : dj + ny] += np.tensordot(of_fields, fields, 1)
    i, j = edge.i, edge.j
    sources, share = edge.parts.T, own[i, j]
    stencil = np.array([*_stencil().values()])
    for (di, dj), at_offset in zip(_stencil(), stencil @ sources * share, strict=True):
        moments[i + 1 + di, j + 1 + dj] += at_offset
    for (di, dj), at_offset in zip(around, near @ sources * share, strict=True):
        u[i + di, j + dj] += at_offset
    moments = _folded(moments, 1, grid)
    moments[i, j] -= edge.centre
    lost = edge.parts.mean(axis=1) - edge.centre
    bend = (fields[2] + fields[4]) / (24 * own)
    missing = float((bend if weight is None else weight * bend).sum())
    missing += float((lost if weight is None else weight[i, j] * lost).sum())
    return deflection(moments) + _folded(u, numbers.NEAR_PARTS, grid), missing * grid.d**2


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
            last = width - 1 + grid.n % 2
            field[width : width + last + 1] += field[last::-1]
            field = field.T
    return field[width:-width, width:-width]


def patch_mean(edge: EdgePatches, p: Array, grid: Grid) -> Array:
    """Means over the patches of the pressure p [Pa] given at their centres: the whole load."""
    fields = _derivatives(p, edge, grid)
    mean: Array = p + (fields[2] + fields[4]) / 24
    mean[edge.i, edge.j] += edge.parts.mean(axis=1) - p[edge.i, edge.j]
    return mean


@lru_cache
def _stencil() -> dict[tuple[int, int], Array]:
    """Shares of the parts that 3 x 3 constant patches need for the same moments up to the second."""
    n = (np.arange(numbers.PARTS) - numbers.PARTS // 2) / numbers.PARTS
    x, y = (v.ravel() for v in np.meshgrid(n, n, indexing="ij"))
    xx, yy = (v**2 + (1 / numbers.PARTS**2 - 1) / 12 for v in (x, y))
    stencil = {(0, 0): 1 - xx - yy}
    for s in (1, -1):
        stencil |= {(s, 0): (xx + s * x) / 2, (0, s): (yy + s * y) / 2}
        stencil |= {(s, t): s * t * x * y / 4 for t in (1, -1)}
    return {offset: weight / numbers.PARTS**2 for offset, weight in stencil.items()}


def near_influence(of_patch: Array, of_part: Array) -> Array:
    """Deflection [m/Pa] at the centres around a patch by its parts, less that of patches of equal moments.

    of_patch : influence coefficients of a patch, at least (N + 2, N + 2) for N = ``NEAR_PARTS``.  of_part :
    those of a part, at least ((N + 1) PARTS, (N + 1) PARTS).  Returns ((2 N + 1)^2, PARTS^2).
    """
    o = np.arange(-numbers.NEAR_PARTS, numbers.NEAR_PARTS + 1)
    m = np.abs(o[:, None] * numbers.PARTS - (np.arange(numbers.PARTS) - numbers.PARTS // 2))
    table = of_part[m[:, None, :, None], m[None, :, None, :]].reshape(o.size**2, numbers.PARTS**2)
    for (a, b), weight in _stencil().items():
        table -= of_patch[np.abs(o - a)[:, None], np.abs(o - b)].reshape(-1, 1) * weight
    return table


def _derivatives(p: Array, edge: EdgePatches, grid: Grid) -> Array:
    """p_x, p_y, p_xx, p_xy, p_yy [Pa] in patches, (5, nx, ny), where p is integrated whole, 0 elsewhere.

    By differences of p^2.
    """
    square = grid.ringed(p) ** 2
    rest = p > 0
    rest[edge.i, edge.j] = False
    half = np.divide(0.5, p, out=np.zeros_like(p), where=rest)
    centre = square[1:-1, 1:-1]
    right, left, above, below = square[2:, 1:-1], square[:-2, 1:-1], square[1:-1, 2:], square[1:-1, :-2]
    cross = square[2:, 2:] + square[:-2, :-2] - square[2:, :-2] - square[:-2, 2:]
    px, py = (right - left) / 2 * half, (above - below) / 2 * half
    return np.stack(
        [
            px,
            py,
            (right + left - 2 * centre - 2 * px * px) * half,
            (cross / 4 - 2 * px * py) * half,
            (above + below - 2 * centre - 2 * py * py) * half,
        ]
    )
