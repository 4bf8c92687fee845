"""Frictionless contact of a rigid paraboloid with one meridian mesh whose vertex sits at the contact edge.

Lengths in a unit L of the caller, moduli in a unit E_0, sphere radius 1 (so displacements are in L^2/R, pressure
in E_0 L/R, load in E_0 L^3/R). For a given contact radius a the contact condition is linear,

    K u - B^T p = 0,     B u_z = int q (delta - r^2/2) r dr  for all q,     u = W u_far on the outer boundary,

a saddle system for displacement u and multiplier p with the approach delta and the load W as parameters. They follow
from p(a) = 0 and from int p = W, so one factorisation with three right-hand sides (flat punch, paraboloid, far
field) gives the whole solution, and a root-find on a gives the load asked for.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg as sla

from .axisymmetric import Discretisation

__all__ = ["Multiplier", "Touch", "touch"]


@dataclass(frozen=True, eq=False)
class Multiplier:
    """Continuous piecewise polynomial of r on the surface edges from the axis to the contact edge.

    nodes  : (number,) radii of the values, increasing, vertices included
    values : (number,) the polynomial's values there
    degree : polynomial degree between vertices
    """

    nodes: np.ndarray
    values: np.ndarray
    degree: int

    @cached_property
    def vertices(self) -> np.ndarray:
        return self.nodes[:: self.degree]

    def __call__(self, r: np.ndarray) -> np.ndarray:
        """Value at the radii ``r``, zero outside; any shape."""
        r = np.asarray(r, dtype=float)
        a = self.vertices[-1]
        inside = r <= a
        cell = np.clip(np.searchsorted(self.vertices, r, side="right") - 1, 0, self.vertices.size - 2)
        left, right = self.vertices[cell], self.vertices[cell + 1]
        t = (np.clip(r, 0, a) - left) / (right - left)
        knots = np.arange(self.degree + 1) / self.degree
        total = np.zeros(r.shape)
        for i, knot in enumerate(knots):
            others = np.delete(knots, i)
            shape = np.prod([(t - other) / (knot - other) for other in others], axis=0)
            total += shape * self.values[cell * self.degree + i]
        return np.where(inside, total, 0.0)


@dataclass(frozen=True, eq=False)
class Touch:
    """Solution of the contact at one contact radius, in the units of the module.

    fields     : (2 N,) radial displacement, then axial displacement
    pressure   : contact pressure of r
    approach, load, contact_radius : the scalars that belong together
    stiffness  : d load / d approach at fixed contact radius
    residuals  : relative errors of the saddle system, (equilibrium, gap)
    """

    fields: np.ndarray
    pressure: Multiplier
    approach: float
    load: float
    contact_radius: float
    stiffness: float
    residuals: tuple[float, float]


def touch(
    discretisation: Discretisation,
    *,
    materials: tuple[tuple[float, float], ...],
    far_displacement: Callable[[np.ndarray, np.ndarray], np.ndarray],
    multiplier_order: int,
) -> Touch:
    """Solve the contact whose edge is the mesh's contact radius.

    materials : (E, nu) per layer, E in units of E_0
    far_displacement : (r, z) -> (2, n), displacement of the outer boundary per unit load
    """
    d, N = discretisation, discretisation.N
    a = d.mesh.contact_radius
    edges = d.facets(lambda x: (x[1] == 0) & (x[0] < a))
    B, moments, nodes, numbers = _coupling(d, edges, multiplier_order)
    K = d.stiffness(materials, 0)

    fixed = np.concatenate([d.axis, d.outer, N + d.outer])
    free = np.setdiff1d(np.arange(2 * N), fixed)
    u_far = np.zeros(2 * N)
    u_far[d.outer], u_far[N + d.outer] = far_displacement(*d.locations[:, d.outer])
    u_far[d.axis] = 0.0

    coupling = sp.hstack([sp.csr_matrix((B.shape[0], N)), B], format="csr")
    Kf = K[free]
    saddle = sp.bmat([[Kf[:, free], -coupling[:, free].T], [-coupling[:, free], None]], format="csc")
    rhs = np.zeros((saddle.shape[0], 3))
    rhs[free.size :, 0] = -moments[0]
    rhs[free.size :, 1] = moments[1] / 2
    rhs[: free.size, 2] = -(Kf @ u_far)
    rhs[free.size :, 2] = coupling @ u_far
    lu = sla.splu(saddle, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=1e-3, options={"SymmetricMode": True})
    x = lu.solve(rhs)
    x += lu.solve(rhs - saddle @ x)

    p = x[free.size :]
    loads = 2 * np.pi * (moments[0] @ p)
    edge = p[-1]
    # p(a) = 0 and int p = W for (delta, W)
    system = np.array([[edge[0], edge[2]], [loads[0], loads[2] - 1.0]])
    delta, W = np.linalg.solve(system, -np.array([edge[1], loads[1]]))
    combine = np.array([delta, 1.0, W])
    residual = rhs @ combine - saddle @ (x @ combine)
    u = W * u_far
    u[free] += x[: free.size] @ combine
    pressure = Multiplier(nodes, p @ combine, multiplier_order)
    scale = (np.abs(moments[0]) @ np.abs(pressure.values), np.max(np.abs(moments[0])) * delta)
    return Touch(
        fields=u,
        pressure=pressure,
        approach=float(delta),
        load=float(W),
        contact_radius=a,
        stiffness=float(loads[0] / (1 - loads[2])),
        residuals=(
            float(np.abs(residual[: free.size]).max() / scale[0]),
            float(np.abs(residual[free.size :]).max() / scale[1]),
        ),
    )


def _coupling(
    d: Discretisation, edges: np.ndarray, order: int
) -> tuple[sp.csr_matrix, tuple[np.ndarray, np.ndarray], np.ndarray, np.ndarray]:
    """B[q, i] = int q phi_i r dr, the moments int q r dr and int q r^3 dr, the radii of q, its unknowns.

    The multiplier's unknowns are put in the order of increasing r.
    """
    trial = d.surface_basis(edges, d.order)
    test = d.surface_basis(edges, order)
    numbers = np.asarray(test.get_dofs(edges).all())
    numbers = numbers[np.argsort(test.doflocs[0, numbers])]
    position = np.full(test.N, -1)
    position[numbers] = np.arange(numbers.size)

    r = trial.global_coordinates().value[0]
    weight = r * trial.dx
    B = sp.csr_matrix((numbers.size, d.N))
    zeroth, second = np.zeros((2, numbers.size))
    for m, q in enumerate(test.basis):
        row = position[test.element_dofs[m]]
        for i, phi in enumerate(trial.basis):
            value = np.sum(q[0].value * phi[0].value * weight, axis=-1)
            keep = row >= 0
            B = B + sp.csr_matrix((value[keep], (row[keep], trial.element_dofs[i][keep])), shape=B.shape)
        np.add.at(zeroth, row[row >= 0], np.sum(q[0].value * weight, axis=-1)[row >= 0])
        np.add.at(second, row[row >= 0], np.sum(q[0].value * weight * r**2, axis=-1)[row >= 0])
    return B, (zeroth, second), np.asarray(test.doflocs[0, numbers]), numbers
