"""The report of a study: figures for a paper beside one page that describes them."""

import base64
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np
from markupsafe import Markup

from verification.cases.units import Units
from verification.report.html.templates import render_sections
from verification.report.study.contours import contour_figures, nearest
from verification.report.study.figures import (
    Drawn,
    contact_figure,
    governing_figure,
    stress_figures,
    use_figures,
    write_drawn,
)
from verification.report.study.recommendation import (
    answers,
    between,
    checked_messages,
    near,
    rounded,
)
from verification.report.study.summary import agreement_messages, main_messages
from verification.report.tables.cells import (
    Cell,
    Gallery,
    Panel,
    Part,
    Row,
    Section,
    Table,
    number,
    row,
    words,
)
from verification.report.tables.csv import embedded
from verification.report.tables.labels import source_label
from verification.report.tables.numbers import scientific
from verification.running.store import write_atomically
from verification.study.choice.criteria import MODES, Judged, judged
from verification.study.choice.thickness import DRAWN, Choice, choice
from verification.study.curves import Curve, Difference, TensionCheck, curves, differences, tension_checks
from verification.study.plan import Study
from verification.study.quantities import QUANTITIES
from verification.study.table import SCALARS, SOURCES, read_columns

CONTOURS = (0.1, 0.5, 2.0)  # h/a_h; the solved ones nearest to these


@dataclass(frozen=True)
class Written:
    """The ``page`` of a study and its ``answer``, a line for each coating."""

    page: Path
    answer: tuple[str, ...]


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
    groups: list[tuple[str, str, list[Drawn]]] = []
    failures: list[str] = []
    if found and figures:
        draws: list[tuple[str, str, Callable[[], list[Drawn]]]] = [
            ("use", "Stress over strength", lambda: use_figures(choices, units)),
            ("governing", "Governing failure mode", lambda: governing_figure(choices, units)),
            ("stress", "Stress against thickness", lambda: stress_figures(found, units)),
            ("contact", "The contact against thickness", lambda: contact_figure(found, units)),
        ]
        if maps:
            draws.insert(3, ("contours", "In the x-z plane", lambda: _maps(study, found, failures)))
        for anchor, title, draw in draws:
            drawing(title)
            groups.append((anchor, title, draw()))
        for _, _, drawings in groups:
            for one in drawings:
                write_drawn(one, folder / "figures" / study.name)
    said = answers(choices, units)
    sections = [
        _preference(study, choices, said),
        inputs_section(study),
        *(drawn_section(*group) for group in groups if group[2]),
        _summary(found, checks),
        *check_sections(checks, tension_checks(columns)),
        Section("extremes", "Extremes of every curve", [_extremes(found, units)]),
        *_failed(every, failures),
    ]
    solved = sum(c.h.size for c in every)
    lost = sum(len(c.failures) for c in every)
    head = [
        ("study", study.title),
        ("points", f"{solved} solved" + (f", {lost} could not be" if lost else "")),
        *(("implausible", message) for message in study.warnings),
        *facts,
    ]
    page = folder / f"{study.name}.html"
    drawn_in = f"; figures/{study.name} holds PDF, SVG, CSV" if groups else ""
    footer = f"Written by coatcheck from {table.name} beside this file{drawn_in}."
    text = " ".join(said) or f"No answer: no curve of {study.title} has two solved points."
    write_atomically(page, render_sections("coatcheck study", text, head, sections, footer))
    return Written(page, tuple(said))


def inputs_section(study: Study) -> Section:
    """Every input and assumption in one table."""
    units, bare = study.units, study.bare
    E_ball = "rigid" if study.ball is None else _solid(*study.ball[:2])
    on_ball = (
        []
        if study.ball is None
        else [f"{_solid(E, nu)}, {units.shown_length(h)}" for E, nu, h in study.ball[2]]
    )
    moduli = ", ".join(f"{E / 1e9:.4g}" for E in study.moduli)
    ratios = ", ".join(f"{E / study.substrate[0]:.3g}" for E in study.moduli)
    h = study.thicknesses
    swept = (
        f"{units.shown_length(min(h))} to {units.shown_length(max(h))}, {len(h)} of them, "
        f"{min(h) / bare.a_h:.3g} to {max(h) / bare.a_h:.3g} a_h"
    )
    strengths = study.criteria.given(units.shown_stress)
    rows = [
        row("ball", f"R = {study.radius * 1e3:g} mm, {E_ball}"),
        *(row(f"coating {i} on the ball", text) for i, text in enumerate(on_ball, start=1)),
        row(
            "load",
            f"{study.load:g} N" if study.loads is None else f"{study.loads[0]:g} to {study.loads[1]:g} N",
        ),
        row("substrate", _solid(*study.substrate)),
        row("coating", f"E = {moduli} GPa (E1/E2 = {ratios}), nu = {study.coating_nu:g}"),
        row("thickness", swept),
        row("friction", ", ".join(f"{f:g}" for f in study.frictions)),
        row(
            "residual stress of the coating",
            ", ".join(units.shown_stress(one) for one in study.residual) or "none",
        ),
        row(
            "uncoated",
            f"a_h = {units.shown_length(bare.a_h)}, p_h = {units.shown_stress(bare.p_h)}, "
            f"delta_h = {units.shown_length(bare.delta_h)}",
        ),
        *(row(f"strength, {mode}", f"{one.text} ({MODES[mode]})") for mode, one in strengths.items()),
        row("safety factor on every stress", f"{study.criteria.safety:g}"),
        row(
            "assumed",
            words(
                "parabolic ball, small strains, linear elasticity, perfect bond, friction that leaves the "
                "pressure unchanged; strengths are independent of each other"
            ),
        ),
    ]
    rows = [Row(one.head, [Cell(cell.text, css="words") for cell in one.cells]) for one in rows]
    return Section("inputs", "Inputs and assumptions", [Part("", [Table("", ["", ""], rows)])])


