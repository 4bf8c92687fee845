"""Maps of what the assumptions cost: as shipped, as measured today, read between their nodes."""

import re
from dataclasses import astuple, replace

import numpy as np
import pytest
from assumption_maps_made.map_axes import MEASURED, MapAxes
from assumption_maps_made.measuring import assembled, measure

from verification.commands.common.known_folders import RECORDS
from verification.credibility.model_error import ASSUMPTIONS, QUANTITIES, Assumption, model_error
from verification.evidence.assumption_maps import AssumptionMaps, Place, places_of, read_maps
from verification.problem.coated_contact import CoatedContact
from verification.running.case_result import RunInfo
from verification.sources.assumptions.contact_change import Change

INFO = RunInfo("python tests/tools assumptions", "2026-11-22", 1.0, 1, None, "a machine", {})


@pytest.fixture(scope="module")
def maps():
    return read_maps(RECORDS)


def test_shipped_maps_hold_every_place(maps):
    for name, stated in MEASURED.items():
        found = maps.of(name)
        assert {axis.name: axis.values for axis in found.axes} == stated.all_axes
        assert found.title == ASSUMPTIONS[name].title
        assert found.change.shape == (len(QUANTITIES), *map(len, stated.all_axes.values()))


@pytest.mark.parametrize(
    ("name", "index"),
    [("sphere", 150), ("goodman", 220), ("bodies", 60), pytest.param("strains", 20, marks=pytest.mark.slow)],
)
def test_shipped_entries_are_those_measured_today(maps, name, index):
    place, stored = list(MEASURED[name].places())[index], maps.of(name)
    today = measure(name, place)
    assert today.change == pytest.approx(stored.change.reshape(len(QUANTITIES), -1)[:, index], rel=1e-3)
    expected = stored.uncertainty.reshape(len(QUANTITIES), -1)[:, index]
    assert today.uncertainty == pytest.approx(expected, rel=1e-3)


# Of 60 random places of each map 95 and 93 % of the values of a quantity are covered, of most all; of 40 with
# h < a_h/5 of the map of small strains all, with at most 0.75 of the uncertainty.
BETWEEN = [
    ("sphere", Place(0.16, 0.7, 0.3, 0.05, 0.2)),
    ("goodman", Place(3.0, 1.4, 0.25, friction=0.45)),
    ("bodies", Place(0.7, 0.3, width=0.15)),
    ("strains", Place(6.07, 0.58, 0.318, width=0.152)),
    ("strains", Place(6.07, 0.031, 0.25, width=0.06)),
    ("strains", Place(0.16, 0.014, 0.3, width=0.15)),
    ("strains", Place(3.5, 0.15, 0.3, width=0.05)),
]


@pytest.mark.parametrize(
    ("name", "place"),
    [pytest.param(*one, marks=[pytest.mark.slow] * (one[0] == "strains")) for one in BETWEEN],
)
def test_uncertainty_between_nodes_covers_what_is_measured_there(maps, name, place):
    problem = place.problem
    (value, U), (expected, beyond) = (
        np.array([astuple(one) for one in both])
        for both in (maps.of(name).at(problem), MEASURED[name].change(problem))
    )
    assert (np.abs(value - expected) <= U + beyond).all()
    assert (0.5 * np.abs(value).max() > U).all()


def _power(problem):
    """A stand-in for a slow model: a power of the width, products of the others; nothing for thick films."""
    place = places_of(problem)[0]
    if place.thickness > 1.5:
        raise ValueError("thick")
    size = (
        place.width**1.5 * (1 + np.log(place.ratio) ** 2) * (1 + place.nu) * np.log(10 * place.thickness + 1)
    )
    return Change(size, -size, 2 * size, 3 * size, None), Change(0.1 * size, 0.0, 0.0, 0.0, None)


@pytest.fixture
def slow(monkeypatch):
    """The assumption ``slow`` with its map."""
    axes = {"ratio": (0.1, 0.5, 1.0, 4.0), "thickness": (0.1, 0.3, 1.0, 2.0), "width": (0.01, 0.1, 0.3)}
    stated = MapAxes(_power, {**axes, "nu": (0.2, 0.4)}, rates={"width": 1.5})
    monkeypatch.setitem(ASSUMPTIONS, "slow", Assumption("slowness"))
    monkeypatch.setitem(MEASURED, "slow", stated)
    found = [measure("slow", place) for place in stated.places()]
    return AssumptionMaps((assembled("slow", found, INFO),))


