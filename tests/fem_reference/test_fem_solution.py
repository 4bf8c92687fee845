"""A solution as a plain object: pickled, sliding with another friction, the parts of its uncertainty."""

import pickle
from dataclasses import asdict, replace
from functools import lru_cache

import numpy as np
import pytest

from fem_reference import solve, solve_prescribed
from fem_reference.companion_points import samples
from fem_reference.contact.fixed_radius import solve_at_radius
from fem_reference.contact.levels import COMPANION, companion_grading, final_grading
from fem_reference.elasticity.state import ElasticState
from fem_reference.estimate import SAFETY, contact_estimates, estimates
from verification.problem.point_answers import Points

R, W, E, NU = 10e-3, 20.0, 210e9, 0.3
A = 8e-5
COATED = ((2 * E, 0.25, 0.5 * A),)
X, Y, Z = (
    A * np.array(v) for v in ([0.0, -1.2, 0.3, 0.4, 0.0], [0.0, 0.2, 0.5, 0.0, 0.0], [0, 0, 0.2, 0.5, 1.1])
)
KINDS = ("sphere", "uniform pressure", "pressure as a function")


def parabola(r):
    return 1e9 * (1 - (r / A) ** 2)


@lru_cache
def solved(kind, friction=0.0, **keywords):
    common = {"coatings": COATED, "substrate": (E, NU), "friction": friction, "size": 0.5, "order": 2}
    if kind == "sphere":
        return solve(radius=R, load=W, **common, **keywords)
    pressure = 1e9 if kind == "uniform pressure" else parabola
    return solve_prescribed(pressure=pressure, load_radius=A, **common, **keywords)


def assert_same(one, other):
    """Equal to the last bit in all but the time."""
    for name in ("contact_radius", "approach", "peak_pressure", "stiffness"):
        assert one.sample(None, name) == other.sample(None, name), name
    assert one.uncertainty == other.uncertainty
    assert one.diagnostics.history == other.diagnostics.history
    for quantity in ("pressure", "stress", "displacement"):
        both = (solution.sample(Points(X, Y, Z), quantity) for solution in (one, other))
        for mine, theirs in zip(*both, strict=True):
            np.testing.assert_array_equal(mine, theirs)


@pytest.mark.parametrize("friction", [0.0, 0.25])
@pytest.mark.parametrize("kind", KINDS)
def test_a_pickled_solution_has_the_same_values(kind, friction):
    s = solved(kind, friction)
    data = pickle.dumps(s)
    assert_same(pickle.loads(data), s)
    # matrices and search trees are computed again on use, in place of being stored
    assert len(pickle.dumps(s)) < 2 * len(data)
    assert_same(pickle.loads(pickle.dumps(s)), s)


@pytest.mark.parametrize("kind", KINDS)
def test_another_friction_gives_the_solution_of_that_friction(kind):
    rest, sliding = solved(kind), solved(kind, 0.25)
    assert_same(rest.with_friction(0.25), sliding)
    assert_same(solved(kind, -0.4).with_friction(0.25), sliding)
    assert_same(sliding.with_friction(0.0), rest)
    assert_same(pickle.loads(pickle.dumps(rest)).with_friction(0.25), sliding)
    assert sliding.with_friction(0.0).state.tangential is None
    assert rest.with_friction(0.25).diagnostics.seconds > rest.diagnostics.seconds


def test_uncertainty_of_the_displacement_is_that_of_its_direction():
    def U(*place):
        return solved("sphere", 0.25).sample(Points(*place), "displacement").uncertainty

    r = 0.5 * solved("sphere").contact_radius
    along, across = U(np.array([r]), np.zeros(1), np.zeros(1)), U(np.zeros(1), np.array([r]), np.zeros(1))
    # beside the axis of sliding the circumferential displacement is that along x
    assert 0.1 * along[0] < across[0] < 10 * along[0]
    assert U(np.array([r]), np.array([r]), np.zeros(1))[0] > 0.7 * across[0]


def test_stress_of_the_far_boundary_bounds_that_of_any_strain_of_its_size():
    state = solved("sphere").state
    missing, stress, _ = state.truncation(0)
    rng = np.random.default_rng(1)
    for modulus, nu in state.solid.materials:
        # Hooke: sigma = E/(1 + nu) (e + nu/(1 - 2 nu) tr e), of principal strains up to one
        e = np.vstack([np.ones(3), rng.uniform(-1, 1, (200, 3))])
        sigma = modulus / (1 + nu) * (e + nu / (1 - 2 * nu) * e.sum(axis=1, keepdims=True))
        assert np.abs(sigma).max() * missing / state.mesh.far <= stress * (1 + 1e-12)


