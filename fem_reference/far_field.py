"""Displacement of a half-space far from a concentrated force on its surface.

Boussinesq (1885) for a normal force, Cerruti (1882) for a tangential one; K. L. Johnson, Contact Mechanics,
Cambridge University Press, 1985, (3.19) and (3.75).
"""

import numpy as np

__all__ = ["boussinesq", "cerruti"]


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
