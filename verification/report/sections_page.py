"""A page of sections alone, in the dress of the report: studies, planted faults, comparisons of runs."""

import base64
import hashlib
from collections.abc import Sequence
from pathlib import Path

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from verification.report.cells import Section

__all__ = ["render_sections"]

HERE = Path(__file__).parent


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
    script = (HERE / "script.js").read_text(encoding="utf-8")
    environment = Environment(
        loader=FileSystemLoader(HERE),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    return environment.get_template("sections.html").render(
        brand=brand,
        summary=summary,
        facts=facts,
        sections=sections,
        footer=footer,
        style=Markup((HERE / "style.css").read_text(encoding="utf-8")),
        script=Markup(script),
        script_hash=base64.b64encode(hashlib.sha256(script.encode()).digest()).decode(),
    )
