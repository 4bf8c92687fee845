"""Energy bounds: stresses are in equilibrium, displacements compatible, the exact values between both."""

from itertools import pairwise

import numpy as np
import pytest
from energy_bounds import lower_bounds, upper_bounds
from energy_bounds.approach_bounds import approach_bounds, bound
from energy_bounds.half_space_mesh import RADIAL_POINTS, STEEPEST, half_space
from energy_bounds.spline_elements import Pieces, Points
from energy_bounds.tensor_energy import virtual_work

from verification.credibility.import_independence import imports_of
from verification.evidence.enclosure_record import SHIPPED, read_record
from verification.problem.coated_contact import CoatedContact, keywords
from verification.sources.references import integral_equation

COARSE = {"degree": 4, "edge": 0.1, "far": 300.0}
COATINGS = ((4.0, 0.2, 0.2), (0.5, 0.45, 0.3))
SOLID = half_space(COATINGS, 0.3, **COARSE)


def random_unknowns(energy, admissible):
    """Admissible unknowns with every free one drawn at random."""
    given, free = admissible(energy)
    x = np.array(given, dtype=float)
    x[free] += np.random.default_rng(3).normal(size=x[free].shape)
    return x


def stresses(x, r, z):
    """sigma_rr, tt, zz, rz of the unknowns at the places ``r``, ``z`` of [-1, 1] in every piece."""
    at = [Points(knots, np.asarray(p), np.zeros(len(p))) for knots, p in ((SOLID.r, r), (SOLID.z, z))]
    with np.errstate(all="ignore"):  # 0/0 on the axis
        sigma = lower_bounds.stress_energy(SOLID, *at).components(x)[0]
    return sigma.reshape(4, SOLID.r.size - 1, len(r), SOLID.z.size - 1, len(z)), at[0].place


@pytest.fixture(scope="module")
def phi():
    return random_unknowns(lower_bounds.stress_energy(SOLID, *SOLID.points()), lower_bounds.admissible)


def test_pieces_are_as_smooth_as_stated():
    knots = np.array([0.0, 0.5, 2.0, 3.0])
    for smoothness in (0, 1):
        space = Pieces(knots, 5, smoothness)
        ends = Points(knots, np.array([-1.0, 1.0]), np.zeros(2))
        for derivative in range(smoothness + 1):
            table = space.table(ends, derivative).reshape(space.size, -1, 2)
            assert np.abs(table[:, 1:, 0] - table[:, :-1, 1]).max() < 1e-13
            numbers = (space.values, space.slopes)[derivative]
            assert table[numbers[:-1], np.arange(3), 0] == pytest.approx(1.0)
    # every polynomial of the degree: as many independent functions a piece
    assert np.linalg.matrix_rank(Pieces(knots[:2], 5, 1).table(Points.gauss(knots[:2], 8))) == 6


def test_radial_points_integrate_polynomials_over_r_to_rounding():
    # such a quotient is a polynomial, which they integrate exactly, with a multiple of 1/r
    points = Points.gauss(np.array([1.0, STEEPEST**1.5]), RADIAL_POINTS)
    assert points.weight @ (1 / points.place) == pytest.approx(1.5 * np.log(STEEPEST), rel=1e-14)


def test_any_stress_of_the_unknowns_is_in_equilibrium(phi):
    step = 1e-4
    x = np.array([t + s for t in np.random.default_rng(1).uniform(-0.9, 0.9, 3) for s in (-step, 0, step)])
    sigma, place = stresses(phi, x, x)
    r = place.reshape(-1, x.size)[:, 1::3, None, None]
    rr, tt, _, rz = sigma[:, :, 1::3, :, 1::3]
    along = [np.diff(k)[:, None] * step for k in (SOLID.r, SOLID.z)]
    d_r = (sigma[:, :, 2::3, :, 1::3] - sigma[:, :, 0::3, :, 1::3]) / along[0][:, :, None, None]
    d_z = (sigma[:, :, 1::3, :, 2::3] - sigma[:, :, 1::3, :, 0::3]) / along[1]
    for parts in ((d_r[0], d_z[3], (rr - tt) / r), (d_r[3], d_z[2], rz / r)):
        size = sum(np.abs(part) for part in parts).max(axis=(1, 3), keepdims=True)
        # relative to the largest of each rectangle; the step's own error is about its square
        assert np.max(np.abs(sum(parts)) / size) < 1e-6


def test_tractions_are_continuous_and_vanish_outside_the_contact(phi):
    sigma, place = stresses(phi, np.array([-1.0, 0.3, 1.0]), np.array([-1.0, 0.3, 1.0]))
    sigma[:, 0, 0] = 0  # on the axis the components are limits
    size = np.abs(sigma).max(axis=(1, 2, 3, 4))[:, None, None, None]
    across_z = (sigma[2:, :, :, :-1, 2] - sigma[2:, :, :, 1:, 0]) / size[2:]
    across_r = (sigma[[0, 3], :-1, 2] - sigma[[0, 3], 1:, 0]) / size[[0, 3]]
    surface = sigma[2:, :, :, 0, 0] / size[2:, ..., 0]
    outside = place.reshape(-1, 3) >= 1
    side = sigma[[0, 3], -1, 2] / size[[0, 3], ..., 0]
    for part in (across_z, across_r, surface[1], surface[0][outside], side):
        assert np.abs(part).max() < 1e-9


