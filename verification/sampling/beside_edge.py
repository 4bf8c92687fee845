"""A solution evaluated beside the contact edge at the same x/a, where a fixed x would compare contact radii.

At a fixed x next to the edge an error da of the radius changes the pressure by q sqrt(2 da/a), whatever the
method; the radius is a quantity of its own.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from verification.problem.array_types import Array
from verification.problem.coated_contact import Solution, relative_to_edge, stress_with_uncertainty
from verification.sampling.largest_tension import BESIDE

__all__ = ["BesideEdge"]


@dataclass(frozen=True, eq=False)
class BesideEdge:
    """``solution`` with points within ``BESIDE`` of the exact ``edge`` [m] at the same x/a of its own."""

    solution: Solution
    edge: float

    def __getattr__(self, name: str) -> Any:
        return getattr(self.solution, name)

    def pressure(self, x: ArrayLike, y: ArrayLike = 0.0) -> Array:
        """As of the solution."""
        _, ratio = self._near(x, y, 0.0)
        return self.solution.pressure(np.asarray(x) * ratio, np.asarray(y) * ratio)

    def pressure_uncertainty(self, x: ArrayLike, y: ArrayLike = 0.0) -> Array:
        """As of the solution; of its view relative to the edge beside it."""
        near, ratio = self._near(x, y, 0.0)
        x, y = np.asarray(x) * ratio, np.asarray(y) * ratio
        relative = relative_to_edge(self.solution).pressure_uncertainty(x, y)
        return np.where(near, relative, self.solution.pressure_uncertainty(x, y))

    def stress(self, x: ArrayLike, y: ArrayLike, z: ArrayLike, layer: int | None = None) -> Array:
        """As of the solution."""
        _, ratio = self._near(x, y, z)
        return self.solution.stress(np.asarray(x) * ratio, np.asarray(y) * ratio, z, layer)

    def stress_uncertainty(self, x: ArrayLike, y: ArrayLike, z: ArrayLike, layer: int | None = None) -> Array:
        """As ``pressure_uncertainty``."""
        near, ratio = self._near(x, y, z)
        place = np.asarray(x) * ratio, np.asarray(y) * ratio, z
        relative = relative_to_edge(self.solution)
        _, U = stress_with_uncertainty(self.solution, *place, layer=layer)
        assert U is not None
        if not near.any() or relative is self.solution:
            return U
        _, beside = stress_with_uncertainty(relative, *place, layer=layer)
        assert beside is not None
        return np.where(near, beside, U)

    def _near(self, x: ArrayLike, y: ArrayLike, z: ArrayLike) -> tuple[Array, Array]:
        """Which points are beside the edge, and the factor on x and y."""
        x, y, z = np.broadcast_arrays(*(np.asarray(v, dtype=float) for v in (x, y, z)))
        near = np.hypot(np.hypot(x, y) - self.edge, z) <= BESIDE * self.edge
        return near, np.where(near, float(self.solution.contact_radius) / self.edge, 1.0)
