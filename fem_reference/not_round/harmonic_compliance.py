"""Compliance of the surface of a layered solid to each angular harmonic of a pressure.

By hand: many pressures on one mesh are needed, and more harmonics than it is worth to factorise matrices for.

Finite elements see a pressure as its products with the shape functions phi_i on the surface,

    L_mi = int p cos(m theta) phi_i(r) dA,   u_z(r, theta) = sum_m cos(m theta) sum_ij phi_i(r) S_m,ij L_mj,

with one matrix S_m for each harmonic, found by as many right-hand sides as there are nodes below the
pressure. So  int p u_z' dA = sum_m L_m . S_m L'_m  holds for any two pressures without a further solution.

The stiffness matrix is a polynomial in m, so S_m depends smoothly on m, which need not be an integer: beyond
``DIRECT`` m S_m is interpolated in log m between Chebyshev's points. A shorter wave is stiffer in proportion.

Friction along x, q = f p, has the products with the shape functions of u_r and u_theta

    R_m = f (L_(m-1) + L_(m+1))/2,      T_m = -f (L_(m-1) - L_(m+1))/2,      L_-1 = L_1.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import scipy.sparse as sp

from fem_reference import element_numbers as chosen
from fem_reference.elasticity.axisymmetric import Discretisation, Skeleton
from fem_reference.elasticity.linear_system import ConstrainedFactor
from fem_reference.scaling import LayeredSolid


@dataclass(frozen=True, eq=False)
class HarmonicCompliance:
    """Response to the pressures that act on the unknowns ``loaded`` of one field on the surface of one mesh.

    solved : m of each solution.  fields : by unit loads of it, as ``Meridian.solve``, (unknowns, nodes).
    meridians : of the same m, factorised.  last, fold : harmonics 0, fold, 2 fold, .., last
    """

    solid: LayeredSolid
    discretisation: Discretisation
    loaded: np.ndarray
    solved: tuple[float, ...]
    fields: tuple[np.ndarray, ...]
    meridians: tuple["Meridian", ...]
    last: int
    fold: int

    @cached_property
    def nodes(self) -> np.ndarray:
        """Radii of the unknowns below the pressure."""
        return self.discretisation.locations[0, self.loaded]

    @property
    def vertices(self) -> np.ndarray:
        """Radii of the vertices among them."""
        return self.nodes[:: self.discretisation.order]

    @cached_property
    def harmonics(self) -> np.ndarray:
        """m of the pressure."""
        return np.arange(0, self.last + 1, self.fold)

    @cached_property
    def matrices(self) -> np.ndarray:
        """S_m, (harmonics, nodes, nodes)."""
        found = [one.deflection(u, self.loaded) for one, u in zip(self.meridians, self.fields, strict=True)]
        return np.array([sum(w * found[k] for k, w in _weights(self.solved, m)) for m in self.harmonics])

    def nodal_loads(self, r: np.ndarray, theta: np.ndarray, forces: np.ndarray, last: int) -> np.ndarray:
        """L of ``forces`` (columns, arcs, points), (harmonics to ``last``, nodes, columns).

        r, theta : radius of each arc (arcs,) and angles on it (arcs, points)
        """
        onto, at_arcs = self._shapes(r).T, forces.transpose(1, 2, 0)
        return np.array([onto @ (wave[:, None, :] @ at_arcs)[:, 0] for wave in self._waves(theta, last)])

    def products(self, r: np.ndarray, values: np.ndarray) -> np.ndarray:
        """sum_k values_mk phi_i(r_k), (harmonics, nodes), of values (harmonics, radii)."""
        return (self._shapes(r).T @ values.T).T

    def deflection(self, at_nodes: np.ndarray, r: np.ndarray, theta: np.ndarray) -> np.ndarray:
        """u_z on arcs as in ``nodal_loads``, (arcs, points), of its amplitudes (nodes, harmonics)."""
        of_arcs = self._shapes(r) @ at_nodes
        u = np.zeros(theta.shape)
        for amplitude, wave in zip(of_arcs.T, self._waves(theta, self.last), strict=True):
            u += amplitude[:, None] * wave
        return u

    def displacements(self, loads: np.ndarray) -> dict[int, np.ndarray]:
        """Field vector of every harmonic under a pressure of ``loads`` (harmonics, nodes)."""
        pressed = {int(m): L for m, L in zip(self.harmonics, loads, strict=True) if L.any()}

        def respond(k: int, columns: np.ndarray) -> np.ndarray:
            return self.meridians[k].extended(self.fields[k] @ columns, _normal(columns))

        return _superposed(self.solved, pressed, respond)

    def sliding(self, loads: np.ndarray, friction: float) -> dict[int, np.ndarray]:
        """Fields under the traction ``friction`` times the pressure along x."""
        L = np.zeros((self.last + 3, self.nodes.size))
        L[self.harmonics] = loads
        pulled: dict[int, np.ndarray] = {}
        for m in range(self.last + 2):
            below, above = L[abs(m - 1)], L[m + 1]
            tractions = friction / 2 * np.array([0 * below, below + above, above - below])
            if tractions.any():
                pulled[m] = tractions
        known = dict(zip(self.solved, self.meridians, strict=True))
        solved = (*(m for m in pulled if m < chosen.DIRECT), *(m for m in self.solved if m >= chosen.DIRECT))

        def respond(k: int, columns: np.ndarray) -> np.ndarray:
            one = known.get(solved[k]) or Meridian.of(self.solid, self.discretisation, solved[k])
            return one.extended(one.solve(self.loaded, columns), columns)

        return _superposed(solved, pulled, respond)

    def _waves(self, theta: np.ndarray, last: int) -> Iterator[np.ndarray]:
        """cos(m theta) of the harmonics m to ``last``."""
        wave, turn = np.ones(theta.shape, dtype=complex), np.exp(1j * self.fold * theta)
        for _ in range(0, last + 1, self.fold):
            yield wave.real
            wave = wave * turn

    def _shapes(self, r: np.ndarray) -> sp.csr_matrix:
        """phi_i(r), (points, nodes); r between the first node and the last."""
        order = self.discretisation.order
        vertices = self.nodes[::order]
        cell = np.clip(np.searchsorted(vertices, r, side="right") - 1, 0, vertices.size - 2)
        t = order * (r - vertices[cell]) / (vertices[cell + 1] - vertices[cell])
        knots = np.arange(order + 1)
        values = [np.prod([(t - k) / (i - k) for k in knots if k != i], axis=0) for i in knots]
        columns, rows = cell[:, None] * order + knots, np.arange(r.size + 1) * (order + 1)
        return sp.csr_matrix(
            (np.stack(values, axis=1).ravel(), columns.ravel(), rows), shape=(r.size, self.nodes.size)
        )


def harmonic_compliance(
    solid: LayeredSolid,
    d: Discretisation,
    last: int,
    fold: int,
    density: float = chosen.DENSITY,
    inner: float = 0.0,
) -> HarmonicCompliance:
    """Compliance to pressures between the radius ``inner`` and the mesh's contact radius.

    Of harmonics 0, fold, .. to ``last``
    """
    wanted = range(0, last + 1, fold)
    solved = (*(m for m in wanted if m < chosen.DIRECT), *_high(last + 1, density))
    first = np.searchsorted(d.contact_vertices, inner, side="right") - 1
    loaded = d.contact[d.order * first :]
    meridians = tuple(Meridian.of(solid, d, m) for m in solved)
    fields = tuple(one.solve(loaded, _normal(np.eye(loaded.size))) for one in meridians)
    return HarmonicCompliance(solid, d, loaded, solved, fields, meridians, last, fold)


def _high(last: int, density: float) -> list[float]:
    """m of the solutions from which those of ``DIRECT`` to ``last`` follow: all, or Chebyshev's points in
    log m."""
    low, high = np.log(chosen.DIRECT), np.log(max(last, chosen.DIRECT))
    count = int(np.ceil(density * (high - low))) + 1
    if last < chosen.DIRECT + max(count, 2):
        return list(range(chosen.DIRECT, last + 1))
    inner = (1 - np.cos(np.pi * np.arange(1, count - 1) / (count - 1))) / 2
    return [chosen.DIRECT, *np.exp(low + (high - low) * inner).tolist(), last]


def _weights(solved: tuple[float, ...], m: int) -> list[tuple[int, float]]:
    """Numbers of the solutions whose weighted sum is that of m: itself, or Lagrange's of m times them."""
    if m in solved:
        return [(solved.index(m), 1.0)]
    first = sum(one < chosen.DIRECT for one in solved)
    x = np.log(solved[first:])
    away = np.log(m) - x
    lagrange = [np.prod(np.delete(away, k)) / np.prod(np.delete(x[k] - x, k)) for k in range(x.size)]
    return [(first + k, float(w) * solved[first + k] / m) for k, w in enumerate(lagrange)]


