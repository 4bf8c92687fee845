"""Exact surface deflection of the layered half-space under an axisymmetric pressure.

For p = sqrt(t) q(t), t = 1 - (r/a)^2, Abel's integral turns the pressure into phi on 0 <= x <= 1,

    p(r) = -int_r^a d phi/dx dx / sqrt(x^2 - r^2),     phat(k) = int_0^a phi cos(kx) dx,

and the deflection, with M(k) the compliance of the layers over that of the first material (E1*), is

    u(r) = (2/E1*) [ int_0^min(r, a) phi(x) dx / sqrt(r^2 - x^2) + int_0^inf (M - 1) phat(k) J0(kr) dk ]:

Sneddon, Fourier Transforms (1951), section 52.3, for the first; the second converges like exp(-2 k h).
Independent of any patches: `collocation` solves the contact of a sphere with it, `defect_correction` measures
the error of constant patches on it.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.polynomial import chebyshev, legendre
from numpy.typing import NDArray
from scipy.interpolate import PPoly, make_interp_spline
from scipy.special import j0

__all__ = [
    "LayerTable",
    "cosine_transform",
    "cosine_transforms",
    "deflection",
    "from_potential",
    "gauss_legendre",
    "layer_table",
    "over_circle",
    "potential",
    "wavenumbers",
]

Array = NDArray[np.floating]

CYCLES = 3000.0  # largest k a: complete for coatings down to h = a/200
PHASE, NODES = 12.0, 16  # of two oscillating factors on a short Gauss panel [rad], and its points
WIDER = 6.0  # a long one: with NODES and half its phase to rounding
# Chebyshev nodes a unit of the stretched radius, then points of splines of degree 7 through their polynomial:
# within 1e-11 of the deflection of the homogeneous solid down to films of a/250, within 1e-10 to a/600.
NODES_A_UNIT, POINTS_A_UNIT, DEGREE = 10, 40, 7


@dataclass(frozen=True, eq=False)
class LayerTable:
    """What the layers add to the deflection under profiles of about one radius a, all of it over r/a and k a.

    It is smooth on a scale of the distance from the edge, next to it of the ``length``,

        r/a = 1 + length sinh(x),      x the Chebyshev nodes of ``ends``.

    excess : M(k) - 1, k [rad/m].  k : of k a, with quadrature ``weight``, (nk,).
    bessel : J0(kr), (nodes, nk).  transforms : of `cosine_transforms`, (terms, nk).
    """

    excess: Callable[[Array], Array]
    k: Array
    weight: Array
    bessel: Array
    transforms: Array
    length: float
    ends: tuple[float, float]

    def __call__(self, a: float, phi: Array, rho: Array) -> Array:
        """int (M - 1) phat J0(kr) dk [Pa m] of phi = a x' sum phi_m P_m(2x' - 1), r = a rho of any shape."""
        phat = phi @ self.transforms[: len(phi)]
        c = _chebyshev(self.bessel @ (self.weight * self.excess(self.k / a) * phat))
        x = np.linspace(*self.ends, int(POINTS_A_UNIT * (self.ends[1] - self.ends[0])) + 2 * DEGREE)
        values = chebyshev.chebval(np.linspace(-1, 1, x.size), c)
        spline = PPoly.from_spline(make_interp_spline(x, values, k=DEGREE))
        found: Array = a * spline(np.arcsinh((rho - 1) / self.length))
        return found


def wavenumbers(reach: float, last: float, scale: float = np.inf) -> tuple[Array, Array]:
    """Gauss points k <= last and their weights, for phases up to k reach and panels up to ``scale``.

    Panels shrink geometrically towards k = 0, where stiff films on soft solids bend. Long ones take fewer
    points: half a point a radian, and the same number above that.
    """
    width = min(PHASE / reach, scale, last / 4)
    points, weights = _on_panels(np.concatenate([[0], np.geomspace(1e-4 * width, width, 10)]), NODES)
    if last <= width:
        return points, weights
    panels = int((last - width) / min(WIDER * width, scale)) + 1
    nodes = NODES + int(reach * (last - width) / panels / 2)
    k, weight = _on_panels(np.linspace(width, last, panels + 1), nodes)
    return np.concatenate([points, k]), np.concatenate([weights, weight])


def _on_panels(edges: Array, nodes: int) -> tuple[Array, Array]:
    s, w = gauss_legendre(nodes)
    half = np.diff(edges)[:, None] / 2
    return (edges[:-1, None] + half * (1 + s)).ravel(), (half * w).ravel()


@lru_cache
def gauss_legendre(nodes: int) -> tuple[Array, Array]:
    """Nodes on [-1, 1] and their weights, read-only, (nodes,) each."""
    s, w = legendre.leggauss(nodes)
    s.flags.writeable = w.flags.writeable = False
    return s, w


def layer_table(
    excess: Callable[[Array], Array], depth: float, radius: float, reach: float, terms: int
) -> LayerTable:
    """Table for contacts of about ``radius``, profiles of at most ``terms`` and points r <= reach.

    excess : M(k) - 1, k [rad/m].  depth : of the first interface that reflects [m], for exp(-2 k depth).
    """
    depth, reach = depth / radius, reach / radius
    k, weight = wavenumbers(1.1 + reach, min(14 / depth, CYCLES))
    length = 2 * min(depth, 0.1)
    ends = float(np.arcsinh(-1 / length)), float(np.arcsinh((reach - 1) / length))
    nodes = chebyshev.chebpts1(int(NODES_A_UNIT * (ends[1] - ends[0])) + 16)
    rho = 1 + length * np.sinh(ends[0] + (nodes + 1) / 2 * (ends[1] - ends[0]))
    transforms = cosine_transforms(terms, k)
    return LayerTable(excess, k, weight, j0(np.outer(rho, k)), transforms, length, ends)


def deflection(
    radius: float, coefficients: Array, E_star: float, table: LayerTable | None, r: Array
) -> Array:
    """u(r) [m] under p = sqrt(t) sum b_m P_m(2t - 1).

    radius : a [m].  coefficients : b_m [Pa].  E_star : E1/(1 - nu1^2) [Pa] of the first material.
    table : of the layers, None for the homogeneous solid.  r [m], any shape.
    """
    phi, rho = potential(coefficients), np.asarray(r) / radius
    inside = rho <= 1
    # a polynomial in rho^2 inside, smooth in the root of the distance outside
    y = chebyshev.chebpts1(phi.size + 1)
    far = float(np.sqrt(max(np.max(rho) - 1, 1e-2)))
    x = chebyshev.chebpts1(phi.size // 2 + int(24 * (1 + far)))
    u = np.empty(rho.shape)
    for part, nodes, at in (
        (inside, np.sqrt((1 - y) / 2), 1 - 2 * rho[inside] ** 2),
        (~inside, 1 + (far * (1 + x) / 2) ** 2, 2 / far * np.sqrt(rho[~inside] - 1) - 1),
    ):
        u[part] = radius * chebyshev.chebval(at, _chebyshev(_homogeneous(phi, nodes)))
    if table is not None:
        u += table(radius, phi, rho)
    return 2 / E_star * u


def _chebyshev(values: Array) -> Array:
    """Coefficients of the polynomial through ``values`` at as many Chebyshev nodes of [-1, 1]."""
    n = len(values)
    c: Array = chebyshev.chebvander(chebyshev.chebpts1(n), n - 1).T @ values * (2 / n)
    c[0] /= 2
    return c


def potential(coefficients: Array) -> Array:
    """phi_m [Pa] of phi = a x' sum phi_m P_m(2x' - 1), x' = 1 - (x/a)^2, from b_m [Pa]."""
    return np.linalg.solve(_abel(len(coefficients)), coefficients)


