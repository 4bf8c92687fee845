"""The report of a study: figures for a paper beside one page that describes them."""

from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

from verification.cases.unit_numbers import Units
from verification.page.page_parts import (
    Cell,
    Part,
    Section,
    Table,
    number,
    row,
)
from verification.study.choice.failure_criteria import MODES, Judged, judged
from verification.study.choice.thickness_choice import DRAWN, Choice, choice
from verification.study.largest_stresses import QUANTITIES
from verification.study.pages.contour_maps import contour_figures, nearest
from verification.study.pages.curve_summary import agreement_messages, main_messages
from verification.study.pages.study_assembly import (
    Draw,
    Written,
    check_sections,
    draw_sections,
    failed_section,
    inputs_section,
    write_page,
)
from verification.study.pages.study_figures import (
    Drawn,
    contact_figure,
    governing_figure,
    stress_figures,
    use_figures,
)
from verification.study.pages.thickness_recommendation import (
    answers,
    between,
    checked_messages,
    near,
    rounded,
)
from verification.study.study_plan import Study
from verification.study.study_table import SCALARS, SOURCES, read_columns
from verification.study.thickness_curves import Curve, Difference, curves, differences, tension_checks

__all__ = ["Written", "write_study_report"]

CONTOURS = (0.1, 0.5, 2.0)  # h/a_h; the solved ones nearest to these


def write_study_report(
    table: Path,
    study: Study,
    folder: Path,
    facts: Sequence[tuple[str, str]] = (),
    *,
    figures: bool = True,
    maps: bool = True,
    drawing: Callable[[str], None] = lambda name: None,
) -> Written:
    """Report the ``table`` of ``study``: NAME.html, figures/NAME/*.pdf, .svg, .csv under ``folder``.

    facts : more (name, value) pairs for the head of the page.   maps : solve for contour maps too.
    drawing : called with the name of each group of figures before it is drawn.
    Raises StoreError where the table cannot be read or the folder not written.
    """
    columns, units = read_columns(table), study.units
    every = curves(columns)
    found = [c for c in every if c.h.size >= 2]
    ratios = sorted({c.ratio for c in found})
    choices = [
        choice([judged(c, study.criteria) for c in found if c.ratio == ratio], study.criteria)
        for ratio in ratios
    ]
    checks = differences(columns)
    failures = [f"{c.label}, h = {h:.4g} a_h: {message}" for c in every for h, message in c.failures]
    draws: list[Draw] = []
    if found and figures:
        draws = [
            ("use", "Stress over strength", lambda: use_figures(choices, units)),
            ("governing", "Governing failure mode", lambda: governing_figure(choices, units)),
            ("stress", "Stress against thickness", lambda: stress_figures(found, units)),
            ("contact", "The contact against thickness", lambda: contact_figure(found, units)),
        ]
        if maps:
            draws.insert(3, ("contours", "In the x-z plane", lambda: _maps(study, found, failures)))
    drawings = draw_sections(draws, folder / "figures" / study.name, drawing)
    said = answers(choices, units)
    sections = [
        _preference(study, choices, said),
        inputs_section(study),
        *drawings,
        _summary(found, checks),
        *check_sections(checks, tension_checks(columns)),
        Section("extremes", "Extremes of every curve", [_extremes(found, units)]),
        *failed_section(failures),
    ]
    solved = sum(c.h.size for c in every)
    lost = sum(len(c.failures) for c in every)
    points = ("points", f"{solved} solved" + (f", {lost} could not be" if lost else ""))
    summary = " ".join(said) or f"No answer: no curve of {study.title} has two solved points."
    return write_page(table, study, folder, said, summary, sections, [points], facts)


def _summary(found: Sequence[Curve], checks: Sequence[Difference]) -> Section:
    if not found:
        return Section("summary", "Summary of the curves", [], ["No curve has two solved points."])
    texts = [*main_messages(found), *(agreement_messages(checks) or ["No point was cross-checked."])]
    return Section("summary", "Summary of the curves", [Part(text) for text in texts])


def _extremes(found: Sequence[Curve], units: Units) -> Part:
    rows, ends = [], ("smallest", "at h", "largest", "at h")
    for curve in found:
        size = curve.a_h / units.metre
        for quantity in (*QUANTITIES, *SCALARS):
            (h_low, low), (h_high, high) = curve.extremes(quantity)
            stress = SCALARS.get(quantity, "p_h") == "p_h"
            scale = curve.p_h / units.pascal if stress else getattr(curve, SCALARS[quantity]) / units.metre
            places = "–"
            if quantity in QUANTITIES:
                i = int(curve.stress[quantity].argmax())
                x, z = curve.x[quantity][i] * size, curve.z[quantity][i] * size
                places = f"{x:.2f}, {z:.2f}".replace("nan", "–")
            rows.append(
                row(
                    quantity,
                    number(curve.ratio, "{:.4g}".format),
                    number(curve.friction, "{:g}".format),
                    units.stress if stress else units.length,
                    number(low * scale, "{:.5g}".format),
                    number(h_low * size, "{:.3g}".format),
                    number(high * scale, "{:.5g}".format),
                    number(h_high * size, "{:.3g}".format),
                    places,
                )
            )
    table = Table(
        f"Extremes of every curve among its solved points; thicknesses, and places of the largest, in "
        f"{units.length}.",
        ["quantity", "E1/E2", "f", "unit", *ends, "x, z"],
        rows,
    )
    return Part("", [table], folded=f"{len(rows)} rows")


