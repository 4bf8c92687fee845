"""A published case: a problem with published tables, read from a TOML file with its CSV files.

The file is in the units of the source and converted to SI here; the tables become Profiles with the
digitisation uncertainty of the source, which are compared like those of any other source.
"""

from dataclasses import dataclass, replace
from itertools import chain, count
from pathlib import Path
from typing import Any

from verification.cases.case_file import Case, parse_case
from verification.cases.published_schema import LayerEntry, ProblemEntry, PublishedFile
from verification.cases.published_table import FOLDER, UNITS, PublishedColumn, columns_of, read_table, si_of
from verification.cases.toml_file import CaseError, load_toml, read_bounded, read_toml
from verification.cases.unit_numbers import of_file
from verification.judging.verdict import Claim
from verification.problem.array_types import Ball, Coatings
from verification.problem.coated_contact import CoatedContact, PrescribedLoad
from verification.problem.loading_curve import CONTROLS, LoadingCurve, Problem
from verification.problem.quantity import QUANTITIES
from verification.sources.source_registry import EXACT, METHODS, PUBLISHED, SOURCES


@dataclass(frozen=True)
class PublishedCase:
    """``problem`` with the ``columns`` published about it.

    path : of its file.   text : that of its files, tables included.
    citation : year, remark, notes; of each table its file, what was ``seen`` of the source, where ``read``.
    """

    name: str
    title: str
    problem: Problem
    claims: tuple[Claim, ...]
    columns: tuple[PublishedColumn, ...]
    citation: dict[str, Any]
    source: str
    path: Path
    text: str


def published_cases() -> dict[str, Path]:
    """The published cases that are shipped, by name, in the order of their file names."""
    return {path.stem: path for path in sorted(FOLDER.glob("*.toml"))}


def is_published(raw: bytes) -> bool:
    """True where the content of a case file has tables, which only a published case has."""
    try:
        return "table" in load_toml(raw)[1]
    except ValueError:
        return False


def read_any_case(path: Path) -> Case | PublishedCase:
    """Read a case file of either kind. Raises CaseError naming file and key."""
    raw = read_bounded(path, "case", "one problem")
    return (parse_published if is_published(raw) else parse_case)(raw, path)


def read_published(path: Path) -> PublishedCase:
    """Read one published case. Raises CaseError naming file and key, or file, row and column."""
    return parse_published(read_bounded(path, "case", "one problem"), path)


def parse_published(raw: bytes, path: Path) -> PublishedCase:
    """Check the text of a published case; its tables lie beside ``path``. Raises CaseError."""
    text, checked = read_toml(raw, path, PublishedFile)
    try:
        problem = _problem(checked.problem)
        units = _units(problem)
        notes, columns, texts = [], [], [text]
        for i, table in enumerate(checked.table):
            content = read_table(path.parent / table.file)
            notes.append(content.notes)
            texts.append(f"# {table.file}\n{content.raw}")
            columns += columns_of(table, content, units, problem, f"table.{i}")
        columns = _told_apart(columns)
        problem = _with_points(problem, columns)
    except CaseError:  # of a table, which names its own file
        raise
    except (ValueError, OverflowError, ZeroDivisionError) as error:
        raise CaseError(f"{path}: {error}") from None
    claims = tuple(
        _claim(item, source)
        for item in columns
        for source in (*METHODS, *EXACT)
        if SOURCES[source].supports(problem, QUANTITIES[item.profile.quantity].kind)
    )
    if not claims:
        raise CaseError(f"{path}: table: no source supports a column, so that nothing would be judged")
    return PublishedCase(
        name=path.stem,
        title=checked.title,
        problem=problem,
        claims=claims,
        columns=tuple(columns),
        citation={
            **checked.model_dump(include={"year", "remark"}),
            "tables": [table.model_dump(include={"file", "seen", "read"}) for table in checked.table],
            "notes": "\n".join(dict.fromkeys(notes)),
        },
        source=checked.source,
        path=path,
        # The tables belong to the input as much as the file that names them.
        text="\n".join(dict.fromkeys(texts)),
    )


