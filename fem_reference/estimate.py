"""Uncertainty estimated from a coarser companion solution.

By hand: scikit-fem has no estimate of the error of stresses at a point.

The difference of two solutions crosses zero along lines where neither is exact, so it is not used point by
point: the estimate at a vertex is the largest difference in the rings of triangles around it, further rings
counting by the shares of ``REACH``, and between vertices it is linear. Triangles grow with the distance from
the contact edge and with depth, and so does the neighbourhood. For stresses all of the largest difference
counts: a thin coating, an interface, the axis keep the mesher from the ratio of sizes that it was asked for.
For pressure, displacements and scalars Roache's estimate (P. J. Roache, J. Fluids Eng. 116 (1994) 405-413,
eq. 9)

    U = SAFETY |difference| / (ratio^order - 1)

is used. The solutions are compared at the same r/a.

Both solutions miss the given load within its tolerance, by amounts that are known. Changes between meshes are
therefore taken at the given load: W ~ a^growth, d delta = dW / stiffness.

A contact radius in error by da displaces the whole field, which changes the values at fixed points next to
the edge by up to the square root of da. The change of the field under that displacement is part of the
estimate of pressures and stresses.

The relative error of the approach, due to the whole mesh, counts everywhere: in a thin coating, whose
triangles are small for its sake alone, the stress has it too.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from fem_reference.companion_points import REACH, ComparisonPoints, Pair, largest_around, samples
from fem_reference.contact.fixed_radius import FixedRadiusContact
from fem_reference.contact.levels import COMPANION
from fem_reference.elasticity.recovery import TRACTIONS, HarmonicField
from fem_reference.elasticity.state import ElasticState
from fem_reference.meshing.location import LocatedPoints, Uncached
from fem_reference.scaling import Units

# Roache's factor of safety for two meshes; `python tests/tools alarms` counts how often it is too small.
SAFETY = 3.0
# Likewise of the largest difference of a stress around a point: 2.4 was needed in one of 100 random problems.
OF_STRESS = 2.6
# Times ``SAFETY`` for a pressure at a point: 1.12 was needed in one of 100 random problems.
_OF_PRESSURE = 1.2
# Of an approach: 1.6 was needed in one of 40 random films of 0.001 to 0.02 times the contact radius.
_OF_APPROACH = 1.7
# Rounding and interpolation of a stress, over the peak pressure: deep in a stack 4e-8 was needed.
_RECOVERED = 1e-7
# Of a stiffness, where both meshes agree by chance: 1.1e-8 was needed in one of 200 random problems.
_OF_STIFFNESS = 2e-8
# Triangles above this size do not reach the order of the elements. The factor then grows with the size, that
# of pressures and stresses with its square: on the axis of a fast solution 2.6 times were needed.
_ASYMPTOTIC_SIZE = 0.18
# The displacement of the field is part of the estimate within this distance of the edge over the radius.
_STRIP = 0.3


@dataclass(frozen=True)
class Uncertainty:
    """Absolute numerical uncertainty in SI units; ``budget`` has rows (quantity, origin, value)."""

    contact_radius: float
    approach: float
    peak_pressure: float
    budget: tuple[tuple[str, str, float], ...]


@dataclass(frozen=True, eq=False)
class PressureEstimate:
    """Estimated error of the pressure as a function of the radius.

    stretch : contact radius of the companion over that of the final mesh; they are compared at the same r/a
    factor : multiplies the difference from the companion
    radius_error : uncertainty of the contact radius; the change of p when the edge shifts by it is added,
        which covers the ring between the two contact edges and the infinite slope of p beside it
    everywhere : added inside the contact, for errors independent of element size
    """

    pressure: Callable[[np.ndarray], np.ndarray]
    companion: Callable[[np.ndarray], np.ndarray]
    vertices: np.ndarray
    stretch: float
    factor: float
    radius_error: float
    everywhere: float

    @cached_property
    def _at_vertices(self) -> np.ndarray:
        r = samples(self.vertices)
        difference = self.pressure(r) - self.companion(self.stretch * r)
        return largest_around(self.factor * np.abs(difference))

    def __call__(self, r: np.ndarray) -> np.ndarray:
        p = self.pressure(r)
        shifted = [self.pressure(np.abs(r + shift)) - p for shift in (-self.radius_error, self.radius_error)]
        inside = np.where(r <= self.vertices[-1], self.everywhere, 0.0)
        between = np.interp(r, self.vertices, self._at_vertices, right=0.0)
        return between + np.max(np.abs(shifted), axis=0) + inside


@dataclass(frozen=True, eq=False)
class StressEstimate(Uncached):
    """Estimated error of the stress of one harmonic as a function of position.

    factor, moved : multiply the largest differences of stress and displacement from the companion
    radius_error : uncertainty of the contact radius
    relative : added in proportion to the stress, for errors of the load
    everywhere : added at every point, for the truncation of the half-space
    far : the same of displacements
    """

    field: HarmonicField
    companion: HarmonicField
    points: ComparisonPoints
    factor: float
    moved: float
    radius_error: float
    relative: float
    everywhere: float
    far: float

    def displacement(self, at: LocatedPoints) -> np.ndarray:
        """Estimate (3, n) of the displacement at points."""
        u, _ = self.field.amplitudes(at)
        return self._between(self._corners[6:], at) + self.far + self.relative * np.abs(u)

    def _error(self, points: Pair, layer: int | None = None) -> np.ndarray:
        """Estimate (6, n) at points of comparison before the largest around is taken, then of u; (9, n).

        layer : of points on a plane z = const, whose stresses follow from strains and tractions of the plane
        """
        (u, final), (other, companion) = (
            f(at) for f, at in zip((self.field, self.companion), points, strict=True)
        )
        difference = final - companion
        if layer is not None:
            # in-plane strains and tractions are two results, whose errors may cancel on one mesh
            nu = self.field.materials[layer][1]
            shared = nu / (1 - nu) * difference[2]
            difference[:2] = np.abs(difference[:2] - shared) + np.abs(shared)
        error = self.factor * np.abs(difference) + self.relative * np.abs(final)
        return np.concatenate([error, self.moved * np.abs(u - other)])

    @cached_property
    def _corners(self) -> np.ndarray:
        """Estimate at the corners of each triangle, (9, 3, triangles), one for each layer at an interface."""
        d = self.field.discretisation
        points = d.mesh.points.shape[1]
        vertices = d.triangulation.t + d.mesh.layer * points
        worst = self._error(self.points.triangles).reshape(9, -1, vertices.shape[1]).max(axis=1)
        estimate = np.zeros((9, (int(d.mesh.layer.max()) + 1) * points))
        for share in np.divide(REACH, (1.0, *REACH[:-1])):
            for corner in vertices:
                for component, row in zip(worst, estimate, strict=True):
                    np.maximum.at(row, corner, share * component)
            worst = estimate[:, vertices].max(axis=1)
        return estimate[:, vertices]

    @cached_property
    def _planes(self) -> dict[tuple[float, int], tuple[np.ndarray, np.ndarray]]:
        """Vertices and estimates on the surface and on both sides of each interface, by (depth, layer)."""
        found = {
            key: (vertices, largest_around(self._error(points, key[1])[:6]))
            for key, (vertices, points) in self.points.planes.items()
        }
        for upper, depth in enumerate(self.field.discretisation.mesh.depths):
            above, below = (found[float(depth), layer][1] for layer in (upper, upper + 1))
            # one value on both sides, in error by that of either side
            above[TRACTIONS] = below[TRACTIONS] = np.maximum(above[TRACTIONS], below[TRACTIONS])
        return found

    def __call__(self, at: LocatedPoints) -> np.ndarray:
        """Estimate (6, n)."""
        estimate = self._between(self._corners[:6], at)
        for (depth, side), (vertices, values) in self._planes.items():
            here = (at.z == depth) & (at.layer == side)
            estimate[:, here] = [np.interp(at.r_given[here], vertices, row) for row in values]
        return estimate + self._displaced(at) + self.everywhere

    def _between(self, corners: np.ndarray, at: LocatedPoints) -> np.ndarray:
        """Values (c, n) at points from those at the corners (c, 3, triangles), linear in each triangle."""
        cells, X = at.triangles_as_given()
        X = np.clip(X, 0, 1)
        shape = np.stack([np.clip(1 - X[0] - X[1], 0, 1), X[0], X[1]])
        return np.einsum("sct,ct->st", corners[:, :, cells], shape)

    def _displaced(self, at: LocatedPoints) -> np.ndarray:
        """Largest change (6, n) of the stress near the edge when the edge moves by ``radius_error``."""
        d = self.field.discretisation
        a = d.mesh.contact_radius
        change = np.zeros((6, at.r.size))
        near = np.flatnonzero(np.hypot(at.r - a, at.z) < _STRIP * a)
        if near.size and self.radius_error > 0:
            r, z, layer = at.r[near], at.z[near], at.layer[near]
            stress = self.field(d.locator.points(r, z, layer))[1]
            for shift in (-self.radius_error, self.radius_error):
                moved = self.field(d.locator.points(r + shift, z, layer))[1]
                change[:, near] = np.maximum(change[:, near], np.abs(moved - stress))
        return change


@dataclass(frozen=True, eq=False)
class Estimates:
    """Uncertainty of a solution: ``scalars`` in SI units, pressure and stresses in scaled units.

    pollution : estimated error of the stress anywhere, due to the whole mesh
    """

    scalars: Uncertainty
    pressure: PressureEstimate
    normal: StressEstimate
    tangential: StressEstimate | None
    companion: ElasticState
    pollution: float

    def with_friction(self, state: ElasticState, friction: float) -> "Estimates":
        """The estimates of ``state``, which slides with ``friction``; the companion is solved for it."""
        companion, estimate = self.companion.with_friction(friction), None
        if state.tangential is not None and companion.tangential is not None:
            far, everywhere, _ = state.truncation(1)
            estimate = replace(
                self.normal,
                field=state.tangential,
                companion=companion.tangential,
                everywhere=everywhere + abs(friction) * self.pollution,
                far=far,
            )
        return replace(self, companion=companion, tangential=estimate)


def contact_estimates(
    final: FixedRadiusContact,
    companion: FixedRadiusContact,
    states: tuple[ElasticState, ...],
    units: Units,
    size: float,
) -> tuple[tuple[Estimates, ...], float]:
    """Uncertainty of each of the ``states`` of the ``final`` frictionless contact, and of its stiffness.

    states : of the flat, then of an elastic ball.  size : of the final mesh
    """
    # contact radius and approach of the companion if it had exactly the load
    a = companion.radius_at(final.load)
    approach = companion.approach + (final.load - companion.load) / companion.stiffness
    edge, other_edge = final.edge_displacement, companion.edge_displacement
    # what the displaced edges leave of the difference of the radii is due to all other triangles
    changes = abs((final.contact_radius - a) + (edge - other_edge)), abs(final.approach - approach)
    # a force out of balance is a load that the solution does not carry: rounding, across a large contrast
    load_residual = final.residual
    pairs = zip(states, (None, companion.ball), strict=False)
    coarse = tuple(ElasticState.of_contact(state.solid, companion, body) for state, body in pairs)
    found = estimates(states, coarse, units, changes, load_residual, abs(edge), size)
    truncation = sum(state.truncation(0)[0] for state in states) / final.approach
    # both are compliances; the difference of one of them may be zero by chance
    change = max(abs(1 - companion.stiffness / final.stiffness), changes[1] / final.approach)
    _, functional, _ = _factors(final.discretisation.order, size)
    stiffness = (functional * change + load_residual + truncation + _OF_STIFFNESS) * final.stiffness
    return found, float(stiffness * units.load / units.displacement)


def estimates(
    states: tuple[ElasticState, ...],
    companions: tuple[ElasticState, ...],
    units: Units,
    changes: tuple[float, float],
    load_residual: float,
    edge: float,
    size: float,
) -> tuple[Estimates, ...]:
    """Uncertainty of each of the frictionless ``states`` of one contact.

    changes : of contact radius and approach from the mesh of the companion, at one load
    load_residual : relative error of the load
    edge : displacement of the contact edge by the size of the last triangle
    size : of the mesh
    """
    flat, d = states[0], states[0].discretisation
    a, (at, largest) = flat.mesh.contact_radius, flat.peak
    size_radius, size_approach = changes
    far_approach, far_stress, curvature = np.sum([state.truncation(0) for state in states], axis=0)
    # The sphere has curvature 1; at given load a ~ R^(1/3) and p0 ~ R^(-2/3), on the bare substrate. A given
    # pressure with its radius is exact.
    far_radius, far_pressure = np.array([a, largest]) * (curvature if flat.normal.root_at_edge else 0.0)
    central = sum(state.central_displacement for state in states)
    factor, functional, coarseness = _factors(d.order, size)
    balance = load_residual / 2 * a  # a ~ W^(1/n), n at least 2 on any layers
    # What the whole mesh misses of a contact's compliance shows in the approach, changes the pressure, and as
    # such a share of the stress everywhere. A given pressure is exact: the error of the displacement under it
    # passes to no stress.
    share = functional * size_approach / central if flat.normal.root_at_edge else 0.0
    pollution = share * largest
    # the radius takes part in the singularity at the edge and not in the higher order of functionals
    size_radius *= factor
    radius_error = size_radius + SAFETY * edge + far_radius + balance
    everywhere = far_pressure + load_residual / 3 * largest
    pressure = PressureEstimate(
        flat.pressure,
        companions[0].pressure,
        d.contact_vertices,
        stretch=companions[0].mesh.contact_radius / a,
        factor=_OF_PRESSURE * factor * coarseness,
        radius_error=radius_error,
        everywhere=everywhere,
    )
    size_peak = float(pressure(np.array([at]))[0]) - everywhere
    rows: tuple[tuple[str, str, float], ...] = (
        ("contact_radius", "element size", size_radius * units.length),
        ("contact_radius", "edge size", SAFETY * edge * units.length),
        ("contact_radius", "outer boundary", far_radius * units.length),
        ("contact_radius", "load balance", balance * units.length),
        ("approach", "element size", _OF_APPROACH * functional * size_approach * units.displacement),
        ("approach", "outer boundary", far_approach * units.displacement),
        ("approach", "load balance", load_residual * central * units.displacement),
        ("peak_pressure", "element size", size_peak * units.pressure),
        ("peak_pressure", "outer boundary", far_pressure * units.pressure),
        ("peak_pressure", "load balance", load_residual / 3 * largest * units.pressure),
    )
    budget = tuple((quantity, origin, float(value)) for quantity, origin, value in rows)
    total = {name: sum(value for quantity, _, value in budget if quantity == name) for name, _, _ in budget}
    scalars = Uncertainty(**total, budget=budget)
    found = []
    for state, companion in zip(states, companions, strict=True):
        normal = StressEstimate(
            state.normal,
            companion.normal,
            ComparisonPoints(state.discretisation, companion.discretisation),
            factor=OF_STRESS * coarseness**2,
            moved=SAFETY / (COMPANION ** (d.order + 1) - 1) * coarseness**2,
            radius_error=radius_error,
            relative=load_residual + radius_error / a + share,
            everywhere=float(far_stress + pollution + _RECOVERED * largest),
            far=float(far_approach),
        )
        found.append(Estimates(scalars, pressure, normal, None, companion, float(pollution)))
    return tuple(found)


def _factors(order: int, size: float) -> tuple[float, float, float]:
    """Uncertainty over the change from the companion, of pressure and functionals; factor of large triangles.

    Functionals, approach and stiffness, converge with up to twice the order (G. Strang and G. J. Fix, An
    Analysis of the Finite Element Method, 1973, section 3.4); all but two are relied on, which thin films
    need, of triangles too large for their order nothing beyond it.
    """
    coarseness = max(1.0, size / _ASYMPTOTIC_SIZE)
    twice = 2 * order - 2 if size <= _ASYMPTOTIC_SIZE else order
    factor, functional = (SAFETY / (COMPANION**n - 1) * coarseness for n in (order, twice))
    return factor, functional, coarseness
