"""Laws and limits of the contact found by finite elements: at rest, then sliding.

Sliding is a first harmonic that leaves the contact at rest as it is, so both share the solved contacts.
"""

from dataclasses import replace
from functools import lru_cache

import numpy as np
import pytest

from fem_reference import solve, solve_prescribed
from fem_reference.contact.fixed_radius import _even_at_the_axis, complementarity, solve_at_radius
from fem_reference.elasticity.axisymmetric import Discretisation
from fem_reference.meshing.mesh import Grading, meridian_mesh
from fem_reference.scaling import LayeredSolid
from verification.sources.references.hertz import Hertz

R, W = 10e-3, 20.0
E, NU = 210e9, 0.3
E_STAR = E / (1 - NU**2)
A_H = (3 * W * R / (4 * E_STAR)) ** (1 / 3)
P_H = 3 * W / (2 * np.pi * A_H**2)

CASES = {
    "stiff": ((4 * E, 0.25, 0.5 * A_H),),
    "compliant": ((E / 4, 0.4, A_H),),
    "interlayer": ((2 * E, 0.2, 0.4 * A_H), (E / 2, 0.3, 0.05 * A_H)),
}


HALF_SPACES = {"bare": (), "layers of equal moduli": ((E, NU, 0.1 * A_H), (E, NU, 0.9 * A_H))}


def pressed(coatings, **options):
    given = {"radius": R, "load": W, "substrate": (E, NU), "estimate_uncertainty": False}
    return solve(coatings=coatings, **given | options)


@lru_cache
def solved(name, quality="default"):
    return pressed((CASES | HALF_SPACES)[name], quality=quality)


def disc(a, n=400):
    """Radii and weights of 2 pi r dr on r <= a, exact for sqrt(1 - r^2/a^2) times polynomials of r^2."""
    s, weight = np.polynomial.legendre.leggauss(n)
    t = (s + 1) / 2
    # r^2 = a^2 (1 - t^2): the square root at the edge becomes t
    return a * np.sqrt(1 - t**2), 2 * np.pi * a**2 * t * weight / 2


@pytest.mark.parametrize("name", CASES)
def test_surface_carries_the_pressure_and_no_shear(name):
    s = solved(name)
    x = np.linspace(-2, 2, 81) * s.contact_radius
    sigma = s.stress(x, 0.0, 0.0)
    np.testing.assert_allclose(sigma[2, 2], -s.pressure(x), rtol=1e-13, atol=0)
    assert np.all(sigma[0, 2] == 0)
    assert 2.5 < s.surface_nodes.max() / s.contact_radius < 3
    np.testing.assert_array_equal(s.surface_nodes, -s.surface_nodes[::-1])
    # just below the surface the strains must say the same: sigma_zz changes by z^2, away from the edge
    below = s.stress(x, 0.0, 1e-4 * A_H)
    inside = np.abs(np.abs(x) - s.contact_radius) > 0.05 * s.contact_radius
    assert np.abs(below[2, 2] + s.pressure(x))[inside].max() < 2e-4 * s.peak_pressure


@pytest.mark.parametrize("name", CASES)
def test_tractions_are_continuous_across_every_interface(name):
    s = solved(name)
    x = np.linspace(-2.5, 2.5, 101) * A_H
    for k, depth in enumerate(np.cumsum([h for _, _, h in CASES[name]])):
        upper, lower = s.stress(x, 0.0, depth, layer=k), s.stress(x, 0.0, depth, layer=k + 1)
        np.testing.assert_allclose(upper[:, 2], lower[:, 2], rtol=0, atol=1e-12 * P_H)
        assert np.abs(upper[0, 0] - lower[0, 0]).max() > 0.05 * P_H  # this one must jump
        # On the interface itself one side lends its tractions to the other. A hair off it each side
        # differentiates alone: the stiffer one is then good to 2e-4 of the peak only.
        above, below = s.stress(x, 0.0, depth * (1 - 1e-6)), s.stress(x, 0.0, depth * (1 + 1e-6))
        assert np.abs(above[:, 2] - below[:, 2]).max() < 2e-4 * s.peak_pressure


