"""Numerical uncertainty: Roache's refinement study on three grids, and a term for each other cause.

    U = SAFETY max(e1, e2/r^(3P/2)) / (r^p - 1) + others,    p = ln(e2/e1) / ln r,    P/2 <= p <= P

with e1 and e2 the changes on refining the patches the last time and the time before, r the last refinement,
P the order of the method and p the one observed. The second term stands for e1 where that is small by chance.
Changes of a field cross zero where its error does not: its e1 and e2 are the largest ones within
``NEIGHBOURHOOD`` times the distance to the contact edge, at the same share of the way to it.

P. J. Roache, J. Fluids Eng. 116 (1994) 405-413; ASME V&V 20-2009, section 2; limits of p: L. Eca and
M. Hoekstra, J. Comput. Phys. 262 (2014) 104-130.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import RegularGridInterpolator

from semianalytic import numbers
from semianalytic.coefficients import influence
from semianalytic.inputs import Body, Numerics
from semianalytic.patches import convolution
from semianalytic.patches.grid import odd
from semianalytic.patches.level import Indenter, Level

Array = NDArray[np.floating]
# at x, y, z [m] in layers: of all levels, (levels, components, n)
Sampled = Callable[[Array, Array, Array, NDArray[np.intp]], Array]

# Of a tensor xx, xy, .. zz, a displacement and a pressure: components that turn into each other about the
# normal have one uncertainty.
TURNING = {9: (0, 0, 2, 0, 0, 2, 2, 2, 1), 3: (0, 0, 1), 1: (0,)}


def refined(last: ArrayLike, before: ArrayLike, ratio: float, order: float) -> Array:
    """U of values that changed by ``last`` on refining the patches ``ratio`` times and by ``before`` then."""
    e1, e2 = np.abs(last), np.abs(before)
    with np.errstate(divide="ignore", invalid="ignore"):
        observed = np.log(e2 / e1) / np.log(ratio)
    p = np.clip(np.where(np.isnan(observed), order, observed), order / 2, order)
    return np.asarray(numbers.SAFETY * np.maximum(e1, e2 / ratio ** (1.5 * order)) / (ratio**p - 1))


def of_levels(levels: Sequence[Level], values: ArrayLike) -> Array:
    """``refined`` of values on three levels, the finest first, along the first axis."""
    fine, middle, coarse = np.asarray(values)
    return refined(fine - middle, middle - coarse, levels[0].grid.n / levels[1].grid.n, order_of(levels[0]))


def order_of(level: Level) -> float:
    """Order of the method: the first of patches alone and of a shape that is fitted near the edge alone."""
    outside = level.shape is not None and level.shape.outside
    return numbers.ORDERS[1 if outside or level.smooth() is None else 0]


@dataclass(frozen=True, eq=False)
class ChangeTable:
    """Uncertainty of a field in one layer by the size of the patches, over share of the way and depth.

    values : (kinds, shares, depths), see ``TURNING``.
    """

    shares: Array
    depths: Array
    values: Array

    @classmethod
    def of(
        cls, levels: Sequence[Level], sampled: Sampled, interfaces: Sequence[float], turning: bool
    ) -> "list[ChangeTable]":
        """Tables of the layers between ``interfaces`` [m], from 0, below a smooth edge.

        levels : the finest first.  sampled : asked once, so that the layers share the rings around a point.
        turning : whether friction makes a field depend on the direction under a round contact.
        """
        shape = levels[0].shape
        assert shape is not None
        a, d = min(shape.axes), levels[0].grid.d
        beside = np.geomspace(d / 2, a, numbers.TABLE) / a
        shares = np.unique(
            np.concatenate([[0.0, 1.0], 1 - beside, 1 + beside, 1 + beside[-1] * np.arange(2, 6)])
        )
        below = np.concatenate([[0.0], d * 2.0 ** np.arange(np.ceil(np.log2(numbers.DEEPEST * a / d)))])
        depths = []
        for top, bottom in pairwise(interfaces):
            ends = [top, bottom] if np.isfinite(bottom) else [top, max(2 * top, below[-1])]
            depths.append(np.unique([*ends, *below[(below > ends[0]) & (below < ends[1])]]))
        in_x, in_y = shape.mirrors
        even = in_x and not turning
        angles = np.pi / 4 * np.arange(8)  # of one of the parts that are mirror images of each other
        if in_y:
            angles = angles[: (1 if even else 5) : 2] if shape.round else angles[: 3 if even else 5]
        layer = np.repeat(np.arange(len(depths)), [one.size for one in depths])
        s, angle, z = np.meshgrid(shares, angles, np.concatenate(depths), indexing="ij")
        x, y = shape.on_ray(s.ravel(), angle.ravel())
        found = sampled(x, y, z.ravel(), np.broadcast_to(layer, s.shape).ravel())
        changes = np.abs(np.diff(found.reshape(len(levels), -1, *s.shape), axis=0)).max(axis=3)
        kinds = np.array(TURNING[changes.shape[1]])
        changes = np.stack([changes[:, kinds == k].max(axis=1) for k in range(kinds.max() + 1)])
        ratio, order = levels[0].grid.n / levels[1].grid.n, order_of(levels[0])
        tables = []
        for number, within in enumerate(depths):
            # the largest within the neighbourhood of each node, (kinds, 2, nodes)
            S, Z = (v.ravel() for v in np.meshgrid(a * (shares - 1), within, indexing="ij"))
            reach = np.maximum(numbers.NEIGHBOURHOOD * np.hypot(S, Z), numbers.LEAST_NEIGHBOURHOOD * d)
            near = np.hypot(S[:, None] - S, Z[:, None] - Z) <= reach[:, None]
            here = changes[..., layer == number].reshape(*changes.shape[:2], -1)
            largest = np.stack([np.where(near, one[..., None, :], 0.0).max(axis=-1) for one in here])
            U = refined(largest[:, 0], largest[:, 1], ratio, order)
            tables.append(cls(shares, within, U.reshape(-1, shares.size, within.size)))
        return tables

    def __call__(self, share: Array, z: Array, components: int) -> Array:
        """U of each of the ``components`` at points, (components, n)."""
        places = np.stack([np.clip(share, *self.shares[[0, -1]]), np.clip(z, *self.depths[[0, -1]])], axis=-1)
        U = np.stack(
            [RegularGridInterpolator((self.shares, self.depths), one)(places) for one in self.values]
        )
        return U[list(TURNING[components])]


@dataclass(frozen=True)
class Uncertainty:
    """Numerical uncertainty in SI units; budget : rows (quantity, numerical parameter, value).

    Parameters: patch size, edge, conversion, domain, iteration. The three scalars are the sums of their rows.
    """

    contact_radius: float
    approach: float
    peak_pressure: float
    budget: tuple[tuple[str, str, float], ...]

    @classmethod
    def from_levels(cls, levels: Sequence[Level], others: dict[str, dict[str, float]]) -> "Uncertainty":
        """From three levels, the finest first, and the changes by each ``other`` numerical parameter."""
        rows = []
        for name in levels[0].scalars:
            size = of_levels(levels, [level.scalars[name] for level in levels])
            rows.append((name, "patch size", float(size)))
            rows += [(name, varied, float(change[name])) for varied, change in others.items()]
        names = ("contact_radius", "approach", "peak_pressure")
        total = {name: sum(row[2] for row in rows if row[0] == name) for name in names}
        return cls(**total, budget=tuple(rows))

    def relative_to(self, scalars: dict[str, float]) -> float:
        """The largest uncertainty over its scalar."""
        return max(getattr(self, name) / size for name, size in scalars.items())


def of_contact(levels: list[Level], indenter: Indenter, body: Body, numerics: Numerics) -> Uncertainty:
    """Refinement study of the last three levels; conversion and domain on the coarsest, the others on the
    finest."""
    last, varied = levels[-1], levels[-3]
    unseen = 0.0
    if last.shape is not None and body.response is not None:  # all grids miss it alike: no change shows it
        unseen = body.response.unseen_edge(last.grid.d)
    others = {
        "edge": last.of_edge(unseen),
        "conversion": _by_other_coefficients(varied, body, numerics, other_conversion(numerics), 1.0),
        "domain": _by_other_coefficients(varied, body, numerics, numerics, numbers.FINER),
        "iteration": _of_iteration(last, indenter),
    }
    return Uncertainty.from_levels(levels[:-4:-1], others)


def is_met(accuracy: float, estimate: Uncertainty, levels: list[Level]) -> bool:
    """Whether the scalars, and the pressure under a smooth edge, are as accurate as asked, relative."""
    last, before = (_pressure_change(levels[k], levels[k - 1]) for k in (-1, -2))
    scalars = levels[-1].scalars
    settled = max(last, before / 4) <= accuracy * scalars["peak_pressure"]
    return estimate.relative_to(scalars) <= accuracy and settled


def is_stalled(accuracy: float, reached: Sequence[float], levels: list[Level]) -> bool:
    """Whether the relative uncertainties ``reached``, a grid each, exceed the accuracy and no longer fall.

    They do where a grid is the first to resolve the pressure at the edge: one more shows it.
    """
    resolved = levels[-1].ripple < numbers.SUDDEN * levels[-2].ripple
    settled = _pressure_change(*levels[:-3:-1]) < numbers.SUDDEN * _pressure_change(*levels[-2:-4:-1])
    return (
        reached[-1] > accuracy and numbers.FALL * reached[-1] > reached[-3:][0] and not (resolved or settled)
    )


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
