"""Tables as people keep them: CSV and XLSX, read cell by cell as text, written from rows."""

import csv
import io
from collections.abc import Sequence
from itertools import islice
from pathlib import Path
from zipfile import BadZipFile, ZipFile

from verification.cases.case_file import Case
from verification.cases.toml_file import CaseError
from verification.desk.contact_answer import ContactAnswer, symbol_and_unit, with_name
from verification.desk.material_spread import Spread
from verification.running.checked_files import rows_of_csv, write_atomically

MOST_ROWS, MOST_COLUMNS, MOST_BYTES, MOST_UNPACKED = 100_000, 200, 5_000_000, 50_000_000
FORMATS = (".csv", ".xlsx")
MISSING = "openpyxl is not installed here; python -m pip install 'coatcheck[xlsx]', or use CSV"
Cell = str | float | None


def read_cells(path: Path) -> list[list[str]]:
    """The cells of a CSV file, or of the first sheet of an XLSX file, as text. Raises CaseError.

    CSV as of ``rows_of_csv``.
    """
    try:
        with path.open("rb") as file:
            raw = file.read(MOST_BYTES + 1)
        if len(raw) > MOST_BYTES:
            raise CaseError(f"{path}: larger than {MOST_BYTES} bytes; leave out what is no table")
        if path.suffix.lower() == ".xlsx":
            return _of_workbook(path, raw)
        text = raw.decode("utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        raise CaseError(f"{path}: cannot be read as CSV in UTF-8 ({error})") from None
    try:
        return rows_of_csv(text)
    except csv.Error as error:
        raise CaseError(f"{path}: not CSV ({error})") from None


def _of_workbook(path: Path, raw: bytes) -> list[list[str]]:
    """Rows of the first sheet; a cell with a formula has the value that was last saved."""
    try:
        from openpyxl import load_workbook
    except ImportError:
        raise CaseError(f"{path}: {MISSING}") from None
    try:
        if sum(part.file_size for part in ZipFile(io.BytesIO(raw)).infolist()) > MOST_UNPACKED:
            raise CaseError(f"{path}: unpacks to more than {MOST_UNPACKED} bytes; leave out what is no table")
        sheet = load_workbook(io.BytesIO(raw), read_only=True, data_only=True).worksheets[0]
        rows = islice(sheet.iter_rows(values_only=True), MOST_ROWS)
        return [
            ["" if one is None else f"{one:.15g}" if isinstance(one, float) else str(one) for one in row]
            for row in (row[:MOST_COLUMNS] for row in rows)
        ]
    except (BadZipFile, KeyError, IndexError, ValueError, TypeError, AttributeError) as error:
        if isinstance(error, CaseError):
            raise
        raise CaseError(f"{path}: not an XLSX workbook ({error}); save it again, or as CSV") from None


def answer_rows(case: Case, found: ContactAnswer, spread: Spread | None = None) -> list[list[Cell]]:
    """Every number of an answer in SI units, a row each, with the ends of its range."""
    axes = "xyz" if case.problem.elliptical else "xz"
    heads = ["quantity", "body", "place", "name", "value", "uncertainty", "unit"]
    places = [f"{axis} [m]" for axis in axes]
    rows: list[list[Cell]] = [[*heads, *places, *(("lowest", "highest") if spread else ())]]
    for name, (value, stated) in found.numbers.items():
        ends = spread.ends[name,] if spread else ()
        nowhere = [None] * len(axes)
        rows.append([name, None, "contact", None, value, stated, symbol_and_unit(name)[1], *nowhere, *ends])
    for at in found.extremes:
        named = with_name(at.body, at.where, case.names)
        called = named.removeprefix(at.where).strip(" ()") or None
        ends = spread.ends[at.body, at.quantity, at.where] if spread else ()
        given = (at.value, at.uncertainty, *(getattr(at, axis) for axis in axes))
        numbers = [None if one != one else one for one in given]
        rows.append([at.quantity, at.body, at.where, called, *numbers[:2], "Pa", *numbers[2:], *ends])
    return rows


def write_cells(path: Path, rows: Sequence[Sequence[Cell]]) -> None:
    """Write ``rows`` as CSV or XLSX, by the suffix of ``path``; numbers stay numbers in a workbook.

    Raises CaseError where openpyxl is missing, and StoreError.
    """
    if path.suffix.lower() != ".xlsx":
        out = io.StringIO()
        texts = [[f"{cell:.10g}" if isinstance(cell, float) else cell for cell in row] for row in rows]
        csv.writer(out, lineterminator="\n").writerows(texts)
        write_atomically(path, out.getvalue())
        return
    try:
        from openpyxl import Workbook
        from openpyxl.styles import Font
    except ImportError:
        raise CaseError(f"{path}: {MISSING}") from None
    book, content = Workbook(), io.BytesIO()
    sheet = book.active
    for row in rows:
        sheet.append([None if cell != cell else cell for cell in row])
    for cells in sheet.columns:
        cells[0].font = Font(bold=True)
        width = max(len(str(cell.value or "")) for cell in cells)
        sheet.column_dimensions[cells[0].column_letter].width = min(max(8, width + 1), 60)
    sheet.freeze_panes = "A2"
    book.save(content)
    write_atomically(path, content.getvalue())
