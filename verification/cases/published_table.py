"""Published tables: CSV files, and their columns as profiles on lines with the uncertainty of the source.

The first lines of a file, marked #, are notes on the source. Cells are kept as published, then converted in
unit and sign. The uncertainty of a cell is what the source printed (half of its last digit) or a digitisation
uncertainty stated by the case file. It depends on no value of the table and is at most ``CEILING`` of the
scale. Neither the disagreement of several programs nor the error of a program is part of it: a cell that is
off by more is a departure of the source and listed with its size.
"""

import csv
import io
from dataclasses import dataclass, replace
from math import floor, isfinite, log10
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from verification.cases.published_schema import ColumnEntry, PositionEntry, TableEntry
from verification.cases.toml_file import CaseError
from verification.cases.unit_numbers import FORCES, LENGTHS, STRESSES
from verification.problem.array_types import Array
from verification.problem.coated_contact import PrescribedLoad
from verification.problem.evaluation_points import TablePoints
from verification.problem.line_profile import Profile
from verification.problem.loading_curve import CONTROLS, LoadingCurve, Problem
from verification.problem.quantity import CURVES, EXTREMES, PEAKS, QUANTITIES, SCALARS, SLOPES
from verification.sources.source_registry import PUBLISHED

FOLDER = Path(__file__).parent / "shipped" / "published"
MAX_BYTES = 1_000_000