def test_another_friction_needs_no_estimate_and_has_to_be_finite():
    rest = solved("sphere", estimate_uncertainty=False)
    sliding = solved("sphere", 0.25, estimate_uncertainty=False)
    np.testing.assert_array_equal(rest.with_friction(0.25).stress(X, Y, Z), sliding.stress(X, Y, Z))
    with pytest.raises(ValueError, match="friction = nan"):
        rest.with_friction(float("nan"))
    assert rest.sample(Points(X, Y, Z), "stress").uncertainty is None


# What each cause adds to the uncertainty, where the solutions are compared


@lru_cache
def contact():
    """The contact on the final mesh, solved alone."""
    state = solved("sphere").state
    return solve_at_radius(state.solid, state.discretisation)


def budget(found):
    return {(quantity, origin): value for quantity, origin, value in found.scalars.budget}


def estimated(companion, residual=0.0):
    """Budget and uncertainty of the stiffness if ``companion`` were the contact on the coarser mesh."""
    one, s = replace(contact(), residual=residual), solved("sphere")
    states = (ElasticState.of_contact(s.state.solid, one),)
    (found,), stiffness = contact_estimates(one, companion, states, s.units, 0.5)
    return budget(found), stiffness


def test_a_companion_that_agrees_leaves_no_error_of_element_size():
    one = contact()
    # what a companion misses of the load is no error of its mesh
    missing = replace(one, load=1.001 * one.load, approach=one.approach + 1e-3 * one.load / one.stiffness)
    (same, least), (other, _) = estimated(one), estimated(missing)
    assert same["contact_radius", "element size"] < 1e-9 * same["contact_radius", "edge size"]
    assert same["approach", "element size"] < 1e-12 * solved("sphere").approach
    assert other["approach", "element size"] < 1e-12 * solved("sphere").approach
    # larger or smaller alike
    for name in ("approach", "stiffness"):
        up, down = (estimated(replace(one, **{name: getattr(one, name) * f})) for f in (1.001, 0.999))
        larger, smaller = (row["approach", "element size"] for row, _ in (up, down))
        assert larger == pytest.approx(smaller, rel=1e-6, abs=1e-12 * solved("sphere").approach)
        assert up[1] == pytest.approx(down[1])
        assert max(larger, up[1] - least) > 0


def test_a_change_from_the_companion_counts_by_roaches_factor_more_on_coarse_triangles():
    one, s = contact(), solved("sphere")
    _, least = estimated(one)
    # Roache (1994) eq. 9 for two meshes of ratio 1.4 and order 2, times 0.5 / 0.18 at size 0.5
    factor, change = 3 / (1.4**2 - 1) * 0.5 / 0.18, 1e-3
    softer, _ = estimated(replace(one, approach=one.approach * (1 + change)))
    # 1.7: what random films needed
    expected = 1.7 * factor * change * s.approach
    assert softer["approach", "element size"] == pytest.approx(expected, rel=1e-6, abs=0)
    # with the load the radius at one load: W ~ a^growth
    larger, _ = estimated(replace(one, load=one.load * (1 + change) ** one.growth))
    radius = factor * change / (1 + change) * s.contact_radius
    assert larger["contact_radius", "element size"] == pytest.approx(radius, rel=1e-6, abs=0)
    _, stiffer = estimated(replace(one, stiffness=one.stiffness * (1 + change)))
    assert stiffer - least == pytest.approx(factor * change * s.stiffness, rel=1e-6, abs=0)


def test_forces_out_of_balance_count_as_load():
    one, s = contact(), solved("sphere")
    (none, least), (some, stiffness) = estimated(one), estimated(one, residual=1e-3)
    # W ~ a^2 at least; p ~ W^(1/3)
    shares = {"contact_radius": 1 / 2, "approach": 1, "peak_pressure": 1 / 3}
    for name, share in shares.items():
        more = some[name, "load balance"] - none[name, "load balance"]
        assert more == pytest.approx(1e-3 * share * getattr(s, name), rel=1e-3, abs=0)
    unit = s.units.load / s.units.displacement
    assert stiffness - least == pytest.approx(1e-3 * one.stiffness * unit, rel=1e-9, abs=0)


