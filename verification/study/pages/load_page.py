"""The report of a study of loads: critical load of every failure mode, its map over the thickness."""

from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
from matplotlib.ticker import LogLocator, MaxNLocator, NullFormatter

from verification.page.page_parts import Cell, Part, Section, Table, number, row
from verification.problem.array_types import Array
from verification.study.choice.critical_load import BAND, Critical, critical, ramps
from verification.study.choice.failure_criteria import MODES
from verification.study.pages.study_assembly import Draw, Written, write_page
from verification.study.pages.study_figures import (
    COLOUR_OF,
    DASHES,
    Drawn,
    below,
    draw_shares,
    draw_use,
    drawn,
    sheet,
    thickness_axes,
)
from verification.study.pages.thickness_page import rounded
from verification.study.study_plan import Study
from verification.study.study_table import read_columns

WIDE = 8.0  # last load over the first, from which the ramp is drawn on a logarithmic axis


def write_load_report(
    table: Path,
    study: Study,
    folder: Path,
    facts: Sequence[tuple[str, str]] = (),
    *,
    figures: bool = True,
    drawing: Callable[[str], None] = lambda name: None,
) -> Written:
    """Report the ``table`` of a ``study`` of loads as ``write_study_report`` does that of thicknesses.

    Raises StoreError where the table cannot be read or the folder not written, ValueError without strengths.
    """
    columns = read_columns(table)
    assert study.loads is not None
    found = [critical(ramp, study.criteria, study.loads[:2]) for ramp in ramps(columns)]
    draws: list[Draw] = []
    if figures and found:
        draws = [
            ("map", "Critical load against thickness", lambda: _maps(study, found)),
            ("ramp", "Load ramp", lambda: _tracks(study, found)),
        ]
    said = answers(study, found)
    failed = np.flatnonzero(columns["status"] != "solved")
    failures = sorted({f"h = {columns['thickness'][i]:.4g} m: {columns['failure'][i]}" for i in failed})
    first = Section("critical", "Critical loads", [Part(text) for text in said] + [_table(study, found)])
    summary = said[0] if said else f"No answer: no ramp of {study.title} has four solved loads."
    return write_page(table, study, folder, columns, said, summary, first, draws, failures, facts, drawing)


def answers(study: Study, found: Sequence[Critical]) -> list[str]:
    """For each coating and thickness the critical load at the friction where it is lowest."""
    said = []
    several = len({one.ramp.ratio for one in found}) > 1
    for one in _weakest(found):
        coating = f"E1/E2 = {one.ramp.ratio:.3g}, " if several else ""
        name = f"{coating}{study.units.shown_length(one.ramp.thickness)}, f = {one.ramp.friction:g}"
        said.append(f"{name}: {_said(one)}.")
    return said


def _weakest(found: Sequence[Critical]) -> list[Critical]:
    """The lowest critical load by coating and thickness, at the highest friction of equal ones."""
    weakest: dict[tuple[float, float], Critical] = {}
    for one in sorted(found, key=lambda one: (one.first[1], one.first[0], -one.ramp.friction)):
        weakest.setdefault((one.ramp.ratio, one.ramp.thickness), one)
    return [weakest[key] for key in dict.fromkeys((one.ramp.ratio, one.ramp.thickness) for one in found)]


def _said(one: Critical) -> str:
    mode, last = one.mode, one.load[-1]
    low, middle, high = one.first
    if mode is None and one.unresolved:
        at = _newtons(middle, float("nan"), one)
        reached = [MODES[mode] for mode, (_, load, _) in one.of.items() if load == middle]
        return f"{at}, the first mode is not resolved among: {', '.join(reached)}"
    if mode is None:
        return f"no stress reaches its strength up to {last:.3g} N"
    U = one.uncertainty[mode]
    share = one.share[mode] / (sum(one.share.values()) + one.unresolved)
    first = f"{MODES[mode]} first" + (f", in {100 * share:.0f} % of the failures" if share < 0.995 else "")
    if middle == 0:
        rest = ", without any load, by the residual stress" if mode in one.at_rest else ""
        return f"below {one.load[0]:.3g} N {first}{rest}"
    text = f"critical load {_newtons(middle, U, one)}"
    if low != high:
        least = _newtons(low, U, one).removesuffix(" N")
        text += f" ({least} to {_newtons(high, U, one)} in 90 % of the strengths)"
    return f"{text}: {first}"


