"""Exact layered half-space under a uniform disc against closed forms."""

import numpy as np
import pytest

from verification.problem.point_answers import Points
from verification.sources.references.uniform_disc import UniformDisc, solve_prescribed

Q, A = 2e6, 0.15
HALF_SPACE = {"pressure": Q, "load_radius": A, "coatings": (), "substrate": (1e9, 0.3)}
LAYERED = {
    "pressure": Q,
    "load_radius": A,
    "coatings": ((5e9, 0.35, 0.26), (2e8, 0.4, 0.5)),
    "substrate": (5e7, 0.45),
}


def test_axis_of_the_half_space_is_johnson_1985():
    # Johnson (3.33): sigma_z = -q [1 - z^3/(a^2 + z^2)^1.5], sigma_r with (1 + 2 nu)/2, (1 + nu), 1/2.
    z = A * np.array([0.0, 0.1, 0.5, 1.0, 3.0])
    found = solve_prescribed(**HALF_SPACE)
    sigma = found.stress(0.0, 0.0, z) / Q
    c = z / np.hypot(A, z)
    assert sigma[2, 2] == pytest.approx(-(1 - c**3), abs=1e-10)
    assert sigma[0, 0] == pytest.approx(-(1.6 / 2 - 1.3 * c + c**3 / 2), abs=1e-10)
    u = found.displacement(0.0, 0.0, z)[2]
    expected = Q * 1.3 / 1e9 * (A**2 / np.hypot(A, z) + 0.4 * (np.hypot(A, z) - z))
    assert u == pytest.approx(expected, rel=1e-10, abs=0)
    assert found.approach == pytest.approx(2 * Q * A * 0.91 / 1e9, rel=1e-12, abs=0)
    assert found.uncertainty.approach == found.sample(Points(0.0, 0.0, 0.0), "displacement").uncertainty[2]


def test_surface_outside_is_that_of_a_point_load_from_afar():
    # Boussinesq: u_z = P (1 - nu^2)/(pi E r), u_r = -P (1 - 2 nu)(1 + nu)/(2 pi E r).
    r = 50 * A
    u = solve_prescribed(**HALF_SPACE).displacement(0.0, r, 0.0)
    P = np.pi * A**2 * Q
    # The disc's own size is felt as (a/r)^2/8.
    assert u[2] == pytest.approx(P * 0.91 / (np.pi * 1e9 * r), rel=1e-4)
    assert u[:2] == pytest.approx([0.0, -P * 0.4 * 1.3 / (2 * np.pi * 1e9 * r)], rel=1e-12, abs=1e-20)
    rim = UniformDisc(A, Q).sink(np.array([A * (1 - 1e-9), A, A * (1 + 1e-9)]))
    # 4 q a / pi E* on the rim, from both sides.
    assert rim == pytest.approx(4 * Q * A / np.pi, rel=1e-6)


def test_sides_of_an_interface_differ_in_the_stress_along_it_alone():
    found = solve_prescribed(**LAYERED)
    z = LAYERED["coatings"][0][2]
    above, below = (found.stress(0.1, 0.0, z, layer=layer) / Q for layer in (0, 1))
    assert above[2] == pytest.approx(below[2], abs=1e-9)
    assert abs(above[0, 0] - below[0, 0]) > 0.1


def test_a_sliding_disc_is_refused():
    with pytest.raises(ValueError, match=r"friction = 0\.1"):
        solve_prescribed(**HALF_SPACE, friction=0.1)
