"""Fields of one Fourier harmonic at any point of the meridian plane.

Strains are the derivatives of the shape functions in the triangle that holds the point, so each side of an
interface keeps its own value. On a plane z = const whose tractions are known more accurately than by
differentiation, the other components follow from the in-plane strains, derivatives along the plane only:

    sigma_rr = E/(1-nu^2) (eps_rr + nu eps_tt) + nu/(1-nu) sigma_zz,     sigma_tt with rr and tt swapped.

On the surface the tractions are the applied ones, sigma_zz = -p. On an interface they are a mean
of both sides, dominated by the more compliant one, where an error of strain changes the stress less.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from .axisymmetric import Discretisation, elasticity, strain_operator
from .location import LocatedPoints

__all__ = ["HarmonicField"]


@dataclass(frozen=True, eq=False)
class HarmonicField:
    """Displacement of one Fourier ``harmonic`` on a discretisation.

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

    def __call__(self, at: LocatedPoints) -> tuple[np.ndarray, np.ndarray]:
        """Displacement (3, n) as (u_r, u_theta, u_z) and stress (6, n) as (rr, tt, zz, rz, rt, tz).

        Amplitudes of cos(theta) or sin(theta) for harmonic 1.
        """
        values, strain = self._fields_and_strains(at)
        stress = self._hooke(strain, at.layer)
        surface = at.z == 0
        if np.any(surface):
            stress[:, surface] = self._on_plane(0, strain[:, surface], self._surface_tractions(at.r[surface]))
        for upper, on_interface, sides in at.interfaces:
            tractions = self._interface_tractions(upper, sides)
            for layer in (upper, upper + 1):
                mine = at.layer[on_interface] == layer
                numbers = on_interface[mine]
                stress[:, numbers] = self._on_plane(layer, strain[:, numbers], tractions[:, mine])
        displacement = np.zeros((3, at.r.size))
        if self.harmonic == 0:
            displacement[0], displacement[2] = values
        else:
            displacement[:] = values[0] - values[1], values[1], values[2]
        return displacement, stress

    def _fields_and_strains(self, at: LocatedPoints) -> tuple[np.ndarray, np.ndarray]:
        """Fields (fields, n) and strains (strains, n)."""
        d, cells, X = self.discretisation, at.cells, at.X
        corners = d.mesh.points[:, d.triangulation.t[:, cells]]
        J = np.stack([corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]], axis=1)
        det = J[0, 0] * J[1, 1] - J[0, 1] * J[1, 0]
        numbers = np.asarray(d.basis.element_dofs)[:, cells]
        A_r, A_z, A_0 = strain_operator(self.harmonic)
        count = A_r.shape[1]
        values, d_r, d_z = np.zeros((3, count, at.r.size))
        nodal = self.fields.reshape(count, -1)
        for i in range(numbers.shape[0]):
            phi, dphi = d.basis.elem.lbasis(X, i)
            u = nodal[:, numbers[i]]
            values += u * phi
            d_r += u * (dphi[0] * J[1, 1] - dphi[1] * J[1, 0]) / det
            d_z += u * (dphi[1] * J[0, 0] - dphi[0] * J[0, 1]) / det
        return values, A_r @ d_r + A_z @ d_z + A_0 @ (values / at.r)

    def _interface_tractions(self, upper: int, sides: list[LocatedPoints]) -> np.ndarray:
        """(sigma_zz, sigma_rz, sigma_tz) on the interface below layer ``upper``, shape (3, n).

        Each side is weighted by the inverse of its error: the error of strain is proportional to stress / E,
        and the modulus at fixed width converts it to stress.
        """
        mean, total = np.zeros((3, sides[0].r.size)), 0.0
        for layer, at in enumerate(sides, start=upper):
            E, nu = self.materials[layer]
            modulus = E * (1 - nu) / ((1 + nu) * (1 - 2 * nu))
            weight = E / modulus**2
            _, strain = self._fields_and_strains(at)
            mean += weight * self._hooke(strain, at.layer)[[2, 3, 5]]
            total += weight
        return mean / total

    def _hooke(self, strain: np.ndarray, layer: np.ndarray) -> np.ndarray:
        """Stress (6, n) of the strains of ``_fields_and_strains``."""
        D = np.stack([elasticity(E, nu, self.harmonic) for E, nu in self.materials])[layer]
        stress = np.zeros((6, layer.size))
        stress[: strain.shape[0]] = np.einsum("nst,tn->sn", D, strain)
        return stress

    def _surface_tractions(self, r: np.ndarray) -> np.ndarray:
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
