"""The report of a study: figures for a paper beside one page that describes them."""

import base64
from collections.abc import Sequence
from functools import partial
from pathlib import Path

from markupsafe import Markup

from verification.report.html.templates import render_sections
from verification.report.study.contours import contour_figure, nearest
from verification.report.study.figures import (
    Drawn,
    contact_figure,
    governing_figure,
    stress_figures,
    use_figures,
    write_drawn,
)
from verification.report.study.recommendation import near, recommendation_messages
from verification.report.study.summary import agreement_messages, main_messages
from verification.report.tables.cells import Cell, Gallery, Panel, Part, Section, Table, number, row
from verification.report.tables.csv import embedded
from verification.report.tables.labels import source_label
from verification.report.tables.numbers import scientific
from verification.running.store import write_atomically
from verification.study.criteria import MODES, Judged, judged
from verification.study.curves import Curve, Difference, TensionCheck, curves, differences, tension_checks
from verification.study.plan import Study
from verification.study.quantities import QUANTITIES
from verification.study.table import SCALARS, SOURCES, read_columns

CONTOURS = (0.1, 0.5, 2.0)  # h/a_h; the solved ones nearest to these


def write_study_report(
    table: Path, study: Study, folder: Path, facts: Sequence[tuple[str, str]] = (), *, maps: bool = True
) -> Path:
    """Draw the ``table`` of ``study``: NAME.html, figures/NAME/*.pdf, .png, .csv under ``folder``.

    facts : more (name, value) pairs for the head of the page.   maps : solve for contour maps too.
    Returns the page. Raises StoreError where the table cannot be read or the folder not written.
    """
    columns = read_columns(table)
    every = curves(columns)
    found = [c for c in every if c.h.size >= 2]
    judgements = [judged(c, study.criteria) for c in found]
    checks = differences(columns)
    groups: list[tuple[str, str, list[Drawn]]] = []
    failures: list[str] = []
    if found:
        groups = [
            ("stress", "Stress against thickness", stress_figures(found)),
            ("use", "Stress over strength", use_figures(judgements)),
            ("governing", "Governing failure mode", governing_figure(judgements)),
            ("contact", "The contact against thickness", contact_figure(found)),
        ]
        if maps:
            drawn, failures = _maps(study, found)
            groups.insert(3, ("contours", "In the x-z plane", drawn))
    for _, _, drawings in groups:
        for drawing in drawings:
            write_drawn(drawing, folder / "figures" / study.name)
    sections = [
        _preference(study, judgements),
        _summary(found, checks),
        *(_drawn_section(*group) for group in groups if group[2]),
        *_checks(checks, tension_checks(columns)),
        Section("extremes", "Extremes of every curve", [_extremes(found)]),
        *_failed(every, failures),
    ]
    p_h, a_h = (found[0].p_h, found[0].a_h) if found else (float("nan"), float("nan"))
    head = [
        ("study", study.title),
        ("sphere", f"R = {study.radius * 1e3:g} mm, W = {study.load:g} N, {_ball(study)}"),
        ("substrate", f"E = {study.substrate[0] / 1e9:g} GPa, nu = {study.substrate[1]:g}"),
        ("coating", f"nu = {study.coating_nu:g}"),
        ("scales", f"a_h = {a_h * 1e6:.4g} µm, p_h = {p_h / 1e6:.4g} MPa"),
        *(("implausible", message) for message in study.warnings),
        *facts,
    ]
    solved = sum(c.h.size for c in every)
    lost = sum(len(c.failures) for c in every)
    text = f"{solved} points solved" + (f", {lost} could not be" if lost else "") + f": {study.title}"
    page = folder / f"{study.name}.html"
    footer = (
        f"Written by coatcheck from {table.name} beside this file; figures/{study.name} holds PDF, PNG, CSV."
    )
    write_atomically(page, render_sections("coatcheck study", text, head, sections, footer))
    return page


def _summary(found: Sequence[Curve], checks: Sequence[Difference]) -> Section:
    if not found:
        return Section("summary", "Summary of the curves", [], ["No curve has two solved points."])
    texts = [*main_messages(found), *(agreement_messages(checks) or ["No point was cross-checked."])]
    return Section("summary", "Summary of the curves", [Part(text) for text in texts])


def _extremes(found: Sequence[Curve]) -> Part:
    rows, ends = [], ("smallest", "at h / a_h", "largest", "at h / a_h")
    for curve in found:
        for quantity in (*QUANTITIES, *SCALARS):
            (h_low, low), (h_high, high) = curve.extremes(quantity)
            places = "–"
            if quantity in QUANTITIES:
                i = int(curve.stress[quantity].argmax())
                places = f"{curve.x[quantity][i]:.3f}, {curve.z[quantity][i]:.3f}".replace("nan", "–")
            rows.append(
                row(
                    quantity,
                    number(curve.ratio, "{:.4g}".format),
                    number(curve.friction, "{:g}".format),
                    SCALARS.get(quantity, "p_h"),
                    number(low, "{:.5f}".format),
                    number(h_low, "{:.3g}".format),
                    number(high, "{:.5f}".format),
                    number(h_high, "{:.3g}".format),
                    places,
                )
            )
    table = Table(
        "Extremes of every curve among its solved points, and where in the solid the largest lies.",
        ["quantity", "E1/E2", "f", "over", *ends, "x, z over a_h"],
        rows,
    )
    return Part("", [table], folded=f"{len(rows)} rows")


