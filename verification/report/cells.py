"""The few shapes a report page is made of: cells, rows, tables, figures, sections."""

from collections.abc import Sequence
from dataclasses import dataclass

from markupsafe import Markup

__all__ = ["Cell", "Gallery", "Panel", "Part", "Row", "Section", "Table"]


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
class Panel:
    """One drawn quantity: ``title`` with its scale, the figure, what a reader should look at."""

    title: str
    figure: Markup
    note: str
    css: str


@dataclass(frozen=True)
class Gallery:
    """Figures side by side under one ``legend`` of (swatch, words), over one ``caption``."""

    legend: Sequence[tuple[Markup, str]]
    panels: Sequence[Panel]
    caption: str


@dataclass(frozen=True)
class Part:
    """A paragraph of a section with the figures and the tables it introduces, under a ``title`` or none."""

    text: str
    tables: Sequence[Table] = ()
    gallery: Gallery | None = None
    title: str = ""


@dataclass(frozen=True)
class Section:
    """A part of the page about the run as a whole; ``failures`` are sentences said before all else."""

    anchor: str
    title: str
    parts: Sequence[Part]
    failures: Sequence[str] = ()
