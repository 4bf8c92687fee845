"""Edge profile of the pressure against closed forms."""

import numpy as np
import pytest

from semianalytic.edge_profile import Profile


@pytest.mark.parametrize("t", np.linspace(0.2, 0.8, 13))
def test_peak_is_the_ring_of_highest_pressure(t):
    """sqrt(t) - t^(3/2) / (3 t_0) is largest at t = t_0, where it is 2 sqrt(t_0) / 3."""
    c = 1 / (3 * t)
    peak = Profile(1e-4, np.array([1 - c / 2, -c / 2])).peak
    missed = 2 / 3 * np.sqrt(t) - peak
    # by no more than half a step of the finer grid, 1e-6 a, from a ring of curvature -2 (1 - t) / t^(3/2)
    assert -1e-15 <= missed <= (1 - t) / t**1.5 * 1e-12 * (1 + 1e-3)
