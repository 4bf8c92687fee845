"""Parts that the reports of all studies share: figures as files, common sections, the page as a file."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from numpy.typing import NDArray

from verification.page.figures import inline
from verification.page.html_page import render_sections
from verification.page.page_parts import Gallery, Panel, Part, Section, number, table_of, words
from verification.page.source_labels import source_label
from verification.problem.array_types import Coatings
from verification.problem.display_units import radii_text
from verification.running.checked_files import write_atomically
from verification.study.choice.elastic_limits import beyond_elastic
from verification.study.choice.failure_criteria import MODES
from verification.study.pages.study_figures import Drawn, write_drawn
from verification.study.study_plan import Study
from verification.study.thickness_curves import CrossCheck, cross_checks

ASSUMED = (
    "parabolic ball, small strains, linear elasticity, perfect bond, friction that leaves the pressure "
    "unchanged; strengths are independent of each other"
)
Draw = tuple[str, str, Callable[[], list[Drawn]]]  # anchor, title, function that draws the figures


@dataclass(frozen=True)
class Written:
    """The ``page`` of a study and its ``answer``, a line for each coating.

    warnings : a line for each limit of elasticity that a solved point exceeds.
    """

    page: Path
    answer: tuple[str, ...]
    warnings: tuple[str, ...] = ()


def write_page(
    table: Path,
    study: Study,
    folder: Path,
    columns: Mapping[str, NDArray[Any]],
    answer: Sequence[str],
    summary: str,
    first: Section,
    draws: Iterable[Draw],
    failures: Sequence[str],
    facts: Sequence[tuple[str, str]],
    drawing: Callable[[str], None],
) -> Written:
    """NAME.html under ``folder`` on the ``table`` of ``study``: its answer in the ``first`` section, then the
    inputs; the figures, written under ``folder`` too; the cross-checks; what could not be solved.

    columns : of the table.   summary : the line on top.   facts : (name, value) pairs of its head.
    drawing : called with the title of each group of figures before it is drawn. A group that fails may add
    to ``failures``.   Raises StoreError where it cannot be written.
    """
    page, warnings = folder / f"{study.name}.html", beyond_elastic(study, columns)
    sections = [first, _inputs_section(study)]
    for anchor, title, draw in draws:
        drawing(title)
        if found := draw():
            sections.append(_drawn_section(anchor, title, found))
        for one in found:
            write_drawn(one, folder / "figures" / study.name)
    sections.append(_check_section(cross_checks(columns)))
    if failures:
        sections.append(Section("failed", "What could not be solved", [], failures[:200]))
    told = [("implausible", text) for text in study.warnings] + [("beyond", text) for text in warnings]
    head = [("study", study.title), ("source", study.source), *told, *facts]
    footer = f"Written by coatcheck from {table.name} beside this file."
    write_atomically(page, render_sections("coatcheck study", summary, head, sections, footer))
    return Written(page, tuple(answer), warnings)


def _inputs_section(study: Study) -> Section:
    """Every input and assumption in one table."""
    units, bare = study.units, study.bare
    E_ball = "rigid" if study.ball is None else _solid(*study.ball[:2])
    moduli = ", ".join(f"{E / 1e9:.4g}" for E in study.moduli)

    def layers(coatings: Coatings, key: str, first: int = 0) -> list[str]:
        solids = (f"{_solid(E, nu)}, {units.shown_length(h)}" for E, nu, h in coatings)
        return [called(f"{key}.{i}", text) for i, text in enumerate(solids, start=first)]

    def called(key: str, text: str) -> str:
        return f"{study.names[key]}, {text}" if key in study.names else text

    n = study.swept
    own = called(f"coatings.{n}" if study.held else "coating", f"E = {moduli} GPa")
    fixed = {"above": layers(study.held[:n], "coatings"), "below": layers(study.held[n:], "coatings", n + 1)}

    ratios = ", ".join(f"{E / study.substrate[0]:.3g}" for E in study.moduli)
    h = study.thicknesses
    swept = (
        f"{units.shown_length(min(h))} to {units.shown_length(max(h))}, {len(h)} of them, "
        f"{min(h) / bare.a_h:.3g} to {max(h) / bare.a_h:.3g} a_h"
    )
    strengths = study.criteria.given(units.shown_stress)
    stresses = ", ".join(map(units.shown_stress, study.residual))
    lengths = [units.shown_length(one) for one in (bare.a_h, bare.delta_h)]
    scales = f"a_h = {lengths[0]}, p_h = {units.shown_stress(bare.p_h)}, delta_h = {lengths[1]}"
    rows = [
        ("indenter" if study.indenter else "ball", called("ball", f"{radii_text(bare)}, {E_ball}")),
        *(
            (f"coating {i} on the ball", text)
            for i, text in enumerate(layers(study.ball[2] if study.ball else (), "ball.coatings"), start=1)
        ),
        ("load", _load(study)),
        ("substrate", called("substrate", _solid(*study.substrate))),
        ("coating", f"{own} (E1/E2 = {ratios}), nu = {study.coating_nu:g}"),
        *((f"{side} it", "; ".join(held)) for side, held in fixed.items() if held),
        ("thickness", swept),
        ("friction", ", ".join(f"{f:g}" for f in study.frictions)),
        ("residual stress of the coating", stresses.replace("-", "−") or "none"),
        ("uncoated", scales),
        *((f"strength, {mode}", f"{one.text} ({MODES[mode]})") for mode, one in strengths.items()),
        *((key, units.shown_stress(value)) for key, value in study.hardness.items()),
        ("safety factor on every stress", f"{study.criteria.safety:g}"),
        ("assumed", ASSUMED),
    ]
    table = table_of("", rows, [("input", lambda one: one[0]), ("value", lambda one: words(one[1]))])
    return Section("inputs", "Inputs and assumptions", [Part("", [table])])


def _load(study: Study) -> str:
    if study.loads is None:
        return f"{study.load:g} N"
    text = "{:.3g} to {:g} N".format(*study.loads)
    if study.asked_from is None:
        return text
    return f"{text}; extended down from {study.asked_from:g} N, where strengths were exceeded already"


def _check_section(checks: Sequence[CrossCheck]) -> Section:
    """The largest differences of the other sources."""
    if not checks:
        return Section("checks", "Cross-check", [Part("No point was cross-checked.")])
    table = table_of(
        "The largest difference from the semi-analytical method, over a_h, delta_h or the smaller of p_h and "
        "p0, where it occurs, the uncertainty both state there.",
        checks,
        [
            ("source", lambda d: source_label(d.source)),
            ("quantity", lambda d: d.quantity),
            ("points", lambda d: d.points),
            ("largest difference", lambda d: d.largest),
            ("uncertainty of both", lambda d: d.stated),
            ("E1/E2", lambda d: number(d.ratio, "{:.4g}".format)),
            ("h / a_h", lambda d: number(d.h, "{:.3g}".format)),
            ("f", lambda d: number(d.friction, "{:g}".format)),
        ],
        row_css=lambda d: "" if d.largest <= d.stated or d.stated != d.stated else "disagrees",
    )
    return Section("checks", "Cross-check", [Part("", [table])])


def _solid(E: float, nu: float) -> str:
    return f"E = {E / 1e9:.4g} GPa, nu = {nu:g}"


def _drawn_section(anchor: str, title: str, drawings: Sequence[Drawn]) -> Section:
    """The figures of one kind, with what is common to them."""
    panels = [
        Panel(
            d.title,
            inline(d.svg.decode(), f"{d.name}: {d.title}. {d.caption}", css="print"),
            d.caption,
            csv=d.csv,
            file=f"{d.name}.csv",
        )
        for d in drawings
    ]
    captions = {
        "stress": "Lines: semi-analytical method; triangles: finite elements; crosses: exact reference, at "
        "the cross-checked points. ",
        "contact": "Lines, triangles, crosses as above. ",
        "contours": "Sliding in +x. Red bar: the contact; dashed: the interface. All maps of a "
        "coating have the same extent and the same scales. ",
    }
    files = ", ".join(f"{d.name}.pdf" for d in drawings)
    text = f"{captions.get(anchor, '')}For print, in the folder of figures: {files}."
    return Section(anchor, title, [Part("", gallery=Gallery([], panels, text))])
