"""Uncertainty of a solution from three meshes of one family, all sizes in the ratio r.

By hand: scikit-fem has no estimate of the error of stresses at a point.

The changes |f1 - f2| and |f2 - f3|, from the finest mesh to the next and from that to the coarsest, each give
Roache's grid convergence index of the finest for an order p, and the larger counts:

    U = SAFETY max(|f1 - f2|, |f2 - f3| / r^p) / (r^p - 1)

(P. J. Roache, J. Fluids Eng. 116 (1994) 405-413, eq. 9, with his factor for an order that is not relied on).
A last change that is small by chance does not make U small. With elements of order k, p = k + 1 for
displacements, approach, stiffness, contact radius; p = k - 1, about the observed, for pressure and stress.
A change of a field crosses zero along lines where no mesh is exact. Its largest value around a point takes
its place: in `RINGS` rings of triangles; on planes in as many cells and within their depth; at the same r/a.

Other errors are added: of the load, whose known misses on coarser meshes are no changes (W ~ a^growth,
d delta = dW / stiffness); of the contact radius, which displaces the field and so changes values next to the
edge by up to its root; of the approach, in proportion in every field; of the far field; of rounding.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from fem_reference import element_numbers as chosen
from fem_reference.comparison_points import ComparisonPoints, largest_around, linear_between, samples
from fem_reference.contact.fixed_radius import FixedRadiusContact
from fem_reference.elasticity.recovery import TRACTIONS, HarmonicField
from fem_reference.elasticity.state import ElasticState
from fem_reference.element_answer import ElementUncertainty
from fem_reference.meshing.location import LocatedPoints, Uncached
from fem_reference.scaling import Scales


def from_changes(changes: np.ndarray, p: int) -> np.ndarray:
    """Uncertainty of the finest mesh by the magnitudes of the two ``changes``, (2, ...), finest first."""
    step = chosen.COARSER**p
    return np.asarray(chosen.SAFETY * np.maximum(changes[0], changes[1] / step) / (step - 1))


def of_scalar(values: Sequence[float], p: int) -> float:
    """Uncertainty of a number from its ``values`` on the three meshes, finest first."""
    return float(from_changes(np.abs(np.diff(values)), p))


@dataclass(frozen=True, eq=False)
class PressureEstimate:
    """Uncertainty of the pressure as a function of the radius.

    states : on the three meshes, finest first, compared at the same r/a
    radius_error : of the contact; the change of p when the edge shifts by it is added, for the infinite slope
    everywhere : added inside the contact
    """

    states: tuple[ElasticState, ...]
    radius_error: float
    everywhere: float

    @cached_property
    def _at_vertices(self) -> tuple[np.ndarray, np.ndarray]:
        """Radii of the surface vertices, and the uncertainty there by the size of the triangles."""
        d = self.states[0].discretisation
        share = samples(d.contact_vertices) / d.mesh.contact_radius
        change = np.diff([one.pressure(one.mesh.contact_radius * share) for one in self.states], axis=0)
        return d.contact_vertices, from_changes(largest_around(np.abs(change)), d.order - 1)

    def __call__(self, r: np.ndarray) -> np.ndarray:
        pressure, shifts = self.states[0].pressure, (-self.radius_error, self.radius_error)
        shifted = [pressure(np.abs(r + shift)) - pressure(r) for shift in shifts]
        inside = np.where(r <= self.states[0].mesh.contact_radius, self.everywhere, 0.0)
        return np.interp(r, *self._at_vertices, right=0.0) + np.max(np.abs(shifted), axis=0) + inside


@dataclass(frozen=True, eq=False)
class StressEstimate(Uncached):
    """Uncertainty of stress and displacement of one harmonic as a function of position.

    fields : on the three meshes, finest first.  relative : added in proportion, for errors of the load
    everywhere, far : added to every stress and displacement, for the truncation of the half-space
    """

    fields: tuple[HarmonicField, ...]
    points: ComparisonPoints
    radius_error: float
    relative: float
    everywhere: float
    far: float

    def displacement(self, at: LocatedPoints) -> np.ndarray:
        """Uncertainty (3, n) of the displacement at points."""
        u, _ = self.fields[0].amplitudes(at)
        return linear_between(self._corners[6:], at) + self.far + self.relative * np.abs(u)

    def _changes(self, points: Sequence[LocatedPoints], layer: int | None = None) -> np.ndarray:
        """Changes (2, 9, n) of stress and displacement between meshes at points of comparison.

        layer : of points on a plane z = const, whose stresses follow from strains and tractions of the plane
        """
        u, stress = zip(*(field(at) for field, at in zip(self.fields, points, strict=True)), strict=True)
        change = np.diff(stress, axis=0)
        if layer is not None:
            # in-plane strains and tractions are two results, whose errors may cancel on one mesh
            nu = self.fields[0].materials[layer][1]
            shared = nu / (1 - nu) * change[:, 2:3]
            change[:, :2] = np.abs(change[:, :2] - shared) + np.abs(shared)
        return np.abs(np.concatenate([change, np.diff(u, axis=0)], axis=1))

    @cached_property
    def _corners(self) -> np.ndarray:
        """Uncertainty at the corners of each triangle, (9, 3, triangles), at an interface one a layer."""
        largest = self.points.largest_at_corners(self._changes(self.points.triangles))
        k = self.fields[0].discretisation.order
        return np.concatenate([from_changes(largest[:, :6], k - 1), from_changes(largest[:, 6:], k + 1)])

    @cached_property
    def _planes(self) -> dict[tuple[float, int], tuple[np.ndarray, np.ndarray]]:
        """Vertices and uncertainties on the surface and both sides of each interface, by (depth, layer)."""
        d, found = self.fields[0].discretisation, {}
        for key, (vertices, points) in self.points.planes.items():
            largest = self.points.largest_on_plane(self._changes(points, key[1])[:, :6], key)
            found[key] = vertices, from_changes(largest, d.order - 1)
        for upper, depth in enumerate(d.mesh.depths):
            above, below = (found[float(depth), layer][1] for layer in (upper, upper + 1))
            # one value on both sides, in error by that of either side
            above[TRACTIONS] = below[TRACTIONS] = np.maximum(above[TRACTIONS], below[TRACTIONS])
        return found

    def __call__(self, at: LocatedPoints) -> np.ndarray:
        """Uncertainty (6, n) of the stress at points."""
        size = linear_between(self._corners[:6], at)
        for (depth, side), (vertices, values) in self._planes.items():
            here = (at.z == depth) & (at.layer == side)
            size[:, here] = [np.interp(at.r_given[here], vertices, row) for row in values]
        stress = self.fields[0](at)[1]
        return size + self.relative * np.abs(stress) + self._displaced(at, stress) + self.everywhere

    def _displaced(self, at: LocatedPoints, stress: np.ndarray) -> np.ndarray:
        """Largest change (6, n) of the ``stress`` near the edge when the edge moves by ``radius_error``."""
        d, change = self.fields[0].discretisation, np.zeros((6, at.r.size))
        a = d.mesh.contact_radius
        near = np.flatnonzero(np.hypot(at.r - a, at.z) < chosen.STRIP * a)
        for shift in (-self.radius_error, self.radius_error) if near.size else ():
            moved = d.locator.points(at.r[near] + shift, at.z[near], at.layer[near])
            change[:, near] = np.maximum(change[:, near], np.abs(self.fields[0](moved)[1] - stress[:, near]))
        return change


@dataclass(frozen=True, eq=False)
class Estimates:
    """Uncertainty of one body, ``scalars`` in SI units; its states on the two ``coarser`` meshes."""

    scalars: ElementUncertainty
    pressure: PressureEstimate
    normal: StressEstimate
    tangential: StressEstimate | None
    coarser: tuple[ElasticState, ...]

    def with_friction(self, state: ElasticState, friction: float) -> "Estimates":
        """The estimates of ``state``, which slides with ``friction``; the coarser ones are solved for it."""
        coarser = tuple(one.with_friction(friction) for one in self.coarser)
        fields = tuple(one.tangential for one in (state, *coarser) if one.tangential is not None)
        if not fields:
            return replace(self, coarser=coarser, tangential=None)
        far, everywhere, _ = state.truncation(1)
        sliding = replace(self.normal, fields=fields, everywhere=everywhere, far=far)
        return replace(self, coarser=coarser, tangential=sliding)


def contact_estimates(
    contacts: tuple[FixedRadiusContact, ...], states: tuple[ElasticState, ...], units: Scales
) -> tuple[tuple[Estimates, ...], float]:
    """Uncertainty of each frictionless state of a contact on the finest mesh, and of its stiffness.

    contacts : on the three meshes, finest first.  states : of the flat, then of an elastic ball
    """
    final, order = contacts[0], contacts[0].discretisation.order
    # as if each had exactly the load; what the last triangles displace the edge is a cause of its own
    values = (
        [one.radius_at(final.load) + one.edge_displacement for one in contacts],
        [one.approach + (final.load - one.load) / one.stiffness for one in contacts],
        [one.stiffness for one in contacts],
    )
    radius, approach, stiffness = (of_scalar(one, order + 1) for one in values)
    coarser = tuple(
        tuple(ElasticState.of_contact(state.solid, one, one.ball if k else None) for one in contacts[1:])
        for k, state in enumerate(states)
    )
    # a force out of balance is a load that the solution does not carry: rounding, across a large contrast;
    # what the far field leaves out is a compliance c, and d(1/S) = c
    left_out = sum(state.truncation(0)[0] for state in states) / final.load
    stiffness += (final.residual + left_out * final.stiffness) * final.stiffness
    edge = chosen.SAFETY * abs(final.edge_displacement)
    found = estimates(states, coarser, units, approach, radius, edge, final.residual)
    return found, float(stiffness * units.load / units.displacement)


def estimates(
    states: tuple[ElasticState, ...],
    coarser: tuple[tuple[ElasticState, ...], ...],
    units: Scales,
    approach: float,
    radius: float = 0.0,
    edge: float = 0.0,
    load: float = 0.0,
) -> tuple[Estimates, ...]:
    """Uncertainty of each of the frictionless ``states`` of one contact.

    coarser : each on two meshes.  approach, radius : errors by all triangles.  edge : by the last ones
    """
    flat, (at, largest) = states[0], states[0].peak
    a, central = flat.mesh.contact_radius, sum(state.central_displacement for state in states)
    far_approach, far_stress, curvature = np.sum([state.truncation(0) for state in states], axis=0)
    # What the whole mesh misses of a compliance changes the pressure. A given one with its radius is exact.
    share, bent = (approach / central, curvature) if flat.normal.root_at_edge else (0.0, 0.0)
    # The sphere has curvature 1; at given load a ~ R^(1/3) and p0 ~ R^(-2/3), on the bare substrate.
    far_radius, far_pressure = a * bent, largest * bent
    balance = load / 2 * a  # a ~ W^(1/n), n at least 2 on any layers
    radius_error = radius + edge + far_radius + balance
    everywhere = far_pressure + load / 3 * largest
    pressure = PressureEstimate((flat, *coarser[0]), radius_error, everywhere)
    size_peak = float(pressure(np.array([at]))[0]) - everywhere
    scale = {"contact_radius": units.length, "approach": units.displacement, "peak_pressure": units.pressure}
    causes = {
        "element size": (radius, approach, size_peak),
        "edge size": (edge,),
        "outer boundary": (far_radius, far_approach, far_pressure),
        "load balance": (balance, load * central, load / 3 * largest),
    }
    budget = tuple(
        (name, origin, float(errors[k] * unit))
        for k, (name, unit) in enumerate(scale.items())
        for origin, errors in causes.items()
        if k < len(errors)
    )
    total = {name: sum(value for quantity, _, value in budget if quantity == name) for name in scale}
    scalars = ElementUncertainty(**total, budget=budget)
    found = []
    for state, others in zip(states, coarser, strict=True):
        normal = StressEstimate(
            tuple(one.normal for one in (state, *others)),
            ComparisonPoints(tuple(one.discretisation for one in (state, *others))),
            radius_error=radius_error,
            relative=load + radius_error / a + share,
            everywhere=float(far_stress + chosen.ROUNDING * largest),
            far=float(far_approach),
        )
        found.append(Estimates(scalars, pressure, normal, None, others))
    return tuple(found)