def test_map_is_exact_at_its_nodes_and_to_its_error_between(slow):
    for place in [Place(0.5, 0.3, 0.2, 0.1), Place(4.0, 1.0, 0.4, 0.3)]:
        value, U = slow.of("slow").at(place.problem)
        assert value.approach == pytest.approx(_power(place.problem)[0].approach, rel=1e-4)
        assert U.approach <= 1e-4 * abs(value.approach)
        assert U.contact_radius == pytest.approx(0.1 * value.contact_radius, rel=1e-3)
    for place in [Place(0.2, 0.2, 0.3, 0.05), Place(3.0, 0.9, 0.25, 0.02)]:
        value, U = slow.of("slow").at(place.problem)
        assert abs(value.approach - _power(place.problem)[0].approach) <= U.approach < 2 * abs(value.approach)


def test_below_the_axis_of_a_rate_the_change_vanishes_with_it(slow):
    place = Place(0.5, 0.3, 0.2, 0.001)
    value, _ = slow.of("slow").at(place.problem)
    assert value.peak_pressure == pytest.approx(_power(place.problem)[0].peak_pressure, rel=1e-4)


def test_two_poissons_ratios_are_read_at_both_with_half_of_the_range_as_uncertainty(slow):
    one = Place(1.0, 0.3, 0.2, 0.1).problem
    E, _, h = one.coatings[0]
    mixed = replace(one, coatings=((E * (1 - 0.16) / (1 - 0.04), 0.4, h),))
    (low, _), (high, _), (value, U) = (
        slow.of("slow").at(p) for p in (one, Place(1.0, 0.3, 0.4, 0.1).problem, mixed)
    )
    assert value.approach == pytest.approx((low.approach + high.approach) / 2)
    assert U.approach == pytest.approx(abs(high.approach - low.approach) / 2, rel=1e-3)


def test_friction_leaves_the_scalars_of_a_map_without_it(slow):
    value, _ = slow.of("slow").at(replace(Place(0.5, 0.3, 0.2, 0.1).problem, friction=0.3))
    assert value.approach is not None
    assert value.tension is None


INSIDE = Place(0.5, 0.3, 0.2, 0.1).problem


@pytest.mark.parametrize(
    ("problem", "reason"),
    [
        (Place(0.5, 0.3, 0.2, 0.4).problem, "a_h/R = 0.4"),
        (Place(20.0, 0.3, 0.2, 0.1).problem, "E1/E2 = 20"),
        (Place(0.5, 2.0, 0.2, 0.1).problem, "problem"),
        (Place(0.5, 0.3, 0.2, 0.1, ball=0.5).problem, "E*/E_ball* = 0.5"),
        (replace(INSIDE, coatings=INSIDE.coatings * 2), "coatings"),
        (replace(INSIDE, ball=(2e11, 0.3, ((1e11, 0.3, 1e-3),))), "coated"),
    ],
)
def test_problem_outside_the_map_is_missing_with_the_reason(slow, problem, reason):
    with pytest.raises(ValueError, match=re.escape(reason)):
        slow.of("slow").at(problem)


BARE = CoatedContact(INSIDE.radius, INSIDE.load, (), INSIDE.substrate)


def test_assumption_without_an_answer_is_missing_with_the_reason(slow):
    missing = dict(model_error(BARE, AssumptionMaps(())).missing)
    assert set(missing) == {one.title for one in ASSUMPTIONS.values() if one.change is None}
    wide = replace(BARE, load=1e4 * BARE.load)
    assert "0.3" in dict(model_error(wide, slow).missing)["slowness"]


def test_uncoated_problem_is_read_without_shear(slow):
    costs = {cost.quantity for cost in model_error(BARE, slow).costs if cost.assumption == "slowness"}
    assert costs == {"contact_radius", "approach", "peak_pressure", "tension"}
