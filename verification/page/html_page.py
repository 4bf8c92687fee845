"""HTML pages rendered from the templates: one style, one script, every string escaped."""

import base64
import hashlib
from collections.abc import Sequence
from functools import cache
from pathlib import Path

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from verification.page.page_parts import Section, embedded
from verification.page.symbol_text import drawn, typeset, unicode

HTML = Path(__file__).parent / "html"


@cache
def environment(folder: Path) -> Environment:
    """Templates of a ``folder`` and of this room, each compiled once."""
    made = Environment(
        loader=FileSystemLoader([folder, HTML]),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    made.policies["json.dumps_kwargs"] = {"separators": (",", ":"), "ensure_ascii": False}
    made.filters |= {"symbols": typeset, "unicode": unicode, "drawn": drawn, "embedded": embedded}
    return made


def rendered(template: str, folder: Path = HTML, **content: object) -> str:
    """One HTML text that needs nothing else; of ``content`` only ``Markup`` stays as it is.

    folder : of the ``template``, which may use those of this room.
    """
    script = (HTML / "script.js").read_text(encoding="utf-8")
    return (
        environment(folder)
        .get_template(template)
        .render(
            content,
            style=Markup((HTML / "style.css").read_text(encoding="utf-8")),
            script=Markup(script),
            script_hash=base64.b64encode(hashlib.sha256(script.encode()).digest()).decode(),
        )
    )


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
    return rendered(
        "sections.html", brand=brand, summary=summary, facts=facts, sections=sections, footer=footer
    )
