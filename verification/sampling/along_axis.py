"""A contact that is not round as seen along either of its axes, its half axis in place of its radius.

The searches for largest stresses look along x at y = 0, where they take the edge at the contact radius. For
an ellipse they do so twice: along x, and in a frame of exchanged axes along y.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from verification.problem.array_types import Array
from verification.problem.point_answers import Answer, Points, Sampled

EXCHANGED = np.array([1, 0, 2])  # components under exchange of x and y
SHARES = np.linspace(0, 1, 33)  # of a bracket of the edge, between which it is searched next
ROUNDS = 7
WIDER = 2.0  # factor by which the first bracket grows


def half_axis(contact: Any, *, across: bool) -> float:
    """Distance [m] from the origin along x, or along y with ``across``, to where the pressure ends."""
    low, high = 0.0, contact.contact_radius

    def pressed(at: Array) -> NDArray[np.bool_]:
        return np.asarray(contact.pressure(*((0 * at, at) if across else (at, 0 * at)))) > 0

    while pressed(np.array([high]))[0]:
        low, high = high, WIDER * high
    for _ in range(ROUNDS):
        at = low + (high - low) * SHARES
        last = int(np.flatnonzero(pressed(at))[-1])
        low, high = float(at[last]), float(at[min(last + 1, at.size - 1)])
    return (low + high) / 2


class AlongAxis(Sampled):
    """A ``contact`` along x, or with ``across`` along y, as a source whose contact radius is the half axis.

    With ``across`` its x is y of the contact, which for that does not slide.
    """

    def __init__(self, contact: Any, *, across: bool) -> None:
        self.contact, self.across, self.frames = contact, across, contact.frames
        self.coarser = None if contact.coarser is None else AlongAxis(contact.coarser, across=across)
        self.surface_nodes = contact.surface_nodes
        self.half_axis = half_axis(contact, across=across)

    def sample(self, points: Points | None, quantity: str, uncertainty: bool = True) -> Answer:
        """Value and uncertainty of the contact at places in this frame.

        The half axis is as uncertain as the contact radius in proportion, at least by its change from the
        coarser solution.
        """
        if points is None:
            value, U = self.contact.sample(None, quantity, uncertainty)
            if quantity != "contact_radius":
                return Answer(value, U)
            if U is not None:
                changed = abs(self.coarser.half_axis - self.half_axis) if self.coarser else 0.0
                U = max(U * self.half_axis / value, changed)
            return Answer(self.half_axis, U)
        if not self.across:
            return Answer(*self.contact.sample(points, quantity, uncertainty))
        turned = Points(points.y, points.x, points.z, points.layer, points.body, points.frame)
        value, U = self.contact.sample(turned, quantity, uncertainty)
        return Answer(*(None if of is None else _exchanged(np.asarray(of), quantity) for of in (value, U)))


def _exchanged(field: Array, quantity: str) -> Array:
    if quantity == "stress":
        return field[EXCHANGED][:, EXCHANGED]
    return field[EXCHANGED] if quantity == "displacement" else field
