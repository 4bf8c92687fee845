"""Generated blocks of pages: ``{generated} name`` is replaced by what ``BLOCKS[name]`` returns.

Every number comes from the baseline or a record of this version.
"""

import re
from collections.abc import Callable, Sequence
from datetime import datetime
from pathlib import Path

import numpy as np

from verification.cases.case_file import read_case, shipped_cases
from verification.cases.published_file import published_cases, read_published
from verification.evidence import alarm_record
from verification.evidence.assumption_maps import WORDS as WORDS_OF_AXES
from verification.evidence.assumption_maps import AssumptionMap, read_maps
from verification.evidence.enclosure_record import read_record as read_enclosures
from verification.evidence.fault_record import read_record
from verification.guests.pages.guests_section import COLUMNS, examined
from verification.manual.baseline_numbers import FOLDER, baseline, largest, pairs
from verification.manual.markdown_text import symbol, table, text
from verification.manual.tour_output import solved
from verification.manual.worked_examples import WORKED
from verification.page.number_text import scientific, seconds
from verification.problem.quantity import QUANTITIES
from verification.sources.source_registry import METHODS, SOURCES

SOURCE = Path(__file__).parent / "source"
RECORDS = FOLDER.parents[1] / "evidence" / "shipped"
FIELDS = ("stress", "pressure", "displacement")
WORDS_OF_MAPS = {
    "contact_radius": "contact radius",
    "approach": "approach",
    "peak_pressure": "peak pressure",
    "tension": r"$\sigma_{xx}$ at the trailing edge",
    "shear": r"largest $|\sigma_{xz}|$ on the interface",
}


def headline() -> str:
    """The largest differences of every case of the default run."""
    rows = []
    for path in shipped_cases().values():
        case = read_case(path)
        found = [p for p in pairs(case.name) if p.between == METHODS]
        cells = [
            scientific(next(p.worst for p in found if p.quantity == name), 1)
            for name in ("peak_pressure", "contact_radius", "approach")
        ]
        exact = [largest(case.name, (method, "integral_equation"), *FIELDS) for method in METHODS]
        fields = [scientific(value, 1) for value in (largest(case.name, METHODS, *FIELDS), *exact)]
        count = str(len(pairs(case.name)))
        rows.append([f"[{text(case.title)}](/cases/{case.name}.md)", *cells, *fields, count])
    head = ["case", "$p_0$", "$a$", r"$\delta$", "lines, both methods", "semi-analytical, exact"]
    return _dated() + table([*head, "finite elements, exact", "comparisons"], rows, 1) + f"\n{HEADLINE}"


HEADLINE = r"""
$p_0$, $a$, $\delta$: relative difference between both methods. Lines: the largest difference of stresses and
pressures over the smaller of $p_h$ and $p_0$, of displacements over the smaller of $\delta_h$ and $\delta$.
"""


def totals() -> str:
    """What the default run judges, in one sentence."""
    known = baseline()
    contacts = [name for name in known.cases if not known.published(name)]
    comparisons = sum(len(c.pairs) for name in contacts for c in known.manifests[name].comparisons)
    invariants = sum(len(known.manifests[name].invariants) for name in contacts)
    points = sum(len(p.position) for name in contacts for p in pairs(name))
    return (
        f"The default run solves {len(contacts)} cases. It judges {comparisons} comparisons at {points} "
        f"points and {invariants} invariants; the baseline holds {known.last.numbers} numbers, those of the "
        "published cases included."
    )


def published_counts() -> str:
    """Number of values of each published case, with what departs."""
    rows = []
    for path in published_cases().values():
        case = read_published(path)
        counted = sum(int(item.counted.sum()) for item in case.columns)
        values = sum(len(item.text) for item in case.columns)
        departed = sum(int((item.departure != 0).sum()) for item in case.columns)
        name = f"[{text(case.title)}](/published/{case.name}.md)"
        rows.append([name, str(case.citation["year"]), str(values), str(counted), str(departed)])
    total = ["all", "", *(str(sum(int(row[i]) for row in rows)) for i in (2, 3, 4))]
    head = ["case", "year", "values", "counted", "departures"]
    return table(head, [*rows, total], 1)


def quantities() -> str:
    """Every quantity with name in files, unit, scale, cap."""
    rows = [
        [f"`{q.name}`", symbol(q.name), text(q.meaning), q.kind, q.unit, scientific(q.cap, 1)]
        for q in QUANTITIES.values()
    ]
    return table(["name in files", "symbol", "meaning", "kind", "unit", "cap"], rows, 5)