def _superposed(
    solved: tuple[float, ...], loads: dict[int, np.ndarray], respond: Callable[[int, np.ndarray], np.ndarray]
) -> dict[int, np.ndarray]:
    """Field vector of every m under its ``loads``, (.., nodes).

    respond : field vectors (n, columns) of a solution, by number, under loads (.., nodes, columns)
    """
    weights = {m: dict(_weights(solved, m)) for m in loads}
    between = [m for m in loads if m not in solved]
    found: dict[int, np.ndarray] = {}
    total: Any = 0.0
    for k, one in enumerate(solved):
        direct = [m for m in loads if m == one]
        wanted = direct + (between if one >= chosen.DIRECT else [])
        if wanted:
            u = respond(k, np.stack([weights[m][k] * loads[m] for m in wanted], axis=-1))
            found |= {m: u[:, j] for j, m in enumerate(direct)}
            total += u[:, len(direct) :] if one >= chosen.DIRECT else 0.0
    return found | dict(zip(between, total.T if between else (), strict=True))


@dataclass(frozen=True, eq=False)
class Meridian:
    """The meridian problem of one m, factorised."""

    solid: LayeredSolid
    discretisation: Discretisation
    harmonic: float
    skeleton: Skeleton
    factor: ConstrainedFactor

    @classmethod
    def of(cls, solid: LayeredSolid, d: Discretisation, m: float) -> "Meridian":
        count = 2 if m == 0 else 3
        axis: tuple[int, ...] = (0,) if m == 0 else (0, 2) if m == 1 else (0, 1, 2)
        fixed = [field * d.N + d.axis for field in axis]
        still, cells = d.outer, None
        if m >= 2:
            beyond = np.hypot(*d.locations) > chosen.VANISHED ** (-1 / (m + 1))
            still, cells = np.flatnonzero(beyond), np.flatnonzero(~beyond[d.basis.element_dofs].all(axis=0))
        K = d.skeleton(solid.materials, m, cells)
        fixed += [field * d.N + still for field in range(count)]
        return cls(solid, d, m, K, ConstrainedFactor.of(K.matrix, np.concatenate([*fixed, K.inner.ravel()])))

    def solve(self, loaded: np.ndarray, loads: np.ndarray) -> np.ndarray:
        """Free unknowns (free, columns) under ``loads`` (3, nodes, columns) normal, radial and angular.

        loaded : unknowns of one field at the nodes
        """
        m, N = self.harmonic, self.discretisation.N
        normal, radial, angular = loads / (2 * np.pi if m == 0 else np.pi)
        # virtual work R U + T V with U = S - V
        load = [radial, normal] if m == 0 else [radial, angular - radial, normal]
        at = np.concatenate([field * N + loaded for field in range(len(load))])
        far = (self._far, _resultant(m, loads)) if m < 2 else None
        return self.factor.solve(at, np.concatenate(load), far)

    @cached_property
    def _far(self) -> np.ndarray:
        """Field vector (n,) due to a unit resultant far away, normal (m = 0) or tangential (1)."""
        d = self.discretisation
        u = np.zeros(self.skeleton.matrix.shape[0])
        far = self.solid.far_fields(int(self.harmonic), 1.0, d.locations[:, d.outer])
        u.reshape(len(far), d.N)[:, d.outer] = far
        return u

    def extended(self, u: np.ndarray, loads: np.ndarray) -> np.ndarray:
        """Field vectors (n, columns) of the free unknowns u under ``loads``."""
        m, n = self.harmonic, self.skeleton.matrix.shape[0]
        whole = np.outer(self._far, _resultant(m, loads)) if m < 2 else np.zeros((n, loads.shape[-1]))
        whole[self.factor.free] = u
        return self.skeleton.extended(whole)

    def deflection(self, u: np.ndarray, loaded: np.ndarray) -> np.ndarray:
        """u_z at the nodes, of which the free unknowns are u."""
        row = self.factor.rows(self.skeleton.matrix.shape[0] - self.discretisation.N + loaded)
        return np.where(row[:, None] < 0, 0.0, u[row])


def _normal(columns: np.ndarray) -> np.ndarray:
    """Loads (3, nodes, columns) of which the normal ones are ``columns``, the others zero."""
    return np.stack([columns, 0 * columns, 0 * columns])


def _resultant(m: float, loads: np.ndarray) -> np.ndarray:
    """Normal (m = 0) or tangential (1) resultant (columns,) of ``loads`` as in ``Meridian.solve``."""
    return np.asarray((loads[1] - loads[2] if m else loads[0]).sum(axis=0))
