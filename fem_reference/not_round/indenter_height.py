"""Heights of the indenters that are no spheres, their symmetry, and what they touch first."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from fem_reference.validation import check_positive

Height = Callable[[Any, Any], Any]
Indenter = tuple[str, tuple[float, ...]]


@dataclass(frozen=True)
class TouchingShape:
    """Height (x, y) [m] above the lowest points, even in y.

    curvatures : along x and y of a lowest point [1/m].   centre : its x, with a second at -x unless it is 0
    fold : n of the symmetry by turns of 2 pi/n about it.   turns : about the axis z
    """

    height: Height
    curvatures: tuple[float, float]
    fold: int
    turns: int
    centre: float = 0.0

    def scaled(self, length: float) -> Height:
        """The height in units of ``length``."""
        return lambda x, y: self.height(x * length, y * length) / length


def touching_shape(indenter: Indenter, radius: float) -> TouchingShape:
    """Shape of an indenter by its name and numbers.

    ("ellipsoid", (R_x, R_y)) : x^2/2 R_x + y^2/2 R_y
    ("asperities", (distance,)) : two spheres of ``radius``, lowest at x = -distance/2, distance/2
    ("lobes", (n, amplitude, at)) : r^2/2 radius + amplitude (r/at)^n cos(n theta)
    Raises ValueError for another shape, for numbers that do not fit.
    """
    shape, numbers = indenter
    if shape == "ellipsoid" and len(numbers) == 2:
        R_x, R_y = numbers
        check_positive(R_x=R_x, R_y=R_y)
        return TouchingShape(lambda x, y: x**2 / (2 * R_x) + y**2 / (2 * R_y), (1 / R_x, 1 / R_y), 2, 2)
    round_ = (1 / radius, 1 / radius)
    if shape == "asperities" and len(numbers) == 1:
        check_positive(distance=numbers[0])
        half = numbers[0] / 2
        return TouchingShape(
            lambda x, y: ((np.abs(x) - half) ** 2 + y**2) / (2 * radius), round_, fold=1, turns=2, centre=half
        )
    if shape == "lobes" and len(numbers) == 3:
        n, amplitude, at = numbers
        check_positive(lobes=n, at=at)
        return TouchingShape(
            lambda x, y: (x**2 + y**2) / (2 * radius) + amplitude * (((x + 1j * y) / at) ** int(n)).real,
            round_,
            fold=int(n),
            turns=int(n),
        )
    raise ValueError(
        f"indenter = {indenter!r}; give ('ellipsoid', (R_x, R_y)), ('asperities', (distance,)) or "
        "('lobes', (n, amplitude, at))"
    )
