#!/usr/bin/env bash
# gmsh 4.15.2, scikit-fem 12.0.2: the centre of a circle arc becomes a node that no triangle uses, and the mesh
# that scikit-fem loads keeps it: one unknown without an equation.
# Guess: the centre only says where the arc runs; what is loaded holds the nodes of its triangles.
# Seen: a quarter of a ring has 56 nodes of which 55 are corners; the Laplace matrix has one row of zeros, at
# the centre (0, 0), outside the ring.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet gmsh==4.15.2 scikit-fem==12.0.2 meshio==5.3.5 numpy==2.4.6
cd "$folder"
"$folder/venv/bin/python" - <<'PYTHON'
import gmsh
import numpy as np
import skfem
from skfem.models.poisson import laplace

gmsh.initialize()
gmsh.option.setNumber("General.Terminal", 0)
make = gmsh.model.geo
centre, *ends = (make.addPoint(x, y, 0, 0.3) for x, y in ((0, 0), (1, 0), (2, 0), (0, 2), (0, 1)))
a, b, c, d = ends
edges = [make.addLine(a, b), make.addCircleArc(b, centre, c), make.addLine(c, d), make.addCircleArc(d, centre, a)]
make.addPlaneSurface([make.addCurveLoop(edges)])
make.synchronize()
gmsh.model.mesh.generate(2)
nodes = gmsh.model.mesh.getNodes()[0].size
gmsh.write("ring.msh")
gmsh.finalize()
mesh = skfem.Mesh.load("ring.msh")
matrix = laplace.assemble(skfem.Basis(mesh, skfem.ElementTriP1()))
empty = np.flatnonzero(np.abs(matrix).sum(axis=1) == 0)
print(gmsh.__version__, skfem.__version__, nodes, np.unique(mesh.t).size, empty, mesh.p[:, empty].T)
raise SystemExit(not (nodes == mesh.p.shape[1] == np.unique(mesh.t).size + 1 and len(empty) == 1))
PYTHON
