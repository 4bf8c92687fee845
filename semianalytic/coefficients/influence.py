"""Conversion of a frequency response into influence coefficients of the surface displacement.

Under pressure a coated half-space deflects by u_z(k) = 2/(E* k) M(k) p(k), flat and elastic ball together by
the sum of both (``response``). Their influence coefficient is the displacement at one patch centre under unit
pressure on another patch, the square of side d:

    K_ij = 1/(pi E*) C_ij,    C(x, y) = int int_patch g(r),    g(r) = int_0^inf M(k) J0(kr) dk.

The two conversions from M to C:

split      M = 1 + c e^(-b k) + R(k). The first two are Love's rectangle at the surface and at
           depth b, in closed form; c = M(0)-1 removes the long range. R is small at both ends, so its
           Hankel transform on a logarithmic grid (Hamilton, Mon. Not. R. Astron. Soc. 312 (2000) 257-284)
           serves every length from the thinnest coating to the whole grid at once: within 4e-10 of
           quadrature for modulus ratios 0.01 to 100.
plain      M/k times the transform of the patch, aliases summed, FFT on an enlarged domain: Liu and Wang
           (J. Tribol. 124 (2002) 36-45). The kernel is singular at
           k = 0 and slow to decay; its error is 0.4 % at the loaded patch and more far away.
"""

from collections.abc import Callable

import ducc0
import numpy as np
from numpy.typing import NDArray

from semianalytic import numbers
from semianalytic.coefficients import halfspace
from semianalytic.coefficients.response import Response
from semianalytic.inputs import Body, Numerics
from semianalytic.stresses.ring_quadrature import gauss_legendre

Array = NDArray[np.floating]
Function = Callable[[Array], Array]


def surface_coefficients(n: int, d: float, body: Body, numerics: Numerics) -> Array:
    """Influence coefficients K [m/Pa] of the surface displacement by the conversion of ``numerics``.

    With an elastic ball, of the approach of both surfaces: u_z of the flat plus that of the ball.

    n : offsets 0..n-1.  d : side of the patches [m].  Returns shape (n, n), even in both indices.
    """
    both = body.response
    if numerics.conversion == "plain":
        excess = both.excess if both else np.zeros_like
        K = plain_coefficients(n, d, excess, threads=numerics.threads)
    else:
        K = halfspace.surface_deflection(n, d)
        if both:
            K += remainder_coefficients(n, d, both, points=numerics.hankel_points)
            c, b = both.image
            of_image = halfspace.surface_deflection(n, d, b)
            of_image *= c
            K += of_image
    K *= 1 / (np.pi * body.contact_modulus)
    return K


def remainder_coefficients(n: int, d: float, response: Response, *, points: int = 4096) -> Array:
    """Integral over a patch of the part of g(r) not due to Love's rectangle and its image.

        C_ij = int int_patch(i, j) int_0^inf R(k) J0(k r) dk,    R = M - 1 - c e^(-b k)

    n : offsets 0..n-1.  d : side of the patches [m].  response : of the surface, with R and its image.
    points : of the logarithmic Hankel grid.
    Returns [m], shape (n, n), even in both indices.
    """
    g, on_disc = response.radial(points)
    near = 2 * response.first / d  # g is singular no nearer than the image of the surface, at depth 2 h
    mean = _average(_average(_octant(g, n + 3, d)).T).T
    mean *= d * d
    if near < numbers.AVERAGED:
        corner = _corner(g, on_disc, min(int(numbers.AVERAGED), n), d, near)
        mean[: len(corner), : len(corner)] = corner
    return mean


def _corner(g: Function, on_disc: Function, n: int, d: float, near: float) -> Array:
    """Integrals [m] over the patches next to the loaded one by Gauss quadrature, shape (n, n).

    near : distance to the nearest singularity of g, in patches.
    """
    mean, inner = np.empty((n, n)), 0
    for edge in (3.0, numbers.AVERAGED):
        outer = min(int(np.ceil(edge)), n)
        reach = np.hypot(near, max(inner - 1, 0.5))
        _gauss_block(mean, g, d, inner, outer, reach)
        inner = outer
    # the loaded patch, which may be far wider than the coating is thick, in polar coordinates
    angle, w = gauss_legendre(16, 0.0, np.pi / 4)
    mean[0, 0] = 8 * np.sum(w * on_disc(d / 2 / np.cos(angle)))
    return mean


