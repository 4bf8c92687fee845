"""Where the model ends: what each assumption that all sources share costs, as maps."""

from collections.abc import Sequence
from functools import partial
from itertools import product

import numpy as np
from markupsafe import Markup

from verification.credibility.model_error import ASSUMPTIONS
from verification.credibility.model_error import WORDS as NAMES
from verification.evidence.assumption_maps import WORDS, AssumptionMap, AssumptionMaps
from verification.page.figures import ROLES, Sheet
from verification.page.number_text import plain
from verification.page.page_parts import Cell, Gallery, Panel, Part, Section, Table, number, row, written
from verification.problem.array_types import Array
from verification.sources.assumptions.contact_change import SCALARS

LEVELS = (0.001, 0.01, 0.05)
SHADES = (0.15, 0.4, 0.75)
COLOUR, NO_ANSWER = "fem", 0.45
SHORT = {"contact_radius": "a", "approach": "delta", "peak_pressure": "p0"}
THICKNESSES = (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2)  # ticks
USUAL = {"nu": 0.3}  # coordinate of a panel, where the map has it


def section(record: AssumptionMaps | None) -> Section | None:
    """As ``parts``; None without a record."""
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
            reaches = [one.reach(i, LEVELS[1]) for i in _measured(one, scalar=scalar)]
            if known := [reach for reach in reaches if reach is not None]:
                limits.append(f"{_coordinate(one)} = {plain(min(known), 2)} ({one.title})")
        texts.append(f"{words} {'up to ' + ', '.join(limits) if limits else 'all over the maps'}")
    text = (
        f"For the worst coating the model itself is good to {_percent(LEVELS[1])} of {'; of '.join(texts)}."
    )
    missing = [a.title for name, a in ASSUMPTIONS.items() if name not in {one.assumption for one in maps}]
    return f"{text} Not measured: {', '.join(missing)}." if missing else text


def _measured(one: AssumptionMap, *, scalar: bool | None = None) -> list[int]:
    """Indices of the quantities that the map holds, scalars or stresses alone."""
    return [
        i
        for i, name in enumerate(one.quantities)
        if np.isfinite(one.change[i]).any() and scalar in (None, name in SCALARS)
    ]


def _coordinate(one: AssumptionMap) -> str:
    """The coordinate that the change grows with."""
    return WORDS[one.axes[one.driver].name]


def _reaches(maps: Sequence[AssumptionMap]) -> Table:
    """Where each quantity reaches the levels, an assumption below the other."""
    names = list(dict.fromkeys(one.quantities[i] for one in maps for i in _measured(one)))
    rows = []
    for one in maps:
        known = {one.quantities[i]: i for i in _measured(one)}
        for level in LEVELS:
            cells: list[Cell] = []
            for name in names:
                value = one.reach(known[name], level) if name in known else None
                beyond = name in known and not value
                cells.append(Cell("beyond") if beyond else number(value, partial(plain, digits=2)))
            head = f"{one.title}, {_coordinate(one)}" if level == LEVELS[0] else ""
            rows.append(row(head, _percent(level), *cells))
    return Table(
        "Where dropping an assumption changes a quantity by three levels, for the worst coating: tension at "
        "the trailing edge, shear of the first interface.",
        ["assumption", "level", *(SHORT.get(name, name) for name in names)],
        rows,
    )


def _largest(one: AssumptionMap) -> Table:
    rows = []
    for i in _measured(one):
        size = np.abs(one.change[i])
        worst = np.unravel_index(int(np.nanargmax(size)), size.shape)
        where = ", ".join(
            f"{WORDS[axis.name]} = {axis.values[k]:g}"
            for axis, k in zip(one.axes, worst, strict=True)
            if len(axis.values) > 1
        )
        values = (number(float(table[i][worst]), _percent) for table in (one.change, one.uncertainty))
        rows.append(row(NAMES.get(one.quantities[i], one.quantities[i]), *values, where))
    return Table("The largest change of the map.", ["quantity", "largest", "±", "where"], rows)


def _part(one: AssumptionMap) -> Part:
    """The maps of an assumption, with all its numbers as CSV."""
    text = (
        f"Measured {one.started[:10]}, commit {one.commit or 'unknown'}, in {one.seconds:.0f} s of a core on "
        f"{one.machine}, over {', '.join(_extent(axis.name, axis.values) for axis in one.axes)}."
    )
    title = one.title[0].upper() + one.title[1:]
    at = _slice(one)
    x, y, planes = one.plane(at)
    panels = []
    for quantity, plane in zip(one.quantities, planes, strict=True):
        if np.isfinite(plane).any():
            name = NAMES.get(quantity, quantity)
            span = f"from {_percent(float(np.nanmin(plane)))} to {_percent(float(np.nanmax(plane)))}"
            panels.append(Panel(name, _draw(x, y, plane, f"{one.title}: {name}"), span))
    legend = [
        (_tint(COLOUR, 0.0), f"below {_percent(LEVELS[0])}"),
        (_tint("muted", NO_ANSWER), "no answer of the model"),
    ]
    legend += [
        (_tint(COLOUR, shade), f"above {_percent(level)}")
        for level, shade in zip(LEVELS, SHADES, strict=True)
    ]
    fixed = ", ".join(
        f"{WORDS[axis.name]} = {at[axis.name]:g}"
        for axis in one.axes
        if axis.name in at and len(axis.values) > 1
    )
    caption = f"Relative change{f' at {fixed}' if fixed else ''}, linear between the nodes."
    return Part(text, [_largest(one)], Gallery(legend, panels, caption, written(_rows(one))), title)


