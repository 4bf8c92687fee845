"""Sliding contact without Goodman's assumption: closed forms, laws, and patches that know no expansion."""

from dataclasses import astuple, replace

import numpy as np
import pytest
from scipy import fft
from scipy.sparse.linalg import LinearOperator, gmres
from scipy.special import j0, j1

from semianalytic.coefficients import frf
from verification.problem.coated_contact import CoatedContact
from verification.sources.assumptions.sliding_coupling import SlidingExpansion, coupling
from verification.sources.references.layered_half_space import contact_modulus

E, NU = 210e9, 0.3
BARE = CoatedContact(10e-3, 20.0, (), (E, NU))
PI2 = np.pi**2
# shift and centre over beta; radius, approach, pressure on the axis over beta^2
CLOSED = np.array(
    [-1 / np.pi, -3 / (2 * np.pi), 1 / 18 + 1 / (6 * PI2), 1 / 9 - 1 / (6 * PI2), -17 / 72 + 1 / (6 * PI2)]
)
PEAK = -25 / 144 + 7 / (24 * PI2) + PI2 / 128  # over beta^2
POWERS = np.array([1, 1, 2, 2, 2])


def coated(ratio, h, nu=NU, **others):
    return replace(BARE, coatings=((ratio * E, nu, h * BARE.a_h),), **others)


@pytest.mark.parametrize(
    "problem",
    [
        BARE,
        replace(BARE, substrate=(E, -0.2)),
        coated(1.0, 0.4),
        replace(BARE, ball=(4 * E, 0.2, ())),
        replace(BARE, ball=(E / 4, 0.2, ((E / 4, 0.2, BARE.a_h),))),
    ],
    ids=["bare", "negative nu", "equal moduli", "elastic ball", "layered ball of one material"],
)
def test_homogeneous_bodies_meet_the_closed_forms(problem):
    change = sliding_change(problem)
    assert change == pytest.approx(CLOSED * problem.dundurs_beta**POWERS, rel=1e-8)


@pytest.mark.parametrize(
    "problem",
    [
        replace(BARE, substrate=(E, 0.5)),
        replace(BARE, ball=(E, NU, ())),
        coated(0.2, 0.3, ball=(E, NU, ((0.2 * E, NU, 0.3 * BARE.a_h),))),
    ],
    ids=["incompressible", "equal bodies", "equal coated bodies"],
)
def test_nothing_changes_without_coupling(problem):
    assert np.abs(sliding_change(problem)).max() < 1e-13


def test_coupling_of_one_layer_is_dundurs_beta_for_short_waves_and_the_substrates_for_long_ones():
    problem = replace(coated(4.0, 1.0, nu=0.2), ball=(E / 2, 0.4, ()))
    solids = ((problem.coatings, problem.substrate), ((), (E / 2, 0.4)))
    E_star = 1 / sum(1 / contact_modulus(*solid) for solid in solids)
    long, short = coupling(solids, E_star, np.array([1e-7, 60.0]) / BARE.a_h)
    assert short == pytest.approx(problem.dundurs_beta, rel=1e-12)
    without = replace(problem, coatings=())
    assert long == pytest.approx(without.dundurs_beta * E_star / without.E_star, rel=1e-4)


def test_thick_coating_gives_the_closed_forms_of_its_material():
    thick = coated(0.5, 300.0, nu=0.1)
    E1 = CoatedContact(10e-3, 20.0, (), (0.5 * E, 0.1))
    # the substrate is felt as a/h
    change = sliding_change(thick) / E1.dundurs_beta**POWERS
    assert change == pytest.approx(CLOSED, rel=2e-2)


@pytest.mark.parametrize("nu", [0.0, 0.3])
def test_peak_pressure_meets_the_closed_form(nu):
    f, problem = 0.02, replace(BARE, substrate=(E, nu))
    # the next power of f beta, 1e-4, times a coefficient of order one
    expected = PEAK * (f * problem.dundurs_beta) ** 2
    assert SlidingExpansion(problem).peak_change(f)[0] == pytest.approx(expected, rel=5e-4)


def test_pressure_of_the_first_order_has_its_moment_and_transform():
    first = (expansion := SlidingExpansion(coated(4.0, 0.5))).first
    # r = a sin(angle)
    x, w = np.polynomial.legendre.leggauss(60)
    angle = np.pi / 4 * (1 + x)
    r, weight = first.a * np.sin(angle), np.pi / 4 * w * first.a * np.cos(angle)
    p1 = expansion.first_pressure(r)
    assert weight @ (p1 * r**2) == pytest.approx(first.moment, rel=1e-6)
    k = 3.0 / first.a
    assert weight @ (p1 * j1(k * r) * r) == pytest.approx(first.transform(np.array([k]))[0], rel=1e-6)


def sliding_change(problem, nodes=160):
    """Shift, centre, radius, approach, pressure on the axis, the last over that without friction."""
    expansion = SlidingExpansion(problem, nodes)
    *others, pressure = astuple(expansion.change)
    return np.array([*others, pressure / expansion.exact.pressure(0.0)])


def rectangle(x, y, d):
    """u_z at (x, y) of a unit p, then of a unit q, on a square of side d, E* = beta = 1. Love; Cerruti."""
    corners = [(i * j, x + i * d / 2, y + j * d / 2) for i in (1, -1) for j in (1, -1)]
    normal = sum(
        sign * (u * np.log(v + np.hypot(u, v)) + v * np.log(u + np.hypot(u, v))) for sign, u, v in corners
    )
    sliding = sum(sign * (v * np.log(np.hypot(u, v)) + u * np.arctan(v / u)) for sign, u, v in corners)
    return normal / np.pi, sliding / np.pi


