"""Fields of a contact: exact for its edge profile, by patches for the remainder of p."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from semianalytic import axisymmetric, subsurface
from semianalytic.edge_profile import Prescribed, Profile
from semianalytic.inputs import Body
from semianalytic.level import Level

__all__ = ["displacement", "displacement_plane", "stress", "stress_of_uncertain_edge", "stress_plane"]

Array = NDArray[np.floating]

FINE = 8  # patches; stresses of a prescribed pressure nearer to the surface use patches of half the side


def stress(
    levels: Sequence[Level],
    body: Body,
    x: ArrayLike,
    y: ArrayLike,
    z: ArrayLike,
    layer: int | None,
) -> Array:
    """Stress tensor [Pa] of each level at points [m], broadcast; shape (len(levels), 3, 3) + points."""
    x, y, z, where = np.broadcast_arrays(x, y, z, body.layer_of(z, layer))
    result = np.zeros((len(levels), 3, 3, *z.shape))
    kept: subsurface.Tables = {}  # a point force does not depend on the grid
    for number, (out, level) in enumerate(zip(result, levels, strict=True)):
        small = isinstance(level.shape, Profile)
        if small and (number > 0 or not level.rest.any()):
            continue  # the rest of a companion is the error of its profile, which the difference shall show
        fine = (z < FINE * level.grid.d) & isinstance(level.shape, Prescribed)
        for part, (patches, p) in ((fine, level.finer), (~fine, (level.grid, _on_patches(level)))):
            if part.any():
                points = x[part], y[part], z[part], where[part]
                out[..., part] = subsurface.stress(
                    *points,
                    grid_x=patches.x,
                    grid_y=patches.x,
                    pressure=p,
                    kept=kept,
                    body=body,
                    few_depths=small,
                )
    profiles = {i: level.shape for i, level in enumerate(levels) if isinstance(level.shape, Profile)}
    if profiles:
        everywhere = tuple(np.asarray(v).ravel() for v in (x, y, z, where))
        exact = axisymmetric.stress(list(profiles.values()), body, *everywhere)
        for i, components in zip(profiles, exact, strict=True):
            result[i] += subsurface.tensor(components).reshape(3, 3, *z.shape)
    return result


def stress_of_uncertain_edge(
    level: Level, body: Body, shift: float, x: ArrayLike, y: ArrayLike, z: ArrayLike, layer: int | None
) -> Array:
    """Largest change of a stress [Pa] when the edge profile widens or narrows by ``shift`` [m].

    Returns the shape of the points.
    """
    x, y, z, where = np.broadcast_arrays(x, y, z, body.layer_of(z, layer))
    shape = level.shape
    assert isinstance(shape, Profile)
    points = tuple(np.asarray(v).ravel() for v in (x, y, z, where))
    moved = [Profile(shape.radius + s, shape.coefficients) for s in (0.0, -shift, shift)]
    here, *others = axisymmetric.stress(moved, body, *points)
    return np.max([np.abs(other - here).max(axis=0) for other in others], axis=0).reshape(z.shape)


def stress_plane(level: Level, body: Body, z: float, layer: int | None) -> Array:
    """Stress tensor [Pa] below every patch centre at depth z [m]; shape (3, 3, n, n)."""
    x, number = level.grid.x, int(body.layer_of(z, layer))
    plane = subsurface.stress_plane(z, number, grid_x=x, grid_y=x, body=body)
    components = plane(_on_patches(level))
    if isinstance(level.shape, Profile):
        components += axisymmetric.stress([level.shape], body, *_plane(x, z, number))[0].reshape(
            components.shape
        )
    return subsurface.tensor(components)


def displacement_plane(level: Level, body: Body, z: float) -> Array:
    """Displacement [m] below every patch centre at depth z [m]; shape (3, n, n)."""
    x, number = level.grid.x, int(body.layer_of(z, None))
    components = subsurface.displacement_plane(z, number, grid_x=x, grid_y=x, body=body)(_on_patches(level))
    if isinstance(level.shape, Profile):
        components += axisymmetric.displacement([level.shape], body, *_plane(x, z, number))[0].reshape(
            components.shape
        )
    return components


def displacement(levels: Sequence[Level], body: Body, x: ArrayLike, y: ArrayLike, z: ArrayLike) -> Array:
    """Displacement [m] of each level at points [m], broadcast; shape (len(levels), 3) + points.

    Companions of a level with an edge profile have the same rest on the patches.
    """
    x, y, z, where = np.broadcast_arrays(x, y, z, body.layer_of(z, None))
    patches, p = levels[0].grid.x, _on_patches(levels[0])
    u = np.zeros((len(levels), 3, *np.shape(z)))
    if p.any():
        u[:] = subsurface.displacement(x, y, z, where, grid_x=patches, grid_y=patches, pressure=p, body=body)
    profiles = [level.shape for level in levels if isinstance(level.shape, Profile)]
    if profiles:
        points = tuple(np.asarray(v).ravel() for v in (x, y, z, where))
        u += axisymmetric.displacement(profiles, body, *points).reshape(u.shape)
    return u


def _on_patches(level: Level) -> Array:
    """The pressure [Pa] that the patches carry: all of it without an edge profile."""
    return level.rest if isinstance(level.shape, Profile) else level.mean


def _plane(x: Array, z: float, layer: int) -> tuple[Array, Array, Array, Array]:
    X, Y = (v.ravel() for v in np.meshgrid(x, x, indexing="ij"))
    return X, Y, np.full(X.size, z), np.full(X.size, layer)
