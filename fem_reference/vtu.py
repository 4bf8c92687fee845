"""The mesh of a solution for ParaView, written by meshio.

Vertices on an interface are written once per layer, so that sigma_xx is discontinuous there. VTK finds points
in a mesh with a tolerance that is relative to the mesh's width: sample the boxes of ``run --fields``; this
file shows the elements themselves.
"""

from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from skfem import MeshTri

if TYPE_CHECKING:
    from .solved_contact import ElementSolution

STRESSES = {"xx": (0, 0), "yy": (1, 1), "zz": (2, 2), "xy": (0, 1), "yz": (1, 2), "xz": (0, 2)}


def write_vtu(solution: "ElementSolution", path: str | PathLike[str], reach: float = 20.0) -> Path:
    """Write the plane y = 0 within ``reach`` contact radii as quadratic triangles to ``path`` (.vtu).

    Points in m, cell data ``layer``, 0 at the surface; point data: displacement [m], stresses [Pa] on their
    own side of an interface, and that of von Mises. With friction both halves x < 0 and x > 0.
    Returns the path.
    Raises ValueError when the name does not end in .vtu, OSError when the file cannot be written.
    """
    import meshio

    path = Path(path)
    if path.suffix != ".vtu":
        raise ValueError(f"path = {path}; the file name has to end in .vtu")
    mesh, length = solution.state.mesh, solution.units.length
    halves = (1.0, -1.0) if solution.state.tangential is not None else (1.0,)
    layers, vertices = mesh.depths.size + 1, mesh.points.shape[1]
    near = (np.abs(mesh.points[:, mesh.triangles]) * length < reach * solution.contact_radius).all(
        axis=(0, 1)
    )
    # no vertex is shared between layers or halves
    corners = np.hstack([mesh.points * [[half * length], [length]] for half in halves for _ in range(layers)])
    apart = (mesh.triangles + mesh.layer * vertices)[:, near]
    # a mirrored triangle runs clockwise: swap two corners
    triangles = np.hstack([apart, apart[[0, 2, 1]] + layers * vertices][: len(halves)])
    plane = MeshTri(corners, triangles, sort_t=False).remove_unused_nodes()
    x, z = np.hstack([plane.p, plane.p[:, plane.facets].mean(axis=1)])
    cells = np.vstack([plane.t, plane.nvertices + plane.t2f]).T
    layer = np.tile(mesh.layer[near], len(halves))
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
    meshio.Mesh(
        np.stack([x, 0 * x, z], axis=1),
        [("triangle6", cells)],
        point_data=point_data,
        cell_data={"layer": [layer.astype(np.int32)]},
    ).write(path)
    return path
