"""Axes over which the map of each assumption is measured, with the model that measures it."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, fields
from itertools import product

from assumption_maps_made.small_strain_cost import of_small_strains
from verification.credibility.model_error import QUANTITIES
from verification.evidence.assumption_maps import Place
from verification.problem.coated_contact import CoatedContact
from verification.sources.assumptions.contact_change import Change, of_goodman, of_sphere
from verification.sources.assumptions.finite_bodies import of_half_spaces

RATIOS = (0.1, 0.25, 0.5, 1.0, 2.0, 4.0, 10.0)  # E1/E2
THICKNESSES = (0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0)  # h/a_h
WIDTHS = (0.003, 0.03, 0.1, 0.3)  # a_h/R
LAYERS = {"ratio": RATIOS, "thickness": THICKNESSES}


@dataclass(frozen=True)
class MapAxes:
    """The map of an assumption: its model and its axes.

    change : change of a contact by dropping the assumption, with the uncertainty; ValueError where there is
        none.
    axes : values of the coordinates of ``Place``; those of no axis are fixed at the values of ``Place``.
    independent_of : coordinates that the change does not depend on.
    rates : exponents with which the change of each quantity vanishes as a coordinate does, one for all or one
        for each of ``QUANTITIES``; the axis excludes 0. The map is read scaled by them, and below its axis.

    Layers of real bodies differ in Poisson's ratio: a map to be read needs an axis of it.
    """

    change: Callable[[CoatedContact], tuple[Change, Change]]
    axes: Mapping[str, tuple[float, ...]]
    independent_of: tuple[str, ...] = ()
    rates: Mapping[str, float | tuple[float, ...]] = field(default_factory=dict)

    @property
    def all_axes(self) -> dict[str, tuple[float, ...]]:
        """Axes of the map by coordinate, one value of a fixed one."""
        fixed = Place()
        return {
            name: self.axes.get(name, (getattr(fixed, name),))
            for name in (one.name for one in fields(Place))
            if name not in self.independent_of
        }

    def places(self) -> Iterator[Place]:
        """Places of the map, the last axis running fastest."""
        names = self.all_axes
        for values in product(*names.values()):
            yield Place(**dict(zip(names, values, strict=True)))

    def rates_of(self, name: str) -> tuple[float, ...]:
        """The rate along coordinate ``name`` of each quantity."""
        rate = self.rates.get(name, 0.0)
        return rate if isinstance(rate, tuple) else (rate,) * len(QUANTITIES)


MEASURED: dict[str, MapAxes] = {
    "sphere": MapAxes(of_sphere, {**LAYERS, "width": WIDTHS, "friction": (0.0, 0.3)}, rates={"width": 2.0}),
    "goodman": MapAxes(
        of_goodman,
        {**LAYERS, "nu": (0.2, 0.3, 0.45), "friction": (0.1, 0.3, 0.6, 1.0)},
        independent_of=("width",),
        rates={"friction": (2.0, 2.0, 2.0, 1.0, 1.0)},
    ),
    "bodies": MapAxes(
        of_half_spaces,
        {
            "ratio": (0.1, 0.5, 1.0, 2.0, 10.0),
            "thickness": (0.02, 0.1, 0.5, 2.0),
            "width": (0.003, 0.03, 0.1, 0.2, 0.3),
            "ball": (0.0, 0.5),
        },
        # at least this one, which the approach has but for a logarithm
        rates={"width": 1.0},
    ),
    "strains": MapAxes(
        of_small_strains,
        {
            "ratio": (0.1, 0.25, 1.0, 4.0, 10.0),
            "thickness": (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0),
            "nu": (0.2, 0.3, 0.45),
            "width": (0.03, 0.1, 0.2, 0.3),
        },
        rates={"width": 1.0},
    ),
}
