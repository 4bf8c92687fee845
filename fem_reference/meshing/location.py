"""Triangles that hold given points of the solid.

By hand: scikit-fem's search does not know on which side of an interface a point lies, and takes twenty times
as long for 10,000 points.
"""

from dataclasses import dataclass, fields
from functools import cached_property
from typing import Any

import numpy as np
from scipy.spatial import cKDTree
from skfem import Basis

from fem_reference import element_numbers as chosen
from fem_reference.meshing.mesh import MeridianMesh


@dataclass(frozen=True, eq=False)
class Uncached:
    """A dataclass that is pickled without its cached properties, a hundred times smaller."""

    def __getstate__(self) -> dict[str, object]:
        return {f.name: getattr(self, f.name) for f in fields(self)}


@dataclass(frozen=True, eq=False)
class LocatedPoints:
    """Points of shape (n,) in their triangles.

    r_given : radii as given.  r : at least ``EDGE_SIZE`` contact radii.  z : on interfaces exactly.
    layer : layer of each point.  cells : triangle of (r, z).  X : its reference coordinates, (2, n).
    """

    locator: "Locator"
    r_given: np.ndarray
    r: np.ndarray
    z: np.ndarray
    layer: np.ndarray
    cells: np.ndarray
    X: np.ndarray

    @cached_property
    def shapes(self) -> np.ndarray:
        """Shape functions of the triangles at the points, with derivatives by r and z, (3, functions, n)."""
        basis = self.locator.basis
        values = np.empty((3, basis.Nbfun, self.r.size))
        for i in range(basis.Nbfun):
            (phi,) = basis.elem.gbasis(basis.mapping, self.X[:, :, None], i, tind=self.cells)
            values[:, i] = np.asarray(phi)[:, 0], phi.grad[0][:, 0], phi.grad[1][:, 0]
        return values

    @cached_property
    def unknowns(self) -> np.ndarray:
        """Numbers of the unknowns (of one field) of the triangles, (functions, n)."""
        return np.asarray(self.locator.basis.element_dofs)[:, self.cells]

    @cached_property
    def interfaces(self) -> "list[tuple[int, np.ndarray, list[LocatedPoints]]]":
        """Interfaces with points, each as the layer above, the points' numbers, the points on either side."""
        found = []
        for upper, depth in enumerate(self.locator.mesh.depths):
            numbers = np.flatnonzero(self.z == depth)
            if numbers.size:
                r, z = self.r[numbers], self.z[numbers]
                sides = [self.locator.points(r, z, np.full(r.size, k)) for k in (upper, upper + 1)]
                found.append((upper, numbers, sides))
        return found

    def triangles_as_given(self) -> tuple[np.ndarray, np.ndarray]:
        """Triangles and reference coordinates at ``r_given`` in place of ``r``."""
        if np.array_equal(self.r, self.r_given):
            return self.cells, self.X
        return self.locator.triangles(self.r_given, self.z, self.layer)


