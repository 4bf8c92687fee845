"""Mesh of GetDP's model by gmsh: layers below a disc of radius 1, fine below it and at its rim."""

from itertools import pairwise

import gmsh


def write_mesh(path, depths, far, size):
    """Triangles of each layer as surface 1, 2, ...; curves 101 the disc, 102 the far ends, 103 the axis."""
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    shape = gmsh.model.occ
    for z, below in pairwise(depths):
        shape.addRectangle(0, -below, 0, far, below - z)
    count = len(depths) - 1
    shape.fragment([(2, k) for k in range(1, count + 1)], [(0, shape.addPoint(1, 0, 0))])
    shape.synchronize()
    found: dict[int, list[int]] = {101: [], 102: [], 103: []}
    for _, k in gmsh.model.getEntities(1):
        r, y, _ = gmsh.model.occ.getCenterOfMass(1, k)
        name = (
            103
            if r < 1e-9
            else 101
            if abs(y) < 1e-9 and r < 1
            else 102
            if r > far - 1e-6 or y < 1e-6 - far
            else 0
        )
        found.setdefault(name, []).append(k)
    for name in (101, 102, 103):
        gmsh.model.addPhysicalGroup(1, found[name], name)
    for k in range(1, count + 1):
        gmsh.model.addPhysicalGroup(2, [k], k)
    field = gmsh.model.mesh.field
    field.add("MathEval", 1)
    fine = f"{size}*Max(1, Sqrt(x*x+y*y)/1.5)*Min(1, 0.04+1.2*Sqrt((x-1)^2+y*y))"
    field.setString(1, "F", fine)
    field.setAsBackgroundMesh(1)
    for option in ("MeshSizeExtendFromBoundary", "MeshSizeFromPoints"):
        gmsh.option.setNumber(f"Mesh.{option}", 0)
    gmsh.option.setNumber("Mesh.ElementOrder", 2)
    gmsh.option.setNumber("Mesh.MshFileVersion", 2.2)
    gmsh.model.mesh.generate(2)
    gmsh.write(str(path))
    gmsh.finalize()
