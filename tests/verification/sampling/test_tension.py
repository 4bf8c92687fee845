"""The largest tension of the surface: closed forms at the edge, smooth maxima beside it, no zone left out."""

from itertools import chain

import numpy as np
import pytest
from synthetic_results import contact

from verification.cases.case_file import read_case, shipped_cases
from verification.judging.standard_claims import standard_claims
from verification.problem.line_profile import lines_of
from verification.problem.point_answers import ByFunctions, Points
from verification.problem.quantity import PEAKS
from verification.sampling import largest_tension
from verification.sampling.largest_tension import Search, Tension, edge_uncertainty
from verification.sampling.line_sampling import sample
from verification.sources.exact_sources import solve_exactly
from verification.sources.references.hertz import Hertz

STEEL, NU = 210e9, 0.3


def largest(solution, problem) -> Tension:
    search = Search(solution, problem)
    sigma, U = solution.sample(Points(search.x, layer=0), "stress")
    return search.largest(sigma[0, 0], None if U is None else U[0, 0])


@pytest.mark.parametrize("f", [0.0, 0.05, 0.25, 0.8])
@pytest.mark.parametrize("nu", [0.0, 0.3, 0.45])
def test_tension_of_hamilton_peaks_at_the_trailing_edge(f, nu):
    problem = contact(substrate=(STEEL, nu), friction=f)
    exact = Hertz(problem.radius, problem.load, STEEL, nu, f)
    found = largest(exact, problem)
    # Johnson (3.43), Hamilton (1983)
    expected = exact.peak_pressure * ((1 - 2 * nu) / 3 + f * np.pi * (4 + nu) / 8)
    assert found.value == pytest.approx(expected, rel=1e-12)
    assert found.place == -exact.contact_radius
    assert found.uncertainty == found.place_uncertainty == 0


# A soft coating keeps the peak at the edge; a stiff one bends, and has it beside the edge unless it slides.
SOLIDS = [
    (0.25, 1.0, 0.0),
    (0.25, 0.1, 0.25),
    (4.0, 1.0, 0.0),
    (4.0, 0.1, 0.0),
    (4.0, 0.1, 0.5),
    (30.0, 0.03, 0.0),
]


@pytest.mark.parametrize(("ratio", "h", "f"), SOLIDS)
def test_no_place_of_a_dense_line_exceeds_the_largest_tension(ratio, h, f):
    problem = contact((ratio * STEEL, NU, h), friction=f)
    exact = solve_exactly(problem)
    found = largest(exact, problem)
    a, p0 = exact.contact_radius, exact.peak_pressure
    line = a * np.linspace(-12, 12 if f else 0, 1501)
    x = np.concatenate([line, -a * (1 + np.geomspace(1e-9, 0.3, 200)), [-a, a]])
    sigma = exact.stress(x, 0.0, 0.0, layer=0)[0, 0]
    assert found.value >= sigma.max() - 1e-10 * p0
    assert found.value == pytest.approx(sigma.max(), abs=1e-3 * p0)
    assert 0 < found.uncertainty < 1e-8 * p0
    at_edge = abs(found.place) == a
    assert at_edge == (f > 0 or ratio < 1)
    if not at_edge:  # the slope vanishes there, to the error that the place states
        step = 1e-4 * a
        low, here, high = exact.stress(found.place + step * np.array([-1, 0, 1]), 0.0, 0.0, layer=0)[0, 0]
        curvature = (2 * here - low - high) / step**2
        assert curvature > 0
        assert abs(high - low) / (2 * step * curvature) < 1e-6 * a
        assert found.place_uncertainty < 1e-6 * a


