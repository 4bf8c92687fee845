"""The door of files: every problem as JSON, its points as CSV to fill in, for codes that nobody else can run.

    DIR/answers/CASE/problem.json     the question of the protocol
    DIR/answers/CASE/contact.csv      quantity, unit, value, uncertainty
    DIR/answers/CASE/points.csv       number, line, x, y, z, layer, one column for each quantity
    DIR/answers/CASE/*.frd, *.vtu, nodes.csv     stresses and displacements at nodes, in place of points.csv

With a refinement study there is a directory for each level below that of the case. A cell that is left empty
is not answered. A column ``U QUANTITY`` may be added; otherwise no uncertainty is stated.
"""

import json
from pathlib import Path
from typing import Any

from verification.guests.doors.csv_rows import cell_number, csv_rows
from verification.guests.doors.nodal_files import nodal_file
from verification.guests.exam_subjects import Subject
from verification.guests.guest_description import Guest
from verification.guests.guest_protocol import VERSION, GuestAnswer, ProtocolError, Question
from verification.page.page_parts import written
from verification.problem.quantity import unit_of
from verification.running.checked_files import write_atomically

MOST_BYTES = 20_000_000
HEAD = ("number", "line", "x", "y", "z", "layer")
# By "value" or "uncertainty", line (or "contact"), quantity: the text of each cell with its place.
Cells = dict[tuple[str, str, str], list[tuple[str, str]]]


def place_of(guest: Guest, case: Subject, question: Question) -> Path:
    """Directory of the files of ``question``."""
    assert guest.results is not None
    level = [f"{name}_{value:g}" for name, value in question.parameter.items()]
    return (guest.folder / guest.results / case.name).joinpath(*level)


def pack(guest: Guest, case: Subject, question: Question) -> Path:
    """Write the files of ``question`` that do not exist yet. Returns their directory."""
    folder = place_of(guest, case, question)
    units = guest.units
    rows = [[name, _unit(unit_of(name), units), "", ""] for name in question.contact]
    quantities = list(dict.fromkeys(q for line in question.lines for q in line.quantities))
    points: list[list[Any]] = [[*HEAD, *quantities]]
    for line in question.lines:
        # A cell of a quantity that is not wanted on this line is no cell to fill in.
        cells = ["" if q in line.quantities else "-" for q in quantities]
        for x, y, z, layer in zip(line.x, line.y, line.z, line.layer, strict=True):
            points.append([len(points) - 1, line.line, repr(x), repr(y), repr(z), layer, *cells])
    texts = {
        "problem.json": json.dumps(question.model_dump() | {"units": units.model_dump()}, indent=1) + "\n",
        "contact.csv": written([["quantity", "unit", "value", "uncertainty"], *rows]),
        "points.csv": written(points),
    }
    for name, text in texts.items():
        if not (folder / name).exists() and (name != "points.csv" or question.lines):
            write_atomically(folder / name, text)
    return folder


def read_answer(guest: Guest, case: Subject, question: Question) -> GuestAnswer:
    """The answer that was filled in. Raises ProtocolError naming file, row and column."""
    folder = place_of(guest, case, question)
    cells: Cells = {}
    nodes = nodal_file(folder)
    scalars = folder / "contact.csv"
    for where, row in csv_rows(scalars, MOST_BYTES) if nodes is None or scalars.exists() else ():
        if row.get("quantity") in question.contact:
            for column in ("value", "uncertainty"):
                cells[column, "contact", row["quantity"]] = [(where, row.get(column) or "")]
    if question.lines and (nodes is None or (folder / "points.csv").exists()):
        cells |= _point_cells(folder / "points.csv", question)
    given: dict[str, Any] = {"values": {}, "uncertainty": {}, "missing": {}, "failed": {}, "warnings": []}
    if nodes is not None:
        from verification.guests.doors.nodal_door import answer_of  # imports much of SciPy

        given = answer_of(nodes, list(guest.nodes.axes), question, stated=not guest.levels)
    found: dict[str, dict[str, dict[str, Any]]] = {
        "value": given.pop("values"),
        "uncertainty": given.pop("uncertainty"),
    }
    failed: dict[str, dict[str, str]] = given["failed"]
    for (column, line, name), texts in cells.items():
        if any(text.strip() for _, text in texts):
            try:
                numbers = [cell_number(text, where) for where, text in texts]
            except ProtocolError as error:
                failed.setdefault(line, {})[name] = str(error)
                continue
            found[column].setdefault(line, {})[name] = numbers[0] if line == "contact" else numbers
    values, uncertainty = found.values()
    if not values and not failed:
        return GuestAnswer(
            protocol=VERSION, id=question.id, unsupported=f"nothing is filled in in {folder.name}"
        )
    known = {
        line: {q: v for q, v in by.items() if q in values.get(line, {})} for line, by in uncertainty.items()
    }
    return GuestAnswer(protocol=VERSION, id=question.id, values=values, uncertainty=known, **given)


def _point_cells(path: Path, question: Question) -> Cells:
    rows: dict[str, tuple[str, dict[str, Any]]] = {}
    for where, row in csv_rows(path, MOST_BYTES):
        key = (row.get("number") or "").strip()
        if key in rows:
            raise ProtocolError(f"{where}: number {key[:20]!r} occurs twice")
        rows[key] = where, row
    count = sum(len(line.x) for line in question.lines)
    if set(rows) != {str(i) for i in range(count)}:
        raise ProtocolError(f"{path}: {len(rows)} rows; numbers 0 to {count - 1}, each once, are needed")
    cells, first = {}, 0
    for line in question.lines:
        mine = [rows[str(first + i)] for i in range(len(line.x))]
        first += len(line.x)
        for name in line.quantities:
            for column, head in (("value", name), ("uncertainty", f"U {name}")):
                texts = [(f"{where}, {head}", row.get(head) or "") for where, row in mine]
                cells[column, line.line, name] = texts
    return cells


def _unit(unit: str, units: Any) -> str:
    names = {"m": units.length, "Pa": units.stress, "N": units.force}
    return names.get(unit, f"{units.force}/{units.length}" if unit == "N/m" else unit)
