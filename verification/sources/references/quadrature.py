"""Gauss-Legendre quadrature, each rule found once."""

from functools import cache

import numpy as np
from numpy.polynomial import legendre

from verification.problem.arrays import Array

__all__ = ["gauss_legendre", "wavenumber_panels"]


@cache
def gauss_legendre(nodes: int) -> tuple[Array, Array]:
    """Nodes on [-1, 1] with their weights, not to be written to."""
    s, w = legendre.leggauss(nodes)
    s.flags.writeable = w.flags.writeable = False
    return s, w


def wavenumber_panels(end: float, first: float, widest: float, nodes: int) -> tuple[Array, Array]:
    """Wavenumbers on (0, ``end``) with their weights, ``nodes`` Gauss points a panel.

    Panels begin with width min(first, widest), where the response of the layers bends, and grow by half up to
    ``widest``, which the oscillation of the integrand sets. All in rad/m.
    """
    width, edges = min(first, widest), [0.0]
    while edges[-1] < end:
        edges.append(min(edges[-1] + width, end))
        width = min(1.5 * width, widest)
    left, (s, w) = np.array(edges), gauss_legendre(nodes)
    half = 0.5 * np.diff(left)
    return ((left[:-1] + half)[:, None] + half[:, None] * s).ravel(), (half[:, None] * w).ravel()
