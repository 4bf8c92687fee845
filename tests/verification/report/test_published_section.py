"""The report's pages on published results: what was printed beside what was computed."""

import json
import re
from dataclasses import replace
from pathlib import Path

import pytest
from quick_case import coatcheck

from verification.cases.published_file import published_cases, read_published
from verification.report.report_material import ReportMaterial
from verification.report.report_page import render
from verification.running.case_result import RunInfo, from_json
from verification.running.checked_files import read_checked
from verification.running.published_counts import counts
from verification.running.published_run import failed, run
from verification.sources.source_registry import METHODS, solvers

SHIPPED = published_cases()
INFO = RunInfo("coatcheck run published", "2026-01-01T00:00:00+00:00", 1.0, 1, None, "a machine", {})


# The quick method alone, which here speaks for both.
BOTH = dict.fromkeys(METHODS, solvers()["semianalytic"])


@pytest.fixture(scope="module")
def results():
    return [run(read_published(SHIPPED[n]), BOTH) for n in ("ahlvin_ulery_1962", "jones_1962")]


@pytest.fixture(scope="module")
def page(results):
    return render(ReportMaterial(results, INFO))


def rows_of(page, anchor):
    """The text of every row of the section, cells parted by |."""
    article = page.partition(f'<article class="page case published" id="case-{anchor}">')[2]
    rows = re.findall(r"<tr.*?</tr>", article.partition("</article>")[0], re.DOTALL)
    cells = [re.findall(r"<t[dh][^>]*>(.*?)</t[dh]>", row, re.DOTALL) for row in rows]
    rows = ["|".join(re.sub("<[^>]*>", "", cell) for cell in row) for row in cells]
    return [row.replace("·10−", "e-") for row in rows]


def test_every_printed_value_stands_beside_both_methods(page, results):
    rows = rows_of(page, "ahlvin-ulery-1962")
    printed = [text for item in results[0].published["columns"] for text in item["text"]]
    assert len(printed) == 139
    beside = [row.split("|") for row in rows if row.endswith(("✓", "✗", "counted"))]
    assert [cells[2] for cells in beside] == printed
    first = beside[0]
    # axis, z = 0.1 a: printed 0.90050, computed 0.900496 by both, met.
    assert first[:3] == ["axis", "0.1", "0.90050"]
    assert float(first[5]) == pytest.approx(0.900496, abs=5e-6)
    assert first[5] == first[8]
    assert first[-1] == "✓"


def test_departures_are_shown_with_their_size_and_not_counted(page, results):
    rows = rows_of(page, "ahlvin-ulery-1962")
    departing = [row for row in rows if "departs" in row]
    assert len(departing) == 93
    misprint = next(row for row in departing if "|0.21727|" in row).split("|")
    assert misprint[3] == "+1.6e-2"
    assert counts(results) == (47, 94, 0)


def test_recomputed_values_are_called_so(results):
    items = [item | {"seen": "recomputed", "counted": [False]} for item in results[1].published["columns"]]
    recomputed = replace(results[1], published=results[1].published | {"columns": items})
    assert counts([recomputed]) == (0, 0, 2)


def test_values_keep_the_sign_and_unit_of_the_source(page):
    factor = next(row for row in rows_of(page, "jones-1962") if "|1.97428|" in row).split("|")
    assert float(factor[5]) == pytest.approx(1.974308, abs=1e-5)
    # Computed less published, in the source's own sign.
    assert float(factor[6]) == pytest.approx(2.9e-5, abs=3e-6)


def test_a_value_that_is_not_met_is_marked(results):
    wrong = results[1]
    factors = {"fem_reference": 1.001}
    profiles = tuple(replace(p, value=p.value * factors.get(p.source, 1)) for p in wrong.profiles)
    rows = rows_of(render(ReportMaterial([replace(wrong, profiles=profiles)], INFO)), "jones-1962")
    assert sum(row.endswith("✗") for row in rows) == 2


def test_a_failed_source_still_has_its_page():
    case = read_published(SHIPPED["jones_1962"])
    page = render(ReportMaterial([failed(case, "its process <died>", 1.0)], INFO))
    assert "process" in page
    assert "0 of 2" in page


def test_command_line_runs_a_table_of_ones_own(tmp_path, monkeypatch):
    monkeypatch.setattr("verification.running.published_run.solvers", lambda problem: BOTH)
    (tmp_path / "mine.toml").write_text(SHIPPED["jones_1962"].read_text().replace("nu = 0.5", "nu = 0.3"))
    table = "factor,meaning,table_memory\nZZ1,a,0.500\nZZ1-RR1,b,1.000\n"
    (tmp_path / "jones_1962_three_layer.csv").write_text(table)
    words = ("run", "mine.toml", "-o", "out", "--json")
    done = coatcheck(*words, cwd=tmp_path)
    # The numbers are made up, so they must disagree.
    assert done.returncode == 1, done.stderr
    assert json.loads(done.stdout)["cases"]["mine"]["outcome"] == "DISAGREES"
    result = from_json(read_checked(tmp_path / "out" / "cases" / "mine.json"))
    assert result.published["columns"][0]["text"] == ["0.500"]
    (tmp_path / "jones_1962_three_layer.csv").write_text(table.replace("1.000", "one"))
    done = coatcheck(*words, cwd=tmp_path)
    assert done.returncode == 2
    assert "jones_1962_three_layer.csv, line 3, column table_memory" in done.stderr
    assert Path(tmp_path / "out" / "report.html").exists()
