"""CalculiX: axisymmetric contact of a stiff cap with the coated solid, meshed by gmsh; lengths over a_h."""

import subprocess
import tempfile
from pathlib import Path

import numpy as np
from deck import INP, deck, table  # type: ignore[import-not-found]


def solve(radius, load, substrate, coatings=(), size=0.1):
    """The cap is moved until it carries the load; the pressure is -sigma_zz of the surface below it."""
    a = (3 * load * radius * (1 - substrate[1] ** 2) / (4 * substrate[0])) ** (1 / 3)
    depths = [0.0, *np.cumsum([h / a for _, _, h in coatings]).tolist(), 2000.0]
    moduli = [*(layer[:2] for layer in coatings), substrate]
    cap = (1e4 * max(E for E, _ in moduli), 0.0)
    W, delta = 0.0, a / radius
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        given = deck(folder, depths, [*moduli, cap], a / (2 * radius), size)
        while abs(W / load - 1) > 1e-4:
            delta *= (load / W) ** (2 / 3) if W else 1
            (folder / "m.inp").write_text(INP % (given | {"delta": delta}))
            subprocess.run(["ccx", "m"], cwd=folder, check=True, capture_output=True)
            W = -180 * a**2 * float((folder / "m.dat").read_text().split()[-2])  # of a sector of 2 degrees
        frd = (folder / "m.frd").read_text()
    (r, y), (_, s) = table(frd).T, table(frd.rpartition("STRESS")[2]).T
    surface = np.flatnonzero(y == 0)
    surface = surface[np.argsort(r[surface])]
    x, p = r[surface], -s[surface]
    near = (p > 0.1 * p[0]) & (p < 0.9 * p[0])  # p^2 falls linearly with r^2 near the edge
    edge = np.roots(np.polyfit(x[near] ** 2, p[near] ** 2, 1))[0] ** 0.5
    return {
        "contact_radius": a * edge,
        "approach": a * delta * (load / W) ** (2 / 3),
        "peak_pressure": p[0],
        "pressure": lambda at, y: np.interp(np.hypot(at, y) / a, x, np.where(x < edge, p, 0.0)),
    }
