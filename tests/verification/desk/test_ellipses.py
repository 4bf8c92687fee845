"""Answers for bodies that are no balls: half axes, p0 and largest stresses of an ellipse, of both bodies."""

import csv
from pathlib import Path

import numpy as np
import pytest
from quick_case import coatcheck

from verification.cases.case_file import parse_case
from verification.cases.toml_file import CaseError
from verification.desk.case_wording import case_text
from verification.desk.contact_answer import answer
from verification.sampling.along_axis import AlongAxis
from verification.sources.exact_sources import hertz
from verification.sources.source_registry import solvers

STEEL = "210 GPa, 0.3"


def case_of(radii, against=None, ball=STEEL, friction=0.0, coatings=(), load="100 N"):
    text = case_text(
        ball, load, STEEL, coatings, friction, coatings if ball else (), radii=radii, against=against
    )
    return parse_case(text.encode(), Path("options"))


def solved(*words, numerics=None, **more):
    case = case_of(*words, **more)
    return case.problem, answer(case.problem, "semianalytic", numerics)


def stress(found, quantity, body="flat"):
    (at,) = [at for at in found.extremes if (at.quantity, at.body, at.where) == (quantity, body, "surface")]
    return at


@pytest.mark.slow
def test_a_ball_in_its_race_has_hertzs_half_axes_and_johnsons_tension():
    """Ball of 9.525 mm of a 6206 on its inner ring: pitch circle 46 mm, groove of 52 % of the ball.

    K. L. Johnson, Contact Mechanics, 1985, section 4.2: sigma_r = -sigma_t at the ends, of both bodies.
    """
    problem, found = solved("4.7625 mm, 4.7625 mm", "18.2375 mm, -4.953 mm")
    exact = hertz(problem)
    assert found.numbers["peak_pressure"][0] == pytest.approx(exact.peak_pressure, rel=1e-5)
    for name, axis in zip(("half_axis_x", "half_axis_y"), exact.axes, strict=True):
        value, U = found.numbers[name]
        assert value == pytest.approx(axis, rel=1e-5)
        assert abs(value - axis) <= U
    b, a = sorted(exact.axes)
    e, nu = np.sqrt(1 - (b / a) ** 2), problem.substrate[1]
    scale = (1 - 2 * nu) * exact.peak_pressure * b / (a * e**2)
    ends = {
        "sigma_yy": scale * (np.arctanh(e) / e - 1),
        "sigma_xx": scale * (1 - b / (a * e) * np.arctan(e * a / b)),
    }
    for body in ("flat", "ball"):
        for quantity, expected in ends.items():
            at = stress(found, quantity, body)
            assert abs(at.value - expected) <= max(at.uncertainty, 1e-5 * exact.peak_pressure)
        at = stress(found, "sigma_yy", body)
        assert (at.x, abs(at.y)) == (0.0, pytest.approx(a, rel=1e-4))


@pytest.mark.parametrize(
    ("radii", "against", "load", "ratio"),
    [("460 mm, flat", "flat, 254 mm", "100 kN", 1.5), ("5 mm, 470 mm", "20 mm, flat", "100 N", 20.0)],
    ids=["wheel on rail", "barrel on ring"],
)
def test_wheel_and_barrel_are_hertz(radii, against, load, ratio):
    problem = case_of(radii, against, load=load).problem
    exact, found = hertz(problem), solvers()["semianalytic"](problem, {})
    assert exact.a / exact.b == pytest.approx(ratio, rel=0.02)
    value, U = found.sample(None, "peak_pressure")
    assert abs(value - exact.peak_pressure) <= U <= 1e-5 * value
    for axis, across in zip(exact.axes, (False, True), strict=True):
        value, U = AlongAxis(found, across=across).sample(None, "contact_radius")
        assert abs(value - axis) <= U <= 1e-4 * value


def test_the_gap_alone_counts():
    """A ball on a flat as one body and as two; radii of the gap by 1/R = 1/R_1 + 1/R_2."""
    one = case_of("6 mm, 3 mm").problem
    two = case_of("4 mm, 2 mm", "-12 mm, -6 mm").problem
    np.testing.assert_allclose(two.indenter[1], one.indenter[1], rtol=1e-15)
    assert case_of("6 mm, 3 mm", "flat, flat").problem == one
    assert case_of("flat, 3 mm", "6 mm, flat").problem == one


