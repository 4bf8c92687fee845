"""The door of files: every problem as JSON, its points as CSV to fill in, for codes that nobody else can run.

    DIR/answers/CASE/problem.json     the question of the protocol
    DIR/answers/CASE/contact.csv      quantity, unit, value, uncertainty
    DIR/answers/CASE/points.csv       number, line, x, y, z, layer, one column for each quantity

With a refinement study there is a directory for each level below that of the case. A cell that is left empty
is not answered. A column ``U QUANTITY`` may be added; otherwise no uncertainty is stated.
"""

import csv
import io
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from verification.guests.exam_subjects import Subject
from verification.guests.guest_description import Guest
from verification.guests.guest_protocol import VERSION, Answer, ProtocolError, Question, check
from verification.problem.quantity import unit_of
from verification.running.checked_files import StoreError, read_bounded, write_atomically

MOST_BYTES = 20_000_000
HEAD = ("number", "line", "x", "y", "z", "layer")


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
    for number, (line, i) in enumerate(_points(question)):
        # A cell of a quantity that is not wanted on this line is no cell to fill in.
        cells = ["" if q in line.quantities else "-" for q in quantities]
        at = [repr(v) for v in (line.x[i], line.y[i], line.z[i])]
        points.append([number, line.line, *at, line.layer[i], *cells])
    texts = {
        "problem.json": json.dumps(question.model_dump() | {"units": units.model_dump()}, indent=1) + "\n",
        "contact.csv": _written([["quantity", "unit", "value", "uncertainty"], *rows]),
        "points.csv": _written(points),
    }
    for name, text in texts.items():
        if not (folder / name).exists() and (name != "points.csv" or question.lines):
            write_atomically(folder / name, text)
    return folder


def read_answer(guest: Guest, case: Subject, question: Question) -> Answer:
    """The answer that was filled in. Raises ProtocolError naming file, row and column."""
    folder = place_of(guest, case, question)
    values: dict[str, dict[str, Any]] = {}
    uncertainty: dict[str, dict[str, Any]] = {}
    for number, row in enumerate(_rows(folder / "contact.csv"), start=2):
        where, name = f"{folder / 'contact.csv'}: row {number}", row.get("quantity") or ""
        if row.get("value") and name in question.contact:
            values.setdefault("contact", {})[name] = _number(row["value"], where)
            if row.get("uncertainty"):
                uncertainty.setdefault("contact", {})[name] = _number(row["uncertainty"], where)
    if question.lines:
        _read_points(folder / "points.csv", question, values, uncertainty)
    if not values:
        return Answer(protocol=VERSION, id=question.id, unsupported=f"nothing is filled in in {folder.name}")
    answer = Answer(protocol=VERSION, id=question.id, values=values, uncertainty=uncertainty)
    check(answer, question)
    return answer


def _read_points(
    path: Path, question: Question, values: dict[str, dict[str, Any]], uncertainty: dict[str, dict[str, Any]]
) -> None:
    rows: dict[str, tuple[str, dict[str, Any]]] = {}
    for number, row in enumerate(_rows(path), start=2):
        key = (row.get("number") or "").strip()
        if key in rows:
            raise ProtocolError(f"{path}: row {number}: number {key[:20]!r} occurs twice")
        rows[key] = (f"{path}: row {number}", row)
    points = list(_points(question))
    if set(rows) != {str(i) for i in range(len(points))}:
        raise ProtocolError(
            f"{path}: {len(rows)} rows; numbers 0 to {len(points) - 1}, each once, are needed"
        )
    for prefix, found in (("", values), ("U ", uncertainty)):
        for line in question.lines:
            for q in line.quantities:
                cells = [
                    (rows[str(i)][0], rows[str(i)][1].get(prefix + q) or "")
                    for i, (other, _) in enumerate(points)
                    if other is line
                ]
                if any(text.strip() for _, text in cells):
                    numbers = [_number(text, f"{where}, {prefix}{q}") for where, text in cells]
                    found.setdefault(line.line, {})[q] = numbers


def _points(question: Question) -> Iterator[tuple[Any, int]]:
    """Each line of ``question`` with the number of each of its points, in the order of the file."""
    for line in question.lines:
        for i in range(len(line.x)):
            yield line, i


def _rows(path: Path) -> list[dict[str, Any]]:
    try:
        text = read_bounded(path, MOST_BYTES).decode("utf-8-sig")
    except (StoreError, UnicodeDecodeError) as error:
        raise ProtocolError(
            f"{error}" if isinstance(error, StoreError) else f"{path}: not UTF-8 text"
        ) from None
    # Spreadsheets of some languages separate by semicolons, with a decimal comma.
    head = text.partition("\n")[0]
    separator = ";" if head.count(";") > head.count(",") else ","
    try:
        return list(csv.DictReader(io.StringIO(text), delimiter=separator))
    except csv.Error as error:
        raise ProtocolError(f"{path}: not CSV ({error})") from None


def _number(text: str, where: str) -> float:
    try:
        return float(text.strip().replace(",", "."))
    except ValueError:
        shown = text.strip()[:20]
        raise ProtocolError(f"{where}: {shown!r} is not a number" if shown else f"{where} is empty") from None


def _written(rows: list[list[Any]]) -> str:
    out = io.StringIO()
    csv.writer(out, lineterminator="\n").writerows(rows)
    return out.getvalue()


def _unit(unit: str, units: Any) -> str:
    names = {"m": units.length, "Pa": units.stress, "N": units.force}
    return names.get(unit, f"{units.force}/{units.length}" if unit == "N/m" else unit)
