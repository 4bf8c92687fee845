"""Fields of a contact: ring by ring under its smooth edge, by patches for the rest of the pressure."""

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from semianalytic.inputs import Body
from semianalytic.patches.level import Level
from semianalytic.stresses import patch_field, subsurface
from semianalytic.stresses.rings import rings_of

Array = NDArray[np.floating]


def stress(
    levels: Sequence[Level],
    body: Body,
    x: ArrayLike,
    y: ArrayLike,
    z: ArrayLike,
    layer: int | NDArray[np.intp] | None,
) -> Array:
    """Stress tensor [Pa] of each level at points [m], broadcast; shape (len(levels), 3, 3) + points.

    Coarser levels are sampled at the same distance from their centre, over that of their edge there.
    """
    points = _points(body, x, y, z, layer)
    places = [level.matching(levels[0], *points[:2]) for level in levels]
    out = np.zeros((len(levels), 6, points[0].size))
    _add(out, levels, places, body, points, subsurface.stress, patch_field.stress)
    shape = np.broadcast_shapes(*(np.shape(v) for v in (x, y, z)))
    sigma = np.array([patch_field.tensor(one) for one in out]).reshape(len(levels), 3, 3, *shape)
    return levels[0].regular(sigma, x, y, z)


def displacement(levels: Sequence[Level], body: Body, x: ArrayLike, y: ArrayLike, z: ArrayLike) -> Array:
    """Displacement [m] of each level at points [m], broadcast; shape (len(levels), 3) + points."""
    points = _points(body, x, y, z, None)
    places = [points[:2]] * len(levels)
    out = np.zeros((len(levels), 3, points[0].size))
    _add(out, levels, places, body, points, subsurface.displacement, patch_field.displacement)
    return out.reshape(len(levels), 3, *np.broadcast_shapes(*(np.shape(v) for v in (x, y, z))))


def _add(
    out: Array,
    levels: Sequence[Level],
    places: Sequence[tuple[Array, Array]],
    body: Body,
    points: tuple[Array, Array, Array, NDArray[np.intp]],
    on_rings: Callable[..., Array],
    on_patches: Callable[..., Array],
) -> None:
    """Adds the field of each level at its ``places``, x and y [m], to ``out``."""
    smooth = [level.smooth(number) for number, level in enumerate(levels)]
    edged = [k for k, one in enumerate(smooth) if one is not None]
    if edged:
        pressures = [smooth[k] for k in edged]
        out[edged] = on_rings(*points, pressures=pressures, body=body, places=[places[k] for k in edged])
    for total, level, one, place in zip(out, levels, smooth, places, strict=True):
        rough = level.mean if one is None else level.rest
        if rough is not None:
            pressure = level.grid.whole(rough)
            total += on_patches(*place, *points[2:], grid_x=level.nodes, pressure=pressure, body=body)


def stress_changes(
    level: Level,
    body: Body,
    moves: Sequence[tuple[float, tuple[Array, Array]]],
    x: Array,
    y: Array,
    z: Array,
    layer: int | None,
) -> Array:
    """How much each stress [Pa] changes by each of ``moves``, (moves, 3, 3) + points.

    moves : how much wider [m] the smooth edge is, at the same load, and the places x, y [m] instead of those.
    """
    X, Y, Z, where = _points(body, x, y, z, layer)
    shape = level.shape
    assert shape is not None
    shapes = [shape.widened(shift) if shift else shape for shift, _ in moves]
    places = [(X, Y), *((u.ravel(), v.ravel()) for _, (u, v) in moves)]
    pressures = [rings_of(one) for one in (shape, *shapes)]
    here, *others = subsurface.stress(X, Y, Z, where, pressures=pressures, body=body, places=places)
    of_load = [np.prod(shape.axes) / np.prod(one.axes) for one in shapes]
    changes = [np.abs(share * other - here) for share, other in zip(of_load, others, strict=True)]
    return np.stack([patch_field.tensor(one.reshape(6, *np.shape(x))) for one in changes])


def stress_plane(level: Level, body: Body, z: float, layer: int | None) -> Array:
    """Stress tensor [Pa] below every patch centre at depth z [m]; shape (3, 3, n, n)."""
    number, pressure = int(body.layer_of(z, layer)), level.grid.whole(level.mean)
    return patch_field.tensor(
        patch_field.stress_plane(z, number, grid_x=level.nodes, pressure=pressure, body=body)
    )


def displacement_plane(level: Level, body: Body, z: float) -> Array:
    """Displacement [m] below every patch centre at depth z [m]; shape (3, n, n)."""
    number, pressure = int(body.layer_of(z, None)), level.grid.whole(level.mean)
    return patch_field.displacement_plane(z, number, grid_x=level.nodes, pressure=pressure, body=body)


def _points(
    body: Body, x: ArrayLike, y: ArrayLike, z: ArrayLike, layer: int | NDArray[np.intp] | None
) -> tuple[Array, Array, Array, NDArray[np.intp]]:
    """The points one after the other, with their layers."""
    x, y, z, where = np.broadcast_arrays(
        *(np.asarray(v, dtype=float) for v in (x, y, z)), body.layer_of(z, layer)
    )
    return x.ravel(), y.ravel(), z.ravel(), where.ravel()