def test_each_cause_adds_to_the_uncertainty():
    s = solved("sphere")
    found, unit, state = s.estimates[0], s.units, s.state

    def of(load_residual=0.0, edge=0.0, changes=(0.0, 0.0)):
        return estimates((state,), (found.companion,), unit, changes, load_residual, edge, 0.5)[0]

    none, load, edge, size = of(), of(load_residual=1e-3), of(edge=1e-3), of(changes=(1e-3, 1e-3))
    for one in (none, load, edge, size):
        rows, scalars = budget(one), one.scalars
        for name in ("contact_radius", "approach", "peak_pressure"):
            total = sum(value for (quantity, _), value in rows.items() if quantity == name)
            assert getattr(scalars, name) == pytest.approx(total, abs=0)
        # the same causes in the estimates of pressure and stress
        radius_error = pytest.approx(scalars.contact_radius / unit.length, rel=1e-14, abs=0)
        assert one.pressure.radius_error == one.normal.radius_error == radius_error
        far_and_load = rows["peak_pressure", "outer boundary"] + rows["peak_pressure", "load balance"]
        assert one.pressure.everywhere * unit.pressure == pytest.approx(far_and_load)
    assert load.normal.relative - none.normal.relative == pytest.approx(1.5e-3)
    assert edge.normal.radius_error - none.normal.radius_error == pytest.approx(SAFETY * 1e-3)
    assert size.normal.radius_error > none.normal.radius_error
    assert size.pollution > none.pollution == 0
    assert size.normal.everywhere - none.normal.everywhere == pytest.approx(size.pollution)


def test_each_part_of_the_estimate_adds_to_that_of_stress_and_displacement():
    s = solved("sphere")
    found, a = s.estimates[0].normal, s.state.mesh.contact_radius
    r, z = a * np.array([0.0, 0.5, 1.0, 1.02, 0.3, 2.0]), a * np.array([0.0, 0.2, 0.0, 0.01, 0.9, 1.5])
    at = s.state.discretisation.locator.points(r, z, np.searchsorted(s.state.mesh.depths, z))
    u, stress = found.field(at)
    before, moved = found(at), found.displacement(at)
    more = replace(found, far=found.far + 1, everywhere=found.everywhere + 2)
    np.testing.assert_allclose(more.displacement(at), moved + 1)
    np.testing.assert_allclose(more(at), before + 2)
    more = replace(found, relative=found.relative + 1)
    np.testing.assert_allclose(more.displacement(at), moved + np.abs(u))
    assert np.all((more(at) > before)[stress != 0])
    # a displaced edge counts beside the edge alone
    displaced, near = replace(found, radius_error=1e-2 * a)._displaced(at), np.hypot(r - a, z) < 0.3 * a
    assert np.all(displaced[:, ~near] == 0)
    assert np.all(displaced[0, near] > 0)


@pytest.mark.parametrize("size", [0.08, 0.12, 0.18, 0.27, 0.5])
def test_the_companion_is_coarser_everywhere_by_one_factor(size):
    final, companion = asdict(final_grading(size)), asdict(companion_grading(size))
    assert final.pop("rows") / companion.pop("rows") == pytest.approx(COMPANION)
    assert companion.pop("edge_size") > final.pop("edge_size")
    assert companion.pop("surface") == final.pop("surface") == 0.0  # for contacts that are no discs, as are
    assert companion.pop("edges") == final.pop("edges") == ()
    for name in final:
        assert companion[name] / final[name] == pytest.approx(COMPANION), name


def test_estimate_is_at_least_the_change_from_the_companion():
    # at some places the final mesh is the worse one, and all the change is its error
    found = solved("sphere").estimates[0].normal
    final, companion = found.points.triangles
    change = np.abs(found.field(final)[1] - found.companion(companion)[1])
    assert np.all(found._error((final, companion))[:6] >= change)
    # a vertex of a plane has the stresses of two cells, of which samples next to it see either
    vertices = found.points.final.contact_vertices
    cells = samples(vertices).reshape(vertices.size - 1, -1)
    assert np.all((vertices[:-1, None] < cells) & (cells < vertices[1:, None]))
    np.testing.assert_allclose(cells[:, [0, -1]].T, [vertices[:-1], vertices[1:]], rtol=0, atol=1e-6)


def test_solutions_are_compared_inside_the_triangles():
    points, mesh = solved("sphere").estimates[0].normal.points, solved("sphere").state.mesh
    final, companion = points.triangles
    assert final.z.size == 7 * mesh.layer.size
    assert final.z.min() > 0
    assert not np.isin(final.z, mesh.depths).any()
    assert np.min([*final.X, 1 - final.X.sum(axis=0)]) > -1e-9
    np.testing.assert_array_equal(final.z, companion.z)
    vertices = points.final.contact_vertices
    assert (vertices[0], vertices[-1]) == (0, mesh.contact_radius)
    assert np.all(np.diff(vertices) > 0)
