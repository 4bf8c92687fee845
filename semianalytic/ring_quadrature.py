"""Gauss points: on an interval, on the arcs of the rings around a point and over their radii."""

from functools import lru_cache
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.floating]

LEAST = 1e-9  # distance from the edge, over the width of the contact, below which a point lies on it


def from_gap(delta: Array, width: Array, crossing: NDArray[np.bool_], s: Array) -> tuple[Array, Array]:
    """beta and d beta/ds at s in [0, 1] of arcs from the edge of a gap to ``width`` from its middle, (n,
    nodes)."""
    delta = np.clip(delta, 1e-12, np.where(crossing, width, 4.0))
    ratio = width / delta
    top = np.where(crossing, np.arccosh(np.maximum(ratio, 1)), np.arcsinh(ratio))[:, None]
    mu = top * s
    e = np.exp(mu)
    c, h = (e + 1 / e) / 2, (e - 1 / e) / 2
    of_gap = crossing[:, None]
    return delta[:, None] * np.where(of_gap, c, h), delta[:, None] * top * np.where(of_gap, h, c)


def panels(
    marks: list[tuple[list[float], bool]], scale: Array, nodes: int
) -> tuple[NDArray[np.intp], Array, Array]:
    """Gauss points on the rings of each point: its index, rho, weight rho d rho, (n,) each.

    marks : radii at which rings touch the edge, ascending, and whether the point is inside.
    """
    foot, radius, weight = [], [], []
    for k, ((touches, inside), depth) in enumerate(zip(marks, scale, strict=True)):
        rho, measure = _graded(touches, inside, float(depth), nodes)
        foot.append(np.full(rho.size, k))
        radius.append(rho)
        weight.append(measure * rho)
    return np.concatenate(foot), np.concatenate(radius), np.concatenate(weight)


def _graded(touches: list[float], inside: bool, scale: float, nodes: int) -> tuple[Array, Array]:
    """Gauss points and weights of rho up to the last touching ring, from the first or, inside, from 0."""
    s, w = gauss_legendre(nodes)
    crowded, slope = s**4, 4 * s**3 * w
    points: list[Array] = []
    weights: list[Array] = []

    def plain(a: float, b: float, share: float, pole: float, shortest: float = 0.0) -> None:
        while a < b * (1 - 1e-12):
            longest = max(share * abs(a - pole), shortest)
            step = min(float(np.hypot(a, scale)), longest)
            step = b - a if step > 0.7 * (b - a) else step
            points.append(a + step * s)
            weights.append(step * w)
            a += step

    first, last = touches[0], touches[-1]
    least = max(first, LEAST * last)
    if inside and first > 0:
        near = 0.75 * first
        plain(0.0, near, 0.75, first)
        points.append(first - (first - near) * crowded[::-1])
        weights.append((first - near) * slope[::-1])
    for low, high in pairwise([first, *touches[1:-1], last]):
        if high <= low:
            continue
        # graded from the lower end, from the middle on towards the upper one
        to = (low + high) / 2
        begin = min(0.5 * least, (to - low) / 2, scale if low == 0 else np.inf)
        points.append(low + begin * crowded)
        weights.append(begin * slope)
        plain(low + begin, to, 1.5, low)
        end = (high - to) / 2 if high == last else min(0.5 * least, (high - to) / 2)
        plain(to, high - end, 0.6, high, end)
        points.append(high - end * crowded[::-1])
        weights.append(end * slope[::-1])
    return np.concatenate(points), np.concatenate(weights)


@lru_cache
def gauss_legendre(nodes: int, lower: float = 0.0, upper: float = 1.0) -> tuple[Array, Array]:
    """Gauss-Legendre points and weights from ``lower`` to ``upper``."""
    s, w = np.polynomial.legendre.leggauss(nodes)
    return (lower + upper) / 2 + (upper - lower) / 2 * s, (upper - lower) / 2 * w