def layers_kernel(r, coating, substrate):
    """u_z at r of a unit p, then of a unit q in +x over cos(theta), by the layers; E1* = beta = 1.

    From the frequency responses of the semi-analytical method, of which the expansion knows nothing.
    """
    layers = {"coatings": (coating,), "substrate": substrate}
    x, w = np.polynomial.legendre.leggauss(400)
    # the response decays as exp(-2 k h)
    k, w = (1 + x) * 10 / coating[2], w * 10 / coating[2]
    sliding = frf.displacement_frf(k, np.zeros(1), 0, **layers, load="in-plane", excess=True)[0, 0]
    alone = {"coatings": (coating,), "substrate": coating[:2]}
    sliding = sliding / frf.displacement_frf(k[:1], np.zeros(1), 0, **alone, load="in-plane")[0, 0]
    radii, where = np.unique(r.round(9), return_inverse=True)
    phase = np.outer(radii, k)
    found = j0(phase) @ (w * frf.compliance_excess(k, **layers)), j1(phase) @ (w * sliding)
    return [part[where].reshape(r.shape) / np.pi for part in found]


def solve_on_patches(C, n, half_width=1.15, load=4 / 3, layers=None):
    """Full sliding with C = f beta, E* = R = 1 on ``n`` squares each way; no expansion in C.

    Returns approach, peak pressure, centre of pressure; the patches' x and pressure.
    """
    d = 2 * half_width / n
    x = (np.arange(n) - (n - 1) / 2) * d
    offset = np.arange(1 - n, n) * d
    normal, sliding = rectangle(offset[:, None], offset[None, :], d)
    if layers is not None:
        r = np.hypot(*np.meshgrid(offset, offset))
        by_pressure, by_traction = layers_kernel(r, *layers)
        normal += d**2 * by_pressure
        sliding += d**2 * by_traction * offset[:, None] / np.maximum(r, d / 2)
    delta, p = solve_sliding(normal + C * sliding, (x[:, None] ** 2 + x**2) / 2, load / (n * d) ** 2)
    i, j = np.unravel_index(p.argmax(), p.shape)
    low, top, high = p[i - 1 : i + 2, j]
    peak = top - (high - low) ** 2 / (8 * (high - 2 * top + low))
    return np.array([delta, peak, (p.sum(axis=1) @ x) / p.sum()]), x, p


def solve_sliding(kernel, gap0, mean):
    """Approach and pressures, whose ``mean`` is given. The contact is found patch by patch.

    kernel : displacement by a unit pressure over the distance in patches, (2 n - 1, 2 m - 1).
    The operator is not symmetric, so that it is no energy's gradient and conjugate gradients do not apply:
    GMRES solves on the active set, which follows the signs of pressure and gap.
    """
    shape = gap0.shape
    sizes = [fft.next_fast_len(side) for side in kernel.shape]
    padded = np.zeros(sizes)
    padded[tuple(slice(side) for side in kernel.shape)] = kernel
    transform = fft.rfft2(np.roll(padded, [1 - side for side in shape], axis=(0, 1)))

    def deflection(p):
        return fft.irfft2(transform * fft.rfft2(p, sizes), sizes)[: shape[0], : shape[1]]

    active, p, delta = gap0 < 0.5, np.zeros(shape), 0.0
    for _ in range(20):

        def apply(v, active=active):
            p = np.zeros(shape)
            p[active] = v[:-1]
            return np.append(deflection(p)[active] - v[-1], p.mean())

        count = int(active.sum()) + 1
        equations = LinearOperator((count, count), matvec=apply, dtype=float)
        start = np.append(p[active], delta)
        solution, failed = gmres(equations, np.append(-gap0[active], mean), x0=start, rtol=1e-9, restart=120)
        assert not failed
        p, delta = np.zeros(shape), solution[-1]
        p[active] = solution[:-1]
        found = np.where(active, p > 0, deflection(p) + gap0 - delta < 0)
        if np.array_equal(found, active):
            break
        active = found
    return delta, p


@pytest.mark.parametrize("problem", [BARE, coated(4.0, 0.5, nu=0.1)], ids=["bare", "coated"])
def test_edge_has_the_exponent_of_the_plane(problem):
    """(1 - r/a)^(atan(f beta cos theta)/pi) to the order f: beta/pi times the logarithm, of the top layer."""
    expansion = SlidingExpansion(problem)
    far = np.array([1e-6, 1e-5])
    r = expansion.a * (1 - far)
    ratio = expansion.first_pressure(r) / expansion.exact.pressure(r)
    assert np.diff(ratio) / np.diff(np.log(far)) == pytest.approx(problem.dundurs_beta / np.pi, rel=1e-3)


def test_patches_without_an_expansion_confirm_a_coated_contact():
    C, n, layers = 0.05, 49, ((1 - NU**2, NU, 0.5), ((1 - NU**2) / 4, NU))
    problem = CoatedContact(1.0, 0.8, (layers[0],), layers[1])
    expansion = SlidingExpansion(problem)
    f, half_width = C / problem.dundurs_beta, 1.15 * expansion.a
    still, sliding = (solve_on_patches(c, n, half_width, problem.load, layers)[0] for c in (0.0, C))
    change = sliding_change(problem)
    assert still[0] == pytest.approx(expansion.exact.approach, rel=1e-3)
    # the staircase; of the peak, which lies on a ring, the terms of f^2 away from the axis
    assert sliding[0] / still[0] - 1 == pytest.approx(f**2 * change[3], rel=0.05)
    assert sliding[1] / still[1] - 1 == pytest.approx(expansion.peak_change(f)[0], rel=0.05)
    assert sliding[2] == pytest.approx(f * change[1] * expansion.a, rel=0.02)