def test_equal_moduli_give_hertz():
    s = solved("layers of equal moduli")
    assert s.contact_radius == pytest.approx(A_H, rel=1e-6)
    assert s.peak_pressure == pytest.approx(P_H, rel=1e-5)
    assert s.approach == pytest.approx(A_H**2 / R, rel=1e-6, abs=0)
    # d W / d approach is that of a flat punch, Johnson (1985) section 3.4
    assert s.stiffness == pytest.approx(2 * E_STAR * A_H, rel=1e-6, abs=0)
    assert s.units.length == pytest.approx(A_H, rel=1e-14, abs=0)
    z = np.linspace(0, 3, 61) * A_H
    t = z / A_H
    lateral = -(1 + NU) * (1 - t * np.arctan2(1, t)) + 0.5 / (1 + t**2)
    sigma = s.stress(0.0, 0.0, z)
    assert np.abs(sigma[0, 0] - P_H * lateral).max() < 5e-5 * P_H
    assert np.abs(sigma[2, 2] + P_H / (1 + t**2)).max() < 5e-5 * P_H


def test_thick_coating_gives_hertz_of_the_coating():
    E_1, nu_1, h = 2 * E, 0.2, 200 * A_H
    s = pressed(((E_1, nu_1, h),), quality="fast")
    a = (3 * W * R * (1 - nu_1**2) / (4 * E_1)) ** (1 / 3)
    # the substrate is felt in proportion to (a/h)^3 in a, to a/h in the approach
    assert s.contact_radius == pytest.approx(a, rel=1e-6)
    assert s.approach == pytest.approx(a**2 / R, rel=2 * a / h)


def test_thin_coating_gives_hertz_of_the_substrate():
    h = 0.001 * A_H
    s = pressed(((2 * E, NU, h),), size=0.5)
    # the coating is felt in proportion to h/a
    assert s.contact_radius == pytest.approx(A_H, rel=2 * h / A_H)
    assert s.peak_pressure == pytest.approx(P_H, rel=4 * h / A_H)


def test_scaling_with_load_radius_and_moduli():
    cheap = {"size": 0.5, "order": 2}
    base = pressed(CASES["stiff"], **cheap)
    factor = 3.0  # all lengths; W ~ E L^2 keeps strains
    coatings = tuple((7 * E_k, nu, factor * h) for E_k, nu, h in CASES["stiff"])
    other = pressed(coatings, radius=factor * R, load=7 * factor**2 * W, substrate=(7 * E, NU), **cheap)
    assert other.contact_radius == pytest.approx(factor * base.contact_radius, rel=1e-9, abs=0)
    assert other.approach == pytest.approx(factor * base.approach, rel=1e-9, abs=0)
    assert other.peak_pressure == pytest.approx(7 * base.peak_pressure, rel=1e-9)
    # sharper sphere, same contact: R -> 2R with W -> W/2 halves every stress, small strain being linear in
    # 1/R
    half = pressed(CASES["stiff"], radius=2 * R, load=W / 2, **cheap)
    assert half.contact_radius == pytest.approx(base.contact_radius, rel=1e-9, abs=0)
    assert half.peak_pressure == pytest.approx(base.peak_pressure / 2, rel=1e-9)


@pytest.mark.parametrize("order", [2, 3, 4])
def test_pressure_error_falls_at_the_expected_order(order):
    """The pressure is a derivative of u, hence order p; on the graded mesh one order may go to the edge."""
    errors = []
    r, weight = disc(1.0)
    for size in (0.8, 0.4):
        edge = 1e-4 * (size / 0.8) ** (order + 1)
        grading = Grading(size=size, edge_rate=size, edge_size=edge, axis_size=size, far_size=size)
        mesh = meridian_mesh(contact_radius=1.0, thicknesses=(), far=1000.0, grading=grading)
        solid = LayeredSolid(materials=((1.0, NU),), thicknesses=(), far=mesh.far)
        found = solve_at_radius(solid, Discretisation(mesh, order))
        exact = 2 / (np.pi * (1 - NU**2)) * np.sqrt(1 - r**2)
        errors.append(np.sqrt(np.sum(weight * (found.pressure(r) - exact) ** 2)))
    assert np.log2(errors[0] / errors[1]) > order - 1


@pytest.mark.slow
def test_outer_boundary_is_far_enough():
    near, far = (
        pressed(CASES["stiff"], far=far, quality="fast", estimate_uncertainty=True) for far in (1e3, 4e3)
    )
    # 3e-7 of the approach at 1000 a_h; the far mesh itself differs by its own estimate
    allowed = near.uncertainty.approach + far.uncertainty.approach
    assert abs(near.approach - far.approach) < allowed
    assert near.contact_radius == pytest.approx(far.contact_radius, rel=1e-5)


