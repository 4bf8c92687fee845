"""Solution of the semi-analytical method.

A ``Solution`` carries its coarser companions, the same problem on fewer patches; from their changes, and a
term for each other cause, follows its uncertainty (``uncertainty``).
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.ndimage import distance_transform_cdt, maximum_filter

from semianalytic import numbers, solution_html
from semianalytic.inputs import Body, check_finite
from semianalytic.patch_answer import PatchAnswer, PatchPoints
from semianalytic.patches.level import Level, interpolated
from semianalytic.patches.neighbours import Neighbours
from semianalytic.stresses import fields
from semianalytic.uncertainty import ChangeTable, Uncertainty, of_levels, order_of, refined

Array = NDArray[np.floating]
BoolArray = NDArray[np.bool_]


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
    coarser: Solution | None = field(repr=False)
    _level: Level = field(repr=False)
    _body: Body = field(repr=False)
    neighbours: Neighbours | None = field(default=None, repr=False)
    frames: ClassVar = ("fixed", "edge")  # in which uncertainties are estimated
    singular_radii: tuple[float, ...] = ()

    @classmethod
    def of_levels(
        cls, levels: Sequence[Level], body: Body, uncertainty: Uncertainty | None, began: float
    ) -> Solution:
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
    def _of_level(cls, level: Level, body: Body, coarser: Solution | None) -> Solution:
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

    def _repr_html_(self) -> str:
        """Sentence, table and pressure for a notebook."""
        return solution_html.shown(self)

    def with_friction(self, friction: float) -> Solution:
        """Solution with this pressure, sliding with another finite coefficient; ValueError otherwise."""
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
        """Displacement [m]; uncertain by the size of the patches, by the rings, by the load of the shape, as
        the approach by all else, and where the edge lies by its place: the slope there is at most twice the
        approach over the radius."""
        x, y, z, body = points.x, points.y, points.z, self._body.named(points.body)
        u, *_ = fields.displacement([self._level], body, x, y, z)
        if not stated:
            return PatchAnswer(u)
        # the deflection changes by no larger a share than the pressure by what its shape leaves out
        shares = self._level.misfit / self.peak_pressure + self._level.unbalanced + numbers.RINGS
        left = self._other("approach") + shares * abs(self.approach)
        U = self._of_patch_size(points, "displacement") + left
        if (shape := self._level.shape) is not None:
            moved = 2 * self._uncertain_reach / min(shape.axes) * abs(self.approach)
            U += moved / self._patches_to_edge(x, y, z)
        return PatchAnswer(u, U)

    def _pressure(self, points: Any, stated: bool) -> PatchAnswer:
        """Contact pressure [Pa]: with a smooth edge that of its shape, fitted to the patches; of patches
        alone p^2 is interpolated. A given one has no uncertainty.

        Uncertain by the size of the patches, by the other numerical parameters as the peak, and by the edge:
        a smooth one by its radius, but for the frame "edge"; that of patches alone by its staircase, and
        then by ``BY_PATCHES`` of the peak.
        """
        x, y = points.x, points.y
        p = self._level.pressure(x, y)
        if not stated:
            return PatchAnswer(p)
        if self._level.given is not None:
            return PatchAnswer(p, 0 * p)
        other = self._other("peak_pressure")
        shape = self._level.shape
        if shape is not None:
            at_surface = PatchPoints(x, y, body=points.body, frame=points.frame)
            U = self._of_patch_size(at_surface, "pressure") + other
            shift, moves = self._uncertain_reach, at_edge(points)
            at, of_level = [x, y], p
            if moves.any():
                at = [np.where(moves, *two) for two in zip(self._out_of_cut(x, y, 0.0), at, strict=True)]
                of_level = self._level.pressure(*at)
            moved = (shape.widened(s) for s in (-shift, shift))
            return PatchAnswer(p, U + np.max([np.abs(q.pressure(*at) - of_level) for q in moved], axis=0))
        changed = interpolated(self.nodes, self._refinement, x, y, order=1)
        least = other + numbers.BY_PATCHES[1] * self.peak_pressure
        return PatchAnswer(p, changed + 2 * least + self._rim(x, y, 0.0))

    @cached_property
    def _refinement(self) -> Array:
        """Uncertainty of the pressure of patches alone at the nodes [Pa] by their size."""
        nodes, levels = np.ix_(self.nodes, self.nodes), self._levels
        U = of_levels(levels, [self.patch_pressure, *(level.pressure(*nodes) for level in levels[1:])])
        reach = 2 * int(np.ceil(2 * levels[0].grid.n / levels[1].grid.n)) + 1
        return np.asarray(maximum_filter(U, size=reach, mode="nearest"))

    def _rim(self, x: ArrayLike, y: ArrayLike, z: ArrayLike) -> Array:
        """Error [Pa] that a staircase makes of an edge: the highest pressure beside it, felt over a patch."""
        d, loaded, ends = self.diagnostics.patch_size, np.pad(self.patch_pressure > 0, 1), self.nodes[[0, -1]]
        inside, outside = (distance_transform_cdt(one, metric="chessboard") for one in (loaded, ~loaded))
        highest = float(self.patch_pressure[inside[1:-1, 1:-1] == 1].max(initial=0.0))
        away, x, y = (np.maximum(inside, outside) - 1.0)[1:-1, 1:-1], np.clip(x, *ends), np.clip(y, *ends)
        return highest * d / (d + np.hypot(interpolated(self.nodes, away, x, y, order=1) * d, z))

    @cached_property
    def _levels(self) -> list[Level]:
        """The levels of the refinement study, the finest first."""
        coarser = self.coarser
        assert coarser is not None
        assert coarser.coarser is not None
        return [one._level for one in (self, coarser, coarser.coarser)]

    def _stress(self, points: Any, stated: bool) -> PatchAnswer:
        """Stress [Pa]; uncertain by the size of the patches, by the other numerical parameters as the peak
        pressure, by the evaluation below the patches, and by the edge as the pressure."""
        x, y, z, layer, solid = points.x, points.y, points.z, points.layer, self._body.named(points.body)
        sigma, *_ = fields.stress([self._level], solid, x, y, z, layer)
        if not stated:
            return PatchAnswer(sigma)
        p0, largest = self.peak_pressure, np.abs(sigma).max(axis=(0, 1))
        U = self._of_patch_size(points, "stress")
        of_pressure = self._other("peak_pressure", "iteration") / p0 + self._level.unbalanced
        U += of_pressure * largest + self._of_iteration(z)
        if self._level.smooth() is None:
            deep = np.asarray(z) >= 4 * self.diagnostics.patch_size
            return PatchAnswer(sigma, U + self._rim(x, y, z) + np.where(deep, *numbers.BY_PATCHES[::-1]) * p0)
        U += numbers.RINGS * p0
        if self._level.shape is not None:
            U += self._uncertain_edge(solid, points)
        return PatchAnswer(sigma, U)

    def _of_patch_size(self, points: Any, quantity: str) -> Array:
        """Uncertainty of a field by the size of the patches, components + points.

        Under a smooth edge that of a ``ChangeTable``, else of the changes at the points, of all components
        that of the one that changes most.
        """
        x, y, z, layer = np.broadcast_arrays(
            *(np.asarray(v, dtype=float) for v in (points.x, points.y, points.z)),
            self._body.named(points.body).layer_of(points.z, points.layer),
        )
        shape = self._level.shape
        if shape is None:
            found = self._of_all_levels(quantity, points.body, x, y, z, points.layer)
            U = of_levels(self._levels, found)
            return np.broadcast_to(U.max(axis=tuple(range(U.ndim - x.ndim))), U.shape).copy()
        axes = {"stress": (3, 3), "displacement": (3,), "pressure": ()}[quantity]
        U = np.empty((int(np.prod(axes)), x.size))
        share = shape.share(x, y).ravel()
        for number in np.unique(layer):
            here = layer.ravel() == number
            table = self._layer_tables(quantity, points.body)[number]
            U[:, here] = table(share[here], z.ravel()[here], len(U))
        return U.reshape((*axes, *x.shape)) + (0.0 if quantity == "displacement" else self._of_shape(x, y, z))

    def _of_shape(self, x: Array, y: Array, z: Array) -> Array:
        """Error [Pa] of the shape of a smooth pressure on every grid: by its polynomials and at the edge.

        What its polynomials leave out is measured inside, and fades as the field of a load. An edge that is
        wrong by a share of a patch changes the pressure one patch inside by half that share; at a given
        load it fades as distance^(-3/2) from there. A traction f p adds 2 f times it to the stress along it.
        """
        level, d = self._level, self.diagnostics.patch_size
        shape = level.shape
        assert shape is not None
        distant = (x * x + y * y + z * z) / self.contact_radius**2
        inside = float(shape.pressure(*shape.on_ray(max(1 - d / min(shape.axes), 0.0), np.zeros(()))))
        at_edge = (1 + 2 * abs(self._body.friction)) * level.edge_error / (2 * d) * inside
        return np.asarray(level.misfit / (1 + distant) + at_edge / self._patches_to_edge(x, y, z) ** 1.5)

    def _of_all_levels(self, quantity: str, body: str, x: Array, y: Array, z: Array, layer: Any) -> Array:
        """A field of the three levels, at the same share of the way to their edge but for displacements."""
        solid, levels = self._body.named(body), self._levels
        if quantity == "stress":
            return fields.stress(levels, solid, x, y, z, layer)
        if quantity == "displacement":
            return fields.displacement(levels, solid, x, y, z)
        return np.stack([level.pressure(*level.matching(levels[0], x, y)) for level in levels])

    def _layer_tables(self, quantity: str, body: str) -> list[ChangeTable]:
        """The uncertainty of a field in the layers of a body, made at its first use."""
        key = quantity, body
        if key not in self._tables:
            solid, sliding = self._body.named(body), bool(self._body.friction)
            interfaces = [0.0, 0.0] if quantity == "pressure" else [0.0, *np.cumsum(solid.thickness), np.inf]
            of = partial(self._of_all_levels, quantity, body)
            self._tables[key] = ChangeTable.of(self._levels, of, interfaces, sliding)
        return self._tables[key]

    @cached_property
    def _tables(self) -> dict[tuple[str, str], list[ChangeTable]]:
        return {}

    def _uncertain_edge(self, solid: Body, points: Any) -> Array:
        """Change of the stress [Pa] by the uncertain radius, (3, 3) + points.

        Of a wider contact of this load, at fixed places or, in the frame "edge", at places that move with it;
        there by the move alone too, in the patches that the edge cuts as beside them. At fixed places within
        ``NEAR_EDGE`` patches of the edge, where it is not in proportion, by its largest move in any
        direction, out and in.
        """
        level, moves = self._level, at_edge(points)
        shift, reach = self._stated.contact_radius, self._uncertain_reach
        x, y, z, moves = np.broadcast_arrays(points.x, points.y, points.z, moves)
        patches = (np.hypot(self._to_edge(x, y), z) - reach) / self.diagnostics.patch_size
        to = (x, y)
        if moves.any():
            assert level.shape is not None
            along = level.shape.widened(shift).matching(level.shape, x, y)
            to = (np.where(moves, along[0], x), np.where(moves, along[1], y))
        asked = [(shift, to), (0.0, to)] if moves.any() else [(shift, to)]
        change, *by_move = fields.stress_changes(level, solid, asked, x, y, z, points.layer)
        cut = moves & (patches < numbers.CUT)
        for one in by_move:
            change = np.maximum(change, np.where(cut, 0.0, one))
        if cut.any():
            assert level.shape is not None
            at = self._out_of_cut(x[cut], y[cut], z[cut])
            moved = [(0.0, level.shape.widened(shift).matching(level.shape, *at))]
            (beside,) = fields.stress_changes(level, solid, moved, *at, z[cut], points.layer)
            change[..., cut] = np.maximum(change[..., cut], beside)
        if (fixed := (patches < numbers.NEAR_EDGE) & ~moves).any():
            at = x[fixed], y[fixed]
            out_and_in = [(one, at) for one in (-reach, reach) if one != shift]
            others = fields.stress_changes(level, solid, out_and_in, *at, z[fixed], points.layer)
            change[..., fixed] = np.maximum(change[..., fixed], others.max(axis=0))
        return change

    @cached_property
    def _uncertain_reach(self) -> float:
        """Uncertainty of the distance from centre to edge [m], the largest of all directions."""
        stated, shapes = self._stated.contact_radius, [level.shape for level in self._levels]
        if any(shape is None or shape.round for shape in shapes):
            return stated
        angle = 2 * np.pi * np.arange(64) / 64
        fine, second, third = (np.array(shape.on_ray(np.ones(64), angle)) for shape in shapes if shape)
        moved = [float(np.hypot(*change).max()) for change in (fine - second, second - third)]
        return max(
            stated,
            float(
                refined(
                    moved[0], moved[1], self._levels[0].grid.n / self._levels[1].grid.n, order_of(self._level)
                )
            )
            + self._level.edge_error,
        )

    def _out_of_cut(self, x: ArrayLike, y: ArrayLike, z: ArrayLike) -> tuple[Array, Array]:
        """The places [m], those in the patches that a smooth edge cuts moved out to beside these patches."""
        shape, reach = self._level.shape, self._uncertain_reach
        assert shape is not None
        widest = numbers.CUT * self.diagnostics.patch_size + reach
        return shape.away(x, y, np.sqrt(np.maximum(widest**2 - np.square(z), 0.0)))

    def _to_edge(self, x: ArrayLike, y: ArrayLike) -> Array:
        """Distance of points from a smooth edge [m], about."""
        shape = self._level.shape
        assert shape is not None
        return np.abs(1 - shape.share(x, y)) * min(shape.axes)

    def _patches_to_edge(self, x: ArrayLike, y: ArrayLike, z: ArrayLike) -> Array:
        """That distance in patches, at least one."""
        away = np.hypot(self._to_edge(x, y), z) / self.diagnostics.patch_size
        return np.asarray(np.maximum(away, 1.0))

    @property
    def _stated(self) -> Uncertainty:
        if self.uncertainty is None:
            raise ValueError("uncertainty was not estimated; solve with estimate_uncertainty=True")
        return self.uncertainty

    def _other(self, scalar: str, *left_out: str) -> float:
        """Uncertainty of a scalar by all numerical parameters but the size of the patches."""
        rows = self._stated.budget
        return sum(row[2] for row in rows if row[0] == scalar and row[1] not in ("patch size", *left_out))

    def _of_iteration(self, z: ArrayLike) -> Array:
        """Uncertainty of a stress [Pa] by the gap g that the iteration leaves.

        It changes the pressure by E* k g/2 at the wavenumber k, at the depth z by exp(-k z) of that: at most
        1/(e k z) of what the shortest waves on the patches, k = sqrt(2) pi/d, change at the surface.
        """
        k = 2**0.5 * np.pi / self.diagnostics.patch_size
        at_surface = self._other("peak_pressure", "edge", "conversion", "domain")
        return at_surface / np.maximum(1.0, np.e * k * np.asarray(z, dtype=float))


def at_edge(points: Any) -> BoolArray:
    """Which of the points keep their share of the way to the contact edge."""
    return np.asarray(np.asarray(points.frame) == "edge")
