"""Layers of a coated half-space by depth."""

import numpy as np
from numpy.typing import NDArray

from verification.problem.array_types import Array, Coatings


def layer_at(z: Array, coatings: Coatings, layer: int | None) -> NDArray[np.int_]:
    """Layer of each depth; on an interface the upper one unless ``layer`` says otherwise.

    Raises ValueError where ``layer`` does not reach ``z``, or z < 0.
    """
    bounds = np.concatenate([[0.0], np.cumsum([h for _, _, h in coatings])])
    slack = 1e-9 * (coatings[0][2] if coatings else 1e-300)
    if np.any(z < 0):
        raise ValueError(f"z = {z.min():g} m is above the surface; depth counts down from 0")
    if layer is None:
        return np.searchsorted(bounds[1:], z - slack)
    if not 0 <= layer <= len(coatings):
        raise ValueError(f"layer = {layer}; this solid has layers 0 to {len(coatings)}")
    end = np.inf if layer == len(coatings) else bounds[layer + 1]
    if np.any(z < bounds[layer] - slack) or np.any(z > end + slack):
        raise ValueError(f"layer = {layer} spans {bounds[layer]:g} to {end:g} m, not every z lies in it")
    return np.full(z.shape, layer)
