"""Proven enclosures: the exact reference, both methods and the published tables lie in them."""

import csv
from unittest import mock

import pytest
from enclosures_made.enclosed_problems import problems

import fem_reference
import semianalytic
from verification.cases.published_table import FOLDER
from verification.credibility.self_tests.known_verdicts import COATED, ROUNDING, distances
from verification.evidence.enclosure_record import SHIPPED, WIDTH, read_record
from verification.problem.coated_contact import keywords
from verification.sources.references import integral_equation
from verification.sources.references.layered_half_space import LayeredHalfSpace

RECORD = read_record(SHIPPED)
ALL = {one.name: one for one in RECORD.enclosures}


def test_every_problem_is_enclosed_as_narrowly_as_required():
    assert {name: one.problem for name, one in ALL.items()} == problems()
    assert len(ALL) >= 24
    for one in ALL.values():
        assert len(one.bounds) == (6 if one.coatings else 4)
        assert max(bounds.width for bounds in one.bounds) <= WIDTH


def test_the_exact_reference_lies_in_every_enclosure():
    outside = []
    for name, one in ALL.items():
        exact = integral_equation.solve(**keywords(one.problem))
        # the largest pressure is the one that is enclosed
        assert exact.peak_pressure == pytest.approx(exact.pressure(0.0), rel=1e-12)
        for bounds, distance, U in distances(one, exact):
            # its own U holds, and an enclosure of the required width contains the value
            if distance > min(U, WIDTH / 2 * abs(bounds.middle)):
                outside.append((name, bounds.quantity, bounds.line, distance / abs(bounds.middle)))
    assert outside == []


@pytest.mark.parametrize("name", COATED)
def test_a_fault_of_the_kernel_of_one_in_a_billion_is_noticed(name):
    right = LayeredHalfSpace.compliance.fget

    def wrong(self):
        return 1 + (1 + 1e-9) * (right(self) - 1)

    one = ALL[name]
    with mock.patch.object(LayeredHalfSpace, "compliance", property(wrong)):
        exact = integral_equation.solve(**keywords(one.problem))
    assert any(distance > ROUNDING * abs(bounds.middle) for bounds, distance, _ in distances(one, exact))


def test_published_pressures_lie_in_the_enclosed_profiles():
    ratios = {"E0.5": "ratio_0.5_h_1", "E1": "same_material", "E2": "ratio_2_h_1"}
    with open(FOLDER / "coated_sphere_exact_pressure_h_equals_a0.csv", newline="") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    for column, name in ratios.items():
        one = ALL[name]
        p_h, a_h = one.problem.p_h, one.problem.a_h
        assert len(rows) == len(one.profile) == 27
        for row, ring in zip(rows, one.profile, strict=True):
            assert ring.r / a_h == pytest.approx(float(row["r_over_a0"]))
            # half of the last published digit
            for bound in (ring.lower, ring.upper):
                assert float(bound) / p_h == pytest.approx(float(row[column]), abs=5.01e-7)


@pytest.mark.slow
@pytest.mark.parametrize("solve", [semianalytic.solve, fem_reference.solve])
@pytest.mark.parametrize("name", ALL)
def test_the_uncertainty_of_both_methods_reaches_the_enclosures(solve, name):
    one = ALL[name]
    outside = [
        (bounds.quantity, bounds.line, distance, U)
        for bounds, distance, U in distances(one, solve(**keywords(one.problem)))
        if not distance <= U
    ]
    assert outside == []
