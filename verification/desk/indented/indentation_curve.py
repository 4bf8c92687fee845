"""Columns of a measured indentation curve, by their heads: "depth [nm]", "P_mN", "sd_S_N_per_m", in SI."""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from verification.cases.toml_file import CaseError, is_number
from verification.cases.unit_numbers import FORCES, LENGTHS
from verification.desk.table_file import read_cells
from verification.problem.array_types import Array

STIFFNESSES = {"N/m": 1.0, "N_per_m": 1.0, "N/mm": 1e3, "mN/um": 1e3, "mN/nm": 1e6, "uN/nm": 1e3}
# Each quantity by the names that instruments give it, with its units.
COLUMNS: dict[str, tuple[tuple[str, ...], Mapping[str, float]]] = {
    "load": (("load", "force", "P", "F"), FORCES),
    "depth": (("depth", "displacement", "indentation", "approach", "h"), LENGTHS),
    "stiffness": (("stiffness", "S"), STIFFNESSES),
    "radius": (("contact radius", "radius", "a"), LENGTHS),
}
_HEAD = re.compile(r"(sd[_ ])?(.+?)(?:[ _]*[\[(]([^\])]+)[\])]|_([A-Za-zµ_/]+))")
LEAST_ROWS = 5


@dataclass(frozen=True, eq=False)
class IndentationCurve:
    """Measured ``values`` by quantity, as of ``COLUMNS``, with their standard deviations ``sd`` where given.

    unused : heads of the other columns.   left_out : rows outside the depths that were asked for.
    """

    values: dict[str, Array]
    sd: dict[str, Array]
    unused: tuple[str, ...]
    left_out: int


def read_curve(path: Path, depths: tuple[float, float] = (0.0, np.inf)) -> IndentationCurve:
    """The curve of a CSV or XLSX file; of its rows those within ``depths`` [m]. Raises CaseError."""
    first, *rows = read_cells(path) or [[]]
    rows = [row for row in rows if any(cell.strip() for cell in row)]
    known: dict[tuple[bool, str], tuple[int, float]] = {}
    unused = []
    for i, head in enumerate(first):
        if (found := _quantity(head.strip())) is None:
            unused.append(head.strip())
        else:
            key = found[:2]
            if key in known:
                raise CaseError(
                    f"{path}: columns {first[known[key][0]]!r} and {head!r} both give the {key[1]}"
                )
            known[key] = i, found[2]
    columns = {}
    for key, (i, unit) in known.items():
        try:
            columns[key] = unit * np.array([float(row[i]) for row in rows])
        except (ValueError, IndexError):
            bad = next(n for n, row in enumerate(rows, 2) if i >= len(row) or not is_number(row[i]))
            raise CaseError(f"{path}: line {bad}: {first[i]} is not a number; leave the row out") from None
        if not np.isfinite(columns[key]).all():
            raise CaseError(f"{path}: {first[i]} is not finite in every row; leave those rows out")
    values = {name: column for (sd, name), column in columns.items() if not sd}
    if not {"load", "stiffness"} & values.keys():
        heads = '"load [mN]", "depth [nm]", "stiffness [N/m]", "contact radius [nm]"'
        raise CaseError(f"{path}: has no load and no stiffness; the heads of its columns are as {heads}")
    keep = np.ones(len(rows), dtype=bool)
    for name in ("load", "radius", "stiffness"):
        keep &= values.get(name, np.ones(len(rows))) > 0
    if "depth" in values:
        keep &= (values["depth"] >= depths[0]) & (values["depth"] <= depths[1])
    elif depths != (0.0, np.inf):
        raise CaseError(f"{path}: has no depth by which its rows could be chosen")
    if keep.sum() < LEAST_ROWS:
        raise CaseError(f"{path}: {keep.sum()} rows are left; at least {LEAST_ROWS} are required")
    sd = {name: column[keep] for (is_sd, name), column in columns.items() if is_sd}
    return IndentationCurve(
        {name: column[keep] for name, column in values.items()}, sd, tuple(unused), int((~keep).sum())
    )


def _quantity(head: str) -> tuple[bool, str, float] | None:
    """Whether a column holds standard deviations, of which quantity, and its unit in SI."""
    found = _HEAD.fullmatch(head)
    if found is None:
        return None
    name, unit = found[2].strip(), found[3] or found[4]
    for quantity, (names, units) in COLUMNS.items():
        if name in names or (len(name) > 1 and name.casefold() in names):
            value = units.get(unit.replace("µ", "u"))
            return None if value is None else (bool(found[1]), quantity, value)
    return None
