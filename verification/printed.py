"""A published case: a problem with the tables printed about it, read from one TOML file and its CSV files.

The problem stands in the units of the source and is converted here, at the border; so are the tables, which
become Profiles with the reading uncertainty of the source, so that no comparison asks where they came from.
"""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from verification.case import METHODS, CaseError, load_toml, read_bounded, read_toml
from verification.loading import CONTROLS, CURVES, PUNCH, LoadingCurve
from verification.printed_file import (
    PrintedAt,
    PrintedColumn,
    PrintedFile,
    PrintedLayer,
    PrintedProblem,
    PrintedTable,
)
from verification.problem import CoatedContact, PrescribedLoad
from verification.profile import Profile
from verification.quantity import EXTREMES, QUANTITIES, SCALAR, Points
from verification.references.published import (
    FOLDER,
    UNITS,
    PublishedError,
    PublishedTable,
    read_table,
)
from verification.verdict import Claim

__all__ = [
    "PRINTED",
    "REFERENCE",
    "Printed",
    "Problem",
    "PublishedCase",
    "is_published",
    "parse_published",
    "published_cases",
    "read_published",
]

Array = NDArray[np.float64]

PRINTED = "published"  # the source of the profiles made from a table
REFERENCE = "integral_equation"  # the exact answer to spheres and to discs
Problem = CoatedContact | PrescribedLoad | LoadingCurve
# Largest admissible uncertainty of a method, as on the lines of every other case; what the source itself
# leaves unknown comes on top.
CAP = 5e-3


