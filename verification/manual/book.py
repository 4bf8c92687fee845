"""The manual as one PDF, its pages numbered, through an installed Chromium.

The page is printed twice: the first print shows on which page each heading lies.
"""

import html
import re
import tempfile
from pathlib import Path

from verification.manual.build import build
from verification.report.pdf import printed

# Headings of chapters with those of their sections, each in a section with an anchor.
HEADING = re.compile(r'<section id="([^"]+)">\n(?:<span [^>]*></span>)*<h([23])>(.*?)</h\2>', re.DOTALL)
PERMALINK = re.compile(r'<a class="headerlink".*?</a>')
TAG = re.compile(r"<[^>]+>")


def print_manual(folder: Path, name: str, time_limit: float) -> list[Path]:
    """Write the manual to ``folder``, and as a PDF called ``name`` there; returns first page and PDF.

    time_limit : [s] of each of the two prints.   Raises ManualError, NoBrowser, StoreError.
    """
    with tempfile.TemporaryDirectory() as work:
        one = Path(work) / "one"
        first = build(folder, one)
        page, draft = one / "index.html", Path(work) / "draft.pdf"
        text = page.read_text(encoding="utf-8")
        page.write_text(with_contents(text, {}), encoding="utf-8")
        places = pages_of(printed(page, draft, time_limit))
        page.write_text(with_contents(text, places), encoding="utf-8")
        return [first, printed(page, folder / name, time_limit)]


def with_contents(page: str, places: dict[str, int]) -> str:
    """The page with its contents before the first chapter; ``places``: page number by anchor."""
    rows, first = [], 0
    for found in HEADING.finditer(page):
        anchor, level, title = found[1], found[2], TAG.sub("", PERMALINK.sub("", found[3])).strip()
        first = first or found.start()
        number = str(places.get(anchor, ""))
        rows.append(
            f'<li class="level-{level}"><a href="#{html.escape(anchor)}"><span>{title}</span></a>'
            f"<span>{number}</span></li>"
        )
    contents = f'<nav class="contents"><h2>Contents</h2><ol>{"".join(rows)}</ol></nav>'
    return page[:first] + contents + page[first:]


def pages_of(path: Path) -> dict[str, int]:
    """Page number, from 1, of every anchor that a link of the PDF leads to."""
    from pypdf import PdfReader

    reader = PdfReader(path)
    found = {}
    for name, place in reader.named_destinations.items():
        number = reader.get_destination_page_number(place)
        if number is not None:
            found[name.lstrip("/")] = number + 1
    return found
