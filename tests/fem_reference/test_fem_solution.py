"""A solution as a plain object: pickled, sliding with another friction, the parts of its uncertainty."""

import pickle
from dataclasses import asdict, replace
from functools import lru_cache
from itertools import pairwise

import numpy as np
import pytest

from fem_reference import solve, solve_prescribed
from fem_reference.comparison_points import samples
from fem_reference.contact.fixed_radius import solve_at_radius
from fem_reference.contact.levels import family
from fem_reference.elasticity.state import ElasticState
from fem_reference.element_numbers import AXIS_SAFETY, COARSER, EDGE_COARSER, RINGS, SAFETY
from fem_reference.estimate import contact_estimates, estimates, from_changes
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


def test_stresses_that_are_one_on_the_axis_are_equally_uncertain():
    """As along and across there; the change of either between the meshes may vanish alone."""
    s = solved("sphere")
    for layer, depths in enumerate(([0.0, 0.1, 0.5], [0.5, 0.8, 1.7])):
        at = Points(np.zeros(3), np.zeros(3), A * np.array(depths), layer)
        stress, U = s.sample(at, "stress")
        np.testing.assert_allclose(stress[0, 0], stress[1, 1], rtol=1e-6)
        np.testing.assert_allclose(U[0, 0], U[1, 1], rtol=1e-9)
    # the larger of both counts
    corners = s.estimates[0].normal.points
    values = np.zeros((2, 9, corners.triangles[0].r.size))
    values[:, 0], values[:, 1] = 1.0, 3.0
    near = corners.largest_at_corners(values)[0, :2]
    assert near[1].min() == near[1].max() == near[0].max() == 3.0
    assert near[0].min() == 1.0


