"""Stress below the patches of a loaded grid.

Each patch carries the pressure p and the traction q = f p on the solid in +x. At a depth z the field is a discrete
convolution of p with the influence of one patch, which is found in one of two ways (d the patch, L the scale on
which the response of the solid dies, exp(-k L)):

- z >= 3 d. The patch is a point force: the lattice sum of a function of scale z differs from the sum over patches by
  its aliases, exp(-2 pi z/d), once the force is smeared to fourth order. Deeper down the forces are first
  gathered on a lattice of spacing up to z/8 with the weights of quintic interpolation, which keep moments up to five.
- z < 3 d. In the first coating (or the uncoated solid) the rectangle on a homogeneous half-space of that material in
  closed form, with the rest of the response, of scale 2h - z, averaged over the patch by Gauss points.
  In a deeper layer the whole response so, its scale being z >= h.

A constant pressure per patch has steps of p' d, and its stress near the surface has their logarithms, but at
the patch centres both are of second order. Close to the surface the stress is therefore evaluated below
patch centres, and interpolated between them by cubics.

Source: source paper, eqs. 1-4; theory sheet, section 3.2. Axes: z down; tension positive; SI units.
"""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.fft import irfft2, next_fast_len, rfft2

from .pointload import PointLoad, displacement_below, stress_below

__all__ = ["displacement", "stress"]

Array = NDArray[Any]
Influence = Callable[[Array, Array], Array]
Coatings = Sequence[tuple[float, float, float]]

SHALLOW = 3.0  # patches; above this depth a patch is not yet a point force: aliases exp(-6 pi) = 7e-9
COARSE = 8.0  # depth over lattice spacing; the sixth-order interpolation then errs by 1e-5
PAIRS = 200_000  # points times forces held at a time


def stress(
    x: ArrayLike,
    y: ArrayLike,
    z: ArrayLike,
    layer: ArrayLike,
    *,
    grid_x: Array,
    grid_y: Array,
    pressure: Array,
    friction: float,
    coatings: Coatings,
    substrate: tuple[float, float],
    rectangle: tuple[Callable[..., Array], Callable[..., Array]],
    stress_frf: Callable[..., Array],
) -> Array:
    """Stress at points (x, y, z) of the layers named, under pressure p with traction q = f p in +x.

    x, y, z : points [m], broadcast.  layer : which side is meant at an interface, integers, broadcast.
    pressure : p [Pa], (nx, ny), constant on patches centred at grid_x, grid_y [m], which are uniform.
    rectangle : normal and tangential stress of a uniformly loaded rectangle, as in `halfspace`.
    stress_frf : response functions, as in `frf`.
    Returns sigma[i, j, ...] [Pa], shape (3, 3) + points.
    """

    def below(z: Array, layer: int, scale: float, excess: bool, smear: float) -> list[PointLoad]:
        return stress_below(
            z,
            layer,
            scale,
            stress_frf=stress_frf,
            coatings=coatings,
            substrate=substrate,
            friction=friction,
            excess=excess,
            smear=smear,
        )

    nu = (*coatings, substrate)[0][1]
    normal, tangential = rectangle

    def closed(X: Array, Y: Array, z: float, dx: float, dy: float) -> Array:
        s = normal(X, Y, z, dx, dy, nu)
        if friction:
            s = s + friction * tangential(X, Y, z, dx, dy, nu)
        return s[(0, 1, 2, 0, 0, 1), (0, 1, 2, 1, 2, 2)]

    parts = _evaluate(x, y, z, layer, grid_x, grid_y, pressure, coatings, below, closed, odd_in_y=(3, 5))
    xx, yy, zz, xy, xz, yz = parts
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


