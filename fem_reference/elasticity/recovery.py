"""Fields of one Fourier harmonic at any point of the meridian plane.

By hand: on planes and at the contact edge, derivatives of the shape functions alone lose digits.

Strains are the derivatives of the shape functions in the triangle that holds the point, so each side of an
interface keeps its own value. On a plane z = const whose tractions are known more accurately than by
differentiation, the other components follow from the in-plane strains, derivatives along the plane only:

    sigma_rr = E/(1-nu^2) (eps_rr + nu eps_tt) + nu/(1-nu) sigma_zz,     sigma_tt with rr and tt swapped.

On the surface the tractions are the applied ones, sigma_zz = -p. On an interface they are a mean
of both sides, dominated by the more compliant one, where an error of strain changes the stress less.

At the edge r = a of a contact p ~ sqrt(a - r), and the in-plane surface strains on either side are series in
half-integer powers of d = |r - a| with one common value at d = 0 (K. L. Johnson, Contact Mechanics, 1985,
sections 3.4 and 7.1, for one material). Polynomials of the last triangles miss that by the square root of
their size, so there the series is used, fitted where triangles are small beside d.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fem_reference import element_numbers as chosen
from fem_reference.elasticity.axisymmetric import Discretisation, elasticity, strain_operator
from fem_reference.meshing.location import LocatedPoints
from fem_reference.meshing.mesh import MeridianMesh

_POWERS = np.array(chosen.EDGE_POWERS)
TRACTIONS = [2, 3, 5]  # rows of the stress on a plane z = const


def edge_distances(mesh: MeridianMesh, farther: float = 1.0) -> np.ndarray:
    """Distances from the edge over ``EDGE_SIZE`` times the radius, at which its series is fitted.

    Those of ``EDGE_SERIES``, times ``farther``; far below the thickness of a film on the surface.
    """
    smallest, largest = chosen.EDGE_SERIES
    thickness = (mesh.length / mesh.contact_radius) ** 2  # of the thinnest film on top, over a
    end = max(min(farther * largest, 0.05 * thickness / chosen.EDGE_SIZE), 5 * smallest)
    return np.geomspace(max(smallest, end * smallest / largest), end, 32)


@dataclass(frozen=True, eq=False)
class HarmonicField:
    """Displacement of one Fourier ``harmonic`` on a discretisation.

    fields    : stacked field vector, see ``axisymmetric``
    materials : (E, nu) per layer
    pressure, factor : factor * pressure(r) is sigma_zz on the surface for harmonic 0, sigma_rz for harmonic 1
    root_at_edge : whether the pressure vanishes like sqrt(a - r) at the contact edge
    """

    discretisation: Discretisation
    fields: np.ndarray
    materials: tuple[tuple[float, float], ...]
    harmonic: int
    pressure: Callable[[np.ndarray], np.ndarray]
    factor: float
    root_at_edge: bool

    def __post_init__(self) -> None:
        """Raises ValueError where the displacement is not finite, wherever its values are asked for."""
        lost = int(self.fields.size - np.isfinite(self.fields).sum())
        if lost:
            raise ValueError(
                f"the displacement is not finite at {lost} of {self.fields.size} unknowns; check the moduli"
            )

    def __call__(self, at: LocatedPoints) -> tuple[np.ndarray, np.ndarray]:
        """Displacement (3, n) as (u_r, u_theta, u_z) and stress (6, n) as (rr, tt, zz, rz, rt, tz).

        Amplitudes of cos(m theta), of u_theta, rt and tz of sin(m theta).
        """
        u, strain = self.amplitudes(at)
        tractions, surface = np.zeros((3, at.r.size)), at.z == 0
        if np.any(surface):
            strain[:, surface] = self._with_series(at.r[surface], strain[:, surface])
            tractions[:, surface] = self._surface_tractions(at.r[surface])
        return u, stress_of(strain, tractions, at, self.materials, lambda side: self.amplitudes(side)[1])

    def amplitudes(self, at: LocatedPoints) -> tuple[np.ndarray, np.ndarray]:
        """Displacement (3, n) as above and strain (6, n), that of the elements alone."""
        values, found = self._fields_and_strains(at)
        u, strain = np.zeros((3, at.r.size)), np.zeros((6, at.r.size))
        strain[: len(found)] = found
        if self.harmonic == 0:
            u[0], u[2] = values
        else:
            u[:] = values[0] - values[1], values[1], values[2]
        # Nearer to the axis than ``at.r``: what is odd in r vanishes in proportion.
        if self.harmonic < 2:
            odd, odd_strains = (([0], [3]), ([2], [0, 1, 2, 4]))[self.harmonic]
            u[odd] *= at.r_given / at.r
            strain[odd_strains] *= at.r_given / at.r
        return u, strain

    def _fields_and_strains(self, at: LocatedPoints) -> tuple[np.ndarray, np.ndarray]:
        """Fields (fields, n) and strains (strains, n)."""
        u = self.fields.reshape(-1, self.discretisation.N)[:, at.unknowns]
        values, d_r, d_z = np.einsum("fin,kin->kfn", u, at.shapes)
        A_r, A_z, A_0 = strain_operator(self.harmonic)
        return values, A_r @ d_r + A_z @ d_z + A_0 @ (values / at.r)

    @cached_property
    def _series(self) -> np.ndarray:
        """Coefficients (1 + 2 powers, strains) of the surface strains: edge value, powers inside, outside."""
        d = self.discretisation
        a = d.mesh.contact_radius
        distance = edge_distances(d.mesh) / chosen.EDGE_SERIES[0]
        r = a + a * chosen.EDGE_SIZE * chosen.EDGE_SERIES[0] * np.concatenate([-distance, distance])
        zero = np.zeros(r.size, dtype=int)
        _, strain = self._fields_and_strains(d.locator.points(r, 0.0 * r, zero))
        powers = distance[:, None] ** _POWERS
        none = np.zeros_like(powers)
        terms = np.hstack([np.ones((r.size, 1)), np.block([[powers, none], [none, powers]])])
        return np.linalg.lstsq(terms, strain.T, rcond=None)[0]

    def _with_series(self, r: np.ndarray, strain: np.ndarray) -> np.ndarray:
        """Surface strains (strains, n), the derivatives among them from the series next to the edge."""
        a = self.discretisation.mesh.contact_radius
        offset = (r / a - 1) / (chosen.EDGE_SIZE * chosen.EDGE_SERIES[0])
        near = np.abs(offset) < 1
        if not (self.root_at_edge and np.any(near)):
            return strain
        regular = _POWERS > 0
        inside, outside = np.maximum(-offset[near], 0.0), np.maximum(offset[near], 0.0)
        terms = [side[:, None] ** _POWERS[regular] for side in (inside, outside)]
        kept = np.concatenate([[True], regular, regular])
        value = np.hstack([np.ones((inside.size, 1)), *terms]) @ self._series[kept]
        strain = strain.copy()
        # u_r / r is continuous and smooth enough as it is
        for row in (0, 4) if self.harmonic else (0,):
            strain[row, near] = value[:, row]
        return strain

    def _surface_tractions(self, r: np.ndarray) -> np.ndarray:
        """(sigma_zz, sigma_rz, sigma_tz) on the surface, shape (3, n)."""
        # q in +x: q_r = q cos, q_theta = -q sin on the solid, whose outward normal is -z
        shares = np.array([0.0, 1.0, -1.0] if self.harmonic else [1.0, 0.0, 0.0])
        return np.multiply.outer(shares, self.factor * self.pressure(r))


def stress_of(
    strain: np.ndarray,
    tractions: np.ndarray,
    at: LocatedPoints,
    materials: tuple[tuple[float, float], ...],
    strain_on: Callable[[LocatedPoints], np.ndarray],
) -> np.ndarray:
    """Stress (6, n) of a strain (6, n), on planes from the strain in the plane and the tractions.

    tractions : (sigma_zz, sigma_rz, sigma_tz) on the surface, (3, n)
    strain_on : strain (6, k) at the points on one side of an interface
    """
    E, nu = np.array(materials).T[:, at.layer]
    surface = at.z == 0
    stress = _hooke(strain, materials, at.layer)
    stress[:, surface] = _on_plane(strain[:, surface], tractions[:, surface], E[surface], nu[surface])
    for upper, on_interface, sides in at.interfaces:
        # Each side counts by the inverse of its error: the error of strain is proportional to stress / E,
        # and the modulus at fixed width converts it to stress.
        mean, total = np.zeros((3, on_interface.size)), 0.0
        for (E_k, nu_k), side in zip(materials[upper : upper + 2], sides, strict=True):
            weight = E_k / (E_k * (1 - nu_k) / ((1 + nu_k) * (1 - 2 * nu_k))) ** 2
            mean += weight * _hooke(strain_on(side), materials, side.layer)[TRACTIONS]
            total += weight
        of_plane = strain[:, on_interface], mean / total, E[on_interface], nu[on_interface]
        stress[:, on_interface] = _on_plane(*of_plane)
    return stress


def _hooke(strain: np.ndarray, materials: tuple[tuple[float, float], ...], layer: np.ndarray) -> np.ndarray:
    """Stress (6, n) of a strain (6, n)."""
    D = np.stack([elasticity(E, nu, 1) for E, nu in materials])[layer]
    return np.asarray(np.einsum("nst,tn->sn", D, strain))


def _on_plane(
    strain: np.ndarray, tractions: np.ndarray, E: np.ndarray | float, nu: np.ndarray | float
) -> np.ndarray:
    """Stress (6, n) on a plane z = const from the in-plane strains and the tractions on it."""
    zz, rz, tz = tractions
    rr = E / (1 - nu**2) * (strain[0] + nu * strain[1]) + nu / (1 - nu) * zz
    tt = E / (1 - nu**2) * (strain[1] + nu * strain[0]) + nu / (1 - nu) * zz
    return np.stack([rr, tt, zz, rz, E / (2 * (1 + nu)) * strain[4], tz])
