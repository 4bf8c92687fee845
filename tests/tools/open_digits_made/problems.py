"""The problems of the open digits, which the package holds: a new data set has the same ones."""

from dataclasses import dataclass
from typing import Any

from verification.guests.vectors import open_digits
from verification.problem.coated_contact import CoatedContact, PrescribedLoad

SEED = 17  # of the problems that the methods check
ELLIPSES = "hertz_ellipse"  # the group, whose problems both methods check


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
        coatings = tuple((one["E"], one["nu"], one["thickness"]) for one in given["coatings"])
        solid = coatings, (given["substrate"]["E"], given["substrate"]["nu"]), given["friction"]
        if "pressure" in given:
            return PrescribedLoad(given["pressure"], given["load_radius"], *solid)
        if "radius" in given:
            return CoatedContact(given["radius"], given["load"], *solid)
        radii = given["radius_x"], given["radius_y"]
        mean = (radii[0] * radii[1]) ** 0.5
        return CoatedContact(mean, given["load"], *solid, indenter=("ellipsoid", radii))


def problems() -> list[VectorProblem]:
    """Every problem, in the order of the data set."""
    stored = open_digits.shipped()["problems"]
    return [VectorProblem(one["name"], one["group"], one["problem"]) for one in stored]
