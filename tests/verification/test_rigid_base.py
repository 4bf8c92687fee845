"""Layers bonded to a rigid base: tables and approximations against the exact reference."""

import numpy as np
import pytest

import semianalytic
from verification.references import integral_equation
from verification.references.flat_punch import kappa
from verification.references.published import FOLDER, read_table

HAYES = read_table(FOLDER / "hayes_1972_flat_punch_kappa.csv")
CORRECTIONS = read_table(FOLDER / "thin_layer_corrections.csv")
RIGID = (1e9, 0.3)  # under layers of 1 Pa


def column(table, name):
    return np.array(table.numbers(name))


def test_hayes_1972_flat_punch_kappa():
    nu, ratio = column(HAYES, "nu"), column(HAYES, "a_over_h")
    found = np.array([kappa(r, ((1.0, n, 1.0),), RIGID) for n, r in zip(nu, ratio, strict=True)])
    # Half of the sixth decimal, in which the exact column is printed.
    assert np.abs(found - column(HAYES, "kappa_exact")).max() <= 0.5e-6 + 1e-9
    # The second-hand table is low by up to 0.9 %, as its notes say, and nowhere high by a printed digit.
    short = 1 - column(HAYES, "kappa_table_memory") / found
    assert short.max() == pytest.approx(0.009, abs=5e-4)
    assert short.min() >= -1e-3


def test_flat_punch_on_a_half_space_is_the_unit():
    assert kappa(1.0, (), (1.0, 0.3)) == 1.0
    assert kappa(1.0, ((1.0, 0.3, 0.7),), (1.0, 0.3)) == pytest.approx(1.0, abs=1e-12)
    # From a thick layer the base is felt as 1/h, from a thin one nothing but the base.
    thick = [kappa(1.0, ((1.0, 0.3, h),), RIGID) - 1 for h in (100.0, 200.0)]
    assert thick[0] == pytest.approx(2 * thick[1], rel=0.02)
    thin = [4 - kappa(1.0, ((1.0, 0.3, h),), (4.0, 0.3)) for h in (0.02, 0.01)]
    assert 0 < thin[1] < 0.6 * thin[0] < 0.2


def test_flat_punch_converges_in_every_knob():
    layer = ((1.0, 0.5, 1.0),)
    fine = kappa(2.0, layer, RIGID)
    assert kappa(2.0, layer, RIGID, nodes=40) == pytest.approx(fine, rel=1e-10)
    assert kappa(2.0, layer, RIGID, tail=30.0) == pytest.approx(fine, rel=1e-10)


def pressed(ratio):
    """Exact load and approach of a sphere on an incompressible layer, at the a/h asked for."""
    low, high = 1e-6, 1e2
    for _ in range(60):
        load = np.sqrt(low * high)
        found = integral_equation.solve(
            radius=100.0,
            load=load,
            coatings=((1.0, 0.5, 1.0),),
            substrate=RIGID,
            nodes=40,
            estimate_uncertainty=False,
        )
        low, high = (load, high) if found.contact_radius < ratio else (low, load)
    return load, found.approach


@pytest.mark.parametrize("ratio", ["0.2", "0.4", "0.6", "1.0"])
def test_corrections_for_thin_layers_err_as_their_notes_say(ratio):
    load, approach = pressed(float(ratio))
    X = np.sqrt(100.0 * approach)
    series = 1 + sum(column(CORRECTIONS, f"c{n}") * X**n for n in range(1, 5))
    formula = 4 / 3 / (1 - 0.25) * 10.0 * approach**1.5 * series
    stated = dict(zip(CORRECTIONS.text("model"), column(CORRECTIONS, f"r{ratio}"), strict=True))
    found = dict(zip(CORRECTIONS.text("model"), formula / load, strict=True))
    # The two that are made for a paraboloid on a bonded layer; half of their fourth decimal.
    for model in ("Dimitriadis2002_bonded", "Garcia2018_paraboloid_bonded"):
        assert found[model] == pytest.approx(stated[model], abs=5e-5), model


def test_semianalytical_sphere_on_an_incompressible_layer_is_exact():
    load = 1.0
    problem = {"radius": 100.0, "load": load, "coatings": ((1.0, 0.5, 1.0),), "substrate": (1e6, 0.3)}
    found = semianalytic.solve(**problem, estimate_uncertainty=False)
    exact = integral_equation.solve(**problem, estimate_uncertainty=False)
    # The accuracy asked of the method for approach and p0.
    assert found.approach == pytest.approx(exact.approach, rel=1e-5)
    assert found.peak_pressure == pytest.approx(exact.peak_pressure, rel=2e-5)