def from_potential(phi: Array) -> Array:
    """b_m [Pa] from phi_m [Pa], the inverse of `potential`."""
    return _abel(len(phi)) @ phi


@lru_cache
def _abel(terms: int) -> Array:
    """Column j: Legendre coefficients of q(t) = 2 int_0^1 phi'(t (1 - v^2)) dv for phi = x' P_j(2x' - 1)."""
    v, w = gauss_legendre(terms + 1)
    v, w = (1 + v) / 2, w / 2
    s, ws = gauss_legendre(terms)
    y = (1 + s)[:, None] / 2 * (1 - v**2)
    P = legendre.legvander(2 * y - 1, terms - 1)
    slope = P + 2 * y[..., None] * (P[..., : max(terms - 1, 1)] @ legendre.legder(np.eye(terms)))
    project = (ws[:, None] * legendre.legvander(s, terms - 1)).T * (np.arange(terms)[:, None] + 0.5)
    return project @ np.einsum("tvj,v->tj", 2 * slope, w)


def over_circle(terms: int, rho: Array) -> Array:
    """int_0^min(rho, 1) x' P_m(2x' - 1) dx / sqrt(rho^2 - x^2) for m < terms, (rho.size, terms).

    x' = 1 - x^2, x = rho sin(theta): a polynomial in sin(theta), exact to rounding.
    """
    y, weight = _on_circle(terms, rho)
    return np.einsum("rs,rsm->rm", weight, legendre.legvander(2 * y - 1, terms - 1), optimize=True)