def plain_coefficients(
    n: int, d: float, excess: Function, *, enlarge: int = 4, aliases: int = 2, threads: int = 1
) -> Array:
    """Conversion of Liu and Wang: C by FFT of M/k times the transform of the patch shape.

    Liu and Wang (2002) eq. 13 with ``aliases`` AL on either side and the domain ``enlarge`` times the
    kernel's. At k = 0, where M/k is infinite, the mean of M(0)/k over the frequency cell.

    Returns [m], shape (n, n), even in both indices.
    """
    m = 2 * int(ducc0.fft.good_size(enlarge * n, True))
    dk = 2 * np.pi / (m * d)
    kx = dk * np.arange(m // 2 + 1)
    spectrum = np.zeros((kx.size, kx.size))
    for shift in np.ndindex(2 * aliases + 1, 2 * aliases + 1):
        ax, ay = (kx + (s - aliases) * 2 * np.pi / d for s in shift)
        k = np.hypot(ax[:, None], ay[None, :])
        shape = np.sinc(ax * d / (2 * np.pi))[:, None] * np.sinc(ay * d / (2 * np.pi))[None, :]
        k[k == 0] = np.inf
        k_finite = np.where(np.isinf(k), dk, k)
        M = 1 + excess(k_finite.ravel()).reshape(k.shape)
        spectrum += np.where(np.isinf(k), 0, M / k) * shape
    # mean of 1/k over the square cell |kx|, |ky| < dk/2
    M0 = 1 + float(excess(np.array([1e-6 * dk]))[0])
    spectrum[0, 0] += M0 * 4 * np.arcsinh(1.0) / dk
    quadrant = ducc0.fft.dct(spectrum, axes=(0, 1), type=1, nthreads=threads)
    return quadrant[:n, :n] * (2 * np.pi / (m * m))


def _octant(g: Function, n: int, d: float) -> Array:
    """g at the patch centres, computed up to the diagonal."""
    table: Array = np.empty((n, n))
    i, j = np.tril_indices(n)
    table[i, j] = table[j, i] = g(d * np.hypot(i, j))
    return table


def _average(table: Array) -> Array:
    """Mean over a patch along the first index: (delta/2)/asinh(delta/2) to sixth differences.

    Of all rows but the last three, whose neighbours are not in the table.
    """
    weights = np.array([1.0, 0, 0, 0])
    for factor, row in (
        (1 / 24, (-2, 1, 0, 0)),
        (-17 / 5760, (6, -4, 1, 0)),
        (367 / 967680, (-20, 15, -6, 1)),
    ):
        weights += factor * np.array(row)
    first, *others = weights.tolist()
    n = table.shape[0] - 3
    rows = np.concat([table[3:0:-1], table])
    mean = table[:n] * first
    for j, weight in enumerate(others, start=1):
        mean += weight * (rows[3 - j : n + 3 - j] + rows[3 + j : n + 3 + j])
    return mean


def _gauss_block(mean: Array, g: Function, d: float, inner: int, outer: int, reach: float) -> None:
    """Overwrite the patches inner <= max(i, j) < outer by Gauss quadrature, in place.

    reach : distance to the nearest singularity of g in patches, sets the order: error rho^(-2 order).
    """
    t = 2 * max(reach, 0.05)
    order = int(np.ceil(-np.log(numbers.NEGLIGIBLE) / (2 * np.log(t + np.hypot(t, 1)))))
    s, w = gauss_legendre(max(order, 3), -0.5, 0.5)
    i, j = np.tril_indices(outer)
    ring = i >= inner
    i, j = i[ring], j[ring]
    X = (i[:, None] + s)[:, :, None]
    Y = (j[:, None] + s)[:, None, :]
    value = np.einsum("pij,i,j->p", g(d * np.hypot(X, Y)), w, w) * d * d
    mean[i, j] = mean[j, i] = value
