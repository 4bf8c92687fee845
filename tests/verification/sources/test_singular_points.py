"""Points where a prescribed pressure jumps have no stress, in no source, and are not judged."""

from functools import partial

import numpy as np
import pytest

import fem_reference
import semianalytic
from verification.cases.published_file import read_published
from verification.judging.outcome import Outcome
from verification.problem.point_answers import Points
from verification.running.published_run import run
from verification.sources.references import uniform_disc

A = 0.1
SOLID = {"load_radius": A, "coatings": (), "substrate": (1e9, 0.3)}
METHODS = [semianalytic.solve_prescribed, partial(fem_reference.solve_prescribed, quality="fast")]
PUBLISHED = """
title = "Pressure of a disc, its rim included"
source = "the definition of the load"
year = 2026
[problem]
length_unit = "m"
stress_unit = "Pa"
pressure = 1e6
load_radius = 0.1
substrate = { E = 1e9, nu = 0.3 }
[[table]]
file = "rim.csv"
seen = "recomputed"
read = "here"
at = { x = "r", unit = "a" }
column = [{ name = "szz", quantity = "sigma_zz", unit = "q" }]
"""


@pytest.mark.parametrize("friction", [0.0, 0.5])
@pytest.mark.parametrize("solve", [*METHODS, uniform_disc.solve_prescribed])
def test_the_rim_of_a_uniform_disc_has_displacements_but_no_stress(solve, friction):
    if friction and solve is uniform_disc.solve_prescribed:
        pytest.skip("the reference has no friction")
    s = solve(pressure=1e6, **SOLID, friction=friction)
    turn = np.linspace(0, 2 * np.pi, 7)
    x, y = A * np.cos(turn), A * np.sin(turn)
    assert np.isnan(s.stress(x, y, 0.0)).all()
    assert np.isnan(s.sample(Points(x, y), "stress").uncertainty).all()
    assert np.isnan(s.sample(Points(x, y), "pressure")).all()
    assert np.isfinite(s.sample(Points(x, y), "displacement")).all()
    r = A * np.array([0.0, 1 - 1e-6, 1 + 1e-6, 1.0])
    assert np.isfinite(s.stress(r, 0.0, [0.0, 0.0, 0.0, 1e-3 * A])).all()


@pytest.mark.parametrize("solve", METHODS)
def test_a_pressure_that_vanishes_at_its_rim_has_stresses_there(solve):
    s = solve(pressure=lambda r: 1e6 * np.sqrt(np.maximum(1 - (r / A) ** 2, 0)), **SOLID, friction=0.3)
    assert s.singular_radii == ()
    assert np.isfinite(s.stress(A, 0.0, 0.0)).all()


@pytest.mark.parametrize("solve", METHODS)
def test_pressures_that_no_method_resolves_are_refused_by_name(solve):
    step, inner, outer = 0.3 * A, 1.0, 0.4
    with pytest.raises(ValueError, match=r"jumps at r = 0\.03 m"):
        solve(pressure=lambda r: np.where(r < step, inner, outer), **SOLID)
    with np.errstate(divide="ignore"), pytest.raises(ValueError, match="finite"):
        solve(pressure=lambda r: 1 / np.sqrt(np.maximum(1 - (r / A) ** 2, 0)), **SOLID)
    # the advice of the message: two loads, whose fields add
    parts = [solve(pressure=inner - outer, **SOLID | {"load_radius": step}), solve(pressure=outer, **SOLID)]
    found = sum(one.stress(0.0, 0.0, step) for one in parts)[2, 2]
    c = step / np.hypot(step, [step, A])  # Johnson (3.33) of either disc
    assert found == pytest.approx(-((inner - outer) * (1 - c[0] ** 3) + outer * (1 - c[1] ** 3)), rel=1e-4)


@pytest.mark.parametrize(
    ("rows", "outcome"), [("0.5,-1.0000\n1,-0.5000\n2,0.0000\n", "AGREES"), ("1,-0.5000\n", "NO_RESULT")]
)
def test_a_published_value_on_the_rim_is_named_and_not_judged(tmp_path, rows, outcome):
    (tmp_path / "rim.csv").write_text("# of the definition\nr,szz\n" + rows)
    (tmp_path / "rim.toml").write_text(PUBLISHED)
    result = run(read_published(tmp_path / "rim.toml"))
    assert {verdict.outcome for _, verdict in result.verdicts} == {Outcome[outcome]}
    assert all("on the rim of the load" in verdict.reason for _, verdict in result.verdicts)
    if outcome == "AGREES":
        assert all(verdict.judged.points == 2 for _, verdict in result.verdicts)
