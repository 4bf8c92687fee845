"""Smooth contact edges: deflection by parts against Hertz, ellipses, the cone, what is no smooth edge."""

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk

import semianalytic
from semianalytic import numbers
from semianalytic.coefficients import influence
from semianalytic.edge import smooth_edge
from semianalytic.edge.edge_shape import FULL, Shape
from semianalytic.inputs import Body, Numerics
from semianalytic.patches import convolution
from semianalytic.patches.grid import Grid
from verification.problem.point_answers import EDGE, Points

STEEL = (210e9, 0.3)
E_STAR = STEEL[0] / (1 - STEEL[1] ** 2)
P0 = 1e9


def indented(profile, half_width, load, patches, **options):
    given = {"coatings": (), "substrate": STEEL, "estimate_uncertainty": False} | options
    return semianalytic.indent(profile=profile, half_width=half_width, load=load, patches=patches, **given)


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
        return indented(self.profile, 1.2 * self.a, self.load, patches, **options)

    def semi_axes(self, solution):
        """Where the pressure along the axes falls to zero."""

        def end(length, direction):
            c, s = np.cos(direction), np.sin(direction)
            p = lambda r: float(solution.pressure(r * c, r * s)) or -1.0  # noqa: E731
            return brentq(p, 0.9 * length, 1.1 * length, xtol=1e-12)

        return end(self.a, self.turn), end(self.b, self.turn + np.pi / 2)


def hertz(n, quarter, semi_axes=(1.0, 1.0), harmonics=numbers.EVEN):
    """Deflection [m], load [N] and load of the patch means under a shape that is Hertz's; E* = p0 = 1."""
    grid, body = Grid(n, 2.24 * max(semi_axes) / n, quarter), Body((), (1.0, 0.0), 0.0)
    b = np.eye(1, len(harmonics))
    shape = Shape((0.0, 0.0), semi_axes, harmonics, np.zeros(len(harmonics)), b)
    p = shape.pressure(grid.x[:, None], grid.x)

    def coefficients(m, side):
        return influence.surface_coefficients(m, side, body, Numerics())

    deflection = convolution.even_convolution(coefficients(n, grid.d), quarter=quarter)
    near, parts = numbers.NEAR_PARTS, numbers.PARTS
    influences = coefficients(near + 2, grid.d), coefficients((near + 1) * parts, grid.d / parts)
    edge = smooth_edge.edge_patches(shape, p, grid, grid.window)
    u, missing = smooth_edge.beyond_centres(
        edge, p, grid, deflection, smooth_edge.near_influence(*influences)
    )
    mean = smooth_edge.patch_mean(edge, p, grid)
    assert edge.misfit < 1e-14
    return grid, grid.whole(deflection(p) + u), grid.force(p) + missing, grid.force(mean)


@pytest.mark.parametrize("n", [65, 128, 257])
def test_deflection_by_parts_is_hertzs_on_a_quarter_as_on_the_whole(n):
    grid, u, load, of_means = hertz(n, quarter=False)
    inside = grid.radius < 1
    exact = np.pi / 4 * (2 - grid.radius**2)  # Johnson (3.41a)
    # 2e-6 at 257 patches; parts and patches of equal moments differ by the order 3/2 of the patch
    assert np.abs(u - exact)[inside].max() < 2e-6 * np.pi / 2 * (257 / n) ** 1.75
    assert load == pytest.approx(2 / 3 * np.pi, rel=4e-8 * (257 / n) ** 1.5)
    assert of_means == pytest.approx(load, rel=1e-12)
    for harmonics in (numbers.EVEN, numbers.ROUND):
        _, quarter, *loads = hertz(n, quarter=True, harmonics=harmonics)
        np.testing.assert_allclose(quarter, u, rtol=0, atol=1e-14)
        assert loads == pytest.approx([load, load], rel=1e-13)


def test_edge_patches_of_an_ellipse_carry_its_load():
    _, _, load, of_means = hertz(129, quarter=False, semi_axes=(2.0, 0.6), harmonics=FULL)
    # a narrow end, two patches of curvature radius 0.18: less is exact than of a circle
    assert load == pytest.approx(2 / 3 * np.pi * 2 * 0.6, rel=1e-6)
    assert of_means == pytest.approx(load, rel=1e-12)


