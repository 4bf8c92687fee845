"""Contact edge as a smooth curve between the patches.

At a smooth edge p = K sqrt(s), s the distance from it (Johnson 1985, section 5.1): p^2 is smooth up to the
edge and, continued beyond it, negative. A quadratic fitted to p^2 around every patch near the edge gives the
edge to a hundredth of a patch and p within the patches that it cuts: their means, and their deflection by
parts of a patch. Away from the edge p^2 gives the derivatives of p by differences. The patches know p at
their centres; the deflection due to all the rest is `Edge.deflection_beyond_centres`.

Lengths in this module are in patches.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import maximum_filter, minimum_filter

from semianalytic.arrays import to_numpy
from semianalytic.grid import touches_rim

__all__ = ["Edge", "fit", "near_influence"]

Array = NDArray[np.floating]
Indices = NDArray[np.intp]

# Share of a patch that is integrated by parts, by its depth in contact, 1 beside an unloaded patch. Without
# the taper the pressure has a ripple four patches from the edge: 1e-3 of the peak in place of 2e-4.
TAPER = (1.0, 1.0, 0.75, 0.5, 0.25)
PARTS = 7  # of a patch a side, odd
REACH = 5  # within which the quadratic is fitted
RIM = 0.2  # weight of a patch beside an unloaded one, whose pressure is the least accurate
NEAR = 4  # within which the deflection is that of the parts, beyond it that of their moments
MISFIT, SUPPORT = 0.2, 9  # of a smooth edge: largest misfit, least number of patches that are not at the rim
HALO = max(REACH, len(TAPER))
AT_ONCE = 2**18  # patches examined together,
AT_EDGE = 2**13  # of them near the edge
CROSS = np.array([[0, 1, 0], [1, 1, 1], [0, 1, 0]], dtype=bool)


@dataclass(frozen=True, eq=False)
class Edge:
    """The patches near the edge and the pressure in them.

    i, j : their indices by rows, (k,).  quadratic : coefficients of p^2 [Pa^2], (k, 6), of 1, x, y, x^2, xy,
    y^2 over ``REACH``, the origin at the patch centre.  mean : of p [Pa], (k,).  share : integrated by parts,
    (k,).  area : of the whole contact, in patches.  misfit : largest misfit of a quadratic, as the distance
    by which it would miss the edge, in patches.
    """

    i: Indices
    j: Indices
    quadratic: Array
    mean: Array
    share: Array
    area: float
    misfit: float

    def embedded(self, i0: int, j0: int) -> "Edge":
        """The same on a grid of which its own was a window that begins at patch i0, j0."""
        return replace(self, i=self.i + i0, j=self.j + j0)

    def pressure(self, p: Array, x: Array, y: Array) -> Array:
        """Pressure [Pa] at points x, y, (k,), in patches from the centre of the first, of p at the centres.

        By the quadratic of p^2 around the nearest patch, from differences away from the edge; 0 outside.
        """
        i, j = (np.clip(np.round(v), 0, n - 1).astype(int) for v, n in zip((x, y), p.shape, strict=True))
        own, asked = self.i * p.shape[1] + self.j, i * p.shape[1] + j
        at = np.minimum(np.searchsorted(own, asked), own.size - 1)
        s, t, near = x - i, y - j, own[at] == asked
        square = np.einsum("ka,ka->k", self.quadratic[at], _terms(s, t))
        L = np.pad(p, 1) ** 2
        c, e, w, n, south = (L[i + 1 + a, j + 1 + b] for a, b in ((0, 0), (1, 0), (-1, 0), (0, 1), (0, -1)))
        cross = L[i + 2, j + 2] + L[i, j] - L[i + 2, j] - L[i, j + 2]
        inside = c + s * (e - w) / 2 + t * (n - south) / 2 + s * t * cross / 4
        inside += s * s * (e + w - 2 * c) / 2 + t * t * (n + south - 2 * c) / 2
        return np.sqrt(np.maximum(np.where(near, square, np.where(c > 0, inside, 0)), 0))

    def patch_mean(self, p: Array) -> Array:
        """Means over the patches of a pressure p [Pa] given at their centres: the whole load."""
        mean = np.array(p)
        for a, b in _rows(p):
            mean[a:b] += _smooth(p, a, b, self)[0][1:-1]
        mean[self.i, self.j] += self.share * (self.mean - p[self.i, self.j])
        return mean

    def deflection_beyond_centres(
        self, parts: Array, p: Array, deflection: Callable[[Array], Array], near: Array
    ) -> tuple[Array, float]:
        """Deflection [m] under p less that of constant patches, and what these miss of the sum of p [Pa].

        Constant patches carry the values at the centres. The difference is that of 3 x 3 constant patches
        with the moments of p up to the second and, within ``NEAR`` of the edge's patches, of their parts.

        parts [Pa] : as from `fit`, overwritten.  p [Pa] : at the centres.  deflection : of constant patches.
        near : `near_influence`.
        """
        moments = np.zeros_like(p)
        parts *= self.share[:, None]
        centre = self.share * np.sqrt(np.maximum(self.quadratic[:, 0], 0))
        missing = float(np.sum(self.share * self.mean - centre))
        for a, b in _rows(p):
            bend, mx, my = _smooth(p, a, b, self)
            moments[a:b] = bend[1:-1] + (mx[:-2] - mx[2:]) / 2
            moments[a:b, 1:] += my[1:-1, :-1] / 2
            moments[a:b, :-1] -= my[1:-1, 1:] / 2
            missing += float(bend[1:-1].sum())
        for (di, dj), weight in _stencil().items():
            moments[self.i + di, self.j + dj] += parts @ weight
        moments[self.i, self.j] -= centre
        u = deflection(moments)
        del moments
        u = np.pad(u, NEAR)
        for k in _few(parts):
            i, j = self.i[k], self.j[k]
            for (di, dj), at_offset in zip(
                np.ndindex(2 * NEAR + 1, 2 * NEAR + 1), near @ parts[k].T, strict=True
            ):
                u[i + di, j + dj] += at_offset
        return u[NEAR:-NEAR, NEAR:-NEAR], missing


def fit(p: Array, *, even: bool = False) -> tuple[Edge, Array] | None:
    """Edge of the contact under pressure p [Pa] at the patch centres; None where it is not a smooth curve.

    even : p is even about the middle of the patches along both axes; a quarter of the edge is fitted.

    It is one if around every loaded patch beside an unloaded one the quadratic misses p^2, root mean square,
    by no more than p^2 changes over ``MISFIT`` of a patch, and is supported by ``SUPPORT`` loaded patches
    with four loaded neighbours; and if the contact keeps off the rim of the grid. A surface rough on the
    scale of the patches does not pass, nor does a corner of the edge, a slit, a contact a few patches wide.

    Returns the edge and the means of p over PARTS x PARTS parts of each of its patches [Pa], (k, PARTS^2).
    """
    if touches_rim(p) or touches_rim(p[1:-1, 1:-1]):
        return None
    found, whole, misfit = [], 0.0, 0.0
    shares = np.array([1.0, *TAPER, 0.0])
    for a, b in _rows(p):
        around = _padded(p, a, b, HALO)
        loaded = around > 0
        depth = sum(minimum_filter(loaded, 2 * n + 1).astype(np.intp) for n in range(len(TAPER) + 1))
        share = np.where(maximum_filter(loaded, 3), shares[depth], 0.0)
        i, j = np.nonzero(share[HALO:-HALO, HALO:-HALO])
        share = share[i + HALO, j + HALO]
        deep = depth[i + HALO, j + HALO]
        whole += np.count_nonzero(loaded[HALO:-HALO, HALO:-HALO]) - float(share[deep > 0].sum())
        if even:
            held = (i + a >= p.shape[0] // 2) & (j >= p.shape[1] // 2)
            i, j, share, deep = i[held], j[held], share[held], deep[held]
        if not i.size:
            continue
        weight = np.where(minimum_filter(loaded, footprint=CROSS), 1.0, RIM * loaded)
        fits = [_quadratics(around, weight, i[k] + HALO, j[k] + HALO) for k in _few(i)]
        quadratic, missed = (np.concatenate(values) for values in zip(*fits, strict=True))
        misfit = max(misfit, float(missed[deep == 1].max(initial=0.0)))
        if misfit > MISFIT:
            return None
        found.append((i + a, j, quadratic, share))
    i, j, quadratic, share = (np.concatenate(parts) for parts in zip(*found, strict=True))
    means = [_parts(quadratic[k]) for k in _few(i)]
    parts, loaded_share = (np.concatenate(values) for values in zip(*means, strict=True))
    if even:
        i, j, quadratic, share, parts, loaded_share = _mirrored(
            p.shape, i, j, quadratic, share, parts, loaded_share
        )
    area = whole + float(share @ loaded_share)
    return Edge(i, j, quadratic, parts.mean(axis=1), share, area, misfit), parts


def _mirrored(
    shape: tuple[int, ...], i: Indices, j: Indices, *values: Array
) -> tuple[Indices, Indices, Array, Array, Array, Array]:
    """Patches i, j of the far quarter, ``values`` as in `fit`, with their mirror images, by rows."""
    at = [i, j]
    quadratic, share, parts, loaded_share = values
    parts = parts.reshape(-1, PARTS, PARTS)
    for axis, n in enumerate(shape):
        image = n - 1 - at[axis]
        other = image != at[axis]
        sign = np.where(np.isin(np.arange(6), (1 + axis, 4)), -1.0, 1.0)
        at = [np.concatenate([k, (image if m == axis else k)[other]]) for m, k in enumerate(at)]
        quadratic = np.concatenate([quadratic, quadratic[other] * sign])
        parts = np.concatenate([parts, np.flip(parts[other], axis + 1)])
        share, loaded_share = (np.concatenate([v, v[other]]) for v in (share, loaded_share))
    rows = np.lexsort(at[::-1])
    parts = parts.reshape(-1, PARTS**2)
    return at[0][rows], at[1][rows], quadratic[rows], share[rows], parts[rows], loaded_share[rows]


def _quadratics(around: Array, weight: Array, i: Indices, j: Indices) -> tuple[Array, Array]:
    """Quadratics of p^2 around the patches i, j by least squares, and their misfits as distances of the edge.

    around, weight : p and its weight.  Returns coefficients [Pa^2] of
    1, x, y, x^2, xy, y^2 over ``REACH``, the origin at the patch centre, (k, 6), and the misfits in patches,
    (k,), infinite without ``SUPPORT``.
    """
    x, y, V, taper = _neighbourhood()
    at = (i[:, None] + x, j[:, None] + y)
    W, L = weight[at], around[at] ** 2
    supported = np.count_nonzero(W == 1, axis=1) >= SUPPORT
    W *= taper
    products = (V[:, :, None] * V[:, None, :]).reshape(-1, 36)
    normal = (W @ products).reshape(-1, 6, 6)
    right = np.einsum("kq,kq,qa->ka", W, L, V, optimize=True)
    normal += 1e-12 * np.eye(6) * normal[:, :1, :1]
    quadratic: Array = np.linalg.solve(normal, right[..., None])[..., 0]
    square = np.einsum("kq,kq,kq->k", W, L, L) - np.einsum("ka,ka->k", right, quadratic)
    slope = np.hypot(quadratic[:, 1], quadratic[:, 2]) / REACH
    root = np.sqrt(np.maximum(square, 0) / W.sum(axis=1))
    return quadratic, np.divide(root, slope, out=np.full(root.shape, np.inf), where=supported)


@lru_cache
def _neighbourhood() -> tuple[Indices, Indices, Array, Array]:
    """Offsets x, y of the patches that a quadratic is fitted to, its terms there, and their weights."""
    n = np.arange(-REACH, REACH + 1)
    x, y = (v.ravel() for v in np.meshgrid(n, n, indexing="ij"))
    taper = 1 - (x**2 + y**2) / (REACH + 0.5) ** 2
    x, y, taper = x[taper > 0], y[taper > 0], taper[taper > 0]
    return x, y, _terms(x, y), taper


def _terms(x: Array | Indices, y: Array | Indices) -> Array:
    s, t = x / REACH, y / REACH
    return np.stack([np.ones_like(s), s, t, s * s, s * t, t * t], axis=-1)


def _parts(quadratic: Array) -> tuple[Array, Array]:
    """Mean of p over PARTS x PARTS parts of every patch, (k, PARTS^2), and its loaded share, (k,).

    Exact for p^2 linear in the direction in which it changes most; two Gauss points across.
    """
    mean, share = np.empty((len(quadratic), PARTS, PARTS)), np.empty(len(quadratic))
    face = np.arange(PARTS + 1) / PARTS - 0.5
    across = ((np.arange(PARTS) - PARTS // 2)[:, None] + np.array([-0.5, 0.5]) / 3**0.5).ravel() / PARTS
    along_x = np.abs(quadratic[:, 1]) >= np.abs(quadratic[:, 2])
    for group, swap in ((along_x, False), (~along_x, True)):
        c = quadratic[group][:, [0, 2, 1, 5, 4, 3]] if swap else quadratic[group]
        L = (c @ _terms(*np.meshgrid(face, across, indexing="ij")).reshape(-1, 6).T).reshape(
            -1, PARTS + 1, 2 * PARTS
        )
        L -= c[:, 3, None, None] / (6 * (REACH * PARTS) ** 2)  # its mean over the part is that of a chord
        low, high = L[:, :-1], L[:, 1:]
        u, v = np.sqrt(np.maximum(low, 0)), np.sqrt(np.maximum(high, 0))
        cut = (low > 0) != (high > 0)
        length = np.divide(v * v - u * u, high - low, out=(low > 0).astype(float), where=cut)
        total = u + v
        p = np.divide(2 / 3 * (u * u + u * v + v * v), total, out=np.zeros_like(total), where=total > 0)
        p = (p * length).reshape(-1, PARTS, PARTS, 2).mean(axis=3)
        mean[group] = p.transpose(0, 2, 1) if swap else p
        share[group] = length.mean(axis=(1, 2))
    return mean.reshape(-1, PARTS**2), share


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


def _smooth(p: Array, a: int, b: int, edge: Edge) -> tuple[Array, Array, Array]:
    """Mean beyond the centre value, lap p/24, and first moments, grad p/12, rows a-1 to b+1 [Pa].

    By differences of p^2; of the share of the patches that is not integrated by parts.
    """
    L = _padded(p, a, b, 2)
    inverse = L[1:-1, 2:-2].copy()
    near = (edge.i >= a - 1) & (edge.i < b + 1)
    at, rest = (edge.i[near] - (a - 1), edge.j[near]), 1 - edge.share[near]
    inverse[at] *= rest > 0
    np.divide(1, inverse, out=inverse, where=inverse > 0)
    L = L[:, 1:-1] ** 2
    middle = L[1:-1, 1:-1]
    px = (L[2:, 1:-1] - L[:-2, 1:-1]) * inverse / 4
    py = (L[1:-1, 2:] - L[1:-1, :-2]) * inverse / 4
    bend = L[2:, 1:-1] + L[:-2, 1:-1] + L[1:-1, 2:] + L[1:-1, :-2] - 4 * middle
    bend = bend * inverse / 2 - (px * px + py * py) * inverse
    moments = bend / 24, px / 12, py / 12
    for moment in moments:
        moment[at] *= rest
    return moments


def _padded(p: Array, a: int, b: int, width: int) -> Array:
    """Rows a to b of p and ``width`` patches around them, 0 beyond the grid; in NumPy."""
    low, high = max(a - width, 0), min(b + width, p.shape[0])
    return np.pad(to_numpy(p[low:high, :]), ((low - a + width, b + width - high), (width, width)))


def _few(patches: Array | Indices) -> Iterator[slice]:
    """Patches near the edge, ``AT_EDGE`` at a time."""
    return (slice(k, k + AT_EDGE) for k in range(0, len(patches), AT_EDGE))


def _rows(p: Array) -> Iterator[tuple[int, int]]:
    """Rows of patches, ``AT_ONCE`` patches at a time."""
    step = max(AT_ONCE // p.shape[1], 4 * REACH)
    return ((a, min(a + step, p.shape[0])) for a in range(0, p.shape[0], step))
