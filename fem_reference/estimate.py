"""Uncertainty estimated from a coarser companion solution.

The difference of two solutions crosses zero at points where neither is exact, so it is not used point by
point: the estimate at a vertex is the largest difference in the triangles around it, and between vertices it
is linear. The companion is coarser, hence the difference is about the error of the companion, which exceeds
the error of the solution; a factor of safety covers the places where it does not, multiplied by a
``coarse_mesh_factor`` on meshes too coarse for errors to fall at their asymptotic rate.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from .axisymmetric import Discretisation
from .contact import peak
from .levels import ContactLevels
from .location import LocatedPoints
from .mesh import EDGE_SIZE
from .recovery import HarmonicField
from .scaling import Units
from .state import ElasticState

__all__ = ["Estimates", "PressureEstimate", "StressEstimate", "Uncertainty", "contact_estimates", "estimates"]

# Roache's factor for an error estimated from two meshes only. He divides the difference by ratio^order - 1
# as well, which is left out: the order observed at a point is not dependable.
SAFETY = 3.0
# Beyond this size the factor of safety grows with it: over 18 coated contacts the error was 0.57 of the
# difference from the companion, times SAFETY, at "default", and 1.08 of it at "fast".
_ASYMPTOTIC_SIZE = 0.2
# The last triangle displaces the edge by this fraction of its size for every solid, as close to the edge all
# contacts are alike. Measured on Hertz: 0.008 to 0.011 for edge sizes from 1e-2 to 1e-7 of the radius.
_EDGE_FRACTION = 0.03

# corners, middles and centre of the reference triangle: the hoop strain is worst on the axis itself
_SAMPLES = np.array([[0, 1, 0, 1 / 2, 1 / 2, 0, 1 / 3], [0, 0, 1, 0, 1 / 2, 1 / 2, 1 / 3]])
# moved this far towards the centre in depth, so that none lies on a plane with a formula of its own
_INWARDS = 1e-7
_CELL_SAMPLES = 7

_Pair = tuple[LocatedPoints, LocatedPoints]  # on the final mesh, on that of the companion


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

    radius_error : uncertainty of the contact radius; the change of p when the edge shifts by it is added,
        which covers the ring between the two contact edges and the infinite slope of p beside it
    everywhere : added inside the contact, for errors independent of element size
    coarse_mesh_factor : multiplies the difference from the companion
    """

    pressure: Callable[[np.ndarray], np.ndarray]
    companion: Callable[[np.ndarray], np.ndarray]
    vertices: np.ndarray
    radius_error: float
    everywhere: float
    coarse_mesh_factor: float

    @cached_property
    def _at_vertices(self) -> np.ndarray:
        r = _samples(self.vertices)
        # the first cells are few and smooth: two solutions may agree by chance in one of them
        return _largest(self.pressure(r) - self.companion(r), self.vertices.size, reach=2)

    def __call__(self, r: np.ndarray) -> np.ndarray:
        p = self.pressure(r)
        shifted = [self.pressure(np.abs(r + shift)) - p for shift in (-self.radius_error, self.radius_error)]
        inside = np.where(r <= self.vertices[-1], self.everywhere, 0.0)
        between = self.coarse_mesh_factor * np.interp(r, self.vertices, self._at_vertices, right=0.0)
        return between + np.max(np.abs(shifted), axis=0) + inside


@dataclass(frozen=True, eq=False)
class _ComparisonPoints:
    """Points at which two solutions are compared, located on the meshes of both."""

    final: Discretisation
    companion: Discretisation

    def __getstate__(self) -> dict[str, object]:
        # pickled without the cached properties
        return {"final": self.final, "companion": self.companion}

    def _on_both(self, r: np.ndarray, z: np.ndarray, layer: np.ndarray) -> _Pair:
        return self.final.locator.points(r, z, layer), self.companion.locator.points(r, z, layer)

    @cached_property
    def triangles(self) -> _Pair:
        """``_SAMPLES`` of every triangle of the final mesh, shape (7 * triangles,)."""
        d = self.final
        s1, s2 = _SAMPLES
        shape = np.stack([1 - s1 - s2, s1, s2])
        corners = d.mesh.points[:, d.triangulation.t]
        r, z = np.einsum("cp,dct->dpt", shape, corners)
        z = z + _INWARDS * (corners[1].mean(axis=0) - z)
        layer = np.broadcast_to(d.mesh.layer, r.shape)
        reach = self.companion.mesh.points.max()
        return self._on_both(np.minimum(r, reach).ravel(), np.minimum(z, reach).ravel(), layer.ravel())

    @cached_property
    def planes(self) -> dict[tuple[float, int], tuple[np.ndarray, _Pair]]:
        """Vertices and points between them on the surface and both sides of interfaces, by (depth, layer)."""
        mesh = self.final.mesh
        reach = 0.9 * self.companion.mesh.far
        sides = [(0.0, 0)]
        for upper, depth in enumerate(mesh.depths):
            sides += [(float(depth), upper), (float(depth), upper + 1)]
        planes = {}
        for depth, layer in sides:
            vertices = np.sort(mesh.points[0, mesh.points[1] == depth])
            vertices = vertices[vertices < reach]
            r = _samples(vertices)
            points = self._on_both(r, np.full(r.shape, depth), np.full(r.shape, layer))
            planes[depth, layer] = vertices, points
        return planes


