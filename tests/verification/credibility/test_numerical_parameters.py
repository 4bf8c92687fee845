"""Ladders of the numerical parameters: of a made-up solver whose error is known, and of both methods."""

from dataclasses import replace

import numpy as np
import pytest

from verification.credibility.accuracy_study import BARE, COATED
from verification.credibility.parameter_sweeps import PARAMETERS, stated, study, sweep
from verification.sources.references.hertz import Hertz
from verification.sources.source_record import NumericalParameter

EXACT = Hertz(BARE.radius, BARE.load, *BARE.substrate)
KNOB = NumericalParameter(
    "semianalytic", "patch size", tuple((f"N = {n}", {"patches": n}, 1 / n) for n in (8, 16, 32, 64))
)


class Off:
    """Hertz with every number off by 1/patches^2 of its scale, and stating ``times`` as much."""

    def __init__(self, patches, times):
        e = self._e = 1 / patches**2
        self.peak_pressure, self.contact_radius, self.approach = (
            v * (1 + e) for v in (EXACT.peak_pressure, EXACT.contact_radius, EXACT.approach)
        )
        self._times = times
        self.uncertainty = self
        self.budget = (("approach", "patch size", times * e * EXACT.approach),)

    def pressure(self, x, y=0.0):
        return EXACT.pressure(x, y) + self._e * BARE.p_h

    def stress(self, x, y, z, layer=None):
        return EXACT.stress(x, y, z, layer) + self._e * BARE.p_h

    def pressure_uncertainty(self, x, y=0.0):
        return np.full(np.shape(x), self._times * self._e * BARE.p_h)

    def stress_uncertainty(self, x, y, z, layer=None):
        return np.full((3, 3, *np.shape(x)), self._times * self._e * BARE.p_h)


def off(_, numerics=None, times=3.0):
    patches = (numerics or {}).get("patches", 64)
    if patches > 64:
        raise ValueError("too fine for this machine; take fewer patches")
    return Off(patches, times)


def test_ladder_of_a_second_order_method_gives_its_order_and_brackets_its_error():
    refinement = sweep(BARE, KNOB, BARE.a_h, off)
    assert refinement.failure is None
    assert len(refinement.values) == 8
    for name in refinement.values:
        found = refinement.estimate(name)
        assert found.order == pytest.approx(2, abs=1e-3)
        assert 1 / 64**2 <= found.uncertainty <= 1.3 / 64**2


def test_level_that_fails_ends_the_ladder_with_its_sentence():
    longer = replace(KNOB, levels=(*KNOB.levels, ("N = 128", {"patches": 128}, 1 / 128)))
    refinement = sweep(BARE, longer, BARE.a_h, off)
    assert refinement.levels == ("N = 8", "N = 16", "N = 32", "N = 64")
    assert refinement.failure.startswith("N = 128: ")
    none = sweep(BARE, replace(KNOB, levels=longer.levels[4:]), BARE.a_h, off)
    assert none.estimate("p0") is None


def test_stated_uncertainty_stands_beside_the_true_error_on_one_scale():
    found = stated(BARE, "semianalytic", off, EXACT)
    assert found.error["approach"] == pytest.approx(1 / 64**2)
    assert found.error["pressure, r = 0.6 a"] == pytest.approx(1 / 64**2)
    assert found.uncertainty["sigma_zz, axis, z = 2 a"] == pytest.approx(3 / 64**2)
    assert found.budget == (("approach", "patch size", pytest.approx(3 / 64**2)),)


def test_every_knob_but_the_order_of_elements_has_four_levels_or_more():
    assert {parameter.name for parameter in PARAMETERS if len(parameter.levels) < 4} == {"element order"}
    assert all(np.all(np.diff([step for *_, step in parameter.levels]) < 0) for parameter in PARAMETERS)


@pytest.mark.slow
@pytest.mark.parametrize(
    "problem",
    [
        BARE,
        replace(COATED, friction=0.25),
        replace(BARE, coatings=((250e9, 0.2, 0.3 * BARE.a_h), (110e9, 0.3, 0.3 * BARE.a_h))),
    ],
    ids=["uncoated", "sliding", "two coatings"],
)
def test_stated_and_fitted_uncertainties_hold_the_true_error(problem):
    refinements, found = study(problem, "solid")
    assert [one.failure for one in refinements if one.failure] == []
    for one in found:
        assert {name for name, error in one.error.items() if error > one.uncertainty[name]} == set()
        if not any(refinement.method == one.method for refinement in refinements):
            continue
        fitted = {
            name: sum(
                refinement.estimate(name).uncertainty
                for refinement in refinements
                if refinement.method == one.method and refinement.parameter != "element order"
            )
            for name in one.error
        }
        assert {name for name, error in one.error.items() if error > fitted[name]} == set()
