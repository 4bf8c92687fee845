"""Maps of what each assumption costs, over a coating's moduli, thickness, contact width, friction.

``coatcheck assumptions --record`` makes them. A rigid ball on one coating of the substrate's Poisson ratio:

    parabola : a_h/R, f, E1/E2, h/a_h at nu = 0.3;   Goodman : f, E1/E2, h/a_h, nu, whatever a/R.
"""

from collections.abc import Iterator
from dataclasses import astuple, dataclass, fields
from itertools import product

from verification.credibility.model.error import GOODMAN, KNOWN, PARABOLA
from verification.problem.contact import CoatedContact
from verification.running.records import RecordFile
from verification.sources.assumptions.change import Change

SCHEMA = "coatcheck-assumptions/1"
QUANTITIES = tuple(field.name for field in fields(Change))
RATIOS = (0.1, 0.25, 0.5, 1.0, 2.0, 4.0, 10.0)  # E1/E2
THICKNESSES = (0.1, 0.2, 0.5, 1.0, 2.0)  # h/a_h
POISSON = (0.2, 0.3, 0.45)
FRICTION = (0.1, 0.3, 0.6, 1.0)
WIDTHS = (0.003, 0.03, 0.1, 0.3)  # a_h/R
SUBSTRATE, RADIUS = 210e9, 10e-3
DIGITS = 5


@dataclass(frozen=True)
class Place:
    """A problem of the maps by its ratios: E1/E2, h/a_h, nu of both materials, a_h/R, f."""

    ratio: float
    thickness: float
    nu: float
    width: float
    friction: float

    @property
    def problem(self) -> CoatedContact:
        """With a steel's modulus below and a ball of 10 mm; the costs depend on neither."""
        substrate, a_h = (SUBSTRATE, self.nu), self.width * RADIUS
        load = 4 * a_h**3 * SUBSTRATE / (1 - self.nu**2) / (3 * RADIUS)
        coating = (self.ratio * SUBSTRATE, self.nu, self.thickness * a_h)
        return CoatedContact(RADIUS, load, (coating,), substrate, self.friction)


@dataclass(frozen=True)
class Entry:
    """Relative change of each of ``QUANTITIES`` at a place by ``assumption``, with its uncertainty."""

    assumption: str
    place: Place
    change: tuple[float, ...]
    uncertainty: tuple[float, ...]


@dataclass(frozen=True)
class AssumptionMaps:
    """All entries with provenance, processor seconds in total."""

    entries: tuple[Entry, ...]
    started: str
    seconds: float
    commit: str | None
    machine: str
    versions: dict[str, str]


def places(assumption: str) -> Iterator[Place]:
    """Where ``assumption`` is measured."""
    layers = product(RATIOS, THICKNESSES)
    if assumption == PARABOLA:
        yield from (Place(*layer, 0.3, a, f) for layer in layers for a, f in product(WIDTHS, (0.0, 0.3)))
    if assumption == GOODMAN:
        yield from (
            Place(*layer, nu, WIDTHS[0], f) for layer in layers for nu, f in product(POISSON, FRICTION)
        )


def measure(assumption: str, place: Place) -> Entry:
    """The entry of a place, rounded. Raises ValueError where the assumption's model has no answer."""
    change, uncertainty = (
        [float(f"{v:.{DIGITS}g}") for v in astuple(one)] for one in KNOWN[assumption](place.problem)
    )
    return Entry(assumption, place, tuple(change), tuple(uncertainty))


_FILE = RecordFile(AssumptionMaps, "assumptions.json", (SCHEMA,), "maps of the assumptions", "make it again")
path_in, write_maps, read_maps = _FILE.path_in, _FILE.write, _FILE.read
