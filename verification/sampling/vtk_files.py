"""Fields of a solution as VTK files for ParaView."""

import tempfile
from pathlib import Path
from typing import Any
from xml.sax.saxutils import quoteattr

import numpy as np
from numpy.typing import NDArray

from verification.cases.case_file import Case
from verification.problem.array_types import Array
from verification.problem.quantity import STRESSES, von_mises
from verification.sampling.stress_plane import depths_of

EVERY, ALONG = 4, 121  # of the patch centres along a side of the box, fewer for at most so many points
LEVELS = 20  # depths of the box, over that of an uncoated solid


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
    step = max(EVERY, -(-(len(solution.nodes) - 1) // (ALONG - 1)))
    every = np.arange(len(solution.nodes))[middle % step :: step]
    x = solution.nodes[every]
    files: dict[str, bytes] = {}
    for layer, z in enumerate(depths_of(solution.contact_radius, case.problem.interfaces, LEVELS)):
        sigma = np.stack([_stress(solution, x, every, float(depth), layer) for depth in z], axis=-1)
        u = np.stack(
            [solution.displacement_plane(float(depth))[:, every[:, None], every] for depth in z], axis=-1
        )
        grid = pv.RectilinearGrid(x, x, z)
        # Points run along x first, then y, then z.
        stresses = {name: sigma[component].ravel(order="F") for name, component in STRESSES.items()}
        for name, values in stresses.items():
            grid.point_data[f"{name} [Pa]"] = values
        grid.point_data["von_mises [Pa]"] = von_mises(list(stresses.values()))
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


def _saved(grid: Any, file: str, case: Case, method: str, radius: float) -> bytes:
    """The bytes of the file that VTK writes of ``grid``, with the case file inside."""
    import pyvista as pv

    texts = {
        "case file": case.text,
        "method": method,
        "axes": "metres, origin at first contact, x along sliding, z into the solid",
    }
    for name, text in texts.items():
        # meshio refuses a mesh that contains text, so it is stored as bytes.
        if isinstance(grid, pv.UnstructuredGrid):
            grid.field_data[f"{name} [UTF-8]"] = np.frombuffer(text.encode(), dtype=np.uint8)
        else:
            grid.field_data[name] = [text]
    grid.field_data["contact radius [m]"] = [radius]
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / file
        grid.save(path)
        return path.read_bytes()


# By ``Source.fields``.
WRITERS = {"mesh": _mesh_file, "boxes": _box_files}
