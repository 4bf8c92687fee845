"""Proven enclosures as the package holds them.

``python tests/tools certify`` of a checkout makes them; reading needs no ball arithmetic.
"""

from dataclasses import dataclass
from decimal import Decimal
from fractions import Fraction
from pathlib import Path

import numpy as np

from verification.problem.array_types import Coatings
from verification.problem.coated_contact import CoatedContact
from verification.running.json_records import RecordFile

SHIPPED = Path(__file__).parent / "shipped"
SCHEMA = "coatcheck-enclosures/1"
WIDTH = 1e-10  # largest relative width that is required of an enclosure
SURFACE, UPPER, LOWER = "surface", "interface 1, upper side", "interface 1, lower side"


@dataclass(frozen=True)
class Bounds:
    """``quantity`` on the axis lies between two decimal numbers, SI.

    line : "contact" of the scalars, otherwise where the axis meets it.
    """

    quantity: str
    line: str
    lower: str
    upper: str

    @property
    def exact(self) -> tuple[Fraction, Fraction]:
        """Lower and upper number as they are written."""
        return Fraction(Decimal(self.lower)), Fraction(Decimal(self.upper))

    @property
    def middle(self) -> float:
        """The nearest binary number to the middle."""
        return float(sum(self.exact) / 2)

    @property
    def width(self) -> float:
        """Relative to the middle, rounded to nearest."""
        return float(self.exact[1] - self.exact[0]) / abs(self.middle)

    def distance(self, value: float) -> float:
        """How far ``value`` lies outside, 0 inside; infinite where it is not finite."""
        if not np.isfinite(value):
            return float("inf")
        lower, upper = self.exact
        return float(max(lower - Fraction(value), Fraction(value) - upper, Fraction(0)))


@dataclass(frozen=True)
class Ring:
    """The pressure [Pa] at ``r`` [m] lies between two decimal numbers."""

    r: float
    lower: str
    upper: str


@dataclass(frozen=True)
class Enclosure:
    """One problem, a rigid sphere without friction, with its bounds.

    profile : bounds of the pressure along the radius, of the problems of published tables.
    bits, terms : precision and number of basis functions of the proof; 0 where a closed form is enclosed.
    """

    name: str
    radius: float
    load: float
    coatings: Coatings
    substrate: tuple[float, float]
    bounds: tuple[Bounds, ...]
    seconds: float
    bits: int = 0
    terms: int = 0
    profile: tuple[Ring, ...] = ()

    @property
    def problem(self) -> CoatedContact:
        """The problem as the sources solve it."""
        return CoatedContact(self.radius, self.load, self.coatings, self.substrate)


@dataclass(frozen=True)
class EnclosureRecord:
    """All enclosures with provenance, processor seconds in total."""

    enclosures: tuple[Enclosure, ...]
    started: str
    seconds: float
    commit: str | None
    machine: str
    versions: dict[str, str]


_FILE = RecordFile(EnclosureRecord, "enclosures.json", (SCHEMA,), "enclosures", "make it again")
write_record, read_record = _FILE.write, _FILE.read
