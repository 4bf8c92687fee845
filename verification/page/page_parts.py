"""Parts of a report page: cells, rows, tables, figures, sections."""

import base64
import csv
import gzip
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from io import StringIO
from typing import Any, TypeVar

from markupsafe import Markup

from verification.judging.verdict import Outcome
from verification.page.number_text import scientific
from verification.page.source_labels import OUTCOMES


def embedded(text: str) -> str:
    """``text`` compressed as a data address; the same text always gives the same address."""
    packed = gzip.compress(text.encode(), compresslevel=9, mtime=0)
    return f"data:application/gzip;base64,{base64.b64encode(packed).decode()}"


def written(rows: Sequence[Sequence[str]]) -> str:
    """``rows`` as CSV."""
    out = StringIO()
    csv.writer(out, lineterminator="\n").writerows(rows)
    return out.getvalue()


@dataclass(frozen=True)
class Cell:
    """``text`` of a table cell; ``sort`` orders a column where the text would not.

    css : class names.   note : what a pointer or a screen reader adds.   href : where the cell leads.
    """

    text: str
    sort: float | None = None
    css: str = ""
    note: str = ""
    href: str = ""


Value = Cell | str | float | None
T = TypeVar("T")


def number(value: float | None, show: Callable[[Any], str] = scientific, css: str = "") -> Cell:
    """A cell that shows ``value``, a dash for None, and sorts by it."""
    return Cell("–" if value is None else show(value), value, css)


def words(text: str) -> Cell:
    """A cell of running text, which may wrap."""
    return Cell(text, css="words")


def outcome_cell(outcome: Outcome) -> Cell:
    """A verdict as mark, word and colour; it sorts by how bad it is."""
    style = OUTCOMES[outcome]
    return Cell(f"{style.mark} {style.word}", float(style.rank), f"verdict {style.css}")


def tally(good: int, total: int, css: str = "") -> Cell:
    """A cell "good of total" that sorts by the share."""
    return Cell(f"{good} of {total}", good / total, css)


@dataclass(frozen=True)
class Row:
    """One row: its ``head`` names it, ``css`` colours it."""

    head: Cell
    cells: Sequence[Cell]
    css: str = ""


def row(head: Value, *cells: Value, css: str = "") -> Row:
    """A row of cells; text, a count or another number alone becomes a cell."""
    first, *others = (cell if isinstance(cell, Cell) else _cell(cell) for cell in (head, *cells))
    return Row(first, others, css)


def _cell(value: str | float | None) -> Cell:
    return Cell(value) if isinstance(value, str) else number(value, str if type(value) is int else scientific)


@dataclass(frozen=True)
class Table:
    """``columns`` head the cells, ``groups`` span them: (title, number of columns), "" for none.

    The first column is that of the row heads. A table without rows is false, and not shown.
    """

    caption: str
    columns: Sequence[str]
    rows: Sequence[Row]
    groups: Sequence[tuple[str, int]] = ()
    css: str = ""

    def __bool__(self) -> bool:
        return bool(self.rows)

    @property
    def heads(self) -> list[str]:
        """The columns, each behind the title of its group."""
        over = [title for title, count in self.groups for _ in range(count)] or [""] * len(self.columns)
        return [f"{title}: {head}" if title else head for title, head in zip(over, self.columns, strict=True)]


def table_of(
    caption: str,
    items: Iterable[T],
    columns: Sequence[tuple[str, Callable[[T], Value]]],
    groups: Sequence[tuple[str, int]] = (),
    css: str = "",
    row_css: Callable[[T], str] = lambda _: "",
) -> Table:
    """A table with a row for each of ``items``; ``columns`` are heads, each with what its cells show."""
    rows = [row(*(show(item) for _, show in columns), css=row_css(item)) for item in items]
    return Table(caption, [head for head, _ in columns], rows, groups, css)


@dataclass(frozen=True)
class Panel:
    """One drawn quantity: ``title`` with its scale, the figure, what a reader should look at.

    csv, file : the numbers behind it and the name of their file, where they are not those of its gallery.
    """

    title: str
    figure: Markup
    note: str = ""
    css: str = ""
    csv: str = ""
    file: str = ""


@dataclass(frozen=True)
class Gallery:
    """Figures side by side under one ``legend`` of (swatch, words), over one ``caption``.

    csv : the numbers behind, where they are not those of the tables beside the figures.
    """

    legend: Sequence[tuple[Markup, str]]
    panels: Sequence[Panel]
    caption: str
    csv: str = ""


@dataclass(frozen=True)
class Part:
    """A paragraph of a section with the figures and the tables it introduces, under a ``title`` or none.

    folded : what the reader clicks to unfold all of it; "" where it lies open.   anchor : of its title.
    """

    text: str
    tables: Sequence[Table] = ()
    gallery: Gallery | None = None
    title: str = ""
    folded: str = ""
    anchor: str = ""

    def __bool__(self) -> bool:
        """False where there is nothing to show."""
        return bool(self.text or self.title or self.gallery or any(self.tables))

    @property
    def download(self) -> str:
        """The numbers of the gallery as a data address; "" without a gallery, or where it has none."""
        if self.gallery is None or not (self.gallery.csv or self.tables):
            return ""
        return embedded(self.gallery.csv or written([row for item in self.tables for row in _cells_of(item)]))


@dataclass(frozen=True)
class Section:
    """A part of the page about the run as a whole; ``failures`` are messages shown first."""

    anchor: str
    title: str
    parts: Sequence[Part]
    failures: Sequence[str] = ()


def joined(anchor: str, title: str, sections: Iterable[Section | None]) -> Section | None:
    """One section of several, each of the others under its own title; None of none."""
    found = [one for one in sections if one is not None]
    parts: list[Part] = []
    for one in found:
        parts += [Part("", title=one.title, anchor=one.anchor)] * (one.anchor != anchor)
        parts += one.parts
    return Section(anchor, title, parts, [text for one in found for text in one.failures]) if found else None


def _cells_of(table: Table) -> list[list[str]]:
    """Heads, then rows: the number of a cell where it has one, else its text."""

    def shown(cell: Cell) -> str:
        return cell.text if cell.sort is None or cell.text in ("", "–") else f"{cell.sort:.9g}"

    return [table.heads, *([row.head.text, *map(shown, row.cells)] for row in table.rows), []]
