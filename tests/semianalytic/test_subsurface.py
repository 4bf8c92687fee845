"""Fields by rings: closed forms, the sum of point forces, Hankel integrals, field equations, continuity."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.polynomial import legendre
from scipy.integrate import quad
from scipy.special import ellipeinc, ellipkinc, jv, spherical_jn

from semianalytic import numbers
from semianalytic.coefficients.frf import displacement_frf, stress_frf
from semianalytic.coefficients.point_force import (
    combine_displacement,
    combine_stress,
    directions,
    half_space_displacement,
    half_space_stress,
)
from semianalytic.edge.edge_shape import FULL, Shape
from semianalytic.inputs import Body
from semianalytic.stresses import subsurface
from semianalytic.stresses.rings import Disc, SmoothContour, rings_of
from verification.sources.references.hertz import Hertz

NU, F = 0.3, 0.4
BARE = Body((), (1.0, NU), F)
SIX = ((0, 1, 2, 0, 0, 1), (0, 1, 2, 1, 2, 2))
RINGS = 2e-8  # of the peak pressure: error that `solution` allows the rings
DISC = Disc(1.0, lambda square: np.sqrt(np.maximum(1 - square, 0)))
# a = p0 = 1: W = 2 pi/3, R = 4 E*/(3 W)
HERTZ = Hertz(radius=2 / np.pi / (1 - NU**2), load=2 * np.pi / 3, E=1.0, nu=NU, friction=F)
COATED = Body(((4.0, 0.25, 0.3), (0.3, 0.4, 0.15)), (1.0, 0.3), F)
THIN = Body(((10.0, 0.3, 0.02),), (1.0, 0.3), F)
# inside, at, and outside the edge; on the surface and down from it
R = np.array([1e-6, 0.3, 0.7, 0.99, 1 - 1e-5, 1, 1 + 1e-5, 1.01, 1.5, 3])
DEPTHS = np.array([0, 1e-7, 1e-4, 1e-2, 0.1, 0.5, 2, 20])


def points(r=R, angle=0.7, depths=DEPTHS):
    r, z = (v.ravel() for v in np.meshgrid(r, depths))
    return r * np.cos(angle), r * np.sin(angle), z


def stress(x, y, z, layer=0, *, pressure=DISC, body=BARE):
    """The tensor, of points broadcast."""
    x, y, z, layer = np.broadcast_arrays(x, y, z, layer)
    six = subsurface.stress(
        *(np.ravel(v).astype(float) for v in (x, y, z)), layer.ravel(), pressures=[pressure], body=body
    )[0]
    tensor = np.empty((3, 3, x.size))
    tensor[SIX], tensor[SIX[::-1]] = six, six
    return tensor.reshape(3, 3, *x.shape)


def displacement(x, y, z, layer=0, *, pressure=DISC, body=BARE):
    x, y, z, layer = np.broadcast_arrays(x, y, z, layer)
    flat = (np.ravel(v).astype(float) for v in (x, y, z))
    found = subsurface.displacement(*flat, layer.ravel(), pressures=[pressure], body=body)
    return found.reshape(3, *x.shape)


def ellipse(a, b, centre=(0.0, 0.0)):
    return Shape(centre, (a, b), numbers.EVEN, np.zeros(len(numbers.EVEN)), np.eye(1, len(numbers.EVEN)))


@pytest.mark.parametrize("angle", [0.0, 0.7, 2.5])
def test_sliding_sphere_is_hamiltons_at_the_edge_too(angle):
    at = points(np.append(R, 0.0), angle)
    np.testing.assert_allclose(stress(*at), HERTZ.stress(*at), rtol=0, atol=RINGS)
    np.testing.assert_allclose(displacement(*at), HERTZ.displacement(*at), rtol=0, atol=RINGS)


@pytest.mark.parametrize("harmonics", [numbers.EVEN, FULL])
@pytest.mark.parametrize("r", [R, np.zeros(1)], ids=["off the axis", "on the axis"])
def test_contour_that_is_a_circle_is_the_disc(r, harmonics):
    b = np.zeros((1, len(harmonics)))
    b[0, 0] = 1.0
    circle = SmoothContour(Shape((0.2, -0.1), (1.0, 1.0), harmonics, np.zeros(b.size), b))
    x, y, z = points(r)
    found = stress(x + 0.2, y - 0.1, z, pressure=circle)
    np.testing.assert_allclose(found, stress(x, y, z), rtol=0, atol=RINGS)


@pytest.mark.parametrize("ratio", [1.5, 5.0])
def test_stress_below_the_centre_of_an_ellipse_is_johnsons(ratio):
    """Johnson (1985) eq. 3.69, a > b; T and the angle phi depend on the depth."""
    a, b = ratio**0.5, ratio**-0.5
    z, m, q = DEPTHS, 1 - (b / a) ** 2, (a / b) ** 2
    s = stress(0.2, -0.1, z, pressure=rings_of(ellipse(a, b, (0.2, -0.1))), body=BARE.with_friction(0.0))
    T, zeta, phi = np.sqrt((b**2 + z**2) / (a**2 + z**2)), z / a, np.arctan2(a, z)
    first, second = ellipkinc(phi, m), ellipeinc(phi, m)
    less, more = zeta * (first - second), zeta * (q * second - first)
    xx = 2 * b / (m * a) * (-(1 - T) / 2 + less + NU * (1 - q * T + more))
    yy = 2 * b / (m * a) * (0.5 + 0.5 / T - q * T + more + NU * (-1 + T + less))
    zz = -b / (m * a) * (1 - T**2) / T
    for found, exact in zip(np.diagonal(s).T, (xx, yy, zz), strict=True):
        np.testing.assert_allclose(found, exact, rtol=0, atol=RINGS)


@pytest.mark.parametrize("ratio", [1.3, 1.6, 2.5])
def test_an_ellipse_sinks_in_by_a_paraboloid_at_the_centres_of_curvature_of_its_pointed_ends_too(ratio):
    a, b = ratio**0.5, ratio**-0.5
    centre = (a**2 - b**2) / a  # around it a ring touches the edge along an arc, not in points
    x, y = centre + np.random.default_rng(1).uniform(-0.1, 0.1, 300), np.linspace(-0.15, 0.15, 300) * b
    x, y = (v[(x / a) ** 2 + (y / b) ** 2 < 1] for v in (x, y))
    w = displacement(x, y, 0.0, pressure=rings_of(ellipse(a, b)), body=BARE.with_friction(0.0))[2]
    paraboloid = np.stack([np.ones_like(x), x**2, y**2], axis=1)
    left = w - paraboloid @ np.linalg.lstsq(paraboloid, w)[0]
    np.testing.assert_allclose(left, 0, rtol=0, atol=6e-7)


def point_stress(x, y, z):
    """Of a normal force 1 with a tangential one F, (6, n)."""
    r = np.hypot(x, y)
    return combine_stress(half_space_stress(r, z, NU, F), directions(x / r, y / r), F)


def point_displacement(x, y, z):
    r = np.hypot(x, y)
    return combine_displacement(half_space_displacement(r, z, 1.0, NU, F), directions(x / r, y / r), F)


def by_point_forces(x, y, z, shape):
    """Stress of the shape summed over 200 rays to its edge and 100 points along each, crowded there."""
    s, w = legendre.leggauss(100)
    v, theta = (1 + s) / 2, 2 * np.pi * np.arange(200) / 200
    rho, reach = 1 - v**2, shape.reach(theta)
    u, t = rho[:, None] * reach * np.cos(theta), rho[:, None] * reach * np.sin(theta)
    (x0, y0), (A, B) = shape.centre, shape.axes
    X, Y = x0 + A * u, y0 + B * t
    force = shape.pressure(X, Y) * (w * v * rho)[:, None] * reach**2 * A * B * 2 * np.pi / theta.size
    out = []
    for at in zip(x, y, z, strict=True):
        out.append(point_stress((at[0] - X).ravel(), (at[1] - Y).ravel(), at[2]) @ force.ravel())
    return np.array(out).T


def lobed():
    """A contour of three unequal lobes, and a pressure that is not Hertz's."""
    contour, b = np.zeros(len(FULL)), np.zeros((2, len(FULL)))
    contour[FULL.index(3)], contour[FULL.index(-4)] = 0.06, 0.02
    b[0, 0], b[1, 0], b[0, FULL.index(1)] = 1.0, 0.2, 0.1
    return Shape((0.1, 0.0), (1.1, 0.9), FULL, contour, b)


