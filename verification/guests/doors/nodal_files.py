"""Files of nodes with stresses and displacements: CSV, VTU through meshio, the FRD of CalculiX."""

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from verification.guests.doors.csv_rows import cell_number, csv_rows
from verification.guests.guest_protocol import ProtocolError
from verification.problem.array_types import Array
from verification.running.checked_files import read_bounded

MOST_BYTES = 500_000_000
VOIGT = ("11", "22", "33", "12", "23", "13")  # of six components; of four the first
FRD_FIELDS = {"STRESS": "stress", "DISP": "displacement"}
LETTERS = str.maketrans("rt", "xy")  # the radius lies along x, the hoop direction along y


@dataclass(frozen=True)
class NodalFields:
    """Nodes of a mesh, with ``stress`` (3, 3, n) and ``displacement`` (3, n) in the axes of the file.

    points : (n, 3).   cells : nodes of each cell, an array for each type; none where a file has nodes alone.
    layer : a number of the material of each node, where a file without cells gives it.
    """

    points: Array
    stress: Array | None = None
    displacement: Array | None = None
    cells: list[Array] = field(default_factory=list)
    layer: Array | None = None


def nodal_file(folder: Path) -> Path | None:
    """The one file of nodes in ``folder``; None where there is none. Raises ProtocolError of several."""
    found = sorted(p for p in folder.glob("*") if p.suffix in (".frd", ".vtu") or p.name == "nodes.csv")
    if len(found) > 1:
        raise ProtocolError(f"{folder}: {', '.join(p.name for p in found)}; leave one file of nodes there")
    return found[0] if found else None


def read_nodes(path: Path, axes: list[str]) -> NodalFields:
    """The content of ``path``; ``axes`` are the letters of its coordinates, by which components are named.

    Raises ProtocolError naming the file.
    """
    readers: dict[str, Callable[[Path, list[str]], tuple[Array, list[Array], dict[str, Array]]]]
    readers = {".csv": _read_csv, ".frd": _read_frd, ".vtu": _read_vtu}
    try:
        points, cells, fields = readers[path.suffix](path, axes)
        stress, displacement = tensor_of(fields, axes), vector_of(fields, axes)
    except (OSError, ValueError, KeyError, IndexError, AttributeError) as error:
        raise ProtocolError(f"{path}: cannot be read ({error})") from None
    if stress is None and displacement is None:
        raise ProtocolError(
            f"{path}: its fields are {', '.join(fields) or 'none'}; stress, or sigma_xx and so on, or "
            "displacement is needed"
        )
    return NodalFields(points, stress, displacement, cells, fields.get("layer", fields.get("material")))


def tensor_of(fields: dict[str, Array], axes: list[str]) -> Array | None:
    """The stress (3, 3, n): of a field of 4, 6 or 9 components, or of fields named by their axes.

    Shear stresses that are not there are zero. Raises ProtocolError where a normal stress is not there.
    """
    whole = fields.get("stress")
    if whole is not None and whole.ndim > 1:
        if whole[0].size == 9:
            return whole.reshape(-1, 9).T.reshape(3, 3, -1)
        named = dict(zip(VOIGT, whole.T, strict=False))
    else:
        letters = {letter: str(1 + column) for column, letter in enumerate(letters_of(axes))}
        stresses = {name[6:].translate(LETTERS): v for name, v in fields.items() if name[:6] == "sigma_"}
        named = {"".join(sorted(letters.get(c, c) for c in name)): v for name, v in stresses.items()}
    if not named:
        return None
    shown = "rtz" if any("r" in axis for axis in axes) else "xyz"
    for k, letter in enumerate(letters_of(axes), start=1):
        if f"{k}{k}" not in named:
            lost = 2 * shown["xyz".index(letter)]
            raise ProtocolError(f"sigma_{lost} is missing; there are {', '.join(fields)}")
    found = np.zeros((3, 3, named["11"].size))
    for name in VOIGT:
        i, j = int(name[0]) - 1, int(name[1]) - 1
        found[i, j] = found[j, i] = named.get(name, 0.0)
    return found


