"""Longer texts of the report, kept in a template with the numbers that they state."""

from functools import cache
from pathlib import Path
from typing import Any

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup


@cache
def _texts() -> Any:
    folder = FileSystemLoader(Path(__file__).parent / "html")
    made = Environment(loader=folder, undefined=StrictUndefined, autoescape=True)
    return made.get_template("words.html").module


def stated(name: str, **numbers: object) -> str:
    """The text ``name`` of words.html in one line, as plain text that a page escapes."""
    # the page escapes all of it, once
    return Markup(" ".join(str(getattr(_texts(), name)(**numbers)).split())).unescape()
