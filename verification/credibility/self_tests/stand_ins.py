"""Closed forms that stand in for a method: right, off, vague, incomplete, or labelled."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from verification.problem.array_types import Array
from verification.problem.coated_contact import ScalarUncertainty
from verification.problem.point_answers import FIELDS, FLAT, ByFunctions, Points
from verification.sources.references.hertz import Hertz

Answers = Iterator[tuple[str, Any, Any]]  # what was asked, what the harness found, what it has to be


@dataclass(frozen=True)
class Stated(Hertz):
    """Hamilton with an uncertainty, ``share`` of each number."""

    share: float = 1e-7

    @property
    def uncertainty(self) -> ScalarUncertainty:
        share = self.share
        return ScalarUncertainty(
            share * self.contact_radius, share * self.approach, share * self.peak_pressure
        )

    def error(self, points: Points | None, quantity: str, value: Any) -> Any:
        """``share`` of the peak pressure, of the approach or of the number itself."""
        scale = {"displacement": self.approach, "pressure": self.peak_pressure, "stress": self.peak_pressure}
        return self.share * (np.full_like(value, scale[quantity]) if quantity in scale else value)


@dataclass(frozen=True)
class Spoiled(Stated):
    """A pressure that is 1 % of its peak too large around the radius ``at`` [a]."""

    at: float = 0.0

    def pressure(self, x: ArrayLike, y: ArrayLike = 0.0) -> Array:
        near = np.abs(np.hypot(x, y) / self.contact_radius - self.at) < 0.03
        return super().pressure(x, y) + np.where(near, 0.01 * self.peak_pressure, 0.0)


@dataclass(frozen=True)
class Misplaced(Stated):
    """Stresses that are 1 % of p0 too large in a box ``low`` to ``high``, x, y, z over a."""

    low: tuple[float, float, float] = (0.0, 0.0, 0.0)
    high: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def stress(self, x: Any, y: Any, z: Any, layer: int | None = None, body: str = FLAT) -> Array:
        at = np.broadcast_arrays(*(np.asarray(v, dtype=float) / self.contact_radius for v in (x, y, z)))
        inside = [(b <= v) & (v <= t) for b, v, t in zip(self.low, at, self.high, strict=True)]
        return super().stress(x, y, z, layer) + 0.01 * self.peak_pressure * np.all(inside, axis=0)


class Failing(Stated):
    """A method that has a contact but no stresses."""

    def stress(self, *at: Any, **of: Any) -> Array:
        raise ValueError("no stresses today")


ON_BALL = 1.5  # every labelled number of the ball over that of the flat


def labelled(i: int, j: int, place: Sequence[Any], layer: int | None) -> Any:
    """A stress that tells its component, place and layer; numbers or arrays."""
    low, high = sorted((i, j))
    x, y, z = place
    component = 1e6 * (1 + 3 * low + high)
    return component + 1e9 * x + 7e9 * y + 3e9 * z + 1e7 * (-1 if layer is None else layer)


def moved(i: int, place: Sequence[Any]) -> Any:
    """A displacement that tells its component and place."""
    x, y, z = place
    return 1e-7 * (1 + i) + 1e-3 * x + 7e-3 * y + 3e-3 * z


class Labelled(ByFunctions):
    """A solution whose every number says what it is and where."""

    contact_radius, approach, peak_pressure = 1e-4, 1e-6, 3e9
    stiffness = 6e7
    uncertainty = ScalarUncertainty(3e-9, 4e-12, 2e6, 5e1)

    def error(self, points: Points | None, quantity: str, value: Any) -> Any:
        return 1e-3 * value if quantity in FIELDS else getattr(self.uncertainty, quantity)

    def pressure(self, x: ArrayLike, y: ArrayLike = 0.0) -> Array:
        return 1e9 + 1e12 * np.asarray(x, dtype=float) + 3e12 * np.asarray(y, dtype=float)

    def stress(self, x: Any, y: Any, z: Any, layer: int | None = None, body: str = FLAT) -> Array:
        at = np.broadcast_arrays(*(np.asarray(v, dtype=float) for v in (x, y, z)))
        sigma = np.array([[labelled(i, j, at, layer) for j in range(3)] for i in range(3)])
        return sigma * (1 if body == FLAT else ON_BALL)

    def displacement(self, x: Any, y: Any, z: Any, body: str = FLAT) -> Array:
        at = np.broadcast_arrays(*(np.asarray(v, dtype=float) for v in (x, y, z)))
        return np.array([moved(i, at) for i in range(3)]) * (1 if body == FLAT else ON_BALL)