@pytest.mark.parametrize(
    ("shape", "atol"),
    [
        (ellipse(1.5**0.5, 1.5**-0.5), 3e-8),
        # the radii at which rings touch the edge merge beside a long side
        (ellipse(5**0.5, 5**-0.5), 1e-7),
        (lobed(), 3e-8),
    ],
    ids=["1.5 : 1", "5 : 1", "lobed"],
)
def test_stress_below_a_contour_is_the_sum_of_its_point_forces(shape, atol):
    rng = np.random.default_rng(3)
    x, y = rng.uniform(-2, 2, (2, 40)) * np.array(shape.axes)[:, None]
    z = rng.uniform(0.5, 1, 40)  # where the sum has converged, to 1e-10
    found = stress(x, y, z, pressure=rings_of(shape))[SIX]
    np.testing.assert_allclose(found, by_point_forces(x, y, z, shape), rtol=0, atol=atol)


@pytest.mark.parametrize("e", [0.02, 0.1, 0.3])
@pytest.mark.parametrize("place", [0.0, 0.5, 1.0, 1.3, 20.0])
@pytest.mark.parametrize("harmonics", [numbers.ROUND, numbers.EVEN])
def test_rings_carry_the_load_of_a_film_that_is_narrower_than_their_panels(e, place, harmonics):
    """f = sqrt(t) tau^6 of tau that changes within e of the edge; W = pi int f dt over t = 1 - r^2."""
    coefficients = np.zeros((7, len(harmonics)))
    coefficients[:, 0] = legendre.poly2leg([0, 0, 0, 0, 0, 0, 1])
    shape = Shape((0.0, 0.0), (1.0, 1.0), harmonics, np.zeros(len(harmonics)), coefficients, layer=e)
    rings = rings_of(shape).rings(np.array([place]), np.zeros(1), np.array([0.1]))
    load, _ = quad(
        lambda v: 2 * np.pi * v * shape.at_distance(1 - v * v), 0, 1, points=[e**0.5], epsabs=1e-13
    )
    assert rings.weight @ rings.harmonics[0] == pytest.approx(load, abs=2 * RINGS)


