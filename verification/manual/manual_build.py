"""The manual as HTML pages, built by Sphinx from Markdown, docstrings, case files, records.

Requires the extra ``manual``. Any warning of Sphinx or of MyST, a broken link inside among them, is an error.
"""

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

NEEDED = ("sphinx", "myst_parser", "furo")
BLOCK = re.compile(r"^```\{generated\} (\w+)\n```$", re.MULTILINE)
EXTENSION = "verification.manual.sphinx_extension"
MARK = "objects.inv"  # a file of every manual, by which a folder is known as one


class ManualError(ValueError):
    """The manual cannot be built as it is."""


def build(folder: Path) -> Path:
    """Write the manual to ``folder``; returns its first page.

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
        warnings = _run(source, folder)
    if warnings:
        raise ManualError("the manual has errors:\n" + "\n".join(warnings[:50]))
    return folder / "index.html"


def _run(source: Path, folder: Path) -> list[str]:
    """Warnings of Sphinx, which writes the pages to ``folder``."""
    from sphinx.application import Sphinx
    from sphinx.util.docutils import docutils_namespace, patch_docutils

    warnings = io.StringIO()
    with patch_docutils(), docutils_namespace():
        app = Sphinx(
            srcdir=source,
            confdir=None,
            outdir=folder.resolve(),
            doctreedir=source.parent / "doctrees",
            buildername="html",
            confoverrides=_settings(),
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


def _settings() -> dict[str, Any]:
    """Configuration of Sphinx: nothing of a page is loaded from the network."""
    return {
        "project": "coatcheck",
        "author": "the coatcheck developers",
        "copyright": "the coatcheck developers",
        "version": version("coatcheck"),
        "release": version("coatcheck"),
        "extensions": ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.viewcode", EXTENSION],
        "myst_enable_extensions": ["dollarmath", "amsmath", "deflist", "colon_fence", "attrs_inline"],
        "myst_heading_anchors": 4,
        "html_math_renderer": "mathml",
        "html_theme": "furo",
        "html_title": f"coatcheck {version('coatcheck')}",
        "html_static_path": ["_static"],
        "html_css_files": ["manual.css"],
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
