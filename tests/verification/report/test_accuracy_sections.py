"""The sections on accuracy: every curve drawn, every message from the numbers, nothing breaks the page."""

import re
from dataclasses import replace

from html_document import Document
from synthetic_results import INFO
from synthetic_study import elements, study

from verification.credibility.accuracy_study import failed
from verification.credibility.refinement_studies import QUANTITIES
from verification.report.report_material import Evidence, ReportMaterial
from verification.report.report_page import render
from verification.report.sections.refinement_section import finite_element_section, semianalytic_section


def material(found) -> ReportMaterial:
    return ReportMaterial([], INFO, Evidence(accuracy=found))


def test_every_quantity_has_a_figure_with_every_curve():
    page = render(material(study()))
    figures = re.findall(r'<svg class="figure"[^>]*logarithmic".*?</svg>', page, re.DOTALL)
    curves = [len(re.findall(r'<path d="[^"]*"[^>]*style="fill: none;', figure)) for figure in figures]
    assert curves == [5] * len(QUANTITIES) + [3] * len(QUANTITIES)


def test_what_failed_is_said_in_its_section():
    broken = study("fem_reference, coated, order 3, default: no mesh", "semianalytic: no grid fits")
    assert semianalytic_section(broken).failures[0] == "semianalytic: no grid fits"
    assert finite_element_section(broken).failures == ("fem_reference, coated, order 3, default: no mesh",)


def test_study_that_died_is_its_reason_alone():
    died = failed("its process was killed", 3.0)
    assert semianalytic_section(died).failures == ("its process was killed",)
    assert finite_element_section(died) is None
    assert "its process was killed" in Document(render(material(died))).text("p")


def test_part_that_is_missing_leaves_the_others():
    whole = study()
    bare = replace(whole.refinements[0], levels=(), failure="N = 33: no grid fits")
    for studies in ((bare,), (bare, *whole.refinements[1:]), (bare, elements(3)), whole.refinements[1:2]):
        Document(render(material(replace(whole, refinements=studies))))