@dataclass(frozen=True, eq=False)
class Locator:
    """Search for triangles of ``mesh``, as numbered by the ``basis`` on it."""

    mesh: MeridianMesh
    basis: Basis

    @cached_property
    def _trees(self) -> list[tuple[np.ndarray, cKDTree]]:
        mesh = self.mesh
        r, z = mesh.points[:, mesh.triangles].mean(axis=1)
        # centroids in the stretched plane, where triangles of one neighbourhood are of one size
        centres = mesh.plane(r, z).T
        members = [np.flatnonzero(mesh.layer == k) for k in range(mesh.depths.size + 1)]
        return [(m, cKDTree(centres[m])) for m in members]

    def points(self, r: np.ndarray, z: np.ndarray, layer: np.ndarray) -> LocatedPoints:
        """The points (r, z) of shape (n,) with their triangles inside ``layer``."""
        near = np.maximum(r, chosen.EDGE_SIZE * self.mesh.contact_radius)
        return LocatedPoints(self, r, near, z, layer, *self.triangles(near, z, layer))

    def triangles(self, r: np.ndarray, z: np.ndarray, layer: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Triangle of each point inside its layer, and the point's reference coordinates (2, n)."""
        mesh, t = self.mesh, self.basis.mesh.t
        cells = np.zeros(r.shape, dtype=int)
        for k, (members, tree) in enumerate(self._trees):
            mine = np.flatnonzero(layer == k)
            count = min(chosen.NEAREST, members.size)
            while mine.size:
                _, near = tree.query(mesh.plane(r[mine], z[mine]).T, k=count)
                candidates = members[near.reshape(mine.size, -1)]
                X = _reference_coordinates(mesh.points, t[:, candidates], r[mine, None], z[mine, None])
                inside = np.min([X[0], X[1], 1 - X[0] - X[1]], axis=0)
                best = np.argmax(inside, axis=1)
                cells[mine] = candidates[np.arange(mine.size), best]
                done = inside[np.arange(mine.size), best] > (1e-9 if count <= chosen.NEAREST else -1e-9)
                if count == members.size:
                    break
                mine, count = mine[~done], min(4 * count, members.size)
        return cells, _reference_coordinates(mesh.points, t[:, cells], r, z)


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
    x, y, z = x.ravel(), y.ravel(), z.ravel() / length
    distance = np.hypot(x, y)
    r, far = distance / length, float(mesh.points.max()) * length
    levels = np.array([0.0, *mesh.depths, np.inf])
    thickness = np.diff(levels)
    for k, level in enumerate(levels[:-1]):
        h = min(thickness[max(k - 1, 0)], thickness[k], mesh.contact_radius)
        z[np.abs(z - level) <= 1e-9 * h] = level
    if z.size and not (np.all(z >= 0) and np.all(np.isfinite(r)) and np.all(np.isfinite(z))):
        worst = length * z[~(z >= 0)][0] if np.any(~(z >= 0)) else np.nan
        raise ValueError(f"z = {worst:g} m is not inside the solid; depth counts down from 0 at the surface")
    farthest = length * max(z.max(initial=0), r.max(initial=0))
    if farthest > far * (1 + 1e-9):
        raise ValueError(
            f"a point {farthest:g} m out is beyond the meshed solid ({far:g} m); choose a larger far boundary"
        )
    # the upper side of an interface belongs to the layer above it
    layers = np.searchsorted(levels[1:-1], z, side="left")
    if layer is not None:
        if not 0 <= layer <= mesh.depths.size:
            raise ValueError(f"layer = {layer}; the solid has layers 0 to {mesh.depths.size}")
        lower, upper = levels[layer : layer + 2]
        outside = (z < lower) | (z > upper)
        if np.any(outside):
            beyond, upper, lower = (depth * length for depth in (z[outside][0], upper, lower))
            raise ValueError(f"z = {beyond:g} m is not in layer {layer}, from {lower:g} to {upper:g} m deep")
        layers = np.full(z.shape, layer)
    unit = np.where(r > 0, distance, 1.0)
    cos = np.where(r > 0, x / unit, 1.0)
    return SolidPoints(locator.points(r, z, layers), cos, y / unit, shape)


def _reference_coordinates(
    points: np.ndarray, triangles: np.ndarray, r: np.ndarray, z: np.ndarray
) -> np.ndarray:
    """Reference coordinates (2, ...) of the points in the triangles (3, ...)."""
    (r0, z0), (r1, z1), (r2, z2) = (points[:, corner] for corner in triangles)
    det = (r1 - r0) * (z2 - z0) - (r2 - r0) * (z1 - z0)
    s = ((r - r0) * (z2 - z0) - (r2 - r0) * (z - z0)) / det
    t = ((r1 - r0) * (z - z0) - (r - r0) * (z1 - z0)) / det
    return np.stack([s, t])