def vector_of(fields: dict[str, Array], axes: list[str]) -> Array | None:
    """The displacement (3, n): of a field of that name, or of fields named by their axes."""
    whole = fields.get("displacement")
    if whole is not None:
        columns = whole.reshape(len(whole), -1).T
        return np.vstack([columns, np.zeros((3, columns.shape[1]))])[:3]
    named = {name[2:].translate(LETTERS): v for name, v in fields.items() if name[:2] == "u_"}
    size = next((v.size for v in named.values()), 0)
    return np.array([named.get(a, np.zeros(size)) for a in letters_of(axes)]) if named else None


def letters_of(axes: list[str]) -> list[str]:
    """x, y or z of the three axes of a file; r lies along x, t along y, the one not named comes last."""
    letters = [axis[-1].translate(LETTERS) for axis in axes]
    return letters + [letter for letter in "xyz" if letter not in letters]


def _read_csv(path: Path, axes: list[str]) -> tuple[Array, list[Array], dict[str, Array]]:
    rows = csv_rows(path, MOST_BYTES)
    heads = [head for head in (rows[0][1] if rows else {}) if head]
    fields = {
        head.split(" [")[0].strip(): np.array(
            [cell_number(row[head] or "", f"{w}, {head}") for w, row in rows]
        )
        for head in heads
    }
    points = np.array([fields.pop(axis[-1]) for axis in axes]).T
    return np.hstack([points, np.zeros((len(points), 3 - len(axes)))]), [], fields


def _read_vtu(path: Path, axes: list[str]) -> tuple[Array, list[Array], dict[str, Array]]:
    try:
        import meshio
    except ImportError:
        raise ProtocolError(f"{path}: meshio reads it; python -m pip install 'coatcheck[fields]'") from None
    try:
        mesh = meshio.read(path)
    except meshio.ReadError as error:
        raise ProtocolError(f"{path}: cannot be read ({error})") from None
    fields = {
        str(name).split(" [")[0].lower(): np.asarray(v, float).squeeze()
        for name, v in mesh.point_data.items()
    }
    points = np.asarray(mesh.points, dtype=float)
    points = np.hstack([points, np.zeros((len(points), 3 - points.shape[1]))])
    return points, [block.data for block in mesh.cells if block.data.shape[1] > 2], fields


def _read_frd(path: Path, axes: list[str]) -> tuple[Array, list[Array], dict[str, Array]]:
    """Nodes, cells, the last stress and displacement: lines in columns of fixed width.

    CalculiX cgx manual, section "Result Format". Numbers of twelve characters may touch.
    """
    lines = read_bounded(path, MOST_BYTES).decode("ascii", errors="replace").splitlines()
    numbers: dict[str, list[tuple[int, list[float]]]] = {}
    elements: list[list[int]] = []
    block, wide = "", 10
    for line in lines:
        head, key = line[:6].strip(), line[:3]
        if head in ("2C", "3C", "100C"):
            block, form = head if head != "100C" else "", line[73:75].strip()
            if form == "2":
                raise ValueError("it is binary; write it as text")
            wide = 5 if form == "0" else 10
        elif key == " -4":
            block = FRD_FIELDS.get(line[5:13].strip(), "")
            numbers.pop(block, None)
        elif key == " -3":
            block = ""
        elif block == "3C" and key in (" -1", " -2"):
            if key == " -1":
                elements.append([])
            else:
                elements[-1] += [int(line[i : i + wide]) for i in range(3, len(line.rstrip()), wide)]
        elif block and key == " -1":
            rest = line[3 + wide :].rstrip()
            values = [float(rest[i : i + 12]) for i in range(0, len(rest), 12)]
            numbers.setdefault(block, []).append((int(line[3 : 3 + wide]), values))
    at = {node: i for i, (node, _) in enumerate(numbers["2C"])}
    by: dict[int, list[Any]] = {}
    for nodes in elements:
        by.setdefault(len(nodes), []).append([at[n] for n in nodes])
    fields: dict[str, Array] = {}
    for name in ("stress", "displacement"):
        if name in numbers:
            fields[name] = np.full((len(at), len(numbers[name][0][1])), np.nan)
            for node, values in numbers[name]:
                fields[name][at[node]] = values
    points = np.array([values for _, values in numbers["2C"]])
    return points, [np.array(nodes) for n, nodes in by.items() if n > 2], fields
