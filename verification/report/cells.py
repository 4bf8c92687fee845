"""The few shapes a report page is made of: cells, rows, tables, sections."""

from collections.abc import Sequence
from dataclasses import dataclass

__all__ = ["Cell", "Row", "Section", "Table"]


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


@dataclass(frozen=True)
class Row:
    """One row: its ``head`` names it, ``css`` colours it."""

    head: Cell
    cells: Sequence[Cell]
    css: str = ""


@dataclass(frozen=True)
class Table:
    """``columns`` head the cells, ``groups`` span them: (title, number of columns), "" for none.

    The first column is that of the row heads.
    """

    caption: str
    columns: Sequence[str]
    rows: Sequence[Row]
    groups: Sequence[tuple[str, int]] = ()
    css: str = ""


@dataclass(frozen=True)
class Section:
    """A part of the page about the run as a whole: paragraphs, each with the tables it introduces."""

    anchor: str
    title: str
    parts: Sequence[tuple[str, Sequence[Table]]]