def displacement(
    x: ArrayLike,
    y: ArrayLike,
    z: ArrayLike,
    layer: ArrayLike,
    *,
    grid_x: Array,
    grid_y: Array,
    pressure: Array,
    friction: float,
    coatings: Coatings,
    substrate: tuple[float, float],
    rectangle: tuple[Callable[..., Array], Callable[..., Array]],
    displacement_frf: Callable[..., Array],
) -> Array:
    """Displacement at points (x, y, z), arguments as in `stress` with the displacements of the rectangle.

    Returns u[i, ...] [m], shape (3,) + points; u_z into the solid.
    """

    def below(z: Array, layer: int, scale: float, excess: bool, smear: float) -> list[PointLoad]:
        return displacement_below(
            z,
            layer,
            scale,
            displacement_frf=displacement_frf,
            coatings=coatings,
            substrate=substrate,
            friction=friction,
            excess=excess,
            smear=smear,
        )

    E, nu = (*coatings, substrate)[0][:2]
    normal, tangential = rectangle

    def closed(X: Array, Y: Array, z: float, dx: float, dy: float) -> Array:
        u = normal(X, Y, z, dx, dy, E, nu)
        return u + friction * tangential(X, Y, z, dx, dy, E, nu) if friction else u

    return _evaluate(x, y, z, layer, grid_x, grid_y, pressure, coatings, below, closed, odd_in_y=(1,))


def _evaluate(x, y, z, layer, grid_x, grid_y, pressure, coatings, below, closed, odd_in_y) -> Array:
    """Field components (n,) + points, depth by depth."""
    x, y, z, layer = np.broadcast_arrays(*(np.asarray(v) for v in (x, y, z, layer)))
    shape = z.shape
    x, y, z, layer = (v.ravel() for v in (x, y, z, layer))
    levels = _lattices(grid_x, grid_y, pressure)
    dx, dy = levels[0].dx, levels[0].dy
    d = max(dx, dy)
    out: Array | None = None
    for number in np.unique(layer):
        depths, which = np.unique(np.where(layer == number, z, np.nan), return_inverse=True)
        depths = depths[np.isfinite(depths)]
        for start, stop, scale, shallow in _groups(depths, int(number), d, coatings):
            zs = depths[start:stop]
            excess = shallow and number == 0
            smear = 0.0 if shallow else np.sqrt((dx**2 + dy**2) / 2)
            kernels: list[Any] = [None] * len(zs)
            if not (excess and not coatings):
                kernels = below(zs, int(number), scale, excess, smear)
            for i, (depth, kernel) in enumerate(zip(zs, kernels, strict=True)):
                at = np.flatnonzero((which == start + i) & (layer == number))
                if shallow:
                    influence = _of_patch(kernel, closed if excess else None, depth, dx, dy, scale)
                    part = _between_centres(x[at], y[at], levels[0], influence, odd_in_y, 4)
                else:
                    level = int(np.clip(np.log2(max(depth / (COARSE * d), 1)), 0, len(levels) - 1))
                    part = _below_forces(x[at], y[at], levels[level], kernel, odd_in_y)
                if out is None:
                    out = np.zeros((len(part), z.size))
                out[:, at] = part
    assert out is not None
    return out.reshape(-1, *shape)


def _groups(depths: Array, layer: int, d: float, coatings: Coatings) -> list[tuple[int, int, float, bool]]:
    """Runs of depths that share a table of wavenumbers: first, last + 1, scale L, whether shallow."""
    runs: list[tuple[int, int, float, bool]] = []
    for i, z in enumerate(depths):
        shallow = bool(z < SHALLOW * d)
        reach = z
        if shallow and layer == 0:
            reach = 2 * coatings[0][2] - z if coatings else d
        scale = 2.0 ** np.floor(np.log2(reach))
        if runs and runs[-1][2:] == (scale, shallow) and i - runs[-1][0] < 64:
            runs[-1] = (runs[-1][0], i + 1, scale, shallow)
        else:
            runs.append((i, i + 1, scale, shallow))
    return runs


