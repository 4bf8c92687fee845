"""Markdown of generated pages: tables, plain text, symbols."""

from collections.abc import Sequence

from verification.problem.quantity import QUANTITIES


def table(head: Sequence[str], rows: Sequence[Sequence[str]], right: int = 99) -> str:
    """A table; columns from ``right`` on are aligned at the right."""
    rule = ["---:" if i >= right else "---" for i in range(len(head))]
    lines = [head, rule, *([cell.replace("|", "\\|") for cell in row] for row in rows)]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def text(words: str) -> str:
    """Plain text in which Markdown finds no markup."""
    return "".join(f"\\{c}" if c in "\\`*_{}[]<>$#" else c for c in words)


def symbol(name: str) -> str:
    """A quantity as a formula."""
    q = QUANTITIES[name]
    # The place of a peak has the symbol of a coordinate, which alone tells too little.
    return f"${q.tex}$" if q.tex and not name.startswith("tension_place") else text(q.symbol)