@pytest.mark.parametrize(
    ("ratio", "degrees", "patches", "smooth"),
    [
        (1.5, 70, 97, True),
        (2, 25, 84, True),
        (3, 0, 129, True),
        pytest.param(4, 30, 321, True, marks=pytest.mark.slow),
        # its contour, oblique to the axes, is not found on so few patches: what is left is their staircase;
        # nor is that of 4 : 1 on 257, since pointed ends have more harmonics
        pytest.param(5, 30, 257, False, marks=pytest.mark.slow),
    ],
)
def test_ellipse_of_any_direction_is_hertzs_within_its_uncertainty(ratio, degrees, patches, smooth):
    ellipse = Ellipse(ratio, degrees)
    s = ellipse.indent(patches, estimate_uncertainty=True)
    exact = {"peak_pressure": P0, "approach": ellipse.approach, "contact_radius": 1e-4}
    for name, value in exact.items():
        assert abs(getattr(s, name) - value) <= getattr(s.uncertainty, name), name
    assert (s._level.shape is not None) == smooth
    if smooth:
        # the order 3/2 of the patch in the short axis b, 1e-5 where b has 35 patches
        order = 1e-5 * max(1.0, (35 * 2.4 * ratio / patches) ** 1.5)
        assert s.peak_pressure == pytest.approx(P0, rel=order)
        assert s.approach == pytest.approx(ellipse.approach, rel=order)
        assert ellipse.semi_axes(s) == pytest.approx((ellipse.a, ellipse.b), rel=1e-4)
    x = np.linspace(-1.05, 1.05, 41)[:, None] * ellipse.a
    error = np.abs(s.pressure(x, x.T) - ellipse.pressure(x, x.T))
    assert np.all(error <= s.sample(Points(x, x.T), "pressure").uncertainty)
    # far away there is none
    assert not s.pressure(10 * x[:5], x.T).any()


def test_approach_and_peak_are_those_between_the_patches():
    """An even number of patches has none at the tip, and four beside the peak."""
    ellipse = Ellipse(2, 30)
    for patches in (72, 73):
        s = ellipse.indent(patches)
        assert s.approach == pytest.approx(ellipse.approach, rel=4e-5)
        assert s.peak_pressure == pytest.approx(P0, rel=4e-5)


def test_uncertainty_is_far_below_that_of_the_staircase():
    ellipse = Ellipse(2, 70)
    corrected, staircase = (
        ellipse.indent(113, estimate_uncertainty=True, edge_correction=edge).uncertainty
        for edge in (True, False)
    )
    for name in ("peak_pressure", "approach", "contact_radius"):
        assert getattr(corrected, name) < 0.1 * getattr(staircase, name)


@pytest.mark.parametrize("coatings", [((840e9, 0.3, 5e-5),), ((52e9, 0.3, 2e-5),)])
def test_round_profile_is_the_sphere(coatings):
    """Fitted without knowing that it is round."""
    R, W = 10e-3, 20.0
    given = {"coatings": coatings, "patches": 129, "estimate_uncertainty": False}
    sphere = semianalytic.solve(radius=R, load=W, substrate=STEEL, **given)
    a = sphere.contact_radius
    s = indented(lambda x, y: (x**2 + y**2) / (2 * R), 1.2 * a, W, **given)
    # the order 3/2 at 54 patches to the radius, of both
    for name in ("peak_pressure", "approach", "contact_radius"):
        assert getattr(s, name) == pytest.approx(getattr(sphere, name), rel=1e-5), name
    x, z = np.linspace(-1.5, 1.5, 7) * a, 0.3 * a
    np.testing.assert_allclose(
        s.stress(x, 0.0, z), sphere.stress(x, 0.0, z), rtol=0, atol=2e-5 * s.peak_pressure
    )


def lobes(x, y):
    """Three lobes on a paraboloid."""
    return (x**2 + y**2) / 0.02 + 5e4 * (x**3 - 3 * x * y**2)


@pytest.mark.slow
def test_a_shape_that_the_coarsest_grid_does_not_resolve_is_found_on_the_next_one():
    # a stiff film of a seventh of the short half-axis, which is 17 patches on the coarsest grid
    given = {
        "radius": 8.4e-3,
        "indenter": ("ellipsoid", (20e-3, 3.526e-3)),
        "load": 20.0,
        "coatings": ((611e9, 0.32, 6.3e-6),),
        "substrate": (210e9, 0.3),
    }
    found = semianalytic.solve(**given)
    finer = semianalytic.solve(**given, patches=513, estimate_uncertainty=False)
    assert found.contact_radius == pytest.approx(finer.contact_radius, rel=2e-4)  # 4e-3 by its rim alone


def test_on_few_patches_a_contour_has_no_more_waves_than_they_show():
    # 36 patches between centre and edge on the coarsest grid, to whose noise twelve waves were once fitted
    given = {"radius": 14.498e-3, "indenter": ("ellipsoid", (10.51e-3, 20e-3)), "load": 20.0}
    film = {"coatings": ((76.67e9, 0.4192, 30.26138e-6),), "substrate": (210e9, 0.3929)}
    found = semianalytic.solve(**given, **film)
    assert found.sample(Points(0.0, 0.0), "pressure").uncertainty < 1e-5 * found.peak_pressure


