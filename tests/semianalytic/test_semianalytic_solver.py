"""Invariants and limits that a solution must obey, whatever the coating."""

import pickle
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

import semianalytic
from semianalytic.inputs import undeformed_gap
from semianalytic.patches import nested
from semianalytic.patches.level import Level
from verification.problem.point_answers import EDGE, Points
from verification.sources.references import integral_equation

R, W = 10e-3, 20.0
E, NU = 210e9, 0.3
E_STAR = E / (1 - NU**2)
A_H = (0.75 * W * R / E_STAR) ** (1 / 3)
P_H = 1.5 * W / (np.pi * A_H**2)
STEEL = (E, NU)
STIFF = ((4 * E, 0.25, 0.5 * A_H),)


def solve(coatings=(), *, radius=R, load: float | None = W, substrate=STEEL, patches=129, **options):
    """On these patches, without its uncertainty, unless ``accuracy`` or ``estimate_uncertainty`` is given."""
    options = {"estimate_uncertainty": False, "accuracy": None} | options
    return semianalytic.solve(
        radius=radius, load=load, coatings=coatings, substrate=substrate, patches=patches, **options
    )


@pytest.fixture(scope="module")
def coated():
    return solve(STIFF)


@pytest.fixture(scope="module")
def sliding():
    return solve(STIFF, friction=0.25)


@pytest.mark.parametrize("coatings", [(), ((E, NU, 0.3 * A_H),), ((E, NU, 0.1 * A_H), (E, NU, A_H))])
def test_equal_moduli_give_hertz(coatings):
    s = solve(coatings)
    # of order 3/2 or more in the patches, 57 to the radius; those at the edge know the radius least
    assert s.contact_radius == pytest.approx(A_H, rel=5e-6)
    assert s.approach == pytest.approx(A_H**2 / R, rel=1e-6, abs=0)
    assert s.peak_pressure == pytest.approx(P_H, rel=1e-6)
    assert s.stiffness == pytest.approx(1.5 * W * R / A_H**2, rel=1e-6)
    r = np.linspace(0, 0.97 * A_H, 50)
    np.testing.assert_allclose(s.pressure(r), P_H * np.sqrt(1 - (r / A_H) ** 2), atol=2e-5 * P_H)


def test_without_edge_correction_hertz_is_of_first_order():
    s = solve(edge_correction=False)
    assert s.peak_pressure == pytest.approx(P_H, rel=1e-4)
    # counted patches: one of 58 to the radius
    assert s.contact_radius == pytest.approx(A_H, rel=1 / 58)


def test_the_error_of_a_staircase_falls_beyond_the_grid_too():
    s = solve(edge_correction=False, estimate_uncertainty=True)
    at = np.array([s.nodes[-1], 1.5 * s.nodes[-1], 2.0 * s.nodes[-1]])
    U = s.sample(Points(at, 0.0, 0.0), "stress").uncertainty[0, 0]
    assert (U[1:] <= 1.01 * U[0]).all()
    assert (
        s.sample(Points(at), "pressure").uncertainty[1:] <= s.sample(Points(at[:1]), "pressure").uncertainty
    ).all()


def test_the_displacement_of_patches_alone_is_within_its_uncertainty_beside_the_staircase():
    s, exact = solve(edge_correction=False, estimate_uncertainty=True), solve()
    x = np.linspace(0, 1.2, 40) * A_H
    u, U = s.sample(Points(x, 0.1 * A_H, 0 * x), "displacement")
    assert (np.abs(u - exact.displacement(x, 0.1 * A_H, 0 * x)) <= U).all()


@pytest.mark.slow
def test_a_pressure_whose_change_does_not_fall_is_refined():
    # a stiff film: the pressure beside the edge changes by 2.6e-5 from grid to grid, and is 1.6e-4 off
    film = ((70e9, 0.22, 2.69693e-6),)
    s, finer = (
        solve(film, radius=1e-3, load=0.1, substrate=(3.3e9, 0.37), patches=n, accuracy=1e-5,
              estimate_uncertainty=True)
        for n in (257, 987)
    )  # fmt: skip
    share = 1 - np.geomspace(1e-4, 0.2, 60)
    error = s.pressure(share * s.contact_radius) - finer.pressure(share * finer.contact_radius)
    assert (
        np.abs(error) <= s.sample(Points(share * s.contact_radius, frame=EDGE), "pressure").uncertainty
    ).all()