def _newtons(value: float, uncertainty: float, one: Critical) -> str:
    if value == 0:
        return f"below {one.load[0]:.3g} N"
    return f"above {one.load[-1]:.3g} N" if not np.isfinite(value) else f"{rounded(value, uncertainty)} N"


def _table(study: Study, found: Sequence[Critical]) -> Part:
    units, rows = study.units, []
    reached = [(each, mode) for each in found for mode in each.of if np.isfinite(each.of[mode][0])]
    for one, mode in reached:
        ramp, U, quantiles = one.ramp, one.uncertainty[mode], one.of[mode]
        # the median, where it is reached within the ramp, and the peak pressure there
        middle = quantiles[1] if 0 < quantiles[1] < np.inf else None
        p0 = middle and float(np.interp(np.log(middle), np.log(ramp.load), ramp.p0)) / units.pascal
        rows.append(
            row(
                number(ramp.ratio, "{:.4g}".format),
                number(ramp.thickness / units.metre, "{:.4g}".format),
                number(ramp.friction, "{:g}".format),
                Cell(mode, note=MODES[mode]),
                *(Cell(_newtons(load, U, one).removesuffix(" N"), load) for load in quantiles),
                middle and U,
                number(p0, "{:.3g}".format),
                number(one.share[mode], "{:.0%}".format),
            )
        )
    heads = ["E1/E2", f"h [{units.length}]", "f", "mode", *(f"{100 * share:g} %" for share in BAND)]
    table = Table(
        "Critical load [N] of each failure mode whose strength some sample reaches within the ramp: its 5 %, "
        "50 %, 95 % quantiles, the numerical uncertainty of the median, the peak pressure there; last the "
        "probability that this mode is the first, none where several are reached below the ramp.",
        [*heads, "±", f"p0 [{units.stress}]", "first"],
        rows,
    )
    return Part("", [table])


def _groups(found: Sequence[Critical]) -> dict[tuple[float, float], list[Critical]]:
    """The critical loads by E1/E2 and friction, over the thickness."""
    groups: dict[tuple[float, float], list[Critical]] = {}
    for one in sorted(found, key=lambda one: one.ramp.thickness):
        groups.setdefault((one.ramp.ratio, one.ramp.friction), []).append(one)
    return groups