def _homogeneous(phi: Array, rho: Array) -> Array:
    """The same of x' sum phi_m P_m(2x' - 1), (rho.size,): the deflection of a homogeneous solid."""
    y, weight = _on_circle(len(phi), rho)
    return np.einsum("rs,rs->r", weight, legendre.legval(2 * y - 1, phi))


def _on_circle(terms: int, rho: Array) -> tuple[Array, Array]:
    """Gauss points x' in theta, and weights that contain x', (rho.size, points) each."""
    s, w = gauss_legendre(2 * terms + 16)
    end = np.arcsin(np.minimum(1, 1 / np.maximum(rho, 1e-300)))
    x = rho[:, None] * np.sin(end[:, None] * (1 + s) / 2)
    y = 1 - np.minimum(x, 1) ** 2
    return y, y * w * (end[:, None] / 2)


def cosine_transform(phi: Array, k: Array) -> Array:
    """int_0^1 phi(x) cos(kx) dx of phi = x' sum phi_m P_m(2x' - 1), x' = 1 - x^2."""
    return (phi @ _even_legendre(len(phi))) @ _even_spherical_bessel(len(phi) + 1, k)


def cosine_transforms(terms: int, k: Array) -> Array:
    """The same of every x' P_m(2x' - 1), m < terms, (terms, k.size)."""
    return _even_legendre(terms) @ _even_spherical_bessel(terms + 1, k)


@lru_cache
def _even_legendre(terms: int) -> Array:
    """x' P_m(2x' - 1) = sum_i c_mi (-1)^i P_2i(x), (terms, terms + 1): int_0^1 P_2i cos(kx) = (-1)^i j_2i."""
    n = np.arange(terms + 1)
    s, w = gauss_legendre(2 * terms + 4)
    y = 1 - s**2
    value = y[:, None] * legendre.legvander(2 * y - 1, terms - 1)
    even = legendre.legvander(s, 2 * terms)[:, ::2]
    return (value * w[:, None]).T @ (even * ((2 * n + 0.5) * (-1.0) ** n))


def _even_spherical_bessel(count: int, x: Array) -> Array:
    """j_0, j_2, .. j_2(count-1), (count, x.size): by j_(n+1) + j_(n-1) = (2n+1)/x j_n.

    Upwards where x exceeds the order; elsewhere downwards from so high an order that its values are nothing
    but rounding, scaled to j_0 or j_1 in the end (Miller; Abramowitz and Stegun 10.5).
    """
    found = np.empty((count, x.size))
    large = x > 2 * count
    y = x[large]
    below, here = np.sin(y) / y, np.sin(y) / y**2 - np.cos(y) / y
    for i in range(count):
        found[i, large] = below
        for n in (2 * i, 2 * i + 1):
            below, here = here, (2 * n + 3) / y * here - below
    y = np.maximum(x[~large], 1e-8)
    scaled = np.zeros((count, y.size))
    here, above = np.full(y.size, 1e-250), np.zeros(y.size)
    for n in range(2 * count + 16 + int(15 * np.cbrt(count)), 0, -1):
        if n % 2 == 0 and n < 2 * count:
            scaled[n // 2] = here
        here, above = (2 * n + 1) / y * here - above, here
        if np.abs(here).max(initial=0.0) > 1e200:
            huge = np.abs(here) > 1e200
            here[huge] *= 1e-250
            above[huge] *= 1e-250
            scaled[:, huge] *= 1e-250
    scaled[0] = here
    j_0 = np.sin(y) / y
    j_1 = np.where(y < 1e-2, y / 3 * (1 - y**2 / 10 * (1 - y**2 / 28)), (j_0 - np.cos(y)) / y)
    first = np.abs(j_0) >= np.abs(j_1)
    found[:, ~large] = scaled * (np.where(first, j_0, j_1) / np.where(first, here, above))
    return found
