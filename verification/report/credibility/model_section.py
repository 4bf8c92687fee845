"""Section on where the model ends: what each assumption that all sources share costs, and up to where."""

from collections.abc import Sequence
from functools import partial

import numpy as np

from verification.credibility.model_error import ASSUMPTIONS
from verification.credibility.model_error import WORDS as NAMES
from verification.evidence.assumption_maps import WORDS, AssumptionMap, AssumptionMaps
from verification.page.number_text import plain
from verification.page.page_parts import Cell, Part, Section, Table, number, row, table_of
from verification.sources.assumptions.contact_change import SCALARS

LEVELS = (0.001, 0.01, 0.05)
SHORT = {"contact_radius": "a", "approach": "delta", "peak_pressure": "p0"}


def section(record: AssumptionMaps | None) -> Section | None:
    """Conclusion and maps as a section; None without a record."""
    if record is None or not record.maps:
        return None
    return Section("model", "Where the model ends", parts(record.maps))


def parts(maps: Sequence[AssumptionMap]) -> list[Part]:
    """A conclusion with the reach of each assumption, then a part for each of its ``maps``."""
    return [Part(_conclusion(maps), [_reaches(maps)]), *map(_part, maps)]


def _conclusion(maps: Sequence[AssumptionMap]) -> str:
    """Up to where the model is good to 1 %, for the worst coating; what was not measured."""
    texts = []
    for words, scalar in (("p0, delta and the contact radius", True), ("the stresses", False)):
        limits = []
        for one in maps:
            found = [i for i in _measured(one) if (one.quantities[i] in SCALARS) is scalar]
            if known := [reach for i in found if (reach := one.reach(i, LEVELS[1])) is not None]:
                limits.append(f"{_driver(one)} = {plain(min(known), 2)} ({one.title})")
        texts.append(f"{words} {'up to ' + ', '.join(limits) if limits else 'all over the maps'}")
    good = (
        f"For the worst coating the model itself is good to {_percent(LEVELS[1])} of {'; of '.join(texts)}."
    )
    missing = [a.title for name, a in ASSUMPTIONS.items() if name not in {one.assumption for one in maps}]
    return f"{good} Not measured: {', '.join(missing)}." if missing else good


def _measured(one: AssumptionMap) -> list[int]:
    """Indices of the quantities that the map holds."""
    return [i for i, change in enumerate(one.change) if np.isfinite(change).any()]


def _driver(one: AssumptionMap) -> str:
    """The coordinate that the change grows with."""
    return WORDS[one.axes[one.driver].name]


def _reaches(maps: Sequence[AssumptionMap]) -> Table:
    """Places at which each quantity reaches the levels, an assumption below the other."""
    names = list(dict.fromkeys(one.quantities[i] for one in maps for i in _measured(one)))
    rows = []
    for one in maps:
        known = {one.quantities[i]: i for i in _measured(one)}
        for level in LEVELS:
            values = [one.reach(known[name], level) if name in known else None for name in names]
            cells = [
                Cell("beyond") if name in known and not value else number(value, partial(plain, digits=2))
                for name, value in zip(names, values, strict=True)
            ]
            head = f"{one.title}, {_driver(one)}" if level == LEVELS[0] else ""
            rows.append(row(head, _percent(level), *cells))
    return Table(
        "Where dropping an assumption changes a quantity by three levels, for the worst coating: tension at "
        "the trailing edge, shear of the first interface.",
        ["assumption", "level", *(SHORT.get(name, name) for name in names)],
        rows,
    )


def _largest(one: AssumptionMap) -> Table:
    """The largest change of each quantity with its uncertainty and its place."""
    places = {
        i: np.unravel_index(int(np.nanargmax(np.abs(one.change[i]))), one.change.shape[1:])
        for i in _measured(one)
    }

    def where(i: int) -> str:
        at = {axis.name: axis.values[k] for axis, k in zip(one.axes, places[i], strict=True)}
        return ", ".join(
            f"{WORDS[axis.name]} = {at[axis.name]:g}" for axis in one.axes if len(axis.values) > 1
        )

    return table_of(
        "The largest change of the map.",
        places,
        [
            ("quantity", lambda i: NAMES.get(one.quantities[i], one.quantities[i])),
            ("largest", lambda i: number(float(one.change[i][places[i]]), _percent)),
            ("±", lambda i: number(float(one.uncertainty[i][places[i]]), _percent)),
            ("where", where),
        ],
    )


def _part(one: AssumptionMap) -> Part:
    """Extent and provenance of the map of an assumption, with its largest changes."""
    ends = {axis.name: dict.fromkeys((axis.values[0], axis.values[-1])) for axis in one.axes}
    extents = [
        f"{WORDS[name]} = {' to '.join(f'{v:g}' for v in some)}"
        for name, some in ends.items()
        if [*some] != [0.0]
    ]
    made = (
        f"Measured {one.started[:10]}, commit {one.commit or 'unknown'}, in {one.seconds:.0f} s of a core on "
        f"{one.machine}, over {', '.join(extents)}."
    )
    return Part(made, [_largest(one)], title=one.title[0].upper() + one.title[1:])


def _percent(value: float) -> str:
    return f"{plain(100 * value, 2)} %"