def test_the_far_cone_continues_the_tractions(phi):
    sigma, place = stresses(phi, np.array([-0.7, 0.2, 0.9]), np.array([-1.0, 1.0]))
    rho = SOLID.r[-1]
    x, m, c = place / rho, SOLID.z[-1] / rho, phi[0] / -1.0
    zz = c * 12 * (1 - x) ** 2 / rho**2
    assert sigma[2, :, :, -1, 1].ravel() == pytest.approx(zz, rel=1e-8, abs=1e-12)
    assert sigma[3, :, :, -1, 1].ravel() == pytest.approx(m * x * zz, rel=1e-8, abs=1e-12)


def test_stresses_do_the_work_of_their_pressure_in_any_displacement(phi):
    strain = upper_bounds.strain_energy(SOLID)
    u = random_unknowns(strain, upper_bounds.admissible)
    sigma = lower_bounds.stress_energy(SOLID, *SOLID.points())
    tensor, strains = sigma.components(phi)[0][None], np.stack([strain.components(v)[0] for v in u.T])
    inside = virtual_work(tensor, strains, strain.weights)
    parts = virtual_work(np.abs(tensor), np.abs(strains), strain.weights)
    assert np.all(np.abs(inside - phi @ lower_bounds.pressure_work(sigma)) < 1e-13 * parts)


@pytest.mark.parametrize("coatings", [(), COATINGS])
def test_bounds_contain_the_exact_values(coatings):
    problem = CoatedContact(1.0, 0.01, tuple((E, nu, h / 5) for E, nu, h in coatings), (1.0, 0.3))
    exact = integral_equation.solve(**keywords(problem), estimate_uncertainty=False)
    found = bound(problem, exact.contact_radius, **COARSE)
    if not coatings:
        assert exact.stiffness == pytest.approx(2 * problem.E_star * problem.a_h, rel=1e-9)
    assert found.stiffness[0] < exact.stiffness < found.stiffness[1] < 1.05 * found.stiffness[0]
    assert found.approach[0] < exact.approach < found.approach[1] < 1.02 * found.approach[0]
    assert found.rounding < 1e-9


def test_wrong_signs_of_the_gap_are_refused():
    upper, lower = np.eye(2), np.eye(2) / 2
    low, high = approach_bounds(upper, lower, 1.0)
    # W = K_11 delta - K_12 at either end of the gap of diagonal forms
    assert low < 4 / 3 < high
    with pytest.raises(ValueError, match="wide"):
        approach_bounds(lower, upper, 1.0)
    with pytest.raises(ValueError, match="1/2"):
        half_space(((1.0, 0.5, 1.0),), 0.3, **COARSE)


def test_bounds_import_neither_a_method_nor_a_reference():
    others = ("semianalytic", "fem_reference", "skfem", "verification.sources.references")
    found = imports_of("energy_bounds", others)
    assert not found.forbidden
    assert found.files > 5


def test_recorded_bounds_contain_the_enclosures():
    two_sided = [one for one in read_record(SHIPPED).enclosures if one.two_sided]
    assert len(two_sided) == 6
    for one in two_sided:
        found = one.two_sided
        assert found.contained, one.name
        assert found.approach == one.bounds[1]
        assert all((high - low) / exact < 2e-5 for (low, high), exact, _ in found.compared)
        assert all(1 <= effectivity < 20 for *_, effectivity in found.compared)


@pytest.mark.slow
def test_the_gap_of_the_stiffness_falls_as_the_first_power_of_the_smallest_piece():
    # r^(-1/2) at the edge: the energy that a piece of size d misses is proportional to d
    problem = CoatedContact(1.0, 0.01, ((4.0, 0.3, 0.05),), (1.0, 0.3))
    exact = integral_equation.solve(**keywords(problem), estimate_uncertainty=False)
    edges = (0.1, 0.03, 0.01)
    found = [bound(problem, exact.contact_radius, degree=6, edge=edge, far=1e7) for edge in edges]
    gaps = [np.ptp(one.stiffness) for one in found]
    order = np.polyfit(np.log(edges), np.log(gaps), 1)[0]
    assert order == pytest.approx(1.0, abs=0.1)
    widths = [np.ptp(one.approach) for one in found]
    assert all(coarse > fine for coarse, fine in pairwise(widths))


@pytest.mark.slow
def test_bounds_of_random_layers_contain_the_exact_values():
    random = np.random.default_rng(19)
    for _ in range(4):
        layers = tuple(
            (10 ** random.uniform(-1, 1), random.uniform(0, 0.45), 0.2 * 10 ** random.uniform(-1, 0.3))
            for _ in range(random.integers(1, 4))
        )
        problem = CoatedContact(1.0, 0.01, layers, (1.0, random.uniform(0, 0.45)))
        exact = integral_equation.solve(**keywords(problem), estimate_uncertainty=False)
        found = bound(problem, exact.contact_radius, degree=5, edge=0.01, far=1e6)
        assert found.stiffness[0] < exact.stiffness < found.stiffness[1] < 1.01 * found.stiffness[0]
        assert found.approach[0] < exact.approach < found.approach[1] < 1.002 * found.approach[0]
