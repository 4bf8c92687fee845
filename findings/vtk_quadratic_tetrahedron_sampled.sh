#!/usr/bin/env bash
# VTK 9.7.2 (pyvista 0.49.1): a quadratic field on a quadratic tetrahedron with straight edges is sampled to five
# digits.
# Guess: exactly, to 1e-15, as on the quadratic triangle: its shape functions hold the field.
# Seen: 1.6e-5 at 200 places in one tetrahedron of 10 nodes, 7e-16 in a triangle of 6: the place in the cell
# comes from an iteration that stops early.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet pyvista==0.49.1 vtk==9.7.2 numpy==2.4.6
"$folder/venv/bin/python" - <<'PYTHON'
import numpy as np
import pyvista as pv


def quadratic(points):
    return (points @ [1.0, 0.5, -0.3]) ** 2


def error(corners, edges, kind):
    points = np.vstack([corners, [(corners[a] + corners[b]) / 2 for a, b in edges]])
    cell = pv.UnstructuredGrid(np.r_[len(points), np.arange(len(points))], [kind], points)
    cell["f"] = quadratic(points)
    places = np.random.default_rng(0).dirichlet(np.ones(len(corners)), 200) @ corners
    found = pv.PolyData(places).sample(cell)
    valid = found["vtkValidPointMask"] == 1
    return int(valid.sum()), float(np.abs(found["f"] - quadratic(places))[valid].max())


corners = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
around = [(0, 1), (1, 2), (2, 0)]
tetrahedron = error(corners, [*around, (0, 3), (1, 3), (2, 3)], pv.CellType.QUADRATIC_TETRA)
triangle = error(corners[:3], around, pv.CellType.QUADRATIC_TRIANGLE)
print(pv.__version__, pv.vtk_version_info, tetrahedron, triangle)
raise SystemExit(not (tetrahedron[1] > 1e-6 and triangle[1] < 1e-14))
PYTHON
