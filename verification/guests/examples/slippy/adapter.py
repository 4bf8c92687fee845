"""Coated half-space of slippy: its published response function in a Polonsky-Keer iteration.

Li, Pohrt, Lyashenko, Popov, Proc. IMechE J 234 (2020) 73-83, (9) to (10), arXiv:1807.01885. As in slippy the
transform is periodic, with no response of the mean pressure, so that the approach has a free constant.
"""

import numpy as np


def compliance(k, E1, nu1, h, E2, nu2):
    """u_z(k) / p(k) [m/Pa] of one coating, k > 0 [rad/m]."""
    s, t, m, n = E1 * (1 + nu2), E2 * (1 + nu1), 3 - 4 * nu1, 3 - 4 * nu2
    A, B, D = (m * t - n * s) * (s - t), 4 * (t + n * s) * (s - t), (t + n * s) * (m * t + s)
    C = -n * s**2 - 2 * s * t * (2 * nu1 - 1) * (2 * nu2 - 1) + t**2 * (8 * nu1**2 - 12 * nu1 + 5)
    e, q = np.exp(-2 * k * h), k * h
    return 2 * (1 - nu1**2) / (E1 * k) * (A * e**2 + B * q * e + D) / (-A * e**2 + (2 * C - B * q**2) * e + D)


def solve(radius, load, substrate, coatings=(), patches=256):
    """``patches`` a side of a period of (patches / 3)^(1/2) Hertz radii: one parameter refines both."""
    n, (E, nu), (E1, nu1, h) = int(patches), substrate, (*coatings, (*substrate, 1.0))[0]
    side = (n / 3) ** 0.5 * (3 * load * radius * (1 - nu**2) / (4 * E)) ** (1 / 3)
    x = (np.arange(n) - n // 2) * side / n
    k = 2 * np.pi * np.hypot(np.fft.fftfreq(n, side / n)[:, None], np.fft.rfftfreq(n, side / n))
    k[0, 0] = 1e100 / side  # no response of the mean pressure
    frf = compliance(k, E1, nu1, h, E, nu)
    gap = (x[:, None] ** 2 + x**2) / (2 * radius)
    p, t, old, delta = np.where(gap < gap.max() / 50, 1.0, 0.0), np.zeros_like(gap), 1.0, 0.0
    for _ in range(500):
        p *= load / (p.sum() * (side / n) ** 2)
        on, g = p > 0, np.fft.irfft2(frf * np.fft.rfft2(p), s=p.shape) + gap
        g -= g[on].mean()
        if np.abs(g[on]).max() < 1e-8 * gap.max():
            break
        t, old = np.where(on, g + delta * (g[on] @ g[on]) / old * t, 0.0), g[on] @ g[on]
        r = np.fft.irfft2(frf * np.fft.rfft2(t), s=p.shape)
        step, inside = (g[on] @ t[on]) / ((r - r[on].mean())[on] @ t[on]), ~on & (g < 0)
        p, delta = np.maximum(p - step * t, 0) * on - np.where(inside, step * g, 0), float(not inside.any())
    a, row = np.sqrt((p > 0).sum() / np.pi) * side / n, p[n // 2]
    return {"contact_radius": a, "peak_pressure": p.max(), "pressure": lambda at, y: np.interp(at, x, row)}
