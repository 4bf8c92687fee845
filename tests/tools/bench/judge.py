"""Residuals of the pressures of patches under a sphere, by coefficients of none of the solvers.

The pressures are put through Love's coefficients coded here, and gap in contact, penetration (over the
approach) and load have to be met within ``LIMIT``.
"""

import numpy as np
from scipy.fft import irfft2, next_fast_len, rfft2

from verification.problem.array_types import FloatArray

__all__ = ["E_STAR", "LIMIT", "RADIUS", "A", "W", "centres", "gap", "residual"]

LIMIT = 1e-6
A, RADIUS, E_STAR = 1.0, 1.0, 1.0  # lengths in contact radii, moduli in E*
W = 4 / 3 * E_STAR * A**3 / RADIUS


def centres(n: int) -> FloatArray:
    """Centres of the ``n`` patches of a side of the square [-2a, 2a]^2."""
    return (np.arange(n) - (n - 1) / 2) * (4 * A / n)


def gap(n: int) -> FloatArray:
    """Height of the sphere over the patches, (n, n)."""
    x = centres(n)
    return (x[:, None] ** 2 + x[None, :] ** 2) / (2 * RADIUS)


def residual(pressure: FloatArray) -> float:
    """The largest of gap in contact and penetration, over the approach, and the relative error of the load.

    pressure : (n, n), E* = 1.
    """
    n = len(pressure)
    d = 4 * A / n
    corner = np.arange(-0.5, n + 0.5)
    X, Y = corner[:, None], corner[None, :]
    # Love (1929): int int dx dy / r over a square, as the corner sum of X asinh(Y/|X|) + Y asinh(X/|Y|)
    f = X * np.arcsinh(Y / np.abs(X)) + Y * np.arcsinh(X / np.abs(Y))
    quadrant = np.diff(np.diff(f, axis=0), axis=1) * d / (np.pi * E_STAR)
    m = next_fast_len(2 * n - 1, real=True)
    kernel = np.zeros((m, m))
    kernel[:n, :n] = quadrant
    kernel[m - n + 1 :, :n] = quadrant[:0:-1]
    kernel[:, m - n + 1 :] = kernel[:, n - 1 : 0 : -1]
    g = irfft2(rfft2(kernel) * rfft2(pressure, s=(m, m)), s=(m, m))[:n, :n] + gap(n)
    loaded = pressure > 0
    g -= (g[loaded].max() + g[loaded].min()) / 2  # the approach that suits the pressure best
    approach = A**2 / RADIUS
    return max(
        float(np.abs(g[loaded]).max() / approach),
        float(-g[~loaded].min() / approach),
        abs(float(pressure.sum()) * d * d / W - 1),
    )