@pytest.mark.parametrize("harmonics", [numbers.EVEN, numbers.ACROSS])
def test_rings_of_mirror_images_are_those_without_regard_to_symmetry(harmonics):
    rng = np.random.default_rng(3)
    b = 0.05 * rng.standard_normal((4, len(harmonics)))
    b[0, 0] = 1.0
    contour = 0.01 * rng.standard_normal(b.shape[1]) / np.arange(1, b.shape[1] + 1) ** 2
    shape = Shape((0.0, 0.0), (1.0, 2.7), harmonics, contour, b)
    inner, outer = rng.uniform(-1.5, 1.5, (2, 20)), np.zeros(20)  # points anywhere and on both axes
    x, y = (
        np.concatenate([inner[0], inner[0], outer, [0, 0.9999, -1]]),
        np.concatenate([2 * inner[1], outer, 2 * inner[1], np.zeros(3)]),
    )

    def sums(rings):
        size = rings.weight / (rings.radius + 0.01)
        return [np.bincount(rings.foot, size * one, x.size) for one in rings.harmonics]

    class Any(Shape):
        mirrors = False, False

    free = replace(rings_of(shape), shape=Any(**vars(shape)))
    scale = np.full(x.size, 0.01)
    found, wanted = (sums(one.rings(x, y, scale)) for one in (rings_of(shape), free))
    np.testing.assert_allclose(found, wanted, rtol=0, atol=1e-12)


