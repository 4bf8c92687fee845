"""Discrete convolution of forces on a lattice, at lattice sites or at any point between them.

    field(x_i, y_j) = sum_kl K(i - k, j - l) F_kl

K has several components; some are odd in y, all others even, so that the table of K is computed for
j >= l and mirrored. Far from the forces they may first be gathered on a coarser lattice, with the weights
of the interpolation that K, smooth over it, would allow (its adjoint: moments up to nine are kept).
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.fft import irfft, irfft2, next_fast_len, rfft, rfft2
from scipy.special import erfc

from semianalytic import numbers

Array = NDArray[Any]
Influence = Callable[[Array, Array], Array]  # of integer offsets (m, n), each (k,) -> (components, k)


@dataclass(frozen=True, eq=False)
class Lattice:
    """Forces [N], (nx, ny), at x = x0 + i dx, y = y0 + j dy [m]."""

    x0: float
    y0: float
    dx: float
    dy: float
    force: Array

    def coarser(self) -> "Lattice":
        """Forces gathered on twice the spacing, by the adjoint of interpolation through ten sites."""
        force = _gather(_gather(self.force).T).T
        return Lattice(self.x0 - 10 * self.dx, self.y0 - 10 * self.dy, 2 * self.dx, 2 * self.dy, force)


def nodal_forces(x: Array, pressure: Array) -> Lattice:
    """Forces of the loaded box of a grid, centred at x along both axes [m]."""
    d = float(x[-1] - x[0]) / (x.size - 1)
    rows, columns = np.flatnonzero(pressure.any(axis=1)), np.flatnonzero(pressure.any(axis=0))
    if not rows.size:
        rows = columns = np.array([0])
    box = pressure[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1]
    return Lattice(x[rows[0]] - d, x[columns[0]] - d, d, d, samples(box) * d**2)


def samples(mean: Array) -> Array:
    """Values of p at the centres from its means over patches, mean = p + (d^2/24) lap p; one patch wider.

    Written as a difference the correction keeps the load.
    """
    padded = np.pad(mean, 2)
    middle = padded[1:-1, 1:-1]
    across = padded[2:, 1:-1] + padded[:-2, 1:-1] + padded[1:-1, 2:] + padded[1:-1, :-2]
    return middle - (across - 4 * middle) / 24


def _gather(force: Array) -> Array:
    """Forces of all rows on every second row, starting ten rows before the first."""
    n = force.shape[0]
    padded = np.zeros((n + 40, force.shape[1]))
    padded[19 : 19 + n] = force
    count = (n + 1) // 2 + 10
    out = padded[9 : 9 + 2 * count : 2].copy()
    # Lagrange's weights half-way between ten sites
    for offset, weight in ((1, 39690), (3, -8820), (5, 2268), (7, -405), (9, 35)):
        for begin in (9 - offset, 9 + offset):
            out += weight / 65536 * padded[begin : begin + 2 * count : 2]
    return out


def at_points(
    x: Array,
    y: Array,
    lattice: Lattice,
    kernel: Callable[[Array, Array], Array],
    odd_in_y: Sequence[int],
    *,
    order: int,
) -> Array:
    """Sum over all forces at points (x, y), (k,) each, of a kernel smooth over the lattice; (components, k).

    Term by term for a few points; for many on the lattice, then between its sites with ``order`` of them.
    """
    if x.size > 2 * numbers.FEW_SITES:
        dx, dy = lattice.dx, lattice.dy
        return between_sites(x, y, lattice, lambda m, n: kernel(m * dx, n * dy), odd_in_y, order=order)
    i, j = np.nonzero(lattice.force)
    X, Y, force = lattice.x0 + i * lattice.dx, lattice.y0 + j * lattice.dy, lattice.force[i, j]
    step = max(1, 16 * numbers.CACHE // max(force.size, 1))
    parts = []
    for begin in range(0, x.size, step):
        xs, ys = x[begin : begin + step, None], y[begin : begin + step, None]
        parts.append(kernel(xs - X, ys - Y) @ force)
    return np.concatenate(parts, axis=1)


def near_and_far(
    x: Array,
    y: Array,
    lattices: Sequence[Lattice],
    influence: Influence,
    kernel: Callable[[Array, Array], Array],
    odd_in_y: Sequence[int],
    *,
    order: int,
) -> Array:
    """Sum over all forces at points: over nearby ones by ``influence``, over distant ones by ``kernel``.

    lattices : that of the forces, the one on which they are gathered.   Others as in ``between_sites`` and
    ``at_points``. The share of the nearby ones falls over ``BLEND`` of the wider spacing; interpolated, it
    leaves 5e-7 of the sum, which is that of what a smooth pressure leaves over, below 1e-3 of the peak.
    """
    near, far = lattices
    dx, dy = near.dx, near.dy

    def share(x: Array, y: Array) -> Array:
        return np.asarray(erfc((np.hypot(x, y) / far.dx - numbers.SPLIT) / numbers.BLEND) / 2)

    def nearby(m: Array, n: Array) -> Array:
        return influence(m, n) * share(m * dx, n * dy)

    def distant(x: Array, y: Array) -> Array:
        rest = 1 - share(x, y)
        return kernel(np.where(rest > 0, x, far.dx), y) * rest  # a force at the point itself has no share

    reach = (numbers.SPLIT + 5 * numbers.BLEND) * far.dx / dx
    found = between_sites(x, y, near, nearby, odd_in_y, order=order, reach=reach)
    return found + at_points(x, y, far, distant, odd_in_y, order=10)


def between_sites(
    x: Array,
    y: Array,
    lattice: Lattice,
    influence: Influence,
    odd_in_y: Sequence[int],
    *,
    order: int,
    reach: float = np.inf,
) -> Array:
    """The convolution at the sites around each point, interpolated by polynomials through ``order`` sites.

    reach : offset along x or y from which there is no influence.
    """
    i, wx = _stencil((x - lattice.x0) / lattice.dx, order)
    j, wy = _stencil((y - lattice.y0) / lattice.dy, order)
    weight = wx[:, :, None] * wy[:, None, :]
    point, a, b = np.nonzero(weight)
    sites, inverse = np.unique(np.stack([i[point, a], j[point, b]]), axis=1, return_inverse=True)
    field = _at_sites(sites, lattice, influence, odd_in_y, reach)
    contribution = field[:, inverse.ravel()] * weight[point, a, b]
    return np.array([np.bincount(point, part, minlength=x.size) for part in contribution])


def _stencil(s: Array, order: int) -> tuple[Array, Array]:
    """Sites (k, order) around positions ``s``, and Lagrange weights; one site alone when ``s`` is on it."""
    nearest = np.round(s)
    s = np.where(np.abs(s - nearest) < 1e-7, nearest, s)
    first = np.floor(s).astype(int) - (order // 2 - 1)
    t = s - first
    weights = np.ones((s.size, order))
    for a in range(order):
        for b in range(order):
            if a != b:
                weights[:, a] *= (t - b) / (a - b)
    return first[:, None] + np.arange(order), weights


def _within(offsets: Array, reach: float) -> Array:
    """Those of the ``offsets`` within ``reach``, or the first, which has no influence."""
    near = offsets[np.abs(offsets) <= reach]
    return near if near.size else offsets[:1]


def _at_sites(
    sites: Array, lattice: Lattice, influence: Influence, odd_in_y: Sequence[int], reach: float
) -> Array:
    """The convolution at lattice sites (2, k): along x alone where they lie in a few columns, or by FFT."""
    force = lattice.force
    columns, column = np.unique(sites[1], return_inverse=True)
    low, high = sites.min(axis=1), sites.max(axis=1)
    m = np.arange(low[0] - (force.shape[0] - 1), high[0] + 1)
    if columns.size <= numbers.COLUMNS:
        m = _within(m, reach)
        n = np.arange(1 + int(min(np.abs(columns[:, None] - [0, force.shape[1] - 1]).max(), reach)))
        table = influence_table(influence, m, n, ())
        return _along_columns(table, sites[0] - m[0], force, columns, column, odd_in_y)
    n = np.arange(low[1] - (force.shape[1] - 1), high[1] + 1)
    m, n = _within(m, reach), _within(n, reach)
    table = influence_table(influence, m, n, odd_in_y, reach)
    place = sites - np.array([m[:1], n[:1]])
    rows, influenced = np.array(force.shape), np.array(table.shape[1:])
    whole = rows + influenced - 1
    felt = ((place >= 0) & (place < whole[:, None])).all(axis=0)
    found = np.zeros((len(table), felt.size))
    if not felt.any():
        return found
    i, j = at = place[:, felt]
    # no longer than what leaves the wanted part of the convolution free of the rest
    least = np.max([whole - at.min(axis=1), at.max(axis=1) + 1, rows, influenced], axis=0)
    size = [next_fast_len(int(length), real=True) for length in least]
    spectrum = rfft2(force, size)
    found[:, felt] = [irfft2(rfft2(part, size) * spectrum, size)[i, j] for part in table]
    return found


def _along_columns(
    table: Array, at: Array, force: Array, columns: Array, column: Array, odd_in_y: Sequence[int]
) -> Array:
    """The convolution with the influence at offsets n >= 0 alone: forces either side of a column are folded.

    table : (components, offsets along x, n).   at, column : of each site, in the convolution and ``columns``.
    """
    n, rows, length = np.arange(table.shape[2]), force.shape[0], table.shape[1]
    padded = np.pad(force, ((0, 0), (2 * n.size, 2 * n.size)))
    size = next_fast_len(rows + length - 1, real=True)
    spectra: dict[int, Array] = {}
    out = np.zeros((len(table), at.size))
    for number, j in enumerate(columns + 2 * n.size):
        here = np.flatnonzero((column == number) & (at >= 0) & (at < rows + length - 1))
        left, right = padded[:, j - n], padded[:, j + n] * (n > 0)
        for odd, folded in ((False, left + right), (True, left - right)):
            components = [c for c in range(len(table)) if (c in odd_in_y) is odd]
            if not folded.any():  # a symmetric pressure has no odd components on its axis
                continue
            if at.size <= numbers.FEW_SITES:
                for k in here:
                    last, first = min(rows - 1, at[k]), max(0, at[k] - length + 1)
                    near = table[components, at[k] - last : at[k] - first + 1]
                    out[components, k] = np.tensordot(near, folded[first : last + 1][::-1], 2)
                continue
            spectrum = rfft(folded, size, axis=0)
            for c in components:
                if c not in spectra:
                    spectra[c] = rfft(table[c], size, axis=0)
                out[c, here] = irfft((spectra[c] * spectrum).sum(axis=1), size)[at[here]]
    return out


def influence_table(
    influence: Influence, m: Array, n: Array, odd_in_y: Sequence[int], reach: float = np.inf
) -> Array:
    """Influence at the offsets m x n, computed for n >= 0 and mirrored; (components, len(m), len(n)).

    m, n : each one more than the one before.   reach : 0 for offsets beyond it.
    """
    mine = np.flatnonzero(np.abs(m) <= reach)
    sides = [np.flatnonzero((n >= 0) & (n <= reach)), np.flatnonzero((n < 0) & (n >= -reach))]
    distinct = np.unique(np.abs(n[np.concatenate(sides)]))
    table = np.zeros((len(influence(m[:1], n[:1])), m.size, n.size))
    if not mine.size or not distinct.size:
        return table
    rows = max(1, 16 * numbers.CACHE // distinct.size)
    for some in (mine[i : i + rows] for i in range(0, mine.size, rows)):
        mm, nn = np.meshgrid(m[some], distinct, indexing="ij")
        block = influence(mm.ravel(), nn.ravel()).reshape(-1, *mm.shape)
        for side in (one for one in sides if one.size):
            mirrored = block[:, :, np.abs(n[side]) - distinct[0]]
            table[:, some[0] : some[-1] + 1, side[0] : side[-1] + 1] = mirrored
    for component in odd_in_y:
        table[component] *= np.where(n < 0, -1.0, 1.0)
    return table
