"""Convergence of both methods: errors against the exact reference over resolution."""

from collections.abc import Sequence

from verification.credibility.accuracy_study import CORRECTED, PLAIN, PROBLEM, STAIRCASE
from verification.credibility.refinement_studies import QUANTITIES, Refinement, settled
from verification.judging.invariants import Invariant
from verification.judging.outcome import Outcome
from verification.page.number_text import factor, scientific, seconds
from verification.page.page_parts import Cell, Gallery, Part, Section, Table, number, row
from verification.page.source_labels import OUTCOMES, row_css
from verification.page.svg_loglog import DASHES, DOTS, MIXED, UNKNOWN, Plot, Trail, panels
from verification.problem.quantity import QUANTITIES as QUANTITY
from verification.problem.quantity import SCALARS
from verification.report.figures.line_panels import swatch
from verification.report.report_material import Material
from verification.report.sections.conversion_section import conversion_part
from verification.sources.source_record import Style

_SCALARS = [QUANTITY[name] for name in SCALARS]
_TITLES = {q.symbol: q.symbol for q in _SCALARS} | {
    "pressure": "pressure, L2 over the contact",
    "stress": "stress, axis and interfaces",
}
_SCALES = {q.symbol: "relative" for q in _SCALARS} | {"pressure": "over p0", "stress": "largest, over p_h"}
_SETTINGS = {
    (CORRECTED, True): Style("semi"),
    (CORRECTED, False): Style("semi", DOTS),
    (STAIRCASE, True): Style("other", DASHES),
    (STAIRCASE, False): Style("other", DOTS),
    (PLAIN, True): Style("pair", MIXED),
    ("order 2", True): Style("fem", DOTS, 1.9),
    ("order 3", True): Style("fem", DASHES, 1.9),
    ("order 4", True): Style("fem"),
}


def semianalytic_section(material: Material) -> Section | None:
    """Errors of the semi-analytical method over its grid; None where they were not measured."""
    study = material.evidence.accuracy
    if study is None:
        return None
    grids = [one for one in study.refinements if one.method == "semianalytic"]
    parts = _grid_parts(grids) if any(one.levels for one in grids) else []
    if study.conversions:
        parts.append(conversion_part(study.conversions))
    parts = [*_judged_parts(study.verdicts), *parts]
    failures = [f for f in study.failures if not f.startswith("fem_reference")]
    failures += [one.message for one in study.verdicts if one.outcome is Outcome.DISAGREES]
    return Section("semi-analytical-accuracy", "Semi-analytical accuracy", parts, failures)


def finite_element_section(material: Material) -> Section | None:
    """Errors of the finite elements over their mesh; None where they were not measured."""
    study = material.evidence.accuracy
    elements = [one for one in study.refinements if one.method == "fem_reference"] if study else []
    if study is None or not elements:
        return None
    parts = _element_parts(elements) if any(one.levels for one in elements) else []
    failures = tuple(f for f in study.failures if f.startswith("fem_reference"))
    return Section("finite-element-accuracy", "Finite element accuracy", parts, failures)


def _judged_parts(found: Sequence[Invariant]) -> list[Part]:
    """Each part of the method beside its limit, which counts for the exit code of the run."""
    if not found:
        return []
    rows = [
        row(
            one.name,
            Cell(one.message, css="reason"),
            Cell(OUTCOMES[one.outcome].mark, one.share, f"verdict {OUTCOMES[one.outcome].css}"),
            css=row_css(one.outcome),
        )
        for one in sorted(found, key=lambda one: OUTCOMES[one.outcome].rank)
    ]
    held = sum(one.outcome is Outcome.AGREES for one in found)
    text = (
        f"{held} of {len(found)} judged errors of the method's parts are within their limits: patches alone, "
        "patches with a corrected edge, given pressures on a disc, influence coefficients, each against an "
        "exact solution. A limit that is exceeded makes the run exit with 1."
    )
    table = Table(
        "The parts of the method beside their limits.", ["part", "error", "verdict"], rows, css="verdicts"
    )
    return [Part(text, [table])]


def _grid_parts(studies: Sequence[Refinement]) -> list[Part]:
    caption = (
        "Error against the integral equation over N, the number of patches along a side of the grid, which "
        "is 1.12 times as wide as the contact. Beside each curve its observed slope, as far as the error "
        "falls; a dash where it falls less than threefold, or over less than a doubling of N."
    )
    gallery = _refinement_gallery(studies, "N", (33, 49, 65, 97, 129, 257), caption)
    summary = _grid_summary([one for one in studies if one.levels])
    return [
        Part(
            f"{PROBLEM[0].upper()}{PROBLEM[1:]}. With the corrected edge a smooth pressure is fitted to "
            "the patches near the contact edge; the curves named staircase edge are of constant patches "
            "alone."
        ),
        *map(Part, summary),
        Part("", [_refinement_table(studies, "patches per side")], gallery),
    ]