def sources() -> str:
    """Every source of numbers."""
    rows = [
        [f"`{s.name}`", s.label, s.kind.value, f"`{s.package}`" * bool(s.package)] for s in SOURCES.values()
    ]
    return table(["name in files", "label", "kind", "code"], rows)


def invariants() -> str:
    """Every invariant of the default run: how often judged, at how many points, largest bound."""
    found: dict[str, list[tuple[int, float]]] = {}
    for name, manifest in baseline().manifests.items():
        if not baseline().published(name):
            for law, _, _, points, widest in manifest.invariants:
                plain = re.sub(r"^ball, |, (coating|interface) \d+|, substrate", "", law)
                found.setdefault(plain, []).append((points, widest))
    rows = [
        [law, str(len(all_)), str(sum(n for n, _ in all_)), scientific(max(U for _, U in all_))]
        for law, all_ in sorted(found.items())
    ]
    return table(["invariant", "judged", "residuals", "largest bound"], rows, 1)


def fault_score() -> str:
    """Planted faults: how many are caught, by group."""
    record = read_record(RECORDS)
    if record is None:
        return "No record of planted faults is part of this version."
    groups: dict[str, list[bool]] = {}
    for row in record.rows:
        groups.setdefault(row.group, []).append(row.caught)
    rows = [[text(name), str(len(found)), str(sum(found))] for name, found in groups.items()]
    missed = [[f"`{row.name}`", text(row.description), text(row.reason)] for row in record.survivors]
    line = (
        f"{_day(record.started)}: {record.caught} of {len(record.rows)} planted faults are caught, "
        f"{record.as_predicted} by a check that was named for it beforehand, in {seconds(record.seconds)}; "
        f"with nothing planted {len(record.alarms)} of {len(record.controls)} trials failed a check."
    )
    parts = [line, table(["group", "faults", "caught"], rows, 1)]
    if missed:
        parts += ["Not caught:", table(["fault", "what is changed", "why no check notices"], missed)]
    return "\n\n".join(parts)


def false_alarms() -> str:
    """Verdicts other than AGREES on random problems without an error."""
    record = alarm_record.read_record(RECORDS)
    if record is None:
        return "No record of false alarms is part of this version."
    parts = [
        f"{_day(record.started)}: {len(record.alarms)} false alarms in {record.comparisons} comparisons and "
        f"{record.invariants} invariants of {record.problems} random problems (seed {record.seed}), of which "
        f"{record.agreeing} agree throughout."
    ]
    if record.ratios:
        rows = [
            [SOURCES[r.source].label, str(r.values), f"{r.within:.1%}", f"{r.median:.3g}"]
            for r in record.ratios
        ]
        head = ["method", "values", "error within $U$", "median of $U$ over error"]
        parts.append(table(head, rows, 1))
    return "\n\n".join(parts)


def real_guests() -> str:
    """Codes of others examined: cases, largest differences, time, memory."""
    rows = []
    for one in examined():
        gaps = (one["differences"].get(name) for name in COLUMNS)
        cells = ["–" if gap is None else scientific(max(gap, 1e-15), 1) for gap in gaps]
        low, high = one["seconds"]
        time = seconds(high) if round(low) == round(high) else f"{seconds(low)} to {seconds(high)}"
        memory = "–" if one["memory"] is None else f"{one['memory'] / 1e6:.0f} MB"
        agree = f"{one['agree']} of {one['answered']}"
        rows.append([text(one["guest"]), str(one["cases"]), text(one["levels"]), *cells, time, memory, agree])
    head = ["code", "problems", "levels", "$p_0$", "$a$", r"$\delta$", "$p(r)$", "$u_z$ under a square"]
    caption = "Largest difference from the exact solution; time at the finest level, on a busy machine."
    return table([*head, "time", "memory", "agree"], rows, 3) + f"\n\n{caption}\n"


def history() -> str:
    """Updates of the baseline with their reasons, the last first."""
    rows = [[_day(u.when), str(u.numbers), text(u.why)] for u in reversed(baseline().history)]
    return table(["date", "numbers", "reason"], rows)


def more_pages() -> str:
    """Table of contents of the pages that the index does not name."""
    index = (SOURCE / "index.md").read_text(encoding="utf-8")
    named = set(re.findall(r"^\w+$", index, re.MULTILINE))
    more = [path.stem for path in sorted(SOURCE.glob("*.md")) if path.stem not in {*named, "index"}]
    return "\n".join(["```{toctree}", ":maxdepth: 1", ":caption: More", "", *more, "```"]) if more else ""