@pytest.mark.parametrize("body", [BARE, COATED, THIN], ids=["bare", "two coatings", "thin"])
def test_surface_tractions_are_minus_p_and_minus_q(body):
    for pressure in (DISC, rings_of(ellipse(1.3, 0.8)), rings_of(lobed())):
        x = np.linspace(-1.5, 1.5, 13)
        s, p = stress(x, 0.21, 0.0, pressure=pressure, body=body), pressure.pressure(x, 0.21)
        np.testing.assert_allclose(s[2], [-F * p, 0 * p, -p], rtol=0, atol=RINGS)


def hankel(x, z, layer, body, k_max):
    """Stress xx, yy, zz, xz and u_x, u_z without friction, on y = 0 below sqrt(1 - r^2), by Gauss panels.

    phat = 2 pi int sqrt(1 - r^2) J0 r dr = 2 pi j_1(k) / k.
    The formulas of ``point_force`` without its tables.
    """
    edges = np.concatenate([[0.0], np.geomspace(1e-6, 1, 16), np.arange(2, k_max + 1, 1.0)])
    s, w = legendre.leggauss(12)
    half = np.diff(edges)[:, None] / 2
    k = (edges[:-1, None] + half * (1 + s)).ravel()
    weight = (half * w).ravel() * spherical_jn(1, k)  # phat k dk / 2 pi
    c, kr = np.sign(x), np.outer(np.abs(x), k)

    def H(m, response):
        return jv(m, kr) @ (weight * response)

    zz, Lz, LL, TT = stress_frf(k, [z], layer, load="normal", **body.layers)[:, 0]
    mean, half_difference = H(0, (LL + TT) / 2), -H(2, (LL - TT) / 2)
    s_zz, s_xz = H(0, zz), -c * H(1, Lz)
    zz, Lz, LL, TT = stress_frf(k, [z], layer, load="in-plane", **body.layers)[:, 0]
    A, B = stress_frf(k, [z], layer, load="anti-plane", **body.layers)[:, 0]
    D = (LL - TT) / 2
    mean = mean - F * c * H(1, (LL + TT) / 2)
    half_difference = half_difference - F * c * (H(1, D - B) - H(3, D + B)) / 2
    s_zz = s_zz - F * c * H(1, zz)
    s_xz = s_xz - F * (H(0, Lz + A) - H(2, Lz - A)) / 2
    uz, U = displacement_frf(k, [z], layer, load="normal", **body.layers)[:, 0] / k
    return (mean + half_difference, mean - half_difference, s_zz, s_xz), (-c * H(1, U), H(0, uz))


@pytest.mark.parametrize(
    ("coatings", "substrate"),
    [
        (((4.0, 0.3, 1.0),), (1.0, 0.3)),
        (((0.1, 0.5, 0.2),), (1.0, 0.2)),
        (((10.0, 0.3, 0.03), (0.2, 0.4, 0.1)), (1.0, 0.3)),
        (((100.0, 0.2, 0.02),), (1.0, 0.3)),
    ],
    ids=["stiff", "soft", "two thin", "hundred times as stiff"],
)
def test_coated_field_is_its_hankel_integral(coatings, substrate):
    body, interfaces = Body(coatings, substrate, F), np.cumsum([h for _, _, h in coatings])
    x = np.array([0.0, 0.41, -0.8, 1.0, -2.5])
    places = [(0.5, int(np.searchsorted(interfaces, 0.5))), (2.0, len(coatings)), (10.0, len(coatings))]
    places += [(h, layer + side) for layer, h in enumerate(interfaces) for side in (0, 1)]
    for z, layer in places:
        exact, exact_u = hankel(x, z, layer, body, k_max=min(40 / z, 1500))
        s = stress(x, 0.0, z, layer, body=body)
        mine = [s[i, j] for i, j in ((0, 0), (1, 1), (2, 2), (0, 2))]
        # tables of either side, 1e-7 of the largest; stiff films carry many p0
        np.testing.assert_allclose(mine, exact, rtol=0, atol=5e-7 * max(1.0, np.abs(s).max()))
        u = displacement(x, 0.0, z, layer, body=body.with_friction(0.0))
        np.testing.assert_allclose(u[[0, 2]], exact_u, rtol=0, atol=5e-7 * np.abs(u).max())


