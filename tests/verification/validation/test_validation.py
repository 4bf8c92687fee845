"""Comparison with measurements: the standard's arithmetic, limits, a page that shows what was stored."""

import re

import numpy as np
import pytest

import semianalytic
from verification.validation import validation_page
from verification.validation.measured_modulus import data_sets, described, exported, table
from verification.validation.validation_metric import changed_stacks, exact_modulus, method_modulus, substrate

SILICA = next(one for one in data_sets() if one.name == "silica_on_silicon")


@pytest.fixture(scope="module")
def record():
    found = validation_page.shipped()
    assert found is not None
    return found


def test_exported_modulus_of_the_bare_wafer_is_the_stated_one():
    """The substrate's modulus follows from the data of the bare wafer, through the same tip."""
    area, bare = table("silica_on_silicon.csv"), table("bare_silicon.csv")
    rows = (bare["hc"] > area["hc"][1]) & (bare["hc"] < 500e-9)
    D = exported(bare["S"][rows], np.interp(bare["hc"][rows], area["hc"], area["a"]))
    assert abs(D.mean() - described()["substrate"]["modulus"]) < described()["substrate"]["u"]


def test_uncertainties_add_up_as_the_standard_says_and_the_interval_is_two_of_them(record):
    for one in record.sets:
        rows = one.measured.admitted
        np.testing.assert_allclose(one.E, np.array(one.S) / one.measured.D[rows] - 1)
        squares = [np.square(change) for change in one.inputs.values()]
        squares += [np.square(one.u_num), np.square(one.u_random), np.full(len(one.E), one.u_common**2)]
        np.testing.assert_allclose(one.u_val**2, np.sum(squares, axis=0))
        low, high = one.interval
        assert high - low == pytest.approx(4 * one.u_val.mean())
        assert (low + high) / 2 == pytest.approx(one.mean)


def test_stored_numbers_are_those_of_the_method_and_of_the_exact_solution(record):
    one = next(found for found in record.sets if found.name == SILICA.name)
    a, solid = SILICA.a[SILICA.admitted], (SILICA.coatings, substrate())
    S, U = method_modulus(a[7], solid, semianalytic.solve, patches=129)
    assert pytest.approx(one.S[7], rel=1e-9) == S
    assert abs(S - exact_modulus(a[7], solid)) < U
    name = "E of SiO2"
    up, down = changed_stacks(SILICA)[name]
    change = (exact_modulus(a[7], up) - exact_modulus(a[7], down)) / 2 / SILICA.D[SILICA.admitted][7]
    assert one.inputs[name][7] == pytest.approx(change)
    # both methods give the same modulus: no difference from the data is numerical
    assert all(abs(value / one.S[k] - 1) < 2e-5 for k, value in one.elements)
    assert len(one.elements) == 3


def test_common_formulas_go_from_the_film_to_the_substrate():
    for M in validation_page.common_formulas(np.array([1e-12, 1.0]), 1e-6, 70e9, 180e9, 0.2).values():
        assert pytest.approx([70e9, 180e9], rel=1e-4) == M
    (gao, bec) = validation_page.common_formulas(np.array([1e-6]), 1e-6, 70e9, 180e9, 0.2).values()
    # I_0 = 1/2 + (0.6 ln 2 - 1/2)/(1.6 pi); compliances 1/(pi M_f) + 1/(2 M_s) over 1/2 + 1/pi
    assert gao == pytest.approx(180e9 - 110e9 * (0.5 + (0.6 * np.log(2) - 0.5) / (1.6 * np.pi)))
    assert bec == pytest.approx((0.5 + 1 / np.pi) / (1 / (np.pi * 70e9) + 1 / (2 * 180e9)))


def test_page_shows_the_numbers_of_the_record_and_every_reason(record):
    text = validation_page.page(record)
    assert text.count('<svg class="print"') == sum(not one.measured.reason for one in record.sets)
    for entry in (*described()["set"], *described()["excluded"]):
        assert entry.get("reason", "") in text
    one = record.sets[0]
    rows = re.findall(r"<tr[^>]*>.*?</tr>", text, flags=re.DOTALL)
    first = next(row for row in rows if f"{one.S[0] / 1e9:.3f}" in row)
    assert f"{one.E[0] / one.u_val[0]:+.2f}" in first
    assert "not judged" in text
