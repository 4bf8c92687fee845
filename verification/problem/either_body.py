"""A solution as seen from either body of the contact."""

from dataclasses import dataclass
from typing import Any, cast

import numpy as np
from numpy.typing import ArrayLike

from verification.problem.array_types import Array
from verification.problem.coated_contact import (
    BALL,
    FLAT,
    Solution,
    relative_to_edge,
    stress_with_uncertainty,
)

# Half a turn round z, of the two bodies' frames: u_x, u_y change sign, and so do sigma_xz, sigma_yz.
_VECTOR = np.array([-1.0, -1.0, 1.0])
_TENSOR = np.outer(_VECTOR, _VECTOR)


def on_body(solution: Solution, body: str) -> Solution:
    """``solution`` as that of ``problem.seen_from(body)``, of the ball with its fields for the flat's.

    The traction on the ball, -q, is along +x in a frame turned by half a turn round z.
    """
    return solution if body == FLAT else cast(Solution, _OnBall(solution))


@dataclass(frozen=True, eq=False)
class _OnBall:
    solution: Any

    def __getattr__(self, name: str) -> Any:
        return getattr(self.solution, name)

    @property
    def coarser(self) -> "_OnBall | None":
        coarser = getattr(self.solution, "coarser", None)
        return None if coarser is None else _OnBall(coarser)

    @property
    def relative_to_edge(self) -> "_OnBall":
        own = relative_to_edge(self.solution)
        return self if own is self.solution else _OnBall(own)

    def stress(self, *at: Any, **of: Any) -> Array:
        return _turned(self._seen("stress", *at, **of), _TENSOR)

    def stress_uncertainty(self, *at: Any, **of: Any) -> Array:
        return self._seen("stress_uncertainty", *at, **of)

    def stress_with_uncertainty(
        self, x: ArrayLike, y: ArrayLike, z: ArrayLike, layer: int | None = None
    ) -> tuple[Array, Array | None]:
        sigma, U = stress_with_uncertainty(self.solution, -np.asarray(x), -np.asarray(y), z, layer, body=BALL)
        return _turned(sigma, _TENSOR), U

    def displacement(self, *at: Any) -> Array:
        return _turned(self._seen("displacement", *at), _VECTOR)

    def displacement_uncertainty(self, *at: Any) -> Array:
        return self._seen("displacement_uncertainty", *at)

    def _seen(self, field: str, x: ArrayLike, y: ArrayLike, *others: Any, **of: Any) -> Array:
        """A field of the ball at places in its own frame."""
        found: Array = getattr(self.solution, field)(-np.asarray(x), -np.asarray(y), *others, **of, body=BALL)
        return found


def _turned(field: Array, sign: Array) -> Array:
    return field * sign.reshape(sign.shape + (1,) * (field.ndim - sign.ndim))
