"""GetDP: axisymmetric elements of second order under a uniform disc, meshed by gmsh; its radius is 1."""

import subprocess
import tempfile
from pathlib import Path

import numpy as np
from mesh import write_mesh  # type: ignore[import-not-found]

MODEL = Path(__file__).with_name("model.pro").read_text()
OPERATION = "PostOperation { { Name At; NameOfPostProcessing Strain; Operation {\n%s} } }\n"
FAR, SIDE = 5000.0, 1e-6  # size of the solid; distance to the axis and to the sides of an interface


def solve(substrate, coatings=(), pressure=None, load_radius=None, size=0.2, **sphere):
    """Moduli over the pressure; strains and displacements of places by a run of the solved problem."""
    if pressure is None:
        raise NotImplementedError("this adapter prescribes the pressure")
    layers = [(E / pressure, nu) for E, nu, *_ in (*coatings, substrate)]
    depths = [0.0, *np.cumsum([h / load_radius for *_, h in coatings]).tolist(), FAR]
    folder, names = Path(tempfile.mkdtemp()), [f"L{k}" for k in range(1, len(layers) + 1)]
    write_mesh(folder / "m.msh", depths, FAR, size)
    given = {"all": ", ".join(names), "groups": "", "moduli": ""}
    for k, (name, layer) in enumerate(zip(names, layers, strict=True), start=1):
        given["groups"] += f"  {name} = Region[{k}];\n"
        given["moduli"] += "".join(
            f"  {m}[{name}] = {v!r};\n" for m, v in zip(("E", "nu"), layer, strict=True)
        )
    (folder / "m.pro").write_text(MODEL % given)
    (folder / "places.pro").write_text("")
    command = ["getdp", "m.pro", "-msh", "m.msh", "-v", "1"]
    subprocess.run([*command, "-solve", "Elastic"], cwd=folder, check=True, capture_output=True)

    def at(names, x, y, depth):
        r = np.maximum(np.hypot(x, y) / load_radius, SIDE)
        form = 'Print[{}, OnPoint {{{:.15g}, {:.15g}, 0}}, Format Table, File >> "{}.txt"];\n'
        lines = "".join(form.format(n, *place, n) for n in names for place in zip(r, -depth, strict=True))
        (folder / "places.pro").write_text(OPERATION % lines)
        for name in names:
            (folder / f"{name}.txt").unlink(missing_ok=True)
        subprocess.run([*command, "-pos", "At"], cwd=folder, check=True, capture_output=True)
        return r, *(np.loadtxt(folder / f"{name}.txt", ndmin=2)[:, -3:].T for name in names)

    def stress(x, y, z, layer):
        depth = np.clip(z / load_radius, depths[layer] + SIDE, depths[layer + 1] - SIDE)
        r, (rr, zz, rz), (u, *_) = at("ev", x, y, depth)
        (E, nu), tt, (c, s) = layers[layer], u / r, (f(np.arctan2(y, x)) for f in (np.cos, np.sin))
        G, mean, o = pressure * E / (1 + nu), nu / (1 - 2 * nu) * (rr + tt + zz), 0 * x
        polar = G * np.array([[rr + mean, o, -rz / 2], [o, tt + mean, o], [-rz / 2, o, zz + mean]])  # z down
        Q = np.array([[c, -s, o], [s, c, o], [o, o, 1 + o]])
        return np.einsum("ian,abn,jbn->ijn", Q, polar, Q)

    def displacement(x, y, z):
        u, w, _ = load_radius * at("v", x, y, z / load_radius)[1]
        return np.array([u * np.cos(np.arctan2(y, x)), u * np.sin(np.arctan2(y, x)), -w])

    return {"stress": stress, "displacement": displacement}
