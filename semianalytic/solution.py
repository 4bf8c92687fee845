"""What a semi-analytical solve returns.

A ``Solution`` carries its coarser companion, the same problem on half the patches. Every uncertainty of
a field is read from the difference of the two at the points asked for, widened so that a chance
agreement of the two does not pass for accuracy.
"""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import RectBivariateSpline
from scipy.ndimage import maximum_filter

__all__ = ["Diagnostics", "Solution", "Uncertainty"]

Array = NDArray[np.floating]
Field = Callable[[ArrayLike, ArrayLike, ArrayLike, int | None], Array]
Motion = Callable[[ArrayLike, ArrayLike, ArrayLike], Array]

# error of the stress of a given pressure, over its peak, against Hankel quadrature: above 4 patches, below
EVALUATION = (5e-6, 5e-7)
# Likewise of a pressure: what the iteration leaves of a gap, answered in proportion to the patches.
RESOLUTION = 1e-7


def safety(ratio: float) -> float:
    """What a change on refining the patches ``ratio`` times is multiplied by: at least 1.

    At order 3/2, the lowest seen, the error left is the change over ratio^(3/2) - 1; never below the change.
    """
    return float(max(1.0, 1 / (ratio**1.5 - 1)))


@dataclass(frozen=True)
class Uncertainty:
    """Numerical uncertainty in SI units; budget : rows (quantity, knob, value).

    Knobs: patch size, conversion, domain, iteration; coating, where the first is thinner than four patches.
    The three scalars are the sums of their rows.
    """

    contact_radius: float
    approach: float
    peak_pressure: float
    budget: tuple[tuple[str, str, float], ...]

    @classmethod
    def from_ladders(
        cls,
        fine: dict[str, float],
        middle: dict[str, float],
        coarse: dict[str, float],
        knobs: dict[str, dict[str, float]],
        *,
        base: dict[str, float],
        ratio: float,
    ) -> "Uncertainty":
        """From the results on three grids, and on that of ``base`` with each other knob turned to the worse.

        Patch size: the change to the finest grid, of ``ratio`` times the patches a side, times ``safety``; or
        a sixth of the change before where the last is small by chance.
        """
        rows = []
        for name, value in fine.items():
            last, before = abs(value - middle[name]), abs(middle[name] - coarse[name])
            rows.append((name, "patch size", float(np.maximum(safety(ratio) * last, before / 6))))
            rows += [(name, knob, abs(result[name] - base[name])) for knob, result in knobs.items()]
        return cls._of(rows)

    def extended(self, rows: list[tuple[str, str, float]]) -> "Uncertainty":
        """The same with more rows in the budget."""
        return self._of([*self.budget, *rows])

    @classmethod
    def _of(cls, rows: list[tuple[str, str, float]]) -> "Uncertainty":
        names = ("contact_radius", "approach", "peak_pressure")
        total = {name: sum(row[2] for row in rows if row[0] == name) for name in names}
        return cls(**total, budget=tuple(rows))


