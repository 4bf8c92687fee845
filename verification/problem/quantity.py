"""Quantities: symbol, kind and unit of every number that a source can give."""

import numpy as np

from verification.problem.arrays import Array
from verification.problem.loading import CURVES

__all__ = ["COMPONENTS", "EXTREMES", "POINTWISE", "QUANTITIES", "SCALAR", "von_mises"]

COMPONENTS = {"sigma_xx": (0, 0), "sigma_yy": (1, 1), "sigma_zz": (2, 2), "sigma_xz": (0, 2)}


def von_mises(sigma: Array) -> Array:
    """Von Mises stress in the plane y = 0 from its four stresses xx, yy, zz, xz (4, ...), [Pa].

    sigma_vM^2 = ((xx - yy)^2 + (yy - zz)^2 + (zz - xx)^2) / 2 + 3 xz^2
    """
    xx, yy, zz, xz = sigma
    return np.sqrt(0.5 * ((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) + 3 * xz**2)


SCALAR = ("peak_pressure", "contact_radius", "approach")


_COMPONENT = {f"{'xyz'[i]}{'xyz'[j]}": (i, j) for i, j in ((0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1))}


# On the axis, where both principal shears are equal.
EXTREMES = ("tau_max", "von_mises_max")


POINTWISE = ("stress", "strain")  # kinds made of the stress at each point; the pressure aside


# Every quantity by the kind of number it is.
QUANTITIES = (
    {name: "curve" for name in CURVES}
    | {name: "scalar" for name in SCALAR + EXTREMES}
    | {"pressure": "pressure", "sigma_kk": "stress", "sigma_zz - sigma_xx": "stress"}
    | {f"sigma_{c}": "stress" for c in _COMPONENT}
    | {f"eps_{c}": "strain" for c in ("xx", "yy", "zz")}
    | {f"u_{c}": "displacement" for c in "xyz"}
)
