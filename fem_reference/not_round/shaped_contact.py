"""Contact of an indenter that is no sphere, by the compliance of finite elements.

Contour and pressure are found from Hertz's ellipse of the bare bodies on (``gap_closing``): on a rough mesh,
which tells how far the contact reaches, then on the mesh and on a coarser companion, by pressures of several
degrees.
"""

import time
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from fem_reference import element_numbers as chosen
from fem_reference.element_answer import ElementAnswer, ElementPoints, ElementUncertainty
from fem_reference.meshing.mesh import surface_size
from fem_reference.not_round.gap_closing import BY_CONDITIONS, Closed, OnTwoMeshes, as_rich_as_helps, closed
from fem_reference.not_round.harmonic_compliance import harmonic_compliance
from fem_reference.not_round.indenter_height import Height, Indenter, touching_shape
from fem_reference.not_round.off_axis import OffAxisFields, PressedSolid, discretised
from fem_reference.not_round.star_contact import StarPressure, hertz_axes
from fem_reference.not_round.star_estimate import StarEstimate, by_degree
from fem_reference.scaling import Coatings, LayeredSolid, Scales
from fem_reference.validation import (
    check_ball,
    check_choice,
    check_materials,
    check_positive,
    check_proportions,
)


@dataclass(frozen=True)
class ShapedGrid:
    """Size of the triangles, the last harmonic, and how the mesh is wider than the contact."""

    size: float
    surface: float
    harmonics: int
    margin: float
    density: float


ROUGH = ShapedGrid(*chosen.ROUGH_GRID, chosen.DENSITY / 2)


@dataclass(frozen=True)
class ShapedDiagnostics:
    """How the contact was reached.

    steps : corrections of the pressure.  harmonics : the last one.  dofs, triangles : of the finer mesh
    residual_gap : root mean square, weighted with the pressure, of the gap inside over the approach
    residual_load : relative error of the load
    """

    steps: int
    harmonics: int
    dofs: int
    triangles: int
    residual_gap: float
    residual_load: float
    seconds: float