def enclosures() -> str:
    """Every enclosed problem with the middle of its bounds, rounded to twelve digits."""
    record = read_enclosures(RECORDS)
    if record is None:
        return "There is no record."
    rows = []
    for one in record.enclosures:
        problem = one.problem
        layers = ", ".join(
            f"({E / one.substrate[0]:g}, {nu:g}, {h / problem.a_h:g})" for E, nu, h in one.coatings
        )
        scales = (problem.a_h, problem.delta_h, problem.p_h)
        values = [f"{b.middle / scale:.12f}" for b, scale in zip(one.bounds, scales, strict=False)]
        width = scientific(max(b.width for b in one.bounds), 1)
        rows.append([f"`{one.name}`", layers or "none", f"{one.substrate[1]:g}", *values, width])
    head = [
        "problem",
        r"layers $(E/E_s, \nu, h/a_h)$",
        r"$\nu_s$",
        "$a/a_h$",
        r"$\delta/\delta_h$",
        "$p/p_h$",
    ]
    return (
        f"Made {_day(record.started)}, commit {record.commit or 'unknown'}, on {record.machine}, in "
        f"{record.seconds:.0f} s with python-flint {record.versions.get('python-flint', 'unknown')}. "
        "$E_s$, $\\nu_s$ of the substrate; $p$ on the axis; the largest relative width of all values of the "
        "problem, $\\sigma_{xx}$ included.\n\n" + table([*head, "width"], rows, 1)
    )


def two_sided() -> str:
    """Energy bounds by finite elements beside the enclosures that they contain."""
    record = read_enclosures(RECORDS)
    rows = []
    for one in record.enclosures if record else ():
        if one.two_sided is not None:
            cells = [f"`{one.name}`"]
            for (low, high), exact, effectivity in one.two_sided.compared:
                ends = (scientific(1 - low / exact, 2), scientific(high / exact - 1, 2))
                cells += [*ends, f"{effectivity:.1f}"]
            rows.append([*cells, f"{one.two_sided.seconds:.0f} s"])
    parts = ["below", "above", "effectivity"]
    head = ["problem", *(f"{which}, {part}" for which in ("$k$", r"$\delta$") for part in parts), "time"]
    return table(head, rows, 1)


def assumption_costs() -> str:
    """What each measured assumption costs over its map, by the coordinate that it grows with."""
    maps = read_maps(RECORDS)
    assert maps is not None
    return "\n\n".join(_costs(one) for one in maps.maps)


def _costs(one: AssumptionMap) -> str:
    """The largest change of each quantity at each value of the axis that drives the change."""
    axis = next((i for i, axis in enumerate(one.axes) if any(axis.rates)), 0)
    values = one.axes[axis].values
    rows = []
    for quantity, change in zip(one.quantities, np.abs(one.change), strict=True):
        along = np.moveaxis(change, axis, 0).reshape(len(values), -1)
        shown = ["–" if np.isnan(some).all() else f"{100 * np.nanmax(some):.2g}" for some in along]
        rows.append([WORDS_OF_MAPS.get(quantity, quantity), *shown])
    ranges = ", ".join(
        f"{WORDS_OF_AXES[axis.name]} {axis.values[0]:g}"
        + (f" to {axis.values[-1]:g}" if len(axis.values) > 1 else "")
        for axis in one.axes
        if axis.name != "ball" or axis.values != (0.0,)
    )
    head = [f"{WORDS_OF_AXES[one.axes[axis].name]} = {value:g}" for value in values]
    return (
        f"{one.title[0].upper()}{one.title[1:]}: the largest relative change in percent, over {ranges}. Made "
        f"{_day(one.started)}, commit {one.commit or 'unknown'}, on {one.machine}, in {one.seconds:.0f} s of "
        "one core.\n\n" + table(["quantity", *head], rows, 1)
    )


def _dated() -> str:
    last = baseline().last
    return f"Baseline of {_day(last.when)}, commit {last.commit or 'unknown'}, on {last.machine}.\n\n"


def _day(when: str) -> str:
    return datetime.fromisoformat(when).date().isoformat()


_ALL: Sequence[Callable[[], str]] = (
    headline,
    totals,
    published_counts,
    quantities,
    sources,
    invariants,
    fault_score,
    false_alarms,
    real_guests,
    history,
    solved,
    enclosures,
    two_sided,
    assumption_costs,
    more_pages,
)
BLOCKS: dict[str, Callable[[], str]] = {block.__name__: block for block in _ALL} | WORKED
