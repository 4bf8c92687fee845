"""Fields of a case as files for ParaView: the finite element mesh, boxes of the semi-analytical method.

Every file carries the case file it came from; their checksums stand in a file beside them that checks itself.
"""

import hashlib
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from xml.sax.saxutils import quoteattr

import numpy as np
from numpy.typing import NDArray

from verification.case import Case
from verification.plane import depths_of
from verification.problem import Solution
from verification.store import MAX_BYTES, StoreError, read_checked, write_atomically, write_checked

__all__ = ["NAMES", "Fields", "fields_path", "read_fields", "write_fields"]

Array = NDArray[np.float64]

SCHEMA = "coatcheck-fields/1"
NAMES = {"xx": (0, 0), "yy": (1, 1), "zz": (2, 2), "xy": (0, 1), "yz": (1, 2), "xz": (0, 2)}
EVERY = 4  # of the patch centres along a side of the box
LEVELS = 20  # depths of the box, over that of an uncoated solid


@dataclass(frozen=True)
class Fields:
    """What was written of a case: the finite element ``mesh``, the ``boxes`` layer by layer, their ``index``.

    None and () where a method gave nothing; ``failures`` has by source the sentence why.
    """

    mesh: Path | None
    index: Path | None
    boxes: tuple[Path, ...]
    failures: Mapping[str, str]


def fields_path(folder: Path, name: str) -> Path:
    """Where a run directory has the checksums of the fields of the case called ``name``."""
    return folder / "fields" / f"{name}.json"


def write_fields(case: Case, solutions: Mapping[str, Solution], folder: Path) -> Fields:
    """Write the fields of ``solutions`` into ``folder``/fields, the file of checksums last.

    NAME-fem.vtu : the plane y = 0, quadratic triangles.   NAME-semi.vtm : an index of NAME-semi-layer-K.vtr,
    a box of a layer each, so that what jumps at an interface has both its values. All in metres, z into the
    solid; fields "sigma_xx [Pa]" ..., "von_mises [Pa]", "displacement [m]", cells with their "layer".
    A method whose fields cannot be had leaves a sentence. Raises StoreError where files cannot be written.
    """
    path = fields_path(folder, case.name)
    written: dict[str, bytes] = {}
    failures: dict[str, str] = {}
    for source, make in (("fem_reference", _mesh_file), ("semianalytic", _box_files)):
        if source in solutions:
            try:
                written |= make(case, solutions[source])
            except Exception as error:  # fields are wanted besides; they cost no result
                failures[source] = f"{type(error).__name__}: {' '.join(str(error).split())[:300]}"
    for name, data in written.items():
        write_atomically(path.parent / name, data)
    content = {
        "schema": SCHEMA,
        "case_file": case.text,
        "files": {name: hashlib.sha256(data).hexdigest() for name, data in written.items()},
        "failures": failures,
    }
    write_checked(path, content)
    return read_fields(folder, case.name, case.text)


def read_fields(folder: Path, name: str, case_file: str | None = None) -> Fields:
    """The fields of the case ``name`` in a run directory, every file's checksum confirmed.

    case_file : that they have to come from.   Raises StoreError, naming the file.
    """
    path = fields_path(folder, name)
    data = read_checked(path)
    if data.get("schema") != SCHEMA or (case_file is not None and data.get("case_file") != case_file):
        raise StoreError(f"{path}: of another case file or version of this program; run the case again")
    try:
        sums = {str(file): str(stated) for file, stated in data["files"].items()}
        failures = {str(source): str(sentence) for source, sentence in data["failures"].items()}
    except (KeyError, AttributeError):
        raise StoreError(f"{path}: not a list of fields; run the case again with --fields") from None
    for file, stated in sums.items():
        if file != Path(file).name:
            raise StoreError(f"{path}: names {file!r}, which is no file beside it")
        if _digest(path.parent / file) != stated:
            raise StoreError(
                f"{path.parent / file}: its checksum does not hold; run the case again with --fields"
            )
    found = [path.parent / file for file in sums]
    return Fields(
        next((p for p in found if p.suffix == ".vtu"), None),
        next((p for p in found if p.suffix == ".vtm"), None),
        tuple(p for p in found if p.suffix == ".vtr"),
        failures,
    )


