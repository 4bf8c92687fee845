"""FreeFEM: axisymmetric elements of second order under a uniform disc; its radius is 1."""

import subprocess
import tempfile
from typing import Any

import numpy as np
from borders import script  # type: ignore[import-not-found]

FAR, SIDE = 5000.0, 1e-6  # size of the solid; distance to the axis and to the sides of an interface


def solve(substrate, coatings=(), pressure=None, load_radius=None, size=0.2, **sphere):
    """Moduli over the pressure; the program waits for places."""
    if pressure is None:
        raise NotImplementedError("this adapter prescribes the pressure")
    layers = [(E / pressure, nu) for E, nu, *_ in (*coatings, substrate)]
    depths = [0.0, *np.cumsum([h / load_radius for *_, h in coatings]).tolist(), FAR]
    with tempfile.NamedTemporaryFile("w", suffix=".edp", delete=False) as file:
        file.write(script(depths, layers, size))
    command = ["FreeFem++", "-nw", "-v", "0", file.name]
    run: Any = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

    def at(x, y, depth):
        places = zip(np.maximum(np.hypot(x, y) / load_radius, SIDE), -depth, strict=True)
        run.stdin.write(f"{x.size}\n" + "".join(f"{r:.15g} {z:.15g}\n" for r, z in places))
        run.stdin.flush()
        found = (line for line in run.stdout if line.startswith("AT "))
        return np.array([next(found).split()[1:] for _ in x], dtype=float).T

    def stress(x, y, z, layer):
        rr, tt, zz, rz, *_ = at(
            x, y, np.clip(z / load_radius, depths[layer] + SIDE, depths[layer + 1] - SIDE)
        )
        (E, nu), (c, s) = layers[layer], (f(np.arctan2(y, x)) for f in (np.cos, np.sin))
        G, mean, o = pressure * E / (1 + nu), nu / (1 - 2 * nu) * (rr + tt + zz), 0 * x
        polar = G * np.array([[rr + mean, o, -rz / 2], [o, tt + mean, o], [-rz / 2, o, zz + mean]])  # z down
        Q = np.array([[c, -s, o], [s, c, o], [o, o, 1 + o]])
        return np.einsum("ian,abn,jbn->ijn", Q, polar, Q)

    def displacement(x, y, z):
        *_, u, w = load_radius * at(x, y, z / load_radius)
        return np.array([u * np.cos(np.arctan2(y, x)), u * np.sin(np.arctan2(y, x)), -w])

    return {"stress": stress, "displacement": displacement}
