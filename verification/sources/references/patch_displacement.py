"""Displacement beside a loaded square of the surface, by direct quadrature around its edge.

Unit pressure on a square of side d displaces the origin by K = C / (pi E1*), where

    C = int int_square g(r) dA,    g(r) = int_0^inf M(k) J0(kr) dk
      = ring int F(r) (x dy - y dx),    F(r) = (1/r^2) int_0^r g(s) s ds = int_0^inf M(k) J1(kr)/(kr) dk

The ring integral is that over the square in polar coordinates around the origin: no integrand is singular,
whether the origin lies inside or outside. M = 1 leaves F = 1/r, the homogeneous solid of Love (1929); M - 1
dies as exp(-2 k h), so Gauss panels over the edge with Gauss panels over the wavenumber give ten digits.
No Fourier grid, no image, no series: it shares nothing with the conversions that it checks.
"""

from collections.abc import Callable

import numpy as np
from scipy.special import j1

from verification.problem.array_types import Array, Coatings
from verification.problem.gauss_legendre import gauss_legendre, wavenumber_panels
from verification.sources.references.layered_half_space import (
    LayeredHalfSpace,
    bending_length,
    contact_modulus,
)

NODES = 20  # Gauss points a panel: 1/r seen from half a side away is met to 2.4^-40


def surface_coefficient(
    x: float, y: float, side: float, coatings: Coatings, substrate: tuple[float, float]
) -> float:
    """u_z [m/Pa] at the origin under unit pressure on the square of ``side`` [m] centred at (x, y) [m].

    The origin must not lie on the rim of the square. Raises ValueError where it does.
    """
    if min(abs(abs(x) - side / 2), abs(abs(y) - side / 2)) < 1e-6 * side:
        raise ValueError(f"({x:g}, {y:g}) m puts the origin in line with the rim of a square of {side:g} m")
    C = over_square(x, y, side, lambda r: 1 / r)
    if coatings:
        h = coatings[0][2]
        k, weight = _wavenumbers(float(np.hypot(abs(x) + side, abs(y) + side)), coatings, substrate)
        excess = weight * (LayeredHalfSpace(coatings, substrate, k).compliance - 1)

        def F(r: Array) -> Array:
            kr = k[:, None] * r[None, :]
            return excess @ (j1(kr) / kr)

        # g is singular no nearer than 2 h below the surface, which sets the panels along the edge.
        C += over_square(x, y, side, F, panels=int(np.ceil(side / (2 * h))))
    return C / (np.pi * contact_modulus(coatings, substrate))


def over_square(x: float, y: float, side: float, F: Callable[[Array], Array], panels: int = 1) -> float:
    """Ring integral of F(r) (x dy - y dx) around the square of ``side`` centred at (x, y), anticlockwise.

    F : of an array of distances from the origin [m].   panels : along each edge, of ``NODES`` points.
    Returns int int_square (r^2 F)'/r dA.
    """
    s, w = gauss_legendre(NODES)
    half = side / (2 * panels)
    t = ((2 * np.arange(panels)[:, None] + 1 + s) * half - side / 2).ravel()
    weight = half * np.tile(w, panels)
    b = side / 2
    # x dy - y dx on the edges x = X (upwards) and y = Y (leftwards) is X dy and Y (-dx).
    total = 0.0
    for X, sign in ((x + b, 1), (x - b, -1)):
        total += sign * X * float(weight @ F(np.hypot(X, y + t)))
    for Y, sign in ((y + b, 1), (y - b, -1)):
        total += sign * Y * float(weight @ F(np.hypot(x + t, Y)))
    return total


def _wavenumbers(reach: float, coatings: Coatings, substrate: tuple[float, float]) -> tuple[Array, Array]:
    """Gauss panels up to exp(-2 k h) = exp(-36), no wider than the oscillation at ``reach``; finer near 0."""
    end = (36 + 2 * np.log(36)) / (2 * coatings[0][2])
    return wavenumber_panels(end, 0.5 / bending_length(coatings, substrate), 8 / reach, NODES)