def _element_parts(studies: Sequence[Refinement]) -> list[Part]:
    caption = (
        "Error against the integral equation over the square root of the number of degrees of freedom, which "
        "grows as the elements shrink: its slope is the order in the size of the elements."
    )
    gallery = _refinement_gallery(studies, "√(degrees of freedom)", (50, 70, 100, 150, 200, 300), caption)
    text = _element_summary([one for one in studies if one.levels])
    return [Part(text, [_refinement_table(studies, "mesh")], gallery)]


def _grid_summary(studies: Sequence[Refinement]) -> list[str]:
    """Where refinement ends, the gain by the corrected edge, the limit of the plain conversion."""
    found = [text for one in studies if one.setting == CORRECTED and (text := _floor(one))]
    by_setting = {one.setting: one for one in studies if one.solid == studies[0].solid}
    best, stairs, paper = (by_setting.get(setting) for setting in (CORRECTED, STAIRCASE, PLAIN))
    if best and stairs:
        here, there = best.levels[-1].errors["pressure"], stairs.levels[-1].errors["pressure"]
        order = stairs.order("pressure")
        speed = "converges" if stairs.falls("pressure") else "does not converge"
        speed += "" if order is None else f" at order {order:.1f}"
        found.append(
            "Without the correction the contact edge is a staircase of patches; the pressure on the "
            f"{stairs.solid} solid {speed}, to {scientific(there)} at {stairs.levels[-1].name}; the "
            f"error with the corrected edge is {scientific(here)} at {best.levels[-1].name}, a factor of "
            f"{factor(there, here)}."
        )
    if paper and stairs and (stuck := [q for q in QUANTITIES if stairs.falls(q) and not paper.falls(q)]):
        found.append(
            f"With the plain conversion of the source paper a finer grid does not reduce {_listed(stuck)}, "
            "dominated by the error of the conversion."
        )
    return found


def _floor(one: Refinement) -> str:
    """The level from which another numerical parameter dominates each error; "" for none."""
    ended: dict[str, list[str]] = {}
    for q in QUANTITIES:
        at = settled([level.errors[q] for level in one.levels])
        if at is not None and at < len(one.levels) - 1:
            ended.setdefault(one.levels[at].name, []).append(q)
    where = "; ".join(f"{_listed(qs)} from {name} on" for name, qs in ended.items())
    solid = f"{one.solid[:1].upper()}{one.solid[1:]}, {one.setting}, the default"
    text = f"{solid}: a finer grid no longer reduces {where}: another numerical parameter dominates there."
    return text if ended else ""


def _element_summary(studies: Sequence[Refinement]) -> str:
    """The gain by the highest order of the elements over the lowest, on the finest mesh."""
    low, high = studies[0], studies[-1]
    worse, better = low.levels[-1].errors, high.levels[-1].errors
    gains = [f"{factor(worse[q], better[q])} in {q}" for q in ("p0", "pressure", "stress")]
    mesh = f"On the {low.solid} solid and the {low.levels[-1].name} mesh"
    text = f"{mesh}, {high.setting} gains over {low.setting} factors of {_listed(gains)}."
    return text if len(studies) > 1 else ""


def _refinement_gallery(
    studies: Sequence[Refinement], coordinate: str, ticks: Sequence[float], caption: str
) -> Gallery:
    styles = [_SETTINGS.get((one.setting, one.solid == studies[0].solid), UNKNOWN) for one in studies]

    def trail(one: Refinement, quantity: str, style: Style) -> Trail:
        order = one.order(quantity)
        return Trail(
            tuple(level.resolution for level in one.levels),
            tuple(level.errors[quantity] for level in one.levels),
            style,
            "–" if order is None else f"−{order:.1f}",
        )

    plots = [
        Plot(
            _TITLES[q],
            f"error of {_TITLES[q]} over {coordinate}, logarithmic",
            f"error, {_SCALES[q]}",
            coordinate,
            ticks,
            [trail(one, q, style) for one, style in zip(studies, styles, strict=True) if one.levels],
        )
        for q in QUANTITIES
    ]
    legend = [
        (swatch(style), f"{one.solid}: {one.setting}") for one, style in zip(studies, styles, strict=True)
    ]
    return Gallery(legend, panels(plots), caption)


def _refinement_table(studies: Sequence[Refinement], level_name: str) -> Table:
    rows = []
    for one in studies:
        name = f"{one.solid}: {one.setting}"
        rows += [
            row(
                name,
                level.name,
                *(number(level.errors[q]) for q in QUANTITIES),
                number(level.seconds, seconds),
            )
            for level in one.levels
        ]
        orders = [one.order(q) for q in QUANTITIES]
        cells = [Cell("–" if o is None else f"{o:.1f}", -1.0 if o is None else o) for o in orders]
        rows.append(row(name, "observed order", *cells, "", css="order"))
    return Table(
        "Errors against the integral equation: p0, a and approach relative, pressure in L2 over the contact "
        "over p0, stress the largest on the axis and on both sides of each interface over p_h.",
        ["solid and setting", level_name, *QUANTITIES, "time"],
        rows,
    )


def _listed(names: Sequence[str]) -> str:
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"
