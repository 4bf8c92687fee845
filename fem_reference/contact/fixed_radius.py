"""Frictionless contact of a paraboloid, rigid or elastic, at a given contact radius.

The mesh has a vertex at the contact edge. Lengths in a unit L of the caller, moduli in a unit E_0, sphere
radius 1: displacements are then in L^2/R, pressure in E_0 L/R, load in E_0 L^3/R. For a given contact radius
a the contact condition is linear, a saddle system for the displacement u and the pressure multiplier p with
the approach delta and the load W as parameters:

    K u - B^T p = 0,     int q (u_z - delta + r^2/2) r dr = 0  for all q,     u = W u_far  on the outer
    boundary.

The multiplier has the order of u_z itself. Then the second line says u_z = delta - r^2/2 at every node, the
paraboloid being a polynomial (of a sphere, its interpolant), and the first gives p from the nodal reactions
through the mass matrix of the contact: the saddle system separates into one positive definite solve and one
small one. (Dividing reactions by nodal weights instead would fail on the axis, where the weight vanishes.)
delta and W follow from p(a) = 0 and int p = W, so one factorisation with three right-hand sides, flat punch,
paraboloid and far field, gives everything. Of an elastic ball u_z is the sum of both bodies' (``loading``),
delta the approach of points far from the contact in both.

The same solution gives the growth of the contact. A load dW indents like a flat punch of radius a, with
dW = S d delta. Near the edge, d = a - r, the pressure is K d^(1/2), that of the punch k d^(-1/2) d delta; the
pressure of the contact of radius a + da is K (d + da)^(1/2), K/2 d^(-1/2) da more, hence

    d delta / da = K / 2k,     d log W / d log a = (a / W) S K / 2k.
"""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg as sla
from scipy.interpolate import PPoly

from fem_reference import element_numbers as chosen
from fem_reference.elasticity.axisymmetric import Discretisation
from fem_reference.elasticity.loading import Body, solve_fields, solve_pair
from fem_reference.elasticity.recovery import edge_distances
from fem_reference.meshing.mesh import MeridianMesh
from fem_reference.scaling import LayeredSolid


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

    @cached_property
    def _cells(self) -> PPoly:
        knots = np.arange(self.degree + 1)
        values = self.values[np.arange(self.vertices.size - 1) * self.degree + knots[:, None]]
        width = np.diff(self.vertices) / self.degree
        return PPoly(np.linalg.solve(np.vander(knots), values) / width ** knots[::-1, None], self.vertices)

    def __call__(self, r: np.ndarray) -> np.ndarray:
        """Value at the radii ``r``, zero outside; any shape."""
        r = np.asarray(r, dtype=float)
        return np.where(r <= self.vertices[-1], self._cells(r), 0.0)


@dataclass(frozen=True, eq=False)
class Ball:
    """An elastic ball in contact: its elements, its displacement with z into it."""

    discretisation: Discretisation
    fields: np.ndarray


@dataclass(frozen=True, eq=False)
class FixedRadiusContact:
    """Solution of the contact at one contact radius, in the units of the module.

    fields     : (2 N,) radial displacement, then axial displacement
    pressure   : contact pressure of r
    approach, load : of the paraboloid with this contact_radius
    stiffness  : d load / d approach at fixed contact radius
    growth     : d log load / d log contact_radius
    residual   : largest out-of-balance nodal force over the load
    ball       : None where it is rigid
    curvature  : of the gap, as in `undeformed_gap`
    """

    discretisation: Discretisation
    fields: np.ndarray
    pressure: Multiplier
    approach: float
    load: float
    contact_radius: float
    stiffness: float
    growth: float
    residual: float
    ball: Ball | None = None
    curvature: float = 0.0

    def radius_at(self, load: float) -> float:
        """Contact radius at a ``load`` near that of this contact; at most a factor of two away."""
        growth = min(max(self.growth, 0.5), 12.0)
        return self.contact_radius * float(np.clip((load / self.load) ** (1 / growth), 0.5, 2.0))

    def at_load(self, load: float) -> "FixedRadiusContact":
        """The contact at a ``load`` so near its own that it grows as Hertz's: u ~ a^2, at the same r/a.

        The difference of the loads counts as a force out of balance.
        """
        factor, p, ball = self.radius_at(load) / self.contact_radius, self.pressure, self.ball
        flat = replace(self.discretisation, mesh=self.discretisation.mesh.stretched(factor))
        if ball:
            moved = replace(ball.discretisation, mesh=ball.discretisation.mesh.stretched(factor))
            ball = Ball(moved, ball.fields * factor**2)
        return replace(
            self,
            discretisation=flat,
            fields=self.fields * factor**2,
            pressure=Multiplier(p.nodes * factor, p.values * load / self.load / factor**2, p.degree),
            approach=self.approach * factor**2,
            load=load,
            contact_radius=flat.mesh.contact_radius,
            residual=self.residual + abs(load / self.load - 1),
            ball=ball,
        )

    @property
    def edge_displacement(self) -> float:
        """Distance by which the last triangles displace the edge of the pressure, outwards.

        p ~ sqrt(a + displacement - r) is c [d^(1/2) + displacement/2 d^(-1/2)] at distances d = a - r beyond
        it.
        """
        singular, root = edge_coefficients(self.pressure, self.discretisation.mesh)
        return 2 * singular / root


