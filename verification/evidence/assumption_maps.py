"""Maps of what each assumption costs: the record with its values between the nodes.

Maintainers make them; ``credibility.model.shared_assumptions`` states the axes of each. The places are
a rigid or elastic ball on one coating, by dimensionless coordinates:

ratio : E1*/E2* of coating and substrate, E1/E2 where both have one nu;   thickness : h/a_h;   nu;
width : a_h/R;   friction : f;   ball : share of the ball in the contact's compliance, E*/E_ball*, 0 rigid.
"""

from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy as np

from verification.problem.array_types import Array
from verification.problem.coated_contact import CoatedContact
from verification.problem.grid_interpolation import contracted, interpolated, window
from verification.running.json_records import RecordFile
from verification.sources.assumptions.contact_change import SCALARS, Change

SUBSTRATE, RADIUS = 210e9, 10e-3  # the costs depend on neither
LOGARITHMIC = ("ratio", "thickness", "width")


@dataclass(frozen=True)
class Place:
    """A problem by its coordinates; both bodies and the coating have one ``nu``."""

    ratio: float = 1.0
    thickness: float = 1.0
    nu: float = 0.3
    width: float = 0.03
    friction: float = 0.0
    ball: float = 0.0

    @property
    def problem(self) -> CoatedContact:
        """With a steel's modulus below and a ball of 10 mm."""
        a_h = self.width * RADIUS
        ball = None
        if self.ball:
            ball = (SUBSTRATE * (1 - self.ball) / self.ball, self.nu, ())
        coating = (self.ratio * SUBSTRATE, self.nu, self.thickness * a_h)
        E_star = SUBSTRATE / (1 - self.nu**2) * (1 - self.ball)
        load = 4 * a_h**3 * E_star / (3 * RADIUS)
        return CoatedContact(RADIUS, load, (coating,), (SUBSTRATE, self.nu), self.friction, ball)


def places_of(problem: CoatedContact) -> tuple[Place, ...]:
    """Places of ``problem`` on the maps: one for each Poisson's ratio that occurs in it.

    Without a coating ``ratio`` is 1 and the thickness is of no importance.
    Raises ValueError where the maps cannot hold it: several coatings, a coated ball.
    """
    if len(problem.coatings) > 1:
        raise ValueError(f"{len(problem.coatings)} coatings; the maps hold one")
    E2, nu2 = problem.substrate
    E1, nu1, h = problem.coatings[0] if problem.coatings else (E2, nu2, problem.a_h)
    share, nus = 0.0, {nu1, nu2}
    if problem.ball is not None:
        E_ball, nu_ball, layers = problem.ball
        if layers:
            raise ValueError("a coated ball; that of the maps is not")
        share = problem.E_star * (1 - nu_ball**2) / E_ball
        nus.add(nu_ball)
    ratio = E1 * (1 - nu2**2) / (E2 * (1 - nu1**2))
    a_h = problem.a_h
    return tuple(
        Place(ratio, h / a_h, nu, a_h / problem.radius, problem.friction, share) for nu in sorted(nus)
    )


SHIPPED = Path(__file__).parent / "shipped"
SCHEMA = "coatcheck-assumptions/2"
SAME = 1e-6  # relative; nearer to a fixed coordinate a problem has it
WORDS = {
    "ratio": "E1/E2",
    "thickness": "h/a_h",
    "nu": "nu",
    "width": "a_h/R",
    "friction": "f",
    "ball": "E*/E_ball*",
}


@dataclass(frozen=True)
class MapAxis:
    """Values of the coordinate ``name``, ascending; ``rates`` as of Assumption, of each quantity."""

    name: str
    values: tuple[float, ...]
    rates: tuple[float, ...]

    @cached_property
    def nodes(self) -> Array:
        """Coordinates of interpolation: logarithms of ratios and widths."""
        values = np.array(self.values)
        return np.log(values) if self.name in LOGARITHMIC else values

    def position(self, value: float) -> float:
        """``value`` as the coordinate of interpolation, that of the first node where a rate holds below.

        Raises ValueError outside the axis.
        """
        low, high = self.values[0], self.values[-1]
        below = any(self.rates) and value < low
        if not (below or low * (1 - SAME) <= value <= high * (1 + SAME)):
            extent = f"{low:g}" if low == high else f"{low:g} to {high:g}"
            raise ValueError(f"{WORDS[self.name]} = {value:.3g}; the map holds {extent}")
        inside = min(max(value, low), high)
        return float(np.log(inside)) if self.name in LOGARITHMIC else inside


