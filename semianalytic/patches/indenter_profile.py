"""Profiles of the indenters that are no spheres."""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from semianalytic.inputs import check_finite, check_positive

Array = NDArray[np.floating]
Shape = tuple[str, tuple[float, ...]]


def profile_of(indenter: Shape, radius: float) -> Callable[[Any, Any], Any]:
    """Height z(x, y) [m] of an indenter given by its shape and numbers [m].

    "ellipsoid" (R_x, R_y) with these radii of curvature; "asperities" (distance,), two spheres of ``radius``
    that stand side by side along x; "lobes" (n, amplitude, at), a sphere of ``radius`` whose height at the
    distance ``at`` varies n times around it by ``amplitude``.
    Raises ValueError for another shape.
    """
    shape, numbers = indenter
    check_finite(**{f"indenter[1][{i}]": number for i, number in enumerate(numbers)})
    if shape == "ellipsoid" and len(numbers) == 2:
        along, across = numbers
        check_positive(R_x=along, R_y=across)
        return lambda x, y: (x * x / along + y * y / across) / 2
    if shape == "asperities" and len(numbers) == 1:
        (distance,) = numbers
        check_positive(distance=distance)
        return lambda x, y: ((np.abs(x) - distance / 2) ** 2 + y**2) / (2 * radius)
    if shape == "lobes" and len(numbers) == 3:
        count, amplitude, at = numbers
        check_positive(lobes=count, at=at)
        return lambda x, y: (
            np.hypot(x, y) ** 2 / (2 * radius)
            + amplitude * (np.hypot(x, y) / at) ** count * np.cos(count * np.arctan2(y, x))
        )
    raise ValueError(f"indenter = {indenter!r}; its shape is ellipsoid, asperities or lobes")
