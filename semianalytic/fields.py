"""Fields of a contact: ring by ring under its smooth edge, by patches for the rest of the pressure."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from semianalytic import patch_field, subsurface
from semianalytic.inputs import Body
from semianalytic.level import Level
from semianalytic.rings import rings_of

__all__ = ["displacement", "displacement_plane", "stress", "stress_of_uncertain_edge", "stress_plane"]

Array = NDArray[np.floating]


def stress(
    levels: Sequence[Level],
    body: Body,
    x: ArrayLike,
    y: ArrayLike,
    z: ArrayLike,
    layer: int | None,
) -> Array:
    """Stress tensor [Pa] of each level at points [m], broadcast; shape (len(levels), 3, 3) + points.

    Coarser levels are sampled at the same distance from their edge, over their radius.
    """
    points = _points(body, x, y, z, layer)
    out = np.zeros((len(levels), 6, points[0].size))
    of_rings: subsurface.Tables = {}  # a point force does not depend on the grid
    of_patches: patch_field.Tables = {}
    for number, (total, level) in enumerate(zip(out, levels, strict=True)):
        at = _scaled(points, level, levels[0])
        smooth = level.smooth(number)
        if smooth is not None:
            total += subsurface.stress(*at, pressure=smooth, body=body, kept=of_rings)
        rough = level.mean if smooth is None else level.rest
        if rough is not None:
            few = smooth is not None
            total += patch_field.stress(
                *at,
                grid_x=level.nodes,
                pressure=level.grid.whole(rough),
                body=body,
                kept=of_patches,
                few_depths=few,
            )
    shape = np.broadcast_shapes(*(np.shape(v) for v in (x, y, z)))
    return np.array([patch_field.tensor(one) for one in out]).reshape(len(levels), 3, 3, *shape)


def stress_of_uncertain_edge(
    level: Level, body: Body, shift: float, x: Array, y: Array, z: Array, layer: int | None
) -> Array:
    """Largest change of a stress [Pa] when a smooth edge widens or narrows by ``shift`` [m], (n,)."""
    points = _points(body, x, y, z, layer)
    kept: subsurface.Tables = {}
    assert level.shape is not None
    moved = [rings_of(level.shape.widened(s)) for s in (0.0, -shift, shift)]
    here, *others = (subsurface.stress(*points, pressure=one, body=body, kept=kept) for one in moved)
    return np.max([np.abs(other - here).max(axis=0) for other in others], axis=0)


def displacement(levels: Sequence[Level], body: Body, x: ArrayLike, y: ArrayLike, z: ArrayLike) -> Array:
    """Displacement [m] of each level at points [m], broadcast; shape (len(levels), 3) + points."""
    points = _points(body, x, y, z, None)
    out = np.zeros((len(levels), 3, points[0].size))
    kept: subsurface.Tables = {}
    for number, (total, level) in enumerate(zip(out, levels, strict=True)):
        smooth = level.smooth(number)
        if smooth is not None:
            total += subsurface.displacement(*points, pressure=smooth, body=body, kept=kept)
        rough = level.mean if smooth is None else level.rest
        if rough is not None:
            total += patch_field.displacement(
                *points, grid_x=level.nodes, pressure=level.grid.whole(rough), body=body
            )
    return out.reshape(len(levels), 3, *np.broadcast_shapes(*(np.shape(v) for v in (x, y, z))))


def stress_plane(level: Level, body: Body, z: float, layer: int | None) -> Array:
    """Stress tensor [Pa] below every patch centre at depth z [m]; shape (3, 3, n, n)."""
    number = int(body.layer_of(z, layer))
    plane = patch_field.stress_plane(z, number, grid_x=level.nodes, body=body)
    return patch_field.tensor(plane(level.grid.whole(level.mean)))


def displacement_plane(level: Level, body: Body, z: float) -> Array:
    """Displacement [m] below every patch centre at depth z [m]; shape (3, n, n)."""
    number = int(body.layer_of(z, None))
    return patch_field.displacement_plane(z, number, grid_x=level.nodes, body=body)(
        level.grid.whole(level.mean)
    )


def _points(
    body: Body, x: ArrayLike, y: ArrayLike, z: ArrayLike, layer: int | None
) -> tuple[Array, Array, Array, NDArray[np.intp]]:
    """The points one after the other, with their layers."""
    x, y, z, where = np.broadcast_arrays(
        *(np.asarray(v, dtype=float) for v in (x, y, z)), body.layer_of(z, layer)
    )
    return x.ravel(), y.ravel(), z.ravel(), where.ravel()


def _scaled(points: tuple[Array, Array, Array, NDArray[np.intp]], level: Level, first: Level):  # noqa: ANN202
    """The points at the same x/a and y/a of another level with a smooth edge."""
    if level.shape is None or first.shape is None or level is first:
        return points
    x, y, z, where = points
    ratio = level.shape.radius / first.shape.radius
    return x * ratio, y * ratio, z, where
