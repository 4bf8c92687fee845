"""The problems of the open digits, which the package holds: a new data set has the same ones."""

from dataclasses import dataclass
from typing import Any

from verification.guests.vectors import open_digits
from verification.problem.array_types import Coatings
from verification.problem.coated_contact import CoatedContact, PrescribedLoad

SEED = 17  # of the problems that the methods check
# Groups of contacts that are not plain spheres: each method checks as many of the problems of each.
ALWAYS = ("hertz_ellipse", "sliding_ellipse", "elastic_ball")
EACH = {"semianalytic": 6, "fem_reference": 2}


@dataclass(frozen=True)
class VectorProblem:
    """One problem with its ``name`` and the ``group`` it belongs to; ``entry`` as the data set holds it."""

    name: str
    group: str
    entry: dict[str, Any]

    @property
    def problem(self) -> CoatedContact | PrescribedLoad:
        """The problem in SI units."""
        given = self.entry
        solid = *_solid(given), given["friction"]
        if "pressure" in given:
            return PrescribedLoad(given["pressure"], given["load_radius"], *solid)
        if "radius" in given:
            layers, core = _solid(given["ball"]) if "ball" in given else ((), None)
            return CoatedContact(given["radius"], given["load"], *solid, core and (*core, layers))
        radii = given["radius_x"], given["radius_y"]
        mean = (radii[0] * radii[1]) ** 0.5
        return CoatedContact(mean, given["load"], *solid, indenter=("ellipsoid", radii))


def _solid(given: dict[str, Any]) -> tuple[Coatings, tuple[float, float]]:
    coatings = tuple((one["E"], one["nu"], one["thickness"]) for one in given["coatings"])
    return coatings, (given["substrate"]["E"], given["substrate"]["nu"])


def problems() -> list[VectorProblem]:
    """Every problem, in the order of the data set."""
    stored = open_digits.shipped()["problems"]
    return [VectorProblem(one["name"], one["group"], one["problem"]) for one in stored]
