"""Solution of the semi-analytical method.

A ``Solution`` carries its coarser companion, the same problem on fewer patches and, of a sphere, with fewer
terms of the edge profile. The uncertainty of a field is estimated from the difference of the two at the
points required, widened so that a chance agreement of the two does not count as accuracy.
"""

import time
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import RectBivariateSpline
from scipy.ndimage import maximum_filter

from semianalytic import fields
from semianalytic.edge_profile import Profile, convergence
from semianalytic.inputs import Body, check_finite
from semianalytic.level import Level
from semianalytic.uncertainty import Uncertainty, safety

__all__ = ["Diagnostics", "Solution"]

Array = NDArray[np.floating]

# error of the stress of a given pressure, over its peak, against Hankel quadrature: above 4 patches, below
EVALUATION = (5e-6, 5e-7)
NEAR = 8.0  # patches from the edge, within which the error of its radius is felt
EXACT = 1e-9  # that of an edge profile, relative to the peak pressure and to the stress
# likewise of a pressure: its response to the gap the iteration leaves, in proportion to the patches
RESOLUTION = 1e-7


@dataclass(frozen=True)
class Diagnostics:
    """Cost of the solution and how well the contact conditions are met.

    gap_inside, penetration_outside : largest, over the depth of the indenter on the grid.
    load_error : relative.  load : that the pressure carries [N].  patches : loaded ones.
    history : (gap, penetration) of every iteration on the finest grid.
    """

    iterations: int
    convolutions: int
    gap_inside: float
    penetration_outside: float
    load_error: float
    load: float
    patches: int
    patches_per_side: int
    patch_size: float
    seconds: float
    history: tuple[tuple[float, float], ...] = field(repr=False, default=())


