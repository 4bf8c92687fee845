"""Contact on one grid of the nested iteration."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import RectBivariateSpline

from semianalytic import numbers
from semianalytic.coefficients import influence
from semianalytic.edge import smooth_edge
from semianalytic.edge.edge_shape import Shape
from semianalytic.edge.smooth_edge import EdgePatches
from semianalytic.inputs import Body, Numerics
from semianalytic.patches import contact, convolution, prescribed
from semianalytic.patches.grid import Grid, Window, prolong
from semianalytic.patches.prescribed import Prescribed
from semianalytic.stresses.rings import Disc, RingPressure, rings_of

Array = NDArray[np.floating]


@dataclass(frozen=True)
class Indenter:
    """Undeformed gap on a grid, and either the load [N] or the approach [m].

    round : the gap depends on the distance from the origin alone.  edge_correction : where the edge is
    smooth. The gap may be above any level; the approach counts from its lowest point, of the patches or,
    given x and y [m] on a grid, of what ``between`` them is [m].
    """

    gap: Callable[[Grid], Array]
    load: float | None
    approach: float | None
    round: bool
    edge_correction: bool = False
    between: Callable[[Array, Array], Array] | None = None


@dataclass(frozen=True)
class Level:
    """A contact on one grid; ``shape`` and the ``edge`` patches where its edge is a smooth curve.

    Both are None for the patches alone, and under a ``given`` pressure.

    noise : pressure [Pa] that the gap left by the iteration may cause on a patch.  unsettled : movement of a
    smooth edge [m] that further rounds of its correction would make.
    """

    grid: Grid
    found: contact.Contact
    load: float
    convolutions: int
    noise: float = 0.0
    shape: Shape | None = None
    edge: EdgePatches | None = None
    given: Prescribed | None = None
    unsettled: float = 0.0

    @property
    def radius(self) -> float:
        """Contact radius [m]: of the disc with the contact's area."""
        if self.shape is not None:
            return self.shape.radius
        if self.given is not None:
            return self.given.radius
        loaded = np.count_nonzero(self.grid.whole(self.found.pressure))
        return float(np.sqrt(loaded / np.pi) * self.grid.d)

    @property
    def edge_error(self) -> float:
        """Error of the radius [m] on this grid: of a smooth edge, what its shape misses and rounds leave.

        Of patches alone a quarter of a patch all along the edge, whose length is that of the staircase times
        pi/4, its mean over all directions (Cauchy-Crofton). A smooth edge is not known worse, nor better on a
        film of few patches where the contact has few.
        """
        d, loaded = self.grid.d, self.grid.whole(self.found.pressure) > 0
        touching = replace(self.grid, quarter=False).ringed(loaded)
        edges = sum(int(np.count_nonzero(np.diff(touching, axis=axis))) for axis in (0, 1))
        stairs = float(np.pi / 4 * edges * d * 0.25 * d / (2 * np.pi * self.radius))
        if self.shape is None:
            return stairs
        patch = d / min(self.shape.axes)
        thin = self.shape.layer < numbers.LAYER * numbers.NARROW_EDGE * patch
        few = thin and patch * numbers.FEW_FOR_EDGE > 1
        return self.unsettled + (stairs if few else min(stairs, self.radius * self.edge_misfit))

    @cached_property
    def edge_misfit(self) -> float:
        """Share of the way to a smooth edge by which the pressures of the patches beside it deny its shape.

        There p is as the square root of the distance x: one that is off by dp at x belongs to an edge that is
        off by 2 x dp/p. The largest of all patches over which the shape was fitted to the edge.
        """
        assert self.shape is not None
        p, f = self.found.pressure, replace(self.shape, outside=False)
        centres = self.grid.x[:, None], self.grid.x[None, :]
        patch, away = self.grid.d / min(self.shape.axes), 1 - self.shape.share(*centres)
        farthest = max(numbers.NARROW_EDGE * patch, numbers.FADED_INSIDE[0] / 2)
        near = (p > 0) & (away > numbers.CUT * patch) & (away < farthest)
        off = np.abs(p - f.pressure(*centres))[near] / p[near]
        return float(np.max(2 * off * away[near], initial=0.0))

    @property
    def load_at_edge(self) -> float:
        """Mean square of the pressure on the outermost loaded patches, over that of the peak.

        The approach changes with the place of an edge as the square of the pressure there: not at a smooth
        edge, in proportion to the radius at that of a flat punch.
        """
        p = self.grid.whole(self.found.pressure)
        loaded = np.pad(p > 0, 1)
        inner = loaded[2:, 1:-1] & loaded[:-2, 1:-1] & loaded[1:-1, 2:] & loaded[1:-1, :-2]
        return float(np.mean(p[(p > 0) & ~inner] ** 2) / p.max() ** 2)

    def of_edge(self, unseen: float = 0.0) -> dict[str, float]:
        """Effect of an edge that its own grid leaves uncertain: between centres of patches, or a staircase.

        unseen : by how much [m] patches of this size may misplace it on every grid.

        The approach is stationary in the contact's area: it changes as the square of the pressure where the
        edge may be, which is of the second order at a smooth edge and of the first at that of a punch.
        Patches that a smooth edge cuts leave ``SECOND`` times the square of their share of the radius.
        """
        error, shape, left, at_edge = self.edge_error + unseen, self.shape, 0.0, self.load_at_edge
        moved = error / self.radius
        peak = self.scalars["peak_pressure"]
        if shape is not None:
            left = numbers.SECOND * (self.grid.d / min(shape.axes)) ** 2
            p = shape.pressure(*shape.on_ray(max(1 - moved, 0.0), np.pi / 4 * np.arange(8)))
            at_edge = float(np.mean(p**2)) / 2 / peak**2
        of_peak = left + moved**2 + 2 * self.unsettled / self.radius if shape is not None else 0.0
        return {
            "contact_radius": error,
            "approach": self.found.approach * (left + at_edge * moved + moved**2),
            "peak_pressure": peak * of_peak,
        }

    @property
    def whole(self) -> "Level":
        """Level on all the patches, not a quarter of them."""
        whole, found = self.grid.whole, self.found
        found = replace(found, pressure=whole(found.pressure), gap=whole(found.gap))
        return replace(self, grid=replace(self.grid, quarter=False), found=found)

    @cached_property
    def scalars(self) -> dict[str, float]:
        peak = float(np.max(self.found.pressure))
        if self.shape is not None:  # continued between the centres of the patches
            peak += _above_highest(self.grid.whole(self.found.pressure))
        return {"contact_radius": self.radius, "approach": self.found.approach, "peak_pressure": peak}

    @cached_property
    def mean(self) -> Array:
        """Pressure averaged over the patches [Pa], those the edge cuts included: the whole load."""
        if self.given is not None:
            return prescribed.patch_mean(self.given, self.grid.x, self.grid.d)
        if self.edge is None:
            return self.found.pressure
        return smooth_edge.patch_mean(self.edge, self.found.pressure, self.grid)

    @cached_property
    def unbalanced(self) -> float:
        """Share of the load by which the pressure that fields are computed from is out of balance.

        The load is in balance on the patches; ``shape`` is fitted to their pressures, and with ``rest`` it is
        only as good as the fit.
        """
        smooth = self.smooth()
        if smooth is None:
            return 0.0
        rings = smooth.rings(np.zeros(1), np.zeros(1), np.array([self.radius]))
        carried = float(rings.weight @ rings.harmonics[0])
        if self.rest is not None:
            carried += self.grid.force(self.rest)
        return abs(carried / self.load - 1)

    @cached_property
    def ripple(self) -> float:
        """Root mean square of the patches' pressure less that of the shape [Pa], where they meet inside."""
        if self.edge is None:
            return 0.0
        edge, inner = self.edge, self.edge.inner
        rest = (self.found.pressure[edge.i, edge.j] - edge.centre)[inner]
        return float(np.sqrt(np.mean(rest**2))) if rest.size else 0.0

    @cached_property
    def misfit(self) -> float:
        """Largest difference of the pressure of the patches from that of the shape [Pa], far from the edge.

        What the polynomials of the shape leave out, on every grid. 0 where ``rest`` holds it.
        """
        if self.shape is None or self.rest is not None:
            return 0.0
        x, y = self.grid.x[:, None], self.grid.x[None, :]
        deep = self.shape.inside(x, y) > numbers.FAR_INSIDE
        miss = np.abs(self.found.pressure - self.shape.pressure(x, y))[deep]
        return float(miss.max(initial=0.0))

    @property
    def nodes(self) -> Array:
        """Centres of all patches along one axis [m], (n,)."""
        return replace(self.grid, quarter=False).x

    def smooth(self, coarser: int = 0) -> RingPressure | None:
        """The pressure with a smooth edge, on fewer rings where ``coarser``; None of patches alone."""
        if self.given is not None:
            return Disc(self.given.radius, self.given.of_square, 24 - 4 * coarser, 10 - coarser)
        return None if self.shape is None else rings_of(self.shape, coarser)

    def matching(self, first: "Level", x: Array, y: Array) -> tuple[Array, Array]:
        """Points [m] as far from this smooth edge as x and y [m] are from that of the ``first`` level."""
        if self.shape is None or first.shape is None:
            return x, y
        return self.shape.matching(first.shape, x, y)

    def pressure(self, x: ArrayLike, y: ArrayLike) -> Array:
        """Contact pressure [Pa], 0 outside; as `Solution.pressure`."""
        smooth, pressure = self.smooth(), self.grid.whole(self.found.pressure)
        if smooth is None:
            touched = interpolated(self.nodes, pressure**2, x, y, order=1) > 0  # the cubic may ripple beyond
            square = interpolated(self.nodes, pressure**2, x, y)
            return np.sqrt(np.maximum(np.where(touched, square, 0), 0))
        value = smooth.pressure(x, y)
        if self.rest is not None and self.shape is not None:  # its interpolation ripples beyond the edge
            rest = interpolated(self.nodes, self.grid.whole(self.rest), x, y)
            value = value + np.where(self.shape.inside(np.asarray(x), np.asarray(y)) > 0, rest, 0.0)
        return self.regular(np.maximum(value, 0), x, y, 0.0)

    def regular(self, value: Array, x: ArrayLike, y: ArrayLike, z: ArrayLike) -> Array:
        """``value`` at points [m], or NaN where a given pressure jumps, which leaves none."""
        return value if self.given is None else np.where(self.given.is_singular(x, y, z), np.nan, value)

    @cached_property
    def rest(self) -> Array | None:
        """Pressure of the patches less that of the shape [Pa], inside; None where it is their own error.

        Patches within a few of the edge err by some 1e-4 of the peak, which the fit of the shape averages.
        """
        if self.shape is None or self.edge is None:
            return None
        x, p, edge = self.grid.x, self.found.pressure, self.edge
        rest = p - self.shape.pressure(x[:, None], x[None, :])
        # in the patches at the edge, less what the parts carry of the shape
        rest[edge.i, edge.j] += edge.centre - p[edge.i, edge.j]
        rest[self.found.pressure <= 0] = 0.0
        return rest if np.abs(rest).max() > numbers.RIPPLE * self.found.pressure.max() else None


