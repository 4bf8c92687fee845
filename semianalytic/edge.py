"""Contact radius from the pressure inside the contact.

Near the edge of a smooth contact p ~ sqrt(a - r), so p^2 is smooth in r^2 and vanishes at r = a:
a polynomial fitted to it reaches the edge far better than a count of loaded patches, whose edge is
a staircase.
"""

import numpy as np
from numpy.typing import NDArray

__all__ = ["radius_of"]

Array = NDArray[np.floating]


def radius_of(pressure: Array, r: Array, d: float, *, inner: float = 0.5, skip: float = 2.5) -> float:
    """Radius at which p^2 vanishes.

    Least squares of p^2 on a quadratic in 1 - (r/a0)^2 over inner a0 < r < a0 - skip d, each patch weighted
    by 1/p since an error e of p is one of 2 p e in p^2; a0 from the loaded area. Contacts of too few
    patches fall back to a0.

    pressure [Pa], r [m] : same shape.  d : side of the patches [m].  Returns a [m].
    """
    a0 = float(np.sqrt(np.count_nonzero(pressure) * d * d / np.pi))
    used = (r < a0 - skip * d) & (r > inner * a0) & (pressure > 0)
    if np.count_nonzero(used) < 24:
        return a0
    t, p = 1 - (r[used] / a0) ** 2, pressure[used] / pressure.max()
    columns = np.stack([np.ones_like(t), t, t * t], axis=1) / p[:, None]
    c0, c1, c2 = np.linalg.lstsq(columns, p, rcond=None)[0]
    root = -2 * c0 / (c1 + np.sqrt(max(c1 * c1 - 4 * c0 * c2, 0.0)))  # the one near 0, without cancellation
    if not abs(root) < 0.5:
        return a0
    return a0 * float(np.sqrt(1 - root))