class _Lattice:
    """Forces [N] on a uniform lattice: x = x0 + i dx, y = y0 + j dy."""

    def __init__(self, x0: float, y0: float, dx: float, dy: float, force: Array):
        self.x0, self.y0, self.dx, self.dy, self.force = x0, y0, dx, dy, force

    def coarser(self) -> "_Lattice":
        """The same forces on twice the spacing, by the adjoint of quintic interpolation."""
        force = _gather(_gather(self.force).T).T
        return _Lattice(self.x0 - 6 * self.dx, self.y0 - 6 * self.dy, 2 * self.dx, 2 * self.dy, force)


def _gather(force: Array) -> Array:
    """Every second row takes over the forces of all, moments up to five kept; starts 6 rows before the first."""
    n = force.shape[0]
    padded = np.zeros((n + 24, force.shape[1]))
    padded[11 : 11 + n] = force
    count = (n + 1) // 2 + 6
    weights = {0: 256, 1: 150, 3: -25, 5: 3}
    out = np.zeros((count, force.shape[1]))
    for offset in (-5, -3, -1, 0, 1, 3, 5):
        begin = 5 + offset
        out += weights[abs(offset)] / 256 * padded[begin : begin + 2 * count : 2]
    return out


def _lattices(grid_x: Array, grid_y: Array, pressure: Array) -> list[_Lattice]:
    """The loaded box of the grid as point forces, then coarser and coarser."""
    grid_x, grid_y = np.asarray(grid_x, dtype=float), np.asarray(grid_y, dtype=float)
    dx = (grid_x[-1] - grid_x[0]) / (grid_x.size - 1)
    dy = (grid_y[-1] - grid_y[0]) / (grid_y.size - 1)
    rows, columns = np.flatnonzero(pressure.any(axis=1)), np.flatnonzero(pressure.any(axis=0))
    if not rows.size:
        rows = columns = np.array([0])
    box = slice(rows[0], rows[-1] + 1), slice(columns[0], columns[-1] + 1)
    levels = [_Lattice(grid_x[rows[0]], grid_y[columns[0]], dx, dy, pressure[box] * (dx * dy))]
    while max(levels[-1].force.shape) > 24:
        levels.append(levels[-1].coarser())
    return levels


def _of_patch(kernel, closed, z: float, dx: float, dy: float, scale: float) -> Influence:
    """Influence of unit force on a patch close by: closed form where there is one, the rest by Gauss points."""
    d = max(dx, dy)
    # nearest singularity of the kernel at distance L, half a patch d/2: the rule gains L/d digits a point
    fine = int(np.clip(np.ceil(1 + 4.5 * d / scale), 2, 12))

    def influence(X: Array, Y: Array) -> Array:
        total = 0.0
        if closed is not None:
            total = closed(X, Y, z, dx, dy) / (dx * dy)
        if kernel is None:
            return total
        near = np.maximum(np.abs(X), np.abs(Y)) < 6.5 * d
        rest = np.zeros_like(_averaged(kernel, X, Y, dx, dy, 2)) if fine == 2 else None
        if rest is None:
            rest = _averaged(kernel, X, Y, dx, dy, 2)
            rest[:, near] = _averaged(kernel, X[near], Y[near], dx, dy, fine)
        else:
            rest = _averaged(kernel, X, Y, dx, dy, 2)
        return total + rest

    return influence


def _averaged(kernel: Influence, X: Array, Y: Array, dx: float, dy: float, n: int) -> Array:
    """Mean of a kernel over the patch by n x n Gauss points."""
    s, w = np.polynomial.legendre.leggauss(n)
    total: Array | float = 0.0
    for si, wi in zip(s, w, strict=True):
        for sj, wj in zip(s, w, strict=True):
            total = total + wi * wj / 4 * kernel(X - si * dx / 2, Y - sj * dy / 2)
    return np.asarray(total)


