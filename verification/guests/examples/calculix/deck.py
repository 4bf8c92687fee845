"""The model of CalculiX filled in: mesh by gmsh, sets by coordinates, a table of its results."""

import subprocess
from pathlib import Path

import numpy as np

GEO, INP = ((Path(__file__).parent / name).read_text() for name in ("model.geo", "model.inp"))
SOLID = "*MATERIAL,NAME=S{0}\n*ELASTIC\n{1:.12g},{2:.12g}\n*SOLID SECTION,ELSET=S{0},MATERIAL=S{0}\n"


def deck(folder, depths, moduli, bend, size):
    """The input but for delta, after gmsh has written mesh.inp; the last of ``moduli`` is the cap's."""
    geo, mesh = folder / "m.geo", folder / "mesh.inp"
    geo.write_text(GEO % {"z": ", ".join(map(str, depths)), "size": size, "bend": bend})
    subprocess.run(["gmsh", "-2", geo, "-o", mesh], check=True, capture_output=True)
    text = mesh.read_text().replace("CPS6", "CAX6")
    mesh.write_text(text)
    rows = [line.split(",") for line in text.splitlines() if line[:1].isdigit() and line[-2] != ","]
    n, *at = np.array([row[:3] for row in rows if len(row) == 4], dtype=float).T
    element, *t = np.array([row for row in rows if len(row) == 7], dtype=int).T
    r, y = np.full((2, int(n.max()) + 1), np.nan)
    r[n.astype(int)], y[n.astype(int)] = at
    given = {"materials": "".join(SOLID.format(k, *m) for k, m in enumerate(moduli, start=1))}
    for name, on in (("AXIS", r < 0.0021), ("FAR", (r > 1999) | (y < -1999)), ("TOP", y > 1.999)):
        given[name] = "\n".join(map(str, np.flatnonzero(on)))
    for name, on in (("FLAT", (y == 0) & (r < 3)), ("CAP", (y > 0) & (abs(y - bend * r**2) < 1e-4))):
        faces = [on[t[i]] & on[t[(i + 1) % 3]] & on[t[i + 3]] for i in range(3)]
        given[name] = "\n".join(f"{k},S{i + 1}" for i in range(3) for k in element[faces[i]])
    return given | {"stiffness": 1e3 * moduli[-2][0]}


def table(text):
    """The first two numbers of each node up to the end of a block of m.frd, (nodes, 2)."""
    rows = (row for row in text.partition("\n -3")[0].splitlines() if row.startswith(" -1"))
    return np.array([(row[13:25], row[25:37]) for row in rows], dtype=float)
