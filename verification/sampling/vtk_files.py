"""Fields of a solution as VTK files for ParaView and pyvista.

All are boxes along the axes, one file a layer, in um. A point is found in them by bisection of each
coordinate; among triangles that shrink towards the contact edge a search takes a neighbour for the right one
as soon as the mesh is wide. Each layer reaches ``BEYOND`` past its interfaces, with the values on them,
so that a line rounded to single precision stays inside. A plane is a thin slab: in a box of one point along y
VTK 9.7 finds no cell beyond the first row.
"""

import tempfile
from collections.abc import Callable
from itertools import pairwise
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
UM = 1e6  # coordinates a metre
BEYOND = 1e-6  # of the depth of an interface, of the contact radius at the surface
THIN = 1e-3  # half of the thickness of a plane, over the contact radius
# Rows and columns of the plane y = 0 are halved until a value halfway is the mean of its neighbours within
# this share of the peak pressure, over 1 + distance / contact radius.
BETWEEN = 5e-4
# Half width and depth over the contact radius, most rounds of halving: the region of interest, the far field.
PLANES = {"": (20.0, 5), "-far": (200.0, 3)}
# The first columns beside the contact edge and rows below the surface, over the contact radius: within a
# millionth the root of the distance is a thousandth.
STEPS = np.concatenate([[0.0], 2.0 ** np.arange(-20, 8)])


def _plane_files(case: Case, solution: Any) -> dict[str, bytes]:
    """Files of the plane y = 0: the region of interest, the far field."""
    files: dict[str, bytes] = {}
    a, interfaces = solution.contact_radius, case.problem.interfaces
    edges = _edges(solution)[:, None]
    for which, (reach, rounds) in PLANES.items():
        depths = [0.0, *(z for z in interfaces if z < reach * a), reach * a]
        beside = STEPS[reach >= STEPS] * a
        layers = []
        for layer, (top, bottom) in enumerate(pairwise(depths)):

            def stress(x: Array, z: Array, layer: int = layer) -> Array:
                sigma = solution.stress(x, 0.0, z[:, None], layer=layer)
                return np.array([sigma[component] for component in STRESSES.values()])

            near = beside if layer == 0 else beside[beside > 0.1 * min(top, a)]  # no edge is in sight below
            x = np.unique([*(edges - near).flat, *(edges + near).flat, -reach * a, 0.0, reach * a])
            z = np.unique(np.concatenate([[top, (top + bottom) / 2, bottom], top + near]))
            x, z = x[np.abs(x) <= reach * a], z[z <= bottom]
            x, z = _refined(stress, x, z, a, BETWEEN * solution.peak_pressure, rounds)
            u = solution.displacement(x, 0.0, z[:, None])
            # from (.., z, x) to (.., x, y, z)
            slab = np.array([-1.0, 1.0]) * THIN * a
            sigma, u = (
                np.repeat(np.swapaxes(found, 1, 2)[:, :, None], slab.size, axis=2)
                for found in (stress(x, z), u)
            )
            layers.append(_box(x, slab, z, sigma, u, layer, a))
        files |= _files(layers, case, f"fem{which}", "finite elements", a)
    return files


def _edges(solution: Any) -> Array:
    """x [m] on y = 0 where the pressure begins or ends, of one contact or of several side by side."""
    a = solution.contact_radius
    x = np.linspace(-20 * a, 20 * a, 4001)
    loaded = solution.pressure(x, 0.0) > 0
    at = np.flatnonzero(loaded[1:] != loaded[:-1])
    low, high, first = x[at], x[at + 1], loaded[at]
    for _ in range(40):
        middle = (low + high) / 2
        before = (solution.pressure(middle, 0.0) > 0) == first
        low, high = np.where(before, middle, low), np.where(before, high, middle)
    return np.asarray((low + high) / 2)


def _refined(
    stress: Callable[[Array, Array], Array], x: Array, z: Array, a: float, close: float, rounds: int
) -> tuple[Array, Array]:
    """Columns and rows between which ``stress`` (x, z) is linear within ``close`` [Pa]."""
    for _ in range(rounds):
        here, between_x, between_z = stress(x, z), (x[1:] + x[:-1]) / 2, (z[1:] + z[:-1]) / 2
        beside = np.abs(stress(between_x, z) - (here[:, :, 1:] + here[:, :, :-1]) / 2).max(axis=0)
        below = np.abs(stress(x, between_z) - (here[:, 1:] + here[:, :-1]) / 2).max(axis=0)
        beside *= 1 + np.hypot(between_x, z[:, None]) / a
        below *= 1 + np.hypot(x, between_z[:, None]) / a
        x = np.sort(np.append(x, between_x[beside.max(axis=0) > close]))
        z = np.sort(np.append(z, between_z[below.max(axis=1) > close]))
    return x, z