def _digest(path: Path) -> str:
    try:
        if path.stat().st_size > MAX_BYTES:
            raise StoreError(f"{path}: larger than {MAX_BYTES} bytes; not a file of this program")
        return hashlib.sha256(path.read_bytes()).hexdigest()
    except OSError as error:
        raise StoreError(
            f"{path}: cannot be read ({error.strerror}); run the case again with --fields"
        ) from None


def _mesh_file(case: Case, solution: Any) -> dict[str, bytes]:
    import pyvista as pv

    from fem_reference import plane_mesh

    found = plane_mesh(solution)
    grid = pv.UnstructuredGrid({pv.CellType.QUADRATIC_TRIANGLE: found.cells}, found.points)
    for name, values in found.point_data.items():
        grid.point_data[name] = values
    grid.cell_data["layer"] = found.layer.astype(np.int32)
    file = f"{case.name}-fem.vtu"
    return {file: _saved(grid, file, case, "finite elements", solution.contact_radius)}


def _box_files(case: Case, solution: Any) -> dict[str, bytes]:
    import pyvista as pv

    middle = len(solution.nodes) // 2
    every = np.arange(len(solution.nodes))[middle % EVERY :: EVERY]
    x = solution.nodes[every]
    files: dict[str, bytes] = {}
    for layer, z in enumerate(depths_of(solution.contact_radius, case.problem.interfaces, LEVELS)):
        sigma = np.stack([_stress(solution, x, every, float(depth), layer) for depth in z], axis=-1)
        u = np.stack(
            [solution.displacement_plane(float(depth))[:, every[:, None], every] for depth in z], axis=-1
        )
        grid = pv.RectilinearGrid(x, x, z)
        # Points run along x first, then y, then z.
        for name, (i, j) in NAMES.items():
            grid.point_data[f"sigma_{name} [Pa]"] = sigma[i, j].ravel(order="F")
        grid.point_data["von_mises [Pa]"] = _von_mises(sigma).ravel(order="F")
        grid.point_data["displacement [m]"] = np.stack([c.ravel(order="F") for c in u], axis=1)
        grid.cell_data["layer"] = np.full(grid.n_cells, layer, dtype=np.int32)
        file = f"{case.name}-semi-layer-{layer}.vtr"
        files[file] = _saved(grid, file, case, "semi-analytical", solution.contact_radius)
    blocks = "".join(
        f"    <DataSet index={quoteattr(str(k))} name={quoteattr(f'layer {k}')} file={quoteattr(file)}/>\n"
        for k, file in enumerate(files)
    )
    index = (
        '<?xml version="1.0"?>\n<VTKFile type="vtkMultiBlockDataSet" version="1.0">\n'
        f"  <vtkMultiBlockDataSet>\n{blocks}  </vtkMultiBlockDataSet>\n</VTKFile>\n"
    )
    return files | {f"{case.name}-semi.vtm": index.encode()}


def _stress(solution: Any, x: Array, every: NDArray[np.int_], z: float, layer: int) -> Array:
    """Stress at one depth below the chosen patch centres, (3, 3, n, n)."""
    if z == 0:  # where planes of whole patches are at their weakest
        return solution.stress(x[:, None], x[None, :], z, layer=layer)
    return solution.stress_plane(z, layer)[:, :, every[:, None], every]


def _von_mises(sigma: Array) -> Array:
    """Von Mises stress of tensors (3, 3, ...): sqrt(3/2 s:s) of the deviator s."""
    mean = np.einsum("ii...->...", sigma) / 3
    square = np.einsum("ij...,ij...->...", sigma, sigma) - 3 * mean**2
    return np.sqrt(1.5 * np.maximum(square, 0.0))


def _saved(grid: Any, file: str, case: Case, method: str, radius: float) -> bytes:
    """The bytes of the file that VTK writes of ``grid``, with the case file inside."""
    import pyvista as pv

    said = {
        "case file": case.text,
        "method": method,
        "axes": "metres, origin at first contact, x along sliding, z into the solid",
    }
    for name, text in said.items():
        # meshio refuses a mesh with text in it, so there it stands as bytes.
        if isinstance(grid, pv.UnstructuredGrid):
            grid.field_data[f"{name} [UTF-8]"] = np.frombuffer(text.encode(), dtype=np.uint8)
        else:
            grid.field_data[name] = [text]
    grid.field_data["contact radius [m]"] = [radius]
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / file
        grid.save(path)
        return path.read_bytes()
