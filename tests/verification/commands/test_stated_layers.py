"""coatcheck run shows what solve honours: names, residual stresses, limits; strains of its own answers."""

import json
import re

import pytest
from case_texts import case_text
from quick_case import coatcheck

from verification.cases.case_file import read_case
from verification.desk.contact_answer import answer
from verification.running.contact_run import run
from verification.sources.source_registry import SOURCES

CLAIM = """[[claim]]
quantity = "{}"
line = "{}"
between = ["integral_equation", "hamilton"]
cap = 1
why = "two references, no method"
"""
STATED = (
    'name = "TiN"; E = "210 GPa"; nu = 0.3; thickness = "20 um"; residual_stress = "-1.5 GPa"; '
    'hardness = "1 GPa"; yield_strength = "3 GPa"'
)


@pytest.mark.slow
def test_run_shows_the_stresses_that_solve_answers(tmp_path):
    path = tmp_path / "mine.toml"
    text = case_text(STATED, more="friction = 0.3", tables=CLAIM.format("peak_pressure", "contact"))
    path.write_text(text.replace("nu = 0.3 }", 'nu = 0.3, yield_strength = "0.3 GPa" }', 1))
    done = coatcheck("run", str(path), "-o", "out", "-j", "1", cwd=tmp_path)
    case = read_case(path)
    own = answer(case.problem, "semianalytic", {}, case.residual)
    largest = max(e.value for e in own.extremes if (e.quantity, e.where) == ("von_mises", "coating 1"))
    assert f"Largest von Mises stress: {float(f'{largest / 1e6:.3g}'):.0f} MPa" in done.stdout
    assert "coating 1 (TiN)" in done.stdout
    assert "substrate yields" in done.stderr
    assert "coating 1, hardness" in done.stderr
    page = re.sub(r"<[^>]+>", " ", (tmp_path / "out" / "report.html").read_text())
    for shown in ("residual stress", "−1.5 GPa", "TiN", "yield strength", "Beyond a limit:"):
        assert shown in page, shown
    evidence = json.loads((tmp_path / "out" / "report.json").read_text())["evidence"]
    assert len(evidence["designed"]["mine"]["extremes"]) == len(own.extremes)
    assert coatcheck("report", "out", cwd=tmp_path).returncode == 0
    assert coatcheck("run", str(path), "--strict", "-j", "1", cwd=tmp_path).returncode == 2


def test_strain_of_a_soft_film_is_warned_of_by_its_own_profiles(tmp_path):
    """Compressed between stiff bodies without widening, e_zz = -p0 (1 + nu)(1 - 2 nu) / (E (1 - nu))."""
    film = 'E = "0.5 GPa"; nu = 0.3; thickness = "5 um"'
    claims = CLAIM.replace("hamilton", "semianalytic").format("sigma_xx", "axis")
    path = tmp_path / "film.toml"
    path.write_text(case_text(film, radius="50e-3", load="200", E="70e9", tables=claims))

    def fast(problem, numerics):
        return SOURCES["semianalytic"].solve(problem, {"estimate_uncertainty": False})

    result = run(read_case(path), dict.fromkeys(("semianalytic", "integral_equation"), fast))
    p0 = result.profile_of["peak_pressure", "contact", "semianalytic"].value[0]
    strain = p0 * 1.3 * 0.4 / (0.5e9 * 0.7)
    (line,) = [line for line in result.warnings if "strained" in line]
    assert line.startswith(f"coating 1 is strained by {100 * strain:.2g} %")