def test_pressure_and_stress_end_with_a_contact_of_lobes():
    """Its contour is no ellipse; far away the field is that of a point force."""
    W, a = 20.0, 8.66e-5
    s = indented(lobes, 1.6 * a, W, 97)
    assert s._level.shape is not None
    angle, r = np.linspace(0, 2 * np.pi, 37), np.geomspace(1.5, 100, 20)[:, None] * a
    assert not s.pressure(r * np.cos(angle), r * np.sin(angle)).any()
    x, z = np.array([1.0, -0.5, 0.2]) * 20 * a, 20 * a
    exact = -3 * W / (2 * np.pi) * z**3 / (x**2 + z**2) ** 2.5
    # the second moment of the contact, (a/20 a)^2 times a few
    np.testing.assert_allclose(s.stress(x, 0.0, z)[2, 2], exact, rtol=5e-3)


def test_cone_is_sneddons_whose_inside_is_left_to_the_patches():
    slope, delta = 0.01, 1e-7
    a, load = 2 * delta / (np.pi * slope), 2 * E_STAR * delta**2 / (np.pi * slope)
    s = indented(lambda x, y: slope * np.hypot(x, y), 1.3 * a, load, 257)
    assert s._level.shape.outside
    # Sneddon (1965)
    assert s.contact_radius == pytest.approx(a, rel=1e-4)
    # at the tip a logarithm, of which a patch takes the mean: of first order
    assert s.approach == pytest.approx(delta, rel=2e-4)
    r = np.linspace(0.3, 0.98, 9) * a
    np.testing.assert_allclose(s.pressure(r), E_STAR * slope / 2 * np.arccosh(a / r), rtol=2e-3)


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
    # the tolerance is relative to the gap at the rim, which under the flat is 6e4 times the approach
    corrected, alone = (
        indented(profile, 1.5e-4, 10.0, 65, tolerance=1e-13, edge_correction=edge) for edge in (True, False)
    )
    np.testing.assert_allclose(
        corrected.patch_pressure, alone.patch_pressure, rtol=0, atol=1e-6 * alone.peak_pressure
    )
    assert corrected.contact_radius == alone.contact_radius


def test_a_contour_of_another_area_than_the_loaded_patches_is_left_to_them(monkeypatch):
    # such as one that loops between the patches, here of every shape
    ellipse = Ellipse(2)
    assert ellipse.indent(97)._level.shape is not None
    alone = ellipse.indent(97, edge_correction=False)
    monkeypatch.setattr(Shape, "radius", property(lambda self: 1.1 * float(np.sqrt(np.prod(self.axes)))))
    found = ellipse.indent(97)
    assert found._level.shape is None
    assert found.contact_radius == alone.contact_radius


def test_edge_correction_has_to_be_a_truth_value():
    with pytest.raises(ValueError, match="edge_correction = 1;"):
        Ellipse(2).indent(65, edge_correction=1)


@pytest.mark.parametrize(
    ("flat", "radius", "approach"),
    [
        (0.5, 1e-3, 1e-4),
        (0.7, 1e-3, 1e-4),
        (0.85, 2.3e-3, 1e-4),
        (0.94, 3.4e-3, 5e-4),
        (1 / 1.0261, 2.5e-3, 7.5e-4),
    ],
)
def test_punch_with_a_round_edge_is_sneddons(flat, radius, approach):
    """Flat to b, then (r - b)^2/2R: G(x) = x int g' / sqrt(x^2 - r^2) dr in closed form (Sneddon 1965).

    Polynomials do not hold the pressure of a short rounding: the radius is known to a quarter of a patch.
    """
    a, R, E_star = 1.0, 100.0, 1.0

    def G(x):
        out = np.maximum(x, flat)
        return out / R * (np.sqrt(out**2 - flat**2) - flat * np.arccos(flat / out))

    s, w = np.polynomial.legendre.leggauss(200)
    x = flat + (a - flat) * (1 + s) / 2
    load = 2 * E_star * (flat * G(a) + (a - flat) / 2 * w @ (G(a) - G(x)))

    def punch(x, y):
        return np.maximum(np.hypot(x, y) - flat, 0) ** 2 / (2 * R)

    found = semianalytic.indent(
        profile=punch, half_width=1.15, load=load, coatings=(), substrate=(1.0, 0.0), patches=257
    )
    assert found.uncertainty is not None
    assert abs(found.contact_radius - a) <= found.uncertainty.contact_radius < radius
    assert abs(found.approach - G(a)) <= found.uncertainty.approach < approach * G(a)

    def pressure(r):  # -(1/pi) int phi'(t) / sqrt(t^2 - r^2) dt, t^2 = r^2 + v^2
        first = np.sqrt(max(flat**2 - r**2, 0.0))
        v = first + (np.sqrt(a**2 - r**2) - first) * ((1 + s) / 2) ** 2
        weight = w / 2 * 2 * ((1 + s) / 2) * (np.sqrt(a**2 - r**2) - first)
        t = np.sqrt(r * r + v * v)
        root, angle = np.sqrt(np.maximum(t * t - flat**2, 1e-30)), np.arccos(np.minimum(flat / t, 1))
        slope = (root - flat * angle) / R + t / R * (t / root - flat**2 / (t * root))
        return E_star / np.pi * weight @ (slope / t)

    places = np.array([0.0, 0.4, 0.9, 0.95, 0.99, 0.999])
    exact = np.array([pressure(r) for r in places])
    assert np.all(
        np.abs(found.pressure(places) - exact) <= found.sample(Points(places), "pressure").uncertainty
    )


