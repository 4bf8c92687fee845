"""Longer texts of the report, kept in a template with the numbers that they state."""

from pathlib import Path

from markupsafe import Markup

from verification.page.html_page import environment

HTML = Path(__file__).parent / "html"


def stated(name: str, **numbers: object) -> str:
    """The text ``name`` of words.html in one line, as plain text that a page escapes."""
    text = getattr(environment(HTML).get_template("words.html").module, name)(**numbers)
    # the page escapes all of it, once
    return Markup(" ".join(str(text).split())).unescape()