@pytest.mark.slow
def test_exchanging_the_axes_exchanges_the_stresses():
    fast = {"patches": 65, "accuracy": None, "estimate_uncertainty": False}
    given = {"coatings": ["20 um, 420 GPa, 0.25"], "ball": None, "numerics": fast}
    (_, one), (_, other) = (solved(radii, **given) for radii in ("6 mm, 3 mm", "3 mm, 6 mm"))
    p0, a = (one.numbers[name][0] for name in ("peak_pressure", "contact_radius"))
    places = {(at.quantity, at.where): at for at in one.extremes}
    assert len(places) == len(one.extremes)
    for at in other.extremes:
        exchanged = (
            at.quantity.translate(str.maketrans("xy", "yx")) if "sigma_" in at.quantity else at.quantity
        )
        same = places[exchanged.replace("zy", "yz").replace("zx", "xz"), at.where]
        assert abs(at.value - same.value) <= 1e-4 * p0
        if not np.isnan(at.x):
            assert (abs(at.x), abs(at.y)) == pytest.approx((abs(same.y), abs(same.x)), abs=5e-3 * a)


@pytest.mark.parametrize(
    ("words", "named"),
    [
        (["--radii", "5 mm"], "--radii"),
        (["--radii", "5 mm, 0"], "radii, value 2"),
        (["--radii", "5 mm, flat"], "along y"),
        (["--radii", "5 mm, 5 mm", "--against", "20 mm, -4 mm"], "along y"),
        (["--radii", "5 mm, 5 mm", "--ball", "10 mm, 210 GPa, 0.3"], "--ball with --radii"),
        (["--radii", "5 mm, 5 mm", "--ball-coating", "1 um, 200 GPa, 0.3"], "--ball"),
        (["--roller", "R = 5 mm"], '"R = 5 mm, crown 2 m"'),
        (["--roller", "R = 5,5 mm, crown 2 m"], "decimals with a point"),
        (["--roller", "R = 5 mm, crown flat"], "give a crown"),
        (["--roller", "R = 5 mm, crown 25 m"], "factor of 5e+03"),
        (["--roller", "d = 10 apples, crown 2 m"], "'apples'"),
        (["--roller", "R = 5 mm, crown 2 m", "--radii", "5 mm, 2 m"], "give one"),
    ],
)
def test_radii_without_meaning_are_refused_in_one_line(words, named, tmp_path):
    done = coatcheck("solve", *words, "--load", "5 N", "--substrate", STEEL, cwd=tmp_path)
    assert done.returncode == 2
    assert named in done.stderr
    assert done.stderr.count("\n") == 1
    assert done.stdout == ""


@pytest.mark.parametrize(
    "words", ["R = 5 mm, crown 2 m", "5 mm, 2 m", "d = 10 mm, crown R = 2 m", "D 0.01, crown 2"]
)
def test_a_roller_is_a_body_with_two_radii(words):
    one, other = (
        case_text(STEEL, "5 N", STEEL, against="20 mm, flat", **{name: text})
        for name, text in (("roller", words), ("radii", "5 mm, 2 m"))
    )
    one, other = (parse_case(text.encode(), Path("options")).problem for text in (one, other))
    assert one == other


def test_radii_of_the_other_body_belong_to_an_ellipsoid():
    text = case_text("10 mm", "5 N", STEEL).replace(
        'radius = "10 mm"',
        'radius = "10 mm"\nindenter = { shape = "asperities", distance = 1e-4, against = [1.0, 1.0] }',
    )
    with pytest.raises(CaseError, match="asperities"):
        parse_case(text.encode(), Path("mine.toml"))


def test_solve_shows_the_half_axes_and_places_in_both_planes(tmp_path, environment):
    environment(COLUMNS="100")
    words = ("--radii", "8 mm, 3 mm", "--load", "20 N", "--substrate", STEEL, "--csv", "all.csv")
    done = coatcheck("solve", *words, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    rows = [line.split() for line in done.stdout.splitlines()]
    assert [row[0] for row in rows if row and row[0] in ("a_x", "a_y")] == ["a_x", "a_y"]
    (head,) = [row for row in rows if row[:2] == ["largest", "place"]]
    assert [word for word in head if word in "xyz"] == ["x", "y", "z"]
    assert "R_x = 8 mm, R_y = 3 mm" in done.stdout
    assert "y = 0 and x = 0" in done.stdout
    with (tmp_path / "all.csv").open(encoding="utf-8") as file:
        cells = {(row["quantity"], row["place"]): row for row in csv.DictReader(file)}
    assert cells["half_axis_x", "contact"]["unit"] == "m"
    edge = float(cells["half_axis_y", "contact"]["value"])
    assert abs(float(cells["sigma_yy", "surface"]["y [m]"])) == pytest.approx(edge, rel=1e-3)
