"""Gauss points: on an interval, on the arcs of the rings around a point and over their radii."""

import math
from functools import lru_cache
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from semianalytic import numbers

Array = NDArray[np.floating]


def from_gap(delta: Array, width: Array, crossing: NDArray[np.bool_], s: Array) -> tuple[Array, Array]:
    """beta and d beta/ds at s in [0, 1] of arcs from the edge of a gap to ``width`` from its middle, (n,
    nodes)."""
    delta = np.clip(delta, 1e-12, np.where(crossing, width, 4.0))
    ratio = width / delta
    top = np.where(crossing, np.arccosh(np.maximum(ratio, 1)), np.arcsinh(ratio))[:, None]
    e = np.exp(top * s)
    other = np.where(crossing, 1.0, -1.0)[:, None] / e
    half = delta[:, None] / 2
    return half * (e + other), half * top * (e - other)


def panels(
    marks: list[tuple[list[float], bool]], scale: Array, nodes: int, width: float = np.inf
) -> tuple[NDArray[np.intp], Array, Array]:
    """Gauss points on the rings of each point: its index, rho, weight rho d rho, (n,) each.

    marks : radii at which rings touch the edge, ascending, and whether the point is inside.  width [m] : over
    which the pressure changes beside the edge.
    """
    graded = [_graded(*mark, float(depth), width) for mark, depth in zip(marks, scale, strict=True)]
    foot = np.repeat(np.arange(len(graded)), [nodes * len(one) for one in graded])
    begin, length, crowded = np.array([panel for one in graded for panel in one]).T[:, :, None]
    s, w = gauss_legendre(nodes)
    radius = begin + length * np.where(crowded, s**4, s)
    weight = np.abs(length) * np.where(crowded, 4 * s**3, 1.0) * w
    return foot, radius.ravel(), (weight * radius).ravel()


def _graded(
    touches: list[float], inside: bool, scale: float, width: float
) -> list[tuple[float, float, bool]]:
    """Panels of rho up to the last touching ring, from the first or, inside, from 0.

    Of each where it begins, its length, and whether its points crowd where it begins, as s^4; the length is
    negative where that is the upper end.
    """
    found: list[tuple[float, float, bool]] = []

    def plain(a: float, b: float, share: float, pole: float, shortest: float = 0.0) -> None:
        while a < b * (1 - 1e-12):
            longest = max(share * abs(a - pole), shortest)
            step = min(math.hypot(a, scale), longest)
            step = b - a if step > 0.7 * (b - a) else step
            found.append((a, step, False))
            a += step

    first, last = touches[0], touches[-1]
    least = max(first, numbers.ROUNDING * last)
    if inside and first > 0:
        far, near = 0.75 * first, max(0.75 * first, first - width)
        plain(0.0, far, 0.75, first)
        plain(far, near, 0.5, first)
        found.append((first, near - first, True))
    for low, high in pairwise([first, *touches[1:-1], last]):
        if high <= low:
            continue
        # graded from the lower end, from the middle on towards the upper one
        to = (low + high) / 2
        begin = min(0.5 * least, (to - low) / 2, width, scale if low == 0 else np.inf)
        found.append((low, begin, True))
        plain(low + begin, to, 1.5, low)
        end = (high - to) / 2 if high == last else min(0.5 * least, (high - to) / 2)
        near = min(end, width)
        plain(to, high - end, 0.6, high, end)
        plain(high - end, high - near, 0.5, high)
        found.append((high, -near, True))
    return found


@lru_cache
def gauss_legendre(nodes: int, lower: float = 0.0, upper: float = 1.0) -> tuple[Array, Array]:
    """Gauss-Legendre points and weights from ``lower`` to ``upper``."""
    s, w = np.polynomial.legendre.leggauss(nodes)
    return (lower + upper) / 2 + (upper - lower) / 2 * s, (upper - lower) / 2 * w
