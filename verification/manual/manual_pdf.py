"""The manual as one PDF with its contents, through an installed Chromium."""

import base64
import re
import tempfile
from pathlib import Path

from verification.manual.manual_build import build
from verification.page.pdf_file import printed

# Headings of chapters with those of their sections, each in a section with an anchor.
HEADING = re.compile(
    r'<section(?: class="[^"]*")? id="([^"]+)">\n(?:<span [^>]*></span>)*<h([23])>(.*?)</h\2>', re.DOTALL
)
PERMALINK = re.compile(r'<a class="headerlink".*?</a>')
TAG = re.compile(r"<[^>]+>")
SCRIPT = re.compile(r"<script\b.*?</script>", re.DOTALL)
SHEET = re.compile(r'<link rel="stylesheet"[^>]*href="([^"?]+)[^"]*"[^>]*/>')
PICTURE = re.compile(r'(<img\b[^>]*src=")([^":]+)(")')
FONT = re.compile(r'url\("([^":]+\.woff2)"\)')
TYPES = {".svg": "image/svg+xml", ".png": "image/png", ".woff2": "font/woff2"}


def print_manual(folder: Path, name: str, time_limit: float) -> list[Path]:
    """Write the manual to ``folder``, and as a PDF called ``name`` there; returns first page and PDF.

    time_limit : [s] of each of the two prints.   Raises ManualError, NoBrowser, StoreError.
    """
    with tempfile.TemporaryDirectory() as work:
        one = Path(work) / "one"
        first = build(folder, one)
        page = one / "index.html"
        page.write_text(with_contents(in_one_file(page)), encoding="utf-8")
        return [first, printed(page, folder / name, time_limit)]


def in_one_file(page: Path) -> str:
    """The page with its style sheets, fonts and pictures in it, without scripts."""
    folder = page.parent

    def sheet(found: re.Match[str]) -> str:
        path = folder / found[1]
        style = FONT.sub(
            lambda font: f'url("{_data(path.parent / font[1])}")', path.read_text(encoding="utf-8")
        )
        return f"<style>{style}</style>"

    text = SCRIPT.sub("", page.read_text(encoding="utf-8"))
    text = SHEET.sub(sheet, text)
    return PICTURE.sub(lambda found: f"{found[1]}{_data(folder / found[2])}{found[3]}", text)


def with_contents(page: str) -> str:
    """The page with its contents before the first chapter, as `printed` numbers them.

    Each heading gets an anchor of its own, for two chapters may have sections of one name.
    """
    rows: list[str] = []

    def anchored(found: re.Match[str]) -> str:
        level, title = found[2], TAG.sub("", PERMALINK.sub("", found[3])).strip()
        anchor = f"heading-{len(rows)}"
        rows.append(f'<li class="level-{level}"><a href="#{anchor}"><span>{title}</span><b></b></a></li>')
        return found[0].replace(f"<h{level}>", f'<h{level} id="{anchor}">')

    first = next((found.start() for found in HEADING.finditer(page)), 0)
    chapters = HEADING.sub(anchored, page[first:])
    contents = f'<nav class="contents"><h2>Contents</h2><ol>{"".join(rows)}</ol></nav>'
    return page[:first] + contents + chapters


def _data(path: Path) -> str:
    """A file as an address that holds it."""
    return f"data:{TYPES[path.suffix]};base64,{base64.b64encode(path.read_bytes()).decode()}"
