"""Indenters that are no spheres: an ellipsoid, two asperities, a lobed sphere, all even in y."""

from collections.abc import Callable
from math import isfinite, isinf
from typing import Any

import numpy as np

Indenter = tuple[str, tuple[float, ...]]  # shape and its numbers, SI
SHAPES = {"ellipsoid": ("R_x", "R_y"), "asperities": ("distance",), "lobes": ("lobes", "amplitude", "at")}


def require_shape(indenter: Indenter) -> None:
    """Raises ValueError for another shape, or for numbers that are none of its."""
    shape, numbers = indenter
    if shape not in SHAPES or len(numbers) != len(SHAPES[shape]):
        raise ValueError(f"indenter = {indenter!r}; give one of " + ", ".join(map(str, SHAPES.items())))
    for name, value in zip(SHAPES[shape], numbers, strict=True):
        if not (isfinite(value) and (value > 0 or name == "amplitude")):
            raise ValueError(f"indenter.{name} = {value:g}; it must be a positive finite number")


def effective_radius(one: float, other: float) -> float:
    """Radius of the gap of two surfaces along one axis, 1/R = 1/R_1 + 1/R_2; negative where concave."""
    return one if isinf(other) else 1 / (1 / one + 1 / other)


def height_of(indenter: Indenter | None, radius: float) -> Callable[[Any, Any], Any]:
    """Height (x, y) [m] of the indenter's surface above its lowest points; a paraboloid of ``radius`` [m].

    ellipsoid   x^2/2 R_x + y^2/2 R_y
    asperities  ((|x| - distance/2)^2 + y^2)/2 radius
    lobes       r^2/2 radius + amplitude (r/at)^lobes cos(lobes theta)
    """
    shape, numbers = indenter or ("sphere", ())

    def height(x: Any, y: Any) -> Any:
        x, y = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
        if shape == "ellipsoid":
            return x**2 / (2 * numbers[0]) + y**2 / (2 * numbers[1])
        if shape == "asperities":
            return ((np.abs(x) - numbers[0] / 2) ** 2 + y**2) / (2 * radius)
        r2 = (x**2 + y**2) / (2 * radius)
        if shape == "lobes":
            n, amplitude, at = numbers
            r2 = r2 + amplitude * (np.hypot(x, y) / at) ** n * np.cos(n * np.arctan2(y, x))
        return r2

    return height
