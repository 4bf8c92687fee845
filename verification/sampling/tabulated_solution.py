"""A solution whose stresses at all the points of a table were taken in one go.

A column of a table asks for one component of the stress on one line, and the next for another one: a method
that answers plane by plane would sum the same planes again and again.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from verification.problem.array_types import Array
from verification.problem.coated_contact import Solution, stress_with_uncertainty
from verification.problem.evaluation_points import Points

__all__ = ["Tabulated", "tabulated"]

Place = tuple[float, float, float]


@dataclass(frozen=True, eq=False)
class Tabulated:
    """``sigma`` and its uncertainty ``U`` at the points of each layer, the rest from ``solution`` itself."""

    solution: Solution
    places: dict[int, dict[Place, int]]
    sigma: dict[int, Array]
    U: dict[int, Array] = field(default_factory=dict)

    def __getattr__(self, name: str) -> Any:
        return getattr(self.solution, name)

    def stress(self, x: ArrayLike, y: ArrayLike, z: ArrayLike, layer: int | None = None) -> Array:
        """As of the solution."""
        rows = self._rows(x, y, z, layer)
        if rows is None or layer is None:
            return self.solution.stress(x, y, z, layer)
        return self.sigma[layer][:, :, rows]

    def stress_uncertainty(self, x: ArrayLike, y: ArrayLike, z: ArrayLike, layer: int | None = None) -> Array:
        """As of the solution."""
        rows = self._rows(x, y, z, layer)
        if rows is None or layer is None or layer not in self.U:
            return self.solution.stress_uncertainty(x, y, z, layer)
        return self.U[layer][:, :, rows]

    def _rows(self, x: ArrayLike, y: ArrayLike, z: ArrayLike, layer: int | None) -> list[int] | None:
        known = self.places.get(-1 if layer is None else layer, {})
        points = zip(*(np.asarray(v, dtype=float).ravel().tolist() for v in (x, y, z)), strict=False)
        rows = [known.get(place) for place in points]
        same = np.ndim(x) == np.ndim(y) == np.ndim(z) == 1
        return [row for row in rows if row is not None] if same and None not in rows else None


def tabulated(solution: Solution, points: Sequence[Points]) -> Tabulated:
    """The solution with its stresses at ``points``, and their uncertainty where it states one."""
    places: dict[int, dict[Place, int]] = {}
    for at in points:
        for x, y, z, layer in zip(
            at.x.tolist(), at.y.tolist(), at.z.tolist(), at.layer.tolist(), strict=True
        ):
            known = places.setdefault(layer, {})
            known.setdefault((x, y, z), len(known))
    sigma: dict[int, Array] = {}
    U: dict[int, Array] = {}
    for layer, known in places.items():
        x, y, z = np.array(list(known)).T
        sigma[layer], uncertainty = stress_with_uncertainty(solution, x, y, z, layer=layer)
        if uncertainty is not None:
            U[layer] = uncertainty
    return Tabulated(solution, places, sigma, U)