def _preference(study: Study, judgements: Sequence[Judged]) -> Section:
    rows = []
    limited = any(j.limited for j in judgements)
    for j in judgements:
        h, use, mode = j.preferable
        ranges = "; ".join(
            f"{low * j.curve.a_h * 1e6:.3g} – {high * j.curve.a_h * 1e6:.3g}" for low, high in j.admissible
        )
        rows.append(
            row(
                number(j.curve.ratio, "{:.4g}".format),
                number(j.curve.friction, "{:g}".format),
                Cell(f"{'≤ ' if h == j.h[0] else '≥ ' if h == j.h[-1] else ''}{h:.3g}", h),
                Cell(f"{h * j.curve.a_h * 1e6:.3g}", h * j.curve.a_h),
                number(use, "{:.4f}".format),
                Cell(mode, note=MODES[mode]),
                *([ranges or "none"] if limited else []),
                number(j.interpolation_error),
                *_near_cells(j, h, mode),
                css="" if j.admissible or not j.limited else "disagrees",
            )
        )
    table = Table(
        "The preferable thickness of every curve; ≤ and ≥ mark an end of the sweep, beyond which it may lie. "
        "Interpolation error: the largest error at a point interpolated from the others, over the largest "
        "ratio of stress to strength; the curve itself has twice the points. Last: the differences of the "
        "governing stress, over p_h, at the checked thickness nearest to the preferable one.",
        [
            "E1/E2",
            "f",
            "h / a_h",
            "h [µm]",
            "stress / strength" if limited else "stress / p_h",
            "governing mode",
            *(["admissible h [µm]"] if limited else []),
            "interpolation error",
            "checked at",
            "difference, finite elements",
            "difference, exact",
        ],
        rows,
    )
    parts = [Part(study.criteria.description()), *(Part(s) for s in recommendation_messages(judgements))]
    return Section("preferable", "Which thickness", [*parts, Part("", [table])])


def _near_cells(judgement: Judged, h: float, mode: str) -> list[Cell]:
    """The thickness checked next to ``h``, what each other source differs by there; dashes for none."""
    by_source = {one.source: one for one in near(judgement, h, mode)}
    checked = next((by_source[source].h for source in reversed(SOURCES[1:]) if source in by_source), None)
    found = [by_source.get(source) for source in SOURCES[1:]]
    differences = [number(None if one is None else one.difference) for one in found]
    return [number(checked, "{:.3g}".format), *differences]


def _drawn_section(anchor: str, title: str, drawings: Sequence[Drawn]) -> Section:
    panels = [
        Panel(
            d.title,
            Markup(
                '<img class="print" src="data:image/png;base64,{}" alt="{}" loading="lazy"><a class="csv" '
                'href="{}" download="{}.csv.gz" data-csv="{}.csv">Numbers as CSV</a>'
            ).format(
                base64.b64encode(d.png).decode(), f"{d.title}. {d.caption}", embedded(d.csv), d.name, d.name
            ),
            d.caption,
            "wide",
        )
        for d in drawings
    ]
    text = "For print, in the folder of figures: " + ", ".join(f"{d.name}.pdf" for d in drawings) + "."
    return Section(anchor, title, [Part("", gallery=Gallery([], panels, text))])


def _maps(study: Study, found: Sequence[Curve]) -> tuple[list[Drawn], list[str]]:
    """Contours of the most compliant and the stiffest coating at the middle friction."""
    frictions = sorted({c.friction for c in found})
    middle = [c for c in found if c.friction == frictions[len(frictions) // 2]]
    chosen = {min(c.ratio for c in middle), max(c.ratio for c in middle)}
    drawings, failures = [], []
    for curve in (c for c in middle if c.ratio in chosen):
        try:
            drawings.append(contour_figure(study, curve, nearest(curve, CONTOURS)))
        except Exception as error:  # a map that fails is a message on the page
            failures.append(f"contour map of {curve.label}: {' '.join(str(error).split())[:300]}")
    return drawings, failures


def _checks(checks: Sequence[Difference], tensions: Sequence[TensionCheck]) -> list[Section]:
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


def _ball(study: Study) -> str:
    if study.ball is None:
        return "rigid"
    E, nu, coatings = study.ball
    return f"E = {E / 1e9:g} GPa, nu = {nu:g}, {len(coatings) or 'no'} coatings"