@dataclass(frozen=True, eq=False)
class LevelProblem:
    """Contact problem of the indenter on a window of the grid.

    gap [m] : on the window, above the level ``datum``.  depth [m] : the largest on the grid above that.
    before : level that gives the first guess, None for one from the gap.
    """

    grid: Grid
    gap: Array
    depth: float
    window: Window
    before: Level | None
    indenter: Indenter
    body: Body
    numerics: Numerics
    datum: float = 0.0

    @cached_property
    def _kernel(self) -> Array:
        nx, ny = self.grid.across(self.window).shape
        return influence.surface_coefficients(max(nx, ny), self.grid.d, self.body, self.numerics)[:nx, :ny]

    @cached_property
    def deflection(self) -> contact.Operator:
        """u = A p on the window."""
        return convolution.even_convolution(
            self._kernel, quarter=self.grid.quarter, threads=self.numerics.threads
        )

    @cached_property
    def precondition(self) -> contact.Operator:
        """An approximate inverse of A."""
        return convolution.circulant_inverse(
            self._kernel, quarter=self.grid.quarter, threads=self.numerics.threads
        )

    @cached_property
    def of_half_space(self) -> contact.Operator:
        """An inverse of A without layers, in proportion to k: the cut at the edge does it no harm."""
        nx, ny = self.grid.across(self.window).shape
        uncoated = Body((), self.body.substrate, friction=0.0)
        kernel = influence.surface_coefficients(max(nx, ny), self.grid.d, uncoated, self.numerics)[:nx, :ny]
        return convolution.circulant_inverse(kernel, quarter=self.grid.quarter, threads=self.numerics.threads)

    def solve(self, defect: Array | float = 0.0, missing: float = 0.0, start: Array | None = None) -> Level:
        """Contact with ``defect`` [m] added to the gap and ``missing`` [N] of the load not on the patches.

        start : first guess of the pressure [Pa], None for `first_guess`.
        """
        grid, before, indenter = self.grid, self.before, self.indenter
        scale = indenter.approach or (before.found.approach if before else self.depth)
        # a flat punch has no depth; its approach is this to a factor of order one
        scale = scale or (indenter.load or 0.0) / (self.body.contact_modulus * grid.half_width)
        problem = contact.Problem(
            self.deflection,
            self.gap + defect,
            total=None if indenter.load is None else (indenter.load - missing) / grid.d**2,
            approach=None if indenter.approach is None else indenter.approach + self.datum,
            start=self.first_guess if start is None else start.copy,
            precondition=self.precondition,
            of_half_space=lambda r: self.of_half_space(r),  # few contacts need it
            scale=scale,
            tolerance=self.numerics.tolerance,
            max_iterations=self.numerics.max_iterations,
            extension=_extension(self.body, grid.d),
            weight=grid.weight(self.gap.shape),
            mirror="mirror" if grid.n % 2 else "reflect",
        )
        found = contact.solve(problem)
        found = replace(found, approach=found.approach - self.datum)
        load = grid.force(found.pressure) + missing
        # p = E* k u / 2, k at most that of a checkerboard, sqrt(2) pi / d
        noise = self.numerics.tolerance * scale * self.body.contact_modulus * np.pi / 2**0.5 / grid.d
        return Level(grid, found, load, found.convolutions, noise)

    @property
    def centres(self) -> tuple[Array, Array]:
        """x and y of the patches of the window [m], (nx, 1) and (1, ny)."""
        rows, columns = self.window.slices
        return self.grid.x[rows][:, None], self.grid.x[columns][None, :]

    def first_guess(self) -> Array:
        """Pressure [Pa] from the level before, or from the gap."""
        before = self.before
        if before is None:
            approach = self.indenter.approach or 0.25 * self.depth
            return self.precondition(np.maximum(np.min(self.gap) + approach - self.gap, 0.0))
        p, g, E_star = before.found.pressure, before.found.gap, self.body.contact_modulus
        return prolong(p, g, before.grid, self.grid, self.window, E_star)