def load_text(study: Study) -> str:
    """The load of a study, or its range."""
    return f"{study.load:g} N" if study.loads is None else f"{study.loads[0]:g} to {study.loads[1]:g} N"


def _solid(E: float, nu: float) -> str:
    return f"E = {E / 1e9:.4g} GPa, nu = {nu:g}"


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


def drawn_section(anchor: str, title: str, drawings: Sequence[Drawn]) -> Section:
    """The figures of one kind, with what is common to them."""
    panels = [
        Panel(
            d.title,
            Markup(
                '<img class="print" src="data:image/svg+xml;base64,{}" alt="{}" loading="lazy">'
                '<a class="csv" href="{}" download="{}.csv.gz" data-csv="{}.csv">Numbers as CSV</a>'
            ).format(
                base64.b64encode(d.svg).decode(), f"{d.title}. {d.caption}", embedded(d.csv), d.name, d.name
            ),
            d.caption,
            "",
        )
        for d in drawings
    ]
    captions = {
        "stress": "Lines: semi-analytical method; circles: finite elements; crosses: the exact reference, at "
        "the cross-checked points; below, how far these are from the lines. ",
        "contact": "Lines, circles, crosses as above. ",
        "contours": "Sliding in +x. Thick bar: the contact; dashed: the interface. All thicknesses have the "
        "same extent and the same scales. ",
    }
    files = ", ".join(f"{d.name}.pdf" for d in drawings)
    text = f"{captions.get(anchor, '')}For print, in the folder of figures: {files}."
    return Section(anchor, title, [Part("", gallery=Gallery([], panels, text))])


def _maps(study: Study, found: Sequence[Curve], failures: list[str]) -> list[Drawn]:
    """Contours of the most compliant and the stiffest coating at the middle friction."""
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


def check_sections(checks: Sequence[Difference], tensions: Sequence[TensionCheck]) -> list[Section]:
    """The largest differences of the other sources; no section where nothing was checked."""
    if not checks:
        return []
    rows = [
        row(
            source_label(d.source),
            d.quantity,
            number(d.points, str),
            number(d.largest),
            number(d.stated),
            number(d.ratio, "{:.4g}".format),
            number(d.h, "{:.3g}".format),
            number(d.friction, "{:g}".format),
            css="" if d.largest <= d.stated or d.stated != d.stated else "disagrees",
        )
        for d in checks
    ]
    columns = ["source", "quantity", "points", "largest difference", "uncertainty of both"]
    table = Table(
        "The largest difference from the semi-analytical method, over a_h, delta_h or the smaller of p_h and "
        "p0, where it occurs, the uncertainty both state there.",
        [*columns, "E1/E2", "h / a_h", "f"],
        rows,
    )
    every = Part("", [_tension_table(tensions)], folded=f"{len(tensions)} rows")
    return [Section("checks", "Cross-check", [Part("", [table]), every])]


def _tension_table(tensions: Sequence[TensionCheck]) -> Table:
    rows = [
        row(
            source_label(t.source),
            number(t.ratio, "{:.4g}".format),
            number(t.h, "{:.3g}".format),
            number(t.friction, "{:g}".format),
            number(t.tension, "{:.6f}".format),
            number(t.difference, partial(scientific, sign=True)),
            number(t.stated),
            number(t.place, partial(scientific, sign=True)),
            css="" if abs(t.difference) <= t.stated or t.stated != t.stated else "disagrees",
        )
        for t in tensions
    ]
    return Table(
        "The largest tension of the surface by the semi-analytical method at every cross-checked point, "
        "over p_h; the difference of the other source and the uncertainty of both, over the smaller of p_h "
        "and p0; the difference of the places, over a.",
        ["source", "E1/E2", "h / a_h", "f", "tension", "difference", "uncertainty of both", "place"],
        rows,
    )


def _failed(every: Sequence[Curve], more: Sequence[str]) -> list[Section]:
    failures = [f"{c.label}, h = {h:.4g} a_h: {message}" for c in every for h, message in c.failures]
    failures += more
    return [Section("failed", "What could not be solved", [], failures[:200])] if failures else []
