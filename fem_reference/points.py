"""Cylindrical coordinates of given points of the solid."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from .location import LocatedPoints, Locator

__all__ = ["SolidPoints", "solid_points"]


@dataclass(frozen=True, eq=False)
class SolidPoints:
    """Points of shape (n,) in the meridian plane, their angle from x, and the shape they were given in."""

    located: LocatedPoints
    cos: np.ndarray
    sin: np.ndarray
    shape: tuple[int, ...]


def solid_points(locator: Locator, length: float, x: Any, y: Any, z: Any, layer: int | None) -> SolidPoints:
    """Broadcast the points (x, y, z) [m], snap them to interfaces within rounding, find their layers.

    length : unit of the mesh [m].  layer : of all points, or None for the upper one at an interface
    Raises ValueError for a point outside the solid or outside ``layer``.
    """
    mesh = locator.mesh
    x, y, z = np.broadcast_arrays(*(np.asarray(c, dtype=float) for c in (x, y, z)))
    shape = x.shape
    x, y, z = x.ravel(), y.ravel(), z.ravel().copy()
    r = np.hypot(x, y)
    depths, far = mesh.depths * length, float(mesh.points.max()) * length
    levels = np.concatenate([[0.0], depths])
    thickness = np.diff(levels, append=np.inf)
    for k, level in enumerate(levels):
        h = min(thickness[max(k - 1, 0)], thickness[k], mesh.contact_radius * length)
        z[np.abs(z - level) <= 1e-9 * h] = level
    if z.size and not (np.all(z >= 0) and np.all(np.isfinite(r)) and np.all(np.isfinite(z))):
        worst = z[~(z >= 0)][0] if np.any(~(z >= 0)) else np.nan
        raise ValueError(f"z = {worst:g} m is not inside the solid; depth counts down from 0 at the surface")
    if z.size and max(z.max(), r.max()) > far * (1 + 1e-9):
        raise ValueError(
            f"a point {max(z.max(), r.max()):g} m out is beyond the meshed solid ({far:g} m); "
            f"choose a larger far boundary"
        )
    # the upper side of an interface belongs to the layer above it
    layers = np.searchsorted(depths, z, side="left")
    if layer is not None:
        if not 0 <= layer <= depths.size:
            raise ValueError(f"layer = {layer}; the solid has layers 0 to {depths.size}")
        lower, upper = levels[layer], np.append(depths, np.inf)[layer]
        outside = (z < lower) | (z > upper)
        if np.any(outside):
            raise ValueError(
                f"z = {z[outside][0]:g} m is not in layer {layer}, from {lower:g} to {upper:g} m deep"
            )
        layers = np.full(z.shape, layer)
    unit = np.where(r > 0, r, 1.0)
    cos = np.where(r > 0, x / unit, 1.0)
    return SolidPoints(locator.points(r / length, z / length, layers), cos, y / unit, shape)
