"""The report: from case results to one HTML text that needs nothing else, and its files.

The page is one file, so that it can be sent by mail alone, with pages inside it that open by the part of the
address behind "#". Without the script, and on paper, all pages follow one after another.
"""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np

from verification.credibility import accuracy_study
from verification.guests.pages import guests_section
from verification.page.html_page import rendered
from verification.page.number_text import seconds
from verification.page.page_parts import Part, Section, joined
from verification.regression import baseline_section
from verification.regression.baseline_change import regression_json
from verification.report.credibility import credibility_statement, detection_sections, model_section
from verification.report.report_material import ReportMaterial
from verification.report.report_words import HTML
from verification.report.sections import (
    accuracy_section,
    first_page,
    invariants_section,
    overview_section,
    published_section,
    refinement_section,
)
from verification.report.sections.case_page import contents, data
from verification.running.case_result import SCHEMA, to_json
from verification.running.checked_files import write_together
from verification.running.json_records import encode
from verification.validation import validation_page
from verification.validation.measured_modulus import data_sets, described

# Of more cases each page is compressed until it is opened: a report of hundreds stays small.
MOST_UNPACKED = 60


def _dated(section: Section | None, *, older: bool) -> Section | None:
    """``section``, where its record is ``older`` than the code with a sentence that says so."""
    if section is None or not older:
        return section
    text = (
        "This record is older than the code that it judges: it was made before the last change of that code."
    )
    return replace(section, parts=[Part(text), *section.parts])


def _sections(material: ReportMaterial) -> list[tuple[str, list[Section]]]:
    """Pages about the run as a whole in their order, under the headings of the contents."""
    contacts, published, anchors = material.contacts, material.published, material.anchors
    found, study, faults = material.evidence, material.evidence.accuracy, material.evidence.faults
    coverage = accuracy_section.coverage_table(contacts)
    results = (overview_section.section(material), published_section.section(published, anchors))
    evidence = (
        joined(
            "credibility",
            "What an agreement is worth",
            (
                credibility_statement.section(material, coverage),
                invariants_section.section(contacts, anchors),
                _dated(detection_sections.faults_section(faults), older="faults" in found.older)
                if faults
                else None,
                detection_sections.self_tests_section(found.self_tests),
            ),
        ),
        joined(
            "accuracy",
            "Accuracy of the methods",
            (
                accuracy_section.section(contacts, anchors),
                refinement_section.semianalytic_section(study),
                refinement_section.finite_element_section(study),
            ),
        ),
        _dated(model_section.section(found.maps), older="maps" in found.older),
        baseline_section.section(found.baseline, anchors),
        guests_section.section(),
        validation_page.section(found.validation) if found.validation else None,
    )
    groups = (("Results", results), ("Evidence", evidence))
    return [(group, shown) for group, pages in groups if (shown := [page for page in pages if page])]


def render(material: ReportMaterial) -> str:
    """The whole page as text. Every string of a result is escaped: a title "<script>" stays text."""
    # Results may hold numbers that overflow or are not finite; the page shows them as they are.
    with np.errstate(all="ignore"):
        cases = [contents(material, result, anchor) for result, anchor in material.anchors.items()]
        return rendered(
            "page.html",
            HTML,
            groups=_sections(material),
            **first_page.contents(material),
            info=material.info,
            cases=cases,
            packed=len(cases) > MOST_UNPACKED,
            data=data(material),
            seconds=seconds,
        )


def write_report(material: ReportMaterial, folder: Path, junit: str) -> Path:
    """Write report.html and report.json into ``folder``, with ``junit`` beside them; the path of the page."""
    texts = {"report.html": render(material), "report.json": report_json(material), "junit.xml": junit}
    write_together(folder, texts)
    return folder / "report.html"


def report_json(material: ReportMaterial) -> str:
    """Everything the report is made from as strict JSON of schema ``coatcheck-report/1``.

    ``evidence`` is all that ``coatcheck report`` needs beside the results; ``accuracy``, ``baseline`` and
    ``shown``, what the page shows besides, are for other readers.
    """
    study, baseline = material.evidence.accuracy, material.evidence.baseline
    radii = {one.name: one.a[one.admitted].tolist() for one in data_sets()}
    shown = {
        "planes": {name: encode(plane) for name, plane in material.planes.items()},
        "studies": [encode(one) for one in study.verdicts] if study else [],
        "guests": guests_section.examined(),
        "measurements": described() | {"radii": radii},
    }
    data = {
        "schema": SCHEMA,
        "run": {**vars(material.info)},
        "cases": [to_json(result) for result in material.results],
        "accuracy": None if study is None else accuracy_study.to_json(study),
        "baseline": None if baseline is None else regression_json(baseline),
        "evidence": encode(material.evidence),
        "shown": shown,
    }
    return json.dumps(data, allow_nan=False, ensure_ascii=True, separators=(",", ":")) + "\n"
