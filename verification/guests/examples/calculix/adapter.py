"""CalculiX: axisymmetric contact of a stiff cap with the coated solid, meshed by gmsh; lengths over a_h."""

import subprocess
import tempfile
from pathlib import Path

import numpy as np

GEO, INP = ((Path(__file__).parent / name).read_text() for name in ("model.geo", "model.inp"))
SOLID = "*ELEMENT,TYPE=CAX6,ELSET=S{0}\n{1}\n*MATERIAL,NAME=M{0}\n*ELASTIC\n{2:.12g},{3:.12g}\n"
SOLID += "*SOLID SECTION,ELSET=S{0},MATERIAL=M{0}\n"


def solve(radius, load, substrate, coatings=(), size=0.1):
    """The cap is moved until it carries the load; the pressure is -sigma_zz of the surface below it."""
    a = (3 * load * radius * (1 - substrate[1] ** 2) / (4 * substrate[0])) ** (1 / 3)
    z, bend, delta = np.cumsum([0.0, *(h / a for _, _, h in coatings)]).tolist(), a / (2 * radius), a / radius
    moduli = [*(c[:2] for c in coatings), substrate, (1e4 * max(c[0] for c in (*coatings, substrate)), 0.0)]
    with tempfile.TemporaryDirectory() as folder:
        run(
            folder,
            "m.geo",
            GEO % {"z": str([*z, 2000.0])[1:-1], "size": size, "bend": bend},
            "gmsh",
            "-2",
            "m.geo",
        )
        nodes, elements = (part.split()[2:] for part in Path(folder, "m.msh").read_text().split("$")[3:6:2])
        n, r, y, _ = np.array(nodes, dtype=float).reshape(-1, 4).T
        part, *t = np.array(elements, dtype=int).reshape(-1, 11)[:, [3, 5, 6, 7, 8, 9, 10]].T
        solids = [
            lines(*(v[part == k] for v in (1 + np.arange(part.size), *t))) for k in range(1, len(moduli) + 1)
        ]
        given = {
            "AXIS": lines(n[r < 0.0021]),
            "FAR": lines(n[(r > 1999) | (y < -1999)]),
            "TOP": lines(n[y > 1.999]),
        }
        given |= {"nodes": lines(n, r, y), "stiffness": 1e3 * substrate[0]}
        given["solids"] = "".join(
            SOLID.format(k, *one) for k, one in enumerate(zip(solids, *zip(*moduli)), start=1)
        )
        for name, on in (("FLAT", (y == 0) & (r < 4)), ("CAP", abs(y - bend * r**2) < 1e-4)):
            of = (part == len(moduli)) == (name == "CAP")
            faces = [of & on[t[i] - 1] & on[t[(i + 1) % 3] - 1] & on[t[i + 3] - 1] for i in range(3)]
            given[name] = "\n".join(f"{k + 1},S{i + 1}" for i in range(3) for k in np.flatnonzero(faces[i]))
        for _ in range(8):
            run(folder, "m.inp", INP % (given | {"delta": delta}), "ccx", "m")
            W = -180 * a**2 * float(Path(folder, "m.dat").read_text().split()[-2])  # of a sector of 2 degrees
            if abs(W / load - 1) < 1e-5:
                break
            delta *= (load / W) ** (2 / 3)
        frd = Path(folder, "m.frd").read_text()
    x, p = np.array(
        sorted((x, -s) for (x, y), (_, s) in zip(table(frd), table(frd.rsplit("STRESS")[1])) if y == 0)
    ).T
    near = (p > 0.1 * p[0]) & (p < 0.7 * p[0])  # p^2 falls linearly with r^2 at the edge
    edge = np.roots(np.polyfit(x[near] ** 2, p[near] ** 2, 1))[0] ** 0.5
    found = {"contact_radius": a * edge, "approach": a * delta, "peak_pressure": p[0]}
    return found | {"pressure": lambda x1, y1: np.interp(np.hypot(x1, y1) / a, x, np.where(x < edge, p, 0))}


def run(folder, name, text, *command):
    Path(folder, name).write_text(text)
    subprocess.run(command, cwd=folder, check=True, capture_output=True)


def lines(*columns):
    return "\n".join(",".join(f"{v:.12g}" for v in row) for row in zip(*columns, strict=True))


def table(text):
    rows = (row for row in text.split("\n -3")[0].splitlines() if row.startswith(" -1"))
    return [(float(row[13:25]), float(row[25:37])) for row in rows]