@dataclass(frozen=True, eq=False)
class Solution:
    """Contact of an indenter on a coated half-space; SI, tension positive, z into the body in question.

    Stresses and displacements are those of the flat, with ``body="ball"`` those of an elastic ball: x and y
    as on the flat, on which the traction is in +x, z into the ball.

    contact_radius [m] : where p vanishes; of a contact that is no disc, the radius of the disc of its area.
    approach [m].  peak_pressure [Pa] : largest pressure, which sits off the axis under stiff thin coatings.
    surface_nodes [m] : x on y = 0 at which no pressure is interpolated, past 2 contact radii.
    stiffness [N/m] : d load / d approach, from neighbouring contacts; None of patches alone.
    """

    contact_radius: float
    approach: float
    peak_pressure: float
    surface_nodes: Array = field(repr=False)
    diagnostics: Diagnostics
    uncertainty: Uncertainty | None
    nodes: Array = field(repr=False)  # patch centres along one axis [m]
    patch_pressure: Array = field(repr=False)  # at the patch centres [Pa], (n, n)
    coarser: "Solution | None" = field(repr=False)
    _level: Level = field(repr=False)
    _body: Body = field(repr=False)
    stiffness: float | None = None
    stiffness_uncertainty: float | None = None

    @classmethod
    def of_levels(
        cls, levels: Sequence[Level], body: Body, uncertainty: Uncertainty | None, began: float
    ) -> "Solution":
        """Solution of the last level; with an uncertainty, the two before are its coarser companions.

        began : ``time.perf_counter()`` at the start of the solve.
        """
        solution: Solution | None = None
        for level in levels[-3:] if uncertainty else levels[-1:]:
            solution = cls._of_level(level, body, solution)
        assert solution is not None
        diagnostics = replace(solution.diagnostics, seconds=time.perf_counter() - began)
        return replace(solution, uncertainty=uncertainty, diagnostics=diagnostics)

    @classmethod
    def _of_level(cls, level: Level, body: Body, coarser: "Solution | None") -> "Solution":
        scalars, found = level.scalars, level.found
        grid = replace(level.grid, quarter=False)
        # the gap has served the iteration; kept, it would be as large as the pressure
        found = replace(found, pressure=level.grid.whole(found.pressure), gap=np.empty((0, 0)))
        level = replace(level, grid=grid, found=found)
        beyond = max(int(np.ceil((2.05 * level.radius - grid.x[-1]) / grid.d)), 0)
        return cls(
            **scalars,
            surface_nodes=grid.x[0] + grid.d * np.arange(-beyond, grid.n + beyond),
            diagnostics=Diagnostics(
                iterations=found.iterations,
                convolutions=level.convolutions,
                gap_inside=found.gap_inside,
                penetration_outside=found.penetration_outside,
                load_error=found.load_error,
                load=level.load,
                patches=int(np.count_nonzero(found.pressure)),
                patches_per_side=grid.n,
                patch_size=grid.d,
                seconds=0.0,
                history=found.history,
            ),
            uncertainty=None,
            nodes=grid.x,
            patch_pressure=found.pressure,
            coarser=coarser,
            _level=level,
            _body=body,
        )

    def with_friction(self, friction: float) -> "Solution":
        """The same contact sliding with another friction coefficient, which leaves the pressure unchanged.

        Raises ValueError unless it is finite.
        """
        check_finite(friction=friction)
        coarser = None if self.coarser is None else self.coarser.with_friction(friction)
        return replace(self, coarser=coarser, _body=self._body.with_friction(float(friction)))

    def pressure(self, x: ArrayLike, y: ArrayLike = 0.0) -> Array:
        """Contact pressure [Pa], 0 outside; between nodes by interpolation of a quantity smooth at the edge.

        That is p less its edge profile or, where there is none, p^2, continued beyond a smooth edge.
        x, y : [m], broadcast.
        """
        shape = self._level.shape
        if self._level.edge is not None:
            x, y = np.broadcast_arrays(np.asarray(x, dtype=float), np.asarray(y, dtype=float))
            s, t = ((v.ravel() - self.nodes[0]) / self.diagnostics.patch_size for v in (x, y))
            return self._level.edge.pressure(self.patch_pressure, s, t).reshape(x.shape)
        if shape is None:
            square = self.patch_pressure**2
            touched = _at(self.nodes, square, x, y, order=1) > 0  # the cubic may oscillate beyond
            return np.sqrt(np.maximum(np.where(touched, _at(self.nodes, square, x, y), 0), 0))
        value = shape.pressure(np.hypot(x, y))
        if isinstance(shape, Profile) and not self._level.rest.any():
            return np.maximum(value, 0)
        rest = self.patch_pressure - shape.pressure(np.hypot(self.nodes[:, None], self.nodes[None, :]))
        return np.maximum(value + _at(self.nodes, rest, x, y, order=1), 0)

    def stress(
        self, x: ArrayLike, y: ArrayLike, z: ArrayLike, layer: int | None = None, body: str = "flat"
    ) -> Array:
        """Stress tensor [Pa], shape (3, 3) + points.

        x, y, z : [m], broadcast, z >= 0.  layer : 0 is the first coating, len(coatings) the substrate; it
        picks the side of an interface, None the upper one.  body : "flat" or "ball".
        Raises ValueError for z < 0, for a layer that z does not lie in, and for a rigid ball.
        """
        return fields.stress([self._level], self._body.named(body), x, y, z, layer)[0]

    def stress_plane(self, z: float, layer: int | None = None, body: str = "flat") -> Array:
        """Stress tensor [Pa] below every patch centre at one depth, shape (3, 3, n, n), by seven FFTs.

        z : [m].  layer, body : as in ``stress``.  Points are (nodes[i], nodes[j]), z.
        """
        return fields.stress_plane(self._level, self._body.named(body), z, layer)

    def displacement_plane(self, z: float, body: str = "flat") -> Array:
        """Displacement [m] below every patch centre at one depth, shape (3, n, n), by four FFTs.

        z : [m].  body : as in ``stress``.  Points are (nodes[i], nodes[j]), z.
        """
        return fields.displacement_plane(self._level, self._body.named(body), z)

    def displacement(self, x: ArrayLike, y: ArrayLike, z: ArrayLike, body: str = "flat") -> Array:
        """Displacement [m], shape (3,) + points, u_z into the body.

        x, y, z : [m], broadcast, z >= 0.  body : as in ``stress``.
        """
        return fields.displacement([self._level], self._body.named(body), x, y, z)[0]

    def displacement_with_uncertainty(
        self, x: ArrayLike, y: ArrayLike, z: ArrayLike, body: str = "flat"
    ) -> tuple[Array, Array]:
        """Displacement and its uncertainty [m], shape (3,) + points each.

        With an edge profile from its coarser companions, as that of the stress, the largest of the components
        for each alike; else the uncertainty of the approach everywhere.
        Raises ValueError where no uncertainty was estimated.
        """
        self._companion()
        assert self.uncertainty is not None
        if not isinstance(self._level.shape, Profile):
            u = self.displacement(x, y, z, body)
            return u, np.full(u.shape, self.uncertainty.approach)
        levels = [self._level, *(replace(self._level, shape=shape) for shape in self._studied[1:])]
        u, second, third = fields.displacement(levels, self._body.named(body), x, y, z)
        last, before = (np.abs(one - other).max(axis=0) for one, other in ((u, second), (second, third)))
        total = self._convergence * np.maximum(last, self._convergence * before) + EXACT * self.approach
        return u, np.broadcast_to(total, u.shape).copy()

    def displacement_uncertainty(self, x: ArrayLike, y: ArrayLike, z: ArrayLike, body: str = "flat") -> Array:
        """The second part of ``displacement_with_uncertainty``."""
        return self.displacement_with_uncertainty(x, y, z, body)[1]

    def pressure_uncertainty(self, x: ArrayLike, y: ArrayLike = 0.0) -> Array:
        """Uncertainty of the pressure [Pa] from the coarser companion.

        With an edge profile as that of the stress. Else the largest difference of the two within two patches
        of the coarser, times ``safety``, or a sixth of that of the next two; plus the changes of the peak by
        the other numerical parameters, twice, since they were varied on half the patches and the pressure
        due to a gap is proportional to the patches; plus ``RESOLUTION`` of the peak; twice the sum.
        Raises ValueError where no uncertainty was estimated.
        """
        coarser, floor = self._companion()
        if isinstance(self._level.shape, Profile):
            return self._profile_uncertainty(x, y)
        i, j = self.nodes[:, None], self.nodes[None, :]
        second = coarser.pressure(i, j)
        ratio = len(self.nodes) / len(coarser.nodes)
        difference = safety(ratio) * np.abs(self.patch_pressure - second)
        if coarser.coarser is not None:
            difference = np.maximum(difference, np.abs(second - coarser.coarser.pressure(i, j)) / 6)
        reach = 2 * int(np.ceil(ratio if self._level.shape is not None else 2 * ratio)) + 1
        widened = maximum_filter(difference, size=reach, mode="nearest")
        total = _at(self.nodes, widened, x, y, order=1) + (2 * floor + RESOLUTION) * self.peak_pressure
        return 2 * total

    def _profile_uncertainty(self, x: ArrayLike, y: ArrayLike) -> Array:
        """Uncertainty of the pressure [Pa] from the coarser edge profiles, as that of the stress."""
        shapes = self._studied
        assert self.uncertainty is not None
        fine, second, third = shapes
        r, rate = np.hypot(x, y), self._convergence
        p = fine.pressure(r)
        change = np.abs(p - second.pressure(r))
        change = rate * np.maximum(change, rate * np.abs(second.pressure(r) - third.pressure(r)))
        shift = self.uncertainty.contact_radius
        moved = np.abs([fine.pressure(r + s) - p for s in (-shift, shift)]).max(axis=0)
        rest = float(np.abs(self._level.rest).max())
        return np.maximum(change, moved) + EXACT * self.peak_pressure + rest

    @cached_property
    def _convergence(self) -> float:
        """Factor by which the last refinement reduced the error of the edge profile."""
        return convergence(*self._studied)

    @property
    def _studied(self) -> list[Profile]:
        """The edge profiles of the refinement study, the finest first."""
        coarser, _ = self._companion()
        assert coarser.coarser is not None
        shapes = [one._level.shape for one in (self, coarser, coarser.coarser)]
        return [shape for shape in shapes if isinstance(shape, Profile)]

    def stress_uncertainty(
        self, x: ArrayLike, y: ArrayLike, z: ArrayLike, layer: int | None = None, body: str = "flat"
    ) -> Array:
        """Uncertainty of the stress [Pa], shape (3, 3) + points; see ``stress_with_uncertainty``.

        Raises ValueError where no uncertainty was estimated.
        """
        return self.stress_with_uncertainty(x, y, z, layer, body)[1]

    def stress_with_uncertainty(
        self, x: ArrayLike, y: ArrayLike, z: ArrayLike, layer: int | None = None, body: str = "flat"
    ) -> tuple[Array, Array]:
        """Stress and its uncertainty [Pa], shape (3, 3) + points each, the latter from coarser companions.

        The largest difference over the six components, for every component alike, of this level and the next,
        or of the next and the one after. With an edge profile both are reduced by the observed convergence;
        the change by the uncertain radius counts where it is larger; plus ``EXACT`` of the peak pressure and
        of the stress. Without, times ``safety``, or a third; plus the changes of the peak pressure by other
        numerical parameters, and the error of the evaluation, ``EVALUATION`` of it.
        Raises ValueError where no uncertainty was estimated.
        """
        coarser, floor = self._companion()
        levels = [self._level, coarser._level]
        if coarser.coarser is not None:
            levels.append(coarser.coarser._level)
        solid = self._body.named(body)
        sigma, second, *third = fields.stress(levels, solid, x, y, z, layer)
        change = np.abs(sigma - second).max(axis=(0, 1))
        before = np.abs(second - third[0]).max(axis=(0, 1)) if third else np.zeros_like(change)
        if isinstance(self._level.shape, Profile):
            rate = self._convergence
            floor = EXACT * (self.peak_pressure + np.abs(sigma).max(axis=(0, 1)))
            total = rate * np.maximum(change, rate * before)
            total = np.maximum(total, self._uncertain_edge(solid, x, y, z, layer)) + floor
        else:
            change = np.maximum(safety(len(self.nodes) / len(coarser.nodes)) * change, before / 3)
            total = change + floor * self.peak_pressure
            shallow = np.asarray(z) < 4 * self.diagnostics.patch_size
            total += np.where(shallow, *EVALUATION) * self.peak_pressure
        return sigma, np.broadcast_to(total, (3, 3, *change.shape)).copy()

    def _uncertain_edge(
        self, solid: Body, x: ArrayLike, y: ArrayLike, z: ArrayLike, layer: int | None
    ) -> Array:
        """Change of the stress [Pa] by the uncertain radius, within ``NEAR`` patches of the edge.

        Plus what the rest of the pressure may reach in the patch next to the edge, where it is left out: a
        ring of that width.
        """
        assert self.uncertainty is not None
        shift = self.uncertainty.contact_radius
        x, y, z = np.broadcast_arrays(*(np.asarray(v, dtype=float) for v in (x, y, z)))
        distance = np.hypot(np.hypot(x, y) - self.contact_radius, z)
        d = self.diagnostics.patch_size
        near = distance < NEAR * d + shift
        change = np.array(4 * np.abs(self._level.rest).max() * d / (d + distance))  # of a single point too
        if near.any():
            change[near] += fields.stress_of_uncertain_edge(
                self._level, solid, shift, x[near], y[near], z[near], layer
            )
        return change

    def _companion(self) -> tuple["Solution", float]:
        if self.uncertainty is None or self.coarser is None:
            raise ValueError("uncertainty was not estimated; solve with estimate_uncertainty=True")
        rows = self.uncertainty.budget
        other = sum(row[2] for row in rows if row[0] == "peak_pressure" and row[1] != "patch size")
        return self.coarser, other / self.peak_pressure


def _at(nodes: Array, values: Array, x: ArrayLike, y: ArrayLike, order: int = 3) -> Array:
    """Spline through the values at the nodes, 0 outside them."""
    x, y = np.broadcast_arrays(np.asarray(x, dtype=float), np.asarray(y, dtype=float))
    inside = np.maximum(np.abs(x), np.abs(y)) <= nodes[-1] * (1 + 1e-12)
    value = np.zeros(x.shape)
    spline = RectBivariateSpline(nodes, nodes, values, kx=order, ky=order)
    value[inside] = spline(x[inside], y[inside], grid=False)
    return value
