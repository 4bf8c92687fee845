"""Displacements and stresses of one harmonic anywhere in the meridian plane.

Strains are the derivatives of the shape functions in the triangle that holds the point, so each side of an
interface keeps its own value. On a plane z = const whose tractions are known better than by differentiation,
the in-plane strains, which differentiate only along the plane, give the rest:

    sigma_rr = E/(1-nu^2) (eps_rr + nu eps_tt) + nu/(1-nu) sigma_zz,     sigma_tt with rr and tt swapped.

On the surface the tractions are the applied ones, sigma_zz = -p. On an interface the stiffer side takes them
from the more compliant one, where an error of strain costs less stress.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.spatial import cKDTree

from .axisymmetric import Discretisation, elasticity, strain_operator

__all__ = ["HarmonicField"]

_NEIGHBOURS = 12


@dataclass(frozen=True, eq=False)
class HarmonicField:
    """A displacement of one Fourier ``harmonic`` on a discretisation.

    fields    : stacked field vector, see ``axisymmetric``
    materials : (E, nu) per layer
    pressure, factor : factor * pressure(r) is sigma_zz on the surface for harmonic 0, sigma_rz for harmonic 1
    """

    discretisation: Discretisation
    fields: np.ndarray
    materials: tuple[tuple[float, float], ...]
    harmonic: int
    pressure: Callable[[np.ndarray], np.ndarray]
    factor: float

    @cached_property
    def _trees(self) -> list[tuple[np.ndarray, cKDTree]]:
        mesh = self.discretisation.mesh
        r, z = mesh.points[:, mesh.triangles].mean(axis=1)
        # centroids in the stretched plane, where triangles of one neighbourhood are of one size
        centres = mesh.plane(r, z).T
        members = [np.flatnonzero(mesh.layer == k) for k in range(len(self.materials))]
        return [(m, cKDTree(centres[m])) for m in members]

    def locate(self, r: np.ndarray, z: np.ndarray, layer: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Triangle of each point inside its layer, and the point's reference coordinates (2, n)."""
        mesh, t = self.discretisation.mesh, self.discretisation.triangulation.t
        cells = np.zeros(r.shape, dtype=int)
        for k, (members, tree) in enumerate(self._trees):
            mine = np.flatnonzero(layer == k)
            count = min(_NEIGHBOURS, members.size)
            while mine.size:
                _, near = tree.query(mesh.plane(r[mine], z[mine]).T, k=count)
                candidates = members[near.reshape(mine.size, -1)]
                X = _reference(mesh.points, t[:, candidates], r[mine, None], z[mine, None])
                inside = np.min([X[0], X[1], 1 - X[0] - X[1]], axis=0)
                best = np.argmax(inside, axis=1)
                cells[mine] = candidates[np.arange(mine.size), best]
                done = inside[np.arange(mine.size), best] > -1e-9
                if count == members.size:
                    break
                mine, count = mine[~done], min(4 * count, members.size)
        return cells, _reference(mesh.points, t[:, cells], r, z)

    def _fields_and_strains(
        self, r: np.ndarray, z: np.ndarray, layer: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Fields (fields, n) and strains (strains, n) at points of shape (n,)."""
        d = self.discretisation
        cells, X = self.locate(r, z, layer)
        corners = d.mesh.points[:, d.triangulation.t[:, cells]]
        J = np.stack([corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]], axis=1)
        det = J[0, 0] * J[1, 1] - J[0, 1] * J[1, 0]
        numbers = np.asarray(d.basis.element_dofs)[:, cells]
        A_r, A_z, A_0 = strain_operator(self.harmonic)
        count = A_r.shape[1]
        values, d_r, d_z = np.zeros((3, count, r.size))
        nodal = self.fields.reshape(count, -1)
        for i in range(numbers.shape[0]):
            phi, dphi = d.basis.elem.lbasis(X, i)
            u = nodal[:, numbers[i]]
            values += u * phi
            d_r += u * (dphi[0] * J[1, 1] - dphi[1] * J[1, 0]) / det
            d_z += u * (dphi[1] * J[0, 0] - dphi[0] * J[0, 1]) / det
        return values, A_r @ d_r + A_z @ d_z + A_0 @ (values / r)

    def __call__(self, r: np.ndarray, z: np.ndarray, layer: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Displacement (3, n) as (u_r, u_theta, u_z) and stress (6, n) as (rr, tt, zz, rz, rt, tz).

        Amplitudes of cos(theta) or sin(theta) for harmonic 1. ``r``, ``z``, ``layer`` of shape (n,).
        """
        mesh = self.discretisation.mesh
        # u/r on the axis is the limit from outside; this far in it is exact to rounding
        r = np.maximum(r, 1e-7 * mesh.contact_radius)
        z = self.snapped(z)
        values, strain = self._fields_and_strains(r, z, layer)
        stress = self._hooke(strain, layer)
        surface = z == 0
        if np.any(surface):
            stress[:, surface] = self._on_plane(0, strain[:, surface], self._applied(r[surface]))
        for upper, depth in enumerate(mesh.depths):
            here = z == depth
            if np.any(here):
                tractions = self._bonded(r[here], z[here], upper)
                for side in (upper, upper + 1):
                    mine = layer[here] == side
                    numbers = np.flatnonzero(here)[mine]
                    stress[:, numbers] = self._on_plane(side, strain[:, numbers], tractions[:, mine])
        displacement = np.zeros((3, r.size))
        if self.harmonic == 0:
            displacement[0], displacement[2] = values
        else:
            displacement[:] = values[0] - values[1], values[1], values[2]
        return displacement, stress

    def snapped(self, z: np.ndarray) -> np.ndarray:
        """Depths with those within rounding of an interface put on it."""
        z = z.copy()
        for depth in self.discretisation.mesh.depths:
            z[np.abs(z - depth) <= 1e-12 * depth] = depth
        return z

    def _bonded(self, r: np.ndarray, z: np.ndarray, upper: int) -> np.ndarray:
        """(sigma_zz, sigma_rz, sigma_tz) on the interface below layer ``upper``, shape (3, n).

        Each side weighs in by the inverse of its error: strain goes wrong in proportion to stress / E, and
        the modulus at fixed width turns that into stress.
        """
        mean, total = np.zeros((3, r.size)), 0.0
        for side in (upper, upper + 1):
            E, nu = self.materials[side]
            modulus = E * (1 - nu) / ((1 + nu) * (1 - 2 * nu))
            weight = E / modulus**2
            layer = np.full(r.size, side)
            _, strain = self._fields_and_strains(r, z, layer)
            mean += weight * self._hooke(strain, layer)[[2, 3, 5]]
            total += weight
        return mean / total

    def _hooke(self, strain: np.ndarray, layer: np.ndarray) -> np.ndarray:
        """Stress (6, n) of the strains of ``_fields_and_strains``."""
        D = np.stack([elasticity(E, nu, self.harmonic) for E, nu in self.materials])[layer]
        stress = np.zeros((6, layer.size))
        stress[: strain.shape[0]] = np.einsum("nst,tn->sn", D, strain)
        return stress

    def _applied(self, r: np.ndarray) -> np.ndarray:
        """(sigma_zz, sigma_rz, sigma_tz) on the surface, shape (3, n)."""
        traction, zero = self.factor * self.pressure(r), np.zeros(r.size)
        if self.harmonic == 0:
            return np.stack([traction, zero, zero])
        # q in +x: q_r = q cos, q_theta = -q sin on the solid, whose outward normal is -z
        return np.stack([zero, traction, -traction])

    def _on_plane(self, layer: int, strain: np.ndarray, tractions: np.ndarray) -> np.ndarray:
        """Stress (6, n) on a plane z = const from the in-plane strains and the tractions on it."""
        E, nu = self.materials[layer]
        zz, rz, tz = tractions
        rr = E / (1 - nu**2) * (strain[0] + nu * strain[1]) + nu / (1 - nu) * zz
        tt = E / (1 - nu**2) * (strain[1] + nu * strain[0]) + nu / (1 - nu) * zz
        rt = E / (2 * (1 + nu)) * strain[4] if self.harmonic == 1 else np.zeros(rr.shape)
        return np.stack([rr, tt, zz, rz, rt, tz])


def _reference(points: np.ndarray, triangles: np.ndarray, r: np.ndarray, z: np.ndarray) -> np.ndarray:
    """Reference coordinates (2, ...) of the points in the triangles (3, ...)."""
    (r0, z0), (r1, z1), (r2, z2) = (points[:, corner] for corner in triangles)
    det = (r1 - r0) * (z2 - z0) - (r2 - r0) * (z1 - z0)
    s = ((r - r0) * (z2 - z0) - (r2 - r0) * (z - z0)) / det
    t = ((r1 - r0) * (z - z0) - (r - r0) * (z1 - z0)) / det
    return np.stack([s, t])
