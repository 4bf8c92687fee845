"""Contact edges between the patches, against the closed form of the ellipse and the sphere's own solver."""

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk

import semianalytic
from semianalytic import smooth_edge

STEEL = (210e9, 0.3)
E_STAR = STEEL[0] / (1 - STEEL[1] ** 2)
P0 = 1e9


class Ellipse:
    """Hertz contact of semi-axes a > b, a turned from x (Johnson 1985, section 4.2)."""

    def __init__(self, ratio, degrees=0.0):
        self.a, self.b = 1e-4 * ratio**0.5, 1e-4 / ratio**0.5
        self.turn = np.radians(degrees)
        m = 1 - (self.b / self.a) ** 2
        K, E = ellipk(m), ellipe(m)
        c = P0 / E_STAR * self.b / (self.a**2 * m)
        self.A, self.B = c * (K - E), c * ((self.a / self.b) ** 2 * E - K)
        self.approach, self.load = P0 / E_STAR * self.b * K, 2 / 3 * np.pi * P0 * self.a * self.b

    def axes(self, x, y):
        c, s = np.cos(self.turn), np.sin(self.turn)
        return c * x + s * y, c * y - s * x

    def profile(self, x, y):
        u, v = self.axes(x, y)
        return self.A * u**2 + self.B * v**2

    def pressure(self, x, y):
        u, v = self.axes(x, y)
        return P0 * np.sqrt(np.maximum(1 - (u / self.a) ** 2 - (v / self.b) ** 2, 0))

    def indent(self, patches, **options):
        given = {"load": self.load, "coatings": (), "substrate": STEEL, "estimate_uncertainty": False}
        half_width = 1.2 * self.a
        return semianalytic.indent(
            profile=self.profile, half_width=half_width, patches=patches, **given | options
        )

    def semi_axes(self, solution):
        """Where the pressure along the axes falls to zero."""

        def end(length, direction):
            c, s = np.cos(direction), np.sin(direction)
            p = lambda r: float(solution.pressure(r * c, r * s)) or -1.0  # noqa: E731
            return brentq(p, 0.9 * length, 1.1 * length, xtol=1e-12)

        return end(self.a, self.turn), end(self.b, self.turn + np.pi / 2)


def test_ellipse_of_257_patches_within_1e_5():
    ellipse = Ellipse(5, 30)
    s = ellipse.indent(257)
    assert s.peak_pressure == pytest.approx(P0, rel=1e-5)
    assert s.approach == pytest.approx(ellipse.approach, rel=5e-6)
    assert s.contact_radius == pytest.approx(1e-4, rel=3e-4)
    assert ellipse.semi_axes(s) == pytest.approx((ellipse.a, ellipse.b), rel=1e-3)


def test_approach_and_peak_are_those_between_the_patches():
    """An even number of patches has none at the tip, and four beside the peak."""
    ellipse = Ellipse(3, 30)
    for patches in (96, 97):
        s = ellipse.indent(patches)
        assert s.approach == pytest.approx(ellipse.approach, rel=4e-5)
        assert s.peak_pressure == pytest.approx(P0, rel=4e-5)


def test_ellipse_converges_with_second_order():
    ellipse = Ellipse(2, 30)
    errors = [
        (abs(s.peak_pressure / P0 - 1), abs(s.approach / ellipse.approach - 1))
        for s in (ellipse.indent(n) for n in (65, 129))
    ]
    assert np.all(np.log2(np.divide(*errors)) > 1.9)


@pytest.mark.parametrize(("patches", "degrees"), [(113, 70), (84, 25)])
def test_uncertainty_covers_the_ellipse_and_is_far_below_that_of_the_staircase(patches, degrees):
    ellipse = Ellipse(2, degrees)
    corrected, staircase = (
        ellipse.indent(patches, estimate_uncertainty=True, edge_correction=edge) for edge in (True, False)
    )
    exact = {"peak_pressure": P0, "approach": ellipse.approach, "contact_radius": 1e-4}
    for name, value in exact.items():
        U = getattr(corrected.uncertainty, name)
        assert abs(getattr(corrected, name) - value) <= U < 0.4 * getattr(staircase.uncertainty, name)


