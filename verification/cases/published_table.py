"""Published tables in CSV files: notes, columns, numbers with their digits.

The first lines, marked #, are notes on the source. Cells are kept as published; ``columns`` converts units
and signs.
"""

import csv
import io
from dataclasses import dataclass, replace
from math import floor, isfinite, log10
from pathlib import Path

FOLDER = Path(__file__).parent / "shipped" / "published"
MAX_BYTES = 1_000_000

INCH, PSI = 0.0254, 6894.757293168361
_STRESSES = {"Pa": 1.0, "kPa": 1e3, "MPa": 1e6, "GPa": 1e9, "psi": PSI, "ksi": 1e3 * PSI}
_LENGTHS = {"m": 1.0, "mm": 1e-3, "um": 1e-6, "in": INCH}
# SI value of each unit of a table.
UNITS = _STRESSES | _LENGTHS | {"N": 1.0, "1": 1.0, "microstrain": 1e-6}


class PublishedError(ValueError):
    """A table that cannot be used; the message names file, row and column."""


@dataclass(frozen=True)
class PublishedTable:
    """The cells of a table as text, row by row, with their line numbers.

    raw : the whole file.
    """

    path: Path
    raw: str
    notes: str
    columns: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    lines: tuple[int, ...]

    def where(self, condition: dict[str, str | float]) -> "PublishedTable":
        """The rows in which every column named has the value given; at least one."""
        kept = [i for i, _ in enumerate(self.rows) if all(self._is(i, c, v) for c, v in condition.items())]
        if not kept:
            wanted = ", ".join(f"{column} = {value}" for column, value in condition.items())
            raise PublishedError(f"{self.path.name}: no row has {wanted}")
        return replace(self, rows=tuple(self.rows[i] for i in kept), lines=tuple(self.lines[i] for i in kept))

    def text(self, column: str) -> tuple[str, ...]:
        """The cells of a column as printed. Raises PublishedError where there is no such column."""
        if column not in self.columns:
            known = ", ".join(self.columns)
            raise PublishedError(f"{self.path.name}: has no column {column!r}; it has {known}")
        number = self.columns.index(column)
        return tuple(row[number] for row in self.rows)

    def numbers(self, column: str, empty: float | None = None) -> tuple[float, ...]:
        """The cells of a column as numbers; ``empty``, where given, is the value of an empty cell.

        Raises PublishedError where one is not a finite number.
        """
        return tuple(
            self._number(i, column, cell) if cell or empty is None else empty
            for i, cell in enumerate(self.text(column))
        )

    def half_digits(self, column: str, significant: int | None = None) -> tuple[float, ...]:
        """Half a unit of the last digit printed, the uncertainty by rounding.

        The last digit is that of the cell with most decimals, since trailing zeros are often dropped; or the
        last of ``significant`` digits in each cell.
        """
        values = self.numbers(column)
        if significant is None:
            return (0.5 * min(_last_digit(cell) for cell in self.text(column)),) * len(values)
        return tuple(0.5 * 10.0 ** (floor(log10(abs(v))) + 1 - significant) if v else 0.0 for v in values)

    def _is(self, row: int, column: str, value: str | float) -> bool:
        cell = self.text(column)[row]
        return cell == value if isinstance(value, str) else self._number(row, column, cell) == value

    def _number(self, row: int, column: str, cell: str) -> float:
        try:
            value = float(cell)
        except ValueError:
            value = float("nan")
        if not isfinite(value):
            shown = repr(cell if len(cell) <= 40 else cell[:37] + "...")
            where = f"{self.path.name}, line {self.lines[row]}, column {column}"
            raise PublishedError(f"{where}: {shown} is not a finite number")
        return value


def read_table(path: Path) -> PublishedTable:
    """Read a CSV file: notes marked #, one line of column names, then rows of as many cells.

    Raises PublishedError naming file and line where it is not so.
    """
    try:
        if not path.is_file():
            raise PublishedError(f"{path.name}: cannot be read; a table is a file beside its case file")
        with path.open("rb") as file:
            raw = file.read(MAX_BYTES + 1)
        text = raw.decode("utf-8")
    except OSError as error:
        raise PublishedError(f"{path.name}: cannot be read ({error.strerror})") from None
    except UnicodeDecodeError:
        raise PublishedError(f"{path.name}: not UTF-8 text; a table is a CSV file") from None
    if len(raw) > MAX_BYTES:
        raise PublishedError(f"{path.name}: larger than {MAX_BYTES} bytes; split the table")
    notes, header, rows, lines = [], None, [], []
    for number, line in enumerate(text.splitlines(), start=1):
        if line.startswith("#") and header is None:
            notes.append(line[1:].strip())
            continue
        if not line.strip():
            continue
        cells = tuple(cell.strip() for cell in next(csv.reader(io.StringIO(line))))
        if header is None:
            header = cells
            continue
        if len(cells) != len(header):
            found = f"{len(cells)} cells under {len(header)} columns ({', '.join(header)})"
            raise PublishedError(f"{path.name}, line {number}: {found}")
        rows.append(cells)
        lines.append(number)
    if header is None or not rows:
        raise PublishedError(f"{path.name}: no {'columns' if header is None else 'rows'} in it")
    if len(set(header)) < len(header) or "" in header:
        raise PublishedError(f"{path.name}: column names must be given and differ: {', '.join(header)}")
    return PublishedTable(path, text, "\n".join(notes), header, tuple(rows), tuple(lines))


def _last_digit(cell: str) -> float:
    mantissa, _, exponent = cell.lower().partition("e")
    # Of a zero the exponent may be anything.
    return 10.0 ** min(int(exponent or 0) - len(mantissa.partition(".")[2]), 308)