@dataclass(frozen=True)
class Diagnostics:
    """What the solution took and how well the contact conditions are met.

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
    """Contact of a rigid indenter on a coated half-space; SI, tension positive, z into the solid.

    contact_radius [m] : where p vanishes; of a contact that is no disc, the radius of the disc of its area.
    approach [m].  peak_pressure [Pa] : largest pressure, which sits off the axis under stiff thin coatings.
    surface_nodes [m] : x on y = 0 at which no pressure is interpolated, past 2 contact radii.
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
    _profile: Callable[[Array], Array] | None = field(repr=False)
    _stress: Field = field(repr=False)
    _plane: Callable[[float, int | None], Array] = field(repr=False)
    _displacement_plane: Callable[[float], Array] = field(repr=False)
    _displacement: Motion = field(repr=False)

    def pressure(self, x: ArrayLike, y: ArrayLike = 0.0) -> Array:
        """Contact pressure [Pa], 0 outside; between nodes what is interpolated is smooth up to the edge.

        That is p less the profile its edge was corrected with or, where there is none, p^2.
        x, y : [m], broadcast.
        """
        if self._profile is None:
            square = self.patch_pressure**2
            touched = _at(self.nodes, square, x, y, order=1) > 0  # where the cubic must not ring
            return np.sqrt(np.maximum(np.where(touched, _at(self.nodes, square, x, y), 0), 0))
        rest = self.patch_pressure - self._profile(np.hypot(self.nodes[:, None], self.nodes[None, :]))
        value = self._profile(np.hypot(x, y)) + _at(self.nodes, rest, x, y, order=1)
        return np.maximum(value, 0)

    def stress(self, x: ArrayLike, y: ArrayLike, z: ArrayLike, layer: int | None = None) -> Array:
        """Stress tensor [Pa], shape (3, 3) + points.

        x, y, z : [m], broadcast, z >= 0.  layer : 0 is the first coating, len(coatings) the substrate; it
        picks the side of an interface, None the upper one.
        Raises ValueError for z < 0, and for a layer that z does not lie in.
        """
        return self._stress(x, y, z, layer)

    def stress_plane(self, z: float, layer: int | None = None) -> Array:
        """Stress tensor [Pa] below every patch centre at one depth, shape (3, 3, n, n), by seven FFTs.

        z : [m].  layer : as in ``stress``.  Points are (nodes[i], nodes[j]), z.
        """
        return self._plane(z, layer)

    def displacement_plane(self, z: float) -> Array:
        """Displacement [m] below every patch centre at one depth, shape (3, n, n), by four FFTs.

        z : [m].  Points are (nodes[i], nodes[j]), z.
        """
        return self._displacement_plane(z)

    def displacement(self, x: ArrayLike, y: ArrayLike, z: ArrayLike) -> Array:
        """Displacement [m], shape (3,) + points, u_z into the solid.

        x, y, z : [m], broadcast, z >= 0.
        """
        return self._displacement(x, y, z)

    def pressure_uncertainty(self, x: ArrayLike, y: ArrayLike = 0.0) -> Array:
        """Uncertainty of the pressure [Pa] from the coarser companion.

        The largest difference of the two within a patch of the coarser, times ``safety``, or a sixth of that
        of the next two; and what the other knobs do to the peak: twice, since they were turned on half the
        patches and a pressure answers a gap in proportion to the patches. Plus what the uncertain radius
        does to the pressure within three patches of the coarser from the edge or, where the edge is a
        staircase, all that twice; and ``RESOLUTION`` of the peak.
        Raises ValueError where no uncertainty was estimated.
        """
        coarser, floor = self._companion()
        i, j = self.nodes[:, None], self.nodes[None, :]
        second = coarser.pressure(i, j)
        ratio = len(self.nodes) / len(coarser.nodes)
        difference = safety(ratio) * np.abs(self.patch_pressure - second)
        if coarser.coarser is not None:
            difference = np.maximum(difference, np.abs(second - coarser.coarser.pressure(i, j)) / 6)
        reach = 2 * int(np.ceil(ratio if self._profile is not None else 2 * ratio)) + 1
        widened = maximum_filter(difference, size=reach, mode="nearest")
        spread = _at(self.nodes, widened, x, y, order=1) + (2 * floor + RESOLUTION) * self.peak_pressure
        if self._profile is None or self.uncertainty is None:
            return 2 * spread
        r, shift = np.hypot(x, y), self.uncertainty.contact_radius
        moved = np.abs([self._profile(r + s) - self._profile(r) for s in (-shift, shift)]).max(axis=0)
        edge = np.abs(r - self.contact_radius) < 3 * coarser.diagnostics.patch_size + shift
        return spread + np.where(edge, moved, 0.0)

    def stress_uncertainty(self, x: ArrayLike, y: ArrayLike, z: ArrayLike, layer: int | None = None) -> Array:
        """Uncertainty of the stress [Pa], shape (3, 3) + points; see ``stress_with_uncertainty``.

        Raises ValueError where no uncertainty was estimated.
        """
        return self.stress_with_uncertainty(x, y, z, layer)[1]

    def stress_with_uncertainty(
        self, x: ArrayLike, y: ArrayLike, z: ArrayLike, layer: int | None = None
    ) -> tuple[Array, Array]:
        """Stress and its uncertainty [Pa], shape (3, 3) + points each, the latter from coarser companions.

        The largest difference over the six components, for every component alike: of this grid and the
        next, times ``safety``, or a third of that of the next and the one after; plus what the other knobs
        do to the peak pressure, and the error of the evaluation, ``EVALUATION`` of the peak.
        Raises ValueError where no uncertainty was estimated.
        """
        coarser, floor = self._companion()
        sigma = self.stress(x, y, z, layer)
        second = coarser.stress(x, y, z, layer)
        spread = safety(len(self.nodes) / len(coarser.nodes)) * np.abs(sigma - second).max(axis=(0, 1))
        if coarser.coarser is not None:
            third = coarser.coarser.stress(x, y, z, layer)
            spread = np.maximum(spread, np.abs(second - third).max(axis=(0, 1)) / 3)
        shallow = np.asarray(z) < 4 * self.diagnostics.patch_size
        total = spread + (floor + np.where(shallow, *EVALUATION)) * self.peak_pressure
        return sigma, np.broadcast_to(total, (3, 3, *spread.shape)).copy()

    def _companion(self) -> tuple["Solution", float]:
        if self.uncertainty is None or self.coarser is None:
            raise ValueError("uncertainty was not estimated; solve with estimate_uncertainty=True")
        rows = self.uncertainty.budget
        other = sum(value for name, knob, value in rows if name == "peak_pressure" and knob != "patch size")
        return self.coarser, other / self.peak_pressure


def _at(nodes: Array, values: Array, x: ArrayLike, y: ArrayLike, order: int = 3) -> Array:
    """Spline through the values at the nodes, 0 outside them."""
    x, y = np.broadcast_arrays(np.asarray(x, dtype=float), np.asarray(y, dtype=float))
    inside = np.maximum(np.abs(x), np.abs(y)) <= nodes[-1] * (1 + 1e-12)
    value = np.zeros(x.shape)
    spline = RectBivariateSpline(nodes, nodes, values, kx=order, ky=order)
    value[inside] = spline(x[inside], y[inside], grid=False)
    return value
