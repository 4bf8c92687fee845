"""The report: from case results to one HTML text that needs nothing else, and its files.

The page is one file, so that it can be sent by mail alone, with pages inside it that open by the part of the
address behind "#". Without the script, and on paper, all pages follow one after another.
"""

import json
from collections.abc import Callable
from dataclasses import replace
from itertools import groupby
from pathlib import Path

import numpy as np

from verification.credibility import accuracy_study
from verification.guests.pages import guests_section
from verification.page.html_page import rendered
from verification.page.number_text import seconds
from verification.page.page_parts import Part, Section
from verification.regression import baseline_section
from verification.regression.baseline_change import regression_json
from verification.report.credibility import (
    credibility_statement,
    detection_sections,
    model_section,
)
from verification.report.report_material import Material
from verification.report.sections import (
    accuracy_section,
    family_section,
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

# Of more cases each page is compressed until it is opened: a report of hundreds stays small.
MOST_UNPACKED = 60
HTML = Path(__file__).parent / "html"


# Pages about the run as a whole in their order, under the heading of the contents; None is left out.
SECTIONS: tuple[tuple[str, Callable[[Material], Section | None]], ...] = (
    ("Results", overview_section.section),
    ("Results", published_section.section),
    ("Results", family_section.section),
    ("Evidence", credibility_statement.section),
    ("Evidence", model_section.section),
    ("Evidence", accuracy_section.section),
    ("Evidence", invariants_section.section),
    ("Evidence", refinement_section.semianalytic_section),
    ("Evidence", refinement_section.finite_element_section),
    ("Evidence", detection_sections.faults_of),
    ("Evidence", detection_sections.self_tests_of),
    ("Evidence", lambda material: baseline_section.section(material.evidence.baseline, material.anchors)),
    ("Evidence", lambda _: guests_section.section()),
)


# The page of each record that may be older than the code it judges.
RECORDS = {"faults": "faults", "model": "maps"}


def _dated(material: Material, section: Section | None) -> Section | None:
    """``section``, where its record is older than the code with a sentence that says so."""
    if section is None or RECORDS.get(section.anchor) not in material.evidence.older:
        return section
    text = (
        "This record is older than the code that it judges: it was made before the last change of that code."
    )
    return replace(section, parts=[Part(text), *section.parts])


def render(material: Material) -> str:
    """The whole page as text. Every string of a result is escaped: a title "<script>" stays text."""
    # Results may hold numbers that overflow or are not finite; the page shows them as they are.
    with np.errstate(all="ignore"):
        cases = [contents(material, result) for result in material.results]
        made = [(group, _dated(material, make(material))) for group, make in SECTIONS]
        sections = [pair for pair in made if pair[1] is not None]
        groups = [
            (group, [section for _, section in some])
            for group, some in groupby(sections, key=lambda pair: pair[0])
        ]
        return rendered(
            "page.html",
            HTML,
            **first_page.contents(material),
            info=material.info,
            groups=groups,
            cases=cases,
            packed=len(cases) > MOST_UNPACKED,
            data=data(material),
            seconds=seconds,
        )


def write_report(material: Material, folder: Path, junit: str) -> Path:
    """Write report.html and report.json into ``folder``, with ``junit`` beside them; the path of the page."""
    texts = {"report.html": render(material), "report.json": report_json(material), "junit.xml": junit}
    write_together(folder, texts)
    return folder / "report.html"


def report_json(material: Material) -> str:
    """Everything the report is made from as strict JSON of schema ``coatcheck-report/1``.

    ``evidence`` is all that ``coatcheck report`` needs beside the results; ``accuracy`` and ``baseline``
    are for other readers.
    """
    study, baseline = material.evidence.accuracy, material.evidence.baseline
    data = {
        "schema": SCHEMA,
        "run": {**vars(material.info)},
        "cases": [to_json(result) for result in material.results],
        "accuracy": None if study is None else accuracy_study.to_json(study),
        "baseline": None if baseline is None else regression_json(baseline),
        "evidence": encode(material.evidence),
    }
    return json.dumps(data, allow_nan=False, ensure_ascii=True, separators=(",", ":")) + "\n"