@pytest.mark.slow
def test_a_grid_that_first_resolves_the_edge_is_followed_by_another():
    # a soft film on a stiff one on a soft one: 1381 patches are the first with polynomials enough
    layers = ((4.975e9, 0.3564, 6.015e-6), (158.2e9, 0.2598, 33.92e-6), (0.9579e9, 0.08933, 34.95e-6))
    s = solve(layers, radius=46.44e-3, load=7.311, substrate=(8.812e9, 0.2422), patches=257, accuracy=1e-5,
              estimate_uncertainty=True)  # fmt: skip
    assert s.uncertainty.contact_radius < 1e-5 * s.contact_radius


def test_scaling_with_load_and_radius(coated):
    # lengths times s, load times s^2: the same pressure, similar figures
    s = 3.7
    coatings = tuple((E1, nu1, s * h) for E1, nu1, h in STIFF)
    similar = solve(coatings, radius=s * R, load=s**2 * W)
    assert similar.contact_radius == pytest.approx(s * coated.contact_radius, rel=1e-9, abs=0)
    assert similar.approach == pytest.approx(s * coated.approach, rel=1e-9, abs=0)
    assert similar.peak_pressure == pytest.approx(coated.peak_pressure, rel=1e-9)
    # moduli and load times c: the same displacements
    c = 1e-3
    soft = solve(tuple((c * E1, nu1, h) for E1, nu1, h in STIFF), load=c * W, substrate=(c * E, NU))
    assert soft.approach == pytest.approx(coated.approach, rel=1e-9, abs=0)


def test_stress_of_a_plane_is_the_stress_at_its_points(sliding):
    h = STIFF[0][2]
    some = slice(None, None, 16)
    x = sliding.nodes[some]
    for z, layer in ((0.4 * h, None), (h, 1), (3 * h, None)):
        plane = sliding.stress_plane(z, layer)
        at_points = sliding.stress(x[:, None], x[None, :], z, layer)
        # whole patches against halved ones above 8 patches, interpolation between lattice sites below
        np.testing.assert_allclose(plane[..., some, some], at_points, atol=2e-4 * P_H)


def test_displacement_of_a_plane_is_the_displacement_at_its_points(sliding):
    some = slice(None, None, 16)
    x = sliding.nodes[some]
    for z in (0.0, 0.4 * STIFF[0][2], 3 * STIFF[0][2]):
        at_points = sliding.displacement(x[:, None], x[None, :], z)
        # whole patches against the pressure between them, largest at the surface
        plane = sliding.displacement_plane(z)
        np.testing.assert_allclose(plane[:, some, some], at_points, rtol=0, atol=2e-5 * sliding.approach)


def test_sliding_stress_is_odd_about_the_frictionless(coated, sliding):
    x, z = np.linspace(0.1, 3, 7) * A_H, 0.4 * A_H
    ahead, behind, still = sliding.stress(x, 0.0, z), sliding.stress(-x, 0.0, z), coated.stress(x, 0.0, z)
    # the part due to q is odd in x for the normal stresses
    np.testing.assert_allclose((ahead + behind)[0, 0] / 2, still[0, 0], rtol=0, atol=1e-7 * P_H)
    assert np.all(behind[0, 0] > ahead[0, 0])  # tension trails


def test_a_bare_solid_has_no_error_of_conversion():
    s = semianalytic.solve_prescribed(
        pressure=1e9, load_radius=1e-4, coatings=(), substrate=STEEL, patches=65
    )
    # its coefficients are closed forms, whatever the points of the Hankel transform
    assert s.uncertainty is not None
    assert [value for _, parameter, value in s.uncertainty.budget if parameter == "conversion"] == [0, 0, 0]


def test_prescribed_pressure_of_a_contact_gives_its_fields(coated):
    again = semianalytic.solve_prescribed(
        pressure=coated.pressure,
        load_radius=coated.contact_radius,
        coatings=STIFF,
        substrate=STEEL,
        patches=129,
    )
    assert again.approach == pytest.approx(coated.approach, rel=1e-5)
    x = np.linspace(-2, 2, 9) * A_H
    np.testing.assert_allclose(
        again.stress(x, 0.0, 0.3 * A_H), coated.stress(x, 0.0, 0.3 * A_H), atol=3e-5 * P_H
    )


