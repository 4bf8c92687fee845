"""Contact of a sphere by collocation: Hertz, convergence, divided coatings, extreme contrasts."""

import numpy as np
import pytest

import semianalytic
from semianalytic import collocation
from semianalytic.inputs import Body, undeformed_gap
from semianalytic.uncertainty import Uncertainty, of_stiffness

R, W = 10e-3, 20.0
E, NU = 210e9, 0.3
E_STAR = E / (1 - NU**2)
A_H = (0.75 * W * R / E_STAR) ** (1 / 3)
P_H = 1.5 * W / (np.pi * A_H**2)
STEEL = (E, NU)


def contact(*coatings):
    body = Body(tuple((ratio * E, nu, h * A_H) for ratio, nu, h in coatings), STEEL, 0.0)
    return collocation.contact(R, W, None, body)


@pytest.mark.parametrize("coatings", [(), ((1.0, NU, 0.3),), ((1.0, NU, 0.1), (1.0, NU, 1.0))])
def test_equal_moduli_give_hertz(coatings):
    profile, approach, stiffness, error = contact(*coatings)[0]
    assert profile.radius == pytest.approx(A_H, rel=1e-13, abs=0)
    assert profile.peak == pytest.approx(P_H, rel=1e-12)
    assert approach == pytest.approx(A_H**2 / R, rel=1e-12, abs=0)
    assert stiffness == pytest.approx(2 * E_STAR * A_H, rel=1e-10)
    assert error < 1e-9 * stiffness


@pytest.mark.parametrize("ratio", [1e-4, 0.25, 4.0, 1e4])
@pytest.mark.parametrize("h", [0.02, 0.5])
def test_terms_converge(ratio, h):
    fine, middle, coarse = (found.profile for found in contact((ratio, 0.25, h)))
    last, before = abs(fine.radius - middle.radius), abs(middle.radius - coarse.radius)
    # geometrically, down to the rounding of the response
    assert last < max(0.3 * before, 1e-10 * fine.radius)


def compared(ratio, nu, h):
    """A coating as one and as two equal halves: each quantity's difference over the stated uncertainties."""
    whole, halves = (
        semianalytic.solve(radius=R, load=W, coatings=coatings, substrate=STEEL, friction=0.3, patches=65)
        for coatings in (((ratio * E, nu, h * A_H),), ((ratio * E, nu, h * A_H / 2),) * 2)
    )
    assert whole.uncertainty is not None
    assert halves.uncertainty is not None
    shares = [
        abs(getattr(whole, name) - getattr(halves, name))
        / (getattr(whole.uncertainty, name) + getattr(halves.uncertainty, name))
        for name in ("contact_radius", "approach", "peak_pressure")
    ]
    x = whole.contact_radius * np.array([-1.01, -1, -0.99, 0, 0.5, 1, 2])
    for z in (0.0, 0.2 * h * A_H, 0.5 * h * A_H, h * A_H):
        (first, U), (second, V) = (s.stress_with_uncertainty(x, 0.0, z) for s in (whole, halves))
        shares.append((np.abs(first - second) / (U + V)).max())
    return max(shares)


@pytest.mark.parametrize(
    ("ratio", "nu", "h"), [(1e-4, 0.4, 0.5), (0.1, 0.3, 0.02), (30.0, 0.2, 0.1), (1e4, 0.3, 5)]
)
def test_a_divided_coating_is_the_same_coating(ratio, nu, h):
    assert compared(ratio, nu, h) < 1


@pytest.mark.slow
@pytest.mark.parametrize("ratio", [1e-4, 1e-2, 0.3, 3.0, 1e2, 1e4])
@pytest.mark.parametrize("h", [0.005, 0.03, 0.2, 1.0, 5.0])
def test_a_divided_coating_is_the_same_coating_everywhere(ratio, h):
    assert compared(ratio, 0.3, h) < 1


def test_a_contact_as_wide_as_the_sphere_is_refused():
    with pytest.raises(ValueError, match=r"contact radius a = .* hold below 0\.9"):
        semianalytic.solve(radius=8e-3, load=3e5, coatings=((2.1e8, 0.3, 0.04),), substrate=STEEL)


@pytest.mark.slow
def test_a_stiff_film_on_a_thick_soft_layer_converges():
    s = semianalytic.solve(
        radius=8e-3, load=19.3, coatings=((1.035e13, 0.2, 4e-6), (4.14e9, 0.45, 1.6e-4)), substrate=STEEL
    )
    assert s.diagnostics.gap_inside < 1e-8
    assert s.diagnostics.load == pytest.approx(19.3, rel=1e-9)


def test_a_single_point_at_the_edge_has_an_uncertainty():
    s = semianalytic.solve(
        radius=R, load=W, coatings=(), substrate=STEEL, patches=65, estimate_uncertainty=True
    )
    sigma, U = s.stress_with_uncertainty(-s.contact_radius, 0.0, 0.0)
    assert sigma.shape == U.shape == (3, 3)
    # Johnson (1985) eq. 3.42c: (1 - 2 nu) p0 / 3 in tension at the edge
    assert abs(sigma[0, 0] - (1 - 2 * NU) / 3 * P_H) <= U[0, 0]


def test_uncertainty_of_the_stiffness_has_no_sign():
    fine, middle, coarse = contact((0.25, 0.25, 0.5))
    S = fine.stiffness
    middle, coarse = (one._replace(stiffness=S) for one in (middle, coarse))
    none, up, down = (
        of_stiffness([fine._replace(stiffness=S * (1 + e)), middle, coarse]) for e in (0.0, 1e-2, -1e-2)
    )
    assert up == pytest.approx(down, rel=1e-3)
    assert up > 2 * none


@pytest.mark.parametrize("share", [{}, {"share": 0.5}])
def test_change_that_is_small_by_chance_is_not_trusted(share):
    fine = {"contact_radius": 1.0, "approach": 2.0, "peak_pressure": 3.0}
    coarse = {name: value + 0.06 for name, value in fine.items()}
    found = Uncertainty.from_levels(fine, fine, coarse, {}, ratio=2.0, **share)
    assert found.peak_pressure == pytest.approx(share.get("share", 1 / 6) * 0.06)


def test_gap_of_the_sphere_lies_on_the_sphere():
    r = R * np.array([0.0, 1e-6, 0.1, 0.6, 1.0])
    gap = undeformed_gap("sphere", R)(r)
    assert (R - gap) ** 2 + r**2 == pytest.approx(np.full(5, R**2), rel=1e-15)
    assert gap[1] == pytest.approx(r[1] ** 2 / (2 * R), rel=1e-11, abs=0)
