"""The report of a study: figures for a paper beside one page that describes them."""

from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path

import numpy as np

from verification.cases.unit_numbers import Units
from verification.page.page_parts import Cell, Part, Section, Table, Value, number, row, table_of
from verification.page.source_labels import source_label
from verification.study.choice.failure_criteria import MODES, Judged, judged
from verification.study.choice.thickness_choice import DRAWN, Choice, choice
from verification.study.largest_stresses import QUANTITIES
from verification.study.pages.contour_maps import contour_figures, nearest
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
from verification.study.thickness_curves import Curve, curves, differences

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
        *check_sections(differences(columns)),
        Section("extremes", "Extremes of every curve", [_extremes(found, units)]),
        *failed_section(failures),
    ]
    solved = sum(c.h.size for c in every)
    lost = sum(len(c.failures) for c in every)
    points = ("points", f"{solved} solved" + (f", {lost} could not be" if lost else ""))
    summary = " ".join(said) or f"No answer: no curve of {study.title} has two solved points."
    return write_page(table, study, folder, said, summary, sections, [points], facts)


def _extremes(found: Sequence[Curve], units: Units) -> Part:
    rows = []
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
            numbers = zip(
                (low * scale, h_low * size, high * scale, h_high * size), ("5", "3") * 2, strict=True
            )
            rows.append(
                row(
                    quantity,
                    number(curve.ratio, "{:.4g}".format),
                    number(curve.friction, "{:g}".format),
                    units.stress if stress else units.length,
                    *(number(value, f"{{:.{digits}g}}".format) for value, digits in numbers),
                    places,
                )
            )
    table = Table(
        f"Extremes of every curve among its solved points; thicknesses, and places of the largest, in "
        f"{units.length}.",
        ["quantity", "E1/E2", "f", "unit", "smallest", "at h", "largest", "at h", "x, z"],
        rows,
    )
    return Part("", [table], folded=f"{len(rows)} rows")


def _preference(study: Study, choices: Sequence[Choice], said: Sequence[str]) -> Section:
    units = study.units
    curves = [(j, choice([j], study.criteria)) for every in choices for j in every.judgements]
    limited = any(one.judgements[0].limited for one in choices)
    columns: list[tuple[str, Callable[[tuple[Judged, Choice]], Value]]] = [
        ("E1/E2", lambda pair: number(pair[0].curve.ratio, "{:.4g}".format)),
        ("f", lambda pair: number(pair[0].curve.friction, "{:g}".format)),
        (f"best h [{units.length}]", lambda pair: _best(*pair, units)),
        ("tolerance", lambda pair: number(pair[1].tolerance, "{:.1%}".format)),
        (
            "stress / strength" if limited else "stress / p_h",
            lambda pair: Cell(rounded(pair[1].least, pair[1].error), pair[1].least),
        ),
        ("governing mode", lambda pair: Cell(_mode(pair[1]), note=MODES[_mode(pair[1])])),
    ]
    if limited:
        columns.append((f"admissible h [{units.length}]", lambda pair: _admissible(pair[1], units)))
    columns.append((f"checked at h [{units.length}]", lambda pair: _checked_at(*pair, units)))
    columns += [
        (
            f"difference, {source_label(source)} [{units.stress}]",
            partial(_difference, source=source, units=units),
        )
        for source in SOURCES[1:]
    ]
    table = table_of(
        "The thicknesses of every curve that are equally good: their largest stress exceeds the smallest by "
        "no more than the tolerance, 1 % or the error of interpolation. Last: differences of the governing "
        "stress at the checked thickness nearest to the best one.",
        curves,
        columns,
        row_css=lambda pair: "" if pair[0].admissible or not pair[0].limited else "disagrees",
    )
    texts = [
        *(said if len(said) > 1 else []),
        study.criteria.description(),
        *checked_messages(choices, units),
    ]
    parts = [*(Part(text) for text in texts), Part("", [table])]
    return Section("preferable", "Which thickness", [*parts, *_chances(study, choices)])


def _mode(one: Choice) -> str:
    return one.governing(one.best)[1]


def _best(j: Judged, one: Choice, units: Units) -> str:
    ends = [edge if end is None else end.h for end, edge in zip(one.even, one.h[[0, -1]], strict=True)]
    return " – ".join(rounded(h * j.curve.a_h / units.metre, 0.0) for h in ends)


def _admissible(one: Choice, units: Units) -> str:
    return "; ".join(between(one, pair, units, safe=True) for pair in one.ranges) or "none"


def _checked_at(j: Judged, one: Choice, units: Units) -> Cell:
    found = near(j, one.best, _mode(one))
    return number(found[-1].h * j.curve.a_h / units.metre if found else None, "{:.3g}".format)


def _difference(pair: tuple[Judged, Choice], source: str, units: Units) -> float | None:
    """What ``source`` differs by at the checked thickness nearest to the best one; None without any."""
    j, one = pair
    found = {near.source: near.difference for near in near(j, one.best, _mode(one))}
    return found[source] * j.curve.p_h / units.pascal if source in found else None


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
        curve = one.judgements[0].curve
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
        ["E1/E2", "at", f"h [{study.units.length}]", *choices[0].judgements[0].modes, "fails"],
        rows,
    )
    return [Part("", [table], title="Probabilities")]


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
