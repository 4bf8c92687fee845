"""Questions of a coating designer, in the words of the command line, against closed forms and by hand."""

from math import pi
from pathlib import Path

import numpy as np
import pytest

from verification.cases.case_file import parse_case
from verification.desk.case_wording import case_text
from verification.desk.contact_answer import answer
from verification.desk.layer_limits import layer_modes, strengths_of

FAST = {"estimate_uncertainty": False, "patches": 129}


def asked(ball, load, substrate, coatings=(), friction=0.0, **more):
    """The case with its answer."""
    text = case_text(ball, load, substrate, coatings, friction, **more)
    case = parse_case(text.encode(), Path("question"))
    return case, answer(case.problem, "semianalytic", FAST, case.residual, case.layers)


def largest(found, quantity, where, body="flat"):
    return next(at for at in found.extremes if (at.body, at.quantity, at.where) == (body, quantity, where))


def p0(found):
    return found.numbers["peak_pressure"][0]


def hertz(radius, load, *solids):
    """Peak pressure and radius of Hertz for (E, nu) of both bodies."""
    E_star = 1 / sum((1 - nu**2) / E for E, nu in solids)
    a = (3 * load * radius / (4 * E_star)) ** (1 / 3)
    return 3 * load / (2 * pi * a * a), a


STEEL = (210e9, 0.3)


def test_a_bearing_yields_first_below_the_surface_as_johnson_has_it():
    # Johnson (1985) 3.4: tau_max = 0.310 p0 at z = 0.48 a, nu = 0.3
    _, found = asked("100Cr6 d = 12.7 mm", "50 N", "100Cr6")
    pressure, a = hertz(6.35e-3, 50.0, STEEL, STEEL)
    assert p0(found) == pytest.approx(pressure, rel=1e-4)
    shear = largest(found, "tau_max", "substrate")
    assert shear.value == pytest.approx(0.310 * pressure, rel=2e-3)
    assert shear.z == pytest.approx(0.48 * a, rel=0.02)


def test_a_thin_film_of_dlc_on_chromium_takes_the_strain_of_its_steel():
    # h << a: the film has the surface's strain; in its middle by Hooke from sigma of the bare steel,
    # sigma_rr = sigma_tt = -(1 + 2 nu)/2 p0 at the centre, sigma_zz = -p0
    _, found = asked("100Cr6 d = 6 mm", "20 N", "100Cr6", ["DLC 0.3 um, strength 1 GPa", "Cr 100 nm"])
    pressure, _ = hertz(3e-3, 20.0, STEEL, STEEL)
    assert p0(found) == pytest.approx(pressure, rel=0.01)
    plane = -(1 + 2 * 0.3) / 2 * pressure
    strain = (plane - 0.3 * (plane - pressure)) / STEEL[0]
    E, nu = 150e9, 0.25
    film = E / (1 - nu) * strain - nu / (1 - nu) * pressure
    base = next(one for one in found.courses if (one.body, one.where) == ("flat", "base of coating 1"))
    assert base.stress[0][np.argmin(np.abs(base.x))] == pytest.approx(film, rel=0.05)


def test_a_scratch_with_a_diamond_tip_pulls_behind_it_as_the_closed_form_has_it():
    # bare: sigma_xx(-a) = p0 [(1 - 2 nu)/3 + (4 + nu) pi f/8], Hamilton (1983)
    _, found = asked("diamond 200 um", "5 N", "220 GPa, 0.3", friction=0.1)
    tension = p0(found) * ((1 - 0.6) / 3 + 4.3 * pi * 0.1 / 8)
    at = largest(found, "sigma_xx", "surface")
    assert at.value == pytest.approx(tension, rel=2e-3)
    assert at.x == pytest.approx(-found.numbers["contact_radius"][0], rel=1e-3)


def test_mismatch_and_growth_are_added_to_the_stresses_of_the_contact():
    # E/(1 - nu) (12e-6 - 9e-6) times -400 K = -720 MPa for 450 GPa, 0.25
    words = "TiN 2 um, 450 GPa, 0.25, residual -1 GPa, expansion 9e-6"
    options = {"friction": 0.2, "substrate": "220 GPa, 0.3, expansion 12e-6"}
    _, with_stress = asked("6 mm", "10 N", coatings=[words], temperature_change=-400.0, **options)
    _, without = asked("6 mm", "10 N", "220 GPa, 0.3", ["TiN 2 um, 450 GPa, 0.25"], 0.2)
    both = [largest(one, "sigma_xx", "surface") for one in (with_stress, without)]
    assert both[0].value == pytest.approx(both[1].value - 1.72e9, rel=1e-6)


