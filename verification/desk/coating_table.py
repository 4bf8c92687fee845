"""Several coatings side by side: a row of a table each, solved, judged, written as table and as one page.

A solid is in one column, "coating 1" with "TiN 2 um, 450 GPa, 0.25, strength 2 GPa", or in one for each
number: "coating 1" with its name, "coating 1 thickness [um]", "coating 1 E [GPa]", "coating 1 nu",
"coating 1 strength [GPa]". A unit in the head is that of the numbers below.
"""

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import matplotlib as mpl
import numpy as np
from markupsafe import Markup
from matplotlib.figure import Figure

from verification.cases.case_file import Case, parse_case
from verification.cases.plausibility import refused
from verification.cases.toml_file import CaseError
from verification.desk.case_wording import case_text
from verification.desk.contact_answer import answer, summary
from verification.desk.layer_limits import MODES, LayerMode, layer_modes, place_name, strengths_of, verdict
from verification.desk.stack_text import conditions, stack
from verification.desk.table_file import read_cells
from verification.page.figures import inline, written
from verification.page.html_page import render_sections
from verification.page.page_parts import Gallery, Panel, Part, Section, Value, number, table_of, words
from verification.running.case_result import message_of
from verification.sources.source_registry import METHODS

COLUMNS = ("name", "ball", "load", "substrate", "friction")  # beside those that begin with "coating"
MOST_ROWS = 1000
_HEAD = re.compile(r"(ball|substrate|coating ?\d*|name|load|friction)(?: (.*?))?(?: ?[\[(](.*)[\])])?")
_NUMBERS = {"radius": "", "diameter": "d = ", "thickness": "", "E": "", "nu": ""}  # that come first, in order
_STATED = ("strength", "residual stress", "yield strength", "adhesion", "hardness", "expansion")
TYPICAL = "typical values: "  # before the sources of materials given by name
FAILS = tuple(dict.fromkeys(does for does, _, _ in MODES.values()))
HUES = dict(zip(FAILS, ("#0072B2", "#D55E00", "#009E73", "#CC79A7"), strict=True))
HEADS = ("name", "stack", "p0 [MPa]", "a [um]", "sigma_1 coatings [MPa]", "von Mises [MPa]", "shear [MPa]")
VERDICT = ("governing", "used", "safety factor", "message")


@dataclass(frozen=True)
class CoatingRow:
    """One coating of the table, solved: its ``numbers`` in the order of ``HEADS``.

    modes : with their places, where it has strengths.   said : its answer in words.
    message : why it could not be solved, "" where it was.
    """

    name: str
    stack: str = ""
    numbers: tuple[float, ...] = ()
    modes: tuple[tuple[str, LayerMode], ...] = ()
    said: str = ""
    message: str = ""

    @property
    def governing(self) -> tuple[str, LayerMode] | None:
        """The mode nearest to its strength, with its place in words; None without strengths."""
        return max(self.modes, key=lambda pair: pair[1].utilisation, default=None)

    @property
    def cells(self) -> list[str]:
        """The row as text, in the order of ``HEADS``, then of ``VERDICT``."""
        place, mode = self.governing or ("", None)
        judged = (
            [f"{place} {MODES[mode.quantity][0]}", *_digits(mode.utilisation, mode.safety)]
            if mode
            else [""] * 3
        )
        return [self.name, self.stack, *(_digits(*self.numbers) or [""] * 5), *judged, self.message]


