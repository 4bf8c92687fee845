"""Numerical uncertainty by a refinement study over grids, by variation of the other numerical parameters."""

from dataclasses import dataclass, replace

import numpy as np

from semianalytic.edge_profile import Profile
from semianalytic.grid import Grid, odd
from semianalytic.inputs import Body, Numerics
from semianalytic.level import Indenter, Level
from semianalytic.nested import solve_on

__all__ = ["WIDER", "Uncertainty", "of_contact", "other_conversion", "safety"]

WIDER = 1.25  # the box that tests the domain over the box in use


def safety(ratio: float) -> float:
    """Factor on a change on refining the patches ``ratio`` times: at least 1.

    At order 3/2, the lowest observed, the error left is the change over ratio^(3/2) - 1.
    """
    return float(max(1.0, 1 / (ratio**1.5 - 1)))


@dataclass(frozen=True)
class Uncertainty:
    """Numerical uncertainty in SI units; budget : rows (quantity, numerical parameter, value).

    Parameters: patch size, conversion, domain, iteration; edge profile, of the contact radius; coating, where
    the first is thinner than four patches. The three scalars are the sums of their rows.
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
        base: dict[str, float],
        ratio: float,
    ) -> "Uncertainty":
        """From the results on three grids, and on that of ``base`` with one other parameter less accurate.

        Patch size: the change to the finest grid, of ``ratio`` times the patches a side, times ``safety``; or
        a sixth of the change before where the last is small by chance.
        """
        rows = []
        for name, value in fine.items():
            last, before = abs(value - middle[name]), abs(middle[name] - coarse[name])
            rows.append((name, "patch size", float(np.maximum(safety(ratio) * last, before / 6))))
            rows += [(name, varied, abs(result[name] - base[name])) for varied, result in variations.items()]
        return cls._of(rows)

    @classmethod
    def _of(cls, rows: list[tuple[str, str, float]]) -> "Uncertainty":
        names = ("contact_radius", "approach", "peak_pressure")
        total = {name: sum(row[2] for row in rows if row[0] == name) for name in names}
        return cls(**total, budget=tuple(rows))


def of_contact(levels: list[Level], indenter: Indenter, body: Body, numerics: Numerics) -> Uncertainty:
    """Refinement study of the last three levels; the other parameters on the coarsest of them."""
    fine, middle, coarse = (level.scalars for level in levels[:-4:-1])
    grid, start = levels[-3].grid, levels[-4] if len(levels) > 3 else None
    numerics = replace(numerics, edge_terms=(grid.n / numerics.patches) ** 0.5)
    looser = replace(numerics, tolerance=min(100 * numerics.tolerance, 1e-2))
    wider = Grid(odd(WIDER * grid.n), grid.d)
    poorer = replace(indenter, table=indenter.coarse_table)
    variations = {
        "conversion": solve_on(grid, start, poorer, body, other_conversion(numerics)).scalars,
        "domain": solve_on(wider, start, indenter, body, numerics).scalars,
        "iteration": solve_on(grid, start, indenter, body, looser).scalars,
    }
    ratio = numerics.patches / levels[-2].grid.n
    estimate = Uncertainty.from_levels(fine, middle, coarse, variations, base=coarse, ratio=ratio)
    shape = levels[-1].shape
    if isinstance(shape, Profile):
        # measured on films down to h = a/200: the radius errs by 0.1 to 0.9 of what the profile leaves
        left = float(np.abs(levels[-1].rest).max()) / fine["peak_pressure"]
        rows = [*estimate.budget, ("contact_radius", "edge profile", left * shape.radius)]
        estimate = Uncertainty._of(rows)
    if indenter.round and body.coatings:
        # no level resolves how the pressure bends at the edge within a coating thinner than the patches
        h, d = body.thickness[0], levels[-1].grid.d
        unresolved = 0.3 * h / levels[-1].radius * max(0.0, 1 - h / (4 * d))
        if unresolved:
            powers = {"contact_radius": 1, "approach": 2, "peak_pressure": 2}
            rows = [(name, "coating", unresolved**power * fine[name]) for name, power in powers.items()]
            estimate = Uncertainty._of([*estimate.budget, *rows])
    return estimate


def other_conversion(numerics: Numerics) -> Numerics:
    """Numerics to compare the conversion with: half its points, or the better conversion if there is one."""
    if numerics.conversion == "split":
        return replace(numerics, hankel_points=numerics.hankel_points // 2)
    return replace(numerics, conversion="split")
