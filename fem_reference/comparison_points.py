"""Points at which solutions on several meshes are compared, and the largest values around them.

By hand: scikit-fem compares no fields on unrelated meshes.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.ndimage import maximum_filter1d

from fem_reference import element_numbers as chosen
from fem_reference.elasticity.axisymmetric import Discretisation
from fem_reference.meshing.location import LocatedPoints, Uncached

# Those of triangles are moved towards the centre in depth: none lies on a plane with a formula of its own,
# nor at a vertex of a plane, where two cells have two stresses.
_CELL = np.linspace(chosen.EDGE_SIZE, 1 - chosen.EDGE_SIZE, 7)


@dataclass(frozen=True, eq=False)
class ComparisonPoints(Uncached):
    """Points on the first of some meshes, located on all of them."""

    meshes: tuple[Discretisation, ...]

    def _on_each(self, r: np.ndarray, z: np.ndarray, layer: np.ndarray) -> list[LocatedPoints]:
        # at the same r/a: next to the edge a displaced one would hide what the triangles miss
        a = self.meshes[0].mesh.contact_radius
        return [d.locator.points(d.mesh.contact_radius / a * r, z, layer) for d in self.meshes]

    @property
    def _reach(self) -> float:
        """Radius and depth that lie in each of the meshes."""
        a = self.meshes[0].mesh.contact_radius
        return float(min(d.mesh.points.max() * min(1.0, a / d.mesh.contact_radius) for d in self.meshes))

    @cached_property
    def triangles(self) -> list[LocatedPoints]:
        """Seven points of every triangle of the first mesh, shape (7 * triangles,)."""
        d = self.meshes[0]
        # corners, middles and centre: the hoop strain is worst on the axis itself
        s1, s2 = np.array([[0, 1, 0, 1 / 2, 1 / 2, 0, 1 / 3], [0, 0, 1, 0, 1 / 2, 1 / 2, 1 / 3]])
        shape = np.stack([1 - s1 - s2, s1, s2])
        corners = d.mesh.points[:, d.triangulation.t]
        r, z = np.einsum("cp,dct->dpt", shape, corners)
        z = z + chosen.EDGE_SIZE * (corners[1].mean(axis=0) - z)
        layer = np.broadcast_to(d.mesh.layer, r.shape)
        r, z = np.minimum((r, z), self._reach).reshape(2, -1)
        return self._on_each(r, z, layer.ravel())

    @cached_property
    def planes(self) -> dict[tuple[float, int], tuple[np.ndarray, list[LocatedPoints]]]:
        """Vertices and points between them on the surface and both sides of interfaces, by (depth, layer)."""
        mesh = self.meshes[0].mesh
        interfaces = [(float(depth), layer) for k, depth in enumerate(mesh.depths) for layer in (k, k + 1)]
        planes = {}
        for depth, layer in [(0.0, 0), *interfaces]:
            vertices = np.sort(mesh.points[0, mesh.points[1] == depth])
            vertices = vertices[vertices < 0.9 * self._reach]
            r = samples(vertices)
            points = self._on_each(r, np.full(r.shape, depth), np.full(r.shape, layer))
            planes[depth, layer] = vertices, points
        return planes

    def largest_on_plane(self, values: np.ndarray, plane: tuple[float, int]) -> np.ndarray:
        """The largest of ``values`` around each vertex of a ``plane``, given by depth and layer.

        Within `RINGS` cells, and within the depth: a load on the surface has about the same stress so far
        away, however narrow the cells are. Changes on the axis count `AXIS_SAFETY` times, for what its one
        cell misses depends on the triangles by chance.

        values : (meshes, rows, n) at ``samples``.  Returns (meshes, rows, vertices)
        """
        r, (depth, _) = self.planes[plane][0], plane
        largest = _one_on_axis(largest_around(values), np.arange(r.size) <= chosen.RINGS)
        near = np.abs(r[:, None] - r) <= depth
        counted = largest * np.where(r == 0, chosen.AXIS_SAFETY[0], 1.0)
        return np.asarray(np.where(near, counted[..., None, :], 0.0).max(axis=-1))

    def largest_at_corners(self, values: np.ndarray) -> np.ndarray:
        """The largest of ``values`` in `RINGS` rings of triangles around each corner of the triangles.

        values : (meshes, rows, n) at ``triangles``.  Returns (meshes, rows, 3, triangles); rings end at
        interfaces
        """
        on_axis = self.triangles[0].r_given[None] == 0
        return _one_on_axis(self._around_corners(values), self._around_corners(on_axis)[0] > 0)

    def _around_corners(self, values: np.ndarray) -> np.ndarray:
        """The largest of ``values`` (..., n) around each corner, of any rows."""
        mesh, triangulation = self.meshes[0].mesh, self.meshes[0].triangulation
        vertices = triangulation.t + mesh.layer * mesh.points.shape[1]  # those of each layer apart
        worst = values.reshape(-1, values.shape[-1] // vertices.shape[1], vertices.shape[1]).max(axis=1)
        largest = np.zeros((len(worst), (int(mesh.layer.max()) + 1) * mesh.points.shape[1]))
        for _ in range(chosen.RINGS):
            for corner in vertices:
                for component, row in zip(worst, largest, strict=True):
                    np.maximum.at(row, corner, component)
            worst = largest[:, vertices].max(axis=1)
        return largest[:, vertices].reshape(*values.shape[:-1], *vertices.shape)


def _one_on_axis(largest: np.ndarray, near: np.ndarray) -> np.ndarray:
    """The ``largest`` changes, one for both of each two components that are one ``near`` the axis.

    There both have the same error, but the change of one may cross zero. rr and tt are one where the harmonic
    is 0; rz and tz, u_r and u_theta where it is 1.

    largest : (meshes, rows) + points, rows of the stress, then of the displacement if it is there
    """
    shared = largest.copy()
    for pair in ([0, 1], [3, 5], [6, 7])[: largest.shape[1] // 3]:
        shared[:, pair] = np.where(near, largest[:, pair].max(axis=1, keepdims=True), largest[:, pair])
    return shared


def linear_between(corners: np.ndarray, at: LocatedPoints) -> np.ndarray:
    """Values (c, n) at points from those at the ``corners`` (c, 3, triangles), linear in each triangle."""
    cells, X = at.triangles_as_given()
    X = np.clip(X, 0, 1)
    shape = np.stack([np.clip(1 - X[0] - X[1], 0, 1), X[0], X[1]])
    return np.asarray(np.einsum("sct,ct->st", corners[:, :, cells], shape))


def samples(vertices: np.ndarray) -> np.ndarray:
    """Points in each of the cells between increasing ``vertices``, next to both ends included."""
    return (vertices[:-1, None] + np.diff(vertices)[:, None] * _CELL).ravel()


def largest_around(values: np.ndarray) -> np.ndarray:
    """The largest value in the ``RINGS`` cells on either side of each vertex.

    values : (..., n) at ``samples``.  Returns shape (..., vertices).
    """
    worst = values.reshape(*values.shape[:-1], -1, _CELL.size).max(axis=-1)
    ends = [(0, 0)] * (worst.ndim - 1) + [(0, 1)]
    # cell k lies behind vertex k, so the window of a vertex begins RINGS cells before it
    return np.asarray(
        maximum_filter1d(np.pad(worst, ends), 2 * chosen.RINGS, axis=-1, mode="constant", origin=0)
    )
