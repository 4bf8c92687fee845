#!/usr/bin/env bash
# pyvista 0.49.1 on VTK 9.7.2: integrate_data takes a quadratic triangle for four flat linear ones.
# Guess: a quadratic field on a straight quadratic triangle is integrated exactly, as the cell interpolates it.
# Seen: the integral of x^2 over the unit triangle is 0.104167 in place of 1/12 = 0.083333; the area of one with
# a side that bulges is that of its chords, 0.707107 in place of 0.776142.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet pyvista==0.49.1 vtk==9.7.2 numpy==2.4.6
"$folder/venv/bin/python" - <<'PYTHON'
import numpy as np
import pyvista as pv


def triangle(middle):
    nodes = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0.5, 0, 0], [middle, middle, 0], [0, 0.5, 0]]
    return pv.UnstructuredGrid({pv.CellType.QUADRATIC_TRIANGLE: np.arange(6)[None]}, np.array(nodes, float))


straight, curved = triangle(0.5), triangle(0.5**0.5)
straight["square"] = straight.points[:, 0] ** 2
curved["one"] = np.ones(6)
seen = float(straight.integrate_data()["square"][0]), float(curved.integrate_data()["one"][0])
# below the quadratic side, a parabola over the chord of length sqrt(2)
bulge = 0.5 + 2 / 3 * 2**0.5 * (1 - 0.5**0.5)
print(pv.__version__, pv.vtk_version_info, "seen", seen, "exact", (1 / 12, bulge))
raise SystemExit(not np.allclose(seen, (5 / 48, 0.5**0.5), rtol=1e-9))
PYTHON