@dataclass(frozen=True, eq=False)
class StressEstimate:
    """Estimated error of the stress of one harmonic as a function of position.

    everywhere : added at every point, for errors independent of element size
    coarse_mesh_factor : multiplies the difference from the companion
    """

    field: HarmonicField
    companion: HarmonicField
    points: _ComparisonPoints
    everywhere: float
    coarse_mesh_factor: float

    def _difference(self, points: _Pair) -> np.ndarray:
        final, companion = points
        return np.abs(self.field(final)[1] - self.companion(companion)[1])

    @cached_property
    def _corners(self) -> np.ndarray:
        """Estimate at the corners of each triangle, (6, 3, triangles); a vertex has one value per layer."""
        d = self.field.discretisation
        t = d.triangulation.t
        difference = self._difference(self.points.triangles)
        worst = SAFETY * difference.reshape(6, -1, t.shape[1]).max(axis=1)
        vertices = t + d.mesh.layer * d.mesh.points.shape[1]
        estimate = np.zeros((6, int(vertices.max()) + 1))
        for corner in vertices:
            for component in range(6):
                np.maximum.at(estimate[component], corner, worst[component])
        return estimate[:, vertices]

    @cached_property
    def _planes(self) -> dict[tuple[float, int], tuple[np.ndarray, np.ndarray]]:
        """Vertices and estimates on the surface and on both sides of each interface, by (depth, layer)."""
        return {
            key: (vertices, _largest(self._difference(points), vertices.size, reach=1))
            for key, (vertices, points) in self.points.planes.items()
        }

    def __call__(self, at: LocatedPoints) -> np.ndarray:
        """Estimate (6, n)."""
        cells, X = at.triangles_as_given()
        X = np.clip(X, 0, 1)
        shape = np.stack([np.clip(1 - X[0] - X[1], 0, 1), X[0], X[1]])
        estimate = np.einsum("sct,ct->st", self._corners[:, :, cells], shape)
        for (depth, side), (vertices, values) in self._planes.items():
            here = (at.z == depth) & (at.layer == side)
            estimate[:, here] = [np.interp(at.r_given[here], vertices, row) for row in values]
        return self.coarse_mesh_factor * estimate + self.everywhere


@dataclass(frozen=True, eq=False)
class Estimates:
    """Uncertainty of a solution: ``scalars`` in SI units, pressure and stresses in scaled units."""

    scalars: Uncertainty
    pressure: PressureEstimate
    normal: StressEstimate
    tangential: StressEstimate | None
    companion: ElasticState

    def with_friction(self, state: ElasticState, friction: float) -> "Estimates":
        """The estimates of ``state``, which slides with ``friction``; the companion is solved for it."""
        companion, estimate = self.companion.with_friction(friction), None
        if state.tangential is not None and companion.tangential is not None:
            points, factor = self.normal.points, self.normal.coarse_mesh_factor
            estimate = StressEstimate(state.tangential, companion.tangential, points, 0.0, factor)
        return replace(self, companion=companion, tangential=estimate)


