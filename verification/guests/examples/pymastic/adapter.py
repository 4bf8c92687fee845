"""PyMastic: layered half-space under a uniform disc, a call for each point; its radius is 1."""

import numpy as np
from Main.MLE import PyMastic

SIDE = 1e-6  # distance to the sides of an interface


def solve(substrate, coatings=(), pressure=None, load_radius=None, iteration=100, **sphere):
    """Two layers at least: an uncoated solid has a layer of its own material. Tension is negative there."""
    if pressure is None:
        raise NotImplementedError("PyMastic takes a pressure on a disc")
    layers = (*(coatings or ((*substrate, load_radius),)), substrate)
    H = [h / load_radius for *_, h in layers[:-1]]
    E, nu = [layer[0] / pressure / 1000 for layer in layers], [layer[1] for layer in layers]
    bonded = [1] * len(H)
    depths = np.array([0.0, *np.cumsum(H), 1000.0])

    def at(x, y, z, *names):
        places = zip(np.hypot(x, y) / load_radius, z, strict=True)
        found = [PyMastic(1.0, 1.0, [r], [d], H, E, nu, 1e-3, bonded, int(iteration)) for r, d in places]
        return np.array([[one[name][0, 0] for name in names] for one in found]).T

    def stress(x, y, z, layer):
        z = z / load_radius
        if coatings:
            z = np.clip(z, depths[layer] + SIDE, depths[layer + 1] - SIDE)
        rr, tt, zz = -pressure * at(x, y, z, "Stress_R", "Stress_T", "Stress_Z")
        c, s = (f(np.arctan2(y, x)) for f in (np.cos, np.sin))
        xx, yy, xy, no = (
            c**2 * rr + s**2 * tt,
            s**2 * rr + c**2 * tt,
            c * s * (rr - tt),
            np.full_like(rr, np.nan),
        )
        return np.array([[xx, xy, no], [xy, yy, no], [no, no, zz]])  # the shear rz is not given

    def displacement(x, y, z):
        u, w = load_radius * at(x, y, z / load_radius + SIDE, "Displacement_H", "Displacement_Z")
        return np.array([u * np.cos(np.arctan2(y, x)), u * np.sin(np.arctan2(y, x)), w])

    return {"stress": stress, "displacement": displacement}
