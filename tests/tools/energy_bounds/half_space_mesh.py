"""Layered half-space in units of the contact radius, on a mesh graded towards the contact edge."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from energy_bounds.spline_elements import Points
from verification.problem.array_types import Array, Coatings

# A radial piece spans a ratio of 5^(3/2) at most: Gauss's error for a polynomial over r is below rounding.
RADIAL_POINTS = 48
STEEPEST = 5.0


@dataclass(frozen=True, eq=False)
class HalfSpace:
    """Layers (E over that of the substrate, nu, thickness) on a substrate (1, nu), with a mesh of rectangles.

    r, z : knots; r = 1 is the contact edge, interfaces are among z.
    """

    coatings: Coatings
    nu: float
    r: Array
    z: Array
    degree: int

    def points(self) -> tuple[Points, Points]:
        """Gauss points, exact for polynomials; for those over r, see ``RADIAL_POINTS``."""
        return Points.gauss(self.r, RADIAL_POINTS), Points.gauss(self.z, self.degree + 1)

    def moduli(self, matrix: Callable[[float, float], Array], z: Array) -> Array:
        """``matrix(E, nu)`` of the layer of each depth, shape (4, 4, depths)."""
        layer = np.searchsorted(np.cumsum([h for _, _, h in self.coatings]), z)
        solids = [*((E, nu) for E, nu, _ in self.coatings), (1.0, self.nu)]
        return np.stack([matrix(*solid) for solid in solids], axis=-1)[..., layer]


def stiffness(E: float, nu: float) -> Array:
    """C of sigma = C e; components rr, tt, zz, rz, shear strain 2 e_rz."""
    return np.asarray(np.linalg.inv(compliance(E, nu)), dtype=float)


def compliance(E: float, nu: float) -> Array:
    """S of e = S sigma."""
    S = np.diag([1 + nu, 1 + nu, 1 + nu, 2 * (1 + nu)])
    S[:3, :3] -= nu
    return S / E


def half_space(coatings: Coatings, nu: float, degree: int, edge: float, far: float) -> HalfSpace:
    """Mesh from pieces of ``edge`` at the contact edge up to ``far``, all over the contact radius.

    Raises ValueError for an incompressible layer, a degree below 4, coatings that reach ``far``.
    """
    interfaces = np.cumsum([h for _, _, h in coatings])
    if not all(-1 < value < 0.5 for value in (nu, *(layer[1] for layer in coatings))):
        raise ValueError("bounds by displacements need nu below 1/2 in every layer")
    if degree < 4 or sum(h for _, _, h in coatings) > far / 8:
        raise ValueError(
            f"degree = {degree} must be 4 or more, far = {far:g} eight times all coatings or more"
        )
    distance = np.array([*_steps(0.5, edge)[::-1], 0.5, *_steps(0.5, far)])
    z = distance[[all(abs(np.log(value / interfaces)) > 0.3) for value in distance]]
    r = np.concatenate([[0], 1 - distance[distance < 0.75][::-1], [1], 1 + distance])
    r[-1] = np.hypot(1, far)
    return HalfSpace(coatings, nu, r, np.sort([0, *z, *interfaces]), degree)


def _steps(d: float, end: float) -> list[float]:
    """Distances after ``d`` up or down to ``end``; the farther from d = 1, the less energy, the longer."""
    found: list[float] = []
    while True:
        ratio = min(STEEPEST, 2 * max(1, d / 3, 0.3 / d) ** 0.17)
        left = np.log(end / d)
        if abs(left) < 1.5 * np.log(ratio):
            return [*found, end]
        d *= ratio ** np.sign(left)
        found.append(d)