@pytest.mark.parametrize("place", [(0.3, 0.2, 0.15, 0), (-0.6, 0.1, 0.36, 1), (0.9, -0.4, 0.8, 2)])
@pytest.mark.parametrize("pressure", [DISC, rings_of(lobed())], ids=["disc", "lobed"])
def test_fields_are_in_equilibrium_and_obey_hooke(place, pressure):
    x, y, z, layer = place
    E, nu = COATED.materials[layer][:2]
    h = 0.005
    steps = h * np.array([-2, -1, 1, 2])
    at = np.array([x, y, z]) + np.eye(3)[:, None, :] * steps[:, None]  # along each axis, (3, 4, 3)
    weights = np.array([1, -8, 8, -1]) / (12 * h)
    given = {"pressure": pressure, "body": COATED}
    s = stress(*np.moveaxis(at, -1, 0), layer, **given)
    gradient = np.einsum("ijab,b->ija", s, weights)
    # fourth-order differences of fields that vary over z: (h/z)^4; rounding of the tables 1e-7/h
    assert np.abs(np.einsum("ijj->i", gradient)).max() < 1e-4 * np.abs(gradient).max()
    u = displacement(*np.moveaxis(at, -1, 0), layer, **given)
    strain = np.einsum("iab,b->ia", u, weights)
    strain = (strain + strain.T) / 2
    here = stress(x, y, z, layer, **given)
    hooke = ((1 + nu) * here - nu * np.trace(here) * np.eye(3)) / E
    np.testing.assert_allclose(strain, hooke, rtol=0, atol=1e-4 * np.abs(hooke).max())


def test_field_far_away_is_that_of_a_point_force():
    x, y, z = np.array([30.0, 5.0]), np.array([-12.0, 0.0]), np.array([20.0, 80.0])
    of = 2 * np.pi / 3
    # the second moment of the contact over the square of its distance: (a/R)^2 / 5 times a few
    for found, exact in (
        (stress(x, y, z)[SIX], of * point_stress(x, y, z)),
        (displacement(x, y, z), of * point_displacement(x, y, z)),
    ):
        np.testing.assert_allclose(found, exact, rtol=0, atol=2e-3 * np.abs(exact).max())


def test_many_depths_are_interpolated_to_what_each_gives_alone():
    rng = np.random.default_rng(11)
    x, y, z = rng.uniform(-1.2, 1.2, (3, 60)) * np.array([1, 1, 0.2])[:, None]
    for low, layer in ((0.0, 0), (0.3, 1), (0.45, 2)):
        depth = low + np.abs(z) * (0.6 if layer == 1 else 1)
        together = stress(x, y, depth, layer, body=COATED)
        alone = [stress(x[i], y[i], depth[i], layer, body=COATED) for i in range(6)]
        np.testing.assert_allclose(together[..., :6], np.stack(alone, axis=-1), rtol=0, atol=1e-7)


def test_stress_is_proportional_to_the_influence_of_point_forces(monkeypatch):
    """All of them 1.01 times as large: as the stress, at z = 0 but for the local terms of the pressure."""
    x, y, z = points(np.array([0.0, 0.5, 1.2]), depths=np.array([0.1, 0.2, 0.6]))
    layer = np.searchsorted(np.cumsum(COATED.thickness), z)
    before = stress(x, y, z, layer, body=COATED)

    def scaled(function):
        def larger(*given, **options):
            found = function(*given, **options)
            if isinstance(found, np.ndarray):
                return 1.01 * found
            for table in found:
                table.radial.c *= 1.01
            return found

        return larger

    for name in ("half_space_stress", "stress_below"):
        monkeypatch.setattr(subsurface, name, scaled(getattr(subsurface, name)))
    np.testing.assert_allclose(stress(x, y, z, layer, body=COATED), 1.01 * before, rtol=1e-12, atol=1e-14)


def test_no_points_give_no_stress():
    assert stress(np.zeros(0), 0.0, 0.0).shape == (3, 3, 0)
