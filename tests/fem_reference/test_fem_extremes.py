"""Extreme solids: the contact is found within its uncertainty."""

import pytest

from fem_reference import solve
from verification.sources.references import integral_equation

STEEL, A_H = (210e9, 0.3), 88.7e-6  # contact radius of 20 N on a ball of 10 mm on steel, [m]


def coated(ratio, thickness=1.0, nu=0.3, substrate=STEEL, ball=None, layers=1):
    """Layers of ``ratio`` and 1 / ``ratio`` times that of steel in turn, of ``thickness`` a_h."""
    h = thickness * A_H / layers
    coatings = tuple((STEEL[0] * ratio ** (-1) ** k, nu, h) for k in range(layers))
    return {"radius": 10e-3, "load": 20.0, "coatings": coatings, "substrate": substrate, "ball": ball}


SOLIDS = {
    "E1/E2 = 0.01": coated(0.01),
    "E1/E2 = 0.01, thin": coated(0.01, 0.1),
    "E1/E2 = 100": coated(100.0),
    "E1/E2 = 1e4": coated(1e4),
    "nu = 0.4999": coated(0.5, nu=0.4999),
    "nu = 0.4999, thin": coated(0.5, 0.1, nu=0.4999),
    "nu = 0.4999 of the substrate": coated(2.0, substrate=(210e9, 0.4999)),
    "soft ball": coated(4.0, ball=(2.1e9, 0.4, ())),
    "coated ball": coated(4.0, 0.5, ball=(300e9, 0.25, ((600e9, 0.25, 0.3 * A_H),))),
    "20 layers": coated(2.0, layers=20),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", SOLIDS)
def test_extreme_solids_are_solved_within_their_uncertainty(name):
    found = solve(**SOLIDS[name])
    exact = integral_equation.solve(**SOLIDS[name])
    for quantity in ("contact_radius", "approach", "peak_pressure"):
        error = abs(getattr(found, quantity) - getattr(exact, quantity))
        # twice: an estimate from two meshes
        assert error <= 2 * getattr(found.uncertainty, quantity), quantity
