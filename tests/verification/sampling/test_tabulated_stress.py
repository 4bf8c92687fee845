"""Stresses taken in one go are those taken point by point."""

import numpy as np
import pytest

from verification.problem.evaluation_points import Points
from verification.sampling.tabulated_solution import tabulated
from verification.sources.references.uniform_disc import solve_prescribed

COATINGS = ((4e9, 0.3, 0.2),)


class Counting:
    """A solution that counts how often its stresses are asked for."""

    def __init__(self, solution):
        self.solution, self.asked, self.asked_uncertainty = solution, 0, 0

    def __getattr__(self, name):
        return getattr(self.solution, name)

    def stress(self, x, y, z, layer=None):
        self.asked += 1
        return self.solution.stress(x, y, z, layer=layer)

    def stress_uncertainty(self, x, y, z, layer=None):
        self.asked_uncertainty += 1
        return self.solution.stress_uncertainty(x, y, z, layer=layer)


@pytest.fixture
def solution():
    return Counting(solve_prescribed(pressure=1e6, load_radius=0.15, coatings=COATINGS, substrate=(1e9, 0.4)))


def test_every_point_of_every_line_is_known_from_one_call_a_layer(solution):
    z = np.array([0.05, 0.2, 0.4])
    first = Points.of(0 * z, 0 * z, z, COATINGS, None, "m", 1.0)
    second = Points.of(0 * z + 0.1, 0 * z, z[::-1], COATINGS, None, "m", 1.0)
    table = tabulated(solution, [first, second, first])
    assert solution.asked == 2
    for at in (first, second):
        for layer in (0, 1):
            here = at.layer == layer
            place = (at.x[here], at.y[here], at.z[here])
            expected = solution.solution.stress(*place, layer=layer)
            assert table.stress(*place, layer=layer) == pytest.approx(expected, abs=1e-6)
            spread = solution.solution.stress_uncertainty(*place, layer=layer)
            assert table.stress_uncertainty(*place, layer=layer) == pytest.approx(spread, abs=1e-6)
    assert solution.asked == solution.asked_uncertainty == 2


def test_whatever_else_is_asked_goes_to_the_solution_itself(solution):
    at = Points.of(np.zeros(1), np.zeros(1), np.array([0.2]), COATINGS, 1, "m", 1.0)
    table = tabulated(solution, [at])
    assert table.approach == solution.approach
    for place, layer in (
        ((0.0, 0.0, 0.2), 1),
        ((np.zeros(1), np.zeros(1), np.array([0.2])), 0),
        ((0.0, 0.1, 0.3), None),
    ):
        expected = solution.solution.stress(*place, layer=layer)
        assert table.stress(*place, layer=layer) == pytest.approx(expected, abs=1e-9)
    # The side of the interface that was not asked for differs.
    sides = [table.stress(at.x, at.y, at.z, layer=layer)[0, 0, 0] for layer in (0, 1)]
    assert abs(sides[0] - sides[1]) > 1e4