def read_rows(path: Path) -> list[Case]:
    """The problem of every row of a table, in the words of ``coatcheck solve``. Raises CaseError."""
    first, *rows = [[cell.strip() for cell in row] for row in read_cells(path)] or [[]]
    heads = [_head(head) for head in first]
    wrong = [head for head, known in zip(first, heads, strict=True) if head and known is None]
    missing = [one for one in COLUMNS[1:4] if not any(head and head[0] == one for head in heads)]
    if wrong or missing:
        what = f"has no column {missing[0]}" if missing else f"has an unknown column {wrong[0]!r}"
        parts = "; or one for each number, such as coating 1 E [GPa]"
        raise CaseError(
            f"{path}: {what}; the columns are {', '.join(COLUMNS)}, coating 1, coating 2, ...{parts}"
        )
    found = []
    for line, cells in enumerate(rows, start=2):
        if not any(cells):
            continue
        given = _words(heads, cells)
        coatings = [word for head, word in given.items() if head.startswith("coating")]
        try:
            friction = float(given.get("friction", 0))
            ball, load, substrate = (given.get(key, "") for key in ("ball", "load", "substrate"))
            words = case_text(ball, load, substrate, coatings, friction)
            case = parse_case(words.encode(), Path(given.get("name") or f"row {line}"))
            for slip in refused(case.problem):
                raise ValueError(slip)
        except ValueError as error:
            raise CaseError(f"{path}: line {line}: {error}") from None
        found.append(case)
    if not 1 <= len(found) <= MOST_ROWS:
        raise CaseError(f"{path}: has {len(found)} coatings; give 1 to {MOST_ROWS}, a row each")
    return found


def _head(text: str) -> tuple[str, str, str] | None:
    """Content of a column: of which solid, which property, in which unit; None where it is unknown."""
    found = _HEAD.fullmatch(" ".join(text.split()).casefold())
    if found is None:
        return None
    of, key = found[1], found[2] or ""
    known = {one.casefold(): one for one in (*_NUMBERS, *_STATED)} | {"": ""}
    known |= {"modulus": "E", "poisson": "nu", "residual": "residual stress", "yield": "yield strength"}
    if key not in known or (key and of in ("name", "load", "friction")):
        return None
    given = re.search(r"[\[(](.*)[\])]\s*$", text)
    return of, known[key], given[1].strip() if given else ""


def _words(heads: Sequence[tuple[str, str, str] | None], cells: Sequence[str]) -> dict[str, str]:
    """The words of a row by their solid: "DLC" with 2 [um], 180 [GPa], 0.2 is "DLC 2 um, 180 GPa, 0.2"."""
    parts: dict[str, dict[str, str]] = {}
    for head, cell in zip(heads, cells, strict=False):
        if head and cell:
            of, key, unit = head
            parts.setdefault(of, {})[key] = f"{cell} {unit}".strip()
    found = {}
    for of, one in parts.items():
        numbers = [f"{mark}{one[key]}" for key, mark in _NUMBERS.items() if key in one]
        first = " ".join([*([one[""]] if "" in one else []), *numbers[:1]])
        stated = [f"{key} {one[key]}" for key in _STATED if key in one]
        found[of] = ", ".join([first, *numbers[1:], *stated])
    return found


def solved_row(case: Case) -> CoatingRow:
    """One row solved by the semi-analytical method, without its uncertainty; a failure is its message."""
    try:
        first = answer(case.problem, METHODS[0], {"estimate_uncertainty": False}, case.residual, case.layers)
        modes = layer_modes(case.problem, first, strengths_of(case.limits), loads=False)
    except Exception as error:  # a row that fails is a row with its message
        return CoatingRow(case.name, stack(case), message=message_of(error))

    def largest(quantity: str, where: str = "") -> float:
        values = [at.value for at in first.extremes if at.quantity == quantity and at.where.startswith(where)]
        return max(values, default=float("nan"))

    p0, a = (first.numbers[name][0] for name in ("peak_pressure", "contact_radius"))
    stresses = (p0, largest("sigma_1", "coating"), largest("von_mises"), largest("|sigma_xz|"))
    scaled = [value / 1e6 for value in stresses]
    said = " ".join(filter(None, (summary(case.problem, first, case.names), verdict(case, modes))))
    named = tuple((place_name(case, one), one) for one in modes)
    return CoatingRow(case.name, stack(case), (scaled[0], a / 1e-6, *scaled[1:]), named, said)


