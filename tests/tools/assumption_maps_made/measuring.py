"""The maps of the assumptions, measured place by place."""

import datetime
import time
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace

import numpy as np
from rich.console import Console

from assumption_maps_made.map_axes import MEASURED
from verification.commands.common.known_folders import RECORDS
from verification.commands.common.shared_options import Flag
from verification.commands.common.task_progress import run_info
from verification.commands.common.terminal import named_table, print_out
from verification.commands.common.terminal_bar import progress_bar
from verification.credibility.model_error import ASSUMPTIONS, QUANTITIES
from verification.evidence.assumption_maps import (
    WORDS,
    AssumptionMap,
    AssumptionMaps,
    MapAxis,
    Place,
    read_maps,
    write_maps,
)
from verification.evidence.judged_source import source_hash
from verification.running.case_result import RunInfo
from verification.sources.assumptions.contact_change import Change

DIGITS = 5


def assumptions(*names: str, record: Flag = False) -> int:
    """Measure the cost of each assumption that all sources share, by models that drop it one at a time.

    Args:
        names: Assumptions, of sphere, goodman, bodies, strains; all of them unless given.
        record: Store each map beside those of the other assumptions.
    """
    table = named_table("assumption", "quantity", "largest change", *WORDS.values())
    for name in names or MEASURED:
        new = _measured(name)
        if record:
            write_maps(RECORDS, with_map(read_maps(RECORDS) or AssumptionMaps(()), new))
        for i, quantity in enumerate(new.quantities):
            table.add_row(name, quantity, *_worst(new, i))
    print_out(table)
    return 0


def _measured(name: str) -> AssumptionMap:
    started, began = datetime.datetime.now(datetime.UTC), time.process_time()
    places = list(MEASURED[name].places())
    with progress_bar(Console(stderr=True)) as bar:
        found = [measure(name, place) for place in bar.track(places, description=name)]
    info = run_info(f"tests/tools assumptions {name}", started, 1)
    return assembled(name, found, replace(info, seconds=round(time.process_time() - began, 1)))


def _worst(one: AssumptionMap, quantity: int) -> tuple[str, ...]:
    """The largest change of a quantity with its place, "any" of what it is independent of."""
    size = np.abs(one.change[quantity])
    if np.isnan(size).all():
        return ("-",) * (1 + len(WORDS))
    where = np.unravel_index(int(np.nanargmax(size)), size.shape)
    at = {axis.name: f"{axis.values[i]:g}" for axis, i in zip(one.axes, where, strict=True)}
    return (f"{one.change[quantity][where]:+.2e}", *(at.get(name, "any") for name in WORDS))


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
    axes = tuple(MapAxis(name, values, stated.rates_of(name)) for name, values in stated.all_axes.items())
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
        source_hash("maps"),
    )
