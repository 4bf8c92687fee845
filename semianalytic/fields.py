"""Fields of a contact: stress, displacement, from the pressure on its grid."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from semianalytic import subsurface
from semianalytic.inputs import Body
from semianalytic.level import Level

__all__ = ["displacement", "displacement_plane", "stress", "stress_plane"]

Array = NDArray[np.floating]

FINE = 8  # patches; stresses nearer to the surface are computed from patches of half the side


def stress(
    level: Level,
    body: Body,
    x: ArrayLike,
    y: ArrayLike,
    z: ArrayLike,
    layer: int | None,
    kept: subsurface.Tables | None = None,
) -> Array:
    """Stress tensor [Pa] at points [m], broadcast; shape (3, 3) + points.

    kept : tables shared by the levels of one contact, as in `subsurface.stress`.
    """
    grid = level.grid
    x, y, z, where = np.broadcast_arrays(x, y, z, body.layer_of(z, layer))
    result = np.empty((3, 3, *z.shape))
    near = (z < FINE * grid.d) & (level.shape is not None)
    for part, fine in ((near, True), (~near, False)):
        if part.any():
            patches, p = level.finer if fine else (grid, level.mean)
            points = x[part], y[part], z[part], where[part]
            result[..., part] = subsurface.stress(
                *points, grid_x=patches.x, grid_y=patches.x, pressure=p, kept=kept, body=body
            )
    return result


def stress_plane(level: Level, body: Body, z: float, layer: int | None) -> Array:
    """Stress tensor [Pa] below every patch centre at depth z [m]; shape (3, 3, n, n)."""
    x = level.grid.x
    plane = subsurface.stress_plane(z, int(body.layer_of(z, layer)), grid_x=x, grid_y=x, body=body)
    return subsurface.tensor(plane(level.mean))


def displacement_plane(level: Level, body: Body, z: float) -> Array:
    """Displacement [m] below every patch centre at depth z [m]; shape (3, n, n)."""
    x = level.grid.x
    plane = subsurface.displacement_plane(z, int(body.layer_of(z, None)), grid_x=x, grid_y=x, body=body)
    return plane(level.mean)


def displacement(level: Level, body: Body, x: ArrayLike, y: ArrayLike, z: ArrayLike) -> Array:
    """Displacement [m] at points [m], broadcast; shape (3,) + points."""
    patches = level.grid.x
    return subsurface.displacement(
        x, y, z, body.layer_of(z, None), grid_x=patches, grid_y=patches, pressure=level.mean, body=body
    )