def test_approach_control_inverts_load_control(coated):
    s = solve(STIFF, load=None, approach=coated.approach)
    assert s.diagnostics.load == pytest.approx(W, rel=1e-7)
    # the patches of another size by the guess: both radii err by 3e-6
    assert s.contact_radius == pytest.approx(coated.contact_radius, rel=1e-5)


def test_approach_control_finds_a_contact_far_narrower_than_the_sphere_at_that_depth():
    """A film of 1000 times its substrate's modulus bends: the first guess is the radius sqrt(R delta)."""
    film = ((1000 * E, NU, 0.1 * A_H),)
    by_load = solve(film, patches=65)
    assert by_load.contact_radius < 0.5 * (R * by_load.approach) ** 0.5
    by_approach = solve(film, load=None, approach=by_load.approach, patches=65)
    # on patches of another size, a tenth of the film's thickness and more
    assert by_approach.diagnostics.load == pytest.approx(W, rel=1e-3)


def test_the_first_square_is_forgotten():
    """An ellipsoid whose radii are far below the one that the first square is chosen by."""
    given = {"indenter": ("ellipsoid", (1.2e-3, 1e-3)), "patches": 65}
    wide, near = solve(radius=1.0, **given), solve(radius=1.1e-3, **given)
    assert wide.peak_pressure == pytest.approx(near.peak_pressure, rel=1e-4)
    assert wide.approach == pytest.approx(near.approach, rel=1e-4)


def test_uncertainty_brackets_the_error_and_not_by_orders():
    s = solve(edge_correction=False, estimate_uncertainty=True)
    u = s.uncertainty
    assert u is not None
    for name, exact in (("approach", A_H**2 / R), ("peak_pressure", P_H)):
        error = abs(getattr(s, name) - exact)
        assert error <= getattr(u, name) <= 100 * error
        total = sum(v for quantity, _, v in u.budget if quantity == name)
        assert getattr(u, name) == pytest.approx(total, rel=1e-14, abs=0)
    parameters = {"patch size", "edge", "conversion", "domain", "iteration"}
    assert {parameter for _, parameter, _ in u.budget} == parameters
    x = s.surface_nodes
    error = np.abs(s.pressure(x) - P_H * np.sqrt(np.maximum(1 - (x / A_H) ** 2, 0)))
    assert np.all(error <= s.sample(Points(x), "pressure").uncertainty)


def test_uncertainty_of_the_default_brackets_hertz():
    s = solve(estimate_uncertainty=True)
    u = s.uncertainty
    assert u is not None
    assert abs(s.contact_radius - A_H) <= u.contact_radius < 1e-3 * A_H
    assert abs(s.peak_pressure - P_H) <= u.peak_pressure < 1e-4 * P_H
    z = np.linspace(0, 3, 13) * A_H
    zz = s.stress(0.0, 0.0, z)[2, 2] + P_H / (1 + (z / A_H) ** 2)
    assert np.all(np.abs(zz) <= s.sample(Points(0.0, 0.0, z), "stress").uncertainty[2, 2])


@pytest.mark.parametrize(("ratio", "h"), [(4.0, 0.05), (0.25, 0.2), (10.0, 0.2)])
def test_a_thin_film_on_few_patches_states_how_little_is_resolved(ratio, h):
    coatings = ((ratio * E, 0.25, h * A_H),)
    exact = integral_equation.solve(radius=R, load=W, coatings=coatings, substrate=STEEL)
    s = solve(coatings, patches=33, estimate_uncertainty=True)
    for name in ("contact_radius", "approach", "peak_pressure"):
        assert abs(getattr(s, name) - getattr(exact, name)) <= getattr(s.uncertainty, name), name


def test_a_displacement_is_as_uncertain_as_its_shape_is_out_of_balance(monkeypatch):
    """On films thinner than a patch the shape misses the edge, and with it a share of the load."""
    film = ((4 * E, 0.4, 0.03 * A_H),)
    s = solve(film, patches=33)
    exact = integral_equation.solve(
        radius=R, load=W, coatings=film, substrate=STEEL, estimate_uncertainty=False
    )
    off = s.displacement(20 * A_H, 0.0, 0.0)[2] / exact.displacement(20 * A_H, 0.0, 0.0)[2] - 1
    assert abs(off) == pytest.approx(s._level.unbalanced, rel=1e-3)
    assert s._level.unbalanced > 1e-4

    s, far = solve(patches=65, estimate_uncertainty=True), Points(5 * A_H)
    monkeypatch.setattr(Level, "unbalanced", 0.0)
    stated = s.sample(far, "displacement").uncertainty
    monkeypatch.setattr(Level, "unbalanced", 0.01)
    more = s.sample(far, "displacement").uncertainty - stated
    np.testing.assert_allclose(more, 0.01 * s.approach)