def undeformed_gap(r: np.ndarray, curvature: float = 0.0) -> np.ndarray:
    """(1 - sqrt(1 - c^2 r^2)) / c^2, of a sphere with ``curvature`` c = L/R; of the paraboloid for c = 0.

    Beyond the sphere's equator it grows on as r^2.
    """
    return r**2 / (1 + np.sqrt(np.maximum(1 - (curvature * r) ** 2, 0.0)))


def solve_at_radius(
    solid: LayeredSolid, discretisation: Discretisation, ball: Body | None = None, curvature: float = 0.0
) -> FixedRadiusContact:
    """Solve the contact whose edge is the mesh's contact radius.

    ball : layers and elements of an elastic ball, with the nodes of the flat on the surface
    curvature : of the gap, as in `undeformed_gap`
    """
    d, contact = discretisation, discretisation.contact
    a = d.mesh.contact_radius
    nodes = d.locations[0, contact]
    # flat punch, paraboloid, far field
    shape = np.stack([np.ones_like(nodes), -undeformed_gap(nodes, curvature), np.zeros_like(nodes)], axis=1)
    far = np.array([0.0, 0.0, 1.0])
    if ball is None:
        u, solved = solve_fields(d, solid, 0, far, u_z=shape)
        reaction = solved.force[d.N + contact]
    else:
        u, of_ball, reaction, solved = solve_pair(((solid, d), ball), shape, far)

    mass = d.contact_mass()[contact][:, contact]
    even = _even_at_the_axis(nodes, d.order)
    p = even @ sla.splu((even.T @ mass @ even).tocsc()).solve(even.T @ reaction)
    loads = 2 * np.pi * reaction.sum(axis=0)
    # p(a) = 0 and int p = W for (delta, W)
    system = np.array([[p[-1, 0], p[-1, 2]], [loads[0], loads[2] - 1.0]])
    delta, W = np.linalg.solve(system, -np.array([p[-1, 1], loads[1]]))
    combine = np.array([delta, 1.0, W])
    values = p @ combine
    values[-1] = 0.0
    pressure = Multiplier(nodes, values, d.order)
    stiffness = loads[0] / (1 - loads[2])
    punch = Multiplier(nodes, p[:, 0] + stiffness * p[:, 2], d.order)
    (_, K), (k, _) = (edge_coefficients(one, d.mesh, chosen.FARTHER) for one in (pressure, punch))
    return FixedRadiusContact(
        discretisation=d,
        fields=u @ combine,
        pressure=pressure,
        approach=float(delta),
        load=float(W),
        contact_radius=a,
        stiffness=float(stiffness),
        growth=float(a / W * stiffness * K / (2 * k)),
        residual=float(2 * np.pi * np.abs(solved.residual @ combine).max() / abs(W)),
        ball=None if ball is None else Ball(ball[1], of_ball @ combine),
        curvature=curvature,
    )


def edge_coefficients(pressure: Multiplier, mesh: MeridianMesh, farther: float = 1.0) -> tuple[float, float]:
    """Coefficients of d^(-1/2) and d^(1/2) in the ``pressure`` at the distance d inside the contact edge.

    farther : as in `edge_distances`
    """
    distance = edge_distances(mesh, farther)
    unit = distance[0] * chosen.EDGE_SIZE * mesh.contact_radius
    terms = (distance / distance[0])[:, None] ** np.array([-0.5, 0.5, 1.5, 2.5])
    values = pressure(mesh.contact_radius - chosen.EDGE_SIZE * mesh.contact_radius * distance)
    c = np.linalg.lstsq(terms, values, rcond=None)[0]
    return float(c[0] * unit**0.5), float(c[1] / unit**0.5)


def complementarity(contact: FixedRadiusContact) -> tuple[float, float]:
    """(deepest penetration outside over the approach, largest tension inside over the peak), both >= 0."""
    d = contact.discretisation
    r = d.locations[0, d.surface]
    gap = undeformed_gap(r, contact.curvature) + contact.fields[d.N + d.surface] - contact.approach
    if contact.ball is not None:
        ball = contact.ball.discretisation
        gap += contact.ball.fields[ball.N + ball.surface]
    # in this order NaN is passed on: max(0.0, nan) would be 0
    penetration = max(-float(gap[r > contact.contact_radius].min()), 0.0)
    p = contact.pressure.values
    return penetration / contact.approach, max(-float(p.min()), 0.0) / float(p.max())


def _even_at_the_axis(nodes: np.ndarray, order: int) -> sp.csr_matrix:
    """Interpolation from the multiplier's free values to all its nodes, p being even in r next to the axis.

    In the first cell only 1, r^2, r^4, ... are kept. Otherwise the weight r leaves the value on the axis
    nearly undetermined: its error was ten times the largest elsewhere in the contact.
    """
    kept = np.unique(np.linspace(0, order, order // 2 + 1).round().astype(int))
    s = nodes[: order + 1] / nodes[order]
    powers = 2 * np.arange(kept.size)
    first = s[:, None] ** powers @ np.linalg.inv(s[kept, None] ** powers)
    return sp.block_diag([first, sp.eye(nodes.size - s.size)], format="csr")
