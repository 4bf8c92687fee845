"""Points of the solid at which quantities are evaluated."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from verification.problem.array_types import Array, Coatings
from verification.problem.layer_depths import layer_at


@dataclass(frozen=True, eq=False)
class Points:
    """Points x, y, z [m] with the ``layer`` of each.

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
    ) -> "Points":
        """Points with their layers, on an interface the upper one unless ``layer`` says otherwise."""
        return cls(x, y, z, np.broadcast_to(layer_at(z, coatings, layer), z.shape), unit, in_si)

    @classmethod
    def origin(cls, count: int) -> "Points":
        """The point (0, 0, 0) for a number of the contact as a whole."""
        zero = np.zeros(count)
        return cls(zero, zero, zero, np.zeros(count, dtype=int), "m", 1.0)

    @classmethod
    def on_curve(cls, control: str, value: Array, unit: str, in_si: float) -> "Points":
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

    def part(self, rows: list[int]) -> "Points":
        """Some of the points."""
        x, y, z, layer = self.x[rows], self.y[rows], self.z[rows], self.layer[rows]
        return Points(x, y, z, layer, self.unit, self.in_si, self.control)

    def _place(self, *fixed: tuple[str, Array]) -> str:
        named = [f"{name} = {float(v[0]) / self.in_si:.6g} {self.unit}" for name, v in fixed if v[0] != 0]
        zero = "surface" if fixed[-1][0] == "z" else "axis"
        return ", ".join(named) or zero
