"""Critical loads: exact where h/a_h has no part, similarity of contacts, strengths that scatter."""

from pathlib import Path

import numpy as np
import pytest
from synthetic_solves import STUDY

from verification.cases.toml_file import CaseError
from verification.problem.coated_contact import CoatedContact
from verification.study.choice.critical_load import Critical, Ramp, critical, ramps
from verification.study.choice.failure_criteria import Criteria, Uniform
from verification.study.largest_stresses import QUANTITIES
from verification.study.pages.load_page import answers, write_load_report
from verification.study.study_plan import parse_study
from verification.study.study_point import answer, table_rows
from verification.study.study_table import read_columns, write_table

LOADS = STUDY.replace("load = 20.0", "").replace(
    "cross_check = 5", "cross_check = 0\nload = { from = 4, to = 30, count = 5 }"
)
BALL = "ball = { E = 210e9, nu = 0.3, coatings = [{ E = 1e11, nu = 0.3, thickness = 1e-6 }] }\n"
EQUAL = """
title = "Equal moduli"
[problem]
radius = 10e-3
substrate = { E = 210e9, nu = 0.3 }
coating = { E = 210e9, nu = 0.3 }
[sweep]
load = { from = 5.0, to = 80.0, count = 4 }
thickness = [5e-5]
friction = [0.0, 0.25]
cross_check = 0
[semianalytic]
patches = 33
estimate_uncertainty = false
[criteria.strength]
sigma_xx_surface = "1 GPa"
von_mises_substrate = { from = "0.6 GPa", to = "0.9 GPa" }
"""


def power_law(load, residual=0.0, factor=1e8):
    """A ramp of a homogeneous body: every stress grows as the cubic root of the load."""
    p_h = factor * load ** (1 / 3)
    stress = {mode: 0.3 * p_h + (residual if mode == "sigma_xx_surface" else 0.0) for mode in QUANTITIES}
    stress = {mode: np.maximum(value, 0) for mode, value in stress.items()}
    zero = np.zeros(load.size)
    return Ramp(1.0, 3e-6, 0.0, residual, load, p_h, p_h, stress, dict.fromkeys(QUANTITIES, zero))


@pytest.mark.parametrize("residual", [0.0, -0.2e8, 0.1e8])
def test_critical_load_of_a_power_law_is_exact(residual):
    ramp = power_law(np.geomspace(1, 100, 5), residual)
    found = critical(ramp, Criteria(strength={"sigma_xx_surface": 0.8e8}), (1.0, 100.0))
    exact = ((0.8e8 - residual) / 0.3e8) ** 3
    assert found.of["sigma_xx_surface"][1] == pytest.approx(exact, rel=1e-6)
    assert found.mode == "sigma_xx_surface"
    assert found.share["sigma_xx_surface"] == 1


def test_scatter_of_a_strength_is_that_of_its_critical_load():
    # W = (S / 0.3e8)^3 with S uniform: the quantiles of W are those of S
    given = Uniform(**{"from": 0.6e8, "to": 1.0e8})
    criteria = Criteria(strength={"sigma_xx_surface": given, "von_mises_substrate": 2e9})
    found = critical(power_law(np.geomspace(1, 100, 5)), criteria, (1.0, 100.0))
    exact = [((0.6e8 + p * 0.4e8) / 0.3e8) ** 3 for p in (0.05, 0.5, 0.95)]
    np.testing.assert_allclose(found.of["sigma_xx_surface"], exact, rtol=0.01)
    assert np.isinf(found.of["von_mises_substrate"]).all()
    median = found.fails["sigma_xx_surface"][np.searchsorted(found.load, exact[1])]
    assert median == pytest.approx(0.5, abs=0.02)


def test_equal_thickness_over_contact_radius_is_solved_once():
    study = parse_study(LOADS.encode(), Path("loads.toml"))
    solves = list(study.solves())
    assert sum(one.points for one in solves) == study.points
    assert len(solves) < 0.9 * study.points / len(study.frictions)
    for one in solves:
        over = [h / CoatedContact(10e-3, W, (), (210e9, 0.3)).a_h for h, W in one.places]
        np.testing.assert_allclose(over, over[0], rtol=1e-12)
    for h in study.thicknesses:
        loads = [W for one in solves for at, W in one.places if at == h]
        assert min(loads) <= 4 * (1 + 1e-9)
        assert max(loads) >= 30 * (1 - 1e-9)


