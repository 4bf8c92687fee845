"""Points at which a solution is asked, and the answer: a value with its uncertainty."""

from typing import Any, NamedTuple

from numpy.typing import ArrayLike


class PatchPoints(NamedTuple):
    """Places x, y, z [m], broadcast, z >= 0 into the ``body``: "flat" or "ball", x and y as on the flat.

    layer : 0 is the first coating, len(coatings) the substrate; picks the side of an interface, None the
    upper one.  frame : of all or of each; "fixed", or "edge" for places meant as the same share of the way to
    the contact edge, whose uncertain radius then does not count.
    """

    x: ArrayLike
    y: ArrayLike = 0.0
    z: ArrayLike = 0.0
    layer: int | None = None
    body: str = "flat"
    frame: ArrayLike = "fixed"


class PatchAnswer(NamedTuple):
    """Value and uncertainty in SI units.

    pressure : shape of the points, stress (3, 3) + it, displacement (3,) + it, a scalar a float.
    uncertainty : None where none was estimated.   Both None: the quantity is not supported.
    """

    value: Any
    uncertainty: Any = None