@dataclass(frozen=True, eq=False)
class ShapedContact(PressedSolid):
    """Contact under an indenter of any shape, even in y; x along sliding, z into the solid, SI.

    contact_radius : of the disc of the contact's area.  extent_x, extent_y : largest x and y of the contact
    uncertainty : of contact radius, approach, peak pressure.  extent_uncertainty : of either extent
    estimate : of the pressure; the fields of the companion have the next lower degree
    typical : change of the stress [Pa] from the companion below the contact: it is small by chance at points
    opposite : this contact with the fields of the elastic ball, None where that is rigid
    """

    contact_radius: float
    approach: float
    peak_pressure: float
    extent_x: float
    extent_y: float
    surface_nodes: np.ndarray
    diagnostics: ShapedDiagnostics
    uncertainty: ElementUncertainty | None
    extent_uncertainty: tuple[float, float] | None
    height: Height = field(repr=False)
    estimate: StarEstimate | None = field(default=None, repr=False)
    typical: float = 0.0
    opposite: "ShapedContact | None" = field(default=None, repr=False)
    frames: ClassVar = ("fixed", "edge")  # in which uncertainties are estimated
    coarser: ClassVar = None  # the companion is no solution of its own

    def sample(self, points: Any, quantity: str, uncertainty: bool = True) -> ElementAnswer:
        """Value of a quantity at points, with its uncertainty when it was estimated.

        Arguments as of ``PressedSolid.sample``; a scalar is contact_radius, approach, peak_pressure, extent_x
        or extent_y. The stress has the error of the pressure too, on the surface where it acts, the
        displacement that of the approach.
        """
        stated = uncertainty and self.uncertainty is not None and self._coarse is not None
        scalars = ("contact_radius", "approach", "peak_pressure", "extent_x", "extent_y")
        if quantity in scalars:
            return ElementAnswer(
                getattr(self, quantity), self._errors[scalars.index(quantity)] if stated else None
            )
        if quantity == "pressure":
            return self._pressure(points, stated)
        if getattr(points, "body", "flat") == "ball" and self.opposite is not None:
            on_ball = ElementPoints(points.x, points.y, points.z, points.layer, "flat", points.frame)
            return self.opposite.sample(on_ball, quantity, uncertainty)
        value, U = super().sample(points, quantity, stated)
        if not stated or U is None:
            return ElementAnswer(value)
        if quantity == "displacement":
            return ElementAnswer(value, U + self._errors[1])
        x, y = points.x, points.y
        smeared = np.where(np.asarray(points.z) == 0, self._smeared(x, y), 0.0)
        distance = np.hypot(x, y) / (chosen.AXIS_SAFETY[1] * self._units.length)
        safety = chosen.OF_FIELDS * (1 + (chosen.AXIS_SAFETY[0] - 1) * np.maximum(1 - distance, 0))
        # beside an edge the stress along the surface is that of plane strain, -p inside and 2 f p outside
        assert self.estimate is not None
        by_pressure = self.estimate.of_stress(*self._scaled(x, y, points.z)) * self._units.pressure
        of_pressure = (1 + 2 * abs(self._fine.friction)) * by_pressure
        change = np.maximum(safety * U, chosen.OF_FIELDS * self.typical)
        return ElementAnswer(value, np.maximum(change, of_pressure) + self._errors[2] + smeared)

    @cached_property
    def _errors(self) -> tuple[float, ...]:
        """Uncertainties of contact radius, approach, peak pressure (no less than there) and both extents."""
        one, extents = self.uncertainty, self.extent_uncertainty
        assert one is not None
        assert extents is not None
        assert self.estimate is not None
        there = self.estimate.of_pressure(np.array([self._fine.pressure.centre]), np.zeros(1))
        peak = max(one.peak_pressure, float(there[0]) * self._units.pressure)
        return (one.contact_radius, one.approach, peak, *extents)

    def _smeared(self, x: Any, y: Any) -> np.ndarray:
        """Stress on the surface [Pa] that the elements may smear where the pressure has its root.

        Along the surface the strain below a pressure is -(1 + nu)(1 - 2 nu)/E of it, so the stress changes by
        (1 - 2 nu)/(1 - nu) of what the pressure differs from the cubic through its values a share `RESOLVED`
        of an element's width and twice that on either side, or in y a fourth and half of the shortest wave.
        On the series at an edge it does not.
        """
        x, y = np.broadcast_arrays(np.asarray(x, dtype=float), np.asarray(y, dtype=float))
        fields, length = self._fine, self._units.length
        edges = np.array(fields.pressure.edges) * length
        away = np.abs(np.hypot(x, y)[..., None] - np.abs(edges)).min(axis=-1)
        size = surface_size(fields.surface, away / length)
        h = length * np.maximum(chosen.RESOLVED * size, fields.least / 3)
        k = np.maximum(h, np.hypot(x, y) * np.pi / (2 * fields.last))
        nu = fields.solid.materials[0][1]
        on_series = (y == 0) & (away < length * chosen.WITHIN * fields.least)
        missed = []
        for i, j in ((h, 0 * h), (0 * k, k)):
            for beside in (-0.5, 0.0, 0.5):  # it changes sign next to the edge
                p, near, far = (
                    self.pressure(x + (beside + step) * i, y + (beside + step) * j)
                    + self.pressure(x + (beside - step) * i, y + (beside - step) * j)
                    for step in (0, 1, 2)
                )
                missed.append(np.abs((4 * near - far) / 6 - p / 2))
        return np.where(on_series, 0.0, (1 - 2 * nu) / (1 - nu) * np.max(missed, axis=0))

    def _pressure(self, points: Any, stated: bool) -> ElementAnswer:
        """Pressure [Pa], uncertain by the changes as far from the edge and, at fixed points, there too."""
        p = self._given(points)
        if not stated or self.estimate is None:
            return ElementAnswer(p)
        U = self.estimate.of_pressure(*self._scaled(points.x, points.y)) * self._units.pressure
        there = self.estimate.of_values(lambda one: self._other(points, one))
        return ElementAnswer(p, np.maximum(there, U))

    def _scaled(self, *coordinates: Any) -> tuple[np.ndarray, ...]:
        return tuple(np.asarray(one) / self._units.length for one in coordinates)

    def _other(self, points: Any, pressure: StarPressure) -> np.ndarray:
        """Another pressure [Pa] at the points that are compared."""
        x, y = self._scaled(*self._matching(points, pressure))
        return np.asarray(pressure(x, y) * self._units.pressure)

    def _matching(self, points: Any, other: StarPressure) -> tuple[Any, Any]:
        """Points [m] of the ``other`` pressure that are compared with x, y."""
        x, y = np.broadcast_arrays(np.asarray(points.x, dtype=float), np.asarray(points.y, dtype=float))
        at_edge = np.asarray(points.frame) == "edge"
        if not at_edge.any():
            return x, y
        L = self._units.length
        X, Y = self._fine.pressure.matching(other, x / L, y / L)
        return np.where(at_edge, L * X, x), np.where(at_edge, L * Y, y)


