"""Gauss-Legendre quadrature on [-1, 1] or on panels of an interval."""

from functools import cache

import numpy as np
from numpy.polynomial import legendre

from verification.problem.array_types import Array


@cache
def gauss_legendre(nodes: int) -> tuple[Array, Array]:
    """Nodes on [-1, 1] with their weights, read-only arrays (``nodes``,)."""
    s, w = legendre.leggauss(nodes)
    s.flags.writeable = w.flags.writeable = False
    return s, w


def on_panels(edges: Array, nodes: int) -> tuple[Array, Array]:
    """Nodes with their weights, ``nodes`` in each panel between two ``edges``; same unit as ``edges``."""
    s, w = gauss_legendre(nodes)
    half = 0.5 * np.diff(edges)
    return ((edges[:-1] + half)[:, None] + half[:, None] * s).ravel(), (half[:, None] * w).ravel()


def wavenumber_panels(end: float, first: float, widest: float, nodes: int) -> tuple[Array, Array]:
    """Wavenumbers on (0, ``end``) with their weights, ``nodes`` Gauss points a panel; all in rad/m.

    The first panel is min(first, widest) wide, where the response of the layers varies most; each next one is
    half as wide again, up to ``widest``, which the oscillation of the integrand sets.
    """
    width, edges = min(first, widest), [0.0]
    while edges[-1] < end:
        edges.append(min(edges[-1] + width, end))
        width = min(1.5 * width, widest)
    return on_panels(np.array(edges), nodes)
