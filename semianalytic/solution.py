"""Solution of the semi-analytical method.

A ``Solution`` carries its coarser companion, the same problem on fewer patches. The uncertainty of a field
is estimated from the difference of the two at the points required, widened so that a chance agreement of
the two does not count as accuracy.
"""

import time
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import pairwise
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.ndimage import distance_transform_cdt, maximum_filter

from semianalytic.inputs import Body, check_finite
from semianalytic.patch_answer import PatchAnswer, PatchPoints
from semianalytic.patches.level import Level, interpolated
from semianalytic.patches.neighbours import Neighbours
from semianalytic.stresses import fields
from semianalytic.uncertainty import AT_EDGE, SMOOTH, Uncertainty, safety, unsettled

Array = NDArray[np.floating]
BoolArray = NDArray[np.bool_]

# error of the stress below patches, over the peak pressure, against Hankel quadrature: above 4 patches, below
EVALUATION = (5e-6, 5e-7)
RINGS = 3e-9  # likewise on rings
NEAR = 8.0  # patches from the edge, within which the error of its radius is felt
# of fields under a smooth edge, inside: times the last change, times the change before
INSIDE = (2.0, 0.2)
OWN = (2.0, 0.35)  # share of a component in that: times its own change over the largest; the least
SHEAR = (1.0, 0.25)  # likewise, of a shear stress
# what the refinement of a smooth edge does not show: of the root mean square of the change of the pressure,
# and of the peak pressure; felt to a depth of some patches
FLOOR, REACH = (0.35, 6e-7), 8.0
DEFLECTED = 0.2  # of that floor over the peak pressure, that the displacement over the approach feels
# deep down a stress follows the moments of the pressure, the second one a^2 at a given load: share of the
# relative uncertainty of a, without which an error was 0.92 of the whole in 200 random problems; in full
# below as many patches
DEEP = 0.03, 32.0
MEAN = 0.2  # less as deep, where a stress is a mean over many patches
# likewise near the edge, of the ripple of the patches, which the shape averages, of the largest change there,
# and of the pressure a patch inside it, of which the parts of a patch leave a little on every grid; within
# some patches of it
RIPPLE, WANDERING, LEFT, TAPER = 0.9, 1.1, 4e-5, 16.0
# times the misfit of the shape inside, where that is more; falling as the square of the distance
MISFIT = 2.0
RESOLUTION = 1e-7  # of the pressure of patches: its response to the gap the iteration leaves


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
    neighbours : contacts that give ``stiffness``; None for patches alone.
    singular_radii [m] : of the surface, where a given pressure jumps: there pressure and stress are NaN.
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
    neighbours: Neighbours | None = field(default=None, repr=False)
    frames: ClassVar = ("fixed", "edge")  # in which uncertainties are estimated
    singular_radii: tuple[float, ...] = ()

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
        grid, pressure = replace(level.grid, quarter=False), level.grid.whole(found.pressure)
        # the gap has served the iteration; kept, it would be as large as the pressure
        level = replace(level, found=replace(found, gap=np.empty((0, 0))))
        beyond = max(int(np.ceil((2.05 * level.radius - grid.x[-1]) / grid.d)), 0)
        return cls(
            **scalars,  # type: ignore[arg-type]
            surface_nodes=grid.x[0] + grid.d * np.arange(-beyond, grid.n + beyond),
            diagnostics=Diagnostics(
                iterations=found.iterations,
                convolutions=level.convolutions,
                gap_inside=found.gap_inside,
                penetration_outside=found.penetration_outside,
                load_error=found.load_error,
                load=level.load,
                patches=int(np.count_nonzero(pressure)),
                patches_per_side=grid.n,
                patch_size=grid.d,
                seconds=0.0,
                history=found.history,
            ),
            uncertainty=None,
            nodes=grid.x,
            patch_pressure=pressure,
            coarser=coarser,
            _level=level,
            _body=body,
            singular_radii=level.given.singular_radii if level.given else (),
        )

    @property
    def stiffness(self) -> float | None:
        """d load / d approach [N/m], from contacts solved on first use; None for patches alone."""
        return None if self.neighbours is None else self.neighbours.stiffness[0]

    def sample(self, points: Any, quantity: str, uncertainty: bool = True) -> PatchAnswer:
        """Value of a quantity at points, with its uncertainty where one was estimated.

        points : any record with the attributes of ``PatchPoints``; None of a scalar.
        quantity : pressure, stress or displacement, or a scalar: contact_radius, approach, peak_pressure,
        stiffness.   uncertainty : False leaves it out, and the work for it.
        Raises ValueError for z < 0, for a layer that z does not lie in, and for a rigid ball.
        """
        stated = self.uncertainty if uncertainty else None
        fields = {"pressure": self._pressure, "stress": self._stress, "displacement": self._displacement}
        if quantity in fields:
            return fields[quantity](points, stated is not None)
        if quantity == "stiffness" and self.neighbours is not None:
            value, U = self.neighbours.stiffness
            return PatchAnswer(value, U if uncertainty else None)
        if quantity in ("contact_radius", "approach", "peak_pressure"):
            return PatchAnswer(getattr(self, quantity), stated and getattr(stated, quantity))
        return PatchAnswer(None)

    def with_friction(self, friction: float) -> "Solution":
        """The same contact and pressure, sliding with another finite coefficient; ValueError otherwise."""
        check_finite(friction=friction)
        coarser = None if self.coarser is None else self.coarser.with_friction(friction)
        return replace(self, coarser=coarser, _body=self._body.with_friction(float(friction)))

    def pressure(self, x: ArrayLike, y: ArrayLike = 0.0) -> Array:
        """Contact pressure [Pa], 0 outside; x, y : [m], broadcast."""
        return np.asarray(self.sample(PatchPoints(x, y), "pressure", False).value)

    def stress(
        self, x: ArrayLike, y: ArrayLike, z: ArrayLike, layer: int | None = None, body: str = "flat"
    ) -> Array:
        """Stress tensor [Pa], shape (3, 3) + points; arguments and errors as of ``PatchPoints``."""
        return np.asarray(self.sample(PatchPoints(x, y, z, layer, body), "stress", False).value)

    def displacement(self, x: ArrayLike, y: ArrayLike, z: ArrayLike, body: str = "flat") -> Array:
        """Displacement [m], shape (3,) + points, u_z into the body; arguments as of ``PatchPoints``."""
        return np.asarray(self.sample(PatchPoints(x, y, z, None, body), "displacement", False).value)

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

    def _displacement(self, points: Any, stated: bool) -> PatchAnswer:
        """Displacement [m]; uncertain by its coarser companions, shared as that of the stress, and by the
        approach."""
        x, y, z, body = points.x, points.y, points.z, self._body.named(points.body)
        levels = self._levels if stated else [self._level]
        u, *coarser = fields.displacement(levels, body, x, y, z)
        if not stated:
            return PatchAnswer(u)
        second, third = coarser
        own = self._change(np.abs(u - second), np.abs(second - third), x, y)
        own[2] = total = own.max(axis=0)  # u_z moves with the approach
        share = self._share(own, total, OWN)
        approach = self._stated.approach
        total = total + (approach if self._level.smooth() is None else RINGS * self.approach)
        if self._level.shape is not None:
            total += approach + DEFLECTED * self._floor / self.peak_pressure * self.approach
        return PatchAnswer(u, share * total)

    def _pressure(self, points: Any, stated: bool) -> PatchAnswer:
        """Contact pressure [Pa]: with a smooth edge that of its shape, fitted to the patches; of patches
        alone p^2 is interpolated. A given one has no uncertainty.

        With a smooth edge uncertain as the stress. Of patches alone by the largest difference from the
        companion within two of its patches, times ``safety``, or a sixth of that of the next two; plus the
        changes of the peak by the other numerical parameters, twice, since they were varied on half the
        patches and the pressure due to a gap is proportional to the patches; plus ``RESOLUTION`` of the peak;
        twice the sum.
        """
        x, y = points.x, points.y
        p = self._level.pressure(x, y)
        if not stated:
            return PatchAnswer(p)
        if self._level.given is not None:
            return PatchAnswer(p, 0 * p)
        if self._level.shape is not None:
            return PatchAnswer(p, self._smooth_uncertainty(x, y, at_edge(points)))
        least = (2 * self._other_than("patch size") + RESOLUTION) * self.peak_pressure
        changed = interpolated(self.nodes, self._refinement, x, y, order=1)
        return PatchAnswer(p, 2 * (changed + least) + self._rim(x, y, 0.0))

    @cached_property
    def _refinement(self) -> Array:
        """Error of the pressure of patches alone at the nodes [Pa] by their size."""
        second, third = (level.pressure(*np.ix_(self.nodes, self.nodes)) for level in self._levels[1:])
        last, before = np.abs(self.patch_pressure - second), np.abs(second - third)
        reach = 2 * int(np.ceil(2 * self._refined)) + 1
        difference = np.maximum(safety(self._refined) * last, before / 6)
        return np.asarray(maximum_filter(difference, size=reach, mode="nearest"))

    def _rim(self, x: ArrayLike, y: ArrayLike, z: ArrayLike) -> Array:
        """Error [Pa] that a staircase makes of an edge: the highest pressure beside it, felt over a patch."""
        d, loaded, ends = self.diagnostics.patch_size, np.pad(self.patch_pressure > 0, 1), self.nodes[[0, -1]]
        inside, outside = (distance_transform_cdt(one, metric="chessboard") for one in (loaded, ~loaded))
        highest = float(self.patch_pressure[inside[1:-1, 1:-1] == 1].max(initial=0.0))
        away, x, y = (np.maximum(inside, outside) - 1.0)[1:-1, 1:-1], np.clip(x, *ends), np.clip(y, *ends)
        return highest * d / (d + np.hypot(interpolated(self.nodes, away, x, y, order=1) * d, z))

    def _smooth_uncertainty(self, x: ArrayLike, y: ArrayLike, at_edge: BoolArray) -> Array:
        """Uncertainty of the pressure [Pa] of a smooth edge: of its shape at equal x/a, and of its radius."""
        fine = self._level.shape
        assert fine is not None
        x, y = np.broadcast_arrays(np.asarray(x, dtype=float), np.asarray(y, dtype=float))
        p, second, third = (level.pressure(*level.matching(self._level, x, y)) for level in self._levels)
        total = self._change(np.abs(p - second), np.abs(second - third), x, y) + self._floor
        total = total + self._near_ripple(x, y) + self._other_than("patch size") * self.peak_pressure
        total = np.maximum(total, self._misfit(x, y, 0.0))
        if at_edge.all():
            return total
        shift = self._uncertain_reach
        moved = [np.abs(fine.widened(s).pressure(x, y) - p) for s in (-shift, shift)]
        return np.where(at_edge, total, np.maximum(total, np.max(moved, axis=0)))

    @cached_property
    def _levels(self) -> list[Level]:
        """The levels of the refinement study, the finest first."""
        coarser = self.coarser
        assert coarser is not None
        assert coarser.coarser is not None
        return [one._level for one in (self, coarser, coarser.coarser)]

    @property
    def _refined(self) -> float:
        """Patches a side over those of the coarser companion."""
        return self._level.grid.n / self._levels[1].grid.n

    def _stress(self, points: Any, stated: bool) -> PatchAnswer:
        """Stress [Pa], uncertain by its coarser companions.

        The largest difference over the six components of this level and the next, or of the next and the one
        after, at the same x/a of each. Under a smooth edge times ``INSIDE`` to ``AT_EDGE``, plus ``FLOOR`` of
        the peak; or the change by the uncertain radius, where that is larger, but for the frame "edge"; of
        that, a component has its share (``OWN``, ``SHEAR``). Of patches alone times ``safety``, or a third,
        plus ``EVALUATION``. Both with the changes by the other numerical parameters.
        """
        x, y, z, layer, solid = points.x, points.y, points.z, points.layer, self._body.named(points.body)
        sigma, *coarser = fields.stress(self._levels if stated else [self._level], solid, x, y, z, layer)
        if not stated:
            return PatchAnswer(sigma)
        (second, third), floor = coarser, self._other_than("patch size")
        own = self._change(np.abs(sigma - second), np.abs(second - third), x, y)
        total = own.max(axis=(0, 1))
        own[0, 0] = own[1, 1] = np.maximum(own[0, 0], own[1, 1])
        shear = np.reshape(~np.eye(3, dtype=bool), (3, 3) + (1,) * total.ndim)
        share = np.where(shear, self._share(own, total, SHEAR), self._share(own, total, OWN))
        if self._level.smooth() is not None:
            if self._level.shape is not None:
                shallow = 1 / (1 + np.asarray(z) / (REACH * self.diagnostics.patch_size)) ** 2
                least = self._floor + self._near_ripple(x, y) + floor * self.peak_pressure
                deep = np.minimum(np.asarray(z) / (DEEP[1] * self.diagnostics.patch_size), 1.0)
                # other coefficients change all pressures together, which is felt far below the contact too
                other = self._other_than("patch size", "iteration")
                scale = other + DEEP[0] * deep * self._stated.contact_radius / self.contact_radius
                total = total + least * shallow + np.abs(sigma).max(axis=(0, 1)) * scale
                total = np.maximum(total, self._misfit(x, y, z)) * (1 - MEAN * deep)
            total = total + RINGS * self.peak_pressure
            if self._level.shape is not None and not (moves := at_edge(points)).all():
                moved = self._uncertain_edge(solid, x, y, z, layer)
                return PatchAnswer(sigma, np.where(moves, share * total, np.maximum(share * total, moved)))
        else:
            total += floor * self.peak_pressure + self._rim(x, y, z)
            deep = np.asarray(z) >= 4 * self.diagnostics.patch_size
            total += np.where(deep, *EVALUATION[::-1]) * self.peak_pressure
        return PatchAnswer(sigma, share * total)

    def _share(self, own: Array, largest: Array, of: tuple[float, float]) -> Array:
        """Share of each component in the uncertainty, by its ``own`` `_change` and the ``largest`` of all."""
        if self._level.smooth() is None:
            return np.ones(own.shape)
        ratio = np.divide(own, largest, out=np.ones(own.shape), where=largest > 0)
        return np.clip(of[0] * ratio, of[1], 1.0)

    def _change(self, last: Array, before: Array, x: ArrayLike, y: ArrayLike) -> Array:
        """Error by the patch size from the last change and the one before."""
        if self._level.smooth() is None:
            return np.maximum(safety(self._refined) * last, before / 3)
        share: Array | float = 0.0
        if self._level.shape is not None:
            near = self._to_edge(x, y) / (2 * self.diagnostics.patch_size)
            share = 1 / (1 + near * near)
        of_last, of_before = (far + (at - far) * share for far, at in zip(INSIDE, AT_EDGE, strict=True))
        return np.asarray(np.maximum(of_last * last, of_before * before))

    def _near_ripple(self, x: ArrayLike, y: ArrayLike) -> Array:
        away = self._to_edge(x, y) / (TAPER * self.diagnostics.patch_size)
        return self._edge_error / (1 + away * away)

    @cached_property
    def _edge_error(self) -> float:
        """Error of a pressure with a smooth edge [Pa] next to it, at equal x/a."""
        shape, left = self._level.shape, 0.0
        if shape is not None:
            inside = max(1 - self.diagnostics.patch_size / min(shape.axes), 0.0)
            left = LEFT * float(shape.pressure(*shape.on_ray(inside, np.zeros(()))))
        return RIPPLE * self._level.ripple + WANDERING * self._edge_change + left

    @cached_property
    def _edge_change(self) -> float:
        """Largest change of the pressure [Pa] within ``TAPER`` patches of a smooth edge, at equal x/a.

        The change crosses zero at places that differ between grids.
        """
        shapes = [level.shape for level in self._levels if level.shape is not None]
        width = min(TAPER * self.diagnostics.patch_size / min(shapes[0].axes), 1.0) if shapes else 0.0
        s = 1 - width * np.linspace(1.0, 0.0, 33) ** 2
        p = [one.pressure(*one.on_ray(s, np.zeros(s.size))) for one in shapes]
        changes = [float(np.abs(a - b).max()) for a, b in pairwise(p)]
        if len(changes) < 2:
            return sum(changes)
        last, before = changes
        return unsettled(last, before, self._level.ripple)

    def _misfit(self, x: ArrayLike, y: ArrayLike, z: ArrayLike) -> Array:
        """Error [Pa] by what the shape of the pressure misses inside."""
        distant = (np.square(x) + np.square(y) + np.square(z)) / self.contact_radius**2
        return np.asarray(MISFIT * self._level.misfit / (1 + distant))

    def _to_edge(self, x: ArrayLike, y: ArrayLike) -> Array:
        """Distance of points from a smooth edge [m], about."""
        shape = self._level.shape
        assert shape is not None
        t, s2, _ = shape.polynomials(x, y)
        return np.asarray(np.abs(t) / (1 + np.sqrt(s2)) * min(shape.axes))

    @cached_property
    def _floor(self) -> float:
        """Error of a smooth pressure [Pa] wherever the refinement shows less by chance."""
        shapes = [level.shape for level in self._levels[:2] if level.shape is not None]
        s = np.linspace(-1, 1, 201)
        s, angle = np.sqrt(np.abs(s)), np.pi * (s > 0) / 4
        p = [one.pressure(*one.on_ray(s, angle)) for one in shapes]
        share, least = FLOOR
        if len(p) < 2:  # patches alone on the coarser grid: the pressure is as uncertain as the radius
            return share * self.peak_pressure * self._stated.contact_radius / self.contact_radius
        return share * float(np.sqrt(np.mean((p[0] - p[1]) ** 2))) + least * self.peak_pressure

    def _uncertain_edge(
        self, solid: Body, x: ArrayLike, y: ArrayLike, z: ArrayLike, layer: int | None
    ) -> Array:
        """Change of the stress [Pa] by the uncertain radius, within ``NEAR`` patches of the edge; (3, 3) +
        points."""
        shift = self._uncertain_reach
        x, y, z = np.broadcast_arrays(*(np.asarray(v, dtype=float) for v in (x, y, z)))
        distance = np.hypot(self._to_edge(x, y), z)
        near = distance < NEAR * self.diagnostics.patch_size + shift
        change = np.zeros((3, 3, *x.shape))
        if near.any():
            change[..., near] = fields.stress_of_uncertain_edge(
                self._level, solid, shift, x[near], y[near], z[near], layer
            )
        return change

    @cached_property
    def _uncertain_reach(self) -> float:
        """Uncertainty of the distance from centre to edge [m], the largest of all directions."""
        stated, shapes = self._stated.contact_radius, [level.shape for level in self._levels]
        if any(shape is None or shape.round for shape in shapes):
            return stated
        angle = 2 * np.pi * np.arange(64) / 64
        fine, second, third = (np.array(shape.on_ray(np.ones(64), angle)) for shape in shapes if shape)
        last, before = (float(np.hypot(*change).max()) for change in (fine - second, second - third))
        return max(stated, SMOOTH[0] * last, SMOOTH[1] * before)

    @property
    def _stated(self) -> Uncertainty:
        if self.uncertainty is None:
            raise ValueError("uncertainty was not estimated; solve with estimate_uncertainty=True")
        return self.uncertainty

    def _other_than(self, *parameters: str) -> float:
        """Relative uncertainty of the peak pressure by all numerical parameters but those named."""
        rows = self._stated.budget
        other = sum(row[2] for row in rows if row[0] == "peak_pressure" and row[1] not in parameters)
        return other / self.peak_pressure


def at_edge(points: Any) -> BoolArray:
    """Which of the points keep their share of the way to the contact edge."""
    return np.asarray(np.asarray(points.frame) == "edge")