def contact_estimates(
    levels: ContactLevels, state: ElasticState, units: Units, load: float, size: float
) -> tuple[Estimates, float]:
    """Uncertainty of the frictionless contact ``state`` of the final level, and that of its stiffness.

    size : of the final mesh.  load : in scaled ``units``, as ``levels``.
    """
    final, companion, near, factor = levels.final, levels.companion, levels.near, _coarse_mesh_factor(size)
    assert companion is not None
    assert near is not None
    # changes at fixed load: that of the load is converted with the contact's own stiffness
    missing = companion.load - near.load
    boundary_changes = (
        abs(missing / load / levels.slope * companion.contact_radius),
        abs(near.approach - companion.approach + missing / companion.stiffness),
        abs(near.pressure.values[0] - companion.pressure.values[0]),
    )
    load_residual = abs(final.load / load - 1)
    stiffness = (
        SAFETY * factor * abs(final.stiffness - companion.stiffness)
        + abs(near.stiffness - companion.stiffness)
        + load_residual * final.stiffness
    )
    coarser = ElasticState.of_contact(state.solid, companion)
    found = estimates(state, coarser, units, boundary_changes, load_residual, size)
    return found, float(stiffness * units.load / units.displacement)


def estimates(
    state: ElasticState,
    companion: ElasticState,
    units: Units,
    boundary_changes: tuple[float, float, float],
    load_residual: float,
    size: float,
) -> Estimates:
    """Uncertainty of a frictionless ``state`` on a mesh of ``size``.

    boundary_changes : of contact radius, approach and peak pressure with a nearer outer boundary
    load_residual : relative error of the load
    """
    d, factor = state.discretisation, _coarse_mesh_factor(size)
    at, largest = peak(state.pressure, d.contact_vertices)
    a = d.mesh.contact_radius
    far_radius, far_approach, far_peak = boundary_changes
    size_radius = abs(a - companion.mesh.contact_radius)
    size_approach = abs(state.central_displacement - companion.central_displacement)
    everywhere = far_peak + load_residual / 3 * largest
    pressure = PressureEstimate(
        state.pressure, companion.pressure, d.contact_vertices, size_radius, everywhere, factor
    )
    size_peak = float(pressure(np.array([at]))[0]) - everywhere
    edge = _EDGE_FRACTION * EDGE_SIZE * a * (size_radius > 0)
    displacement = units.displacement
    rows: tuple[tuple[str, str, float], ...] = (
        ("contact_radius", "element size", SAFETY * factor * size_radius * units.length),
        ("contact_radius", "edge size", edge * units.length),
        ("contact_radius", "outer boundary", far_radius * units.length),
        ("contact_radius", "load balance", load_residual / 3 * a * units.length),
        ("approach", "element size", SAFETY * factor * size_approach * displacement),
        ("approach", "outer boundary", far_approach * displacement),
        ("approach", "load balance", load_residual * state.central_displacement * displacement),
        ("peak_pressure", "element size", size_peak * units.pressure),
        ("peak_pressure", "outer boundary", far_peak * units.pressure),
        ("peak_pressure", "load balance", load_residual / 3 * largest * units.pressure),
    )
    budget = tuple((quantity, origin, float(value)) for quantity, origin, value in rows)
    total = {name: sum(value for quantity, _, value in budget if quantity == name) for name, _, _ in budget}
    points = _ComparisonPoints(d, companion.discretisation)
    normal = StressEstimate(state.normal, companion.normal, points, everywhere, factor)
    return Estimates(Uncertainty(**total, budget=budget), pressure, normal, None, companion)


def _coarse_mesh_factor(size: float) -> float:
    """Factor on SAFETY, above 1 where triangles are too large for errors to fall at their asymptotic rate."""
    return max(1.0, size / _ASYMPTOTIC_SIZE)


def _samples(vertices: np.ndarray) -> np.ndarray:
    """Points in each of the cells between increasing ``vertices``, both ends included."""
    t = np.linspace(0, 1, _CELL_SAMPLES)
    return (vertices[:-1, None] + np.diff(vertices)[:, None] * t).ravel()


def _largest(values: np.ndarray, vertices: int, reach: int) -> np.ndarray:
    """SAFETY times the largest |value| within ``reach`` cells of each of the ``vertices``.

    values : (..., n) at ``_samples``.  Returns shape (..., vertices).
    """
    worst = SAFETY * np.abs(values).reshape(*values.shape[:-1], -1, _CELL_SAMPLES).max(axis=-1)
    padded = np.concatenate([worst[..., :1]] * reach + [worst] + [worst[..., -1:]] * reach, axis=-1)
    return np.max([padded[..., k : k + vertices] for k in range(2 * reach)], axis=0)