def test_a_row_at_another_load_is_what_a_solve_of_its_own_gives():
    coating, load = (420e9, 0.25, 4e-5), 20.0
    scale = 1.3
    request = {
        "source": "integral_equation", "numerics": {"estimate_uncertainty": False}, "radius": 10e-3,
        "substrate": [210e9, 0.3], "ball": None,
        "frictions": [0.2],
    }  # fmt: skip
    # the second place has h and a_h times 1.3; its residual stress over p_h is that of the request
    places = ((coating[2] / scale, load / scale**3), (coating[2], load))
    request |= {"load": places[0][1], "coating": [*coating[:2], places[0][0]]}
    request |= {"residual": [-1e8, -1e8 / scale]}
    rows = table_rows(0, "k", request, answer(request), places)
    alone = request | {"load": load, "coating": list(coating), "residual": [-1e8]}
    (own,) = table_rows(0, "k", alone, answer(alone), (places[1],))
    for name in ("residual_stress", "a_h", "p_h", "peak_pressure", "contact_radius", "approach", *QUANTITIES):
        assert rows[1][name] == pytest.approx(own[name], rel=1e-7, abs=1.0), name


@pytest.mark.slow
def test_report_of_a_load_study_answers_first(tmp_path):
    text = EQUAL.replace("thickness = [5e-5]", 'thickness = ["50 um", "60 um"]')
    study = parse_study(text.encode(), tmp_path / "ramp.toml")
    rows = []
    for one in study.solves():
        made = [_closed(one.request, f) for f in one.request["frictions"]]
        found = {"rows": made, "versions": {}, "seconds": 0.0}
        rows += table_rows(one.first, one.key, one.request, found, one.places)
    write_table(tmp_path / "ramp.parquet", rows, {"name": "ramp", "text": text})
    written = write_load_report(tmp_path / "ramp.parquet", study, tmp_path)
    page = written.page.read_text()
    assert written.answer[0].startswith("50 µm, f = 0.25: ")
    assert f"<h1>{written.answer[0]}</h1>" in page
    names = {path.name for path in (tmp_path / "figures" / "ramp").glob("*.pdf")}
    assert names == {"critical_1_f0.pdf", "critical_1_f0_25.pdf", "ramp_1_50.pdf", "ramp_1_60.pdf"}
    (ramp, *_) = [r for r in ramps(read_columns(tmp_path / "ramp.parquet")) if r.friction == 0.25]
    one = critical(ramp, study.criteria, study.loads[:2])
    assert isinstance(one, Critical)
    assert answers(study, [one])[0] == written.answer[0]


def _closed(request, f):
    contact = CoatedContact(request["radius"], request["load"], (), tuple(request["substrate"]))
    row = {"friction": f, "status": "solved", "failure": None}
    for name in QUANTITIES:
        row |= {name: (0.3 + f) * contact.p_h, f"{name}_over_p_h": 0.3 + f, f"{name}_uncertainty": 0.0}
        row |= {f"{name}_x": 0.0, f"{name}_z": 0.0}
    scales = {"peak_pressure": "p_h", "contact_radius": "a_h", "approach": "delta_h"}
    return row | {name: getattr(contact, scale) for name, scale in scales.items()}


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("count = 5", "count = 3", "sweep.load.count"),
        ("from = 4", "from = 40", "sweep.load"),
        ("from = 4", 'from = "4 Pa"', "'Pa'"),
        ("coating = {", BALL + "coating = {", "coatings"),
        ("2e-5", "2e-8", "value 1"),
    ],
)  # fmt: skip
def test_bad_load_sweep_is_one_message(old, new, message):
    with pytest.raises(CaseError, match=message):
        parse_study(LOADS.replace(old, new, 1).encode(), Path("loads.toml"))
