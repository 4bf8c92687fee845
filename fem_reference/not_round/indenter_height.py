"""Heights of the indenters that are no spheres, and their symmetry."""

from collections.abc import Callable
from typing import Any

import numpy as np

from fem_reference.validation import check_positive

Height = Callable[[Any, Any], Any]
Indenter = tuple[str, tuple[float, ...]]


def indenter_height(indenter: Indenter, radius: float) -> tuple[Height, int]:
    """Height (x, y) [m] above its lowest points, and n of the symmetry by turns of 2 pi/n about z.

    ("ellipsoid", (R_x, R_y)) : x^2/2 R_x + y^2/2 R_y
    ("asperities", (distance,)) : two spheres of ``radius``, lowest at x = -distance/2, distance/2
    ("lobes", (n, amplitude, at)) : r^2/2 radius + amplitude (r/at)^n cos(n theta)
    All are even in y. Raises ValueError for another shape, for numbers that do not fit.
    """
    shape, numbers = indenter
    if shape == "ellipsoid" and len(numbers) == 2:
        R_x, R_y = numbers
        check_positive(R_x=R_x, R_y=R_y)
        return lambda x, y: x**2 / (2 * R_x) + y**2 / (2 * R_y), 2
    if shape == "asperities" and len(numbers) == 1:
        check_positive(distance=numbers[0])
        half = numbers[0] / 2
        return lambda x, y: ((np.abs(x) - half) ** 2 + y**2) / (2 * radius), 2
    if shape == "lobes" and len(numbers) == 3:
        n, amplitude, at = numbers
        check_positive(lobes=n, at=at)
        return (
            lambda x, y: (x**2 + y**2) / (2 * radius) + amplitude * (((x + 1j * y) / at) ** int(n)).real,
            int(n),
        )
    raise ValueError(
        f"indenter = {indenter!r}; give ('ellipsoid', (R_x, R_y)), ('asperities', (distance,)) or "
        "('lobes', (n, amplitude, at))"
    )