# The other two are solved by the slow test against the exact solution.
@pytest.mark.parametrize(("thickness", "ratio"), [(0.01, 100.0), (20.0, 0.01)])
def test_extreme_coatings_are_solved_with_positive_pressure_and_gap(ratio, thickness):
    s = pressed(((ratio * E, NU, thickness * A_H),), size=0.5)
    assert s.diagnostics.residual_pressure == 0
    assert s.diagnostics.residual_gap == 0
    # between Hertz on the stiffer and on the softer of the two solids
    a_coating = A_H * ratio ** (-1 / 3)
    assert min(A_H, a_coating) * 0.999 < s.contact_radius < max(A_H, a_coating) * 1.001


@pytest.mark.parametrize(("ratio", "thickness"), [(1.0, 0.5), (4.0, 1.0), (0.1, 0.1), (100.0, 0.02)])
def test_the_load_grows_with_the_radius_as_one_solution_says(ratio, thickness):
    solid = LayeredSolid(materials=((ratio, NU), (1.0, NU)), thicknesses=(thickness,), far=1000.0)
    mesh = meridian_mesh(contact_radius=1.0, thicknesses=(thickness,), far=1000.0, grading=Grading.of(0.4))
    one, two = (solve_at_radius(solid, Discretisation(mesh.stretched(a), 4)) for a in (1.0, 1.001))
    growth = np.log(two.load / one.load) / np.log(1.001)
    # on triangles this large the coefficients at the edge are good to some thousandths; Hertz: W ~ a^3
    assert one.growth == pytest.approx(growth, rel=5e-3)
    assert two.radius_at(one.load) == pytest.approx(1.0, rel=5e-6)
    # a contact moved to a load nearby is that of its radius, all nodes on the paraboloid
    near = solve_at_radius(solid, Discretisation(mesh.stretched(1 + 1e-6), 4))
    moved = one.at_load(near.load)
    assert moved.contact_radius == pytest.approx(1 + 1e-6, abs=1e-8)
    assert moved.load == near.load
    assert moved.approach == pytest.approx(near.approach, rel=3e-6)
    assert moved.pressure.values[0] == pytest.approx(near.pressure.values[0], rel=3e-6)
    assert complementarity(moved)[0] < 1e-12
    assert moved.residual == pytest.approx(one.residual + near.load / one.load - 1)
    if ratio == 1.0:
        assert growth == pytest.approx(3.0, rel=1e-4)


# Contacts at a given radius 1, on a coarse mesh

SOFT, HARD = (((1.0, 0.3), (2.0, 0.2)), (0.5,)), (((4.0, 0.25), (1.0, 0.1)), (0.3,))


def layered(materials, thicknesses):
    return LayeredSolid(materials=materials, thicknesses=thicknesses, far=500.0)


@lru_cache
def coarse(thicknesses, stacks):
    grading = Grading(size=0.6, edge_rate=0.6, edge_size=1e-3, axis_size=0.6, far_size=1.0)
    mesh = meridian_mesh(
        contact_radius=1.0, thicknesses=thicknesses, far=500.0, grading=grading, stacks=stacks
    )
    return Discretisation(mesh, 2)


@lru_cache
def at_radius(flat, ball=None):
    solids = [layered(*body) for body in (flat, ball) if body]
    stacks = tuple(sorted(solid.thicknesses for solid in solids))
    one, *other = (coarse(solid.thicknesses, stacks) for solid in solids)
    return solve_at_radius(solids[0], one, (solids[1], other[0]) if ball else None)


def test_a_ball_like_the_flat_halves_the_pressure():
    rigid, equal = at_radius(SOFT), at_radius(SOFT, SOFT)
    assert equal.approach == pytest.approx(rigid.approach, rel=1e-11)
    assert equal.load == pytest.approx(rigid.load / 2, rel=1e-11)
    assert equal.stiffness == pytest.approx(rigid.stiffness / 2, rel=1e-11)
    np.testing.assert_allclose(equal.pressure.values, rigid.pressure.values / 2, rtol=0, atol=1e-11)
    np.testing.assert_allclose(equal.fields, rigid.fields / 2, rtol=0, atol=1e-11)
    np.testing.assert_allclose(equal.ball.fields, equal.fields, rtol=0, atol=1e-11)
    assert max(rigid.residual, equal.residual) < 1e-10


