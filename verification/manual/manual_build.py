"""The manual as HTML pages, built by Sphinx from Markdown, docstrings, case files, records; and as one PDF.

Requires the extra ``manual``. Any warning of Sphinx or of MyST, a broken link inside among them, is an error.
The PDF has its contents, through an installed Chromium.
"""

import base64
import io
import re
import shutil
import tempfile
from importlib.metadata import version
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from verification.manual.generated_blocks import BLOCKS, SOURCE
from verification.manual.generated_pages import generated_pages
from verification.page.pdf_file import printed

NEEDED = ("sphinx", "myst_parser", "furo")
BLOCK = re.compile(r"^```\{generated\} (\w+)\n```$", re.MULTILINE)
HTML, ONE_PAGE = "html", "singlehtml"
MARK = "objects.inv"  # a file of every manual, by which a folder is known as one


class ManualError(ValueError):
    """The manual cannot be built as it is."""


def build(folder: Path, one_page: Path | None = None) -> Path:
    """Write the manual to ``folder``; returns its first page.

    one_page : where it is also written as one page, to be printed.
    Raises ManualError with every warning of the build, or where ``folder`` holds something else.
    """
    if folder.exists() and any(folder.iterdir()) and not (folder / MARK).exists():
        raise ManualError(f"{folder}: holds something else than a manual; give another --output")
    missing = [name for name in NEEDED if find_spec(name) is None]
    if missing:
        raise ManualError(f"{', '.join(missing)} missing; install the extra: pip install 'coatcheck[manual]'")
    with tempfile.TemporaryDirectory() as work:
        source = Path(work) / "source"
        assemble(source)
        warnings = _run(source, folder, HTML)
        if one_page is not None:
            warnings += _run(source, one_page, ONE_PAGE)
    if warnings:
        raise ManualError("the manual has errors:\n" + "\n".join(warnings[:50]))
    return folder / "index.html"


def _run(source: Path, folder: Path, style: str) -> list[str]:
    """Warnings of Sphinx, which writes the pages to ``folder``; a second style reads nothing again."""
    from sphinx.application import Sphinx
    from sphinx.util.docutils import docutils_namespace, patch_docutils

    warnings = io.StringIO()
    with patch_docutils(), docutils_namespace():
        app = Sphinx(
            srcdir=source,
            confdir=None,
            outdir=folder.resolve(),
            doctreedir=source.parent / "doctrees",
            buildername=style,
            confoverrides=_settings(style),
            status=None,
            warning=warnings,
        )
        app.build()
    return [line.replace(f"{source}/", "") for line in warnings.getvalue().splitlines() if line.strip()]


def assemble(source: Path) -> None:
    """Write every page with its figures to the new folder ``source``: those kept here, those generated.

    Raises ManualError for a generated block that does not exist, or a page that is both.
    """
    shutil.copytree(SOURCE, source)
    for path in sorted(source.rglob("*.md")):
        path.write_text(_with_blocks(path.read_text(encoding="utf-8"), path.name), encoding="utf-8")
    for name, content in generated_pages():
        path = source / name
        if path.exists():
            raise ManualError(f"{name}: generated, and kept in {SOURCE.name}/ too; rename that one")
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content if isinstance(content, bytes) else _with_blocks(content, name).encode())


def _with_blocks(text: str, page: str) -> str:
    """The text with every ``{generated}`` block replaced by what the function of that name returns."""

    def block(found: re.Match[str]) -> str:
        if found[1] not in BLOCKS:
            raise ManualError(f"{page}: no generated block {found[1]!r}; there are {', '.join(BLOCKS)}")
        return BLOCKS[found[1]]()

    return BLOCK.sub(block, text)


def _settings(style: str) -> dict[str, Any]:
    """Configuration of Sphinx: nothing of a page is loaded from the network."""
    return {
        "project": "coatcheck",
        "author": "the coatcheck authors",
        "copyright": "the coatcheck authors",
        "version": version("coatcheck"),
        "release": version("coatcheck"),
        "extensions": ["myst_parser", "sphinx.ext.autodoc", "verification.manual.sphinx_extension"],
        "myst_enable_extensions": ["dollarmath", "amsmath", "deflist", "colon_fence", "attrs_inline"],
        "myst_heading_anchors": 4,
        "html_math_renderer": "mathml",
        "html_theme": "furo" if style == HTML else "basic",
        "html_title": f"coatcheck {version('coatcheck')}",
        "html_static_path": ["_static"],
        "html_css_files": ["manual.css"] if style == HTML else ["manual.css", "print.css"],
        "html_show_sourcelink": False,
        "html_copy_source": False,
        "html_use_index": True,
        "pygments_style": "a11y-high-contrast-light",
        "autodoc_typehints": "signature",
        "autodoc_member_order": "bysource",
        "autodoc_class_signature": "separated",
        "python_maximum_signature_line_length": 90,
        "add_module_names": False,
        "toc_object_entries": False,  # the contents beside each page, copied for every other page
        "exclude_patterns": ["_static"],
        # A record that three packages name alike, in an annotation: no link, rather than one of the three.
        "suppress_warnings": ["ref.python"],
    }


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
