"""Influence coefficients of the coated solid against direct quadrature of their definition."""

import pickle

import numpy as np
import pytest
from scipy.special import j0, sici

from semianalytic import numbers
from semianalytic.coefficients import frf, halfspace, influence
from semianalytic.coefficients.response import Response, response
from semianalytic.inputs import Body, Numerics

SUBSTRATE = (210e9, 0.3)
PLACES = [(0, 0), (1, 0), (2, 2), (6, 3), (13, 2), (30, 11)]


def by_quadrature(i, j, d, excess, h1):
    """int int over the patch of int (M - 1) J0(kr) dk: Gauss in the patch, panels of half a period in k."""
    nodes, weights = np.polynomial.legendre.leggauss(20 if h1 < 4 * d else 8)
    r = np.hypot((i + nodes[:, None] / 2) * d, (j + nodes[None, :] / 2) * d).ravel()
    k_max = 15 / h1  # exp(-2 k h1) = 1e-13
    low = min(k_max / 30, 10 / r.max())
    edges = np.concatenate(
        [[0], np.geomspace(1e-9, 1, 60) * low, np.linspace(low, k_max, 30 + int(k_max * r.max() / 4))]
    )
    s, w = np.polynomial.legendre.leggauss(12)
    edges = np.unique(edges)
    half = np.diff(edges)[:, None] / 2
    k, wk = (edges[:-1, None] + half * (1 + s)).ravel(), (half * w).ravel()
    g = j0(np.outer(r, k)) @ (wk * excess(k))
    return d * d / 4 * np.sum(np.outer(weights, weights).ravel() * g)


def of_layers(n, d, layers):
    """Coefficients less Love's rectangle on the first material."""
    c, b = layers.image
    return c * halfspace.surface_deflection(n, d, b) + influence.remainder_coefficients(n, d, layers)


def stack(ratio, h, layers):
    """One coating, or five alternating ones of the same total modulus contrast."""
    E = ratio * SUBSTRATE[0]
    if layers == 1:
        return ((E, 0.25, h),)
    return tuple(
        (E if i % 2 == 0 else np.sqrt(E * SUBSTRATE[0]), 0.1 * i, h * (1 + i / 2)) for i in range(layers)
    )


@pytest.mark.parametrize("layers", [1, 2, 5])
@pytest.mark.parametrize("h", [0.5, 3.0, 2560.0])  # patches: half a patch .. 20 a_h at 128 patches to a_h
@pytest.mark.parametrize("ratio", [0.01, 0.25, 4.0, 100.0])
def test_split_coefficients_are_the_quadrature(ratio, h, layers):
    d = 1.0
    coatings = stack(ratio, h * d, layers)
    thickness = [c[2] for c in coatings]

    def excess(k):
        return frf.compliance_excess(k, coatings, SUBSTRATE)

    n = 40
    C = of_layers(n, d, Response(excess, thickness[0], sum(thickness)))
    largest = abs(halfspace.surface_deflection(1, d)[0, 0] + C[0, 0])
    for i, j in PLACES:
        # what the issue asks: 1e-7 of the largest coefficient
        assert C[i, j] == pytest.approx(by_quadrature(i, j, d, excess, thickness[0]), abs=1e-7 * largest)
        assert C[j, i] == pytest.approx(C[i, j], rel=1e-13, abs=0)


@pytest.mark.parametrize(
    ("ratio", "h"), [(10.0, 5.0), (4.0, 30.0), (0.1, 300.0), pytest.param(0.1, 0.2, marks=pytest.mark.slow)]
)
def test_far_coefficients_keep_their_digits(ratio, h):
    """1e-9 of that of the substrate at the same offset; h / d = 5 at 800 is h / d = 50 at 8000."""
    n, coatings = 801, stack(ratio, h, 1)

    def excess(k):
        return frf.compliance_excess(k, coatings, SUBSTRATE)

    film = Response(excess, h, h)
    c, b = film.image
    R = influence.remainder_coefficients(n, 1.0, film)
    substrate = (1 + c) * halfspace.surface_deflection(n, 1.0)
    for i, j in ((0, 0), (51, 0), (256, 113), (800, 341)):
        rest = by_quadrature(i, j, 1.0, lambda k, c=c, b=b: excess(k) - c * np.exp(-b * k), h)
        assert R[i, j] == pytest.approx(rest, abs=1e-9 * substrate[i, j])


@pytest.mark.parametrize("nu", [0.0, 0.5])
@pytest.mark.parametrize("ratio", [0.1, 10.0])
def test_split_coefficients_are_the_quadrature_at_both_ends_of_poissons_ratio(ratio, nu):
    coatings, substrate = ((ratio * SUBSTRATE[0], nu, 3.0),), (SUBSTRATE[0], nu)

    def excess(k):
        return frf.compliance_excess(k, coatings, substrate)

    C = of_layers(40, 1.0, Response(excess, 3.0, 3.0))
    largest = abs(halfspace.surface_deflection(1, 1.0)[0, 0] + C[0, 0])
    for i, j in PLACES:
        assert C[i, j] == pytest.approx(by_quadrature(i, j, 1.0, excess, 3.0), abs=1e-7 * largest)


def test_plain_conversion_has_the_error_it_is_known_for():
    love = halfspace.surface_deflection(64, 1.0)
    plain = influence.plain_coefficients(64, 1.0, np.zeros_like, enlarge=4)
    error = np.abs(plain - love)
    np.testing.assert_allclose(plain, plain.T, rtol=0, atol=1e-13)
    # 0.4 % at the centre with AL = 2 on the homogeneous half-space, several per cent at far patches
    assert 1e-3 < error[0, 0] / love[0, 0] < 1e-2
    assert (error / love).max() > 0.02
    without = influence.plain_coefficients(64, 1.0, np.zeros_like, enlarge=4, aliases=0)
    assert abs(without[0, 0] - love[0, 0]) > 10 * error[0, 0]