def test_flat_and_ball_change_places():
    one, other = at_radius(SOFT, HARD), at_radius(HARD, SOFT)
    for name in ("approach", "load", "stiffness"):
        assert getattr(one, name) == pytest.approx(getattr(other, name), rel=1e-10), name
    np.testing.assert_allclose(one.ball.fields, other.fields, rtol=0, atol=1e-10)
    np.testing.assert_allclose(one.fields, other.ball.fields, rtol=0, atol=1e-10)
    d, ball = one.discretisation, one.ball.discretisation
    both = one.fields[d.N + d.contact] + one.ball.fields[ball.N + ball.contact]
    np.testing.assert_allclose(both, one.approach - d.locations[0, d.contact] ** 2 / 2, rtol=1e-10)
    assert complementarity(one) == (0, 0)


def test_penetration_and_tension_are_found():
    contact = at_radius(SOFT, HARD)
    p = contact.pressure
    tension = replace(p, values=p.values - 0.1 * p.values.max())
    deepest, largest = complementarity(replace(contact, pressure=tension))
    assert (deepest, largest) == (0, pytest.approx(1 / 9))
    # nearest to the edge, as far as the sphere is lowered but for the gap there
    deepest, largest = complementarity(replace(contact, approach=1.5 * contact.approach))
    assert (deepest, largest) == (pytest.approx(1 / 3, rel=1e-2), 0)


@pytest.mark.parametrize("order", [2, 3, 4])
def test_even_polynomials_are_kept_next_to_the_axis(order):
    r = np.linspace(0, 3, 3 * order + 1)
    kept = np.unique(np.linspace(0, order, order // 2 + 1).round().astype(int))
    even = _even_at_the_axis(r, order)
    assert even.shape == (r.size, kept.size + 2 * order)
    for power in range(0, order + 1, 2):
        free = np.concatenate([r[kept] ** power, r[order + 1 :] ** power])
        np.testing.assert_allclose(even @ free, r**power, rtol=0, atol=1e-13)


# Sliding friction as first harmonic

F = 0.5


@lru_cache
def sliding(friction=F, name="bare", quality="default"):
    """The contact is solved once; that sliding later equals sliding from the start has a test of its own."""
    return solved(name, quality).with_friction(friction)


def test_full_tensor_of_sliding_is_hamiltons():
    low, high = [-1.5, -1.5, 0.25], [1.5, 1.5, 2]
    x, y, z = A_H * np.random.default_rng(3).uniform(low, high, (40, 3)).T
    found = sliding().stress(x, y, z) - sliding(0.0).stress(x, y, z)
    exact = F * Hertz(R, W, E, NU, F).stress_of_traction(x, y, z)
    assert np.abs(found - exact).max() < 1e-4 * F * P_H


def test_reversed_friction_mirrors_the_field():
    forward, backward = sliding(name="stiff", quality="fast"), sliding(-F, "stiff", "fast")
    x, y, z = (A_H * np.array(v) for v in ([0.4, -0.9], [0.2, 0.3], [0.3, 0.9]))
    mirror = np.diag([-1.0, 1.0, 1.0])
    expected = np.einsum("ia,jb,ab...->ij...", mirror, mirror, forward.stress(x, y, z))
    np.testing.assert_allclose(backward.stress(-x, y, z), expected, rtol=0, atol=1e-9 * forward.peak_pressure)
    np.testing.assert_allclose(
        backward.displacement(-x, y, z)[0], -forward.displacement(x, y, z)[0], rtol=1e-9
    )


@pytest.mark.slow
def test_prescribed_hertz_pressure_reproduces_the_contact():
    s = sliding(name="stiff")
    given = solve_prescribed(
        pressure=s.pressure,
        load_radius=s.contact_radius,
        coatings=CASES["stiff"],
        substrate=(E, NU),
        friction=F,
        estimate_uncertainty=False,
    )
    x, z = np.linspace(-1.5, 1.5, 31) * A_H, 0.45 * A_H
    assert np.abs(given.stress(x, 0.1 * A_H, z) - s.stress(x, 0.1 * A_H, z)).max() < 5e-5 * s.peak_pressure
    assert given.approach == pytest.approx(s.approach, rel=2e-6)
