"""Questions of a coating designer as the manual asks them, against closed forms and by hand."""

from math import pi
from pathlib import Path

import numpy as np
import pytest

import verification
from verification.cases.case_file import parse_case
from verification.desk.case_wording import case_text
from verification.desk.contact_answer import answer
from verification.desk.layer_limits import layer_modes, strengths_of
from verification.manual.tour_output import QUESTIONS, SOURCE, commands
from verification.sampling.along_axis import AlongAxis
from verification.sources.references.hertz_ellipse import pressed_ellipsoid

FAST = {"estimate_uncertainty": False, "patches": 129}
STEEL = (210e9, 0.3)
SECTIONS = (SOURCE / "examples.md").read_text(encoding="utf-8").split("\n## ")


def stated(number, **changed):
    """The case of a question of the manual, but for what is ``changed``."""
    words, options = commands("examples")[number - 1][1:], {"coatings": []}
    pairs = [pair for word in words for pair in word.split("=", word.startswith("--temp"))]
    for option, value in zip(pairs[::2], pairs[1::2], strict=True):
        key = option.removeprefix("--").replace("-", "_")
        if key == "coating":
            options["coatings"].append(value)
        elif key != "plot":
            options[key] = float(value) if key in ("friction", "temperature_change") else value
    text = case_text(**{"ball": None, "load": None} | options | changed)
    return parse_case(text.encode(), Path("question"))


def asked(number, **changed):
    """The case with its answer."""
    case = stated(number, **changed)
    return case, answer(case.problem, "semianalytic", FAST, case.residual, case.layers)


def pressed(number, **changed):
    """The peak pressure alone."""
    return verification.solve(stated(number, **changed).problem, **FAST).peak_pressure


def on_page(number, value, unit):
    """``value``, as the page has it by hand."""
    shown = f"{value:.3g} {unit}" if abs(value) < 100 else f"{value:.0f} {unit}"
    assert shown in " ".join(SECTIONS[number].split())
    return value


def largest(found, quantity, where, body="flat"):
    return next(at for at in found.extremes if (at.body, at.quantity, at.where) == (body, quantity, where))


def p0(found):
    return found.numbers["peak_pressure"][0]


def hertz(radius, load, *solids):
    """Peak pressure and radius of Hertz for (E, nu) of both bodies."""
    E_star = 1 / sum((1 - nu**2) / E for E, nu in solids)
    a = (3 * load * radius / (4 * E_star)) ** (1 / 3)
    return 3 * load / (2 * pi * a * a), a


def test_every_question_of_the_page_has_its_answer_and_its_picture():
    assert len(SECTIONS) == len(commands("examples")) + 1 == len(QUESTIONS) + 1
    assert len(commands("tour")) == 1
    for number, text in enumerate(SECTIONS[1:], start=1):
        for part in (
            f"{{generated}} question_{number}\n",
            f"question_{number}.svg",
            f"question_{number}.png",
        ):
            assert part in text


def test_1_a_thin_film_of_dlc_on_chromium_takes_the_strain_of_its_steel():
    # h << a: the film has the surface's strain; at its base by Hooke from sigma of the bare steel,
    # sigma_rr = sigma_tt = -(1 + 2 nu)/2 p0 at the centre, where friction adds nothing, sigma_zz = -p0
    _, found = asked(1, coatings=["DLC 0.3 um", "Cr 100 nm"])
    pressure, _ = hertz(3e-3, 20.0, STEEL, STEEL)
    assert p0(found) == pytest.approx(on_page(1, pressure / 1e6, "MPa") * 1e6, rel=0.01)
    plane = -(1 + 2 * 0.3) / 2 * pressure
    strain = (plane - 0.3 * (plane - pressure)) / STEEL[0]
    E, nu = 150e9, 0.25
    film = E / (1 - nu) * strain - nu / (1 - nu) * pressure
    base = next(one for one in found.courses if (one.body, one.where) == ("flat", "base of coating 1"))
    assert base.stress[0][np.argmin(np.abs(base.x))] == pytest.approx(film, rel=0.05)


def test_2_a_scratch_with_a_diamond_tip_pulls_behind_it_as_the_closed_form_has_it():
    # bare: sigma_xx(-a) = p0 [(1 - 2 nu)/3 + (4 + nu) pi f/8], Hamilton (1983)
    _, found = asked(2, coatings=[])
    tension = hertz(200e-6, 5.0, (1141e9, 0.07), (220e9, 0.3))[0] * ((1 - 0.6) / 3 + 4.3 * pi * 0.1 / 8)
    at = largest(found, "sigma_xx", "surface")
    assert at.value == pytest.approx(on_page(2, tension / 1e6, "MPa") * 1e6, rel=2e-3)
    assert at.x == pytest.approx(-found.numbers["contact_radius"][0], rel=1e-3)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("number", "load", "along", "across"),
    [(3, 500.0, (4.7625e-3, 18.2e-3), (4.7625e-3, -4.9e-3)), (4, 200.0, (5e-3, np.inf), (0.5, np.inf))],
)
def test_3_4_a_bearing_and_a_roller_press_as_the_ellipse_of_hertz(number, load, along, across):
    R = [1 / sum(1 / r for r in bends) for bends in (along, across)]
    exact = pressed_ellipsoid(*R, load, *STEEL, STEEL)
    # a film of DLC that is thin beside both half axes
    found = verification.solve(stated(number).problem, estimate_uncertainty=False)
    assert found.peak_pressure == pytest.approx(on_page(number, exact.p0 / 1e6, "MPa") * 1e6, rel=0.01)
    for across, value in enumerate(sorted(exact.axes)):
        half = AlongAxis(found, across=bool(across)).contact_radius
        assert half == pytest.approx(on_page(number, value * 1e6, "µm") / 1e6, rel=0.01)