def test_pressure_between_the_patches_is_that_of_the_ellipse():
    ellipse = Ellipse(2, 30)
    s = ellipse.indent(97)
    x = np.linspace(-1, 1, 41)[:, None] * ellipse.a
    error = np.abs(s.pressure(x, x.T) - ellipse.pressure(x, x.T)) / P0
    inside = ellipse.pressure(x, x.T) > 0.3 * P0
    assert error[inside].max() < 5e-4
    # next to the edge a hundredth of a patch is a few per cent of the peak
    assert error.max() < 5e-2
    assert np.array_equal(s.pressure(x, x.T) > 0, ellipse.pressure(x, x.T) > 0)


@pytest.mark.parametrize("coatings", [((840e9, 0.3, 5e-5),), ((52e9, 0.3, 2e-5),)])
def test_round_contact_is_that_of_the_sphere(coatings):
    R, W = 10e-3, 20.0
    sphere = semianalytic.solve(
        radius=R, load=W, coatings=coatings, substrate=STEEL, patches=33, estimate_uncertainty=False
    )
    s = semianalytic.indent(
        profile=lambda x, y: (x**2 + y**2) / (2 * R),
        half_width=1.2 * sphere.contact_radius,
        load=W,
        coatings=coatings,
        substrate=STEEL,
        patches=97,
        estimate_uncertainty=False,
    )
    assert s.peak_pressure == pytest.approx(sphere.peak_pressure, rel=2e-5)
    assert s.approach == pytest.approx(sphere.approach, rel=2e-5)
    assert s.contact_radius == pytest.approx(sphere.contact_radius, rel=5e-4)


@pytest.mark.parametrize(
    "profile",
    [
        lambda x, y: 0.01 * np.maximum(np.abs(x), np.abs(y)),
        lambda x, y: (x**2 + y**2) / 0.02 + 1e-8 * np.cos(4e5 * x) * np.cos(3.7e5 * y),
        lambda x, y: np.maximum(np.hypot(x, y) - 8e-5, 0) ** 2 / 1e-6,
    ],
    ids=["corners", "rough", "edge below a patch"],
)
def test_an_edge_that_is_no_smooth_curve_is_left_to_the_patches(profile):
    given = {"half_width": 1.5e-4, "load": 10.0, "coatings": (), "substrate": STEEL, "patches": 65}
    corrected, alone = (
        semianalytic.indent(profile=profile, **given, edge_correction=edge, estimate_uncertainty=False)
        for edge in (True, False)
    )
    np.testing.assert_array_equal(corrected.patch_pressure, alone.patch_pressure)
    assert corrected.contact_radius == alone.contact_radius


def test_edge_fitted_to_an_exact_pressure_has_its_area_and_load():
    ellipse, n = Ellipse(3, 20), 129
    d = 2.4 * ellipse.a / n
    x = (np.arange(n) - n // 2) * d
    p = ellipse.pressure(x[:, None], x)
    edge, parts = smooth_edge.fit(p)
    assert edge.area * d**2 == pytest.approx(np.pi * ellipse.a * ellipse.b, rel=1e-6)
    assert edge.patch_mean(p).sum() * d**2 == pytest.approx(ellipse.load, rel=5e-6)
    np.testing.assert_allclose(parts.mean(axis=1), edge.mean, rtol=1e-12)
    assert edge.misfit < 1e-4


@pytest.mark.parametrize("n", [64, 65, 66])
def test_edge_of_an_even_pressure_is_that_of_its_quarter(n):
    ellipse = Ellipse(3)
    x = (np.arange(n) - (n - 1) / 2) * (2.4 * ellipse.a / n)
    p = ellipse.pressure(x[:, None], x)
    (edge, parts), (whole, all_parts) = smooth_edge.fit(p, even=True), smooth_edge.fit(p)
    np.testing.assert_array_equal([edge.i, edge.j, edge.share], [whole.i, whole.j, whole.share])
    np.testing.assert_allclose(parts, all_parts, rtol=0, atol=1e-9 * P0)
    np.testing.assert_allclose(edge.quadratic, whole.quadratic, rtol=0, atol=1e-11 * P0**2)
    assert edge.area == pytest.approx(whole.area, rel=1e-12)
    assert edge.misfit == pytest.approx(whole.misfit, abs=1e-8)


def test_edge_correction_has_to_be_a_truth_value():
    with pytest.raises(ValueError, match="edge_correction = 1;"):
        Ellipse(2).indent(65, edge_correction=1)