def interpolated(nodes: Array, values: Array, x: ArrayLike, y: ArrayLike, order: int = 3) -> Array:
    """Spline through the values at the nodes, 0 outside them."""
    x, y = np.broadcast_arrays(np.asarray(x, dtype=float), np.asarray(y, dtype=float))
    inside = np.maximum(np.abs(x), np.abs(y)) <= nodes[-1] * (1 + 1e-12)
    value = np.zeros(x.shape)
    spline = RectBivariateSpline(nodes, nodes, values, kx=order, ky=order)
    value[inside] = spline(x[inside], y[inside], grid=False)
    return value


def _above_highest(p: Array) -> float:
    """Height of a maximum of p between the patch centres above the highest of them, 0 at a tip.

    By differences of second order: g . H^-1 g / 2, g the slope and -H the second derivatives.
    """
    i, j = divmod(int(np.argmax(p)), p.shape[1])
    q = p[max(i - 1, 0) : i + 2, max(j - 1, 0) : j + 2]
    if q.shape != (3, 3) or not (q > 0).all():
        return 0.0
    slope = np.array([q[2, 1] - q[0, 1], q[1, 2] - q[1, 0]]) / 2
    cross = (q[2, 0] + q[0, 2] - q[0, 0] - q[2, 2]) / 4
    curvature, axes = np.linalg.eigh(
        [[2 * q[1, 1] - q[0, 1] - q[2, 1], cross], [cross, 2 * q[1, 1] - q[1, 0] - q[1, 2]]]
    )
    curved = curvature > 0.02 * curvature[1]  # not along a ridge, such as a ring of highest pressure
    return float(np.sum((slope @ axes)[curved] ** 2 / (2 * curvature[curved])))


def _extension(body: Body, d: float) -> float:
    """Patches over which the residual is extended: fewer where a stiff coating is a few patches thick.

    Measured: a third of it reduces five iterations to four where E1/E2 = 10, h = 3 d.
    """
    stiff = [one.thickness[0] for one in body.pair if one.coatings and one.moduli[0] > one.moduli[1]]
    return min([numbers.EXTENSION, *(max(1.0, 0.3 * h / d) for h in stiff)])