# SI value of each unit of a table.
UNITS = STRESSES | LENGTHS | FORCES | {"1": 1.0, "microstrain": 1e-6}
CEILING = 0.01  # largest uncertainty of a cell as a fraction of the scale, unless the case file states why
DEPARTURE = "_departure"  # a column of this ending lists the departures of the column named before it
RECOMPUTED = "recomputed"  # value of ``seen`` for tables that the source does not print


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
            raise CaseError(f"{self.path.name}: no row has {wanted}")
        return replace(self, rows=tuple(self.rows[i] for i in kept), lines=tuple(self.lines[i] for i in kept))

    def text(self, column: str) -> tuple[str, ...]:
        """The cells of a column as printed. Raises CaseError where there is no such column."""
        if column not in self.columns:
            known = ", ".join(self.columns)
            raise CaseError(f"{self.path.name}: has no column {column!r}; it has {known}")
        number = self.columns.index(column)
        return tuple(row[number] for row in self.rows)

    def numbers(self, column: str, empty: float | None = None) -> tuple[float, ...]:
        """The cells of a column as numbers; ``empty``, where given, is the value of an empty cell.

        Raises CaseError where one is not a finite number.
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
            raise CaseError(f"{where}: {shown} is not a finite number")
        return value


def read_table(path: Path) -> PublishedTable:
    """Read a CSV file: notes marked #, one line of column names, then rows of as many cells.

    Raises CaseError naming file and line where it is not so.
    """
    try:
        if not path.is_file():
            raise CaseError(f"{path.name}: cannot be read; a table is a file beside its case file")
        with path.open("rb") as file:
            raw = file.read(MAX_BYTES + 1)
        text = raw.decode("utf-8")
    except OSError as error:
        raise CaseError(f"{path.name}: cannot be read ({error.strerror})") from None
    except UnicodeDecodeError:
        raise CaseError(f"{path.name}: not UTF-8 text; a table is a CSV file") from None
    if len(raw) > MAX_BYTES:
        raise CaseError(f"{path.name}: larger than {MAX_BYTES} bytes; split the table")
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
            raise CaseError(f"{path.name}, line {number}: {found}")
        rows.append(cells)
        lines.append(number)
    if header is None or not rows:
        raise CaseError(f"{path.name}: no {'columns' if header is None else 'rows'} in it")
    if len(set(header)) < len(header) or "" in header:
        raise CaseError(f"{path.name}: column names must be given and differ: {', '.join(header)}")
    return PublishedTable(path, text, "\n".join(notes), header, tuple(rows), tuple(lines))


def _last_digit(cell: str) -> float:
    mantissa, _, exponent = cell.lower().partition("e")
    # Of a zero the exponent may be anything.
    return 10.0 ** min(int(exponent or 0) - len(mantissa.partition(".")[2]), 308)


@dataclass(frozen=True, eq=False)
class PublishedColumn:
    """One column of a table on one line.

    profile : as published, in SI, tension positive, with its uncertainty.   at : the points of its values.
    departure : exact solution less published value [SI], 0 where none is listed.
    rows : their lines in ``file``, with their ``labels``.   text : the cells as published, in ``unit``.
    to_si : SI value of a published 1, with its sign.   seen : what was seen of the source.
    scale : divisor of differences [SI].   series : coefficients of a power series, see ``ColumnEntry``.
    """

    profile: Profile
    departure: Array
    at: TablePoints
    file: str
    column: str
    rows: tuple[int, ...]
    text: tuple[str, ...]
    labels: tuple[str, ...]
    unit: str
    to_si: float
    seen: str
    scale: float
    series: tuple[float, ...] = ()

    @property
    def reference(self) -> Profile:
        """The profile with the listed departures added, to which the methods are compared."""
        return replace(self.profile, value=self.profile.value + self.departure)

    @property
    def departs(self) -> NDArray[np.bool_]:
        """True for the rows with a listed departure."""
        return self.departure != 0

    @property
    def counted(self) -> NDArray[np.bool_]:
        """True for the rows that count as published values: not recomputed, without a departure."""
        return ~self.departs & (self.seen != RECOMPUTED)


def si_of(name: str, units: dict[str, float], where: str) -> float:
    """SI value of the unit ``name`` among ``units``. Raises ValueError naming ``where`` it is used."""
    if name not in units:
        raise ValueError(f"{where}: unit {name!r} is unknown; known are {', '.join(units)}")
    if not (isfinite(units[name]) and units[name] > 0):
        raise ValueError(f"{where}: unit {name!r} is {units[name]:g} in this problem; give another unit")
    return units[name]


def columns_of(
    table: TableEntry, content: PublishedTable, units: dict[str, float], problem: Problem, key: str
) -> list[PublishedColumn]:
    """The columns of a table, line by line. Raises CaseError, or ValueError that names a key."""
    content = content.where(table.rows) if table.rows else content
    labels = content.text(table.label) if table.label else ("",) * len(content.rows)
    found = []
    for i, column in enumerate(table.column):
        here = f"{table.file}, column {column.name}"
        named = f"{here}: quantity {column.quantity!r}"
        known = [name for name in QUANTITIES if name not in PEAKS + SLOPES]
        if column.quantity not in known:
            raise CaseError(f"{named} is unknown; known are {', '.join(known)}")
        fits = (column.quantity in CURVES) == isinstance(problem, LoadingCurve)
        if not fits and column.quantity not in SCALARS:
            raise CaseError(
                f"{named} does not go with this problem; {', '.join(CURVES)} belong to a sphere without a "
                "load, all others to a load"
            )
        at = column.at or table.at
        if at is None and column.quantity not in SCALARS + EXTREMES:
            raise ValueError(f"{key}.column.{i}: has no positions; give at")
        try:
            to_si = column.factor * si_of(column.unit, units, here)
        except ValueError as error:
            raise CaseError(str(error)) from None
        points = _points(at, content, units, problem, here)
        value = np.array(content.numbers(column.name)) * to_si
        if column.uncertainty is not None:
            U = np.full(value.shape, column.uncertainty) * abs(to_si)
        else:
            U = np.array(content.half_digits(column.name, column.significant)) * abs(to_si)
        scale = _scale(column, table, content, units, problem)
        _check_ceiling(table, content, U / scale if scale else np.full(len(U), np.inf), here)
        departure = np.zeros(value.shape)
        if (listed := column.name + DEPARTURE) in content.columns:
            departure = np.array(content.numbers(listed, empty=0.0)) * to_si
        _check_departures(content, departure, U, here)
        for name, rows in points.lines():
            line = f"{name}, {content.path.stem}, column {column.name}"
            part = points.part(rows)
            profile = Profile(column.quantity, line, part.along, value[rows], PUBLISHED, U[rows])
            found.append(
                PublishedColumn(
                    profile,
                    departure[rows],
                    part,
                    table.file,
                    column.name,
                    tuple(content.lines[n] for n in rows),
                    tuple(content.text(column.name)[n] for n in rows),
                    tuple(labels[n] for n in rows),
                    column.unit,
                    to_si,
                    table.seen,
                    scale,
                    tuple(column.series),
                )
            )
    return found


def _points(
    at: PositionEntry | None, content: PublishedTable, units: dict[str, float], problem: Problem, where: str
) -> TablePoints:
    n = len(content.rows)
    if at is None:
        return TablePoints.origin(n)
    try:
        unit = si_of(at.unit, units, "at")

        def metres(given: str | float) -> Array:
            value = np.array(content.numbers(given)) if isinstance(given, str) else np.full(n, given)
            if not np.all(abs(value) <= np.finfo(float).max / max(unit, 1.0)):
                raise ValueError(
                    f"at: {given} in {at.unit!r} is too large for floating point; give another unit"
                )
            return value * unit

        if isinstance(problem, LoadingCurve):
            for control in CONTROLS:
                if (given := getattr(at, control)) is not None:
                    return TablePoints.on_curve(control, metres(given), at.unit, unit)
            raise ValueError(f"at: give {' or '.join(CONTROLS)}, for the sphere has no load")
        x, y, z = (metres(v) for v in (at.x, at.y, at.z))
        return TablePoints.of(x, y, z, problem.coatings, at.layer, at.unit, unit)
    except ValueError as error:
        raise CaseError(f"{where}: {error}") from None


def _check_departures(content: PublishedTable, departure: Array, U: Array, where: str) -> None:
    """Raise CaseError naming the first row whose listed departure is no larger than its uncertainty."""
    for line, size, least in zip(content.lines, abs(departure), U, strict=True):
        if 0 < size <= least:
            raise CaseError(f"{where}, line {line}: the departure is within the uncertainty; remove it")


def _check_ceiling(table: TableEntry, content: PublishedTable, fraction: Array, where: str) -> None:
    """Raise CaseError naming the first row whose uncertainty exceeds the ceiling."""
    ceiling = CEILING if table.ceiling is None else table.ceiling.fraction
    for line, found in zip(content.lines, fraction, strict=True):
        if not found <= ceiling:
            raise CaseError(
                f"{where}, line {line}: the uncertainty is {found:.2g} of the scale, above the ceiling "
                f"{ceiling:g}; give ceiling = {{ fraction, why }} where the source supports no less"
            )


def _scale(
    column: ColumnEntry, table: TableEntry, content: PublishedTable, units: dict[str, float], problem: Problem
) -> float:
    """Stresses over the pressure; displacements and strains over the largest of their kind in the table."""
    kind = QUANTITIES[column.quantity].kind
    if kind in ("stress", "pressure") and not isinstance(problem, LoadingCurve):
        return problem.pressure if isinstance(problem, PrescribedLoad) else problem.p_h
    known = {name for name, quantity in QUANTITIES.items() if quantity.kind == kind}
    alike = [c for c in table.column if c.quantity in known and c.unit in units]
    if kind in ("scalar", "curve"):
        alike = [column]
    largest = 0.0
    for c in alike:
        published = np.abs(content.numbers(c.name))
        largest = max(largest, float(published.max() * abs(c.factor) * units[c.unit]))
    return largest