def test_changes_on_a_plane_count_as_far_away_as_it_is_deep():
    """On the surface within the rings alone; narrow cells of a deep interface do not make it more certain."""
    points = solved("sphere").estimates[0].normal.points
    for (depth, layer), (r, on_plane) in points.planes.items():
        cell = np.searchsorted(r, 2 * points.meshes[0].mesh.contact_radius)  # begins with this vertex
        values = np.zeros((2, 6, r.size - 1, on_plane[0].r.size // (r.size - 1)))
        values[:, 3, cell] = 1.0
        found = points.largest_on_plane(values.reshape(2, 6, -1), (depth, layer))
        near = r[cell - RINGS + 1 : cell + RINGS + 1]
        expected = (r >= near[0] - depth) & (r <= near[-1] + depth)
        np.testing.assert_array_equal(found[0, 3] > 0, expected)
        assert np.count_nonzero(expected) > near.size or depth == 0
        alike = points.largest_on_plane(np.ones((2, 6, on_plane[0].r.size)), (depth, layer))
        # of changes of one size those on the axis count more, as far as the depth
        assert np.all(alike == np.where(r <= depth, AXIS_SAFETY[0], 1.0))


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


def estimated(*coarser, residual=0.0):
    """Budget and uncertainty of the stiffness if ``coarser`` were the contacts on the coarser meshes."""
    one, s = replace(contact(), residual=residual), solved("sphere")
    states = (ElasticState.of_contact(s.state.solid, one),)
    (found,), stiffness = contact_estimates((one, *coarser), states, s.units)
    return budget(found), stiffness


def test_meshes_that_agree_leave_no_error_of_element_size():
    one = contact()
    # what a coarser one misses of the load is no error of its mesh
    missing = replace(one, load=1.001 * one.load, approach=one.approach + 1e-3 * one.load / one.stiffness)
    same, _ = estimated(one, one)
    assert same["contact_radius", "element size"] < 1e-9 * same["contact_radius", "edge size"]
    for row, _ in (estimated(one, one), estimated(missing, one), estimated(one, missing)):
        assert row["approach", "element size"] < 1e-12 * solved("sphere").approach


@pytest.mark.parametrize("sign", [1, -1])
def test_changes_between_meshes_count_by_roaches_factor(sign):
    one, s, change = contact(), solved("sphere"), sign * 1e-3
    _, least = estimated(one, one)
    other = replace(
        one,
        approach=one.approach * (1 + change),
        stiffness=one.stiffness * (1 + change),
        # with the load the radius at one load: W ~ a^growth
        load=one.load * (1 + change) ** one.growth,
    )
    # Roache (1994) eq. 9, ratio 1.4: order 2 + 1 of displacements; of the coarser meshes' change the share
    last = 3 / (1.4**3 - 1) * abs(change)
    for coarser, factor in (((other, other), last), ((one, other), last / 1.4**3)):
        row, stiffness = estimated(*coarser)
        missing = one.approach * (1 + change) + (one.load - other.load) / other.stiffness - one.approach
        approach = factor * abs(missing / change) * s.units.displacement
        assert row["approach", "element size"] == pytest.approx(approach, rel=1e-9, abs=0)
        radius = factor / (1 + change) * s.contact_radius
        assert row["contact_radius", "element size"] == pytest.approx(radius, rel=1e-5, abs=0)
        assert stiffness - least == pytest.approx(factor * s.stiffness, rel=1e-9, abs=0)


@pytest.mark.parametrize("order", [1, 3, 5])
def test_an_error_of_the_order_is_stated_thrice(order):
    # f = c h^p: the last change over r^p - 1 is the error of the finest mesh
    error = 1e-6
    fine, coarse = (error * (COARSER ** ((k + 1) * order) - COARSER ** (k * order)) for k in (0, 1))
    assert from_changes(np.array([fine, coarse]), order) == pytest.approx(SAFETY * error)
    # a last change that is small by chance does not count
    assert from_changes(np.array([0.0, coarse]), order) == pytest.approx(SAFETY * error)
    assert from_changes(np.array([coarse, coarse]), order) > SAFETY * error


def test_forces_out_of_balance_count_as_load():
    one, s = contact(), solved("sphere")
    (none, least), (some, stiffness) = (estimated(one, one, residual=load) for load in (0.0, 1e-3))
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

    def of(approach=0.0, **causes):
        return estimates((state,), (found.coarser,), unit, approach, **causes)[0]

    none, load, edge, size = of(), of(load=1e-3), of(edge=1e-3), of(1e-3, radius=1e-3)
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
    for one in (edge, size):
        assert one.normal.radius_error - none.normal.radius_error == pytest.approx(1e-3)
    share = 1e-3 / (s.approach / unit.displacement) + 1e-3 / state.mesh.contact_radius
    assert size.normal.relative - none.normal.relative == pytest.approx(share)


def test_each_part_of_the_estimate_adds_to_that_of_stress_and_displacement():
    s = solved("sphere")
    found, a = s.estimates[0].normal, s.state.mesh.contact_radius
    r, z = a * np.array([0.0, 0.5, 1.0, 1.02, 0.3, 2.0]), a * np.array([0.0, 0.2, 0.0, 0.01, 0.9, 1.5])
    at = s.state.discretisation.locator.points(r, z, np.searchsorted(s.state.mesh.depths, z))
    u, stress = found.fields[0](at)
    before, moved = found(at), found.displacement(at)
    more = replace(found, far=found.far + 1, everywhere=found.everywhere + 2)
    np.testing.assert_allclose(more.displacement(at), moved + 1)
    np.testing.assert_allclose(more(at), before + 2)
    more = replace(found, relative=found.relative + 1)
    np.testing.assert_allclose(more.displacement(at), moved + np.abs(u))
    assert np.all((more(at) > before)[stress != 0])
    # a displaced edge counts beside the edge alone
    displaced, near = (
        replace(found, radius_error=1e-2 * a)._displaced(at, stress),
        np.hypot(r - a, z) < 0.3 * a,
    )
    assert np.all(displaced[:, ~near] == 0)
    assert np.all(displaced[0, near] > 0)


@pytest.mark.parametrize("size", [0.08, 0.12, 0.18, 0.27, 0.5])
def test_three_meshes_are_of_one_family(size):
    meshes = [asdict(grading) for grading in family(size)]
    for fine, coarse in pairwise(meshes):
        for name in ("surface", "edges"):  # for contacts that are no discs
            assert not coarse[name]
            assert not fine[name]
        factors = {"rows": 1 / COARSER, "edge_size": EDGE_COARSER}
        for name in fine.keys() - {"surface", "edges"}:
            assert coarse[name] / fine[name] == pytest.approx(factors.get(name, COARSER)), name


def test_the_uncertainty_is_above_the_last_change():
    # at some places the final mesh is the worse one, and all the change is its error
    found = solved("sphere").estimates[0].normal
    final, companion, _ = found.points.triangles
    change = np.abs(found.fields[0](final)[1] - found.fields[1](companion)[1])
    assert np.all(found._changes(found.points.triangles)[0, :6] == change)
    worst = change.reshape(6, 7, -1).max(axis=1)
    assert np.all(found._corners[:6] >= worst[:, None])
    # a vertex of a plane has the stresses of two cells, of which samples next to it see either
    vertices = found.points.meshes[0].contact_vertices
    cells = samples(vertices).reshape(vertices.size - 1, -1)
    assert np.all((vertices[:-1, None] < cells) & (cells < vertices[1:, None]))
    np.testing.assert_allclose(cells[:, [0, -1]].T, [vertices[:-1], vertices[1:]], rtol=0, atol=1e-6)


def test_solutions_are_compared_inside_the_triangles():
    points, mesh = solved("sphere").estimates[0].normal.points, solved("sphere").state.mesh
    final, *coarser = points.triangles
    assert final.z.size == 7 * mesh.layer.size
    assert final.z.min() > 0
    assert not np.isin(final.z, mesh.depths).any()
    assert np.min([*final.X, 1 - final.X.sum(axis=0)]) > -1e-9
    for one in coarser:
        np.testing.assert_array_equal(final.z, one.z)
    vertices = points.meshes[0].contact_vertices
    assert (vertices[0], vertices[-1]) == (0, mesh.contact_radius)
    assert np.all(np.diff(vertices) > 0)


def test_what_the_far_field_leaves_out_is_a_compliance():
    """1/S is d delta / d W: a near boundary changes both by one compliance, not in one proportion."""
    load = 20.0
    given = {"radius": 10e-3, "load": load, "coatings": ((420e9, 0.25, 30e-6),), "substrate": (210e9, 0.3)}
    near, far = (solve(**given, far=distance) for distance in (20.0, 1000.0))
    missing = (near.approach - far.approach) / load
    assert 1 / near.stiffness - 1 / far.stiffness == pytest.approx(missing, rel=0.1)
    budget = {row[:2]: row[2] for row in near.uncertainty.budget}
    assert near.stiffness_uncertainty > near.stiffness**2 * budget["approach", "outer boundary"] / load
    assert len(repr(near)) < 2000
