"""PDF of a page through an installed Chromium."""

import base64
import gzip
import io
import os
import re
import shutil
import subprocess
import tempfile
from collections.abc import Mapping
from pathlib import Path

from verification.running.checked_files import StoreError, write_atomically

BROWSERS = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome")
FLAGS = (
    "--headless",
    "--disable-gpu",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--no-pdf-header-footer",
)

SIZE = "@page {{ size: {}"  # of the paper, as the style sheet writes it
# A sheet of Letter is shorter: a case that fills one of A4 is drawn smaller on it.
LETTER = "@media print { .case:not(.published) { zoom: .77 !important; margin: 0 11mm; } } "


class NoBrowser(Exception):
    """No browser is installed, or it fails to print."""


def browser() -> str | None:
    """Path of an installed Chromium or Chrome; None where there is none."""
    return next((path for path in map(shutil.which, BROWSERS) if path), None)


def printed(page: Path, path: Path, time_limit: float, paper: str = "A4") -> Path:
    """Print ``page`` to ``path``, whole or not at all; returns it.

    Printed twice: the contents have the numbers of the pages that the first print put each heading on.
    time_limit : of each print [s].   paper : "A4" or "Letter".
    Raises NoBrowser, and StoreError where a file cannot be read or written.
    """
    found = browser()
    if found is None:
        raise NoBrowser(
            "--pdf needs Chromium or Chrome, and none is installed as chromium, chromium-browser or "
            f"google-chrome; {page} is written, and any browser prints it"
        )
    try:
        text = whole(page.read_text(encoding="utf-8"))
        if paper == "Letter":
            text = text.replace(SIZE.format("A4"), LETTER + SIZE.format(paper))
    except OSError as error:
        raise StoreError(f"{page}: cannot be read ({error.strerror})") from None
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        first = _print(found, text, Path(folder), page, time_limit)
        numbered = with_numbers(text, page_numbers(first))
        data = first if numbered == text else _print(found, numbered, Path(folder), page, time_limit)
        write_atomically(path, data)
    return path


def page_numbers(pdf: bytes) -> dict[str, int]:
    """Page of every named place of a PDF, from 1; empty where it cannot be read."""
    from pypdf import PdfReader
    from pypdf.errors import PyPdfError

    try:
        reader = PdfReader(io.BytesIO(pdf))
        pages = {
            name.removeprefix("/"): reader.get_destination_page_number(place)
            for name, place in reader.named_destinations.items()
        }
    except PyPdfError:
        return {}
    return {name: page + 1 for name, page in pages.items() if page is not None and page >= 0}


def with_numbers(text: str, numbers: Mapping[str, int]) -> str:
    """The page ``text`` with the number of each place behind its entry in the contents."""

    def entry(match: re.Match[str]) -> str:
        return f"{match[1]}{numbers.get(match[2], '')}</b>"

    return re.sub(r'(<a href="#([\w.~-]+)"><span>(?:(?!</a>).)*</span><b>)</b>', entry, text)


def whole(text: str) -> str:
    """The page ``text`` with its compressed pages written out."""

    def body(match: re.Match[str]) -> str:
        return gzip.decompress(base64.b64decode(match[1])).decode("utf-8")

    packed = (
        r'<h2>[^\n]*</h2>\n<noscript>[^\n]*</noscript>\n<div class="packed" data-html="[^",]*,([^"]*)"></div>'
    )
    return re.sub(packed, body, text)


def _print(found: str, text: str, folder: Path, page: Path, time_limit: float) -> bytes:
    """PDF of the page ``text``; ``page`` is named in messages."""
    source, made = folder / "report.html", folder / "report.pdf"
    source.write_text(text, encoding="utf-8")
    # As root Chromium runs only without its sandbox; the page is our own and loads nothing.
    sandbox = ("--no-sandbox",) if hasattr(os, "geteuid") and os.geteuid() == 0 else ()
    words = [found, *FLAGS, *sandbox, f"--user-data-dir={folder}/profile", f"--print-to-pdf={made}"]
    try:
        done = subprocess.run([*words, source.as_uri()], capture_output=True, timeout=time_limit, check=False)
    except subprocess.TimeoutExpired:
        raise NoBrowser(f"{found} did not print {page} within {time_limit:g} s; raise --time-limit") from None
    except OSError as error:
        raise NoBrowser(f"{found} could not be started ({error.strerror or error})") from None
    if done.returncode != 0 or not made.exists():
        raise NoBrowser(f"{found} ended with code {done.returncode} and printed nothing of {page}")
    try:
        return made.read_bytes()
    except OSError as error:
        raise StoreError(f"{made}: cannot be read ({error.strerror})") from None