def solve_shape(
    *,
    indenter: Indenter,
    radius: float,
    load: float,
    coatings: Coatings,
    substrate: tuple[float, float],
    friction: float = 0.0,
    ball: tuple[float, float, Coatings] | None = None,
    quality: str = "default",
    harmonics: int | None = None,
    order: int = 4,
    size: float | None = None,
    surface: float | None = None,
    far: float = 1000.0,
    degree: int | None = None,
    first: float = 1.0,
    estimate_uncertainty: bool = True,
) -> ShapedContact:
    """Indenter of another shape than a sphere on a coated half-space, as in ``solve``.

    indenter : shape and numbers, see ``touching_shape``.   ball : the solid of an elastic one
    size, surface : of the triangles over their distance from the contact; on the surface below it over its
    extent.  quality : "fast", "default" or "fine"; sets size, surface and harmonics that are not given, more
    of them for a contact with pointed ends on y = 0, smaller triangles below one longer than ``SLENDER``
    degree : of the polynomial in the pressure.   first : axes of the first contact over Hertz's
    Raises ValueError for bad input, ElementsNotConverged where no such contact is found.
    """
    began = time.perf_counter()
    check_choice("quality", quality, tuple(chosen.SHAPED_QUALITY))
    usual, default = (chosen.SHAPED_QUALITY[one] for one in (quality, "default"))
    size = usual[0] if size is None else size
    check_positive(radius=radius, load=load, far=far, size=size, first=first)
    check_materials(coatings, substrate, friction)
    check_choice("order", order, (2, 3, 4))
    if ball is not None:
        check_ball(ball)
    shape = touching_shape(indenter, radius)
    E = substrate[0]
    layers = [(coatings, substrate)] + ([(ball[2], ball[:2])] if ball else [])
    compliance = sum((1 - nu**2) / modulus for _, (modulus, nu) in layers)
    axes = hertz_axes(shape.curvatures, load / 2 if shape.centre else load, compliance)
    # the width of a long contact is a small share of its extent, and of the circle around its end
    slender = max(1.0, max(axes) / min(axes) / chosen.SLENDER)
    surface = usual[1] / slender**0.5 if surface is None else surface
    check_positive(surface=surface)
    rough_grid = replace(ROUGH, surface=ROUGH.surface / slender, harmonics=int(ROUGH.harmonics * slender))
    begin = StarPressure.of_ellipse(
        shape.centre, (first * axes[0], first * axes[1]), load / E, shape.fold, chosen.ROUGH_DEGREE
    )
    least = usual[3] * max(shape.fold, 2) if degree is None else degree
    most = 2 * least if degree is None else degree

    def on_mesh(reach: float, grid: ShapedGrid, begin: StarPressure, enough: float) -> Closed:
        """The contact [reach] on a mesh to the radius ``reach`` [m]."""
        start = begin.scaled(reach)
        # vertices at the radii of the edge on y = 0 and of its sides, none right beside another
        radii = sorted({round(abs(x), 4) for x in (*start.edges, start.extents[1])})
        pairs = zip(radii, [0.0, *radii], strict=False) if grid is not rough_grid else ()
        apart = tuple(r for r, before in pairs if r - before > grid.surface / 10)
        scaled = [LayeredSolid.scaled(*one, reach, far, E) for one in layers]
        bodies = [replace(one, far=max(each.far for each in scaled)) for one in scaled]
        for one, name in zip(bodies, ("", "ball "), strict=False):
            check_proportions(one.thicknesses, "the contact's extent", name)
        # graded as if no interface were nearer than a triangle of the surface is wide
        depths = (np.maximum(np.cumsum(one.thicknesses), grid.surface) for one in bodies)
        stacks = tuple(tuple(np.diff(of, prepend=0.0).tolist()) for of in depths)
        inner = max(0.0, start.reach[0] - (grid.margin - 1))
        made = {}
        for one in dict.fromkeys(bodies):  # two bodies of the same layers are one
            d = discretised(one, grid.size, grid.surface, order, growth=0.7, edges=apart, stacks=stacks)
            made[one] = harmonic_compliance(one, d, grid.harmonics, shape.turns, grid.density, inner)
        height, last = shape.scaled(reach), min(int(chosen.CORRECTING * slender), grid.harmonics)
        return closed(tuple(made[one] for one in bodies), start, height, load / (E * reach**2), last, enough)

    for _ in range(chosen.MOST_STEPS):
        reach = ROUGH.margin * begin.reach[1]
        rough = on_mesh(reach, rough_grid, begin, chosen.EDGE_CLOSE)
        begin = rough.pressure.scaled(1 / reach)
        if rough.converged:
            break
    rough.check_rest(indenter[0])
    # six digits, lest the mesh follow the rounding
    reach = float(f"{chosen.MARGIN * begin.reach[1]:.6g}")
    if harmonics is None:
        at_end = np.pi / begin.scaled(reach).end_angle(float(surface_size(surface, 0.0)))
        turns = usual[2] / shape.turns * max(1.0, chosen.AT_END * at_end / default[2])
        harmonics = shape.turns * int(np.ceil(turns))
    check_positive(harmonics=harmonics)
    unit = Scales(length=reach, pressure=E, modulus=E)

    grid = ShapedGrid(size, surface, harmonics, chosen.MARGIN, chosen.DENSITY)
    r = chosen.SHAPED_COARSER
    coarser = replace(grid, size=r * size, surface=r * surface, density=grid.density / r)
    first_found = on_mesh(reach, grid, begin.of_degree(least), chosen.EDGE_SIZE)
    first_found.check(indenter[0])
    companion_first = on_mesh(reach, coarser, first_found.pressure.scaled(1 / reach), chosen.EDGE_SIZE)
    both, others = as_rich_as_helps(OnTwoMeshes(first_found, companion_first), most)
    found = both.found
    found.check(indenter[0])
    numbers, units = _numbers(found), np.array([reach, reach, E, reach, reach])
    fine = _fields(found, friction, surface)
    coarse: Sequence[OffAxisFields | None] = [None] * len(layers)
    uncertainty, extents, estimate = None, None, None
    if estimate_uncertainty:
        companion, (lower, *beyond) = both.companion, others
        richer = tuple((one.found, one.companion) for one in beyond)
        pairs = tuple((one.pressure, on_companion.pressure) for one, on_companion in richer)
        estimate = StarEstimate(found.pressure, companion.pressure, lower.found.pressure, pairs)
        coarse = _fields(lower.companion, friction, r * surface)
        of_mesh = _change(found, companion)
        change = BY_CONDITIONS * of_mesh
        change[1] = max(change[1], chosen.STIFF * slender * (size / default[0]) ** 4 * numbers[1])
        to_richer = ((_change(found, one), _change(one, on_companion)) for one, on_companion in richer)
        cut = by_degree(_change(found, lower.found), of_mesh, to_richer)
        left = np.maximum(found.residual, chosen.OF_FIELDS * found.errors) * np.abs(numbers)
        left[1] = max(left[1], abs(found.missed))
        names = ("contact_radius", "approach", "peak_pressure")
        parts = (("element size", change), ("degree of the pressure", cut), ("gap left", left))
        budget = tuple(
            (name, what, float(part[k] * units[k])) for k, name in enumerate(names) for what, part in parts
        )
        total = np.sqrt(sum(part**2 for _, part in parts)) * units
        uncertainty = ElementUncertainty(float(total[0]), float(total[1]), float(total[2]), budget)
        # no extent is better known than the contact radius: the edge may be at rest at its ends by chance
        ends = np.maximum(total[3:], total[0] / numbers[0] * numbers[3:])
        extents = float(ends[0]), float(ends[1])
    d, load_error = fine[0].discretisation, abs(fine[0].load * unit.load / load - 1)
    reached = 3 * d.N, int(d.mesh.layer.size), found.residual, load_error, time.perf_counter() - began
    nodes = np.linspace(0, 2.6 * found.pressure.extents[0], 160)
    scalars: tuple[float, float, float, float, float] = tuple((numbers * units).tolist())
    sides: list[ShapedContact] = []
    for k in range(len(layers))[::-1]:
        pair = fine[k], coarse[k]
        sides.append(
            ShapedContact(
                *pair,
                unit,
                *scalars,
                surface_nodes=np.concatenate([-nodes[:0:-1], nodes]) * reach,
                diagnostics=ShapedDiagnostics(rough.steps + found.steps, harmonics, *reached),
                uncertainty=uncertainty,
                extent_uncertainty=extents,
                height=shape.height,
                estimate=estimate,
                typical=_typical(PressedSolid(*pair, unit)) if estimate_uncertainty else 0.0,
                opposite=sides[0] if sides else None,
            )
        )
    return sides[-1]


