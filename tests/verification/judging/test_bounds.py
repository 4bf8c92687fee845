"""Bounds of invariants from known uncertainties, so that each part of them is seen by itself."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import pytest

from verification.judging.invariants.bonded_deformation import displacement_bound, hooke
from verification.judging.invariants.central_differences import Stencil
from verification.judging.verdict import Outcome
from verification.problem.coated_contact import CoatedContact
from verification.problem.point_answers import ByFunctions

E, NU, A, S = 210e9, 0.3, 1e-4, 1e6
BARE = CoatedContact(10e-3, 20.0, (), (E, NU))
E_STAR = E / (1 - NU**2)
STENCIL = Stencil(np.array([[0.1], [0.2], [0.5]]) * A, np.full((3, 1), 0.01 * A))


@dataclass(frozen=True)
class Uncertain(ByFunctions):
    """No displacement, a stress of ``ratio`` times its uncertainty, a pressure uncertain on a ring."""

    ratio: float = 1.0
    ring: tuple[float, float] = (0.0, 1.0)
    contact_radius: ClassVar[float] = A
    approach: ClassVar[float] = 1e-6

    def pressure(self, x, y):
        return np.zeros(np.shape(x))

    def displacement(self, x, y, z):
        return np.zeros((3, *np.shape(x)))

    def stress(self, x, y, z, layer=None):
        sigma = np.zeros((3, 3, *np.shape(x)))
        sigma[1, 1] = sigma[2, 2] = self.ratio * S
        return sigma

    def error(self, points, quantity, value):
        r = 0.0 if points is None else np.hypot(points.x, points.y) / A
        ring = np.where((r > self.ring[0]) & (r < self.ring[1]), S, 0.0)
        return {"stress": value / self.ratio, "pressure": ring}.get(quantity, 0.0)


@pytest.mark.parametrize(("ratio", "outcome"), [(1.9, Outcome.AGREES), (2.1, Outcome.DISAGREES)])
def test_hooke_allows_twice_the_uncertainty_of_lateral_stresses(ratio, outcome):
    """sigma_xx = 0, so that -nu sigma_kk, bounded by 2 nu U_kk, decides."""
    assert hooke(Uncertain(ratio), "known", BARE, 0, STENCIL).outcome is outcome


@pytest.mark.parametrize("ring", [(0.0, 1.0), (1.0, 1.1), (0.0, 1.1)])
def test_uncertain_pressure_on_a_ring_moves_the_centre_and_distant_points_as_a_load_does(ring):
    """u(0) = 2 p (b - a)/E*, and W/(pi E* r) far away, Johnson (3.24)."""
    zero, far = np.zeros(1), np.array([50 * A])
    low, high = np.array(ring) * A
    bound = displacement_bound(Uncertain(ring=ring), BARE, zero, zero, zero)
    assert bound == pytest.approx(2 * S * (high - low) / E_STAR, rel=1e-6, abs=0)
    bound = displacement_bound(Uncertain(ring=ring), BARE, far, zero, zero)
    assert bound == pytest.approx(S * (high**2 - low**2) / (E_STAR * far), rel=1e-3, abs=0)