@dataclass(frozen=True, eq=False)
class AssumptionMap:
    """Relative change of each of ``quantities`` by ``assumption``, (quantities, *axes), NaN without answer.

    uncertainty : of the change.   seconds : of the processor.   source : hash of the code.
    """

    assumption: str
    title: str
    quantities: tuple[str, ...]
    axes: tuple[MapAxis, ...]
    independent_of: tuple[str, ...]
    change: Array
    uncertainty: Array
    started: str
    seconds: float
    commit: str | None
    machine: str
    versions: dict[str, str]
    source: str = ""

    def at(self, problem: CoatedContact) -> tuple[Change, Change]:
        """Change with uncertainty at ``problem``, that of the interpolation included; None where it has none.

        Between Poisson's ratios of the bodies and the coating the middle, half of the range as uncertainty.
        Raises ValueError outside the map, or where its model had no answer.
        """
        places = places_of(problem)
        if not problem.coatings:  # any thickness of the map
            values = next((axis.values for axis in self.axes if axis.name == "thickness"), (1.0,))
            any_thickness = min(values, key=lambda value: abs(np.log(value)))
            places = tuple(replace(place, thickness=any_thickness) for place in places)
        found = np.array([self._at_place(place) for place in places])
        low, high = found[:, 0].min(axis=0), found[:, 0].max(axis=0)
        value, uncertainty = (low + high) / 2, found[:, 1].max(axis=0) + (high - low) / 2
        if not problem.coatings:
            value[self.quantities.index("shear")] = np.nan
        if np.isnan(value).all():
            raise ValueError("the model had no answer near this problem")
        one, other = (
            Change(
                **{n: None if np.isnan(v) else float(v) for n, v in zip(self.quantities, some, strict=True)}
            )
            for some in (value, np.where(np.isnan(value), np.nan, uncertainty))
        )
        return one, other

    @property
    def driver(self) -> int:
        """Index of the axis along which the change grows, the one with rates."""
        return next(i for i, axis in enumerate(self.axes) if any(axis.rates))

    @cached_property
    def largest(self) -> Array:
        """Largest magnitude with its uncertainty at each value of the ``driver``, (quantities, values)."""
        size = np.moveaxis(np.abs(self.change) + self.uncertainty, 1 + self.driver, 1)
        flat = np.where(np.isnan(size), -np.inf, size).reshape(*size.shape[:2], -1).max(axis=-1)
        return np.where(np.isinf(flat), np.nan, flat)

    def reach(self, quantity: int, level: float) -> float | None:
        """Value of the ``driver`` up to which the change of a quantity is at most ``level`` all over the map.

        By powers between the values, below the first by its rate; None where it is above the last.
        """
        axis, size = self.axes[self.driver], self.largest[quantity]
        above = np.flatnonzero(size > level)
        if not above.size:
            return None
        i = int(above[0])
        if i == 0:
            return float(axis.values[0] * (level / size[0]) ** (1 / axis.rates[quantity]))
        share = np.log(level / size[i - 1]) / np.log(size[i] / size[i - 1])
        return float(axis.values[i - 1] * (axis.values[i] / axis.values[i - 1]) ** share)

    def _at_place(self, place: Place) -> tuple[Array, Array]:
        frictionless = next((axis.values == (0.0,) for axis in self.axes if axis.name == "friction"), False)
        if frictionless and place.friction:
            # friction leaves the pressure as it is, but for Goodman's assumption
            value, uncertainty = self._at_place(replace(place, friction=0.0))
            stress = np.array([name not in SCALARS for name in self.quantities])
            return np.where(stress, np.nan, value), uncertainty
        positions = [axis.position(getattr(place, axis.name)) for axis in self.axes]
        scale = np.prod([self._scale(axis, getattr(place, axis.name)) for axis in self.axes], axis=0)
        below = [getattr(place, axis.name) < axis.values[0] * (1 - SAME) for axis in self.axes]
        nodes = [axis.nodes for axis in self.axes]
        # with fewer nodes where the model had no answer at some of four
        for most in (4, 2):
            value, error = interpolated(self._scaled, nodes, positions, below, most)
            if np.isfinite(value).any():
                break
        near = [window(along, x, 2) for along, x in zip(nodes, positions, strict=True)]
        return value * scale, (error + contracted(self.uncertainty / self._scales, near)) * scale

    @cached_property
    def _scaled(self) -> Array:
        return self.change / self._scales

    @cached_property
    def _scales(self) -> Array:
        """Factors that the changes vanish with, at every node."""
        total = np.ones_like(self.change)
        for j, axis in enumerate(self.axes, start=1):
            along = np.stack([self._scale(axis, value) for value in axis.values], axis=1)
            total *= np.expand_dims(along, [i for i in range(1, total.ndim) if i != j])
        return total

    @staticmethod
    def _scale(axis: MapAxis, value: float) -> Array:
        return np.array([value**rate if rate else 1.0 for rate in axis.rates])


@dataclass(frozen=True)
class AssumptionMaps:
    """The maps of all assumptions, each with its own provenance."""

    maps: tuple[AssumptionMap, ...]

    def of(self, assumption: str) -> AssumptionMap | None:
        """The map of ``assumption``; None where it was not measured."""
        return next((one for one in self.maps if one.assumption == assumption), None)


_FILE = RecordFile(AssumptionMaps, "assumptions.json", (SCHEMA,), "maps of the assumptions", "make it again")
write_maps, read_maps = _FILE.write, _FILE.read
