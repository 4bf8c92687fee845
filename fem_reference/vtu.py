"""ParaView files of a solution, written by meshio.

Vertices on an interface are written once per layer, so that sigma_xx is discontinuous there.
"""

from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from skfem import MeshTri

if TYPE_CHECKING:
    from .solved_contact import Solution

STRESSES = {"xx": (0, 0), "yy": (1, 1), "zz": (2, 2), "xy": (0, 1), "yz": (1, 2), "xz": (0, 2)}


@dataclass(frozen=True, eq=False)
class PlaneMesh:
    """The plane y = 0 as quadratic triangles, no node shared between layers.

    points : [m], (n, 3).   cells : (m, 6), corners, then the middles of the sides.   layer : of a cell, (m,).
    point_data : fields by name with unit: displacement (n, 3), stresses (n,) on their own side of an
        interface, and that of von Mises, sqrt(3/2 s:s) of the deviator s
    """

    points: np.ndarray
    cells: np.ndarray
    layer: np.ndarray
    point_data: dict[str, np.ndarray]


def plane_mesh(solution: "Solution") -> PlaneMesh:
    """The mesh of the plane y = 0 with its fields; with friction both halves x < 0 and x > 0."""
    mesh, length = solution.state.mesh, solution.units.length
    halves = (1.0, -1.0) if solution.state.tangential is not None else (1.0,)
    layers, vertices = mesh.depths.size + 1, mesh.points.shape[1]
    # no vertex is shared between layers or halves
    corners = np.hstack([mesh.points * [[half * length], [length]] for half in halves for _ in range(layers)])
    apart = mesh.triangles + mesh.layer * vertices
    # a mirrored triangle runs clockwise: swap two corners
    triangles = np.hstack([apart, apart[[0, 2, 1]] + layers * vertices][: len(halves)])
    plane = MeshTri(corners, triangles, sort_t=False).remove_unused_nodes()
    x, z = np.hstack([plane.p, plane.p[:, plane.facets].mean(axis=1)])
    cells = np.vstack([plane.t, plane.nvertices + plane.t2f]).T
    layer = np.tile(mesh.layer, len(halves))
    sigma = np.zeros((3, 3, x.size))
    for k in range(layers):
        mine = np.unique(cells[layer == k])
        sigma[:, :, mine] = solution.stress(x[mine], 0.0, z[mine], layer=k)
    deviator = sigma - np.eye(3)[:, :, None] * np.einsum("iin->n", sigma) / 3
    point_data = {
        "displacement [m]": solution.displacement(x, 0.0, z).T,
        **{f"sigma_{name} [Pa]": sigma[ij] for name, ij in STRESSES.items()},
        "von_mises [Pa]": np.sqrt(1.5 * np.einsum("ijn,ijn->n", deviator, deviator)),
    }
    return PlaneMesh(np.stack([x, 0 * x, z], axis=1), cells, layer, point_data)


def write_vtu(solution: "Solution", path: str | PathLike[str]) -> Path:
    """Write the plane y = 0 as quadratic triangles to ``path`` (.vtu); returns the path.

    Cell data ``layer``, 0 at the surface, and the point data of `plane_mesh`.
    Raises ValueError when the name does not end in .vtu, OSError when the file cannot be written.
    """
    import meshio

    path = Path(path)
    if path.suffix != ".vtu":
        raise ValueError(f"path = {path}; the file name has to end in .vtu")
    found = plane_mesh(solution)
    meshio.Mesh(
        found.points,
        [("triangle6", found.cells)],
        point_data=found.point_data,
        cell_data={"layer": [found.layer.astype(np.int32)]},
    ).write(path)
    return path
