"""The report page: from case results to one HTML text that needs nothing else.

It is one file, so that it can be sent by mail alone, with pages inside it that open by the part of the
address behind "#". Without the script, and on paper, all pages follow one after another.
"""

import json
from collections.abc import Callable
from itertools import groupby
from pathlib import Path
from typing import Any

import numpy as np
from markupsafe import Markup

from verification.guests.pages import guests_section
from verification.page.html_page import rendered
from verification.page.number_text import seconds
from verification.page.page_parts import Section
from verification.regression import baseline_section
from verification.regression.manifest import manifest_message
from verification.report.credibility import (
    credibility_statement,
    faults_section,
    model_section,
    mutants_section,
    self_tests_section,
)
from verification.report.report_material import Material
from verification.report.sections import (
    accuracy_section,
    case_page,
    effective_section,
    family_section,
    first_page,
    invariants_section,
    overview_section,
    parameters_section,
    published_section,
    refinement_section,
)

# Of more cases each page is compressed until it is opened: a report of hundreds stays small.
MOST_UNPACKED = 60
HTML = Path(__file__).parent / "html"


def _baseline(material: Material) -> Section | None:
    anchors = {result.name: anchor for result, anchor in material.anchors.items()}
    return baseline_section.section(material.evidence.baseline, anchors)


# Pages about the run as a whole in their order, under the heading of the contents; None is left out.
SECTIONS: tuple[tuple[str, Callable[[Material], Section | None]], ...] = (
    ("Results", overview_section.section),
    ("Results", published_section.section),
    ("Results", family_section.section),
    ("Results", effective_section.family_section),
    ("Results", effective_section.section),
    ("Evidence", credibility_statement.section),
    ("Evidence", model_section.section),
    ("Evidence", accuracy_section.section),
    ("Evidence", invariants_section.section),
    ("Evidence", refinement_section.semianalytic_section),
    ("Evidence", refinement_section.finite_element_section),
    ("Evidence", parameters_section.section),
    ("Evidence", faults_section.section),
    ("Evidence", mutants_section.section),
    ("Evidence", self_tests_section.section),
    ("Evidence", _baseline),
    ("Evidence", lambda _: guests_section.section()),
)


def render(material: Material) -> str:
    """The whole page as text. Every string of a result is escaped: a title "<script>" stays text."""
    # Results may hold numbers that overflow or are not finite; the page shows them as they are.
    with np.errstate(all="ignore"):
        sections = [(group, found) for group, make in SECTIONS if (found := make(material)) is not None]
        return rendered(
            "page.html",
            HTML,
            info=material.info,
            asked=first_page.asked(material.results),
            headline=first_page.headline(material.results),
            largest=first_page.largest(material),
            tallies=first_page.tallies(material.results),
            alarms=_alarms(material),
            answered=first_page.answered(material.results),
            chart=first_page.chart(material),
            worth=first_page.worth(material),
            not_claimed=first_page.not_claimed(material),
            packed=len(material.results) > MOST_UNPACKED,
            groups=[
                (group, [section for _, section in some])
                for group, some in groupby(sections, key=lambda pair: pair[0])
            ],
            cases=[case_page.contents(material, result) for result in material.results],
            data=_embedded(case_page.data(material)),
            seconds=seconds,
        )


def _embedded(data: dict[str, Any]) -> Markup:
    """``data`` as JSON inside an element."""
    text = json.dumps(data, separators=(",", ":"), ensure_ascii=False)
    return Markup(text.replace("&", "&amp;").replace("<", "&lt;"))


def _alarms(material: Material) -> list[str]:
    """What fails although every verdict may agree: self-tests, the manifest, the baseline."""
    failed = [test.name for test in material.evidence.self_tests if not test.passed]
    messages = [f"self-tests of the harness: {', '.join(failed)}"] if failed else []
    found = material.evidence.baseline
    if found is not None and found.less:
        messages.append(manifest_message(found.less))
    if found is not None and found.unexplained:
        messages.append(f"numbers differ from the baseline: {baseline_section.baseline_message(found)}")
    return messages
