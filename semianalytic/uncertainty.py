"""Numerical uncertainty by a refinement study over grids, and by variation of the other numerical
parameters."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from semianalytic.coefficients import influence
from semianalytic.inputs import Body, Numerics
from semianalytic.patches import convolution
from semianalytic.patches.grid import odd
from semianalytic.patches.level import Indenter, Level

WIDER = 1.25  # the box that tests the domain over the box in use
SMOOTH = (3.0, 0.8)  # times the last change, or the one before, of a contact with a smooth edge
# Times the change before of the contact radius, which the patches at the edge move to and fro; of its own in
# the budget, since it falls a grid later than the rest.
RADIUS, MOVING = 1.2, "edge on the patches"
OUTSIDE = 3.0  # times as much where the shape is fitted near the edge alone
SECOND = 1e-3  # of approach and peak, times (d/a)^2: what patches leave of deflection and pressure inside
UNRESOLVED = 0.03  # patches by which the edge of a film thinner than two of them may be wrong
# Of fields at a smooth edge, at the same x/a: times the last change, times the change before. Over the
# accuracy asked, the most that this may be of the pressure.
AT_EDGE, PRESSURE = (8.0, 2.0), 8.0
# Patches between centre and edge, below which the uncertainty grows as the fourth power of their size: a film
# of 0.1 a on 15 patches needed 5.4 times.
COARSE = 24.0
FALL = 3.0  # of the uncertainty on refining twice, that makes a larger grid worth its time
SUDDEN = 0.1  # of the ripple, or of the change of the pressure, of the grid before
PATCHES = (
    1.0  # of the change before, of patches alone: their edge moves erratically, and no order is observed
)


def safety(ratio: float) -> float:
    """Factor on a change on refining the patches ``ratio`` times: at least 1.

    At order 3/2, the lowest observed, the error left is the change over ratio^(3/2) - 1.
    """
    return float(max(1.0, 1 / (ratio**1.5 - 1)))


def unsettled(last: float, before: float, ripple: float = 0.0) -> float:
    """The last change, up to four times where it falls by less than half, but for a ripple of the patches."""
    return last * min(max(1.0, (2 * last / (before + ripple)) ** 2), 4.0) if before else last


@dataclass(frozen=True)
class Uncertainty:
    """Numerical uncertainty in SI units; budget : rows (quantity, numerical parameter, value).

    Parameters: patch size, conversion, domain, iteration. The three scalars are the sums of their rows.
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
        factor: float,
        share: float,
        edge: float = 0.0,
        inside: float = 0.0,
        moving: float = 0.0,
        loaded: float = 0.0,
    ) -> "Uncertainty":
        """From the results on three grids, and the changes by one other parameter that is less accurate.

        Patch size: ``factor`` times the change to the finest grid, or ``share`` of the change before where
        the last is small by chance, or ``edge``, the error of the contact radius by patches that the edge
        cuts [m], or ``inside``, that of deflection and pressure there, relative.
        ``moving`` : share of the change before that the contact radius has at least, in a row of its own.
        ``loaded`` : of the edge, see ``Level.load_at_edge``; 0 of a smooth one.
        """
        moved = edge / fine["contact_radius"]
        # an error of the edge is of the second order in the approach, which is stationary in the contact's
        # area
        least = {
            "contact_radius": edge,
            "approach": fine["approach"] * (inside + loaded * moved + moved**2),
            "peak_pressure": fine["peak_pressure"] * inside,
        }
        rows = []
        for name, value in fine.items():
            last, before = abs(value - middle[name]), abs(middle[name] - coarse[name])
            found = np.max([factor * last, share * before, least.get(name, 0.0)])
            rows.append((name, "patch size", float(found)))
            rows += [(name, varied, change[name]) for varied, change in variations.items()]
            if moving and name == "contact_radius":
                rows.append((name, MOVING, float(max(0.0, moving * before - found))))
        names = ("contact_radius", "approach", "peak_pressure")
        total = {name: sum(row[2] for row in rows if row[0] == name) for name in names}
        return cls(**total, budget=tuple(rows))

    def relative_to(self, scalars: dict[str, float], without: str = "") -> float:
        """The largest uncertainty over its scalar, but for what is due to the origin ``without``."""
        return max(
            sum(value for name, origin, value in self.budget if name == scalar and origin != without) / size
            for scalar, size in scalars.items()
        )


