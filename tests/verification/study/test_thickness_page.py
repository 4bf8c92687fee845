"""The page of a study with its figures for print."""

import csv
import re

import pytest
import study_table
from markupsafe import escape
from matplotlib.backends.backend_agg import FigureCanvasAgg

from verification.study.choice.failure_criteria import Criteria, Uniform
from verification.study.choice.thickness_choice import choice
from verification.study.largest_stresses import QUANTITIES
from verification.study.pages import study_figures, thickness_page
from verification.study.pages.thickness_page import write_study_report
from verification.study.study_table import read_columns
from verification.study.thickness_curves import curves


@pytest.fixture(scope="module", params=["contact alone", pytest.param("all", marks=pytest.mark.slow)])
def report(request, tmp_path_factory):
    """Where a study was reported with the figure of the contact alone, or all but the maps; the study."""
    folder = tmp_path_factory.mktemp("study")
    text = study_table.TEXT.replace("Made of formulas", "<script>alert(1)</script>")
    text += "[criteria.strength]\nsigma_xx_surface = 8e8\nvon_mises_substrate = 9e8\n"
    study = study_table.write(folder / "study.parquet", failed=(3,), text=text)
    left_out = ["_maps"] + ["use_figures", "governing_figure", "stress_figures"] * (request.param != "all")
    with pytest.MonkeyPatch.context() as patch:
        for name in left_out:
            patch.setattr(thickness_page, name, lambda *_: [])
        write_study_report(folder / "study.parquet", study, folder)
    return folder, study


def test_every_figure_is_for_print_with_its_numbers(report):
    folder = report[0] / "figures" / "study"
    stems = {path.with_suffix("") for path in folder.iterdir()}
    assert folder / "contact" in stems
    for stem in stems:
        assert stem.with_suffix(".pdf").read_bytes().startswith(b"%PDF")
        assert b"<svg" in stem.with_suffix(".svg").read_bytes()
        with stem.with_suffix(".csv").open() as file:
            rows = [row for row in csv.DictReader(file) if row.get("source") == "semianalytic"]
        for row in rows:
            name, place = row["quantity"], (float(row[key]) for key in ("E1/E2", "h / a_h", "f"))
            expected = study_table.stress(name, *place) if name in QUANTITIES else 1.0
            assert float(row["over its scale"]) == pytest.approx(expected, rel=1e-7)
        if stem.name.startswith("stress"):
            assert len(rows) == 2 * 9 * 2 - 1


def test_page_needs_nothing_from_outside_and_names_the_failed_point(report):
    text = (report[0] / "study.html").read_text()
    assert not re.search(r'(?:src|href)="(?!data:|#)', text)
    assert '<svg class="print"' in text
    assert "no luck" in text


def test_answer_is_the_first_line_and_inputs_come_next(report):
    text = (report[0] / "study.html").read_text()
    assert re.search(r"<h1>E1/E2 = 0.5: [\d.]+ to [\d.]+ µm", text)
    before = re.sub(r"<[^>]+>", "", text.partition('id="contact"')[0])
    assert all(number in before for number in ("105, 420", "0.5, 2", "800"))


@pytest.mark.slow
def test_no_label_or_legend_of_a_figure_is_cut(report, monkeypatch):
    cut = []

    def measured(figure, name, *_):
        tight, whole = figure.get_tightbbox(FigureCanvasAgg(figure).get_renderer()), figure.get_size_inches()
        if min(tight.x0, tight.y0) < 0 or tight.x1 > whole[0] or tight.y1 > whole[1]:
            cut.append((name, tight.extents))

    monkeypatch.setattr(study_figures, "drawn", measured)
    folder, study = report
    found = curves(read_columns(folder / "study.parquet"))
    criteria = Criteria(
        strength={"sigma_zz_interface": Uniform(**{"from": 8e8, "to": 9e8}), "sigma_xx_base": 9e8}
    )
    for chosen in (found, [c for c in found if c.ratio > 1]):
        groups = [[c for c in chosen if c.ratio == r] for r in {c.ratio for c in chosen}]
        choices = [choice(group, criteria) for group in groups]
        study_figures.stress_figures(chosen, study.units)
        study_figures.contact_figure(chosen, study.units)
        study_figures.use_figures(choices, study.units)
        study_figures.governing_figure(choices, study.units)
    assert cut == []


def test_without_figures_there_still_is_a_page_with_its_answer(report, tmp_path):
    folder, study = report
    written = write_study_report(folder / "study.parquet", study, tmp_path, figures=False)
    assert [path.name for path in tmp_path.iterdir()] == ["study.html"]
    shown = "".join(re.sub("<[^>]*>", "", written.page.read_text()).split())
    assert "".join(escape(written.answer[0]).split()) in shown
