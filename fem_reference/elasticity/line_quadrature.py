"""Gauss-Legendre quadrature on intervals."""

import numpy as np

Ends = float | np.ndarray


def gauss_legendre(nodes: int, lower: Ends, upper: Ends) -> tuple[np.ndarray, np.ndarray]:
    """Points from ``lower`` to ``upper`` and their weights, those of many intervals in a row."""
    s, w = np.polynomial.legendre.leggauss(nodes)
    low = np.atleast_1d(lower)[:, None]
    half = (np.atleast_1d(upper)[:, None] - low) / 2
    return (low + half * (1 + s)).ravel(), (half * w).ravel()
