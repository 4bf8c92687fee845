"""Stiffness of a round contact, from contacts at neighbouring loads."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial

import numpy as np
from numpy.typing import NDArray

from semianalytic import numbers
from semianalytic.inputs import Body, Numerics, undeformed_gap
from semianalytic.patches import nested
from semianalytic.patches.contact import NotConverged
from semianalytic.patches.level import Indenter, Level

Array = NDArray[np.floating]


@dataclass(frozen=True)
class Sphere:
    """A sphere of ``radius`` [m] with the ``gap`` "parabola" or "sphere"."""

    radius: float
    gap: str

    def indenter(self, load: float | None, approach: float | None, edge_correction: bool) -> Indenter:
        undeformed = undeformed_gap(self.gap, self.radius)
        return Indenter(lambda grid: undeformed(grid.radius), load, approach, True, edge_correction)


@dataclass(frozen=True, eq=False)
class Neighbours:
    """Contacts at loads next to that of a solution.

    levels : of the coarser grids of at most 513 patches a side whose edge is smooth, the finest first.
    approach, uncertainty : of the finest grid [m], the latter None where it was not estimated.
    """

    sphere: Sphere
    levels: Sequence[Level]
    load: float
    approach: float
    uncertainty: float | None
    body: Body
    numerics: Numerics

    @cached_property
    def stiffness(self) -> tuple[float, float | None]:
        """d load / d approach [N/m] and its uncertainty.

        From d ln W / d ln delta by central differences, which Hertz's contact makes exact. The patches grow
        with the contact, so that its edge cuts them alike and their errors cancel: on the finest grid on
        which every edge is known to ``SHARED_NOISE`` of the approach, else where it is known best.
        """
        found = []
        for level in self.levels:
            beside, off = self._pressed(level), abs(self.approach / level.found.approach - 1)
            own, *others = (
                one.of_edge()["approach"] / one.found.approach for one in (level, *beside[0], *beside[1])
            )
            of_edges = max(others) - own  # patches cut alike are wrong alike
            found.append((max(off, of_edges), off, level, beside))
            if found[-1][0] <= numbers.SHARED_NOISE:
                break
        of_grid, off, level, beside = min(found, key=lambda one: one[0])
        slopes = []
        for pair in beside:
            ends = [np.log([one.load, one.found.approach]) for one in pair]
            slopes.append(float(np.divide(*(ends[0] - ends[1]))))
        slope = slopes[0] + (slopes[0] - slopes[1]) * numbers.STEPS[0] ** 2 / (
            numbers.STEPS[1] ** 2 - numbers.STEPS[0] ** 2
        )
        stiffness = slope * self.load / self.approach
        if self.uncertainty is None:
            return stiffness, None
        error = numbers.OF_STEP * abs(slope - slopes[0]) / slope + off
        # those of the approaches, over the smaller of their differences, whose slope has the larger weight
        of_approach = max(self.uncertainty / self.approach, numbers.SHARED_NOISE, of_grid)
        error += of_approach / float(np.log1p(numbers.STEPS[0]))
        return stiffness, stiffness * error

    def _pressed(self, level: Level) -> list[list[Level]]:
        """Contacts at a step's more and less than the load of ``level``, each started from the nearest."""
        numerics = replace(self.numerics, max_iterations=numbers.FURTHER * self.numerics.max_iterations)
        radius = partial(hertz_radius, self.sphere.radius, approach=None, body=self.body)
        beside, nearest = [], [level, level]
        for step in numbers.STEPS:
            found = []
            for start, factor in zip(nearest, (1 + step, 1 / (1 + step)), strict=True):
                load = level.load * factor
                size = level.grid.d * radius(load) / radius(level.load)
                before, grid = _stretched(start, size, load), replace(level.grid, d=size)
                pressed = self.sphere.indenter(load, None, edge_correction=True)
                found.append(nested.solve_on(grid, before, pressed, self.body, numerics))
            nearest = [one if one.shape is not None else level for one in found]
            beside.append(found)
        return beside


def hertz_radius(radius: float, load: float | None, approach: float | None, body: Body) -> float:
    """Hertz's contact radius [m] on a solid as compliant as the layers at the wavelength of the contact."""
    if load is None:
        return float((radius * (approach or 0.0)) ** 0.5)
    both, a = body.response, radius
    for _ in range(200):
        M = 1 + float(both.excess(np.array([2 / a]))[0]) if both else 1.0
        if not M > 0:
            raise NotConverged(f"the layers' compliance is {M:g} of the first one's; check the moduli")
        a, last = (a * a * 0.75 * load * radius * M / body.contact_modulus) ** 0.2, a
        if abs(a - last) < 1e-12 * a:
            break
    return a


def _stretched(level: Level, size: float, load: float) -> Level:
    """A level at another ``load`` [N] on patches of another ``size`` [m], to start from."""
    assert level.shape is not None
    ratio = size / level.grid.d
    factor = load / level.load / ratio**2
    A, B = (axis * ratio for axis in level.shape.axes)
    shape = replace(level.shape, axes=(A, B), coefficients=level.shape.coefficients * factor)
    found = replace(level.found, pressure=level.found.pressure * factor, gap=level.found.gap * ratio**2)
    return replace(level, grid=replace(level.grid, d=size), found=found, shape=shape)
