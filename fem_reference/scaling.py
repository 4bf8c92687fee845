"""The problem in scaled units: one length, one pressure, the modulus of the substrate.

Far from a concentrated force on the surface the substrate alone counts. Its displacement there is that of
Boussinesq (1885) and Cerruti (1882); K. L. Johnson, Contact Mechanics, 1985, (3.19) and (3.75).
"""

from dataclasses import dataclass

import numpy as np

Coatings = tuple[tuple[float, float, float], ...]


@dataclass(frozen=True)
class Scales:
    """SI values of the units in which a problem is solved."""

    length: float
    pressure: float
    modulus: float

    @property
    def displacement(self) -> float:
        """u/L ~ p/E."""
        return self.length * self.pressure / self.modulus

    @property
    def load(self) -> float:
        return self.pressure * self.length**2


@dataclass(frozen=True)
class LayeredSolid:
    """(E, nu) per layer over a common modulus, thickness per coating, extent of the mesh in r and z."""

    materials: tuple[tuple[float, float], ...]
    thicknesses: tuple[float, ...]
    far: float

    @classmethod
    def scaled(
        cls, coatings: Coatings, substrate: tuple[float, float], length: float, far: float, modulus: float
    ) -> "LayeredSolid":
        """The solid in units of ``length`` and ``modulus``, meshed to ``far`` times its own size.

        A stiff coating distributes the load over a length that grows with its modulus, so it contributes
        h sqrt(E_k/E) to that size.
        """
        E, nu = substrate
        thicknesses = tuple(h / length for _, _, h in coatings)
        extent = sum(
            h * max(1.0, E_k / E) ** 0.5 for h, (E_k, _, _) in zip(thicknesses, coatings, strict=True)
        )
        moduli = [E_k / modulus for E_k, _, _ in coatings]
        poisson = [nu_k for _, nu_k, _ in coatings]
        materials = (*zip(moduli, poisson, strict=True), (E / modulus, nu))
        return cls(materials, thicknesses, far * (1 + extent))

    def far_fields(self, harmonic: int, load: float | np.ndarray, at: np.ndarray) -> np.ndarray:
        """Fields (see ``axisymmetric``) at points (2, n) far from a ``load``: those of the substrate alone.

        load : number or (columns,), normal for harmonic 0, tangential for 1.  Returns (fields, n, columns).
        """
        r, z = at
        if harmonic == 0:
            return np.multiply.outer(boussinesq(r, z, *self.materials[-1]), load)
        U, V, Z = np.multiply.outer(cerruti(r, z, *self.materials[-1]), load)
        return np.stack([U + V, V, Z])


def first_radius(solids: tuple[LayeredSolid, ...], load: float) -> float:
    """Contact radius if the layers above z gave the share (2/pi) atan(z/a) of the compliance of a body.

    Initial guess; ``load`` in units with sphere radius 1.
    """
    a = 1.0
    for _ in range(30):
        compliance = 0.0
        for solid in solids:
            depths = np.cumsum([0.0, *solid.thicknesses])
            share = np.diff(2 / np.pi * np.arctan(depths / a), append=1.0)
            compliance += sum(s * (1 - nu**2) / E for s, (E, nu) in zip(share, solid.materials, strict=True))
        a = (0.75 * load * compliance) ** (1 / 3)
    return float(a)


def boussinesq(r: np.ndarray, z: np.ndarray, E: float, nu: float) -> np.ndarray:
    """(u_r, u_z) of a unit force in +z at the origin, shape (2,) + points. Johnson (3.19).

    u_r = (1+nu)/(2 pi E) [r z/rho^3 - (1-2 nu) r/(rho (rho+z))]
    u_z = (1+nu)/(2 pi E) [z^2/rho^3 + 2 (1-nu)/rho]
    """
    rho = np.hypot(r, z)
    u_r = r * z / rho**3 - (1 - 2 * nu) * r / (rho * (rho + z))
    u_z = z**2 / rho**3 + 2 * (1 - nu) / rho
    return (1 + nu) / (2 * np.pi * E) * np.stack([u_r, u_z])


def cerruti(r: np.ndarray, z: np.ndarray, E: float, nu: float) -> np.ndarray:
    """Amplitudes (u_r, u_theta, u_z) of a unit force in +x at the origin. Johnson (3.75).

    u_r = U cos, u_theta = V sin, u_z = Z cos, with c = (1+nu)/(2 pi E):
    U = c [1/rho + r^2/rho^3 + (1-2 nu) (1/(rho+z) - r^2/(rho (rho+z)^2))]
    V = -c [1/rho + (1-2 nu)/(rho+z)]
    Z = c [r z/rho^3 + (1-2 nu) r/(rho (rho+z))]
    """
    rho = np.hypot(r, z)
    s = rho + z
    U = 1 / rho + r**2 / rho**3 + (1 - 2 * nu) * (1 / s - r**2 / (rho * s**2))
    V = -(1 / rho + (1 - 2 * nu) / s)
    Z = r * z / rho**3 + (1 - 2 * nu) * r / (rho * s)
    return (1 + nu) / (2 * np.pi * E) * np.stack([U, V, Z])
