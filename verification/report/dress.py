"""What every page is made with: the templates that escape all they are given, one style, one script."""

import base64
import hashlib
from pathlib import Path

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

__all__ = ["dressed"]

HERE = Path(__file__).parent


def dressed(template: str, **content: object) -> str:
    """One HTML text that needs nothing else; of ``content`` only ``Markup`` stays as it is."""
    environment = Environment(
        loader=FileSystemLoader(HERE),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    script = (HERE / "script.js").read_text(encoding="utf-8")
    return environment.get_template(template).render(
        content,
        style=Markup((HERE / "style.css").read_text(encoding="utf-8")),
        script=Markup(script),
        script_hash=base64.b64encode(hashlib.sha256(script.encode()).digest()).decode(),
    )
