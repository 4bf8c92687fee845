"""The report of a study: its answer in words, and figures for a paper beside one page that describes them.

No number of the answer has more digits than its uncertainty supports; limits are rounded to the safe side.
"""

import math
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

from verification.cases.unit_numbers import Units
from verification.page.page_parts import Cell, Part, Section, Table, Value, number, row, words
from verification.study.choice.failure_criteria import MODES
from verification.study.choice.thickness_choice import DRAWN, Choice, End, Range, choice
from verification.study.pages.contour_maps import contour_figures, nearest
from verification.study.pages.study_assembly import Draw, Written, write_page
from verification.study.pages.study_figures import (
    Drawn,
    contact_figure,
    governing_figure,
    stress_figures,
    use_figures,
)
from verification.study.study_plan import Study
from verification.study.study_table import read_columns
from verification.study.thickness_curves import ThicknessCurve, curves

DIGITS = 2  # of a thickness, at most


def rounded(value: float, uncertainty: float, upwards: bool | None = None) -> str:
    """A positive ``value`` in at most ``DIGITS`` digits, none beyond the first of its ``uncertainty``.

    upwards : whether it is rounded up or down; to the nearest for None.
    """
    last = math.floor(math.log10(value)) - DIGITS + 1
    if uncertainty > 0 and math.isfinite(uncertainty):
        last = max(last, math.floor(math.log10(uncertainty)))
    last = min(last, math.floor(math.log10(value)))
    step = 10.0**last
    # 1e-9: a value that is round already stays
    shift = 0.0 if upwards is None else (-1e-9 if upwards else 1e-9)
    steps = value / step + shift
    count = round(steps) if upwards is None else math.ceil(steps) if upwards else math.floor(steps)
    return f"{(count or 1) * step:.{max(-last, 0)}f}"


def answers(choices: Sequence[Choice], units: Units) -> list[str]:
    """The answer for each modulus in a line."""
    return [_answer(one, units, several=len(choices) > 1) for one in choices]


def _answer(found: Choice, units: Units, *, several: bool) -> str:
    frictions = [one.friction for one in found.curves]
    at = f"f = {frictions[0]:g}" + (f" to {frictions[-1]:g}" if len(frictions) > 1 else "")
    name = f"E1/E2 = {found.curves[0].ratio:.3g}: " if several else ""
    if not found.criteria.limited:
        return f"{name}{_even(found, units)} at {at}{_limits(found, found.even)}."
    if not found.ranges:
        mode, friction = found.governing(found.best)
        use = rounded(found.least, found.error)
        return (
            f"{name}no thickness of the sweep keeps every stress below its strength at {at}; even the best, "
            f"{_length(found, found.best, units)}, uses {use} of it: {MODES[mode]} "
            f"(f = {friction:g})."
        )
    parts = []
    for pair in found.ranges:
        parts.append(
            f"{between(found, pair, units, safe=True)} keeps every stress below its strength at {at}"
            f"{_limits(found, pair)}"
        )
    use = rounded(found.least, found.error)
    return f"{name}{'. '.join(parts)}. {_even(found, units)}, at {use} of the strength."


def _even(found: Choice, units: Units) -> str:
    percent = math.ceil(100 * found.tolerance - 1e-9)
    return f"{between(found, found.even, units)} stress the bodies least, within {percent} % of each other"


def between(found: Choice, pair: Range, units: Units, *, safe: bool = False) -> str:
    """ "2 to 10 µm"; inwards where ``safe``, with the ends of the sweep named."""
    low, high = pair
    scale = found.curves[0].a_h / units.metre
    ends = []
    for end, edge, upwards in ((low, found.h[0], True), (high, found.h[-1], False)):
        value, U = (float(edge), 0.0) if end is None else (end.h, end.uncertainty)
        ends.append(rounded(value * scale, U * scale, upwards if safe and end else None))
    swept = [word for word, end in (("thinnest", low), ("thickest", high)) if end is None]
    beyond = f" (the {' and the '.join(swept)} of the sweep)" if swept else ""
    if ends[0] == ends[1] or float(ends[0]) > float(ends[1]):
        return f"about {_length(found, found.best, units)}{beyond}"
    return f"{ends[0]} to {ends[1]} {units.length}{beyond}"


def _length(found: Choice, h: float, units: Units) -> str:
    return f"{rounded(h * found.curves[0].a_h / units.metre, 0.0)} {units.length}"


def _limits(found: Choice, pair: Range) -> str:
    """Cause of each limit, with its share of the samples in which the coating fails there."""
    said = []
    causes = (
        ("The lower limit is where", "the upper limit where") if pair[0] else ("", "The upper limit is where")
    )
    for word, end in zip(causes, pair, strict=True):
        if end is not None:
            said.append(f"{word} {MODES[end.mode]} ({_share(found, end)}f = {end.friction:g})")
    return f". {', '.join(said)}" if said else ""


def _share(found: Choice, end: End) -> str:
    if not found.criteria.scatters:
        return ""
    chances = found.chances(np.array([end.h]))
    if not chances.fails[0]:
        return ""
    share = chances.breaks[found.modes.index(end.mode), 0] / chances.fails[0]
    return f"{100 * share:.0f} % of the failures there, "


CONTOURS = (0.1, 0.5, 2.0)  # h/a_h; the solved ones nearest to these


