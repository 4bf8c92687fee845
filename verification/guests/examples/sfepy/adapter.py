"""sfepy: axisymmetric elements of second order under a uniform disc; lengths over its radius."""

import numpy as np
from weak_form import displaced  # type: ignore[import-not-found]

FAR, SIDE = 5000.0, 1e-6  # size of the solid; distance to the axis and to the sides of an interface


def solve(substrate, coatings=(), pressure=None, load_radius=None, size=0.2, **sphere):
    """Strains by the gradients of both displacements and u/r."""
    if pressure is None:
        raise NotImplementedError("this adapter prescribes the pressure")
    layers = np.array([(E / pressure, nu) for E, nu, *_ in (*coatings, substrate)])
    depths = np.array([0.0, *np.cumsum([h / load_radius for *_, h in coatings]), FAR])
    fields = displaced(layers, depths[1:-1], FAR, size)

    def at(x, y, depth):
        places = np.stack([np.maximum(np.hypot(x, y) / load_radius, SIDE), depth], -1)
        found = [
            f.evaluate_at(places, mode=mode).reshape(x.size, -1).T for mode in ("val", "grad") for f in fields
        ]
        return places[:, 0], *found, *(f(np.arctan2(y, x)) for f in (np.cos, np.sin))

    def stress(x, y, z, layer):
        depth = np.clip(z / load_radius, depths[layer] + SIDE, depths[layer + 1] - SIDE)
        r, (U,), _, (rr, U_z), (W_r, zz), c, s = at(x, y, depth)
        (E, nu), tt, o = layers[layer], U / r, 0 * x
        G, mean, rz = pressure * E / (1 + nu), nu / (1 - 2 * nu) * (rr + U / r + zz), (U_z + W_r) / 2
        polar = G * np.array([[rr + mean, o, rz], [o, tt + mean, o], [rz, o, zz + mean]])
        Q = np.array([[c, -s, o], [s, c, o], [o, o, 1 + o]])
        return np.einsum("ian,abn,jbn->ijn", Q, polar, Q)

    def displacement(x, y, z):
        _, (U,), (W,), *_, c, s = at(x, y, z / load_radius)
        return load_radius * np.array([U * c, U * s, W])

    return {"stress": stress, "displacement": displacement}