def test_a_displacement_beside_the_edge_is_as_uncertain_as_the_place_of_the_edge():
    s = solve(patches=65, estimate_uncertainty=True)
    a, d = s.contact_radius, s.diagnostics.patch_size
    u = s.displacement(a + np.array([-1e-3, 1e-3]) * a, 0.0, 0.0)[2]
    slope = abs(u[1] - u[0]) / (2e-3 * a)
    beside, inside, far = s.sample(Points(np.array([a, a - 8 * d, 3 * a])), "displacement").uncertainty[2]
    assert beside - far > slope * s.uncertainty.contact_radius
    assert inside - far < slope * s.uncertainty.contact_radius


def test_an_uncertainty_that_is_not_estimated_is_none():
    s = solve(patches=65)
    assert s.uncertainty is None
    for quantity in ("pressure", "stress", "displacement", "approach", "stiffness"):
        assert s.sample(Points(0.0), quantity).uncertainty is None, quantity


def test_the_plain_conversion_is_worse_and_says_so():
    best = solve(STIFF, edge_correction=False)
    other = solve(STIFF, edge_correction=False, conversion="plain", estimate_uncertainty=True)
    assert other.uncertainty is not None
    error = abs(other.approach - best.approach)
    assert error > 1e-4 * best.approach
    rows = {row[1]: row[2] for row in other.uncertainty.budget if row[0] == "approach"}
    # estimated on half the patches, from the better conversion
    assert rows["conversion"] == pytest.approx(error, rel=0.5, abs=0)


def test_surface_nodes_cover_twice_the_contact(coated):
    x = coated.surface_nodes
    assert np.all(np.diff(x) > 0)
    assert x[0] <= -2 * coated.contact_radius
    assert x[-1] >= 2 * coated.contact_radius
    c = len(x) // 2
    assert x[c] == 0
    inside = np.abs(x) <= coated.nodes[-1]
    middle = len(coated.nodes) // 2
    # the shape averages a ripple of some 1e-4 of the patches
    np.testing.assert_allclose(coated.pressure(x[inside]), coated.patch_pressure[:, middle], atol=3e-4 * P_H)


# Other methods, other coefficients


BALL = (600e9, 0.2, ((E, NU, 0.2 * A_H),))
CASES = {
    "stiff": {"coatings": STIFF},
    "soft": {"coatings": ((0.25 * E, 0.4, 0.2 * A_H),)},
    "two coatings": {"coatings": ((4 * E, 0.2, 0.1 * A_H), (0.5 * E, 0.3, 0.5 * A_H))},
    "coated ball": {"coatings": STIFF, "ball": BALL},
    "thin and stiff": {"coatings": ((10 * E, NU, 0.05 * A_H),)},
}


def test_a_contact_that_reaches_the_rim_of_the_first_grid_is_found_on_a_wider_one():
    """On a film of 1000 times its substrate's modulus, which bends: Hertz on the film alone is smaller."""
    given = {"radius": R, "load": W, "substrate": STEEL, "coatings": ((1000 * E, NU, 0.1 * A_H),)}
    exact = integral_equation.solve(**given, estimate_uncertainty=False)
    s = semianalytic.solve(**given, patches=65, estimate_uncertainty=False)
    assert exact.contact_radius > 3 * A_H / 10
    assert s.contact_radius == pytest.approx(exact.contact_radius, rel=1e-3)


