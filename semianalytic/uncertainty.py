"""Numerical uncertainty by a refinement study over grids, by variation of the other numerical parameters."""

from dataclasses import dataclass, replace

import numpy as np

from semianalytic import perturbation
from semianalytic.arrays import namespace
from semianalytic.collocation import RoundContact
from semianalytic.edge_profile import Profile, convergence
from semianalytic.grid import Window, odd
from semianalytic.influence import surface_coefficients
from semianalytic.inputs import Body, Numerics
from semianalytic.level import Indenter, Level
from semianalytic.nested import is_alone, lowest_point, solve_on, undeformed

__all__ = ["WIDER", "Uncertainty", "change", "of_contact", "of_stiffness", "other_conversion", "safety"]

QUADRATURE = 1e-9  # of the layers' response by Gauss panels
WIDER = 1.25  # the box that tests the domain over the box in use


def safety(ratio: float) -> float:
    """Factor on a change on refining the patches ``ratio`` times: at least 1.

    At order 3/2, the lowest observed, the error left is the change over ratio^(3/2) - 1.
    """
    return float(max(1.0, 1 / (ratio**1.5 - 1)))


@dataclass(frozen=True)
class Uncertainty:
    """Numerical uncertainty in SI units; budget : rows (quantity, numerical parameter, value).

    Parameters: patch size, conversion, domain, iteration, the staircase that patches make of the edge; of a
    contact with an edge profile its terms, the quadrature, the iteration. The three scalars are the sums of
    their rows.
    """

    contact_radius: float
    approach: float
    peak_pressure: float
    budget: tuple[tuple[str, str, float], ...]

    @classmethod
    def from_levels(
        cls,
        fine: dict[str, float],
        middle: dict[str, float],
        coarse: dict[str, float],
        variations: dict[str, dict[str, float]],
        *,
        ratio: float,
        staircase: float = 0.0,
        share: float = 1 / 6,
    ) -> "Uncertainty":
        """From the results on three grids, and the changes by one other parameter that is less accurate.

        Patch size: the change to the finest grid, of ``ratio`` times the patches a side, times ``safety``; or
        that ``share`` of the change before where the last is small by chance.  staircase : error of the edge
        [m].
        """
        rows = []
        if staircase:  # of the second order in the approach, which is stationary in the contact's area
            second = fine["approach"] * (staircase / fine["contact_radius"]) ** 2
            rows = [("contact_radius", "staircase", staircase), ("approach", "staircase", second)]
        for name, value in fine.items():
            last, before = abs(value - middle[name]), abs(middle[name] - coarse[name])
            rows.append((name, "patch size", float(np.maximum(safety(ratio) * last, share * before))))
            rows += [(name, varied, change[name]) for varied, change in variations.items()]
        return cls._of(rows)

    @classmethod
    def _of(cls, rows: list[tuple[str, str, float]]) -> "Uncertainty":
        names = ("contact_radius", "approach", "peak_pressure")
        total = {name: sum(row[2] for row in rows if row[0] == name) for name in names}
        return cls(**total, budget=tuple(rows))


def change(one: dict[str, float], other: dict[str, float]) -> dict[str, float]:
    """Absolute changes of scalars."""
    return {name: abs(other[name] - value) for name, value in one.items()}


def of_contact(levels: list[Level], indenter: Indenter, body: Body, numerics: Numerics) -> Uncertainty:
    """Refinement study of the last three levels; the other parameters on the coarsest of them."""
    if isinstance(levels[-1].shape, Profile):
        return _of_profiles(levels, numerics)
    fine, middle, coarse = (level.scalars for level in levels[:-4:-1])
    last, varied = levels[-1], levels[-3]
    variations = {
        "conversion": _of_conversion(varied, indenter, body, numerics),
        "domain": _of_domain(varied, levels[-4] if len(levels) > 3 else None, indenter, body, numerics),
        "iteration": _of_iteration(last, indenter),
    }
    return Uncertainty.from_levels(
        fine,
        middle,
        coarse,
        variations,
        ratio=numerics.patches / levels[-2].grid.n,
        staircase=last.staircase,
        share=1 / 4 if last.edge else 1 / 2,  # an edge of whole patches changes erratically
    )


def _of_conversion(level: Level, indenter: Indenter, body: Body, numerics: Numerics) -> dict[str, float]:
    """Changes by `other_conversion`, to the first order: ``perturbation``."""
    if numerics.conversion == "split" and not any(one.coatings for one in body.pair):  # in closed form
        return dict.fromkeys(level.scalars, 0.0)
    n, d, other = level.grid.n, level.grid.d, other_conversion(numerics)
    xp = namespace(level.found.pressure)
    change = surface_coefficients(n, d, body, other, xp)
    change -= surface_coefficients(n, d, body, numerics, xp)
    return perturbation.of_kernel(level, change, other, indenter, body, numerics)


