#!/usr/bin/env bash
# pyvista 0.49.1 on VTK 9.7.2: sample_over_line takes a neighbour for the right cell where a graded mesh is wide.
# Guess: a point inside a cell is interpolated in that cell; the default tolerance is for points just outside.
# Seen: 1 / (1 + r^2) on triangles graded from 0.001 to 5 is right within 0.002 on a line from 0 to 2; graded to
# 2500 it is wrong by 0.17, with vtkValidPointMask 1 at all 201 points. tolerance=1e-9 gives 0.005.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet pyvista==0.49.1 vtk==9.7.2 numpy==2.4.6
"$folder/venv/bin/python" - <<'PYTHON'
import numpy as np
import pyvista as pv


def errors(width, tolerance=None):
    x = np.concatenate([[0], np.geomspace(1e-3, width, 60)])
    X, Z = np.meshgrid(x, x)
    points = np.stack([X.ravel(), 0 * X.ravel(), Z.ravel()], axis=1)
    i = np.arange(x.size**2).reshape(x.size, x.size)
    a, b, c, d = (corner.ravel() for corner in (i[:-1, :-1], i[:-1, 1:], i[1:, 1:], i[1:, :-1]))
    cells = np.vstack([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    mesh = pv.UnstructuredGrid({pv.CellType.TRIANGLE: cells}, points)
    mesh["f"] = 1 / (1 + (points**2).sum(axis=1))
    line = mesh.sample_over_line((0, 0, 0.4), (2, 0, 0.4), resolution=200, tolerance=tolerance)
    exact = 1 / (1 + np.linspace(0, 2, 201) ** 2 + 0.4**2)
    return int(line["vtkValidPointMask"].sum()), float(np.abs(line["f"] - exact).max())


narrow, wide, careful = errors(5), errors(2500), errors(2500, 1e-9)
print(pv.__version__, pv.vtk_version_info, "width 5", narrow, "width 2500", wide, "with tolerance", careful)
as_seen = narrow[1] < 0.003 and wide[0] == 201 and wide[1] > 0.1 and careful[1] < 0.006
raise SystemExit(not as_seen)
PYTHON
