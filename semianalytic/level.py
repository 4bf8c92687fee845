"""Contact on one grid of the nested iteration."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from semianalytic import abel, contact, convolution, edge_profile, influence
from semianalytic.grid import Grid, Window, prolong, refine
from semianalytic.inputs import Body, Numerics

__all__ = ["Indenter", "Level", "LevelProblem"]

Array = NDArray[np.floating]


@dataclass(frozen=True)
class Indenter:
    """Undeformed gap on a grid, and either the load [N] or the approach [m].

    round : axisymmetric with a smooth edge, which can be corrected; table : of the layers, for that;
    coarse_table : with half the wavenumbers, where the coating is too thin for ``table`` to be complete.
    """

    gap: Callable[[Grid], Array]
    load: float | None
    approach: float | None
    round: bool
    table: abel.LayerTable | None = None
    coarse_table: abel.LayerTable | None = None


@dataclass(frozen=True)
class Level:
    """A contact on one grid; ``shape`` is the edge profile of its correction."""

    grid: Grid
    found: contact.Contact
    shape: edge_profile.Profile | edge_profile.Prescribed | None
    load: float
    convolutions: int

    @property
    def radius(self) -> float:
        if self.shape is not None:
            return self.shape.radius
        return float(np.sqrt(np.count_nonzero(self.found.pressure) / np.pi) * self.grid.d)

    @property
    def scalars(self) -> dict[str, float]:
        return {
            "contact_radius": self.radius,
            "approach": self.found.approach,
            "peak_pressure": float(self.found.pressure.max()),
        }

    @cached_property
    def mean(self) -> Array:
        """Pressure averaged over the patches [Pa], those the edge cuts included: the whole load."""
        return self._mean_on(self.grid)

    @cached_property
    def finer(self) -> tuple[Grid, Array]:
        """A grid of half the patch size, and the pressure averaged over its patches."""
        grid = Grid(2 * self.grid.n - 1, self.grid.d / 2)
        return grid, self._mean_on(grid)

    def _mean_on(self, grid: Grid) -> Array:
        p, f = self.found.pressure, self.shape
        if f is None:
            return p
        rest = p - f.pressure(self.grid.radius)
        if grid.n != self.grid.n:
            rest = np.where(grid.radius < f.radius, refine(rest, self.grid, grid), 0.0)
        return rest + edge_profile.patch_mean(f, grid.x, grid.d)


class LevelProblem:
    """Contact problem of the indenter on a window of the grid.

    gap [m] : on the window.  depth [m] : the largest gap on the grid.  before : level that gives the first
    guess, None for one from the gap.  deflection : u = A p on the window.
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
    ) -> None:
        self.grid, self.gap, self.depth, self.window, self.before = grid, gap, depth, window, before
        self.indenter, self.body, self.numerics = indenter, body, numerics
        nx, ny = window.shape
        kernel = influence.surface_coefficients(max(nx, ny), grid.d, body, numerics)[:nx, :ny]
        self.deflection = convolution.even_convolution(kernel, threads=numerics.threads)
        self.precondition = convolution.circulant_inverse(kernel, threads=numerics.threads)

    def solve(self, defect: Array | float, missing: float, start: Level | None, tolerance: float) -> Level:
        """Contact with ``defect`` [m] added to the gap and ``missing`` [N] of the load not on the patches.

        start : level on the same window, None to start from ``before``.
        """
        grid, before, indenter = self.grid, self.before, self.indenter
        found = contact.solve(
            self.deflection,
            self.gap + defect,
            total=None if indenter.load is None else (indenter.load - missing) / grid.d**2,
            approach=indenter.approach,
            start=self._first_guess() if start is None else start.found.pressure,
            precondition=self.precondition,
            scale=indenter.approach or (before.found.approach if before else self.depth),
            tolerance=tolerance,
            max_iterations=self.numerics.max_iterations,
            extension=_extension(self.body, grid.d),
        )
        load = float(found.pressure.sum() * grid.d**2) + missing
        spent = 0 if start is None else start.convolutions + 1
        return Level(grid, found, None, load, spent + found.convolutions)

    def _first_guess(self) -> Array:
        before = self.before
        if before is None:
            approach = self.indenter.approach or 0.25 * self.depth
            return self.precondition(np.maximum(self.gap.min() + approach - self.gap, 0))
        p, g, E_star = before.found.pressure, before.found.gap, self.body.moduli[0]
        return prolong(p, g, before.grid, self.grid, self.window, E_star)


def _extension(body: Body, d: float) -> float:
    """Patches over which the residual is extended: fewer where a stiff coating is a few patches thick.

    Measured: a third of it reduces five iterations to four where E1/E2 = 10, h = 3 d.
    """
    if not body.coatings or body.moduli[0] <= body.moduli[1]:
        return contact.EXTENSION
    return min(contact.EXTENSION, max(1.0, 0.3 * body.thickness[0] / d))