def _of_domain(
    level: Level, start: Level | None, indenter: Indenter, body: Body, numerics: Numerics
) -> dict[str, float]:
    """Changes by a box ``WIDER`` times as wide.

    The convolution is exact on a box of any size, and only influence coefficients by FFT depend on it: where
    the gap stays open beyond the box, nothing else changes. Where it does not, the contact is solved on the
    wider box, from ``start``.
    """
    grid = level.grid
    wider = replace(grid, n=odd(WIDER * grid.n))
    box, gap = (
        undeformed(replace(wider, quarter=False), indenter)
        if not indenter.round
        else (wider, indenter.gap(wider))
    )
    level = level if box.quarter else level.whole
    if box.quarter == level.grid.quarter and (wider.n - grid.n) % 2 == 0:
        first, m = 0 if box.quarter else (wider.n - grid.n) // 2, len(level.grid.x)
        window = Window(first, first + m, first, first + m)
        xp = namespace(gap)
        datum = lowest_point(box, gap, indenter)
        depth = float(xp.max(gap)) - datum
        found = level.found.embedded(window.slices, box.window.shape, depth)
        if is_alone(replace(level, grid=box, found=found), box.lowest(gap - datum), window, body, numerics):
            if numerics.conversion == "split":
                return dict.fromkeys(level.scalars, 0.0)
            by_fft = surface_coefficients(wider.n, grid.d, body, numerics, xp)[: grid.n, : grid.n]
            by_fft -= surface_coefficients(grid.n, grid.d, body, numerics, xp)
            return perturbation.of_kernel(level, by_fft, numerics, indenter, body, numerics)
    return change(level.scalars, solve_on(wider, start, indenter, body, numerics).scalars)


def _of_iteration(level: Level, indenter: Indenter) -> dict[str, float]:
    """Changes by a further step of the iteration.

    The gap g that is left in contact changes the approach by its mean, weighted with the pressure of a flat
    punch, which is nowhere negative (``perturbation``): by no more than the largest |g|. The pressure changes
    by A^-1 g, about P g, and the radius by no larger a part.
    """
    found = level.found
    left = min(found.left, level.noise)
    xp, gap = namespace(found.gap), 0.0
    if indenter.approach is None:
        gap = float(xp.max(xp.abs(found.gap[found.pressure > 0])))
    peak = float(xp.max(found.pressure))
    return {"contact_radius": level.radius * left / peak, "approach": gap, "peak_pressure": left}


def _of_profiles(levels: list[Level], numerics: Numerics) -> Uncertainty:
    """Refinement study of the edge profile's terms, which the patches follow.

    Terms: the change to the finest profile, times the observed convergence.  Quadrature: of the layers'
    response.  Iteration: the gap it leaves, over the approach; what the patches leave of the profile.
    """
    fine, middle, coarse = levels[:-4:-1]
    shapes = [level.shape for level in (fine, middle, coarse)]
    rate = convergence(*(shape for shape in shapes if isinstance(shape, Profile)))
    rows = [
        ("approach", "iteration", numerics.tolerance * fine.found.approach),
        ("peak_pressure", "iteration", float(np.abs(fine.rest).max())),
    ]
    for name, value in fine.scalars.items():
        last, before = abs(value - middle.scalars[name]), abs(middle.scalars[name] - coarse.scalars[name])
        rows.append((name, "edge terms", rate * max(last, rate * before)))
        rows.append((name, "quadrature", QUADRATURE * value))
    return Uncertainty._of(rows)


def of_stiffness(found: list[RoundContact]) -> float:
    """Uncertainty of the stiffness [N/m] of the first contact, as of its scalars, and of its differences."""
    fine, middle, coarse = found
    rate = convergence(fine.profile, middle.profile, coarse.profile)
    last, before = abs(fine.stiffness - middle.stiffness), abs(middle.stiffness - coarse.stiffness)
    return rate * max(last, rate * before) + fine.stiffness_error + QUADRATURE * fine.stiffness


def other_conversion(numerics: Numerics) -> Numerics:
    """Numerics to compare the conversion with: half its points, or the better conversion if there is one."""
    if numerics.conversion == "split":
        return replace(numerics, hankel_points=numerics.hankel_points // 2)
    return replace(numerics, conversion="split")