@pytest.mark.parametrize(
    "name", [pytest.param(one, marks=[pytest.mark.slow] * (one == "thin and stiff")) for one in CASES]
)
def test_errors_against_the_integral_equation_are_within_the_uncertainty(name):
    given = {"radius": R, "load": W, "substrate": STEEL, "friction": 0.25} | CASES[name]
    exact = integral_equation.solve(**given, estimate_uncertainty=False)
    s = semianalytic.solve(**given, patches=129, accuracy=None)
    assert s.uncertainty is not None
    for quantity in ("contact_radius", "approach", "peak_pressure"):
        error = abs(getattr(s, quantity) - getattr(exact, quantity))
        assert error <= getattr(s.uncertainty, quantity) < 1e-3 * getattr(exact, quantity), quantity
    a, h = exact.contact_radius, CASES[name]["coatings"][0][2]
    x = np.array([-2, -1.05, -0.9, -0.4, 0, 0.5, 0.95, 1.3]) * a
    assert np.all(np.abs(s.pressure(x) - exact.pressure(x)) <= s.sample(Points(x), "pressure").uncertainty)
    for body in ("flat", "ball") if "ball" in given else ("flat",):
        for z, layer in ((0.05 * h, 0), (h, 1), (a, None)):
            points = Points(x, 0.1 * a, z, layer if body == "flat" else None, body)
            (sigma, U), (true, _) = (one.sample(points, "stress") for one in (s, exact))
            assert np.all(np.abs(sigma - true) <= U), (body, z)


def test_edge_on_a_film_that_no_patch_sees_is_as_uncertain_as_it_is_wrong():
    """It is off alike on all three grids, whose differences do not show it."""
    given = {"radius": R, "load": W, "substrate": STEEL, "coatings": ((0.9 * E, NU, 0.003 * A_H),)}
    exact = integral_equation.solve(**given, estimate_uncertainty=False)
    s = semianalytic.solve(**given, patches=129, accuracy=None)
    error = abs(s.contact_radius - exact.contact_radius)
    assert error <= s.uncertainty.contact_radius < 3 * error
    rows = {row[:2]: row[2] for row in s.uncertainty.budget}
    assert rows["contact_radius", "patch size"] < error / 3


def test_patches_are_refined_to_the_accuracy_or_as_far_as_allowed(monkeypatch):
    given = {"patches": 65, "estimate_uncertainty": True}
    rough, fine = solve(STIFF, **given, accuracy=None), solve(STIFF, **given, accuracy=2e-5)
    names = ("contact_radius", "approach", "peak_pressure")

    def reached(s):
        return max(getattr(s.uncertainty, name) / getattr(s, name) for name in names)

    assert (rough.diagnostics.patches_per_side, reached(rough) > 2e-5) == (65, True)
    assert reached(fine) <= 2e-5
    assert fine.diagnostics.patches_per_side > 65
    for name in names:
        error = abs(getattr(rough, name) - getattr(fine, name))
        assert error <= getattr(rough.uncertainty, name) + getattr(fine.uncertainty, name)
    monkeypatch.setattr("semianalytic.numbers.LARGEST_GRID", 100)
    stopped = solve(STIFF, **given, accuracy=1e-9)
    assert stopped.diagnostics.patches_per_side <= 100
    assert reached(stopped) > 1e-9


def test_where_a_finer_grid_does_not_converge_the_last_one_states_what_it_reached(monkeypatch):
    given, solve_on = {"patches": 65, "estimate_uncertainty": True}, nested.solve_on
    rough = solve(STIFF, **given, accuracy=None)

    def short(grid, *others):
        if grid.n > 65:
            raise semianalytic.NotConverged("stopped short")
        return solve_on(grid, *others)

    monkeypatch.setattr(nested, "solve_on", short)
    stopped = solve(STIFF, **given, accuracy=1e-9)
    assert (stopped.contact_radius, stopped.uncertainty) == (rough.contact_radius, rough.uncertainty)


def test_a_smooth_edge_on_the_finest_grid_alone_has_an_uncertainty():
    """Contact of 11 patches to the radius; coarser ones do not resolve its edge."""
    s = indent(lambda x, y: (x**2 + y**2) / (2 * R), 3 * A_H, estimate_uncertainty=True, patches=33)
    x = np.array([0.0, 0.5, 0.8]) * A_H
    assert np.all(
        np.abs(s.pressure(x) - P_H * np.sqrt(1 - (x / A_H) ** 2))
        <= s.sample(Points(x), "pressure").uncertainty
    )
    zz = s.stress(0.0, 0.0, x)[2, 2] + P_H / (1 + (x / A_H) ** 2)
    assert np.all(np.abs(zz) <= s.sample(Points(0.0, 0.0, x), "stress").uncertainty[2, 2])


# Solutions as plain records


