"""Compliance of the surface of a layered solid to each angular harmonic of a pressure.

By hand: many pressures on one mesh are needed, and more harmonics than it is worth to factorise matrices for.

Finite elements see a pressure as its products with the shape functions phi_i on the surface,

    L_mi = int p cos(m theta) phi_i(r) dA,   u_z(r, theta) = sum_m cos(m theta) sum_ij phi_i(r) S_m,ij L_mj,

with one matrix S_m for each harmonic: the inverse of what is left of the stiffness matrix when all unknowns
but u_z below the pressure are eliminated. So  int p u_z' dA = sum_m L_m . S_m L'_m  holds for any two
pressures without a further solution.

The stiffness matrix is a polynomial in m, so S_m depends smoothly on m, which need not be an integer: beyond
``DIRECT`` m S_m is interpolated in log m between Chebyshev's points. A shorter wave is stiffer in proportion.

Friction along x, q = f p, has the products with the shape functions of u_r and u_theta

    R_m = f (L_(m-1) + L_(m+1))/2,      T_m = -f (L_(m-1) - L_(m+1))/2,      L_-1 = L_1.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp

from fem_reference import element_numbers as chosen
from fem_reference.contact.levels import ElementsNotConverged
from fem_reference.elasticity.axisymmetric import Discretisation, Skeleton
from fem_reference.elasticity.linear_system import ConstrainedFactor
from fem_reference.scaling import LayeredSolid


@dataclass(frozen=True, eq=False)
class HarmonicCompliance:
    """Response to the pressures that act on the unknowns ``loaded`` of one field on the surface of one mesh.

    solved : m of each of the ``meridians``.   compliances : S of each, (solutions, nodes, nodes)
    last, fold : harmonics 0, fold, 2 fold, .., last
    """

    solid: LayeredSolid
    discretisation: Discretisation
    loaded: np.ndarray
    solved: tuple[float, ...]
    meridians: tuple["Meridian", ...]
    compliances: np.ndarray
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
    def _shares(self) -> np.ndarray:
        """Weights of the solutions in each harmonic, (harmonics, solutions)."""
        return np.array([_weights(self.solved, int(m)) for m in self.harmonics])

    def matrices(self, last: int) -> np.ndarray:
        """S_m of the harmonics to ``last``, (harmonics, nodes, nodes)."""
        return np.tensordot(self._shares[: last // self.fold + 1], self.compliances, 1)

    def deflections(self, loads: np.ndarray) -> np.ndarray:
        """Amplitudes of u_z at the nodes (nodes, harmonics) under ``loads`` (harmonics, nodes)."""
        return sum(
            S @ (share[:, None] * loads).T for S, share in zip(self.compliances, self._shares.T, strict=True)
        )

    def on_arcs(self, theta: np.ndarray, forces: np.ndarray, last: int) -> np.ndarray:
        """Products of ``forces`` (columns, arcs, points) with the waves, (arcs, harmonics, columns).

        theta : angles (arcs, points).   last : the last harmonic
        """
        return self._waves(theta, last) @ forces.transpose(1, 2, 0)

    def nodal_loads(self, r: np.ndarray, on_arcs: np.ndarray) -> np.ndarray:
        """L (harmonics, nodes, columns) of forces ``on_arcs`` of radii r (arcs,)."""
        L = self._shapes(r).T @ on_arcs.reshape(r.size, -1)
        return np.asarray(L.reshape(-1, *on_arcs.shape[1:]).swapaxes(0, 1))

    def deflection(self, at_nodes: np.ndarray, r: np.ndarray, theta: np.ndarray) -> np.ndarray:
        """u_z on arcs of radius r (arcs,) at theta (arcs, points), of its amplitudes (nodes, harmonics)."""
        return np.asarray(((self._shapes(r) @ at_nodes)[:, None] @ self._waves(theta, self.last))[:, 0])

    def displacements(self, loads: np.ndarray, friction: float = 0.0) -> dict[int, np.ndarray]:
        """Field vector of every harmonic under a pressure and ``friction`` times it along x.

        loads : of the pressure, (harmonics, nodes)
        """
        L = np.zeros((self.last + 3, self.nodes.size))
        L[self.harmonics] = loads
        acting: dict[int, np.ndarray] = {}
        for m in range(self.last + 2):
            below, above = friction / 2 * L[abs(m - 1)], friction / 2 * L[m + 1]
            tractions = np.array([L[m], below + above, above - below])
            if tractions.any():
                acting[m] = tractions
        known, d = dict(zip(self.solved, self.meridians, strict=True)), self.discretisation
        found: dict[int, np.ndarray] = {}
        for m in (m for m in acting if m < chosen.DIRECT):
            one = known.get(m) or Meridian.of(self.solid, d, m, self.loaded)
            found[m] = one.solve(acting[m][..., None])[:, 0]
        high = [m for m in acting if m >= chosen.DIRECT]
        if not high:
            return found
        total = np.zeros((len(high), 3 * d.N))
        fewer, sums = _sums(np.array([acting[m] for m in high]))
        shares = np.array([_weights(self.solved, m) for m in high])
        for one, share in zip(self.meridians, shares.T, strict=True):
            if share.any():
                u, mixed = one.solve(fewer), share[:, None] * sums
                rows = np.flatnonzero(u.any(axis=1))
                for begin in range(0, rows.size, chosen.TRIANGLES_AT_ONCE):
                    some = rows[begin : begin + chosen.TRIANGLES_AT_ONCE]
                    total[:, some] += mixed @ u[some].T
        return found | dict(zip(high, total, strict=True))

    def _waves(self, theta: np.ndarray, last: int) -> np.ndarray:
        """cos(m theta) of the harmonics to ``last``, (arcs, harmonics, points)."""
        turn = np.exp(1j * self.fold * theta)
        waves = np.empty((len(turn), last // self.fold + 1, theta.shape[1]))
        power = np.ones_like(turn)
        for k in range(waves.shape[1]):
            waves[:, k] = power.real
            power *= turn
        return waves

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

    Of harmonics 0, fold, .. to ``last``. Raises ElementsNotConverged where these take too much memory.
    """
    wanted = range(0, last + 1, fold)
    solved = (*(m for m in wanted if m < chosen.DIRECT), *_high(last + 1, density))
    if d.N * len(solved) > chosen.MOST_KEPT:
        raise ElementsNotConverged(
            f"films so thin below a contact so long need {d.N} nodes in {len(solved)} harmonics, together "
            f"beyond {chosen.MOST_KEPT:g}; give thicker films, or leave this contact to the patches alone"
        )
    first = np.searchsorted(d.contact_vertices, inner, side="right") - 1
    loaded = d.contact[d.order * first :]
    meridians = tuple(Meridian.of(solid, d, m, loaded) for m in solved)
    compliances = np.array([one.compliance for one in meridians])
    return HarmonicCompliance(solid, d, loaded, solved, meridians, compliances, last, fold)