def test_asperities_far_apart_carry_half_the_load_each_beside_a_point_force():
    """Two spheres 16 a apart: each feels the other as a displacement W/2 / (pi E* d), and its slope."""
    R, load = 1e-2, 20.0
    a = (0.75 * load / 2 * R / E_STAR) ** (1 / 3)
    d = 16 * a
    given = {"coatings": (), "substrate": STEEL, "radius": R}
    pair = semianalytic.solve(indenter=("asperities", (d,)), load=load, patches=801, **given)
    one = semianalytic.solve(load=load / 2, **given)
    assert pair.contact_radius == pytest.approx(2**0.5 * a, rel=2e-4)
    assert pair.peak_pressure == pytest.approx(one.peak_pressure, rel=2e-4)
    assert pair.approach == pytest.approx(a**2 / R + load / 2 / (np.pi * E_STAR * d), rel=3e-5)
    x, y, z = np.array([[-0.6, 0.2, 0.4], [0.3, 0.0, 1.1], [0.0, 0.3, 0.8]]) * a
    outwards = R * load / 2 / (np.pi * E_STAR * d**2)
    sum_of_both = one.stress(x - outwards, y, z) + one.stress(x + d + outwards, y, z)
    stress = pair.stress(x + d / 2, y, z)
    assert np.abs(stress - sum_of_both).max() < 3e-4 * one.peak_pressure
    mirrored = pair.stress(-x - d / 2, y, z)
    mirrored[0, 1:] *= -1
    mirrored[1:, 0] *= -1
    np.testing.assert_allclose(mirrored, stress, atol=1e-9 * one.peak_pressure)


@pytest.mark.slow
def test_two_contacts_side_by_side_settle_as_fast_as_one():
    """Interacting through a coating: p0 within 2e-6 and a within 1e-5 on grids of 257 and 401 patches."""
    coarse, fine = (
        semianalytic.solve(
            indenter=("asperities", (1.5e-4,)),
            radius=1e-2,
            load=20.0,
            coatings=((420e9, 0.25, 5e-5),),
            substrate=STEEL,
            patches=patches,
        )
        for patches in (257, 401)
    )
    for name, tolerance in (("peak_pressure", 2e-6), ("approach", 1e-6), ("contact_radius", 2e-5)):
        one, other = getattr(coarse, name), getattr(fine, name)
        assert one == pytest.approx(other, rel=tolerance), name
        assert abs(one - other) <= getattr(coarse.uncertainty, name) + getattr(fine.uncertainty, name), name


@pytest.mark.slow
def test_the_stress_at_the_edge_of_an_ellipse_is_within_a_small_uncertainty():
    coated = {"coatings": ((420e9, 0.25, 16e-6),), "substrate": (210e9, 0.3), "accuracy": None}
    pressed = {"radius": 9e-3, "load": 20.0, "indenter": ("ellipsoid", (20e-3, 4e-3))}
    found, finer = (semianalytic.solve(**pressed, **coated, patches=n) for n in (273, 513))
    angle = np.array([0.0, 0.7, np.pi / 2])
    (stress, U), (better, _) = (
        one.sample(Points(*one._level.shape.on_ray(1.0, angle), 0.0, frame=EDGE), "stress")
        for one in (found, finer)
    )
    assert np.all(np.abs(stress - better) <= U)
    assert U.max() < 2e-3 * found.peak_pressure  # compared at a common ratio of radii, it was 0.1