@cache
def small(friction=0.25):
    return solve(STIFF, friction=friction, patches=65, estimate_uncertainty=True)


def prescribed(pressure, **options):
    return semianalytic.solve_prescribed(
        pressure=pressure, load_radius=A_H, coatings=STIFF, substrate=STEEL, patches=65, **options
    )


def ellipsoid(x, y):
    return x**2 / (2 * R) + y**2 / (6 * R)


def answers(solution):
    """Everything a solution answers, its coarser companions included, as a flat list."""
    x, z = np.linspace(-2, 2, 9) * A_H, 0.3 * A_H
    found = [solution.contact_radius, solution.approach, solution.peak_pressure, solution.diagnostics]
    found += [solution.nodes, solution.surface_nodes, solution.patch_pressure, solution.pressure(x, z)]
    found += [solution.stress(x, 0.0, 0.0), solution.stress_plane(z), solution.displacement_plane(z)]
    found += [solution.displacement(x, 0.1 * A_H, z), solution.stress(x, 0.0, STIFF[0][2], layer=0)]
    if solution.uncertainty is not None:
        found += [solution.uncertainty, solution.sample(Points(x), "pressure").uncertainty]
        found += solution.sample(Points(x, 0.0, z), "stress")
    return found if solution.coarser is None else found + answers(solution.coarser)


def assert_same_bits(first, second):
    for one, other in zip(answers(first), answers(second), strict=True):
        np.testing.assert_array_equal(one, other)


@pytest.mark.parametrize(
    "solved",
    [
        small,
        pytest.param(
            lambda: indent(ellipsoid, 2 * A_H, friction=0.25, estimate_uncertainty=True),
            marks=pytest.mark.slow,
        ),
        lambda: prescribed(1e9, friction=0.25),
        lambda: prescribed(np.cos, estimate_uncertainty=False),
    ],
    ids=["sphere", "ellipsoid", "uniform pressure", "pressure of r"],
)
def test_a_pickled_solution_gives_the_same_bits(solved):
    solution = solved()
    assert_same_bits(pickle.loads(pickle.dumps(solution)), solution)


@pytest.mark.parametrize("friction", [0.0, -0.3])
def test_another_friction_needs_no_other_solve(friction):
    sliding, direct = small(), small(friction)
    other = sliding.with_friction(friction)
    elapsed = {"seconds": other.diagnostics.seconds}  # the only field that may differ
    assert_same_bits(other, replace(direct, diagnostics=replace(direct.diagnostics, **elapsed)))
    assert_same_bits(other.with_friction(0.25), sliding)
    with pytest.raises(ValueError, match="friction = nan"):
        sliding.with_friction(float("nan"))


# Indenters other than the sphere


def indent(profile, half_width, load: float | None = W, **options):
    options = {"estimate_uncertainty": False} | options
    return semianalytic.indent(
        profile=profile,
        half_width=half_width,
        load=load,
        coatings=(),
        substrate=STEEL,
        **{"patches": 129} | options,
    )


def test_a_sphere_given_as_a_profile_is_the_sphere():
    s = indent(lambda x, y: (x**2 + y**2) / (2 * R), 1.2 * A_H)
    assert s.approach == pytest.approx(A_H**2 / R, rel=2e-5)
    assert s.peak_pressure == pytest.approx(P_H, rel=5e-5)


@pytest.fixture(scope="module")
def wide():
    """A contact of patches alone, on a square of six contact radii a side."""
    return semianalytic.indent(
        profile=lambda x, y: (x**2 + y**2) / (2 * R),
        half_width=3 * A_H,
        load=W,
        coatings=(),
        substrate=STEEL,
        patches=33,
        edge_correction=False,
    )


def test_surface_nodes_of_a_wide_square_are_its_patches(wide):
    np.testing.assert_allclose(wide.surface_nodes, wide.nodes, rtol=0, atol=1e-12 * A_H)


def test_uncertainty_of_the_pressure_of_patches_covers_hertz_and_falls_beyond_the_contact(wide):
    x = wide.nodes
    U = wide.sample(Points(x), "pressure").uncertainty
    assert np.all(np.abs(wide.pressure(x) - P_H * np.sqrt(np.maximum(1 - (x / A_H) ** 2, 0))) <= U)
    beyond = U[x > A_H + 2 * wide.diagnostics.patch_size]
    assert np.all(np.diff(beyond) <= 0)
    assert beyond[-1] < 0.1 * U.max()


