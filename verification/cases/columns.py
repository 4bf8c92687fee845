"""Columns of a published table as profiles on lines with the digitisation uncertainty of the source."""

from dataclasses import dataclass
from math import isfinite

import numpy as np
from numpy.typing import NDArray

from verification.cases.schema import ColumnEntry, PositionEntry, TableEntry
from verification.cases.table import PublishedError, PublishedTable
from verification.problem.arrays import Array
from verification.problem.contact import PrescribedLoad
from verification.problem.loading import CONTROLS, LoadingCurve, Problem
from verification.problem.points import Points
from verification.problem.profile import Profile
from verification.problem.quantity import CURVES, EXTREMES, PEAKS, QUANTITIES, SCALARS
from verification.sources.registry import PUBLISHED


@dataclass(frozen=True, eq=False)
class PublishedColumn:
    """One column of a table on one line.

    profile : in SI, tension positive, with the digitisation uncertainty.   at : the points of its values.
    rows : their lines in ``file``, with their ``labels``.   text : the cells as printed, in ``unit``.
    to_si : SI value of a printed 1, with its sign.   why_not : reason why a row does not count, or "".
    scale : divisor of differences [SI].   series : coefficients of a power series, see ``ColumnEntry``.
    """

    profile: Profile
    at: Points
    file: str
    column: str
    rows: tuple[int, ...]
    text: tuple[str, ...]
    labels: tuple[str, ...]
    unit: str
    to_si: float
    why_not: tuple[str, ...]
    scale: float
    series: tuple[float, ...] = ()

    @property
    def counted(self) -> NDArray[np.bool_]:
        """True for the rows that count."""
        return np.array([not why for why in self.why_not])


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
    content = content.where(table.rows) if table.rows else content
    labels = content.text(table.label) if table.label else ("",) * len(content.rows)
    found = []
    for i, column in enumerate(table.column):
        here = f"{table.file}, column {column.name}"
        named = f"{here}: quantity {column.quantity!r}"
        known = [name for name in QUANTITIES if name not in PEAKS]
        if column.quantity not in known:
            raise PublishedError(f"{named} is unknown; known are {', '.join(known)}")
        fits = (column.quantity in CURVES) == isinstance(problem, LoadingCurve)
        if not fits and column.quantity not in SCALARS:
            raise PublishedError(
                f"{named} does not go with this problem; {', '.join(CURVES)} belong to a sphere without a "
                "load, all others to a load"
            )
        at = column.at or table.at
        if at is None and column.quantity not in SCALARS + EXTREMES:
            raise ValueError(f"{key}.column.{i}: has no positions; give at")
        try:
            to_si = column.factor * si_of(column.unit, units, here)
        except ValueError as error:
            raise PublishedError(str(error)) from None
        points = _points(at, content, units, problem, here)
        value = np.array(content.numbers(column.name)) * to_si
        why_not = _why_not(table, content, column.name)
        counted = np.array([not why for why in why_not])
        U = _uncertainty(column, content, counted) * abs(to_si)
        scale = _scale(column, table, content, units, problem)
        for name, rows in points.lines():
            line = f"{name}, {content.path.stem}, column {column.name}"
            part = points.part(rows)
            profile = Profile(column.quantity, line, part.along, value[rows], PUBLISHED, U[rows])
            found.append(
                PublishedColumn(
                    profile,
                    part,
                    table.file,
                    column.name,
                    tuple(content.lines[n] for n in rows),
                    tuple(content.text(column.name)[n] for n in rows),
                    tuple(labels[n] for n in rows),
                    column.unit,
                    to_si,
                    tuple(column.not_counted or why_not[n] for n in rows),
                    scale,
                    tuple(column.series),
                )
            )
    return found


def _points(
    at: PositionEntry | None, content: PublishedTable, units: dict[str, float], problem: Problem, where: str
) -> Points:
    n = len(content.rows)
    if at is None:
        return Points.origin(n)
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
                    return Points.on_curve(control, metres(given), at.unit, unit)
            raise ValueError(f"at: give {' or '.join(CONTROLS)}, for the sphere has no load")
        x, y, z = (metres(v) for v in (at.x, at.y, at.z))
        return Points.of(x, y, z, problem.coatings, at.layer, at.unit, unit)
    except ValueError as error:
        raise PublishedError(f"{where}: {error}") from None


def _why_not(table: TableEntry, content: PublishedTable, column: str) -> list[str]:
    """Reason why each row does not count, flagged or named as a misprint; "" for one that counts."""
    why = [""] * len(content.rows)
    if table.flag is not None:
        why = ["misprint" if cell else "" for cell in content.text(table.flag)]
    for misprint in table.misprint:
        content.text(misprint.column)
        named = content.where(misprint.row).lines
        if misprint.column == column:
            why = [misprint.why if line in named else w for line, w in zip(content.lines, why, strict=True)]
    return why


def _uncertainty(column: ColumnEntry, content: PublishedTable, counted: NDArray[np.bool_]) -> Array:
    """Digitisation uncertainty of every row, in the unit of the column.

    As stated by the file; or half of the last digit, plus the error of the program that printed it or, where
    each row is of another program, the range of the rows.
    """
    if column.relative is not None:
        return column.relative * np.abs(content.numbers(column.name))
    if isinstance(column.uncertainty, float):
        return np.full(len(content.rows), column.uncertainty)
    rounding = np.array(content.half_digits(column.name, column.significant))
    if column.uncertainty == "range":
        return rounding + (np.ptp(np.array(content.numbers(column.name))[counted]) if counted.any() else 0.0)
    return rounding + column.program_error


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
        counted = np.array([not why for why in _why_not(table, content, c.name)])
        printed = np.abs(content.numbers(c.name))[counted]
        largest = max(largest, float(printed.max(initial=0.0) * abs(c.factor) * units[c.unit]))
    return largest