@dataclass(frozen=True, eq=False)
class Printed:
    """One column of a table on one line: where, what, and which rows count.

    profile : in SI, tension positive, with the reading uncertainty.   at : the points of its values.
    rows : their lines in ``file``, with their ``labels``.   text : the cells as printed, in ``unit``.
    to_si : SI value of a printed 1, its sign included.   why_not : why a row does not count, or "".
    scale : what differences are divided by [SI].   series : coefficients that the quantity speaks of.
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


@dataclass(frozen=True)
class PublishedCase:
    """``problem`` with what was ``printed`` about it.

    path : of its file.   text : all it was read from, tables included.
    citation : year, how it was read, whether the primary source was seen, and remarks.
    """

    name: str
    title: str
    problem: Problem
    claims: tuple[Claim, ...]
    printed: tuple[Printed, ...]
    citation: dict[str, Any]
    source: str
    path: Path
    text: str


def published_cases() -> dict[str, Path]:
    """The published cases that are shipped, by name, in the order of their file names."""
    return {path.stem: path for path in sorted(FOLDER.glob("*.toml"))}


def is_published(path: Path) -> bool:
    """True where a case file has tables, which only a published case has."""
    try:
        return "table" in load_toml(read_bounded(path, "case", "one problem"))[1]
    except ValueError:
        return False


def read_published(path: Path) -> PublishedCase:
    """Read one published case. Raises CaseError: one sentence with file and key, or file, row and column."""
    return parse_published(read_bounded(path, "case", "one problem"), path)


def parse_published(raw: bytes, path: Path) -> PublishedCase:
    """Check the text of a published case; its tables lie beside ``path``. Raises CaseError."""
    text, checked = read_toml(raw, path, PrintedFile)
    try:
        problem = _problem(checked.problem)
        units = _units(problem)
        notes, printed, texts = [], [], [text]
        for i, table in enumerate(checked.table):
            content = read_table(path.parent / table.file)
            notes.append(content.notes)
            texts.append(f"# {table.file}\n{content.raw}")
            printed += _printed(table, content, units, problem, f"table.{i}")
        problem = _with_points(problem, printed)
    except PublishedError as error:
        raise CaseError(str(error)) from None
    except (ValueError, OverflowError, ZeroDivisionError) as error:
        raise CaseError(f"{path}: {error}") from None
    return PublishedCase(
        name=path.stem,
        title=checked.title,
        problem=problem,
        claims=tuple(
            _claim(item, source)
            for item in printed
            if item.counted.any()
            for source in (*METHODS, REFERENCE)
            if source in METHODS or _speaks(problem, item.profile.quantity)
        ),
        printed=tuple(printed),
        citation={
            "year": checked.year,
            "primary_read": checked.primary_read,
            "read": checked.read,
            "remark": checked.remark,
            "notes": "\n".join(dict.fromkeys(notes)),
        },
        source=checked.source,
        path=path,
        # The tables belong to the input as much as the file that names them.
        text="\n".join(dict.fromkeys(texts)),
    )


def _speaks(problem: Problem, quantity: str) -> bool:
    """True where the exact reference answers: no displacement under a contact, no sliding disc."""
    if isinstance(problem, PrescribedLoad):
        return not problem.friction
    return QUANTITIES[quantity] != "displacement"


def _with_points(problem: Problem, printed: list[Printed]) -> Problem:
    """A loading curve with the points that its tables ask for."""
    if not isinstance(problem, LoadingCurve):
        return problem
    controls = {item.at.control for item in printed}
    if len(controls) > 1 or "" in controls:
        raise ValueError(
            f"at: one of {', '.join(CONTROLS)} has to say where every value of a loading curve is"
        )
    at = sorted({float(x) for item in printed for x in item.at.along})
    punch = any(item.profile.quantity in PUNCH for item in printed)
    return replace(problem, control=controls.pop(), at=tuple(at), punch=punch)


def _problem(p: PrintedProblem) -> Problem:
    length, stress, force = (
        _unit(value, UNITS, f"problem.{key}")
        for key, value in (
            ("length_unit", p.length_unit),
            ("stress_unit", p.stress_unit),
            ("load_unit", p.load_unit),
        )
    )
    substrate = (p.substrate.E * stress, p.substrate.nu)
    if p.radius is not None and p.load is not None:
        bare = CoatedContact(p.radius * length, p.load * force, (), substrate, p.friction)
        coatings = tuple((c.E * stress, c.nu, _thickness(c, length, bare.a_h)) for c in p.coatings)
        return CoatedContact(bare.radius, bare.load, coatings, substrate, p.friction)
    if p.radius is not None:
        coatings = tuple((c.E * stress, c.nu, _thickness(c, length, None)) for c in p.coatings)
        return LoadingCurve(p.radius * length, CONTROLS[0], (1.0,), coatings, substrate)
    assert p.pressure is not None
    assert p.load_radius is not None
    coatings = tuple((c.E * stress, c.nu, _thickness(c, length, None)) for c in p.coatings)
    return PrescribedLoad(p.pressure * stress, p.load_radius * length, coatings, substrate, p.friction)


def _thickness(c: PrintedLayer, length: float, a_h: float | None) -> float:
    if c.thickness is not None:
        return c.thickness * length
    if c.thickness_over_a_h is None or a_h is None:
        raise ValueError("problem.coatings: every coating needs its thickness")
    return c.thickness_over_a_h * a_h


def _units(problem: Problem) -> dict[str, float]:
    """The units a table of this problem may be printed in: those of UNITS and its own scales."""
    if isinstance(problem, LoadingCurve):
        h, R = problem.coatings[0][2] if problem.coatings else float("inf"), problem.radius
        return UNITS | {"R": R, "h": h, "h^2/R": h**2 / R, "E* h^3/R": problem.E_star * h**3 / R}
    if isinstance(problem, PrescribedLoad):
        return UNITS | {"q": problem.pressure, "a": problem.load_radius}
    return UNITS | {"a_h": problem.a_h, "p_h": problem.p_h, "delta_h": problem.delta_h}


def _unit(name: str, units: dict[str, float], where: str) -> float:
    if name not in units:
        raise ValueError(f"{where}: unit {name!r} is unknown; known are {', '.join(units)}")
    return units[name]


def _printed(
    table: PrintedTable,
    content: PublishedTable,
    units: dict[str, float],
    problem: Problem,
    key: str,
) -> list[Printed]:
    content = content.where(table.rows) if table.rows else content
    labels = content.text(table.label) if table.label else ("",) * len(content.rows)
    found = []
    for i, column in enumerate(table.column):
        here = f"{table.file}, column {column.name}"
        if column.quantity not in QUANTITIES:
            raise PublishedError(
                f"{here}: quantity {column.quantity!r} is unknown; known are {', '.join(QUANTITIES)}"
            )
        if (column.quantity in CURVES) != isinstance(problem, LoadingCurve) and column.quantity not in SCALAR:
            raise PublishedError(
                f"{here}: quantity {column.quantity!r} does not go with this problem; {', '.join(CURVES)} "
                "belong to a sphere without a load, all others to a load"
            )
        at = column.at or table.at
        if at is None and column.quantity not in SCALAR + EXTREMES:
            raise ValueError(f"{key}.column.{i}: says nowhere where its values are; give at")
        try:
            to_si = column.factor * _unit(column.unit, units, here)
        except ValueError as error:
            raise PublishedError(str(error)) from None
        points = _points(at, content, units, problem, here)
        value = np.array(content.numbers(column.name)) * to_si
        why_not = _why_not(table, content, column.name)
        counted = np.array([not why for why in why_not])
        spread = _uncertainty(column, content, counted) * abs(to_si)
        scale = _scale(column, table, content, units, problem)
        for name, rows in points.lines():
            line = f"{name}, {content.path.stem}, column {column.name}"
            part = points.part(rows)
            profile = Profile(column.quantity, line, part.along, value[rows], PRINTED, spread[rows])
            found.append(
                Printed(
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
    at: PrintedAt | None,
    content: PublishedTable,
    units: dict[str, float],
    problem: Problem,
    where: str,
) -> Points:
    n = len(content.rows)
    if at is None:
        return Points.origin(n)

    def numbers(given: str | float) -> Array:
        return np.array(content.numbers(given)) if isinstance(given, str) else np.full(n, given)

    x, y, z = (numbers(v) for v in (at.x, at.y, at.z))
    try:
        unit = _unit(at.unit, units, "at")
        if isinstance(problem, LoadingCurve):
            for control in CONTROLS:
                if (given := getattr(at, control)) is not None:
                    return Points.on_curve(control, numbers(given) * unit, at.unit, unit)
            raise ValueError(f"at: give {' or '.join(CONTROLS)}, for the sphere has no load")
        return Points.of(x * unit, y * unit, z * unit, problem.coatings, at.layer, at.unit, unit)
    except ValueError as error:
        raise PublishedError(f"{where}: {error}") from None


def _why_not(table: PrintedTable, content: PublishedTable, column: str) -> list[str]:
    """Why a row does not count: it is flagged, or the cell named, as a misprint; "" for one that counts."""
    why = [""] * len(content.rows)
    if table.flag is not None:
        why = ["misprint" if cell else "" for cell in content.text(table.flag)]
    for misprint in table.misprint:
        content.text(misprint.column)
        named = content.where(misprint.row).lines
        if misprint.column == column:
            why = [misprint.why if line in named else w for line, w in zip(content.lines, why, strict=True)]
    return why


def _uncertainty(column: PrintedColumn, content: PublishedTable, counted: NDArray[np.bool_]) -> Array:
    """Reading uncertainty of every row, in the unit of the column.

    Stated by the file; or half the last digit with the error of the program that printed it; or, where
    several programs speak row by row, with all that they differ by.
    """
    if column.relative is not None:
        return column.relative * np.abs(content.numbers(column.name))
    if isinstance(column.uncertainty, float):
        return np.full(len(content.rows), column.uncertainty)
    rounding = np.array(content.half_digits(column.name, column.significant))
    if column.uncertainty == "spread":
        return rounding + (np.ptp(np.array(content.numbers(column.name))[counted]) if counted.any() else 0.0)
    return rounding + column.program_error


def _scale(
    column: PrintedColumn,
    table: PrintedTable,
    content: PublishedTable,
    units: dict[str, float],
    problem: Problem,
) -> float:
    """Stresses over the pressure; displacements and strains over the largest of their kind in the table."""
    kind = QUANTITIES[column.quantity]
    if kind in ("stress", "pressure") and not isinstance(problem, LoadingCurve):
        return problem.pressure if isinstance(problem, PrescribedLoad) else problem.p_h
    alike = [c for c in table.column if QUANTITIES.get(c.quantity) == kind and c.unit in units]
    if kind in ("scalar", "curve"):
        alike = [column]
    largest = 0.0
    for c in alike:
        counted = np.array([not why for why in _why_not(table, content, c.name)])
        printed = np.abs(content.numbers(c.name))[counted]
        largest = max(largest, float(printed.max(initial=0.0) * abs(c.factor) * units[c.unit]))
    return largest


def _claim(item: Printed, source: str) -> Claim:
    spread = item.profile.uncertainty
    assert spread is not None
    cap = CAP + float(spread[item.counted].max()) / item.scale if item.scale else CAP
    why = f"printed in column {item.column} of {item.file}"
    return Claim(item.profile.quantity, item.profile.line, (source, PRINTED), cap, why)
