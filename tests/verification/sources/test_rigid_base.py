"""Layers bonded to a rigid base: tables and approximations against the exact reference."""

from dataclasses import dataclass

import numpy as np
import pytest

from verification.cases.published_table import FOLDER, read_table
from verification.sources.references import flat_punch, integral_equation, solids_in_contact
from verification.sources.references.flat_punch import pressed

HAYES = read_table(FOLDER / "hayes_1972_flat_punch_kappa.csv")
RIGID = (1e9, 0.3)  # under layers of 1 Pa


def column(table, name):
    return np.array(table.numbers(name))


def kappa(*arguments, **options):
    return pressed(*arguments, **options).kappa


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
    assert kappa(1.0, (), (1.0, 0.3)) == pytest.approx(1.0, rel=1e-15)
    assert kappa(1.0, ((1.0, 0.3, 0.7),), (1.0, 0.3)) == pytest.approx(1.0, abs=1e-12)
    # From a thick layer the base is felt as 1/h, from a thin one nothing but the base.
    thick = [kappa(1.0, ((1.0, 0.3, h),), RIGID) - 1 for h in (100.0, 200.0)]
    assert thick[0] == pytest.approx(2 * thick[1], rel=0.02)
    thin = [4 - kappa(1.0, ((1.0, 0.3, h),), (4.0, 0.3)) for h in (0.02, 0.01)]
    assert 0 < thin[1] < 0.6 * thin[0] < 0.2


def by_formula(approach, coefficients):
    """Load of the corrections at h = 1, E = 1, nu = 1/2, R = 100."""
    X = np.sqrt(100.0 * approach)
    series = 1 + sum(c * X**n for n, c in enumerate(coefficients, start=1))
    return 4 / 3 / (1 - 0.25) * 10.0 * approach**1.5 * series


@dataclass(frozen=True)
class SlidingLayer:
    """Compliance of a layer free to slide on a rigid base: M = (cosh 2x - 1)/(sinh 2x + 2x), x = kh."""

    coatings: tuple
    substrate: tuple
    k: np.ndarray

    @property
    def compliance(self):
        x = np.minimum(self.k * self.coatings[0][2], 300.0)
        return 2 * np.sinh(x) ** 2 / (np.sinh(2 * x) + 2 * x)


@pytest.mark.parametrize(
    ("table", "column", "coefficients", "solid"),
    [
        ("dimitriadis_2002_corrections", "bonded", (1.133, 1.283, 0.769, 0.0975), None),
        ("dimitriadis_2002_corrections", "notbonded", (0.884, 0.781, 0.386, 0.0048), SlidingLayer),
        ("garcia_2018_corrections", "paraboloid", (1.133, 1.497, 1.469, 0.755), None),
    ],
)
def test_corrections_for_thin_layers_err_as_their_notes_say(monkeypatch, table, column, coefficients, solid):
    if solid is not None:
        monkeypatch.setattr(solids_in_contact, "LayeredHalfSpace", solid)
    table = read_table(FOLDER / f"{table}.csv")
    found = []
    for a in table.numbers("a_over_h"):
        exact = flat_punch.pressed(a, ((1.0, 0.5, 1.0),), RIGID)
        found.append(by_formula(exact.approach / 100, coefficients) / (exact.load / 100))
    # Half of their fourth decimal.
    assert found == pytest.approx(table.numbers(column), abs=5e-5)


def test_sphere_pressed_to_a_radius_is_the_sphere_under_its_load():
    for layer, base in ((((1.0, 0.5, 1.0),), RIGID), (((1.0, 0.3, 0.4), (5.0, 0.2, 1.0)), (2.0, 0.4))):
        found = flat_punch.pressed(0.8, layer, base)
        same = integral_equation.solve(
            radius=100.0, load=found.load / 100, coatings=layer, substrate=base, estimate_uncertainty=False
        )
        assert same.contact_radius == pytest.approx(0.8, rel=1e-9)
        assert same.approach == pytest.approx(found.approach / 100, rel=1e-9)
