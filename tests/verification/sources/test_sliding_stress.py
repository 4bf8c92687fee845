"""Stress under the first harmonic of a sliding contact: shifted fields, limits, the edge of the contact."""

from dataclasses import dataclass, replace

import numpy as np
import pytest

from verification.problem.coated_contact import CoatedContact
from verification.sources.assumptions.sliding_coupling import SlidingExpansion, first_harmonic
from verification.sources.references import integral_equation
from verification.sources.references.axisymmetric_pressure import AbelPressure

E, NU = 210e9, 0.3
BARE = CoatedContact(10e-3, 20.0, (), (E, NU))
A = BARE.a_h
COATINGS = ((4 * E, 0.2, 0.3 * A), (E / 2, 0.4, 0.2 * A))


@dataclass(frozen=True)
class Shifted:
    """-dp/dx of an axisymmetric pressure p: the harmonic p1 = -dp/dr, phat1 = k phat."""

    of: AbelPressure

    @property
    def a(self):
        return self.of.a

    def transform(self, k):
        return k * self.of.transform(k)


@pytest.mark.parametrize(("z", "layer"), [(0.2, 0), (0.4, 1), (0.7, 2)])
@pytest.mark.parametrize("coatings", [(), COATINGS], ids=["bare", "two coatings"])
def test_a_shifted_pressure_gives_the_shifted_field(coatings, z, layer):
    layer = layer if coatings else 0
    exact = [
        integral_equation.solve(
            radius=10e-3,
            load=20.0,
            coatings=coatings,
            substrate=(E, NU),
            friction=f,
            estimate_uncertainty=False,
        )
        for f in (0.0, 1.0)
    ]
    x, step = np.array([-1.2, -0.3, 0.5, 1.7]) * A, 1e-3 * A
    fields = first_harmonic(Shifted(exact[0].abel), coatings, (E, NU), x, z * A, layer)

    def slope(f):
        right, left = (exact[f].stress(x + side * step, 0.0, z * A, layer) for side in (1, -1))
        return -(right - left)[0, [0, 2]] / (2 * step)

    normal = slope(0)
    for found, expected in zip(fields, (normal, slope(1) - normal), strict=True):
        # central differences: step^2/6 times third derivatives
        assert np.abs(np.array(found) - expected).max() * A < 1e-4 * BARE.p_h


def test_surface_outside_the_contact_continues_the_field_below():
    problem = replace(BARE, coatings=COATINGS)
    first = SlidingExpansion(problem).first
    x, step = np.array([-2.0, -1.4, 1.5]) * first.a, 0.02 * first.a
    surface = first_harmonic(first, COATINGS, (E, NU), x, 0.0, 0)
    depths = [first_harmonic(first, COATINGS, (E, NU), x, n * step, 0) for n in (1, 2, 3)]
    for number in (0, 1):
        at = [np.array(depth[number]) for depth in depths]
        extrapolated = 3 * at[0] - 3 * at[1] + at[2]
        # quadratic: step^3 = 8e-6 times third derivatives of order 10
        assert np.abs(extrapolated - np.array(surface[number])).max() < 1e-4 * BARE.p_h


def test_uncoated_edge_has_the_closed_moment():
    first, beta = SlidingExpansion(BARE).first, BARE.dundurs_beta
    # the centre of pressure -3 beta a/(2 pi) less that of the contact, times W/pi
    assert first.moment == pytest.approx(-beta * first.a * BARE.load / (2 * np.pi**2), rel=1e-10)
    trailing, _ = first_harmonic(first, (), (E, NU), np.array([-first.a]), 0.0, 0)
    expected = (1 - 2 * NU) * beta * BARE.load / (2 * np.pi**2 * first.a**2)
    assert trailing.xx[0] == pytest.approx(expected, rel=1e-10)