def test_peaks_are_numbers_of_the_contact():
    problem = contact((4 * STEEL, NU, 0.5), friction=0.25)
    exact = solve_exactly(problem)
    line = lines_of(problem)[0]
    x = exact.contact_radius * np.linspace(-2, 2, 9)
    found = {
        p.quantity: p for p in sample(exact, "integral_equation", line, x, problem) if p.line == "contact"
    }
    wanted = largest(exact, problem)
    assert tuple(found) == PEAKS
    assert [float(p.value[0]) for p in found.values()] == [wanted.value, wanted.place]
    # the peak lies at the edge
    assert wanted.place_uncertainty == exact.uncertainty.contact_radius
    assert all(p.position.shape == (9,) for p in sample(exact, "integral_equation", line, x))


def test_no_shipped_claim_leaves_a_zone_out():
    shipped = [read_case(path) for path in shipped_cases().values()]
    for claim in chain.from_iterable(case.claims for case in shipped):
        assert claim.edge == 0
    alone = [case for case in shipped if not case.numerics["semianalytic"].get("edge_correction", True)]
    assert [case.name for case in alone] == ["30_patches_alone"]  # the largest tension is at its staircase
    for case in (one for one in shipped if one not in alone):
        peaks = [claim.between for claim in case.claims if claim.quantity in PEAKS]
        assert len(peaks) == 2 * len({claim.between for claim in standard_claims(case.problem)})


def test_the_uncertainty_at_the_edge_is_beside_it_plus_what_no_change_of_the_radius_explains():
    value, U = np.array([1.0, 0.7, 0.8, 1.1, 0.8]), np.array([0.5, 0.1, 0.12, 0.3, 0.3])
    assert edge_uncertainty(value, U, None) == pytest.approx(0.5 - 0.2)
    assert edge_uncertainty(value[[0, 1, 2, 4, 3]], U, None) == pytest.approx(0.5 - 0.2)
    assert edge_uncertainty(value, U - [0.25, 0, 0, 0, 0], None) == pytest.approx(0.12)
    assert edge_uncertainty(value, U, np.array(0.02)) == pytest.approx(0.14)


class Waving(ByFunctions):
    """A maximum of sigma_xx at x = -``middle`` a, with waves on it that the companion has elsewhere."""

    contact_radius, peak_pressure = 1e-4, 1e9

    def __init__(self, phase=0.0, coarser=None, middle=2.0):
        self.phase, self.coarser, self.middle = phase, coarser, middle

    def stress(self, x, y, z, layer=None):
        r = np.abs(np.asarray(x)) / self.contact_radius
        sigma = np.zeros((3, 3, *r.shape))
        sigma[0, 0] = 1e9 * (np.exp(-(((r - self.middle) / 0.4) ** 2)) + 1e-5 * np.cos(20 * r + self.phase))
        return sigma

    def error(self, points, quantity, value):
        return np.full_like(value, 2e6) if quantity == "stress" else 1e-12


def test_place_of_a_smooth_maximum_is_the_least_uncertain_one_with_its_distance_from_the_next(monkeypatch):
    solution, problem = Waving(1.0, Waving()), contact()
    found = largest(solution, problem)
    single = set()  # two of three fits keep as many terms here
    for fit in largest_tension.FITS:
        monkeypatch.setattr(largest_tension, "FITS", np.array([fit]))
        single.add(largest(solution, problem))
    best, other = sorted(single, key=lambda one: one.place_uncertainty)
    assert other.place_uncertainty > 2 * best.place_uncertainty
    assert found.place == best.place
    assert found.uncertainty == 2e6
    apart = abs(best.place - other.place)
    assert apart > best.place_uncertainty
    assert found.place_uncertainty == pytest.approx(best.place_uncertainty + apart, rel=1e-9, abs=0)
    assert abs(found.place + 2 * solution.contact_radius) < found.place_uncertainty


def test_place_may_be_the_edge_where_it_is_as_large_and_that_edge_is_uncertain():
    solution = Waving(1.0, Waving(middle=1.02), middle=1.02)
    found, a, U_a = largest(solution, contact()), solution.contact_radius, 1e-12
    assert found.place < -a
    assert abs(found.place + a) + U_a <= found.place_uncertainty < 1.1 * abs(found.place + a)