def _high(last: int, density: float) -> list[float]:
    """m of the solutions from which those of ``DIRECT`` to ``last`` follow: all, or Chebyshev's points in
    log m."""
    low, high = np.log(chosen.DIRECT), np.log(max(last, chosen.DIRECT))
    count = int(np.ceil(density * (high - low))) + 1
    if last < chosen.DIRECT + max(count, 2):
        return list(range(chosen.DIRECT, last + 1))
    inner = (1 - np.cos(np.pi * np.arange(1, count - 1) / (count - 1))) / 2
    return [chosen.DIRECT, *np.exp(low + (high - low) * inner).tolist(), last]


def _weights(solved: tuple[float, ...], m: int) -> np.ndarray:
    """Weights of the solutions in that of m: itself, or Lagrange's of m times them."""
    if m in solved:
        return np.array([float(one == m) for one in solved])
    first = sum(one < chosen.DIRECT for one in solved)
    x = np.log(solved[first:])
    away = np.log(m) - x
    lagrange = [np.prod(np.delete(away, k)) / np.prod(np.delete(x[k] - x, k)) for k in range(x.size)]
    return np.concatenate([np.zeros(first), np.array(lagrange) * np.array(solved[first:]) / m])


def _sums(loads: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Loads (3, nodes, columns) of which ``loads`` (harmonics, 3, nodes) are sums, and their shares."""
    flat = loads.reshape(len(loads), -1)
    used = np.flatnonzero(flat.any(axis=0))
    U, size, V = np.linalg.svd(flat[:, used], full_matrices=False)
    rank = int(np.count_nonzero(size > size.max(initial=0.0) * max(flat.shape) * np.finfo(float).eps))
    fewer = np.zeros((flat.shape[1], rank))
    fewer[used] = V[:rank].T
    return fewer.reshape(*loads.shape[1:], rank), U[:, :rank] * size[:rank]


@dataclass(frozen=True, eq=False)
class Meridian:
    """The meridian problem of one m, for loads on the unknowns ``loaded`` of one field.

    order : the free unknowns, in an order that fills a factor little.   normal : u_z of ``loaded`` among them
    Factorised for its compliance, and anew for fields: the factors of all m together take gigabytes.
    """

    solid: LayeredSolid
    discretisation: Discretisation
    harmonic: float
    loaded: np.ndarray
    skeleton: Skeleton
    order: np.ndarray
    normal: np.ndarray

    @classmethod
    def of(cls, solid: LayeredSolid, d: Discretisation, m: float, loaded: np.ndarray) -> "Meridian":
        count = 2 if m == 0 else 3
        axis: tuple[int, ...] = (0,) if m == 0 else (0, 2) if m == 1 else (0, 1, 2)
        cells = _reached(d, m)
        still = np.append(d.outer, np.unique(d.basis.element_dofs[:, ~cells]))
        K = d.skeleton(solid.materials, m, np.flatnonzero(cells))
        fixed = [field * d.N + d.axis for field in axis] + [field * d.N + still for field in range(count)]
        order = (d.elimination[:, None] + d.N * np.arange(count)).ravel()
        normal = (count - 1) * d.N + loaded
        given = np.concatenate(fixed)
        return cls(solid, d, m, loaded, K, *(of[~np.isin(of, given)] for of in (order, normal)))

    def solve(self, loads: np.ndarray) -> np.ndarray:
        """Field vectors (n, columns) under ``loads`` (3, nodes, columns) normal, radial and angular."""
        m, N = self.harmonic, self.discretisation.N
        normal, radial, angular = loads / (np.pi if m else 2 * np.pi)
        # virtual work R U + T V with U = S - V
        load = [radial, normal] if m == 0 else [radial, angular - radial, normal]
        at = np.concatenate([field * N + self.loaded for field in range(len(load))])
        resultant = (loads[1] - loads[2] if m else loads[0]).sum(axis=0)
        far = (self._far, resultant) if m < 2 else None
        factor = ConstrainedFactor.of(self.skeleton.matrix, self.order, self.order[:0])
        whole = np.outer(*far) if far else np.zeros((len(load) * N, loads.shape[-1]))
        whole[factor.free] = factor.solve(at, np.concatenate(load), far)
        return self.skeleton.extended(whole)

    @property
    def compliance(self) -> np.ndarray:
        """u_z at the nodes by unit normal loads on each, (nodes, nodes)."""
        factor = ConstrainedFactor.of(self.skeleton.matrix, self.order, self.normal)
        row = factor.rows(self.skeleton.matrix.shape[0] - self.discretisation.N + self.loaded)
        S = np.zeros((row.size, row.size))
        free = np.flatnonzero(row >= 0)
        S[np.ix_(free, free)] = factor.compliance / (np.pi if self.harmonic else 2 * np.pi)
        if self.harmonic == 0:  # moved by what is given far away, the same for every load
            no_load = self.loaded[:0], np.zeros((0, 1))
            S[free] += factor.solve(*no_load, (self._far, np.ones(1)))[row[free]]
        return S

    @cached_property
    def _far(self) -> np.ndarray:
        """Field vector (n,) due to a unit resultant far away, normal (m = 0) or tangential (1)."""
        d = self.discretisation
        u = np.zeros(self.skeleton.matrix.shape[0])
        far = self.solid.far_fields(int(self.harmonic), 1.0, d.locations[:, d.outer])
        u.reshape(len(far), d.N)[:, d.outer] = far
        return u


def _reached(d: Discretisation, m: float) -> np.ndarray:
    """Whether the harmonic m of a load on r <= 1 counts in a triangle, (triangles,), or is taken as zero.

    Beyond the load one of m >= 2 falls as the distance to the power -(m + 1). Below, at an angle phi from the
    axis, it is tan(phi/2)^m, about exp(-m z/r), and its stresses the power -2 of r more.
    """
    r, z = d.locations
    distance, numbers = np.hypot(r, z), d.basis.element_dofs
    slope = r / np.maximum(distance + z, np.finfo(float).tiny)
    near = (distance < chosen.VANISHED ** (-1 / (m + 1))) & (slope ** max(m - 2, 0) > chosen.VANISHED) | (
        m < 2
    )
    beside = np.zeros(d.N, dtype=bool)
    beside[numbers[:, near[numbers].any(axis=0)]] = True  # and in those next to it, lest one row be too stiff
    return np.asarray(beside[numbers].any(axis=0))