def _box_files(case: Case, solution: Any) -> dict[str, bytes]:
    middle = len(solution.nodes) // 2
    step = max(EVERY, -(-(len(solution.nodes) - 1) // (ALONG - 1)))
    every = np.arange(len(solution.nodes))[middle % step :: step]
    x, a = solution.nodes[every], solution.contact_radius
    boxes = []
    for layer, z in enumerate(depths_of(a, case.problem.interfaces, LEVELS)):
        sigma = np.stack([_stress(solution, x, every, float(depth), layer) for depth in z], axis=-1)
        u = [solution.displacement_plane(float(depth))[:, every[:, None], every] for depth in z]
        stresses = np.array([sigma[component] for component in STRESSES.values()])
        boxes.append(_box(x, x, z, stresses, np.stack(u, axis=-1), layer, a))
    return _files(boxes, case, "semi", "semi-analytical", a)


def _box(x: Array, y: Array, z: Array, stresses: Array, u: Array, layer: int, a: float) -> Any:
    """A box with ``stresses`` in the order of ``STRESSES``, (6, nx, ny, nz), and the displacement ``u``.

    Its first and its last depth lie beyond the layer, by ``BEYOND``.
    """
    import pyvista as pv

    z = z.copy()
    z[0] -= BEYOND * (z[0] or a)
    z[-1] += BEYOND * z[-1]
    grid = pv.RectilinearGrid(x * UM, y * UM, z * UM)
    # Points run along x first, then y, then z.
    for name, values in zip(STRESSES, stresses, strict=True):
        grid.point_data[f"{name} [Pa]"] = values.ravel(order="F")
    grid.point_data["von_mises [Pa]"] = von_mises(stresses).ravel(order="F")
    grid.point_data["displacement [m]"] = np.stack([c.ravel(order="F") for c in u], axis=1)
    grid.cell_data["layer"] = np.full(grid.n_cells, layer, dtype=np.int32)
    return grid


def _files(boxes: list[Any], case: Case, which: str, method: str, a: float) -> dict[str, bytes]:
    """The files of the boxes of all layers, and an index of them."""
    names = [f"{case.name}-{which}-layer-{k}.vtr" for k in range(len(boxes))]
    files = {file: _saved(grid, file, case, method, a) for file, grid in zip(names, boxes, strict=True)}
    blocks = "".join(
        f"    <DataSet index={quoteattr(str(k))} name={quoteattr(f'layer {k}')} file={quoteattr(file)}/>\n"
        for k, file in enumerate(files)
    )
    index = (
        '<?xml version="1.0"?>\n<VTKFile type="vtkMultiBlockDataSet" version="1.0">\n'
        f"  <vtkMultiBlockDataSet>\n{blocks}  </vtkMultiBlockDataSet>\n</VTKFile>\n"
    )
    return files | {f"{case.name}-{which}.vtm": index.encode()}


def _stress(solution: Any, x: Array, every: NDArray[np.int_], z: float, layer: int) -> Array:
    """Stress at one depth below the chosen patch centres, (3, 3, n, n)."""
    if z == 0:  # where planes of whole patches are at their weakest
        return solution.stress(x[:, None], x[None, :], z, layer=layer)
    return solution.stress_plane(z, layer)[:, :, every[:, None], every]


def _saved(grid: Any, file: str, case: Case, method: str, radius: float) -> bytes:
    """The bytes of the file that VTK writes of ``grid``, with the case file inside."""
    texts = {
        "case file": case.text,
        "method": method,
        "axes": "um, origin at first contact, x along sliding, z into the solid",
    }
    for name, text in texts.items():
        grid.field_data[name] = [text]
    grid.field_data["contact radius [m]"] = [radius]
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / file
        grid.save(path)
        return path.read_bytes()


# By ``Source.fields``.
WRITERS = {"plane": _plane_files, "boxes": _box_files}
