"""The page of a study with its figures for print."""

import csv
import re

import pytest
import study_table
from PIL import Image

from verification.report.study.figures import governing_figure
from verification.report.study.page import write_study_report
from verification.study.criteria import judged
from verification.study.curves import curves
from verification.study.quantities import QUANTITIES
from verification.study.table import read_columns


@pytest.fixture(scope="module")
def report(tmp_path_factory):
    """Where a study was reported, and the study."""
    folder = tmp_path_factory.mktemp("study")
    text = study_table.TEXT.replace("Made of formulas", "<script>alert(1)</script>")
    text += "[criteria.strength]\nsigma_xx_surface = 8e8\nvon_mises_substrate = 9e8\n"
    study = study_table.write(folder / "study.parquet", failed=(3,), text=text)
    write_study_report(folder / "study.parquet", study, folder, maps=False)
    return folder, study


@pytest.fixture
def folder(report):
    return report[0]


def test_every_failure_mode_has_its_figure_for_print_with_its_numbers(folder):
    for quantity in QUANTITIES:
        stem = folder / "figures" / "study" / f"stress_{quantity}"
        assert stem.with_suffix(".pdf").read_bytes().startswith(b"%PDF")
        with Image.open(stem.with_suffix(".png")) as image:
            assert image.width > 1000
        with stem.with_suffix(".csv").open() as file:
            rows = list(csv.DictReader(file))
        solved = [r for r in rows if r["source"] == "semianalytic"]
        assert len(solved) == 2 * 9 * 2 - 1
        for row in solved:
            expected = study_table.stress(
                quantity, float(row["E1/E2"]), float(row["h / a_h"]), float(row["f"])
            )
            assert float(row[f"{quantity} over its scale"]) == pytest.approx(expected, rel=1e-7)
    for name in ("governing_mode", "use_0_5", "use_2", "contact_approach"):
        assert (folder / "figures" / "study" / f"{name}.pdf").exists()


def test_page_needs_nothing_from_outside_and_names_the_failed_point(folder):
    page = (folder / "study.html").read_text()
    assert not re.search(r'(?:src|href)="(?!data:|#)', page)
    assert "no luck" in page
    assert "35 points solved, 1 could not be" in page
    assert "admissible at every friction" in page
    assert "admissible h [µm]" in page


def test_the_same_table_gives_the_same_figures(report):
    folder, study = report
    # the one with lines, raster, contours, labels
    judgements = [judged(curve, study.criteria) for curve in curves(read_columns(folder / "study.parquet"))]
    for again in governing_figure(judgements):
        stem = folder / "figures" / "study" / again.name
        assert stem.with_suffix(".pdf").read_bytes() == again.pdf
        assert stem.with_suffix(".png").read_bytes() == again.png


def test_titles_from_strangers_stay_text(folder):
    page = (folder / "study.html").read_text()
    assert "<script>alert(1)" not in page
    assert "&lt;script&gt;alert(1)" in page