def _below_forces(x: Array, y: Array, lattice: _Lattice, kernel: PointLoad, odd_in_y) -> Array:
    """Sum over the forces at points of one depth: directly for few points, else on the lattice and between."""
    i, j = np.nonzero(lattice.force)
    if x.size > 64:
        return _between_centres(x, y, lattice, kernel, odd_in_y, 6)
    X, Y, force = lattice.x0 + i * lattice.dx, lattice.y0 + j * lattice.dy, lattice.force[i, j]
    step = max(1, PAIRS // max(force.size, 1))
    parts = []
    for begin in range(0, x.size, step):
        xs, ys = x[begin : begin + step, None], y[begin : begin + step, None]
        parts.append(kernel(xs - X, ys - Y) @ force)
    return np.concatenate(parts, axis=1)


def _between_centres(x: Array, y: Array, lattice: _Lattice, influence: Influence, odd_in_y, order: int) -> Array:
    """Field below the lattice sites around each point, interpolated by polynomials of ``order`` sites."""
    i, wx = _stencil((x - lattice.x0) / lattice.dx, order)
    j, wy = _stencil((y - lattice.y0) / lattice.dy, order)
    weight = wx[:, :, None] * wy[:, None, :]
    point, a, b = np.nonzero(weight)
    sites, inverse = np.unique(np.stack([i[point, a], j[point, b]]), axis=1, return_inverse=True)
    field = _at_sites(sites, lattice, influence, odd_in_y)
    out = np.zeros((len(field), x.size))
    contribution = field[:, inverse.ravel()] * weight[point, a, b]
    for component, part in zip(out, contribution, strict=True):
        component[:] = np.bincount(point, part, minlength=x.size)
    return out


def _stencil(s: Array, order: int) -> tuple[Array, Array]:
    """Sites (n, order) around positions ``s``, and Lagrange weights; one site alone when ``s`` is on it."""
    nearest = np.round(s)
    s = np.where(np.abs(s - nearest) < 1e-7, nearest, s)
    first = np.floor(s).astype(int) - (order // 2 - 1)
    sites = first[:, None] + np.arange(order)
    t = s - first
    weights = np.ones((s.size, order))
    for a in range(order):
        for b in range(order):
            if a != b:
                weights[:, a] *= (t - b) / (a - b)
    return sites, weights


def _at_sites(sites: Array, lattice: _Lattice, influence: Influence, odd_in_y) -> Array:
    """Discrete convolution at lattice sites (2, n): term by term for a few, by FFT for many."""
    force = lattice.force
    low, high = sites.min(axis=1), sites.max(axis=1)
    # offsets site - force, from the least to the greatest
    m = np.arange(low[0] - (force.shape[0] - 1), high[0] + 1)
    n = np.arange(low[1] - (force.shape[1] - 1), high[1] + 1)
    table = _table(influence, m * lattice.dx, n, lattice.dy, odd_in_y)
    if sites.shape[1] <= 32:
        out = np.empty((len(table), sites.shape[1]))
        flipped = force[::-1, ::-1]
        for c, (i, j) in enumerate((sites - low[:, None]).T):
            window = table[:, i : i + force.shape[0], j : j + force.shape[1]]
            out[:, c] = np.tensordot(window, flipped, 2)
        return out
    size = (next_fast_len(m.size, real=True), next_fast_len(n.size, real=True))
    spectrum = rfft2(force, size)
    begin = sites - low[:, None] + np.array(force.shape)[:, None] - 1
    return np.array([irfft2(rfft2(part, size) * spectrum, size)[begin[0], begin[1]] for part in table])


def _table(influence: Influence, X: Array, n: Array, dy: float, odd_in_y) -> Array:
    """Influence at all offsets, computed for y >= 0 and mirrored."""
    distinct, where = np.unique(np.abs(n), return_inverse=True)
    XX, YY = np.meshgrid(X, distinct * dy, indexing="ij")
    half = influence(XX.ravel(), YY.ravel()).reshape(-1, *XX.shape)
    table = half[:, :, where]
    for component in odd_in_y:
        table[component] *= np.where(n < 0, -1.0, 1.0)
    return table
