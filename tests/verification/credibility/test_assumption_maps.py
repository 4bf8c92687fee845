"""Maps of what the assumptions cost: as shipped, as measured today, between them the stated rates."""

import numpy as np
import pytest

from verification.commands.common.folders import RECORDS
from verification.credibility.model.error import GOODMAN, PARABOLA
from verification.credibility.model.maps import QUANTITIES, measure, places, read_maps


@pytest.fixture(scope="module")
def maps():
    return read_maps(RECORDS)


def test_shipped_maps_hold_every_place(maps):
    for assumption in (PARABOLA, GOODMAN):
        held = [entry.place for entry in maps.entries if entry.assumption == assumption]
        assert held == list(places(assumption))
    values = np.array([(entry.change, entry.uncertainty) for entry in maps.entries])
    assert values.shape[1:] == (2, len(QUANTITIES))
    assert np.isfinite(values).all()


@pytest.mark.parametrize("index", [150, 500])
def test_shipped_entries_are_those_measured_today(maps, index):
    stored = maps.entries[index]
    today = measure(stored.assumption, stored.place)
    assert today.change == pytest.approx(stored.change, rel=1e-3)
    assert today.uncertainty == pytest.approx(stored.uncertainty, rel=1e-3)


def test_parabola_costs_the_square_of_the_contact_radius_all_over_the_map(maps):
    costs = {entry.place: np.array(entry.change) for entry in maps.entries if entry.assumption == PARABOLA}
    for place, change in costs.items():
        if place.width == 0.003:
            wider = next(
                costs[other] for other in costs if other.width == 0.03 and _beside(other) == _beside(place)
            )
            scalars = slice(0, 3)
            assert np.log10(wider[scalars] / change[scalars]) == pytest.approx(2.0, rel=0.05)


def _beside(place):
    return place.ratio, place.thickness, place.nu, place.friction
