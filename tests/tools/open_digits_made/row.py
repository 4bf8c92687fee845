"""Values at points, and the points of the open digits."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from verification.problem.array_types import Array
from verification.problem.point_answers import FLAT, Answer, Points
from verification.problem.quantity import DISPLACEMENTS, STRESSES

SCALARS = ("contact_radius", "approach", "peak_pressure")
# Positions over the contact radius, or over the radius of the disc.
INSIDE = (0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 0.99)
DEPTH = (0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.8, 1.0, 1.5, 2.0, 3.0)
BELOW, ASIDE, DIRECTION = (0.1, 0.3, 0.6, 1.0, 2.0), 0.5, (0.8, 0.6)  # of points off y = 0


@dataclass(frozen=True, eq=False)
class Row:
    """``value`` [SI] of ``quantity`` at ``points``, None for one of the contact, with ``uncertainty``."""

    quantity: str
    points: Points | None
    value: Array
    uncertainty: Array


def rows_at(points: Points, quantities: Sequence[str], sample: Callable[..., Answer]) -> Iterator[Row]:
    """Rows of stresses and displacements at the same ``points`` by ``sample``."""
    fields: dict[str, Answer] = {}
    for name in quantities:
        kind = "stress" if name in STRESSES else "displacement"
        if kind not in fields:
            fields[kind] = sample(points, kind)
        value, U = (part[component(name)] for part in fields[kind])
        yield Row(name, points, value, U)


def component(quantity: str) -> tuple[int, ...]:
    """Place of ``quantity`` in its field; of the pressure none."""
    if quantity in DISPLACEMENTS:
        return ("xyz".index(quantity[-1]),)
    return STRESSES.get(quantity, ())


def places(multiples: Sequence[float], a: float, *, sliding: bool = False) -> Array:
    """Multiples of ``a`` [m], rounded; of a sliding contact on either side."""
    found = [rounded(m * a) for m in multiples]
    return np.array(([-x for x in found[:0:-1]] if sliding else []) + found)


def rounded(value: float, digits: int = 4) -> float:
    """``value`` with ``digits`` significant digits."""
    return float(f"{value:.{digits - 1}e}")


def off_plane(a: float, coatings: Sequence[tuple[float, float, float]], body: str = FLAT) -> Iterator[Points]:
    """Points below one place beside the axis, off y = 0, of each layer together; lengths over ``a`` [m]."""
    x, y = (places([ASIDE * cosine], a)[0] for cosine in DIRECTION)
    z = places(BELOW, a)
    layers = np.searchsorted(np.cumsum([h for *_, h in coatings]), z)
    for layer in sorted(set(layers.tolist())):
        here = z[layers == layer]
        yield Points(np.full_like(here, x), np.full_like(here, y), here, layer, body)
