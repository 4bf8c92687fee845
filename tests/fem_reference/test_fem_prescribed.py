"""Half-spaces under given pressures against closed forms."""

import numpy as np
import pytest

from fem_reference import solve_prescribed
from fem_reference.validation import GivenPressure
from verification.problem.point_answers import Points

E, NU = 210e9, 0.3
A, P = 1e-4, 1e9


@pytest.mark.parametrize("coatings", [(), ((E, NU, A / 3),) * 2], ids=["bare", "equal layers"])
def test_uniform_disc_follows_the_closed_form_on_the_axis(coatings):
    """Boussinesq's disc, K. L. Johnson, Contact Mechanics, (3.33) and (3.29a)."""
    s = solve_prescribed(
        pressure=P, load_radius=A, coatings=coatings, substrate=(E, NU), estimate_uncertainty=False
    )
    t = np.linspace(0, 3, 31)
    sigma = s.stress(0.0, 0.0, t * A)
    root = np.sqrt(1 + t**2)
    lateral = -((1 + 2 * NU) / 2 - (1 + NU) * t / root + t**3 / (2 * root**3))
    # order 1e-5 of the pressure at the default size, as for the sphere
    assert np.abs(sigma[2, 2] / P + 1 - t**3 / root**3).max() < 1e-4
    assert np.abs(sigma[0, 0] / P - lateral).max() < 1e-4
    assert s.approach == pytest.approx(2 * (1 - NU**2) * P * A / E, rel=5e-6)
    assert s.contact_radius == A
    assert s.peak_pressure == pytest.approx(P)


def test_response_is_linear_in_the_pressure():
    coatings = ((2 * E, NU, A / 2),)

    def cap(r):
        return P * (1 - (r / A) ** 2)

    one, two = (
        solve_prescribed(
            pressure=lambda r, factor=factor: factor * cap(r),
            load_radius=A,
            coatings=coatings,
            substrate=(E, NU),
            friction=0.2,
            size=0.5,
            order=2,
            estimate_uncertainty=False,
        )
        for factor in (1.0, 2.5)
    )
    x, z = np.linspace(-2, 2, 9) * A, 0.3 * A
    np.testing.assert_allclose(
        two.stress(x, 0.1 * A, z), 2.5 * one.stress(x, 0.1 * A, z), rtol=1e-9, atol=1e-9 * P
    )
    assert two.approach == pytest.approx(2.5 * one.approach, rel=1e-12, abs=0)
    x = np.linspace(-0.9, 0.9, 7) * A
    np.testing.assert_allclose(one.pressure(x), cap(np.abs(x)), rtol=1e-12)


def test_given_pressure_ends_at_the_load_radius_within_rounding():
    pressure = GivenPressure(lambda r: 6.0 + r, radius=2.0, scale=4.0)
    np.testing.assert_array_equal(pressure([0, 1, 1 + 5e-13, 1 + 1.5e-12, 2]), [1.5, 2, 2, 0, 0])


def test_given_pressure_carries_no_pressure_uncertainty():
    s = solve_prescribed(pressure=P, load_radius=A, coatings=(), substrate=(E, NU), quality="fast")
    assert np.all(s.sample(Points(np.linspace(0, 0.99, 5) * A), "pressure").uncertainty == 0)
    assert s.uncertainty.contact_radius == 0
    assert 0 < s.uncertainty.approach < 1e-3 * s.approach


@pytest.mark.parametrize(
    ("pressure", "says"),
    [
        (0.0, "pressure = 0.0"),
        (-P, "positive"),
        (lambda r: 0 * r, "zero"),
        (lambda r: np.full_like(r, np.nan), "finite"),
        (lambda r: 1.0 if r < A else 0.0, "numpy"),
    ],
)
def test_hopeless_pressures_are_refused_in_a_sentence(pressure, says):
    with pytest.raises(ValueError, match=says):
        solve_prescribed(pressure=pressure, load_radius=A, coatings=(), substrate=(E, NU))
