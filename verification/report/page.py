"""The report page: from case results to one HTML text that needs nothing else.

It is one file, so that it can be sent by mail alone, with pages inside it that open by the part of the
address behind "#". Without the script, and on paper, all pages follow one after another.
"""

import json
from collections.abc import Callable
from itertools import groupby
from typing import Any

import numpy as np
from markupsafe import Markup

from verification.regression.manifest import manifest_message
from verification.report.credibility import faults, guests, model, mutants, self_tests, statement
from verification.report.html.templates import rendered
from verification.report.material import Material
from verification.report.sections import (
    accuracy,
    baseline,
    case,
    effective,
    family,
    first,
    invariants,
    overview,
    parameters,
    published,
    refinement,
)
from verification.report.tables.cells import Section
from verification.report.tables.numbers import seconds

# Of more cases each page is compressed until it is opened: a report of hundreds stays small.
MOST_UNPACKED = 60
# Pages about the run as a whole in their order, under the heading of the contents; None is left out.
SECTIONS: tuple[tuple[str, Callable[[Material], Section | None]], ...] = (
    ("Results", overview.section),
    ("Results", published.section),
    ("Results", family.section),
    ("Results", effective.family_section),
    ("Results", effective.section),
    ("Evidence", statement.section),
    ("Evidence", model.section),
    ("Evidence", accuracy.section),
    ("Evidence", invariants.section),
    ("Evidence", refinement.semianalytic_section),
    ("Evidence", refinement.finite_element_section),
    ("Evidence", parameters.section),
    ("Evidence", faults.section),
    ("Evidence", mutants.section),
    ("Evidence", self_tests.section),
    ("Evidence", baseline.section),
    ("Evidence", guests.section),
)


def render(material: Material) -> str:
    """The whole page as text. Every string of a result is escaped: a title "<script>" stays text."""
    # Results may hold numbers that overflow or are not finite; the page shows them as they are.
    with np.errstate(all="ignore"):
        sections = [(group, found) for group, make in SECTIONS if (found := make(material)) is not None]
        return rendered(
            "page.html",
            info=material.info,
            asked=first.asked(material.results),
            headline=first.headline(material.results),
            largest=first.largest(material),
            tallies=first.tallies(material.results),
            alarms=_alarms(material),
            answered=first.answered(material.results),
            chart=first.chart(material),
            worth=first.worth(material),
            not_claimed=first.not_claimed(material),
            packed=len(material.results) > MOST_UNPACKED,
            groups=[
                (group, [section for _, section in some])
                for group, some in groupby(sections, key=lambda pair: pair[0])
            ],
            cases=[case.contents(material, result) for result in material.results],
            data=_embedded(case.data(material)),
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
        messages.append(f"numbers differ from the baseline: {baseline.baseline_message(found)}")
    return messages
