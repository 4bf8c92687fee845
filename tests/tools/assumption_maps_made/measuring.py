"""The maps of the assumptions, measured place by place."""

from collections.abc import Sequence
from dataclasses import asdict, dataclass

import numpy as np

from assumption_maps_made.map_axes import MEASURED
from verification.credibility.model_error import ASSUMPTIONS, QUANTITIES
from verification.evidence.assumption_maps import AssumptionMap, AssumptionMaps, Axis, Place
from verification.running.case_result import RunInfo
from verification.sources.assumptions.contact_change import Change

DIGITS = 5


def with_map(maps: AssumptionMaps, new: AssumptionMap) -> AssumptionMaps:
    """``maps`` with ``new`` in place of its predecessor, in the order of ``ASSUMPTIONS``."""
    found = {one.assumption: one for one in maps.maps} | {new.assumption: new}
    known = [name for name in ASSUMPTIONS if name in found]
    return AssumptionMaps(tuple(found[name] for name in (*known, *(found.keys() - set(known)))))


@dataclass(frozen=True)
class Measured:
    """Change and uncertainty of ``QUANTITIES`` at a place, rounded; NaN where the model has no answer."""

    change: tuple[float, ...]
    uncertainty: tuple[float, ...]


def measure(assumption: str, place: Place) -> Measured:
    """What ``assumption`` costs at ``place``."""
    nothing = (float("nan"),) * len(QUANTITIES)
    try:
        found = MEASURED[assumption].change(place.problem)
    except ValueError:
        return Measured(nothing, nothing)
    return Measured(*(_rounded(one) for one in found))


def _rounded(change: Change) -> tuple[float, ...]:
    return tuple(float("nan") if v is None else float(f"{v:.{DIGITS}g}") for v in asdict(change).values())


def assembled(assumption: str, measured: Sequence[Measured], info: RunInfo) -> AssumptionMap:
    """The map of ``assumption`` from what was ``measured`` at its places, in their order."""
    stated = MEASURED[assumption]
    axes = tuple(Axis(name, values, stated.rates_of(name)) for name, values in stated.all_axes.items())
    shape = (*(len(axis.values) for axis in axes), len(QUANTITIES))
    change, uncertainty = (
        np.moveaxis(np.array([getattr(one, name) for one in measured]).reshape(shape), -1, 0)
        for name in ("change", "uncertainty")
    )
    return AssumptionMap(
        assumption,
        ASSUMPTIONS[assumption].title,
        QUANTITIES,
        axes,
        stated.independent_of,
        change,
        uncertainty,
        info.started,
        info.seconds,
        info.commit,
        info.machine,
        dict(info.versions),
    )