def _preference(study: Study, choices: Sequence[Choice], said: Sequence[str]) -> Section:
    rows, units = [], study.units
    for every in choices:
        for j in every.judgements:
            one = choice([j], study.criteria)
            _, mode = one.governing(one.best)
            size = j.curve.a_h / units.metre
            even = [
                edge if end is None else end.h for end, edge in zip(one.even, one.h[[0, -1]], strict=True)
            ]
            ranges = "; ".join(between(one, pair, units, safe=True) for pair in one.ranges)
            rows.append(
                row(
                    number(j.curve.ratio, "{:.4g}".format),
                    number(j.curve.friction, "{:g}".format),
                    " – ".join(rounded(h * size, 0.0) for h in even),
                    number(one.tolerance, "{:.1%}".format),
                    Cell(rounded(one.least, one.error), one.least),
                    Cell(mode, note=MODES[mode]),
                    *([ranges or "none"] if j.limited else []),
                    *_near_cells(j, one.best, mode, units),
                    css="" if j.admissible or not j.limited else "disagrees",
                )
            )
    limited = any(one.judgements[0].limited for one in choices)
    table = Table(
        "The thicknesses of every curve that are equally good: their largest stress exceeds the smallest by "
        "no more than the tolerance, 1 % or the error of interpolation. Last: differences of the governing "
        "stress at the checked thickness nearest to the best one.",
        [
            "E1/E2",
            "f",
            f"best h [{units.length}]",
            "tolerance",
            "stress / strength" if limited else "stress / p_h",
            "governing mode",
            *([f"admissible h [{units.length}]"] if limited else []),
            f"checked at h [{units.length}]",
            f"difference, finite elements [{units.stress}]",
            f"difference, exact [{units.stress}]",
        ],
        rows,
    )
    texts = [
        *(said if len(said) > 1 else []),
        study.criteria.description(),
        *checked_messages(choices, units),
    ]
    parts = [*(Part(text) for text in texts), Part("", [table])]
    return Section("preferable", "Which thickness", [*parts, *_chances(study, choices)])


def _chances(study: Study, choices: Sequence[Choice]) -> list[Part]:
    """Probabilities that each mode governs, at the limits and at the best thickness of each coating."""
    if not study.criteria.scatters:
        return []
    rows = []
    for one in choices:
        places = {"best": one.best}
        for low, high in one.ranges:
            places |= {"limit below": low.h} if low else {}
            places |= {"limit above": high.h} if high else {}
        chances = one.chances(np.array([*places.values()]))
        for k, (what, h) in enumerate(places.items()):
            rows.append(
                row(
                    number(one.judgements[0].curve.ratio, "{:.4g}".format),
                    what,
                    number(h * one.judgements[0].curve.a_h / study.units.metre, "{:.3g}".format),
                    *(number(share, "{:.0%}".format) for share in chances.governs[:, k]),
                    number(chances.fails[k], "{:.0%}".format),
                )
            )
    table = Table(
        f"Probability that each mode governs and that any stress exceeds its strength, by {DRAWN} samples "
        "of the strengths at the worst friction; standard error below 0.4 %.",
        ["E1/E2", "at", f"h [{study.units.length}]", *choices[0].judgements[0].modes, "fails"],
        rows,
    )
    return [Part("", [table], title="Probabilities")]


def _near_cells(judgement: Judged, h: float, mode: str, units: Units) -> list[Cell]:
    """The thickness checked next to ``h``, what each other source differs by there; dashes for none."""
    by_source = {one.source: one for one in near(judgement, h, mode)}
    checked = next((by_source[source].h for source in reversed(SOURCES[1:]) if source in by_source), None)
    found = [by_source.get(source) for source in SOURCES[1:]]
    scale = judgement.curve.p_h / units.pascal
    size = judgement.curve.a_h / units.metre
    return [
        number(None if checked is None else checked * size, "{:.3g}".format),
        *(number(None if one is None else one.difference * scale) for one in found),
    ]


def _maps(study: Study, found: Sequence[Curve], failures: list[str]) -> list[Drawn]:
    """Contours of the most compliant and the stiffest coating at the middle friction; none of a stack."""
    if study.above or study.below:
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
