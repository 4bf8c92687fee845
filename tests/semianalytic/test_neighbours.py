"""Stiffness of a round contact by contacts at neighbouring loads."""

from dataclasses import replace

import numpy as np
import pytest

from semianalytic import solve
from semianalytic.numbers import STEPS
from semianalytic.patches.neighbours import Neighbours

E, NU, R, W = 210e9, 0.3, 10e-3, 20.0


@pytest.fixture(scope="module")
def beside() -> Neighbours:
    coatings = ((3 * E, NU, 30e-6),)
    solution = solve(radius=R, load=W, coatings=coatings, substrate=(E, NU), patches=129, accuracy=None)
    return solution.neighbours


def with_loose_edges(monkeypatch, sizes):
    """On grids of ``sizes`` patches a side an edge is left a tenth of a patch from where it rests."""
    pressed = Neighbours._pressed

    def _pressed(self, level):
        found = pressed(self, level)
        if level.grid.n not in sizes:
            return found
        (low, high), *further = found
        off = replace(low.found, approach=low.found.approach * (1 - 3e-6))
        return [[replace(low, found=off, unsettled=0.1 * low.grid.d), high], *further]

    monkeypatch.setattr(Neighbours, "_pressed", _pressed)


def test_a_grid_where_an_edge_does_not_rest_gives_no_stiffness(beside, monkeypatch):
    finest, next_one, *_ = (level.grid.n for level in beside.levels)
    on_next = replace(beside, levels=beside.levels[1:]).stiffness
    with_loose_edges(monkeypatch, {finest})
    assert finest > next_one
    assert replace(beside).stiffness == on_next


def test_where_no_edge_rests_the_stiffness_is_uncertain_by_them(beside, monkeypatch):
    at_rest, known = replace(beside).stiffness
    with_loose_edges(monkeypatch, {level.grid.n for level in beside.levels})
    stiffness, uncertainty = replace(beside).stiffness
    assert known < abs(stiffness - at_rest) < uncertainty


def test_neighbours_are_known_no_better_than_their_own_grid(beside):
    """Whose approach the finest grid shows to be off by 1e-6: errors beside it need not be alike."""
    off = replace(beside, approach=beside.approach * (1 + 1e-6))
    stiffness, uncertainty = off.stiffness
    assert uncertainty > beside.stiffness[1]
    assert uncertainty / stiffness > 1e-6 / np.log1p(STEPS[0])
