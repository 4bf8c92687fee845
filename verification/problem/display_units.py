"""Units in which the numbers of one problem are shown: nm and nN under an AFM tip, um and N under a ball.

A unit of a kind goes with every number of that kind in an answer; moduli and the radius of the ball, which
differ by orders of magnitude from stresses and places, have a prefix of their own.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from math import floor, log10, pi

from verification.problem.coated_contact import CoatedContact

_PREFIXES = {-15: "f", -12: "p", -9: "n", -6: "u", -3: "m", 0: "", 3: "k", 6: "M", 9: "G", 12: "T"}


@dataclass(frozen=True)
class Units:
    """Units in which results are shown: names with the SI value of 1."""

    length: str = "µm"
    metre: float = 1e-6
    stress: str = "MPa"
    pascal: float = 1e6
    force: str = "N"
    newton: float = 1.0

    @classmethod
    def of_contact(cls, problem: CoatedContact, radius: float, peak: float | None = None) -> "Units":
        """Those of a contact of ``radius`` [m] under ``peak`` [Pa], by default the mean pressure.

        Contacts of 0.1 um to 5 mm are shown in um, pressures from 1 MPa in MPa, loads of 0.1 N to 10 kN in N.
        """
        mean = problem.load / (pi * radius**2)
        length, metre = _first([(1e-7, "nm", 1e-9), (5e-3, "um", 1e-6)], radius, ("mm", 1e-3))
        stress, pascal = _first([(1e3, "Pa", 1.0), (1e6, "kPa", 1e3)], peak or mean, ("MPa", 1e6))
        small = [(1e-6, "nN", 1e-9), (1e-3, "uN", 1e-6), (0.1, "mN", 1e-3), (1e4, "N", 1.0)]
        return cls(length, metre, stress, pascal, *_first(small, problem.load, ("kN", 1e3)))

    def shown_stress(self, value: float) -> str:
        """A given stress [Pa] with its unit."""
        return f"{value / self.pascal:.4g} {self.stress}"

    def shown_length(self, value: float, digits: int = 4) -> str:
        """A given length [m] with its unit."""
        return f"{value / self.metre:.{digits}g} {self.length}"

    def shown_force(self, value: float) -> str:
        """A given force [N] with its unit."""
        return f"{value / self.newton:.4g} {self.force}"


def prefixed(value: float, unit: str, digits: int = 4) -> str:
    """A positive number in SI with a prefix: 4.2e11, "Pa" is "420 GPa"; plain letters."""
    factor, letter = prefix_of(value)
    return f"{value / factor:.{digits}g} {letter}{unit}"


def prefix_of(value: float) -> tuple[float, str]:
    """Size and letter of the prefix of a number that is not 0."""
    # The nudge keeps 1000 from being shown as 999.99... thousand.
    power = min(max(3 * floor((log10(abs(value)) + 1e-9) / 3), min(_PREFIXES)), max(_PREFIXES))
    return 10.0**power, _PREFIXES[power]


def radii_text(problem: CoatedContact) -> str:
    """The radius of the ball, or the radii of the gap along x and y under an ellipsoid."""
    if problem.indenter is None or not problem.elliptical:
        return f"R = {prefixed(problem.radius, 'm')}"
    along, across = (prefixed(R, "m") for R in problem.indenter[1])
    return f"R_x = {along}, R_y = {across}"


def _first(
    below: Iterable[tuple[float, str, float]], value: float, other: tuple[str, float]
) -> tuple[str, float]:
    """The unit of the first bound that ``value`` is below."""
    return next(((name, size) for bound, name, size in below if value < bound), other)
