"""A page of sections alone, in the dress of the report: studies, planted faults, comparisons of runs."""

from collections.abc import Sequence

from verification.report.cells import Section
from verification.report.dress import dressed

__all__ = ["render_sections"]


def render_sections(
    brand: str,
    summary: str,
    facts: Sequence[tuple[str, str]],
    sections: Sequence[Section],
    footer: str = "Written by coatcheck.",
) -> str:
    """One HTML text that needs nothing else; every string is escaped, only ``Markup`` stays as it is.

    facts : (name, value) pairs under the ``summary``, the first of which also heads the window.
    """
    return dressed(
        "sections.html",
        brand=brand,
        summary=summary,
        facts=facts,
        sections=sections,
        footer=footer,
    )
