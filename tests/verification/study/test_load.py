"""Critical loads: exact where h/a_h has no part, similarity of contacts, strengths that scatter."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import study_table
from case_texts import study_text
from synthetic_solves import STUDY

from verification.problem.coated_contact import CoatedContact
from verification.running.json_records import encode
from verification.study.choice.critical_load import Critical, Ramp, critical, extended, ramps
from verification.study.choice.failure_criteria import Criteria, Uniform
from verification.study.largest_stresses import QUANTITIES
from verification.study.pages.load_page import answers, write_load_report
from verification.study.study_plan import parse_study
from verification.study.study_point import answer, table_rows
from verification.study.study_table import read_columns

LOADS = STUDY.replace("load = 20.0", "").replace(
    "cross_check = 5", "cross_check = 0\nload = { from = 4, to = 30, count = 5 }"
)
EQUAL = study_text(
    "coating = { E = 210e9, nu = 0.3 }",
    sweep="load = { from = 5.0, to = 80.0, count = 4 }; thickness = [5e-5]; friction = [0.0, 0.25]; "
    "cross_check = 0",
    load="",
    tables="[semianalytic]\npatches = 33\nestimate_uncertainty = false\n[criteria.strength]\n"
    'sigma_xx_surface = "1 GPa"\nvon_mises_substrate = { from = "0.6 GPa", to = "0.9 GPa" }\n',
)


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


def test_below_the_ramp_no_mode_is_the_first_of_several():
    """All reached at once: no load is stated, and no mode for its place in a list."""
    ramp, between = power_law(np.geomspace(20, 60, 5)), (20.0, 60.0)
    weak = {"sigma_xx_surface": 0.5e8, "sigma_xz_interface": 0.2e8, "von_mises_substrate": 9e9}
    found = critical(ramp, Criteria(strength=weak), between)
    assert (found.mode, found.unresolved, found.first) == (None, 1.0, (0.0, 0.0, 0.0))
    assert all(share == 0 for share in found.share.values())
    assert all((fails == 0).all() for fails in found.fails.values())
    study = parse_study(EQUAL.encode(), Path("ramp.toml"))
    (said,) = answers(study, [found])
    assert "below 20 N, the first mode is not resolved among: the coating cracks at its surface, the" in said
    # one mode alone below the ramp is the first, at a load that is not known
    one = critical(ramp, Criteria(strength=weak | {"sigma_xz_interface": 0.9e8}), between)
    assert (one.mode, one.unresolved, one.first[1]) == ("sigma_xx_surface", 0.0, 0.0)
    assert "below 20 N" in answers(study, [one])[0]


def solved_table(text, path, study=None):
    """The study of ``text`` with its table at ``path``, of stresses that grow with friction alone."""
    law = lambda quantity, ratio, h, f: 0.3 + f  # noqa: E731
    return study_table.write(path, text=text, study=study, law=law)


@pytest.mark.parametrize("begin", [5.0, 40.0, 70.0])
def test_a_ramp_that_begins_too_high_gives_the_answer_of_one_that_does_not(begin, tmp_path):
    """Every stress is (0.3 + f) p_h: its strength S is reached at W with p_h = S/(0.3 + f)."""
    text = EQUAL.replace("from = 5.0", f"from = {begin}").replace('"1 GPa"', '"0.3 GPa"')
    path = tmp_path / "ramp.parquet"
    study = solved_table(text, path)
    for _ in range(3):
        lower = extended(study, read_columns(path))
        if lower is None:
            break
        assert lower.loads[0] < study.loads[0]
        assert lower.asked_from == begin
        study = solved_table(text, path, lower)
    else:
        pytest.fail("no ramp is low enough")
    for ramp in ramps(read_columns(path)):
        found = critical(ramp, study.criteria, study.loads[:2])
        at_5 = CoatedContact(10e-3, 5.0, (), (210e9, 0.3)).p_h
        exact = 5.0 * (0.3e9 / ((0.3 + ramp.friction) * at_5)) ** 3
        assert found.first[1] == pytest.approx(exact, rel=1e-3)
        assert (found.mode, found.unresolved) == ("sigma_xx_surface", 0.0)
        assert sum(fails[0] for fails in found.fails.values()) < 2e-3


def test_a_strength_that_the_residual_stress_exceeds_needs_no_lower_ramp(tmp_path):
    text = EQUAL.replace("nu = 0.3 }\n[sweep]", 'nu = 0.3, residual_stress = "2 GPa" }\n[sweep]')
    assert text != EQUAL
    ramp = power_law(np.geomspace(5, 80, 5), 2e9)
    found = critical(ramp, Criteria(strength={"sigma_xx_surface": 1e9}), (5.0, 80.0))
    assert found.at_rest == ("sigma_xx_surface",)
    study = parse_study(text.encode(), Path("ramp.toml"))
    assert "without any load, by the residual stress" in answers(study, [found])[0]


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
    own = CoatedContact(10e-3, 20.0, ((420e9, 0.25, 4e-5),), (210e9, 0.3))
    scale = 1.3
    (E, nu, h), load = own.coatings[0], own.load / scale**3
    first = replace(own, load=load, coatings=((E, nu, h / scale),))
    # the second place has h and a_h times 1.3; its residual stress over p_h is that of the request
    asked = {"source": "integral_equation", "numerics": {"estimate_uncertainty": False}, "swept": 0}
    asked |= {"frictions": [0.2], "problem": encode(first), "residual": [-1e8, -1e8 / scale]}
    rows = table_rows(0, "k", asked, answer(asked), ((h / scale, load), (h, own.load)))
    alone = asked | {"problem": encode(own), "residual": [-1e8]}
    (own,) = table_rows(0, "k", alone, answer(alone), ((h, own.load),))
    for name in ("residual_stress", "a_h", "p_h", "peak_pressure", "contact_radius", "approach", *QUANTITIES):
        assert rows[1][name] == pytest.approx(own[name], rel=1e-7, abs=1.0), name


@pytest.mark.slow
def test_report_of_a_load_study_answers_first(tmp_path):
    text = EQUAL.replace("thickness = [5e-5]", 'thickness = ["50 um", "60 um"]')
    study = solved_table(text, tmp_path / "ramp.parquet")
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
