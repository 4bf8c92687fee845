#!/usr/bin/env bash
# VTK 9.7.2 (pyvista 0.49.1): a vtkRectilinearGrid of one point along y is sampled in its first row alone.
# Guess: a plane is a plane; x-z, y-z and x-y grids are sampled alike.
# Seen: of x + z at (0.6, 0.6), x-y gives 1.2 and is valid; x-z and y-z give 0 with vtkValidPointMask 0. The
# same plane as vtkImageData gives 1.2.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet pyvista==0.49.1 vtk==9.7.2 numpy==2.4.6
"$folder/venv/bin/python" - <<'PYTHON'
import numpy as np
import pyvista as pv

seen = {}
for flat in range(3):
    axes = [np.zeros(1) if k == flat else np.linspace(0, 1, 5) for k in range(3)]
    grid = pv.RectilinearGrid(*axes)
    grid["f"] = grid.points.sum(axis=1)
    place = np.full((1, 3), 0.6)
    place[0, flat] = 0
    found = pv.PolyData(place).sample(grid)
    seen["xyz"[flat]] = int(found["vtkValidPointMask"][0]), round(float(found["f"][0]), 6)
image = pv.ImageData(dimensions=(5, 1, 5), spacing=(0.25, 1, 0.25))
image["f"] = image.points.sum(axis=1)
seen["image"] = round(float(pv.PolyData([[0.6, 0, 0.6]]).sample(image)["f"][0]), 6)
print(pv.__version__, pv.vtk_version_info, seen)
raise SystemExit(seen != {"x": (0, 0.0), "y": (0, 0.0), "z": (1, 1.2), "image": 1.2})
PYTHON
