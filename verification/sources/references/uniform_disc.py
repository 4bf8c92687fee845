"""Layered half-space under a uniform pressure on a disc, frictionless, by Hankel quadrature.

    phat(k) = int_0^a q J0(kr) r dr = q a J1(ka)/k

Stress and displacement as in ``hankel``; the surface of the homogeneous solid in closed form, Johnson,
Contact Mechanics (1985), (3.29).
"""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import ellipe, ellipkm1, j1

from verification.problem.array_types import Array, Coatings
from verification.problem.coated_contact import PrescribedLoad, ScalarUncertainty
from verification.problem.point_answers import ByFunctions, Points, by_functions
from verification.sources.references.hankel_field import HankelField


@dataclass(frozen=True)
class UniformDisc:
    """Pressure ``q`` [Pa] on r <= ``a`` [m]."""

    a: float
    q: float

    def pressure(self, r: ArrayLike) -> Array:
        """q inside, 0 outside [Pa]; half of it on the rim itself, as every Fourier sum has it there."""
        r = np.asarray(r, dtype=float)
        return self.q * np.where(r == self.a, 0.5, 1.0 * (r < self.a))

    def resultant(self, r: ArrayLike) -> Array:
        """int_0^r p(s) s ds [N/rad]; shape of ``r``."""
        return 0.5 * self.q * np.minimum(np.asarray(r, dtype=float), self.a) ** 2

    def transform(self, k: Array) -> Array:
        """phat(k) [N]."""
        return self.q * self.a * j1(k * self.a) / k

    def sink(self, r: Array) -> Array:
        """E* u_z [N/m] on the surface of the homogeneous solid. Johnson (3.29a, c)."""
        s = r / self.a
        inner = ellipe(np.minimum(s, 1.0) ** 2)
        t = 1 / np.maximum(s, 1.0) ** 2
        # (1 - t) K(t) vanishes at the rim, where K alone does not stay finite.
        outer = (ellipe(t) - np.where(t < 1, (1 - t) * ellipkm1(np.where(t < 1, 1 - t, 1.0)), 0.0)) * s
        return 4 * self.q * self.a / np.pi * np.where(s <= 1, inner, outer)


@dataclass(frozen=True, eq=False)
class DiscSolution(ByFunctions):
    """Stresses and displacements; the difference from ``coarser`` gives the uncertainty."""

    problem: PrescribedLoad
    disc: UniformDisc
    field: HankelField
    coarser: HankelField

    @property
    def contact_radius(self) -> float:
        """Radius of the disc [m]."""
        return self.disc.a

    @property
    def peak_pressure(self) -> float:
        """q [Pa]."""
        return self.disc.q

    @property
    def approach(self) -> float:
        """u_z at the origin [m]."""
        return float(self.field.displacement(0.0, 0.0, 0.0)[2])

    @property
    def uncertainty(self) -> ScalarUncertainty:
        """For u_z at the origin, twice the change when every quadrature is coarser by a quarter."""
        U = float(self.sample(Points(0.0), "displacement").uncertainty[2])
        return ScalarUncertainty(approach=U, budget=(("approach", "quadrature", U),))

    @property
    def diagnostics(self) -> dict[str, float]:
        """Gauss points a panel of wavenumbers, and the exponent at which the integrands are cut."""
        return {"nodes": self.field.nodes, "tail": self.field.tail}

    def pressure(self, x: ArrayLike, y: ArrayLike = 0.0) -> Array:
        """p [Pa], NaN on the rim, where it jumps."""
        return self._regular(self.disc.pressure(np.hypot(x, y)), x, y, 0.0)

    def stress(self, x: ArrayLike, y: ArrayLike, z: ArrayLike, layer: int | None = None) -> Array:
        """sigma[i, j, ...] [Pa]; ``layer`` picks the side of an interface, the upper one unless given.

        NaN on the rim, where it depends on the direction of approach.
        """
        return self._regular(self.field.stress(x, y, z, layer), x, y, z)

    def _regular(self, value: Array, x: ArrayLike, y: ArrayLike, z: ArrayLike) -> Array:
        return np.where(self.problem.is_singular(x, y, z), np.nan, value)

    def displacement(self, x: ArrayLike, y: ArrayLike, z: ArrayLike) -> Array:
        """u[i, ...] [m] towards infinity."""
        return self.field.displacement(x, y, z)

    def error(self, points: Points | None, quantity: str, value: Any) -> Any:
        """Uncertainty of ``value``: twice the change by the coarser quadrature, with the rounding."""
        if points is None:
            return getattr(self.uncertainty, quantity)
        if quantity == "pressure":  # is given
            return 0 * value
        rounding = 1e-12 * (self.disc.q if quantity == "stress" else np.abs(value).max(initial=0.0))
        return 2 * np.abs(value - by_functions(self.coarser, points, quantity)) + rounding


def solve_prescribed(
    *,
    pressure: float,
    load_radius: float,
    coatings: Coatings,
    substrate: tuple[float, float],
    friction: float = 0.0,
    nodes: int = 16,
    tail: float = 36.0,
) -> DiscSolution:
    """A layered half-space under ``pressure`` [Pa] on a disc of ``load_radius`` [m], as in PrescribedLoad.

    Raises ValueError where there is friction.
    """
    if friction:
        raise ValueError(f"friction = {friction:g}; a sliding disc has infinite stress at its rim")
    problem = PrescribedLoad(pressure, load_radius, coatings, substrate)
    disc = UniformDisc(load_radius, pressure)
    fine = HankelField(disc, coatings, substrate, 0.0, nodes, tail)
    return DiscSolution(problem, disc, fine, replace(fine, nodes=3 * nodes // 4, tail=0.75 * tail))