def table_rows(rows: Sequence[CoatingRow]) -> list[list[str | float | None]]:
    """The table for a file: heads, then a row each, whose numbers are numbers."""
    words = {0, 1, len(HEADS), len(HEADS) + len(VERDICT) - 1}
    told = [
        [cell if i in words else float(cell) if cell else None for i, cell in enumerate(row.cells)]
        for row in rows
    ]
    return [[*HEADS, *VERDICT], *told]


def table_page(rows: Sequence[CoatingRow], cases: Sequence[Case], title: str) -> str:
    """One page: the table, a bar of the utilisation of every coating by mode, a section of each."""
    failed = sum(bool(one.message) for one in rows)
    holding = [one.name for one in rows if one.governing and one.governing[1].utilisation <= 1]
    judged = sum(one.governing is not None for one in rows)
    headline = f"{len(rows)} coatings"
    if judged:
        headline = f"{len(holding)} of {judged} coatings with strengths hold"
    table = table_of(
        "By the semi-analytical method, residual stress included, each under its own load.",
        rows,
        [(head, _column(i)) for i, head in enumerate((*HEADS, *VERDICT[:-1])) if i != 1],
        row_css=lambda one: "disagrees" if one.governing and one.governing[1].utilisation > 1 else "",
    )
    sections = [Section("table", "Coatings", [Part("", [table])])]
    if judged:
        panel = Panel("Stress over strength", _bars([one for one in rows if one.modes]), "", "wide")
        caption = "Each bar is one mode at its worst place; beyond the line it fails."
        sections.append(Section("bars", "Utilisation", [Part("", gallery=Gallery([], [panel], caption))]))
    parts = [
        Part(f"{conditions(case.problem)}. {one.message or one.said}", title=f"{one.name}: {one.stack}")
        for one, case in zip(rows, cases, strict=True)
    ]
    sections.append(Section("each", "Each coating", parts))
    typical = [case.source for case in cases if case.source.startswith(TYPICAL)]
    known = sorted({one for source in typical for one in source.removeprefix(TYPICAL).split("; ")})
    facts = [("table", title), ("not solved", str(failed)), *((TYPICAL.strip(": "), one) for one in known)]
    return render_sections("coatcheck compare-coatings", headline, facts, sections)


def _bars(rows: Sequence[CoatingRow]) -> Markup:
    with mpl.rc_context({"font.size": 8}):
        figure = Figure(figsize=(7.5, 0.9 + 0.16 * len(FAILS) * len(rows)), layout="constrained")
        axes = figure.subplots()
        for k, does in enumerate(FAILS):
            used = [
                max(
                    (mode.utilisation for _, mode in one.modes if MODES[mode.quantity][0] == does),
                    default=0.0,
                )
                for one in rows
            ]
            at = np.arange(len(rows)) + 0.2 * (k - 1.5)
            axes.barh(at, used, height=0.18, color=HUES[does], label=does)
        axes.axvline(1.0, color="#c02a2a", linewidth=1.0, linestyle=(0, (4, 2)))
        axes.set_yticks(range(len(rows)), [one.name for one in rows])
        axes.invert_yaxis()
        axes.set_xlabel("stress over strength")
        axes.legend(loc="upper center", bbox_to_anchor=(0.5, 1.0 + 0.5 / len(rows)), ncols=4, frameon=False)
        return inline(written(figure), "Stress over strength of each coating by mode", css="print")


def _digits(*values: float) -> list[str]:
    return ["" if value != value else f"{float(f'{value:.3g}'):g}" for value in values]


def _column(i: int) -> Callable[[CoatingRow], Value]:
    """Cells of the column ``i``: words, or numbers to sort by."""

    def cell(row: CoatingRow) -> Value:
        text = row.cells[i]
        if i == len(HEADS):
            return words(text)
        return text if i == 0 or not text else number(float(text), lambda _: text)

    return cell