def of_contact(levels: list[Level], indenter: Indenter, body: Body, numerics: Numerics) -> Uncertainty:
    """Refinement study of the last three levels; conversion and domain on the coarsest, iteration on the
    finest."""
    fine, middle, coarse = (level.scalars for level in levels[:-4:-1])
    last, varied = levels[-1], levels[-3]
    variations = {
        "conversion": _by_other_coefficients(varied, body, numerics, other_conversion(numerics), 1.0),
        "domain": _by_other_coefficients(varied, body, numerics, numerics, WIDER),
        "iteration": _of_iteration(last, indenter),
    }
    edge, inside, moving = last.staircase, 0.0, 0.0
    factor, share = safety(last.grid.n / levels[-2].grid.n), PATCHES
    if last.shape:
        patch = last.grid.d / min(last.shape.axes)
        few = max(1.0, COARSE * patch) ** 4
        factor, share = np.multiply(SMOOTH, few * (OUTSIDE if last.shape.outside else 1.0))
        edge, inside, moving = few * edge, SECOND * patch**2, few * RADIUS
        # patches too large for what happens within the thickness of a film
        if body.response is not None and body.response.depth < 2 * last.grid.d:
            edge = max(edge, UNRESOLVED * last.grid.d)
    return Uncertainty.from_levels(
        fine,
        middle,
        coarse,
        variations,
        factor=factor,
        share=share,
        edge=edge,
        inside=inside,
        moving=moving,
        loaded=0.0 if last.shape else last.load_at_edge,
    )


def is_met(accuracy: float, estimate: Uncertainty, levels: list[Level]) -> bool:
    """Whether the scalars, and the pressure under a smooth edge, are as accurate as asked, relative."""
    last, before = (_pressure_change(levels[k], levels[k - 1]) for k in (-1, -2))
    at_edge = max(AT_EDGE[0] * last, AT_EDGE[1] * before) / levels[-1].scalars["peak_pressure"]
    return estimate.relative_to(levels[-1].scalars) <= accuracy and at_edge <= PRESSURE * accuracy


def is_stalled(accuracy: float, reached: Sequence[float], levels: list[Level]) -> bool:
    """Whether the relative uncertainties ``reached``, a grid each, exceed the accuracy and no longer fall.

    They do where a grid is the first to resolve the pressure at the edge: one more shows it.
    """
    resolved = levels[-1].ripple < SUDDEN * levels[-2].ripple
    settled = _pressure_change(*levels[:-3:-1]) < SUDDEN * _pressure_change(*levels[-2:-4:-1])
    return reached[-1] > accuracy and FALL * reached[-1] > reached[-3:][0] and not (resolved or settled)


def _pressure_change(fine: Level, coarse: Level) -> float:
    """Largest change of the pressure [Pa] of a smooth edge at the same x/a; 0 of patches alone."""
    if fine.shape is None or coarse.shape is None:
        return 0.0
    s = np.sqrt(np.concatenate([[0.0], 1 - np.geomspace(1.0, 1e-3, 40)]))
    p = [shape.pressure(*shape.on_ray(s, np.zeros(s.size))) for shape in (fine.shape, coarse.shape)]
    return float(np.abs(p[0] - p[1]).max())


def _by_other_coefficients(
    level: Level, body: Body, numerics: Numerics, other: Numerics, wider: float
) -> dict[str, float]:
    """Changes by other influence coefficients, computed on a box ``wider`` times as wide.

    Their deflection changes by e = dK p. At a given load the approach changes by a mean of e, weighted with
    the pressure of a flat punch, which is nowhere negative: by no more than the largest |e|. Hertz's
    contact, whose gap e changes by c r^2, is that of another radius of curvature: p0 changes by 4/3, a by
    2/3 of the range of e over the approach; here by twice and once that share.
    """
    none = dict.fromkeys(level.scalars, 0.0)
    if numerics.conversion == "split" and (wider > 1 or not any(one.coatings for one in body.pair)):
        return none  # coefficients in closed form, or computed without a box
    grid, p = level.grid, level.found.pressure
    n = level.grid.n
    dK = influence.surface_coefficients(odd(wider * n), grid.d, body, other)[:n, :n]
    dK = dK - influence.surface_coefficients(n, grid.d, body, numerics)
    e = convolution.even_convolution(dK, quarter=grid.quarter)(p)[p > 0]
    low, high = float(np.min(e)), float(np.max(e))
    share = (high - low) / level.found.approach
    return {
        "contact_radius": share * level.radius,
        "approach": max(abs(low), abs(high)),
        "peak_pressure": 2 * share * level.scalars["peak_pressure"],
    }


def _of_iteration(level: Level, indenter: Indenter) -> dict[str, float]:
    """Changes by a further step of the iteration.

    The gap g that is left in contact changes the approach by its mean, weighted with the pressure of a flat
    punch, which is nowhere negative: by no more than the largest |g|. The pressure changes
    by A^-1 g, about P g, and the radius by no larger a part.
    """
    found = level.found
    left = min(found.left, level.noise)
    gap = 0.0
    if indenter.approach is None:
        gap = float(np.max(np.abs(found.gap[found.pressure > 0])))
    peak = float(np.max(found.pressure))
    return {"contact_radius": level.radius * left / peak, "approach": gap, "peak_pressure": left}


def other_conversion(numerics: Numerics) -> Numerics:
    """Numerics to compare the conversion with: half its points, or the better conversion."""
    if numerics.conversion == "split":
        return replace(numerics, hankel_points=numerics.hankel_points // 2)
    return replace(numerics, conversion="split")