def write_study_report(
    table: Path,
    study: Study,
    folder: Path,
    facts: Sequence[tuple[str, str]] = (),
    *,
    figures: bool = True,
    drawing: Callable[[str], None] = lambda name: None,
) -> Written:
    """Report the ``table`` of ``study``: NAME.html, figures/NAME/*.pdf, .svg, .csv under ``folder``.

    facts : more (name, value) pairs for the head of the page.
    drawing : called with the name of each group of figures before it is drawn.
    Raises StoreError where the table cannot be read or the folder not written.
    """
    columns, units = read_columns(table), study.units
    every = curves(columns)
    found = [c for c in every if c.h.size >= 2]
    ratios = sorted({c.ratio for c in found})
    choices = [choice([c for c in found if c.ratio == ratio], study.criteria) for ratio in ratios]
    failures = [f"{c.label}, h = {h:.4g} a_h: {message}" for c in every for h, message in c.failures]
    draws: list[Draw] = []
    if found and figures:
        draws = [
            ("use", "Stress over strength", lambda: use_figures(choices, units)),
            ("governing", "Governing failure mode", lambda: governing_figure(choices, units)),
            ("stress", "Stress against thickness", lambda: stress_figures(found, units)),
            ("contours", "In the x-z plane", lambda: _maps(study, found, failures)),
            ("contact", "The contact against thickness", lambda: contact_figure(found, units)),
        ]
    said = answers(choices, units)
    solved, lost = (sum(counts) for counts in ([c.h.size for c in every], [len(c.failures) for c in every]))
    points = ("points", f"{solved} solved" + (f", {lost} could not be" if lost else ""))
    summary = " ".join(said) or f"No answer: no curve of {study.title} has two solved points."
    if len(choices) > 1:  # the first section holds the answer for each
        ends = (f"E1/E2 = {one.curves[0].ratio:.3g}: {between(one, one.even, units)}" for one in choices)
        lowest, *_, highest = ends
        summary = f"{lowest} stress the bodies least; {highest}."
    first, about = _preference(study, choices, said), [points, *facts]
    return write_page(table, study, folder, columns, said, summary, first, draws, failures, about, drawing)


def _preference(study: Study, choices: Sequence[Choice], said: Sequence[str]) -> Section:
    units, limited, rows = study.units, study.criteria.limited, []
    for every in choices:
        # Each choice of the answer, then that of each friction alone.
        for one in (every, *(choice([c], study.criteria) for c in every.curves if len(every.curves) > 1)):
            frictions, (mode, _) = [curve.friction for curve in one.curves], one.governing(one.best)
            ranges = [between(one, one.even, units)]
            ranges += [between(one, ends, units, safe=True) for ends in one.ranges]
            even, *admissible = (text.replace(f" {units.length}", "") for text in ranges)
            rows.append(
                row(
                    number(one.curves[0].ratio, "{:.4g}".format),
                    _ends(frictions),
                    even,
                    number(one.tolerance, "{:.1%}".format),
                    Cell(rounded(one.least, one.error), one.least),
                    Cell(mode, note=MODES[mode]),
                    *([words("; ".join(admissible) or "none")] if limited else []),
                    css="" if one.ranges or not limited else "disagrees",
                )
            )
    heads = ["E1/E2", "f", f"best h [{units.length}]", "tolerance"]
    heads += ["stress / strength" if limited else "stress / p_h", "governing mode"]
    table = Table(
        "The thicknesses that are equally good, at all frictions together and at each alone: their largest "
        "stress exceeds the smallest by no more than the tolerance, 1 % or the error of interpolation.",
        [*heads, *([f"admissible h [{units.length}]"] if limited else [])],
        rows,
    )
    texts = [*(said if len(said) > 1 else []), study.criteria.description()]
    parts = [*(Part(text) for text in texts), Part("", [table])]
    return Section("preferable", "Which thickness", [*parts, *_chances(study, choices)])


def _ends(frictions: Sequence[float]) -> Value:
    first, last = frictions[0], frictions[-1]
    return number(first, "{:g}".format) if len(frictions) == 1 else f"{first:g} to {last:g}"


def _chances(study: Study, choices: Sequence[Choice]) -> list[Part]:
    """Probabilities that each mode governs, at the limits and at the best thickness of each coating."""
    if not study.criteria.scatters:
        return []
    rows = []
    for one in choices:
        places = {"best": one.best}
        for low, high in one.ranges:
            places |= {"lower limit": low.h} if low else {}
            places |= {"upper limit": high.h} if high else {}
        chances = one.chances(np.array([*places.values()]))
        curve = one.curves[0]
        for k, (what, h) in enumerate(places.items()):
            rows.append(
                row(
                    number(curve.ratio, "{:.4g}".format),
                    what,
                    number(h * curve.a_h / study.units.metre, "{:.3g}".format),
                    *(number(share, "{:.0%}".format) for share in (*chances.governs[:, k], chances.fails[k])),
                )
            )
    table = Table(
        f"Probability that each mode governs and that any stress exceeds its strength, by {DRAWN} samples "
        "of the strengths at the worst friction; standard error below 0.4 %.",
        ["E1/E2", "at", f"h [{study.units.length}]", *choices[0].modes, "fails"],
        rows,
    )
    return [Part("", [table], title="Probabilities")]


def _maps(study: Study, found: Sequence[ThicknessCurve], failures: list[str]) -> list[Drawn]:
    """Contours of the most compliant and the stiffest coating at the middle friction; below spheres.

    None of a stack.
    """
    if study.held or study.indenter:
        return []
    frictions = sorted({c.friction for c in found})
    middle = [c for c in found if c.friction == frictions[len(frictions) // 2]]
    chosen = {min(c.ratio for c in middle), max(c.ratio for c in middle)}
    drawings = []
    for curve in (c for c in middle if c.ratio in chosen):
        try:
            drawings += contour_figures(study, curve, nearest(curve, CONTOURS))
        except Exception as error:  # a map that fails is a message on the page
            failures.append(f"contour map of {curve.label}: {' '.join(str(error).split())[:300]}")
    return drawings
