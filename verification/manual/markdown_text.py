"""Markdown of generated pages: tables, plain text, symbols; parts of a report."""

from collections.abc import Iterable, Sequence

from markupsafe import Markup

from verification.page.page_parts import Part, Table
from verification.page.symbol_text import html
from verification.problem.quantity import QUANTITIES


def table(head: Sequence[str], rows: Iterable[Sequence[str]], right: int = 99) -> str:
    """A table; columns from ``right`` on are aligned at the right."""
    rule = ["---:" if i >= right else "---" for i in range(len(head))]
    lines = [head, rule, *([cell.replace("|", "\\|") for cell in row] for row in rows)]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def text(words: str) -> str:
    """Plain text in which Markdown finds no markup, with the sign of a negative value as a minus."""
    return "".join(f"\\{c}" if c in "\\`*_{}[]<>$#" else c for c in words.replace("= -", "= −"))


def symbol(name: str) -> str:
    """A quantity as a formula."""
    q = QUANTITIES[name]
    # The place of a peak has the symbol of a coordinate, which alone tells too little.
    return f"${q.tex}$" if q.tex and not name.startswith("tension_place") else text(q.symbol)


def typeset(words: str) -> str:
    """``words`` of a report, their symbols as HTML; what is ``Markup`` already stays as it is."""
    if isinstance(words, Markup):
        return str(words)
    return html(words, text)


def shown(found: Table) -> str:
    """A table of a report under its caption."""
    heads = [typeset(head).replace("|", "\\|") for head in found.heads]
    rows = [[typeset(cell.text) for cell in (row.head, *row.cells)] for row in found.rows]
    return f"{typeset(found.caption)}\n\n{table(heads, rows, 1)}"


def paragraphs(parts: Iterable[Part]) -> str:
    """The open parts of a section of a report: their texts and tables, without figures."""
    found = []
    for part in (part for part in parts if part and not part.folded):
        found += [f"**{text(part.title)}**"] * bool(part.title) + [typeset(part.text)] * bool(part.text)
        found += [shown(one) for one in part.tables if one]
    return "\n\n".join(found)
