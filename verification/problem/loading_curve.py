"""A loading curve: a sphere in contact at given contact radii or approaches."""

from dataclasses import dataclass

from verification.problem.array_types import Coatings
from verification.problem.coated_contact import CoatedContact, PrescribedLoad

CONTROLS = ("contact_radius", "approach")


@dataclass(frozen=True)
class LoadingCurve:
    """Rigid sphere of ``radius`` [m] where ``control``, contact_radius or approach, equals each ``at`` [m].

    coatings, substrate as in CoatedContact. Raises ValueError.
    """

    radius: float
    control: str
    at: tuple[float, ...]
    coatings: Coatings
    substrate: tuple[float, float]

    def __post_init__(self) -> None:
        if self.control not in CONTROLS or not self.at or not min(self.at) > 0:
            raise ValueError(
                f"{self.control} = {self.at}; a loading curve needs positive {' or '.join(CONTROLS)}"
            )
        self.contact(1.0)

    @property
    def E_star(self) -> float:
        """E1/(1 - nu1^2) [Pa] of the uppermost layer."""
        E, nu = self.coatings[0][:2] if self.coatings else self.substrate
        return E / (1 - nu**2)

    def contact(self, load: float) -> CoatedContact:
        """The problem at one load [N]."""
        return CoatedContact(self.radius, load, self.coatings, self.substrate)


Problem = CoatedContact | PrescribedLoad | LoadingCurve