def test_stress_uncertainty_of_patches_covers_the_last_refinement(wide):
    x = np.array([0.6, 0.7, 0.8, 1.0]) * A_H
    sigma, U = wide.sample(Points(x, 0.0, 0.0), "stress")
    assert np.all(np.abs(sigma - wide.coarser.stress(x, 0.0, 0.0)) <= U)


def test_the_gap_of_a_sphere_lies_on_the_sphere_and_exceeds_that_of_its_parabola_by_its_next_term():
    r = np.array([0.0, 0.1, 0.6, 1.0]) * R
    gap, parabola = (undeformed_gap(name, R)(r) for name in ("sphere", "parabola"))
    np.testing.assert_allclose(r**2 + (R - gap) ** 2, R**2, rtol=1e-15)
    assert gap[1] - parabola[1] == pytest.approx(r[1] ** 4 / (8 * R**3), rel=1e-2)


def test_flat_punch_has_the_stiffness_of_its_radius():
    a = 1e-4
    edge = 1e-2 * a
    s = indent(lambda x, y: np.maximum(np.hypot(x, y) - a, 0) ** 2 / (2 * edge), 1.2 * a)
    # F = 2 E* a delta for a sharp punch; the round edge and half a patch of 54 widen it
    assert W / s.approach == pytest.approx(2 * E_STAR * a, rel=1.5e-2)


def test_contact_at_the_rim_of_the_square_is_refused():
    with pytest.raises(semianalytic.NotConverged, match="widen"):
        indent(lambda x, y: (x**2 + y**2) / (2 * R), 0.8 * A_H)
    with pytest.raises(semianalytic.NotConverged, match="upside down"):
        indent(lambda x, y: -(x**2 + y**2) / (2 * R), 2 * A_H)


# Refusals


def test_stopping_short_raises():
    with pytest.raises(semianalytic.NotConverged, match="max_iterations"):
        solve(max_iterations=1, edge_correction=False)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"load": None}, "approach"),
        ({"approach": 1e-6}, "approach"),
        ({"coatings": ((E, NU, 1e-6), (E, 0.6, 1e-6))}, "nu of coating 2 = 0.6"),
        ({"patches": 128}, "patches = 128"),
        ({"patches": 65.0}, "patches = 65.0"),
        ({"tolerance": "1e-8"}, "tolerance = '1e-8'"),
        ({"tolerance": 0.0}, "tolerance = 0"),
        ({"conversion": "magic"}, "conversion = 'magic'"),
    ],
)
def test_meaningless_input_is_refused_with_a_message(changes, message):
    with pytest.raises(ValueError, match=message):
        solve(**changes)


def test_numpy_numbers_are_accepted():
    plain = solve(coatings=((E, NU, 5e-5),), friction=0.0, patches=65)
    numbers = solve(
        coatings=((np.float64(E), np.float64(NU), np.float64(5e-5)),),
        friction=np.int64(0),
        patches=np.int64(65),
    )
    assert numbers.contact_radius == plain.contact_radius


def test_wrong_layers_and_points_above_the_surface_are_refused(coated):
    h = STIFF[0][2]
    with pytest.raises(ValueError, match="layer = 1"):
        coated.stress(0.0, 0.0, 0.5 * h, layer=1)
    with pytest.raises(ValueError, match="layer = 2"):
        coated.stress(0.0, 0.0, 0.5 * h, layer=2)
    with pytest.raises(ValueError, match="surface"):
        coated.stress(0.0, 0.0, -1e-9)
    with pytest.raises(ValueError, match="'flat', the ball is rigid"):
        coated.stress(0.0, 0.0, h, body="ball")
    # within rounding of the interface is on it
    on = coated.stress(0.0, 0.0, h * (1 + 1e-12), layer=0)
    np.testing.assert_allclose(on, coated.stress(0.0, 0.0, h, layer=0), rtol=1e-6, atol=1e-9 * P_H)


@pytest.mark.parametrize("pressure", [float("nan"), lambda r: r * np.nan])
def test_meaningless_prescribed_pressure_is_refused(pressure):
    with pytest.raises(ValueError, match="finite"):
        semianalytic.solve_prescribed(
            pressure=pressure, load_radius=1e-4, coatings=(), substrate=STEEL, patches=65
        )