def _told_apart(columns: list[PublishedColumn]) -> list[PublishedColumn]:
    """The columns on lines so named that a name has one set of points and each quantity once.

    A column that is read twice, at other points or from other rows, has its quantity behind the name of its
    line the second time, then a number.
    """
    points: dict[str, bytes] = {}
    taken: set[tuple[str, str]] = set()
    found = []
    for item in columns:
        quantity, line, here = item.profile.quantity, item.profile.line, item.profile.position.tobytes()
        names = chain((line, f"{line} as {quantity}"), (f"{line} as {quantity}, {n}" for n in count(2)))
        name = next(n for n in names if points.get(n, here) == here and (quantity, n) not in taken)
        points[name] = here
        taken.add((quantity, name))
        found.append(replace(item, profile=replace(item.profile, line=name)))
    return found


def _with_points(problem: Problem, columns: list[PublishedColumn]) -> Problem:
    """A loading curve with the points of its tables."""
    if not isinstance(problem, LoadingCurve):
        return problem
    controls = {item.at.control for item in columns}
    if len(controls) > 1 or "" in controls:
        raise ValueError(f"at: give one of {', '.join(CONTROLS)} for every value of a loading curve")
    at = sorted({float(x) for item in columns for x in item.at.along})
    return replace(problem, control=controls.pop(), at=tuple(at))


def _problem(p: ProblemEntry) -> Problem:
    length, stress, force = (
        si_of(getattr(p, key), UNITS, f"problem.{key}") for key in ("length_unit", "stress_unit", "load_unit")
    )
    substrate = (of_file(p.substrate.E, stress), p.substrate.nu)

    def layers(coatings: list[LayerEntry], a_h: float | None) -> Coatings:
        return tuple((of_file(c.E, stress), c.nu, _thickness(c, length, a_h)) for c in coatings)

    def ball(a_h: float | None) -> Ball | None:
        if p.ball is None:
            return None
        return of_file(p.ball.E, stress), p.ball.nu, layers(p.ball.coatings, a_h) if a_h else ()

    if p.radius is not None and p.load is not None:
        radius, load = of_file(p.radius, length), of_file(p.load, force)
        bare = CoatedContact(radius, load, (), substrate, p.friction, ball(None))
        return replace(bare, coatings=layers(p.coatings, bare.a_h), ball=ball(bare.a_h))
    coatings = layers(p.coatings, None)
    if p.radius is not None:
        return LoadingCurve(of_file(p.radius, length), CONTROLS[0], (1.0,), coatings, substrate)
    assert p.pressure is not None
    assert p.load_radius is not None
    pressure, load_radius = of_file(p.pressure, stress), of_file(p.load_radius, length)
    return PrescribedLoad(pressure, load_radius, coatings, substrate, p.friction)


def _thickness(c: LayerEntry, length: float, a_h: float | None) -> float:
    if c.thickness is not None:
        return of_file(c.thickness, length)
    if c.thickness_over_a_h is None or a_h is None:
        raise ValueError("problem.coatings: every coating needs its thickness")
    return c.thickness_over_a_h * a_h


def _units(problem: Problem) -> dict[str, float]:
    """The units of the tables of this problem: UNITS with its own scales."""
    if isinstance(problem, LoadingCurve):
        R = problem.radius
        if not problem.coatings:
            return UNITS | {"R": R}
        h = problem.coatings[0][2]
        return UNITS | {"R": R, "h": h, "h^2/R": h**2 / R, "E* h^3/R": problem.E_star * h**3 / R}
    if isinstance(problem, PrescribedLoad):
        return UNITS | {"q": problem.pressure, "a": problem.load_radius}
    return UNITS | {"a_h": problem.a_h, "p_h": problem.p_h, "delta_h": problem.delta_h}


def _claim(item: PublishedColumn, source: str) -> Claim:
    U = item.profile.uncertainty
    assert U is not None
    # As in every other case; the uncertainty of the published value, which ``columns`` limits, is added.
    quantity = QUANTITIES[item.profile.quantity]
    cap = max(quantity.cap, quantity.least) + float(U.max()) / item.scale
    why = f"published in column {item.column} of {item.file}"
    return Claim(item.profile.quantity, item.profile.line, (source, PUBLISHED), cap, why)
