"""Error of the model itself: which assumption dominates where, what is missing, the sentence."""

from dataclasses import replace

import pytest

from verification.credibility.model_error import (
    ASSUMPTIONS,
    GOODMAN,
    HALF_SPACES,
    PARABOLA,
    SMALL_STRAINS,
    Cost,
    ModelError,
    model_error,
)
from verification.problem.coated_contact import CoatedContact

BARE = CoatedContact(10e-3, 20.0, (), (210e9, 0.3))


def test_friction_dominates_a_small_sliding_contact_and_the_bodies_a_wide_still_one():
    sliding, wide = model_error(replace(BARE, friction=0.3)), model_error(replace(BARE, load=2e6))
    assert sliding.largest().assumption == GOODMAN
    assert sliding.largest().quantity == "tension"
    assert wide.largest().assumption == HALF_SPACES
    assert wide.largest(["contact_radius"]).assumption == PARABOLA


def test_message_states_size_and_assumption_of_scalars_and_of_stresses():
    found = model_error(replace(BARE, friction=0.3)).message()
    assert "5.7 %" in found
    assert found.index(HALF_SPACES) < found.index(GOODMAN)


def test_contact_as_wide_as_the_sphere_has_no_cost_of_the_parabola_nor_of_the_bodies():
    error = model_error(replace(BARE, load=1e9))
    assert [assumption for assumption, _ in error.missing] == [PARABOLA, HALF_SPACES, SMALL_STRAINS]
    assert "carried" in error.missing[0][1]
    assert {cost.assumption for cost in error.costs} == {GOODMAN}


def test_no_assumption_has_a_cost_under_an_indenter_that_is_no_sphere():
    error = model_error(replace(BARE, radius=0.02, indenter=("ellipsoid", (1e-2, 4e-2))))
    assert not error.costs
    assert [assumption for assumption, _ in error.missing] == [one.title for one in ASSUMPTIONS.values()]


def test_uncertainty_counts_in_the_comparison_of_costs():
    small, sure = Cost(GOODMAN, "approach", 0.01, 0.05), Cost(PARABOLA, "approach", -0.03, 0.0)
    assert ModelError((small, sure)).largest() is small


def test_assumption_that_dominates_nowhere_is_named_with_its_largest_cost():
    costs = Cost(GOODMAN, "tension", 0.05, 0.0), Cost(HALF_SPACES, "approach", 0.01, 0.0)
    less = Cost(SMALL_STRAINS, "approach", 0.001, 0.001), Cost(SMALL_STRAINS, "shear", -0.004, 0.0)
    nothing = Cost(PARABOLA, "approach", 1e-9, 0.0)
    small, missing = ModelError((*costs, *less, nothing), ((PARABOLA, "why"),)).notes
    assert all(part in small for part in ("0.4 %", SMALL_STRAINS))
    assert all(part in missing for part in (PARABOLA, "why"))


def test_stresses_that_a_model_without_friction_does_not_have_are_missing():
    still, sliding = (dict(model_error(replace(BARE, friction=f)).missing) for f in (0.0, 0.3))
    assert any(name.startswith(SMALL_STRAINS) for name in sliding)
    assert not still


@pytest.mark.parametrize("friction", [0.0, 0.5])
def test_terms_beyond_the_expansion_vanish_without_friction(friction):
    costs = model_error(replace(BARE, friction=friction)).costs
    uncertainty = {cost.uncertainty for cost in costs if cost.assumption == GOODMAN}
    assert (uncertainty == {0.0}) is (friction == 0)
