"""Frictionless contact of a rigid sphere with a layered half-space, at finite or at small strain.

Total Lagrangian finite elements: the nodal forces f = int P : grad N dV of the displacement u vanish but on
the contact, the nodes with X <= A on the surface. Each of these lies on the sphere, at depth delta - G(r):

    G(r) = R - sqrt(R^2 - r^2),      f_r = G'(r) f_z      at finite strain, r = X + u_r,

while at small strain r = X, f_r = 0 and P is Hooke's. The pressure vanishes at the edge, f_z = 0 there, which
fixes delta; 2 pi sum f_z = W fixes A. Newton's method finds u, delta and A at once. With A the mesh moves, so
that the edge stays at the end of an element and all results are smooth functions of the load: what the mesh
misses changes a result at finite and at small strain alike. On the outer boundary u is that of a point force
W on the substrate, Johnson, Contact Mechanics (1985), eq. (3.18).
"""

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from scipy.sparse import coo_array, csc_array
from scipy.sparse.linalg import splu

from assumption_maps_made import neo_hooke
from assumption_maps_made.meridian_elements import Meridian, lagrange
from verification.problem.array_types import Array, Coatings
from verification.problem.gauss_legendre import gauss_legendre

TOLERANCE, ITERATIONS = 1e-9, 12
LEAST_STEP = 1 / 16  # of the curvature 1/R, which is raised in steps where Newton's method fails at once
TENSILE = 0.01  # of the peak pressure, by which a negative one is more than an error of the mesh
_SCALES = np.array([1, 0, 1, 0, 1])  # powers of 1/A of the components of the gradient


class State(NamedTuple):
    """A, delta and the displacements 2 node of u_r, 2 node + 1 of u_z."""

    A: float
    delta: float
    u: Array

    def moved(self, by: "State", share: float) -> "State":
        """With the ``share`` of a correction."""
        return State(self.A + share * by.A, self.delta + share * by.delta, self.u + share * by.u)


@dataclass(frozen=True)
class Deformed:
    """Results in the units of the mesh; stresses are Cauchy's.

    contact_radius : current, A + u_r at the edge.   peak_pressure : the largest, along the current normal.
    tension : sigma_rr of the surface at the edge.   shear : largest traction along the deformed first
    interface, which is sigma_rz at small strain; None without one.
    """

    contact_radius: float
    approach: float
    peak_pressure: float
    tension: float
    shear: float | None


