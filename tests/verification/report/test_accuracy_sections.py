"""The sections on accuracy: every curve drawn, every message from the numbers, nothing breaks the page."""

import re
from dataclasses import replace

import pytest
from html_document import Document
from synthetic_results import INFO, contact, result_of
from synthetic_study import conversion, elements, study

from verification.credibility.accuracy_study import failed
from verification.credibility.refinement_studies import QUANTITIES
from verification.report.report_material import Evidence, Material
from verification.report.report_page import render
from verification.report.sections.refinement_section import finite_element_section, semianalytic_section


def material(found, results=()) -> Material:
    return Material(list(results), INFO, Evidence(accuracy=found))


def convergence_sections(found):
    made = (make(material(found)) for make in (semianalytic_section, finite_element_section))
    return [section for section in made if section is not None]


@pytest.fixture(scope="module")
def page():
    return render(material(study(), [result_of(contact(), points=11)]))


def test_without_a_study_there_is_no_section():
    assert 'id="semi-analytical-accuracy"' not in render(Material([result_of(contact(), points=11)], INFO))


def test_every_quantity_has_a_figure_with_every_curve(page):
    document = Document(page)
    drawn = [a["aria-label"] for a in document.all("svg") if "logarithmic" in a.get("aria-label", "")]
    assert len(drawn) == 2 * len(QUANTITIES)
    identifiers = [a["id"] for _, a in document.elements if "id" in a]
    assert len(identifiers) == len(set(identifiers))
    figures = re.findall(r'<svg class="figure"[^>]*logarithmic".*?</svg>', page, re.DOTALL)
    assert [len(re.findall(r'class="s-(?!grid)', figure)) for figure in figures] == [5] * 5 + [3] * 5


def test_what_failed_is_said_in_its_section():
    broken = study("fem_reference, coated, order 3, default: no mesh", "semianalytic: no grid fits")
    grid, element = convergence_sections(broken)
    assert grid.failures[0] == "semianalytic: no grid fits"
    assert element.failures == ("fem_reference, coated, order 3, default: no mesh",)


def test_study_that_died_is_its_reason_alone():
    (section,) = convergence_sections(failed("its process was killed", 3.0))
    assert section.failures == ("its process was killed",)
    page = render(material(failed("its process was killed", 3.0)))
    assert "its process was killed" in Document(page).text("p")


def test_part_that_is_missing_leaves_the_others():
    whole = study()
    bare = replace(whole.refinements[0], levels=(), failure="N = 33: no grid fits")
    for studies in ((bare,), (bare, *whole.refinements[1:]), (bare, elements(3)), whole.refinements[1:2]):
        Document(render(material(replace(whole, refinements=studies))))
    for conversions in ((), whole.conversions[:1], whole.conversions[1:2], (conversion("new", 4, 1, 1.0),)):
        Document(render(material(replace(whole, conversions=conversions))))
