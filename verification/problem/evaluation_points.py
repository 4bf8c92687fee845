"""Points of published tables at which quantities are evaluated, and the layers in which they lie."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from verification.problem.array_types import Array, Coatings


def layer_at(z: Array, coatings: Coatings, layer: int | None) -> NDArray[np.int_]:
    """Layer of each depth; on an interface the upper one unless ``layer`` says otherwise.

    Raises ValueError where ``layer`` does not reach ``z``, or z < 0.
    """
    bounds = np.concatenate([[0.0], np.cumsum([h for _, _, h in coatings])])
    slack = 1e-9 * (coatings[0][2] if coatings else 1e-300)
    if np.any(z < 0):
        raise ValueError(f"z = {z.min():g} m is above the surface; depth counts down from 0")
    if layer is None:
        return np.searchsorted(bounds[1:], z - slack)
    if not 0 <= layer <= len(coatings):
        raise ValueError(f"layer = {layer}; this solid has layers 0 to {len(coatings)}")
    end = np.inf if layer == len(coatings) else bounds[layer + 1]
    if np.any(z < bounds[layer] - slack) or np.any(z > end + slack):
        raise ValueError(f"layer = {layer} spans {bounds[layer]:g} to {end:g} m, not every z lies in it")
    return np.full(z.shape, layer)


@dataclass(frozen=True, eq=False)
class TablePoints:
    """Points x, y, z [m] of a table with the ``layer`` of each.

    unit, in_si : unit of the source with its SI value, for names of lines.
    control : of a loading curve, whose values x are.
    """

    x: Array
    y: Array
    z: Array
    layer: NDArray[np.int_]
    unit: str
    in_si: float
    control: str = ""

    @classmethod
    def of(
        cls, x: Array, y: Array, z: Array, coatings: Coatings, layer: int | None, unit: str, in_si: float
    ) -> "TablePoints":
        """The points with their layers, on an interface the upper one unless ``layer`` says otherwise."""
        return cls(x, y, z, np.broadcast_to(layer_at(z, coatings, layer), z.shape), unit, in_si)

    @classmethod
    def origin(cls, count: int) -> "TablePoints":
        """The point (0, 0, 0) for a number of the contact as a whole."""
        zero = np.zeros(count)
        return cls(zero, zero, zero, np.zeros(count, dtype=int), "m", 1.0)

    @classmethod
    def on_curve(cls, control: str, value: Array, unit: str, in_si: float) -> "TablePoints":
        """Points of a loading curve by the value of its control [m]."""
        zero = np.zeros(value.shape)
        return cls(value, zero, zero, np.zeros(value.shape, dtype=int), unit, in_si, control)

    @property
    def along(self) -> Array:
        """The coordinate that varies: z, or x where all lie at one depth, or the control of a curve [m]."""
        return self.x if self._at_one_depth or self.control else self.z

    @property
    def coordinate(self) -> str:
        """The name of ``along``."""
        if self.control:
            return {"contact_radius": "a", "approach": "delta"}[self.control]
        return "x" if self._at_one_depth else "z"

    @property
    def _at_one_depth(self) -> bool:
        return bool(self.z.size > 1 and np.ptp(self.z) == 0 and np.ptp(self.x) > 0)

    def lines(self) -> list[tuple[str, list[int]]]:
        """The points as straight lines, each with its name and the numbers of its points."""
        if self.control:
            return [("loading curve", list(range(self.x.size)))]
        if self._at_one_depth and np.ptp(self.y) == 0:
            return [(self._place(("y", self.y), ("z", self.z)), list(range(self.z.size)))]
        lines: dict[tuple[float, float], list[int]] = {}
        for i, place in enumerate(zip(self.x.tolist(), self.y.tolist(), strict=True)):
            lines.setdefault(place, []).append(i)
        return [
            (self.part(rows)._place(("x", self.x[rows]), ("y", self.y[rows])), rows)
            for rows in lines.values()
        ]

    def part(self, rows: list[int]) -> "TablePoints":
        """Some of the points."""
        x, y, z, layer = self.x[rows], self.y[rows], self.z[rows], self.layer[rows]
        return TablePoints(x, y, z, layer, self.unit, self.in_si, self.control)

    def _place(self, *fixed: tuple[str, Array]) -> str:
        named = [f"{name} = {float(v[0]) / self.in_si:.6g} {self.unit}" for name, v in fixed if v[0] != 0]
        zero = "surface" if fixed[-1][0] == "z" else "axis"
        return ", ".join(named) or zero