class SphereContact:
    """Sphere of ``radius`` under ``load``; lengths and stresses in units of the caller.

    coatings, substrate : as ``CoatedContact``.   finite : finite strain.
    """

    def __init__(
        self,
        mesh: Meridian,
        radius: float,
        load: float,
        coatings: Coatings,
        substrate: tuple[float, float],
        finite: bool,
    ) -> None:
        self.mesh, self.radius, self.load, self.finite, self.substrate = mesh, radius, load, finite, substrate
        moduli = np.array([neo_hooke.lame(E, nu) for E, nu, *_ in (*coatings, substrate)])
        self.mu, self.lam = moduli[mesh.layer].T[..., None]
        self.surface_moduli = float(moduli[0, 0]), float(moduli[0, 1])
        lines, nodes = mesh.z.size, mesh.rho.size * mesh.z.size
        contact = lines * np.arange(mesh.degree * mesh.ends + 1)
        self.rho = mesh.rho[: contact.size]
        self.c_r, self.c_z = 2 * contact, 2 * contact + 1
        self.far = np.unique(np.append(np.arange(nodes - lines, nodes), np.arange(lines - 1, nodes, lines)))
        axis = 2 * np.arange(lines)
        self.free = np.setdiff1d(np.arange(2 * nodes), np.concatenate([axis, self._far_unknowns, self.c_z]))

    @property
    def _far_unknowns(self) -> Any:
        return np.asarray(np.stack([2 * self.far, 2 * self.far + 1], axis=1).ravel())

    def _gap(self, r: Array) -> tuple[Array, Array, Array]:
        """G, G', G'' of the sphere at ``r``; NaN beyond its radius."""
        with np.errstate(invalid="ignore"):
            root = np.sqrt(self.radius**2 - r**2)
        return r**2 / (self.radius + root), r / root, self.radius**2 / root**3

    def gradient(self, state: State) -> Array:
        """Displacement gradient at the Gauss points, (elements, points, 5)."""
        local = state.u[self.mesh.unknowns]
        H = np.matmul(self.mesh.B, local[:, None, :, None])[..., 0]
        return np.asarray(H * state.A**-_SCALES)

    def forces(self, state: State, layers: int | None = None) -> Array:
        """int P : grad N r dr dz of each displacement, of the first ``layers`` alone if given."""
        H, scales = self.gradient(state), state.A ** (2 - _SCALES)
        if self.finite:
            P = neo_hooke.first_piola(neo_hooke.IDENTITY + H, self.mu, self.lam)
        else:
            P = neo_hooke.hooke(H, self.mu, self.lam)
        P = P * (self.mesh.weights[..., None] * scales)
        if layers is not None:
            P[self.mesh.layer >= layers] = 0.0
        local = np.einsum("eqca,eqc->ea", self.mesh.B, P, optimize=True)
        return np.asarray(np.bincount(self.mesh.unknowns.ravel(), local.ravel(), state.u.size), dtype=float)

    def stiffness(self, state: State) -> csc_array:
        """d forces / d u."""
        F = neo_hooke.IDENTITY + self.finite * self.gradient(state)
        D = neo_hooke.tangent(F, self.mu, self.lam)
        D *= self.mesh.weights[..., None, None] * state.A ** (2 - np.add.outer(_SCALES, _SCALES))
        B = self.mesh.B.reshape(self.mesh.layer.size, -1, self.mesh.B.shape[-1])
        local = np.matmul(B.transpose(0, 2, 1), np.matmul(D, self.mesh.B).reshape(B.shape))
        index = self.mesh.unknowns
        rows, columns = np.broadcast_arrays(index[:, :, None], index[:, None, :])
        shape = (state.u.size, state.u.size)
        return coo_array((local.ravel(), (rows.ravel(), columns.ravel())), shape=shape).tocsc()

    def _far_displacement(self, A: float) -> Array:
        """That of the point force, u_r and u_z in turn."""
        (E, nu), lines = self.substrate, self.mesh.z.size
        r, z = A * self.mesh.rho[self.far // lines], self.mesh.z[self.far % lines]
        s = np.hypot(r, z)
        scale = self.load * (1 + nu) / (2 * np.pi * E * s)
        u_r = scale * (r * z / s**2 - (1 - 2 * nu) * r / (s + z))
        return np.stack([u_r, scale * (2 * (1 - nu) + z**2 / s**2)], axis=1).ravel()

    def _equations(self, state: State) -> Array:
        """Forces of the free displacements, that of the edge, excess of the load; zero in equilibrium."""
        f = self.forces(state)
        if self.finite:
            f[self.c_r] -= self._gap(state.A * self.rho + state.u[self.c_r])[1] * f[self.c_z]
        return np.append(f[self.free], [f[self.c_z[-1]], f[self.c_z].sum() - self.load / (2 * np.pi)])

    def _step(self, state: State) -> State:
        """Newton's correction of ``state``."""
        A, delta, u = state
        count, small = self.free.size, 1e-7 * A
        G, slope, curvature = self._gap(A * self.rho + self.finite * u[self.c_r])
        f, K = self.forces(state), self.stiffness(state)
        # corrections of the displacements that are held: to where they belong, with delta, with A
        held = np.zeros((u.size, 3))
        held[self.c_z] = np.stack([delta - G - u[self.c_z], np.ones_like(G), -slope * self.rho], axis=1)
        here = self._far_displacement(A)
        held[self._far_unknowns, 0] = here - u[self._far_unknowns]
        held[self._far_unknowns, 2] = (self._far_displacement(A + small) - here) / small
        # a contact node that moves along r moves on the sphere
        rank = np.arange(count)
        T = coo_array((np.ones(count), (self.free, rank)), shape=(u.size, count)).tocsc()
        bend = np.zeros(count)
        if self.finite:
            slides = np.searchsorted(self.free, self.c_r[1:])
            T = T + coo_array((-slope[1:], (self.c_z[1:], slides)), shape=T.shape).tocsc()
            bend[slides] = -curvature[1:] * f[self.c_z[1:]]
        KT, Kh = K @ T, K @ held
        reduced = (T.T @ KT + coo_array((bend, (rank, rank)), shape=(count, count))).tocsc()
        edge_then_load = np.zeros((2, u.size))
        edge_then_load[0, self.c_z[-1]] = edge_then_load[1, self.c_z] = 1.0
        now = self._equations(state)
        right = np.concatenate([T.T @ Kh, edge_then_load @ Kh])
        right[:, 0] += now
        right[:, 2] += (self._equations(state._replace(A=A + small)) - now) / small
        if not np.isfinite(right).all():
            raise ValueError("the contact reaches the widest circle of the sphere; lower the load")
        try:
            factor = splu(reduced, "MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
        except RuntimeError as error:
            raise ValueError(f"the deformed solid is not stable: {error}") from error
        inner = factor.solve(right[:count])
        last = right[count:] - edge_then_load @ (KT @ inner)
        size = np.append(1.0, np.linalg.solve(last[:, 1:], -last[:, 0]))
        return State(float(size[2]), float(size[1]), held @ size - T @ (inner @ size))

    def _newton(self, state: State) -> State:
        """Equilibrium next to ``state``. Raises ValueError where the iterations do not reach it."""
        for _ in range(ITERATIONS):
            by = self._step(state)
            share = min(1.0, 0.4 * state.A / abs(by.A))
            while not np.isfinite(self.forces(new := state.moved(by, share))).all():
                share /= 2
                if share < LEAST_STEP:
                    raise ValueError("an element of the deformed solid turns inside out")
            state = new
            if max(abs(by.A) / state.A, np.abs(by.u).max() / abs(state.delta)) < TOLERANCE:
                return state
        raise ValueError(f"no equilibrium after {ITERATIONS} iterations of Newton's method")

    def solve(self, start: State | None = None) -> State:
        """Equilibrium, from ``start`` if given: the contact at small strain.

        Curvature and load are raised in steps where needed, as the displacement at one contact radius is in
        proportion to both. Raises ValueError with what ended the last of them.
        """
        state = start or State(1.0, 0.0, np.zeros(2 * self.mesh.rho.size * self.mesh.z.size))
        radius, load, done, step = self.radius, self.load, 0.0, 1.0
        try:
            while done < 1:
                share = min(done + step, 1.0)
                self.radius, self.load = radius / share, load * share
                scale = share / (done or 1.0)
                try:
                    state = self._newton(State(state.A, scale * state.delta, scale * state.u))
                    done = share
                except ValueError as error:
                    step /= 2
                    if step < LEAST_STEP:
                        raise ValueError(f"beyond {done:.2f} of the load, {error}") from error
        finally:
            self.radius, self.load = radius, load
        return state

    def results(self, state: State) -> Deformed:
        """Quantities of ``state``. Raises ValueError where a contact without gaps needs tension."""
        edge = state.A + self.finite * state.u[self.c_r[-1]]
        pressure = self.pressure(state)
        if pressure.min() < -TENSILE * pressure.max():
            raise ValueError(f"the pressure falls to {pressure.min() / pressure.max():.3g} of its largest")
        x = np.linspace(-1, 1, 9)
        peak = _largest(self.mesh.of_elements(pressure) @ lagrange(self.mesh.nodes, x)[0].T)
        shear = None
        if self.mesh.layer.any():
            shear = _largest(np.abs(self.interface_shear(state, x)))
        return Deformed(float(edge), state.delta, peak, self.tension(state), shear)

    def pressure(self, state: State) -> Array:
        """At the nodes of the contact: int p N r dr = f_z over current radii."""
        r = state.A * self.rho + self.finite * state.u[self.c_r]
        return self.mesh.density(r, self.forces(state)[self.c_z])

    def _along(self, state: State, line: int, x: Array) -> tuple[Array, Array, Array]:
        """u_r,X, u_z,X and u_r/X on a line of nodes, at the points ``x`` of each element."""
        N, D = lagrange(self.mesh.nodes, x)
        nodes = np.arange(self.mesh.rho.size) * self.mesh.z.size + line
        X, u_r, u_z = (
            self.mesh.of_elements(part)
            for part in (state.A * self.mesh.rho, state.u[2 * nodes], state.u[2 * nodes + 1])
        )
        dX, at = X @ D.T, X @ N.T
        hoop = np.where(at > 1e-12, u_r @ N.T / np.where(at > 1e-12, at, 1.0), u_r @ D.T / dX)
        return u_r @ D.T / dX, u_z @ D.T / dX, hoop

    def interface_shear(self, state: State, x: Array) -> Array:
        """Traction along the deformed first interface, by the nodal forces of what lies above it."""
        line, mesh = self.mesh.interface, self.mesh
        f = self.forces(state, 1).reshape(mesh.rho.size, mesh.z.size, 2)[:, line]
        N = lagrange(mesh.nodes, x)[0]
        # the outermost nodes carry forces of the outer boundary as well
        t_r, t_z = (mesh.of_elements(mesh.density(state.A * mesh.rho, part))[:-1] @ N.T for part in f.T)
        if not self.finite:
            return np.asarray(t_r)
        by_r, by_z, hoop = (part[:-1] for part in self._along(state, line, x))
        return np.asarray((t_r * (1 + by_r) + t_z * by_z) / ((1 + by_r) ** 2 + by_z**2) / (1 + hoop))

    def tension(self, state: State) -> float:
        """sigma_rr at the edge, extrapolated from the free surface by 1, sqrt(d), d of the distance d.

        There the stretches along the surface give it, with that along the normal from sigma_nn = 0. The
        second to the fourth element are used, since the first has the error of the edge.
        """
        N, _ = lagrange(self.mesh.nodes, x := gauss_legendre(self.mesh.degree)[0])
        near = slice(self.mesh.ends + 1, self.mesh.ends + 4)
        by_r, by_z, hoop = (part[near].ravel() for part in self._along(state, 0, x))
        distance = (self.mesh.of_elements(self.mesh.rho)[near] @ N.T).ravel() - 1
        stress = neo_hooke.free_surface_stress(by_r, by_z, hoop, *self.surface_moduli, self.finite)
        powers = np.sqrt(distance)[:, None] ** np.arange(3)
        return float(np.linalg.lstsq(powers, stress, rcond=None)[0][0])


def _largest(values: Array) -> float:
    """Largest of a line's ``values`` (elements, points) by the parabola through it and its neighbours."""
    flat = np.append(values[:, :-1].ravel(), values[-1, -1])
    best = int(np.argmax(flat))
    if best in (0, flat.size - 1):
        return float(flat[best])
    left, middle, right = flat[best - 1 : best + 2]
    return float(middle + (right - left) ** 2 / (8 * (2 * middle - left - right)))
