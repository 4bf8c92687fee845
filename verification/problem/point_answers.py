"""Points of a contact, and what a source of numbers answers about a quantity there.

A method's solution, an exact reference, an extrapolation, a loading curve, another code: all are asked

    value, uncertainty = source.sample(points, quantity)

with a field, ``FIELDS``, or a scalar of the contact, for which ``points`` are None. A source that does not
give the quantity answers UNSUPPORTED; at a singular point the value is NaN.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from verification.problem.array_types import Array

FLAT, BALL = "flat", "ball"  # the two bodies of a contact
FIXED, EDGE = "fixed", "edge"  # the frames of points
FIELDS = {"pressure": (), "stress": (3, 3), "displacement": (3,)}  # with their component axes


@dataclass(frozen=True, eq=False)
class Points:
    """Places x, y, z [m], broadcast, x and y as on the flat, z into the ``body``.

    layer : 0 at the surface to the number of coatings; the side of an interface, None the upper one.
    frame : of all or of each; FIXED, or EDGE where a place is meant as the same share of the way to the
    source's own contact edge: the error of the edge is then no part of the uncertainty.
    """

    x: ArrayLike
    y: ArrayLike = 0.0
    z: ArrayLike = 0.0
    layer: int | None = None
    body: str = FLAT
    frame: ArrayLike = FIXED

    @property
    def shape(self) -> tuple[int, ...]:
        """Shape of the points."""
        return np.broadcast_shapes(np.shape(self.x), np.shape(self.y), np.shape(self.z))


class Answer(NamedTuple):
    """Value and absolute uncertainty in SI units.

    A field has the component axes of ``FIELDS`` before those of the points, a scalar is a float.
    uncertainty : None where none is stated or wanted, 0 of an exact value.
    """

    value: Any
    uncertainty: Any = None


UNSUPPORTED = Answer(None)


class NotClaimed(ValueError):
    """A source does not give the field that was requested; this is no failure of it."""


def supported(source: Any, points: Points | None, quantity: str, uncertainty: bool = True) -> Answer:
    """The answer of ``source``. Raises NotClaimed where it does not support the quantity."""
    answer = Answer(*source.sample(points, quantity, uncertainty))
    if answer.value is None:
        raise NotClaimed(f"{type(source).__name__} gives no {quantity}; compare other quantities with it")
    return answer


class Sampled:
    """Base of a source: its scalars and fields as plain numbers and arrays, by its ``sample``."""

    frames: tuple[str, ...] = (FIXED,)  # in which its uncertainties are its own
    coarser: Any = None  # the solution it is compared with for its uncertainty

    def sample(self, points: Points | None, quantity: str, uncertainty: bool = True) -> Answer:
        """Value and uncertainty of a quantity; without ``uncertainty`` the value alone, at less work."""
        raise NotImplementedError

    @property
    def contact_radius(self) -> float:
        """Contact radius [m]."""
        return float(supported(self, None, "contact_radius", False).value)

    @property
    def approach(self) -> float:
        """Approach [m]."""
        return float(supported(self, None, "approach", False).value)

    @property
    def peak_pressure(self) -> float:
        """Largest pressure [Pa]."""
        return float(supported(self, None, "peak_pressure", False).value)

    def pressure(self, x: ArrayLike, y: ArrayLike = 0.0) -> Array:
        """Contact pressure [Pa], shape of the points."""
        return np.asarray(supported(self, Points(x, y), "pressure", False).value)

    def stress(
        self, x: ArrayLike, y: ArrayLike, z: ArrayLike, layer: int | None = None, body: str = FLAT
    ) -> Array:
        """Stress tensor [Pa], shape (3, 3) + points."""
        return np.asarray(supported(self, Points(x, y, z, layer, body), "stress", False).value)

    def displacement(self, x: ArrayLike, y: ArrayLike, z: ArrayLike, body: str = FLAT) -> Array:
        """Displacement [m], shape (3,) + points."""
        return np.asarray(supported(self, Points(x, y, z, None, body), "displacement", False).value)


def by_functions(of: Any, points: Points | None, quantity: str) -> Any:
    """The value of a quantity by the attribute or function of its name; None without such a one.

    of : a mapping or an object with scalars, pressure(x, y), stress(x, y, z, layer), displacement(x, y, z),
    the last two with ``body`` where the ball is elastic.
    """
    found = of.get(quantity) if isinstance(of, Mapping) else getattr(of, quantity, None)
    if found is None or points is None or quantity not in FIELDS:
        return found
    if quantity == "pressure":
        return found(points.x, points.y)
    given: dict[str, Any] = {} if points.body == FLAT else {"body": points.body}
    if quantity == "stress":
        given["layer"] = points.layer
    return found(points.x, points.y, points.z, **given)


class ByFunctions:
    """Base of a source whose numbers and functions are attributes of it, see ``by_functions``."""

    frames: ClassVar[tuple[str, ...]] = (FIXED,)
    coarser: Any = None

    @property
    def surface_nodes(self) -> Array:
        """The pressure is known everywhere; 401 points on [-2a, 2a]."""
        return 2 * float(self.sample(None, "contact_radius", False).value) * np.linspace(-1, 1, 401)

    def sample(self, points: Points | None, quantity: str, uncertainty: bool = True) -> Answer:
        """Value and uncertainty of a quantity; without ``uncertainty`` the value alone, at less work."""
        value = by_functions(self, points, quantity)
        if value is None or not uncertainty:
            return Answer(value)
        return Answer(value, self.error(points, quantity, value))

    def error(self, points: Points | None, quantity: str, value: Any) -> Any:
        """Uncertainty of ``value``: none, it is exact."""
        return np.zeros_like(value) if quantity in FIELDS else 0.0