def _fields(found: Closed, friction: float, surface: float) -> list[OffAxisFields]:
    """Fields of each body; traction acts on the second in -x."""
    first, *others = found.compliances
    fields = [OffAxisFields.of(first, found.nodal_loads, friction, found.pressure, surface)]
    for one in others:
        same, of = one is first and one.fold % 2 == 0, (-friction, found.pressure, surface)
        fields.append(fields[0].turned if same else OffAxisFields.of(one, found.nodal_loads, *of))
    return fields


def _typical(solid: PressedSolid) -> float:
    """Change of the stress [Pa] from the companion, exceeded at few points below the contact."""
    shares = ((np.arange(n) + at) / n for n, at in zip(chosen.TYPICAL_POINTS, (0.4, 0.3, 0.0), strict=True))
    r, turn, z = np.meshgrid(*shares)
    x, y, z = solid._units.length * np.array([r * np.cos(np.pi * turn), r * np.sin(np.pi * turn), 0.1 + z])
    _, U = solid.sample(ElementPoints(x, y, z), "stress")
    return float(np.percentile(U[0, 0], chosen.TYPICAL))


def _change(one: Closed, other: Closed) -> np.ndarray:
    """Changes of the numbers; in that of the area parts of the edge do not make up for each other."""
    change = np.abs(_numbers(one) - _numbers(other))
    change[0] = one.moved(other) * _numbers(one)[0]
    return np.asarray(change)


def _numbers(found: Closed) -> np.ndarray:
    """Contact radius, approach, peak pressure, extents; scaled."""
    p = found.pressure
    return np.array([np.sqrt(p.area / np.pi), found.approach + found.missed, p.peak, *p.extents])
