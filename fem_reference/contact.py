"""Frictionless contact of a rigid paraboloid at a given contact radius.

The mesh has a vertex at the contact edge. Lengths in a unit L of the caller, moduli in a unit E_0, sphere
radius 1: displacements are then in L^2/R, pressure in E_0 L/R, load in E_0 L^3/R. For a given contact radius
a the contact condition is linear, a saddle system for the displacement u and the pressure multiplier p with
the approach delta and the load W as parameters:

    K u - B^T p = 0,     int q (u_z - delta + r^2/2) r dr = 0  for all q,     u = W u_far  on the outer
    boundary.

The multiplier has the order of u_z itself. Then the second line says u_z = delta - r^2/2 at every node, the
paraboloid being a polynomial, and the first gives p from the nodal reactions through the mass matrix of the
contact: the saddle system separates into one positive definite solve and one small one. (Dividing
reactions by nodal weights instead would fail on the axis, where the weight vanishes.) delta and W follow
from p(a) = 0 and int p = W, so one factorisation with three right-hand sides, flat punch, paraboloid and far
field, gives everything.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg as sla
from scipy.optimize import minimize_scalar

from .axisymmetric import Discretisation, constrained_solve
from .scaling import LayeredSolid

__all__ = ["FixedRadiusContact", "Multiplier", "complementarity", "peak", "solve_at_radius"]


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
class FixedRadiusContact:
    """Solution of the contact at one contact radius, in the units of the module.

    fields     : (2 N,) radial displacement, then axial displacement
    pressure   : contact pressure of r
    approach, load : of the paraboloid with this contact_radius
    stiffness  : d load / d approach at fixed contact radius
    residual   : largest out-of-balance nodal force over the load
    """

    discretisation: Discretisation
    fields: np.ndarray
    pressure: Multiplier
    approach: float
    load: float
    contact_radius: float
    stiffness: float
    residual: float


def solve_at_radius(solid: LayeredSolid, discretisation: Discretisation) -> FixedRadiusContact:
    """Solve the contact whose edge is the mesh's contact radius; E_0 is the modulus of the substrate."""
    d, N = discretisation, discretisation.N
    a = d.mesh.contact_radius
    edges = d.facets(lambda x: (x[1] == 0) & (x[0] < a))
    contact = d.unknowns_on(edges)
    contact = contact[np.argsort(d.locations[0, contact])]
    nodes = d.locations[0, contact]
    K = d.stiffness(solid.materials, 0)

    given = np.zeros((2 * N, 3))
    given[N + contact, 0] = 1.0
    given[N + contact, 1] = -(nodes**2) / 2
    given[d.outer, 2], given[N + d.outer, 2] = solid.far_displacement(*d.locations[:, d.outer])
    given[d.axis] = 0.0
    u = constrained_solve(K, given, np.concatenate([d.axis, d.outer, N + d.outer, N + contact]))

    reaction = (K @ u)[N + contact]
    mass = d.surface_mass(edges)[contact][:, contact]
    even = _even_at_the_axis(nodes, d.order)
    p = even @ sla.splu((even.T @ mass @ even).tocsc()).solve(even.T @ reaction)
    loads = 2 * np.pi * reaction.sum(axis=0)
    # p(a) = 0 and int p = W for (delta, W)
    system = np.array([[p[-1, 0], p[-1, 2]], [loads[0], loads[2] - 1.0]])
    delta, W = np.linalg.solve(system, -np.array([p[-1, 1], loads[1]]))
    combine = np.array([delta, 1.0, W])
    fields = u @ combine
    force = K @ fields
    force[np.concatenate([d.axis, d.outer, N + d.outer, N + contact])] = 0.0
    values = p @ combine
    values[-1] = 0.0
    return FixedRadiusContact(
        discretisation=d,
        fields=fields,
        pressure=Multiplier(nodes, values, d.order),
        approach=float(delta),
        load=float(W),
        contact_radius=a,
        stiffness=float(loads[0] / (1 - loads[2])),
        residual=float(2 * np.pi * np.abs(force).max() / abs(W)),
    )


def complementarity(contact: FixedRadiusContact) -> tuple[float, float]:
    """(deepest penetration outside over the approach, largest tension inside over the peak), both >= 0."""
    d = contact.discretisation
    r = d.locations[0, d.surface]
    gap = r**2 / 2 + contact.fields[d.N + d.surface] - contact.approach
    # in this order NaN is passed on: max(0.0, nan) would be 0
    penetration = max(-float(gap[r > contact.contact_radius].min()), 0.0)
    p = contact.pressure.values
    return penetration / contact.approach, max(-float(p.min()), 0.0) / float(p.max())


def peak(pressure: Callable[[np.ndarray], np.ndarray], vertices: np.ndarray) -> tuple[float, float]:
    """Radius and value of the largest pressure: the axis, or a ring where a stiff film bends like a plate."""
    r = np.unique(np.linspace(vertices[:-1], vertices[1:], 9))
    best = int(np.argmax(pressure(r)))
    if best == 0:
        return 0.0, float(pressure(r[:1])[0])
    found = minimize_scalar(
        lambda radius: -float(pressure(np.array([radius]))[0]),
        bounds=(r[best - 1], r[min(best + 1, r.size - 1)]),
        method="bounded",
        options={"xatol": 1e-6 * r[-1]},
    )
    return float(found.x), -float(found.fun)


def _even_at_the_axis(nodes: np.ndarray, order: int) -> sp.csr_matrix:
    """Interpolation from the multiplier's free values to all its nodes, p being even in r next to the axis.

    In the first cell only 1, r^2, r^4, ... are kept. Otherwise the weight r leaves the value on the axis
    nearly undetermined: its error was ten times the largest elsewhere in the contact.
    """
    kept = np.unique(np.linspace(0, order, order // 2 + 1).round().astype(int))
    s = nodes[: order + 1] / nodes[order]
    powers = 2 * np.arange(kept.size)
    first = s[:, None] ** powers @ np.linalg.inv(s[kept, None] ** powers)
    rest = nodes.size - s.size
    T = sp.lil_matrix((nodes.size, kept.size + rest))
    T[: s.size, : kept.size] = first
    T[np.arange(rest) + s.size, np.arange(rest) + kept.size] = 1.0
    return T.tocsr()