def test_3_a_bearing_yields_first_below_the_surface_as_johnson_has_it():
    # Johnson (1985) 3.4: tau_max = 0.310 p0 at z = 0.48 a, nu = 0.3; a round contact of the same ball
    _, found = asked(1, coatings=[], friction=0.0)
    pressure, a = hertz(3e-3, 20.0, STEEL, STEEL)
    shear = largest(found, "tau_max", "substrate")
    assert shear.value == pytest.approx(0.310 * pressure, rel=2e-3)
    assert shear.z == pytest.approx(0.48 * a, rel=0.02)


def test_5_mismatch_and_growth_are_added_to_the_stresses_of_the_contact():
    # E/(1 - nu) (12e-6 - 9.4e-6) times -400 K
    mismatch = on_page(5, 450e3 / 0.75 * 2.6e-6 * -400, "MPa")
    total = on_page(5, mismatch - 2000, "MPa") * 1e6
    _, with_stress = asked(5)
    words = {"substrate": "220 GPa, 0.3", "temperature_change": None}
    _, without = asked(5, coatings=["TiN 2 um, 450 GPa, 0.25"], **words)
    both = [largest(one, "sigma_xx", "surface") for one in (with_stress, without)]
    assert both[0].value == pytest.approx(both[1].value + total, rel=1e-6)


@pytest.mark.slow
def test_6_pairs_of_layers_press_as_the_one_film_that_they_make_up():
    # p0 of steel on 4 um follows the modulus of the film within 1 %
    E = 469, 400
    moduli = [2 / sum(1 / one for one in E), sum(E) / 2]
    ends = [pressed(6, coatings=[f"4 um, {one} GPa, 0.25"]) for one in moduli]
    assert f"{moduli[0]:.0f} and {moduli[1]:.0f} GPa" in SECTIONS[6]
    assert min(ends) * 0.995 < pressed(6) < max(ends) * 1.005


def test_7_a_sphere_of_five_micrometres_sinks_in_as_deep_as_its_approach_says():
    case, found = asked(7)
    assert found.numbers["approach"][0] == pytest.approx(20e-9, rel=1e-5)
    # the load lies between Hertz's on silica and on silicon
    diamond = (1 - 0.07**2) / 1141e9
    loads = [
        on_page(7, 4 / 3 / ((1 - nu**2) / E + diamond) * (5e-6 * (20e-9) ** 3) ** 0.5 * 1e6, "µN")
        for E, nu in ((72.7e9, 0.16), (162.6e9, 0.222))
    ]
    assert loads[0] < case.problem.load * 1e6 < loads[1]


@pytest.mark.parametrize(
    ("number", "radius", "load", "body"), [(8, 2e-3, 1.0, (100.6e9, 0.35)), (9, 2e-3, 5.0, STEEL)]
)
def test_8_9_gold_and_silver_yield_under_the_pressure_of_hertz(number, radius, load, body):
    case, found = asked(number)
    pressure, _ = hertz(radius, load, body, body)
    assert p0(found) == pytest.approx(on_page(number, pressure / 1e6, "MPa") * 1e6, rel=0.1)
    modes = layer_modes(case.problem, found, strengths_of(case.limits), loads=False)
    first = next(mode for mode in modes if mode.where == "coating 1")
    assert first.utilisation > 1


def test_10_a_thin_layer_of_ptfe_is_a_bed_of_springs():
    # Johnson (1985) 5.8: p = M (a^2 - r^2)/(2 R h), W = pi M a^4/(4 R h), M = E (1 - nu)/((1 + nu)(1 - 2 nu))
    E, nu, h, R, W = 0.5e9, 0.4, 20e-6, 3e-3, 5.0
    _, found = asked(10)
    M = E * (1 - nu) / ((1 + nu) * (1 - 2 * nu))
    a = (4 * R * h * W / (pi * M)) ** 0.25
    pressure = on_page(10, M * a * a / (2 * R * h) / 1e6, "MPa") * 1e6
    # the steel below gives way too: p0 of the bare steel is 1.1 GPa, and its share is about p0/p_h
    assert found.numbers["contact_radius"][0] == pytest.approx(a, rel=0.1)
    assert p0(found) == pytest.approx(pressure, rel=0.15)


def test_11_a_graded_film_lies_between_its_ends():
    assert on_page(11, hertz(3e-3, 20.0, STEEL, STEEL)[0] / 1e6, "MPa")
    ends = [pressed(11, coatings=[f"3 um, {E} GPa, 0.22"]) for E in (150, 300)]
    assert ends[0] < pressed(11) < ends[1]
