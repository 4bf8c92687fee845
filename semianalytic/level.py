"""Contact on one grid of the nested iteration."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from semianalytic import abel, contact, convolution, edge_profile, influence, smooth_edge
from semianalytic.arrays import copy, namespace, to_numpy
from semianalytic.grid import Grid, Window, prolong
from semianalytic.inputs import Body, Numerics

__all__ = ["Indenter", "Level", "LevelProblem"]

Array = NDArray[np.floating]

SINGLE = 2**20  # patches, above which preconditioner and steps are of single precision,
LOOSE = 1e-8  # at this tolerance or above: the iterations were measured to be as many; at 1e-12 more


@dataclass(frozen=True)
class Indenter:
    """Undeformed gap on a grid, and either the load [N] or the approach [m].

    round : axisymmetric with a smooth edge.  shapes : edge profiles of the contact, the finest first.
    table : of the layers, for their deflection.  edge_correction : of others, where their edge is smooth.
    Their gap may be above any level; the approach counts from its lowest point, of the patches or, given x
    and y [m] on a grid, of what ``between`` them is [m].
    """

    gap: Callable[[Grid], Array]
    load: float | None
    approach: float | None
    round: bool
    shapes: tuple[edge_profile.Profile, ...] = ()
    table: abel.LayerTable | None = None
    edge_correction: bool = False
    between: Callable[[Array, Array], Array] | None = None


@dataclass(frozen=True)
class Level:
    """A contact on one grid; ``shape`` is the edge profile that corrects it, ``edge`` a smooth edge.

    Both are None for the patches alone.

    noise : pressure [Pa] that the gap left by the iteration may cause on a patch.
    """

    grid: Grid
    found: contact.Contact
    shape: edge_profile.Profile | edge_profile.Prescribed | None
    load: float
    convolutions: int
    noise: float = 0.0
    edge: smooth_edge.Edge | None = None

    @property
    def radius(self) -> float:
        if self.shape is not None:
            return self.shape.radius
        if self.edge is not None:
            return float(np.sqrt(self.edge.area / np.pi) * self.grid.d)
        loaded = self.grid.count(self.found.pressure > 0)
        return float(np.sqrt(loaded / np.pi) * self.grid.d)

    @property
    def staircase(self) -> float:
        """A quarter of a patch all along the edge, as an error of the radius [m]; 0 with an edge profile.

        Of a smooth edge its misfit, in place of a quarter.

        The perimeter is that of the staircase times pi/4, its mean over all directions (Cauchy-Crofton).
        """
        if self.shape is not None:
            return 0.0
        share = 0.25 if self.edge is None else self.edge.misfit
        whole, count = self.grid.whole(self.found.pressure), namespace(self.found.pressure).count_nonzero
        touching = replace(self.grid, quarter=False).ringed(whole > 0)
        edges = int(count(touching[1:, :] ^ touching[:-1, :])) + int(
            count(touching[:, 1:] ^ touching[:, :-1])
        )
        return float(np.pi / 4 * edges * self.grid.d * share * self.grid.d / (2 * np.pi * self.radius))

    @property
    def whole(self) -> "Level":
        """The same contact on all the patches."""
        whole, found = self.grid.whole, self.found
        found = replace(found, pressure=whole(found.pressure), gap=whole(found.gap))
        return replace(self, grid=replace(self.grid, quarter=False), found=found)

    @property
    def in_numpy(self) -> "Level":
        """The same contact in arrays of NumPy."""
        found = self.found
        if isinstance(found.pressure, np.ndarray):
            return self
        found = replace(found, pressure=to_numpy(found.pressure), gap=to_numpy(found.gap))
        return replace(self, found=found)

    @cached_property
    def scalars(self) -> dict[str, float]:
        return {
            "contact_radius": self.radius,
            "approach": self.found.approach,
            "peak_pressure": self._peak,
        }

    @property
    def _peak(self) -> float:
        """Of the patches; a ring of highest pressure between their centres is that of the edge profile."""
        peak = float(namespace(self.found.pressure).max(self.found.pressure))
        if isinstance(self.shape, edge_profile.Profile):
            peak = self.shape.peak
            if self.rest.any():
                on_patches = self.shape.pressure(self.grid.radius)
                peak += float((on_patches + self.rest).max() - on_patches.max())
        elif self.edge is not None:
            peak += _above_highest(self.grid.whole(self.found.pressure))
        return peak

    @cached_property
    def mean(self) -> Array:
        """Pressure averaged over the patches [Pa], those the edge cuts included: the whole load."""
        return self._mean_on(self.grid)

    @cached_property
    def finer(self) -> tuple[Grid, Array]:
        """A grid of half the patch size, and a prescribed pressure averaged over its patches."""
        grid = Grid(2 * self.grid.n - 1, self.grid.d / 2)
        return grid, self._mean_on(grid)

    @cached_property
    def rest(self) -> Array:
        """Pressure at the patch centres less its edge profile [Pa].

        Zero within a patch of the edge, where the profile is the better of the two, and everywhere if the
        iteration does not resolve it.
        """
        assert isinstance(self.shape, edge_profile.Profile)
        r = self.grid.radius
        rest = self.found.pressure - self.shape.pressure(r)
        rest = np.where(r < self.shape.radius - self.grid.d, rest, 0.0)
        # in this order NaN is passed on
        return np.zeros_like(rest) if np.abs(rest).max() <= self.noise else rest

    def _mean_on(self, grid: Grid) -> Array:
        if isinstance(self.shape, edge_profile.Prescribed):
            return edge_profile.patch_mean(self.shape, grid.x, grid.d)
        if self.edge is not None:
            return self.edge.patch_mean(self.found.pressure)
        return self.found.pressure


class LevelProblem:
    """Contact problem of the indenter on a window of the grid.

    gap [m] : on the window, above the level ``datum``.  depth [m] : the largest on the grid above that.
    before : level that gives the first guess, None for one from the gap.  deflection : u = A p on the window.
    single : the steps are of single precision, as is u of them.
    """

    def __init__(
        self,
        grid: Grid,
        gap: Array,
        depth: float,
        window: Window,
        before: Level | None,
        indenter: Indenter,
        body: Body,
        numerics: Numerics,
        datum: float = 0.0,
    ) -> None:
        self.grid, self.gap, self.depth, self.window, self.before = grid, gap, depth, window, before
        self.indenter, self.body, self.numerics, self.datum = indenter, body, numerics, datum
        xp, (nx, ny) = namespace(gap), grid.across(window).shape
        kernel = influence.surface_coefficients(max(nx, ny), grid.d, body, numerics, xp)[:nx, :ny]
        held, threads = grid.quarter, numerics.threads
        memory: Array | None = None
        inverse: Array | None = None
        self.work: tuple[Array, Array] | None = None
        if not held and xp is np:
            memory, inverse, self.work = _shared_memory(nx, ny, numerics.tolerance >= LOOSE)
        self.single = memory is not None and memory.dtype == np.float32
        self.deflection = convolution.even_convolution(kernel, quarter=held, threads=threads, memory=memory)
        self.precondition = convolution.circulant_inverse(
            kernel, quarter=held, threads=threads, memory=inverse
        )

    def solve(self, defect: Array | float, missing: float, start: Array | None = None) -> Level:
        """Contact with ``defect`` [m] added to the gap and ``missing`` [N] of the load not on the patches.

        start : first guess of the pressure [Pa], None for `first_guess`.
        """
        grid, before, indenter = self.grid, self.before, self.indenter
        scale = indenter.approach or (before.found.approach if before else self.depth)
        # a flat punch has no depth; its approach is this to a factor of order one
        scale = scale or (indenter.load or 0.0) / (self.body.contact_modulus * grid.half_width)
        found = contact.solve(
            self.deflection,
            self.gap if isinstance(defect, float) else self.gap + defect,
            total=None if indenter.load is None else (indenter.load - missing) / grid.d**2,
            approach=None if indenter.approach is None else indenter.approach + self.datum,
            start=self.first_guess if start is None else start,
            precondition=self.precondition,
            scale=scale,
            tolerance=self.numerics.tolerance,
            max_iterations=self.numerics.max_iterations,
            extension=_extension(self.body, grid.d),
            weight=grid.weight(self.gap.shape),
            mirror="mirror" if grid.n % 2 else "reflect",
            work=self.work,
            deflection_into=self.deflection if self.single else None,
        )
        found = replace(found, approach=found.approach - self.datum)
        load = grid.force(found.pressure) + missing
        # p = E* k u / 2, k at most that of a checkerboard, sqrt(2) pi / d
        noise = self.numerics.tolerance * scale * self.body.contact_modulus * np.pi / 2**0.5 / grid.d
        return Level(grid, found, None, load, found.convolutions, noise)

    def deflection_of_whole(self, p: Array) -> Array:
        """u = A p of an even pressure [Pa] on the window and its mirror images."""
        return self.grid.whole(self.deflection(self.held(p)))

    def held(self, field: Array) -> Array:
        """The part on the window of an even field on it and its mirror images."""
        nx, ny = self.window.shape
        return field[-nx:, -ny:]

    def first_guess(self) -> Array:
        """Pressure [Pa] from the level before, or from the gap."""
        before = self.before
        if before is None and self.indenter.shapes:
            return self.indenter.shapes[0].pressure(self.grid.radius)
        if before is None:
            approach = self.indenter.approach or 0.25 * self.depth
            xp = namespace(self.gap)
            p = self.precondition(xp.maximum(xp.min(self.gap) + approach - self.gap, 0.0))
            return copy(p, xp.float64)  # not in memory that the iteration uses
        p, g, E_star = before.found.pressure, before.found.gap, self.body.contact_modulus
        return prolong(p, g, before.grid, self.grid, self.window, E_star)


def _shared_memory(nx: int, ny: int, loose: bool) -> tuple[Array, Array, tuple[Array, Array]]:
    """Memory of the convolution; parts of it for the preconditioner, for the work of the iteration.

    The convolution is never in use together with the others. All are single above ``SINGLE`` patches where
    the tolerance is ``loose``. The preconditioner takes and returns the second part of the work.
    """
    single, own = loose and nx * ny > SINGLE, nx * ny
    size = own + convolution.memory_size(nx, ny, padded=False)
    padded = convolution.memory_size(nx, ny, padded=True, single=single)
    memory: Array = np.empty(max(padded, size), np.float32 if single else np.float64)
    inverse = memory[own:size]
    return memory, inverse, (memory[:own].reshape(nx, ny), inverse[:own].reshape(nx, ny))


def _above_highest(p: Array) -> float:
    """Height of a maximum of p between the patch centres above the highest of them, 0 at a tip.

    By differences of second order: g . H^-1 g / 2, g the slope and -H the second derivatives.
    """
    i, j = divmod(int(namespace(p).argmax(p)), p.shape[1])
    q = to_numpy(p[max(i - 1, 0) : i + 2, max(j - 1, 0) : j + 2])
    if q.shape != (3, 3) or not (q > 0).all():
        return 0.0
    slope = np.array([q[2, 1] - q[0, 1], q[1, 2] - q[1, 0]]) / 2
    cross = (q[2, 0] + q[0, 2] - q[0, 0] - q[2, 2]) / 4
    curvature, axes = np.linalg.eigh(
        [[2 * q[1, 1] - q[0, 1] - q[2, 1], cross], [cross, 2 * q[1, 1] - q[1, 0] - q[1, 2]]]
    )
    curved = curvature > 1e-9 * curvature[1]  # not along a ridge
    return float(np.sum((slope @ axes)[curved] ** 2 / (2 * curvature[curved])))


def _extension(body: Body, d: float) -> float:
    """Patches over which the residual is extended: fewer where a stiff coating is a few patches thick.

    Measured: a third of it reduces five iterations to four where E1/E2 = 10, h = 3 d.
    """
    stiff = [one.thickness[0] for one in body.pair if one.coatings and one.moduli[0] > one.moduli[1]]
    return min([contact.EXTENSION, *(max(1.0, 0.3 * h / d) for h in stiff)])
