"""Values at points, and the points of the open digits."""

from dataclasses import dataclass

import numpy as np

from verification.problem.array_types import Array

SCALARS = ("contact_radius", "approach", "peak_pressure")
# Positions over the contact radius, or over the radius of the disc.
INSIDE = (0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 0.99)
DEPTH = (0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.8, 1.0, 1.5, 2.0, 3.0)


@dataclass(frozen=True, eq=False)
class Row:
    """``value`` [SI] of ``quantity`` at points of the plane y = 0, with its ``uncertainty``.

    layer : of each point, which picks the side of an interface.   A number of the contact is at x = z = 0.
    """

    quantity: str
    x: Array
    z: Array
    layer: int
    value: Array
    uncertainty: Array


def places(multiples: tuple[float, ...], a: float, *, sliding: bool = False) -> Array:
    """Multiples of ``a`` [m], rounded; of a sliding contact on either side."""
    found = [rounded(m * a) for m in multiples]
    return np.array(([-x for x in found[:0:-1]] if sliding else []) + found)


def rounded(value: float, digits: int = 4) -> float:
    """``value`` with ``digits`` significant digits."""
    return float(f"{value:.{digits - 1}e}")
