"""Small strains under an elastic ball: limits, a curved body of finite elements, the second-order energy."""

from dataclasses import astuple, replace

import numpy as np
import pytest
from assumption_maps_made.finite_deformation import SphereContact, State
from assumption_maps_made.meridian_elements import Meridian, lagrange
from assumption_maps_made.small_strain_cost import of_small_strains
from numpy.polynomial import legendre
from scipy.sparse.linalg import splu

from verification.evidence.assumption_maps import Place
from verification.problem.coated_contact import keywords
from verification.sources.assumptions.contact_change import Change
from verification.sources.assumptions.strain_cost_of_pair import SAFETY, of_pair
from verification.sources.references import integral_equation

WIDTH = 1e-3
PAIR = Place(4.0, 0.2, 0.3, WIDTH, 0.0, 0.5).problem
BARE = replace(PAIR, coatings=())


def of_rigid(problem):
    """A stand-in that grows with the width and the coating, without uncertainty."""
    size = (
        problem.a_h / problem.radius * sum((1.0, *(E / problem.substrate[0] for E, *_ in problem.coatings)))
    )
    return Change(-size, -2 * size, 3 * size, 4 * size, None), Change(0.0, 0.0, 0.0, 0.0, None)


def test_rigid_ball_is_read_as_it_is():
    rigid = replace(PAIR, ball=None)
    assert of_pair(rigid, of_rigid) == of_rigid(rigid)


def test_coated_ball_is_refused():
    with pytest.raises(ValueError, match="ball"):
        of_pair(replace(BARE, ball=(*BARE.substrate, ((1e11, 0.3, 1e-6),))), of_rigid)


def test_problem_that_a_body_has_no_answer_for_has_none():
    with pytest.raises(ValueError, match="answer"):
        of_pair(BARE, lambda problem: (Change(*[None] * 5),) * 2)


def test_very_stiff_ball_is_rigid():
    """The contact of the ball alone, almost without strain, is not solved."""
    asked = []
    stiff = replace(PAIR, ball=(1e6 * PAIR.ball[0], 0.3, ()))
    expected = of_rigid(replace(stiff, ball=None))[0]
    change, _ = of_pair(stiff, lambda problem: asked.append(problem) or of_rigid(problem))
    assert len(asked) == 1
    assert astuple(change)[:3] == pytest.approx(astuple(expected)[:3], rel=1e-4)
    assert (change.tension, change.shear) == (None, None)


def test_equal_bodies_halve_the_cost_but_of_the_approach():
    change, U = of_pair(BARE, of_rigid)
    size = BARE.a_h / BARE.radius  # of which each body has half
    assert change.peak_pressure == pytest.approx(3 * size / 2, rel=1e-6)
    assert change.contact_radius == pytest.approx(-size / 2, rel=1e-6)
    nu = BARE.ball[1]
    slope = (2 / (3 * np.pi)) * (1 - 2 * nu) / (1 - nu) * size / 2
    assert change.approach == pytest.approx(-size + slope, rel=1e-6)
    assert astuple(U)[:3] == pytest.approx((0.0, 0.0, 0.0), abs=1e-8 * size)


def body_energy(exact, problem, body):
    """int Psi_3 dV, int p S u_r dA with S the deformed slope, int p r u_r dA under p; over E* a^3."""
    E_star, seen = problem.E_star, problem.seen_from(body)
    coatings = tuple((E / E_star, nu, h / exact.contact_radius) for E, nu, h in seen.coatings)
    depths = tuple(np.cumsum([h for *_, h in coatings]))
    mesh = Meridian(depths, 50.0, 4, 1.0, 5e-4 * min([1.0, *(h for *_, h in coatings)]))
    substrate = seen.substrate[0] / E_star, seen.substrate[1]
    load = problem.load / (E_star * exact.contact_radius**2)
    model = SphereContact(mesh, 1.0, load, coatings, substrate, False)
    x, w = legendre.leggauss(12)
    N, D = lagrange(mesh.nodes, x)
    r, dr = (mesh.of_elements(model.rho) @ part.T for part in (N, D))
    force = exact.pressure(r * exact.contact_radius) / E_star * r * dr * w
    f, u = np.zeros(2 * mesh.rho.size * mesh.z.size), np.zeros(2 * mesh.rho.size * mesh.z.size)
    np.add.at(f, model.c_z[mesh._members(model.rho.size)], force @ N)
    far = model._far_unknowns
    u[far] = model._far_displacement(1.0)
    K = model.stiffness(State(1.0, 0.0, u))
    free = np.setdiff1d(np.arange(u.size), np.concatenate([2 * np.arange(mesh.z.size), far]))
    options = {"SymmetricMode": True}
    factor = splu(K[free][:, free].tocsc(), "MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options=options)
    u[free] = factor.solve((f - K @ u)[free])
    rr, rz, zr, zz, tt = np.moveaxis(model.gradient(State(1.0, 0.0, u)), -1, 0)
    H = np.zeros((*rr.shape, 3, 3))
    H[..., 0, 0], H[..., 0, 1], H[..., 1, 0], H[..., 1, 1], H[..., 2, 2] = rr, rz, zr, zz, tt
    tr, tr2, tr3 = (np.trace(part, axis1=-2, axis2=-1) for part in (H, H @ H, H @ H @ H))
    volume = np.sum((-model.mu / 3 * tr3 - model.lam / 2 * tr * tr2) * mesh.weights)
    u_r, slope = mesh.of_elements(u[model.c_r]) @ N.T, -(mesh.of_elements(u[model.c_z]) @ D.T) / dr
    return 2 * np.pi * np.array([volume, np.sum(force * slope * u_r), np.sum(force * r * u_r)])


def second_order_energy(problem):
    """Of both bodies at the same approach, with it; the slope of the contact is that of the ball less r/R."""
    exact = integral_equation.solve(**keywords(problem), estimate_uncertainty=False)
    flat, ball = (body_energy(exact, problem, body) for body in problem.bodies)
    a = exact.contact_radius
    both = flat[0] - flat[1] + ball[0] - ball[1] + ball[2] * a / problem.radius
    return both * problem.E_star * a**3, exact.approach


@pytest.mark.slow
@pytest.mark.parametrize(
    ("ratio", "thickness", "ball", "nu"),
    [
        (1.0, 0.5, 0.5, 0.3),
        (10.0, 0.02, 0.5, 0.3),
        (0.1, 0.02, 0.5, 0.3),
        (10.0, 0.2, 0.5, 0.3),
        (4.0, 0.1, 0.8, 0.2),
    ],
)
def test_approach_of_a_coated_pair_follows_the_second_order_energy(ratio, thickness, ball, nu):
    problem, step = Place(ratio, thickness, nu, WIDTH, 0.0, ball).problem, 0.02
    above, below = (
        second_order_energy(replace(problem, load=(1 + by) * problem.load))[0] for by in (step, -step)
    )
    expected = -(above - below) / (2 * step * problem.load) / second_order_energy(problem)[1]
    change, U = of_pair(problem, of_small_strains)
    assert change.approach == pytest.approx(expected, abs=0.9 / SAFETY * U.approach + 5e-3 * abs(expected))