def _maps(study: Study, found: Sequence[Critical]) -> list[Drawn]:
    """Critical load of each mode over the thickness, with the band of 90 % of the strengths."""
    drawings, units = [], study.units
    for (ratio, friction), members in _groups(found).items():
        if len(members) < 2:
            continue
        modes = [mode for mode in members[0].of if any(np.isfinite(one.of[mode][0]) for one in members)]
        h = np.array([one.ramp.thickness / units.metre for one in members])
        low, high = members[0].load[0], members[0].load[-1]
        bands = {mode: np.array([one.of[mode] for one in members]) for mode in modes}
        heads = [f"{mode}, {share:.0%} [N]" for mode in modes for share in BAND]
        rows = [[f"h [{units.length}]", *heads], *np.column_stack([h, *bands.values()])]

        def shown(load: Array, low: float = low, high: float = high) -> Array:
            return np.where(np.isfinite(load), np.maximum(load, low / 10), 10 * high)

        with sheet(80, (len(modes) + 2) // 2, right=4) as figure:
            axes = figure.subplots(1, 1)
            for mode, band in bands.items():
                least, middle, most = shown(band).T
                axes.fill_between(h, least, most, color=COLOUR_OF[mode], linewidth=0, alpha=0.27)
                axes.plot(h, middle, color=COLOUR_OF[mode], label=mode, marker=".", markersize=3)
            first = shown(np.array([one.first[1] for one in members]))
            axes.plot(h, first, color="black", linewidth=0.9, linestyle=DASHES[1], label="first of all")
            axes.set_yscale("log")
            axes.set_ylim(0.9 * low, 1.1 * high)
            axes.yaxis.set_major_formatter(lambda y, _: f"{y:g}")
            axes.set_ylabel("critical load [N]")
            axes.grid(visible=True, which="both")
            thickness_axes([axes], study.bare.a_h / units.metre, units)
            below(figure, axes.get_legend_handles_labels()[0], 2)
            title = f"Critical load, E1/E2 = {ratio:.4g}, f = {friction:g}"
            caption = f"Bands: 90 % of the strengths. h/a_h at {study.load:g} N."
            drawings.append(drawn(figure, f"critical_{ratio:.4g}_f{friction:g}", title, caption, rows))
    return drawings


def _tracks(study: Study, found: Sequence[Critical]) -> list[Drawn]:
    """Tracks as of a scratch test: stress over strength along the ramp with Lc marked, then the failures.

    For each coating and thickness at the friction with the lowest critical load.
    """
    drawings, units = [], study.units
    strengths = study.criteria.given()
    for one in _weakest(found):
        ramp = one.ramp
        use = {
            mode: study.criteria.safety * ramp.at(one.load, mode) / float(strength.quantile(0.5))
            for mode, strength in strengths.items()
        }
        with sheet(104, (len(use) + 1) // 2, right=4) as figure:
            upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=(2, 1))
            draw_use(upper, one.load, use)
            for mode, colour in ((mode, COLOUR_OF[mode]) for mode in use):
                if one.load[0] < one.of[mode][1] <= one.load[-1]:
                    upper.plot([one.of[mode][1]], [1.0], "v", color=colour, markersize=5)
            upper.set_ylim(0, max(1.4, min(2.5, max(float(u.max()) for u in use.values()))))
            # below the ramp, in grey, several modes without a first
            draw_shares(lower, one.load, one.fails, rest=one.unresolved)
            lower.set_ylabel("probability\nof failure")
            lower.set_xlabel("load [N]")
            lower.set_xlim(one.load[0], one.load[-1])
            wide = one.load[-1] > WIDE * one.load[0]
            if wide:
                lower.set_xscale("log")
            # after the scale, which would replace its locator and formatter
            top = upper.secondary_xaxis("top", functions=_pressure(ramp.load, ramp.p0 / units.pascal))
            top.xaxis.set_major_locator(MaxNLocator(5))
            if wide:
                for axis in (lower.xaxis, top.xaxis):
                    axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
                    axis.set_major_formatter(lambda value, _: f"{value:g}")
                    axis.set_minor_formatter(NullFormatter())
            top.set_xlabel(f"peak pressure $p_0$ [{units.stress}]")
            below(figure, upper.get_legend_handles_labels()[0], 2)
            heads = ["load [N]", *(f"{mode} over strength" for mode in use)]
            heads += [f"{mode} failed first" for mode in use]
            some = np.linspace(0, one.load.size - 1, 81).astype(int)
            rows = [heads, *np.column_stack([one.load, *use.values(), *one.fails.values()])[some]]
            h = units.shown_length(ramp.thickness)
            title = f"Load ramp, E1/E2 = {ramp.ratio:.4g}, {h}, f = {ramp.friction:g}"
            caption = (
                "Triangles: critical loads at median strength. Below: probability of failure, by first mode."
            )
            name = f"ramp_{ramp.ratio:.4g}_{ramp.thickness / units.metre:.4g}"
            drawings.append(drawn(figure, name, title, caption, rows))
    return drawings


def _pressure(load: Array, p0: Array) -> tuple[Callable[[Array], Array], Callable[[Array], Array]]:
    """From a load to its peak pressure and back, both by power laws between the points and beyond."""
    slope = np.log(p0[-1] / p0[0]) / np.log(load[-1] / load[0])
    x, y = np.log(load), np.log(p0)

    def through(a: Array, b: Array, rise: float, value: Array) -> Array:
        at = np.log(np.maximum(value, 1e-9))
        beyond = np.minimum(at - a[0], 0) + np.maximum(at - a[-1], 0)
        return np.exp(np.interp(at, a, b) + rise * beyond)

    return (lambda v: through(x, y, slope, v)), (lambda v: through(y, x, 1 / slope, v))
