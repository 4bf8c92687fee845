"""Stress and displacement below a grid: closed forms, field equations, continuity, Hankel quadrature."""

import numpy as np
import pytest
from scipy.special import j0, j1, jv, spherical_jn

from semianalytic import halfspace, subsurface
from semianalytic.frf import displacement_frf, stress_frf
from semianalytic.inputs import Body

NU = 0.3
TWO_COATINGS = (((4.0, 0.25, 0.3), (0.3, 0.4, 0.15)), (1.0, 0.3))


def hertz_means(n, half_width=1.12, aspect=1.0):
    """Grid and patch means of sqrt(1 - r^2), a = p0 = 1: Gauss points, midpoints near the edge."""
    d = 2 * half_width / n
    x = (np.arange(n) - n // 2) * d
    y = (np.arange(round(n * aspect)) - round(n * aspect) // 2) * d / aspect
    X, Y = np.meshgrid(x, y, indexing="ij")
    r = np.hypot(X, Y)
    mean = np.zeros_like(r)
    near = np.abs(r - 1) < 3 * d
    gauss, weight = np.polynomial.legendre.leggauss(4)
    for where, nodes, weights in (
        (~near & (r < 1), gauss, weight / 2),
        (near, (np.arange(24) + 0.5) / 12 - 1, np.full(24, 1 / 24)),
    ):
        xs, ys = (
            X[where][:, None, None] + nodes[:, None] * d / 2,
            Y[where][:, None, None] + nodes * d / aspect / 2,
        )
        p = np.sqrt(np.maximum(1 - xs**2 - ys**2, 0))
        mean[where] = np.einsum("pij,i,j->p", p, weights, weights)
    area = d * d / aspect
    mean *= 2 * np.pi / 3 / (mean.sum() * area)
    return {"grid_x": x, "grid_y": y, "pressure": mean}


GRID = hertz_means(129)
D = GRID["grid_x"][1] - GRID["grid_x"][0]


def sigma(x, y, z, layer, *, grid=GRID, f=0.0, coatings=(), substrate=(1.0, NU)):
    return subsurface.stress(x, y, z, layer, body=Body(coatings, substrate, f), **grid)


def displacement(x, y, z, layer, *, f=0.0, coatings=(), substrate=(1.0, NU)):
    return subsurface.displacement(x, y, z, layer, body=Body(coatings, substrate, f), **GRID)


def hankel_stress(x, z, layer, coatings, substrate, f, k_max):
    """Stress on y = 0 below p = sqrt(1 - r^2): Hankel integrals of the response functions, Gauss panels.

    phat = 2 pi int sqrt(1 - r^2) J0 r dr = 2 pi j_1(k) / k.
    The formulas of `pointload` without its tables.
    """
    edges = np.concatenate([[0.0], np.geomspace(1e-4, 1, 12), np.arange(2, k_max + 1, 1.0)])
    s, w = np.polynomial.legendre.leggauss(12)
    half = np.diff(edges)[:, None] / 2
    k = (edges[:-1, None] + half * (1 + s)).ravel()
    weight = (half * w).ravel() * spherical_jn(1, k)  # phat k dk / 2 pi
    body = {"coatings": coatings, "substrate": substrate}
    r, c = np.abs(x), np.sign(x)
    kr = np.outer(r, k)

    def H(m, F):
        return jv(m, kr) @ (weight * F)

    zz, Lz, LL, TT = stress_frf(k, [z], layer, load="normal", **body)[:, 0]
    mean, half_difference = H(0, (LL + TT) / 2), -H(2, (LL - TT) / 2)
    s_zz, s_xz = H(0, zz), -c * H(1, Lz)
    zz, Lz, LL, TT = stress_frf(k, [z], layer, load="in-plane", **body)[:, 0]
    A, B = stress_frf(k, [z], layer, load="anti-plane", **body)[:, 0]
    D = (LL - TT) / 2
    mean = mean - f * c * H(1, (LL + TT) / 2)
    half_difference = half_difference - f * c * (H(1, D - B) - H(3, D + B)) / 2
    s_zz = s_zz - f * c * H(1, zz)
    s_xz = s_xz - f * (H(0, Lz + A) - H(2, Lz - A)) / 2
    return mean + half_difference, mean - half_difference, s_zz, s_xz


def test_stress_on_the_axis_is_johnsons():
    z = np.concatenate([[0.0], np.geomspace(1e-3, 10, 40)])
    s = sigma(0.0, 0.0, z, 0)
    lateral = -(1 + NU) * (1 - z * np.arctan2(1, z)) + 0.5 / (1 + z**2)
    # 129 patches: (d/a)^2 / 24 = 1.3e-5
    np.testing.assert_allclose(s[0, 0], lateral, atol=2e-5)
    np.testing.assert_allclose(s[1, 1], lateral, atol=2e-5)
    np.testing.assert_allclose(s[2, 2], -1 / (1 + z**2), atol=2e-5)
    # odd components; deep down the forces are gathered on lattices that do not lie symmetrically
    assert np.abs(s[[0, 0, 1], [1, 2, 2]]).max() < 1e-7


def test_sliding_shear_on_the_axis_is_the_closed_form():
    z = np.concatenate([[0.0], np.geomspace(1e-3, 10, 40)])
    f = 0.3
    exact = -1 + 1.5 * z * np.arctan2(1, z) - z**2 / (2 * (1 + z**2))  # Hamilton (1983) on the axis
    np.testing.assert_allclose(sigma(0, 0, z, 0, f=f)[0, 2] / f, exact, atol=2e-5)


def test_sliding_surface_stress_is_linear_and_tensile_at_the_trailing_edge():
    # Hamilton (1983): inside, sigma_xx = f p0 pi (4 + nu)/8 (-x/a), sigma_yy = f p0 3 pi nu/8 (-x/a)
    x = np.linspace(-1, 1, 41) * (1 - 4 * D)  # nodes and points between
    x, y = np.concatenate([x, 0.7 * x]), np.concatenate([0 * x, 0.31 + 0 * x])
    bare, sliding = sigma(x, y, 0.0, 0), sigma(x, y, 0.0, 0, f=1.0)
    # 2e-4 p_h at f = 1 more than three patches from the edge, on half the default grid
    np.testing.assert_allclose((sliding - bare)[0, 0], -np.pi * (4 + NU) / 8 * x, atol=2e-4)
    np.testing.assert_allclose((sliding - bare)[1, 1], -3 * np.pi * NU / 8 * x, atol=2e-4)
    # with Hertz's part, Johnson (3.42): at x = -a together (1 - 2 nu)/3 + f pi (4 + nu)/8 (Hamilton 1983)
    on_line = (y == 0) & (x != 0)
    x, t = x[on_line], 1 - x[on_line] ** 2
    hertz = (1 - 2 * NU) / (3 * x**2) * (1 - t**1.5) - np.sqrt(t)
    np.testing.assert_allclose(sliding[0, 0, on_line], hertz - np.pi * (4 + NU) / 8 * x, atol=2e-4)


def test_surface_stress_outside_the_contact_is_pure_shear_of_hertz():
    x = np.array([1 + 4 * D, 1.5, 2.2, -3.7])
    s = sigma(x, 0.0, 0.0, 0)
    exact = (1 - 2 * NU) / (3 * x**2)  # Johnson (3.43)
    np.testing.assert_allclose(s[0, 0], exact, atol=5e-5)
    np.testing.assert_allclose(s[1, 1], -exact, atol=5e-5)


@pytest.mark.parametrize("f", [0.0, 0.25])
@pytest.mark.parametrize("coatings", [(), TWO_COATINGS[0], ((10.0, 0.3, D / 2),)])
def test_surface_tractions_are_minus_p_and_minus_q(f, coatings):
    x, y = GRID["grid_x"], GRID["grid_y"][64 + 13]
    p = np.sqrt(np.maximum(1 - x**2 - y**2, 0))
    away = np.abs(np.hypot(x, y) - 1) > 3 * D
    s = sigma(x, y, 0.0, 0, f=f, coatings=coatings)
    np.testing.assert_allclose(s[2, 2][away], -p[away], atol=1e-4)
    np.testing.assert_allclose(s[0, 2][away], -f * p[away], atol=1e-4)
    assert np.abs(s[1, 2]).max() < 1e-12


@pytest.mark.parametrize(
    "coatings", [((1.0, NU, 0.4),), ((1.0, NU, 0.02), (1.0, NU, 0.7)), ((1.0, NU, D / 2),)]
)
def test_layers_of_equal_moduli_are_no_layers(coatings):
    interfaces = np.cumsum([h for _, _, h in coatings])
    x, y = np.array([0.0, 0.4, -0.8, 1.7]), np.array([0.1, 0.0, 0.3, -2.2])
    for z in (0.0, 0.013, interfaces[0], 0.1, interfaces[-1], 3.0):
        layer = int(np.searchsorted(interfaces, z))
        for field in (sigma, displacement):
            bare = field(x, y, z, 0, f=0.3)
            layered = field(x, y, z, layer, f=0.3, coatings=coatings)
            # thin layers take the table of the whole response in place of closed forms: 1e-6
            np.testing.assert_allclose(layered, bare, atol=2e-6 * np.abs(bare).max())


@pytest.mark.parametrize(
    ("coatings", "substrate"),
    [TWO_COATINGS, (((10.0, 0.3, 0.05),), (1.0, 0.3)), (((0.05, 0.5, D),), (1.0, 0.0))],
    ids=["two", "thin and stiff", "one patch, soft"],
)
def test_tractions_and_displacements_continue_across_interfaces(coatings, substrate):
    x, y = np.array([0.0, 0.5, -0.9, 1.6]), np.array([0.2, 0.0, 0.1, -1.0])
    body = {"f": 0.4, "coatings": coatings, "substrate": substrate}
    for layer, depth in enumerate(np.cumsum([h for _, _, h in coatings])):
        above, below = (sigma(x, y, depth, side, **body) for side in (layer, layer + 1))
        # the first interface of a thin coating compares closed forms plus tables with tables
        np.testing.assert_allclose(above[2], below[2], atol=2e-6)
        assert np.abs(above[0, 0] - below[0, 0]).max() > 1e-2  # which jumps
        above, below = (displacement(x, y, depth, side, **body) for side in (layer, layer + 1))
        np.testing.assert_allclose(above, below, atol=2e-6 * np.abs(above).max())


@pytest.mark.parametrize(
    ("x", "y", "z", "layer"),
    [
        (0.3, 0.2, 0.15, 0),
        (0.3, 0.2, 1.5 * D, 0),
        (-0.6, 0.1, 0.36, 1),
        (0.9, -0.4, 0.8, 2),
        (1.8, 0.5, 0.05, 0),
    ],
)
def test_fields_are_in_equilibrium_and_obey_hooke(x, y, z, layer):
    coatings, substrate = TWO_COATINGS
    body = {"f": 0.4, "coatings": coatings, "substrate": substrate}
    E, nu = (*coatings, substrate)[layer][:2]
    node = np.round(np.array([x, y]) / D) * D  # the shallow fields are exact at nodes
    step = 2 * D if z < 3 * D else D
    steps = np.zeros((3, 4, 3))
    for axis in range(3):
        h = step if axis < 2 else min(step, 0.02, z / 5)
        steps[axis, :, axis] = h * np.array([-2, -1, 1, 2])
    at = np.array([*node, z]) + steps
    weights = np.array([1, -8, 8, -1]) / 12
    spacing = np.array([steps[axis, 2, axis] for axis in range(3)])
    s = sigma(*np.moveaxis(at, -1, 0), layer, **body)
    u = displacement(*np.moveaxis(at, -1, 0), layer, **body)
    gradient = np.einsum("ijab,b,a->ija", s, weights, 1 / spacing)
    # fourth-order differences of fields that vary over 0.2 a: (0.035/0.2)^4 = 1e-3 of the gradient
    assert np.abs(np.einsum("ijj->i", gradient)).max() < 3e-3 * np.abs(gradient).max()
    strain = np.einsum("iab,b,a->ia", u, weights, 1 / spacing)
    strain = (strain + strain.T) / 2
    here = sigma(*node, z, layer, **body)
    hooke = ((1 + nu) * here - nu * np.trace(here) * np.eye(3)) / E
    np.testing.assert_allclose(strain, hooke, atol=3e-3 * np.abs(hooke).max())


@pytest.mark.parametrize(
    ("coatings", "substrate"),
    [
        (((4.0, 0.3, 1.0),), (1.0, 0.3)),
        (((0.1, 0.5, 0.2),), (1.0, 0.2)),
        (((10.0, 0.3, 0.03), (0.2, 0.4, 0.1)), (1.0, 0.3)),
        (((100.0, 0.2, D / 2),), (1.0, 0.3)),
    ],
    ids=["stiff", "soft", "two thin", "half a patch"],
)
def test_coated_stress_is_its_hankel_integral(coatings, substrate):
    interfaces = np.cumsum([h for _, _, h in coatings])
    x = np.array([0.0, 0.41, -0.8, 1 + 5 * D, -2.5])
    points = [(0.5, int(np.searchsorted(interfaces, 0.5))), (2.0, len(coatings)), (10.0, len(coatings))]
    points += [(h, layer + side) for layer, h in enumerate(interfaces) for side in (0, 1)]
    for z, layer in points:
        exact = hankel_stress(x, z, layer, coatings, substrate, 0.3, k_max=min(40 / z, 1500))
        s = sigma(x, 0.0, z, layer, f=0.3, coatings=coatings, substrate=substrate)
        mine = s[0, 0], s[1, 1], s[2, 2], s[0, 2]
        scale = max(1.0, np.abs(exact).max())
        # 2e-4 p_h is required of 257 patches; here 129, and stiff films carry many p_h
        assert np.abs(np.array(mine) - np.array(exact)).max() < 2e-4 * scale, (z, layer)


def test_stress_is_mirrored_with_the_sliding_direction():
    coatings, substrate = TWO_COATINGS
    x, y = np.array([0.3, -0.75, 1.4]), np.array([0.2, 0.4, -1.1])
    for z, layer in ((0.0, 0), (0.02, 0), (0.3, 1), (0.6, 2)):
        body = {"coatings": coatings, "substrate": substrate}
        s = sigma(x, y, z, layer, f=0.4, **body)
        across = sigma(x, -y, z, layer, f=0.4, **body)
        back = sigma(-x, y, z, layer, f=-0.4, **body)
        flip_y, flip_x = np.array([1, -1, 1]), np.array([-1, 1, 1])
        np.testing.assert_allclose(
            across, s * np.multiply.outer(flip_y, flip_y)[..., None], rtol=0, atol=1e-10
        )
        np.testing.assert_allclose(back, s * np.multiply.outer(flip_x, flip_x)[..., None], rtol=0, atol=1e-10)


def test_stress_far_away_is_that_of_a_point_force():
    x, y, z = np.array([30.0, 5.0]), np.array([-12.0, 0.0]), np.array([20.0, 80.0])
    load = 2 * np.pi / 3
    point = halfspace.normal_stress(x, y, z, 1e-2, 1e-2, NU) + 0.2 * halfspace.tangential_stress(
        x, y, z, 1e-2, 1e-2, NU
    )
    # the second moment of the contact over its distance: (a/R)^2 / 5 times a few
    np.testing.assert_allclose(
        sigma(x, y, z, 0, f=0.2), load * point / 1e-4, atol=5e-3 * np.abs(load * point / 1e-4).max()
    )


def test_oblong_patches_serve_as_well():
    grid = hertz_means(129, aspect=0.75)
    x, y, z = (
        np.array([0.0, 0.5, -0.3, 0.2]),
        np.array([0.0, 0.2, 0.4, -0.6]),
        np.array([0.0, 0.01, 0.06, 0.7]),
    )
    coatings, substrate = TWO_COATINGS
    layer = np.array([0, 0, 0, 2])
    oblong, square = (
        sigma(x, y, z, layer, grid=g, f=0.3, coatings=coatings, substrate=substrate) for g in (grid, GRID)
    )
    np.testing.assert_allclose(oblong, square, atol=1e-4)


@pytest.mark.parametrize(("z", "layer"), [(0.0, 0), (0.02, 0), (0.3, 0), (0.3, 1), (1.0, 2)])
def test_plane_of_stress_is_the_stress_at_the_patch_centres(z, layer):
    coatings, substrate = TWO_COATINGS
    grid = {"grid_x": GRID["grid_x"], "grid_y": GRID["grid_y"]}
    plane = subsurface.stress_plane(z, layer, **grid, body=Body(coatings, substrate, 0.3))
    whole = plane(GRID["pressure"])
    i, j = np.array([64, 3, 90, 128, 0]), np.array([64, 10, 70, 128, 77])
    x, y = grid["grid_x"][i], grid["grid_y"][j]
    s = sigma(x, y, z, layer, f=0.3, coatings=coatings, substrate=substrate)
    six = s[(0, 1, 2, 0, 0, 1), (0, 1, 2, 1, 2, 2)]
    np.testing.assert_allclose(whole[:, i, j], six, atol=2e-6)  # coarser lattices deep down


def test_plane_refuses_a_pressure_of_another_grid():
    x = GRID["grid_x"]
    plane = subsurface.stress_plane(1.0, 0, grid_x=x, grid_y=x, body=Body((), (1, NU), 0.0))
    with pytest.raises(ValueError, match=r"\(3, 3\)"):
        plane(np.zeros((3, 3)))


def test_displacement_of_hertz_on_the_surface_and_axis():
    r = np.array([0.0, 0.33, 0.8])
    E_star = 1 / (1 - NU**2)
    exact = np.pi / (4 * E_star) * (2 - r**2)  # Johnson (3.41a)
    np.testing.assert_allclose(displacement(r, 0.0, 0.0, 0)[2], exact, rtol=1e-5)


def test_sliding_displacement_of_a_point_far_away_is_cerrutis():
    x, y, z = np.array([40.0]), np.array([9.0]), np.array([30.0])
    load = 2 * np.pi / 3
    u = displacement(x, y, z, 0, f=1.0) - displacement(x, y, z, 0, f=0.0)
    point = halfspace.tangential_displacement(x, y, z, 1e-2, 1e-2, 1.0, NU) / 1e-4
    np.testing.assert_allclose(u, load * point, rtol=1e-2, atol=1e-4 * load * np.abs(point).max())


def test_coated_displacement_is_its_hankel_integral():
    coatings, substrate = TWO_COATINGS
    k = np.concatenate([[0], np.geomspace(1e-5, 1, 14), np.arange(2.0, 400)])
    s, w = np.polynomial.legendre.leggauss(12)
    half = np.diff(k)[:, None] / 2
    k = (k[:-1, None] + half * (1 + s)).ravel()
    weight = (half * w).ravel() * spherical_jn(1, k) / k
    r = np.array([0.0, 0.4, 0.85, 2.0])
    for z, layer in ((0.1, 0), (0.3, 0), (0.3, 1), (0.45, 2), (3.0, 2)):
        uz, U = displacement_frf(k, [z], layer, coatings=coatings, substrate=substrate, load="normal")[:, 0]
        u = displacement(r, 0.0, z, layer, coatings=coatings, substrate=substrate)
        np.testing.assert_allclose(u[2], j0(np.outer(r, k)) @ (weight * uz), atol=2e-5)
        np.testing.assert_allclose(u[0], -j1(np.outer(r, k)) @ (weight * U), atol=2e-5)


def test_many_shallow_depths_are_interpolated_to_what_each_gives_alone():
    rng = np.random.default_rng(11)
    coatings, substrate = (((4.0, 0.25, 0.02), (0.3, 0.4, 0.15)), (1.0, 0.3))
    x, y = rng.uniform(-0.6, 0.6, (2, 30))
    z = rng.uniform(0, 0.02, 30)
    together = sigma(x, y, z, 0, f=0.3, coatings=coatings, substrate=substrate)
    alone = [sigma(x[i], y[i], z[i], 0, f=0.3, coatings=coatings, substrate=substrate) for i in range(5)]
    np.testing.assert_allclose(together[..., :5], np.stack(alone, axis=-1), atol=2e-6)


def test_no_points_give_no_stress():
    assert sigma(np.zeros(0), 0.0, 0.0, 0).shape == (3, 3, 0)
