"""Pages of the manual: what is kept, what is generated, how docstrings and formulas are typeset."""

import re

import pytest

from verification.manual import build
from verification.manual.blocks import BLOCKS
from verification.manual.typeset import restructured


def test_an_unknown_block_is_refused_with_the_page(tmp_path, monkeypatch):
    source = tmp_path / "kept"
    source.mkdir()
    (source / "page.md").write_text("# Page\n\n```{generated} nothing\n```\n")
    monkeypatch.setattr(build, "SOURCE", source)
    with pytest.raises(build.ManualError, match=r"page.md: no generated block 'nothing'"):
        build.assemble(tmp_path / "out")


def test_a_docstring_keeps_formulas_lists_its_parameters_and_escapes_the_rest():
    text = """|A - B| of *both*, see `compare`.

    u = E* p

a : first [m].   b, c : second,
over two lines. Raises ValueError."""
    assert restructured(text) == (
        r"\|A - B\| of \*both\*, see ``compare``."
        + "\n\n::\n\n        u = E* p\n\n- **a** : first [m].\n- **b, c** : second, over two lines.\n\n"
        + "Raises ValueError.\n"
    )


def test_every_block_of_the_manual_has_content():
    assert [name for name, block in BLOCKS.items() if not block().strip()] == []


@pytest.mark.slow
def test_the_manual_builds_without_a_warning_and_loads_nothing(tmp_path):
    pytest.importorskip("sphinx")
    first = build.build(tmp_path / "manual")
    pages = {path: path.read_text(encoding="utf-8") for path in first.parent.rglob("*.html")}
    assert len(pages) > 20
    loaded = r'<(?:script|img|link|iframe)[^>]+(?:src|href)="(?:https?:)?//'
    assert [path.name for path, text in pages.items() if re.search(loaded, text)] == []
