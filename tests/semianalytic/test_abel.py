"""Exact deflection of the layered half-space, and patch means of a profile."""

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.special import j0

from semianalytic import abel, collocation, edge_profile, frf
from semianalytic.inputs import Body

A, E_STAR, P0 = 1.3, 2.0, 0.7


def hertz(r):
    """Johnson (1985) eqs. 3.42a, b."""
    s = np.maximum(r, A)
    outside = ((2 * A**2 - s**2) * np.arcsin(A / s) + s * A * np.sqrt(1 - (A / s) ** 2)) / (2 * A)
    return P0 / E_STAR * np.where(r <= A, np.pi * (2 * A**2 - r**2) / (4 * A), outside)


def test_square_root_pressure_gives_the_deflection_of_hertz():
    r = np.linspace(0, 3 * A, 301)
    u = abel.deflection(A, np.array([P0]), E_STAR, None, r)
    # polynomials inside and outside
    np.testing.assert_allclose(u, hertz(r), rtol=1e-12)


def test_higher_terms_integrate_their_pressure():
    rng = np.random.default_rng(5)
    b = rng.normal(size=9)
    shape = edge_profile.Profile(A, b)
    u = abel.deflection(A, b, E_STAR, None, np.array([0.0]))
    # at the centre u = (2/E*) int p dr
    direct = quad(lambda t: 2 * t * shape.pressure(A * (1 - t * t)) * A, 0, 1, epsabs=1e-12)[0] * 2 / E_STAR
    assert u[0] == pytest.approx(direct, rel=1e-8)
    load = quad(lambda t: 2 * t * A * 2 * np.pi * A * (1 - t * t) * shape.pressure(A * (1 - t * t)), 0, 1)[0]
    assert shape.load == pytest.approx(load, rel=1e-9)


def test_gauss_panels_integrate_oscillations_to_rounding():
    """int_0^inf e^(-bk) J0(kr) dk = 1 / sqrt(b^2 + r^2), cut where e^(-bk) is rounding; to r = reach."""
    for b, reach, scale in ((0.01, 2.7, np.inf), (1.0, 2.0, np.inf), (30.0, 2.0, np.inf), (0.1, 50.0, 30.0)):
        k, weight = abel.wavenumbers(reach, 34 / b, scale)
        r = np.linspace(0, reach, 25)
        found = j0(np.outer(r, k)) @ (weight * np.exp(-b * k))
        np.testing.assert_allclose(found, 1 / np.hypot(b, r), rtol=1e-11)


@pytest.mark.parametrize("h", [0.006, 0.05, 3.0])
@pytest.mark.parametrize("ratio", [1e-2, 1e2])
def test_table_of_layers_is_smooth_between_its_nodes(h, ratio):
    """Against the integral at every point, under the edge profile of a contact."""

    def excess(k):
        return frf.compliance_excess(k, ((ratio, 0.3, h),), (1.0, 0.3))

    body = Body(((ratio, 0.3, h),), (1.0, 0.3), 0.0)
    profile = collocation.contact(1e3, None, A**2 / 1e3, body, (1.0,))[0].profile
    a, phi = profile.radius, abel.potential(profile.coefficients)
    table = abel.layer_table(excess, h, a, 1.6 * a, phi.size)
    rho = np.sort(np.append(np.linspace(0, 1.59, 100), 1 + h * np.linspace(-3, 3, 50) / a))
    rho = rho[(rho >= 0) & (rho < 1.6)]
    phat = phi @ table.transforms
    direct = a * j0(np.outer(rho, table.k)) @ (table.weight * excess(table.k / a) * phat)
    homogeneous = abel.deflection(a, profile.coefficients, 2.0, None, rho)
    assert np.abs(table(a, phi, rho) - direct).max() < 1e-10 * homogeneous.max()


def test_layers_add_their_hankel_integral():
    coatings, substrate = ((4.0, 0.3, 0.4),), (1.0, 0.3)

    def excess(k):
        return frf.compliance_excess(k, coatings, substrate)

    r = np.array([0.0, 0.5, 1.3, 1.9])
    table = abel.layer_table(excess, 0.4, A, 2.0, 1)
    layered = abel.deflection(A, np.array([P0]), E_STAR, table, r)
    alone = abel.deflection(A, np.array([P0]), E_STAR, None, r)

    def phat(k):  # Hankel transform of p0 sqrt(1 - r^2/a^2)
        x = k * A
        return P0 * A**2 * (np.sin(x) - x * np.cos(x)) / x**3

    for i, ri in enumerate(r):
        direct = quad(
            lambda k, ri=ri: excess(np.array(k)) * phat(k) * j0(k * ri), 1e-9, 60, limit=400, epsabs=1e-11
        )
        assert layered[i] - alone[i] == pytest.approx(2 / E_STAR * direct[0], abs=1e-8)


@pytest.mark.parametrize(
    "shape", [edge_profile.Profile(A, np.array([1.0, 0.3])), edge_profile.Prescribed(A, np.ones_like)]
)
def test_patch_means_carry_the_load(shape):
    d = A / 20.3
    x = (np.arange(49) - 24) * d
    mean = edge_profile.patch_mean(shape, x, d)
    assert mean.sum() * d * d == pytest.approx(shape.load, rel=1e-12)
    assert mean[24, 24] == pytest.approx(float(shape.pressure(np.zeros(()))), rel=1e-3)
    np.testing.assert_allclose(mean, mean.T)
    np.testing.assert_allclose(mean, mean[::-1])


def test_patch_mean_of_a_uniform_disc_is_the_covered_fraction():
    d = A / 20.3
    x = (np.arange(49) - 24) * d
    mean = edge_profile.patch_mean(edge_profile.Prescribed(A, np.ones_like), x, d)
    fine = (np.arange(200) + 0.5) / 200 - 0.5
    for i, j in ((24 + 20, 24), (24 + 14, 24 + 14), (24 + 17, 24 + 11), (24, 24)):
        X, Y = x[i] + fine[:, None] * d, x[j] + fine[None, :] * d
        # 200 x 200 points resolve a fraction of 1/200; Gauss lines err by less where the rim cuts a corner
        assert mean[i, j] == pytest.approx(np.mean(np.hypot(X, Y) <= A), abs=5e-3)


def test_transform_of_the_uniform_part_is_the_bessel_function():
    # int_0^1 x' cos(kx) dx with x' = 1 - x^2 is the transform behind sqrt pressure: (sin k - k cos k) 2/k^3
    k = np.array([0.1, 1.0, 7.0, 40.0])
    found = abel.cosine_transform(np.array([1.0]), k)
    np.testing.assert_allclose(found, 2 * (np.sin(k) - k * np.cos(k)) / k**3, rtol=0, atol=1e-12)