@pytest.mark.slow
def test_twenty_layers_press_as_the_one_film_that_they_make_up():
    # series and parallel moduli of TiN 450 and CrN 250 GPa differ by 9 %; p0 follows either within 1 %
    layers = ["10 x (TiN 100 nm, 450 GPa, 0.25 / CrN 100 nm, 250 GPa, 0.25)"]
    _, stack = asked("6 mm", "20 N", "210 GPa, 0.3", layers)
    ends = [
        p0(asked("6 mm", "20 N", "210 GPa, 0.3", [f"2 um, {E} GPa, 0.25"])[1])
        for E in (2 / (1 / 450 + 1 / 250), (450 + 250) / 2)
    ]
    assert min(ends) * 0.995 < p0(stack) < max(ends) * 1.005


def test_a_sphere_of_five_micrometres_sinks_in_as_deep_as_its_approach_says():
    case, found = asked("5 um", None, "Si", ["SiO2 500 nm"], approach="10 nm")
    assert found.numbers["approach"][0] == pytest.approx(10e-9, rel=1e-5)
    # the load lies between Hertz's on silica and on silicon
    loads = [
        4 / 3 * E / (1 - nu**2) * (5e-6 * (10e-9) ** 3) ** 0.5 for E, nu in ((72.7e9, 0.16), (162.6e9, 0.222))
    ]
    assert loads[0] < case.problem.load < loads[1]


def test_a_gold_contact_yields_and_silver_too():
    for words, strength in (("Au 1 um, yield 0.2 GPa", 0.2e9), ("Ag 1 um, yield 0.1 GPa", 0.1e9)):
        case, found = asked("100Cr6 d = 4 mm", "5 N", "100Cr6", [words], friction=0.02)
        (mode,) = layer_modes(case.problem, found, strengths_of(case.limits), loads=False)
        pressure, a = hertz(2e-3, 5.0, STEEL, STEEL)
        assert a > 40 * 1e-6
        assert p0(found) == pytest.approx(pressure, rel=0.02)
        # squeezed between steel it has its plane strain; at least a fifth of p0 is left as von Mises stress
        assert mode.utilisation == pytest.approx(mode.stress / strength)
        assert mode.utilisation > 1


def test_a_thin_layer_of_ptfe_is_a_winkler_foundation():
    # Johnson (1985) 5.8: p = M (a^2 - r^2)/(2 R h), W = pi M a^4/(4 R h), M = E (1 - nu)/((1 + nu)(1 - 2 nu))
    E, nu, h, R, W = 0.5e9, 0.3, 2e-6, 3e-3, 5.0
    _, found = asked("3 mm", "5 N", "100Cr6", [f"PTFE 2 um, 0.5 GPa, {nu}"])
    M = E * (1 - nu) / ((1 + nu) * (1 - 2 * nu))
    a = (4 * R * h * W / (pi * M)) ** 0.25
    pressure = M * a * a / (2 * R * h)
    # the steel below gives way too: p0 of the bare steel is 1.7 GPa, and its share is about p0/p_h
    assert found.numbers["contact_radius"][0] == pytest.approx(a, rel=0.1)
    assert p0(found) == pytest.approx(pressure, rel=0.15)


def test_a_graded_film_lies_between_its_ends():
    film = '{ thickness = 10e-6, nu = 0.2, layers = 8, E = { course = "linear", top = 2e11, base = 1e11 } }'
    text = case_text("3 mm", "20 N", "210 GPa, 0.3", [], 0.1).replace("coatings = []", f"coatings = [{film}]")
    case = parse_case(text.encode(), Path("graded"))
    graded = p0(answer(case.problem, "semianalytic", FAST, None, case.layers))
    ends = [p0(asked("3 mm", "20 N", "210 GPa, 0.3", [f"10 um, {E} GPa, 0.2"], 0.1)[1]) for E in (100, 200)]
    assert ends[0] < graded < ends[1]
