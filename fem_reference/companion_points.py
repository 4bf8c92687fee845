"""Points at which a solution is compared with its coarser companion, and the largest values around them.

By hand: scikit-fem compares no fields on two unrelated meshes.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from fem_reference.elasticity.axisymmetric import Discretisation
from fem_reference.meshing.location import LocatedPoints, Uncached

# Shares of the largest difference in rings of triangles, or cells of a line, by their distance from a point.
REACH = (1.0, 1.0, 0.5)
# corners, middles and centre of the reference triangle: the hoop strain is worst on the axis itself
_SAMPLES = np.array([[0, 1, 0, 1 / 2, 1 / 2, 0, 1 / 3], [0, 0, 1, 0, 1 / 2, 1 / 2, 1 / 3]])
# Moved this far towards the centre, those of triangles in depth: none lies on a plane with a formula of its
# own, nor at a vertex of a plane, where two cells have two stresses.
_INWARDS = 1e-7
_CELL_SAMPLES = 7

Pair = tuple[LocatedPoints, LocatedPoints]  # on the final mesh, on that of the companion


@dataclass(frozen=True, eq=False)
class ComparisonPoints(Uncached):
    """Points at which two solutions are compared, located on the meshes of both."""

    final: Discretisation
    companion: Discretisation

    def _on_both(self, r: np.ndarray, z: np.ndarray, layer: np.ndarray) -> Pair:
        # at the same r/a: next to the edge a displaced one would hide what the triangles miss
        stretch = self.companion.mesh.contact_radius / self.final.mesh.contact_radius
        return self.final.locator.points(r, z, layer), self.companion.locator.points(stretch * r, z, layer)

    @cached_property
    def triangles(self) -> Pair:
        """``_SAMPLES`` of every triangle of the final mesh, shape (7 * triangles,)."""
        d = self.final
        s1, s2 = _SAMPLES
        shape = np.stack([1 - s1 - s2, s1, s2])
        corners = d.mesh.points[:, d.triangulation.t]
        r, z = np.einsum("cp,dct->dpt", shape, corners)
        z = z + _INWARDS * (corners[1].mean(axis=0) - z)
        layer = np.broadcast_to(d.mesh.layer, r.shape)
        reach = self.companion.mesh.points.max()
        return self._on_both(np.minimum(r, reach).ravel(), np.minimum(z, reach).ravel(), layer.ravel())

    @cached_property
    def planes(self) -> dict[tuple[float, int], tuple[np.ndarray, Pair]]:
        """Vertices and points between them on the surface and both sides of interfaces, by (depth, layer)."""
        mesh = self.final.mesh
        reach = 0.9 * self.companion.mesh.far
        interfaces = [(float(depth), layer) for k, depth in enumerate(mesh.depths) for layer in (k, k + 1)]
        planes = {}
        for depth, layer in [(0.0, 0), *interfaces]:
            vertices = np.sort(mesh.points[0, mesh.points[1] == depth])
            vertices = vertices[vertices < reach]
            r = samples(vertices)
            points = self._on_both(r, np.full(r.shape, depth), np.full(r.shape, layer))
            planes[depth, layer] = vertices, points
        return planes


def samples(vertices: np.ndarray) -> np.ndarray:
    """Points in each of the cells between increasing ``vertices``, next to both ends included."""
    t = np.linspace(_INWARDS, 1 - _INWARDS, _CELL_SAMPLES)
    return (vertices[:-1, None] + np.diff(vertices)[:, None] * t).ravel()


def largest_around(values: np.ndarray) -> np.ndarray:
    """The largest value in the cells around each vertex, by the shares of ``REACH``.

    values : (..., n) at ``samples``.  Returns shape (..., vertices).
    """
    worst = values.reshape(*values.shape[:-1], -1, _CELL_SAMPLES).max(axis=-1)
    shares = np.array([*REACH[::-1], *REACH])  # of the cells before and behind a vertex
    beyond = (*((0, 0),) * (worst.ndim - 1), (len(REACH), len(REACH)))
    around = sliding_window_view(np.pad(worst, beyond), len(shares), axis=-1)
    return np.asarray((shares * around).max(axis=-1))
