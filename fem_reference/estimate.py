"""Pointwise uncertainty from the difference between a solution and a coarser companion.

The difference of two solutions crosses zero at points where neither is exact, so it is not taken point by
point: the bound at a vertex is the largest difference found in the triangles around it, and between vertices
it is linear. The companion is coarser, hence the difference is about the error of the companion, which
exceeds the error sought; a factor of safety covers the places where it does not, times a ``caution`` that
the solver raises on meshes too coarse for errors to have begun to fall as they should.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from .recovery import HarmonicField

__all__ = ["SAFETY", "PressureBound", "StressBound", "line_bound"]

# Roache's factor for an error estimated from two meshes only. He divides the difference by ratio^order - 1
# as well, which is left out: the order seen at a point is not dependable.
SAFETY = 3.0

# corners, middles and centre of the reference triangle: the hoop strain is worst on the axis itself
_SAMPLES = np.array([[0, 1, 0, 1 / 2, 1 / 2, 0, 1 / 3], [0, 0, 1, 0, 1 / 2, 1 / 2, 1 / 3]])
# moved this far towards the centre in depth, so that none lies on a plane with a formula of its own
_INWARDS = 1e-7


def line_bound(
    difference: Callable[[np.ndarray], np.ndarray], vertices: np.ndarray, samples: int = 7, reach: int = 1
) -> tuple[np.ndarray, np.ndarray]:
    """SAFETY times the largest |difference| within ``reach`` cells of each of the increasing ``vertices``.

    difference : (n,) positions -> (..., n).  Returns (vertices, bound of shape (..., vertices)).
    """
    t = np.linspace(0, 1, samples)
    points = vertices[:-1, None] + np.diff(vertices)[:, None] * t
    values = np.abs(difference(points.ravel()))
    worst = SAFETY * values.reshape(*values.shape[:-1], *points.shape).max(axis=-1)
    padded = np.concatenate([worst[..., :1]] * reach + [worst] + [worst[..., -1:]] * reach, axis=-1)
    bound = np.max([padded[..., k : k + vertices.size] for k in range(2 * reach)], axis=0)
    return vertices, bound


@dataclass(frozen=True, eq=False)
class PressureBound:
    """Bound of |p - companion's p| as a function of the radius.

    radius_error : uncertainty of the contact radius; a shift of the edge by it is added, which covers the
    ring
        between the two contact edges and the infinite slope of p beside it
    everywhere : added inside the contact, for errors that are no matter of element size
    caution : times the bound, above 1 on meshes too coarse
    """

    pressure: Callable[[np.ndarray], np.ndarray]
    companion: Callable[[np.ndarray], np.ndarray]
    vertices: np.ndarray
    radius_error: float
    everywhere: float = 0.0
    caution: float = 1.0

    @cached_property
    def _around(self) -> tuple[np.ndarray, np.ndarray]:
        # the first cells are few and smooth: two solutions may agree by chance in one of them
        return line_bound(lambda r: self.pressure(r) - self.companion(r), self.vertices, reach=2)

    def __call__(self, r: np.ndarray) -> np.ndarray:
        vertices, bound = self._around
        p = self.pressure(r)
        shifted = [self.pressure(np.abs(r + shift)) - p for shift in (-self.radius_error, self.radius_error)]
        inside = np.where(r <= vertices[-1], self.everywhere, 0.0)
        between = self.caution * np.interp(r, vertices, bound, right=0.0)
        return between + np.max(np.abs(shifted), axis=0) + inside


@dataclass(frozen=True, eq=False)
class StressBound:
    """Bound of |stress - companion's stress| as a function of position, for one harmonic.

    everywhere : added at every point, for errors that are no matter of element size
    caution : times the bound, above 1 on meshes too coarse
    """

    field: HarmonicField
    companion: HarmonicField
    everywhere: float = 0.0
    caution: float = 1.0

    def _difference(self, r: np.ndarray, z: np.ndarray, layer: np.ndarray) -> np.ndarray:
        return np.abs(self.field(r, z, layer)[1] - self.companion(r, z, layer)[1])

    @cached_property
    def _corners(self) -> np.ndarray:
        """Bound at the corners of each triangle, (6, 3, triangles); a vertex has one value per layer."""
        d = self.field.discretisation
        t = d.triangulation.t
        s1, s2 = _SAMPLES
        shape = np.stack([1 - s1 - s2, s1, s2])
        corners = d.mesh.points[:, t]
        r, z = np.einsum("cp,dct->dpt", shape, corners)
        z = z + _INWARDS * (corners[1].mean(axis=0) - z)
        layer = np.broadcast_to(d.mesh.layer, r.shape)
        reach = self.companion.discretisation.mesh.points.max()
        inside = np.minimum(r, reach).ravel(), np.minimum(z, reach).ravel()
        worst = SAFETY * self._difference(*inside, layer.ravel()).reshape(6, *r.shape).max(axis=1)
        vertices = t + d.mesh.layer * d.mesh.points.shape[1]
        bound = np.zeros((6, int(vertices.max()) + 1))
        for corner in vertices:
            for component in range(6):
                np.maximum.at(bound[component], corner, worst[component])
        return bound[:, vertices]

    @cached_property
    def _planes(self) -> dict[tuple[float, int], tuple[np.ndarray, np.ndarray]]:
        """Bounds along the surface and along both sides of each interface, keyed by (depth, layer)."""
        mesh = self.field.discretisation.mesh
        reach = 0.9 * self.companion.discretisation.mesh.far
        sides = [(0.0, 0)]
        for upper, depth in enumerate(mesh.depths):
            sides += [(float(depth), upper), (float(depth), upper + 1)]
        planes = {}
        for depth, layer in sides:

            def difference(r: np.ndarray, depth: float = depth, layer: int = layer) -> np.ndarray:
                return self._difference(r, np.full(r.shape, depth), np.full(r.shape, layer))

            vertices = np.sort(mesh.points[0, mesh.points[1] == depth])
            planes[depth, layer] = line_bound(difference, vertices[vertices < reach])
        return planes

    def __call__(self, r: np.ndarray, z: np.ndarray, layer: np.ndarray) -> np.ndarray:
        """Bound (6, n) at points of shape (n,)."""
        z = self.field.snapped(z)
        cells, X = self.field.locate(r, z, layer)
        X = np.clip(X, 0, 1)
        shape = np.stack([np.clip(1 - X[0] - X[1], 0, 1), X[0], X[1]])
        bound = np.einsum("sct,ct->st", self._corners[:, :, cells], shape)
        for (depth, side), (vertices, values) in self._planes.items():
            here = (z == depth) & (layer == side)
            bound[:, here] = [np.interp(r[here], vertices, row) for row in values]
        return self.caution * bound + self.everywhere