@pytest.mark.parametrize("aliases", [0, 1, 2])
def test_a_unit_spectrum_gives_the_patch_itself(aliases):
    """M = k: 2 pi times the indicator of the patch, cut off at |kx|, |ky| = (2 aliases + 1) pi / d."""
    i = np.arange(12)
    found = influence.plain_coefficients(i.size, 1.0, lambda k: k - 1, enlarge=6, aliases=aliases)
    end = np.pi * (aliases + 0.5)
    along = (sici(end * (1 + 2 * i))[0] + sici(end * (1 - 2 * i))[0]) / np.pi
    # sums for integrals over wavenumbers, (pi / half)^2 of the grid of 72
    np.testing.assert_allclose(found, 2 * np.pi * np.outer(along, along), rtol=0, atol=1e-3)


@pytest.mark.parametrize("near", [0.02, 0.3, 1.0, 2.0, 3.0, 8.0])
@pytest.mark.parametrize(("inner", "outer"), [(0, 3), (3, 12)])
def test_gauss_block_is_the_rectangle_of_love(near, inner, outer):
    """Mean of 1 / sqrt(r^2 + depth^2), singular ``near`` patches below, to the stated digits."""
    exact = halfspace.surface_deflection(12, 1.0, near)
    mean = exact.copy()
    reach = np.hypot(near, max(inner - 1, 0.5))
    influence._gauss_block(mean, lambda r: 1 / np.hypot(r, near), 1.0, inner, outer, reach)
    if inner == 0:
        mean[0, 0] = exact[0, 0]  # the loaded patch is integrated in polar coordinates
    assert np.abs(mean / exact - 1).max() < 10 * numbers.NEGLIGIBLE


def test_remainder_of_the_kernel_is_its_integral_on_both_sides_of_a_tenth_of_the_coating():
    h = 1e-5
    coatings, substrate = ((840e9, 0.25, h),), (210e9, 0.3)

    def excess(k):
        return frf.compliance_excess(k, coatings, substrate)

    film = Response(excess, h, h)
    (c, b), (g, _) = film.image, film.radial(4096)
    r = h * np.array([0.0, 0.05, 0.099, 0.101])
    k = np.geomspace(1e-6, 60, 30001) / h
    R = excess(k) - c * np.exp(-b * k)
    expected = np.trapezoid(R * k * j0(k * r[:, None]), np.log(k))
    assert g(r) == pytest.approx(expected, rel=1e-9)


BALLS = {
    "alike": (630e9, 0.22, ((259e9, 0.22, 2.0), (279e9, 0.21, 1.0))),
    "far thinner": (630e9, 0.22, ((200e9, 0.4, 3e-3),)),
    "far thicker": (70e9, 0.22, ((700e9, 0.2, 3e3),)),
    # 1/E* of the substrates outweighs what the coatings change: no long range is left
    "opposite": (4 * 210e9, 0.3, ((210e9, 0.3, 3.0),)),
}


@pytest.mark.parametrize("ball", BALLS.values(), ids=list(BALLS))
@pytest.mark.parametrize("conversion", ["split", "plain"])
def test_coefficients_of_two_bodies_are_the_sum_of_each(ball, conversion):
    """Each transform is within 1e-9 of that of its first material; the plain conversion to the samples."""
    flat, numerics = ((4 * 210e9, 0.3, 3.0),), Numerics(conversion=conversion)
    both = Body(flat, SUBSTRATE, 0.0, Body(ball[2], ball[:2], 0.0))
    found, one, other = (
        influence.surface_coefficients(48, 1.0, body, numerics)
        for body in (both, Body(flat, SUBSTRATE, 0.0), Body(ball[2], ball[:2], 0.0))
    )
    np.testing.assert_allclose(found, one + other, rtol=1e-8 if conversion == "split" else 1e-11)


@pytest.mark.parametrize("ratio", [1e-6, 0.1, 10.0, 1e6])
def test_sampled_response_is_that_of_the_layers(ratio):
    bodies = [
        (0.3, {"coatings": ((ratio, 0.3, 1.0),), "substrate": (1.0, 0.3)}),
        (0.7, {"coatings": ((1.0, 0.4, 0.01), (2.0, 0.2, 0.02)), "substrate": (3.0, 0.3)}),
    ]
    k = np.geomspace(1e-9, 1e5, 3333)
    exact = sum(share * frf.compliance_excess(k, **layers) for share, layers in bodies)
    # quintic splines through 2000 points
    np.testing.assert_array_less(np.abs(response(bodies).excess(k) - exact), 1e-12 * (1 + np.abs(exact)))


def test_response_is_found_once_and_not_pickled():
    body = Body(((4e11, 0.3, 1e-6),), SUBSTRATE, 0.0)
    assert body.response is body.response
    assert body.response.radial(1024) is body.response.radial(1024)
    assert "response" not in vars(pickle.loads(pickle.dumps(body)))


def test_waves_shorter_than_the_patches_move_an_edge_as_by_wiener_and_hopf():
    """M = (k^2 + b^2)/(k^2 + c^2) has the factor (k + i b)/(k + i c), by which s = 1/b - 1/c."""
    b, c = 2.0, 5.0
    one = Response(lambda k: (b**2 - c**2) / (k**2 + c**2), first=1e-3, total=1e-3)
    assert one.unseen_edge(d=1e3) == pytest.approx(1 / b - 1 / c, rel=1e-3)
    # patches that see all waves of the layer place it exactly
    assert one.unseen_edge(d=1e-3) < 1e-8
