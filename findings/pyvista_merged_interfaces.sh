#!/usr/bin/env bash
# pyvista 0.49.1: what becomes of two values at one point of an interface depends on the filter.
# Guess: points with other data stay apart, or all filters that merge points merge their data alike.
# Seen: of 10 on one side and 30 on the other, combine() and clean() make 20, which is on neither side;
# combine(merge_points=True) and merge() make 10.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet pyvista==0.49.1 vtk==9.7.2 numpy==2.4.6
"$folder/venv/bin/python" - <<'PYTHON'
import numpy as np
import pyvista as pv

upper = pv.ImageData(dimensions=(3, 3, 1)).cast_to_unstructured_grid()
lower = upper.translate((0, 2, 0))
upper["stress"], lower["stress"] = np.full(9, 10.0), np.full(9, 30.0)
blocks = pv.MultiBlock([upper, lower])
seen = {}
for name, mesh in {
    "combine": blocks.combine(),
    "clean": blocks.combine().clean(),
    "merge_points": blocks.combine(merge_points=True),
    "merge": upper.merge(lower),
}.items():
    seen[name] = np.unique(mesh["stress"][np.isclose(mesh.points[:, 1], 2)]).tolist()
print(pv.__version__, pv.vtk_version_info, seen)
raise SystemExit(seen != {"combine": [10.0, 30.0], "clean": [20.0], "merge_points": [10.0], "merge": [10.0]})
PYTHON
