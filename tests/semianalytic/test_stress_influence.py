"""Influence coefficients of stress, and of displacement below the surface, against direct quadrature."""

import numpy as np
import pytest
from scipy.special import jv

from semianalytic.coefficients.frf import displacement_frf, stress_frf
from semianalytic.coefficients.point_force import (
    combine_displacement,
    combine_stress,
    directions,
    displacement_below,
    stress_below,
)
from semianalytic.inputs import Body

SUBSTRATE = (210e9, 0.3)
FRICTION = 0.5
TOLERANCE = 1e-7  # of the largest coefficient
RADII = np.array([0, 0.004, 0.02, 0.1, 1, 7])  # over the depth or the scale


def panels(radius, scale):
    """Nodes k, weights / 2 pi for responses that die like exp(-k scale) and change down to 1e-9 / scale."""
    width = min(1 / scale, 2 / radius if radius else np.inf)
    edges = np.concatenate([[0], np.geomspace(1e-9, 1, 45), np.arange(2, int(45 / scale / width) + 2)])
    u, w = np.polynomial.legendre.leggauss(12)
    half = np.diff(edges * width)[:, None] / 2
    return (edges[:-1, None] * width + half * (1 + u)).ravel(), (half * w).ravel() / (2 * np.pi)


def by_quadrature(r, c, s, z, layer, scale, excess, body):
    """Stress xx, yy, zz, xy, xz, yz below a point force at (r c, r s): Gauss panels of a period and less."""
    out = []
    for radius in r:
        k, weight = panels(radius, scale)
        weight = weight * k

        def response(load, k=k):
            return stress_frf(k, np.array([z]), layer, load=load, excess=excess, **body)[:, 0]

        def H(m, F, k=k, weight=weight, radius=radius):
            return (jv(m, k * radius) * F) @ weight

        zz, Lz, LL, TT = response("normal")
        mean, half_difference = H(0, (LL + TT) / 2), -(c * c - s * s) * H(2, (LL - TT) / 2)
        xy, xz, yz, s_zz = -2 * c * s * H(2, (LL - TT) / 2), -c * H(1, Lz), -s * H(1, Lz), H(0, zz)
        zz, Lz, LL, TT = response("in-plane")
        A, B = response("anti-plane")
        E, G = H(1, (LL - TT) / 2 - B), H(3, (LL - TT) / 2 + B)
        cos3, sin3 = 4 * c**3 - 3 * c, 3 * s - 4 * s**3
        mean -= FRICTION * c * H(1, (LL + TT) / 2)
        half_difference -= FRICTION * (c * E - cos3 * G) / 2
        s_zz -= FRICTION * c * H(1, zz)
        xy -= FRICTION * (s * E - sin3 * G) / 2
        xz -= FRICTION * (H(0, Lz + A) - (c * c - s * s) * H(2, Lz - A)) / 2
        yz += FRICTION * c * s * H(2, Lz - A)
        out.append([mean + half_difference, mean - half_difference, s_zz, xy, xz, yz])
    return np.array(out).T


def displacement_by_quadrature(r, c, s, z, layer, scale, body):
    """Displacement x, y, z below a point force at (r c, r s), likewise."""
    out = []
    for radius in r:
        k, weight = panels(radius, scale)

        def response(load, k=k):
            return displacement_frf(k, np.array([z]), layer, load=load, **body)[:, 0]

        def H(m, F, k=k, weight=weight, radius=radius):
            return (jv(m, k * radius) * F) @ weight

        u_z, U = response("normal")
        x, y, down = -c * H(1, U), -s * H(1, U), H(0, u_z)
        u_z, U = response("in-plane")
        (V,) = response("anti-plane")
        across = H(2, U - V)
        x -= FRICTION * (H(0, U + V) - (c * c - s * s) * across) / 2
        y += FRICTION * c * s * across
        out.append([x, y, down - FRICTION * c * H(1, u_z)])
    return np.array(out).T


def stack(ratio, h, layers, nu):
    E = ratio * SUBSTRATE[0]
    if layers == 1:
        return ((E, nu, h),)
    return tuple(
        (E if i % 2 == 0 else np.sqrt(E * SUBSTRATE[0]), 0.1 * i, h * (1 + i / 2)) for i in range(layers)
    )


def at(table, combine, r):
    """Components from a table at the distances r in the direction (0.8, 0.6)."""
    harmonics = np.repeat(directions(np.array([0.8]), np.array([0.6])), r.size, axis=1)
    return combine(table.radial(np.arcsinh(r / table.scale)).T, harmonics, FRICTION)


def check_tables(ratio, h, layers, nu, tolerance=TOLERANCE):
    """Tables above and below every kind of interface; patches of side 1, shallow ones within 3 of them."""
    coatings = stack(ratio, h, layers, nu)
    body = {"coatings": coatings, "substrate": SUBSTRATE}
    interfaces = np.cumsum([c[2] for c in coatings])
    places = [(0.0, 0, True), (min(h, 2.9), 0, True), (interfaces[0], 1, False)]
    places += [(3.0, int(np.searchsorted(interfaces, 3.0)), False), (interfaces[-1] + 1, layers, False)]
    for z, layer, excess in places:
        scale = 2.0 ** np.floor(np.log2(2 * h - z if excess else z))
        (table,) = stress_below(np.array([z]), layer, scale, Body(friction=FRICTION, **body), excess=excess)
        r = RADII * scale
        expected = by_quadrature(r, 0.8, 0.6, z, layer, scale, excess, body)
        # shallow in the first layer the closed form, of order 1, is added to the table
        largest = max(np.abs(expected).max(), float(excess))
        assert np.abs(at(table, combine_stress, r) - expected).max() <= tolerance * largest, (z, layer)
    z, layer, _ = places[3]
    scale = 2.0 ** np.floor(np.log2(z))
    (table,) = displacement_below(np.array([z]), layer, scale, Body(friction=FRICTION, **body))
    expected = displacement_by_quadrature(RADII * scale, 0.8, 0.6, z, layer, scale, body)
    error = at(table, combine_displacement, RADII * scale) - expected
    assert np.abs(error).max() <= tolerance * np.abs(expected).max(), "displacement"


@pytest.mark.parametrize(
    ("ratio", "h", "layers", "nu"),
    [
        (100.0, 2560.0, 1, 0.5),
        (100.0, 5120.0, 5, 0.25),
        (0.01, 0.5, 1, 0.0),
        (100.0, 0.5, 2, 0.25),
        (0.01, 3.0, 5, 0.25),
    ],
)
def test_coated_influence_is_the_quadrature(ratio, h, layers, nu):
    check_tables(ratio, h, layers, nu)


@pytest.mark.slow
@pytest.mark.parametrize("layers", [1, 2, 5])
@pytest.mark.parametrize("h", [0.5, 3.0, 40.0, 2560.0])  # patches: half a patch .. 20 a_h at 128 to a_h
@pytest.mark.parametrize("ratio", [0.01, 0.25, 4.0, 100.0])
def test_coated_influence_is_the_quadrature_over_the_range(ratio, h, layers):
    for nu in (0.0, 0.5) if layers == 1 else (0.25,):
        check_tables(ratio, h, layers, nu)