def _slice(one: AssumptionMap) -> dict[str, float]:
    """Coordinates of the panels: of the driver where a typical change is nearest to the last level."""
    at = {}
    for i, axis in enumerate(one.axes):
        if axis.name in ("thickness", "ratio"):
            continue
        if i == one.driver:
            size = np.median(one.largest[_measured(one)], axis=0)
            at[axis.name] = axis.values[int(np.argmin(np.abs(np.log(np.maximum(size, 1e-12) / LEVELS[-1]))))]
        else:
            usual = USUAL.get(axis.name, axis.values[-1])
            at[axis.name] = axis.values[int(np.argmin(np.abs(np.array(axis.values) - usual)))]
    return at


def _draw(x: Array, y: Array, plane: Array, label: str) -> Markup:
    size = np.ma.masked_invalid(np.abs(plane))
    known = np.where(np.ma.getmaskarray(size), 0.0, 1.0)
    figure = Sheet(320, 250)
    chart = figure.chart((48.0, 5.0, 266.0, 207.5), (x[0], x[-1]), (y[0], y[-1]))
    for z, levels, colour, shades in (
        (known, (-1.0, 0.999), "muted", (NO_ANSWER,)),
        (size, (*LEVELS, 1e9), COLOUR, SHADES),
    ):
        for low, high, shade in zip(levels[:-1], levels[1:], shades, strict=True):
            if ((z > low) & (z <= high)).any():
                chart.axes.contourf(x, y, z, (low, high), colors=[ROLES[colour]], alpha=shade)
    for level in LEVELS:
        if size.min() < level < size.max():
            found = chart.axes.contour(x, y, size, (level,), colors=[ROLES["ink"]], linewidths=0.9)
            lines = [np.asarray(one.vertices, dtype=float) for one in found.get_paths()]
            longest = max(lines, key=lambda line: line.shape[0])
            x_text, y_text = longest[len(longest) // 2]
            chart.note(float(x_text), float(y_text), _percent(level))
    chart.ticks(_ticks(THICKNESSES, x), _ticks((0.1, 0.25, 1, 4, 10), y), WORDS["thickness"])
    chart.note(x[0], y[-1], WORDS["ratio"], by=(4, 13))
    return figure.drawing(f"{label} over {WORDS['thickness']} and {WORDS['ratio']}")


def _tint(colour: str, shade: float) -> Markup:
    """A small piece of a tinted area, for the legend."""
    return Markup(
        '<svg class="swatch" viewBox="0 0 36 10" aria-hidden="true"><rect x="1" y="0" width="34" height="10" '
        'class="f-{} s-muted" stroke-width="1" fill-opacity="{}"/></svg>'
    ).format(colour, shade)


def _ticks(values: tuple[float, ...], shown: Array) -> list[tuple[float, str]]:
    low, high = float(shown[0]) - 1e-9, float(shown[-1]) + 1e-9
    return [(float(np.log(value)), f"{value:g}") for value in values if low <= np.log(value) <= high]


def _extent(name: str, values: tuple[float, ...]) -> str:
    if name == "ball" and values == (0.0,):
        return "a rigid ball"
    return f"{WORDS[name]} = {values[0]:g}" + (f" to {values[-1]:g}" if len(values) > 1 else "")


def _percent(value: float) -> str:
    return f"{100 * value:.2g} %".replace("-", "−")


def _rows(one: AssumptionMap) -> list[list[str]]:
    """Heads, then coordinates, changes, uncertainties of every place of the map."""
    heads = [WORDS[axis.name] for axis in one.axes]
    heads += [text for name in one.quantities for text in (f"change of {name}", f"uncertainty of {name}")]
    count = len(one.quantities)
    both = np.stack([one.change.reshape(count, -1), one.uncertainty.reshape(count, -1)], axis=1)
    columns = both.reshape(2 * count, -1)
    places = product(*(axis.values for axis in one.axes))
    return [
        heads,
        *([f"{v:g}" for v in (*at, *values)] for at, values in zip(places, columns.T, strict=True)),
    ]
