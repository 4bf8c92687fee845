"""A contact as seen from either of its bodies."""

from typing import Any

import numpy as np

from verification.problem.array_types import Array
from verification.problem.point_answers import BALL, FLAT, Answer, Points, Sampled

# Half a turn round z, of the two bodies' frames: u_x, u_y change sign, and so do sigma_xz, sigma_yz.
_VECTOR = np.array([-1.0, -1.0, 1.0])
_SIGNS = {"stress": np.outer(_VECTOR, _VECTOR), "displacement": _VECTOR, "pressure": np.array(1.0)}


def on_body(solution: Any, body: str) -> Any:
    """``solution`` as that of ``problem.seen_from(body)``, of the ball with its fields for the flat's."""
    return solution if body == FLAT else BallSide(solution)


class BallSide(Sampled):
    """The ball of a contact as a source of its own, in whose frame the traction on it is in +x.

    That frame is turned by half a turn round z, since the traction on the ball is -q.
    """

    def __init__(self, contact: Any) -> None:
        self.contact, self.frames = contact, contact.frames
        self.coarser = None if contact.coarser is None else BallSide(contact.coarser)
        self.surface_nodes = contact.surface_nodes

    def sample(self, points: Points | None, quantity: str, uncertainty: bool = True) -> Answer:
        """Value and uncertainty of the contact, at places in the frame of the ball."""
        if points is None:
            return Answer(*self.contact.sample(None, quantity, uncertainty))
        x, y = -np.asarray(points.x), -np.asarray(points.y)
        turned = Points(x, y, points.z, points.layer, BALL, points.frame)
        value, U = self.contact.sample(turned, quantity, uncertainty)
        return Answer(None if value is None else _turned(value, _SIGNS[quantity]), U)


def _turned(field: Array, sign: Array) -> Array:
    return field * sign.reshape(sign.shape + (1,) * (field.ndim - sign.ndim))
