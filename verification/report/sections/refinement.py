"""Convergence of both methods: errors against the exact reference over resolution."""

from collections.abc import Sequence

from verification.credibility.accuracy import CORRECTED, PLAIN, PROBLEM, STAIRCASE
from verification.credibility.refinement import QUANTITIES, Refinement, settled
from verification.problem.quantity import QUANTITIES as QUANTITY
from verification.problem.quantity import SCALARS
from verification.report.figures.loglog import Trail, decades, draw_loglog
from verification.report.figures.panels import swatch
from verification.report.material import Material
from verification.report.sections.conversion import conversion_part
from verification.report.tables.cells import Cell, Gallery, Panel, Part, Row, Section, Table, number
from verification.report.tables.numbers import factor, plain, scientific, seconds
from verification.sources.source import Style

__all__ = ["finite_element_section", "semianalytic_section"]

_SCALARS = [QUANTITY[name] for name in SCALARS]
_TITLES = {q.symbol: q.symbol for q in _SCALARS} | {
    "pressure": "pressure, L2 over the contact",
    "stress": "stress, axis and interfaces",
}
_SCALES = {q.symbol: "relative" for q in _SCALARS} | {"pressure": "over p0", "stress": "largest, over p_h"}
_DOTS, _DASHES, _MIXED = (1.0, 1.4), (3.6, 3.0), (4.5, 1.4, 1.0, 1.4)
_SETTINGS = {
    (CORRECTED, True): Style("semi"),
    (CORRECTED, False): Style("semi", _DOTS),
    (STAIRCASE, True): Style("other", _DASHES),
    (STAIRCASE, False): Style("other", _DOTS),
    (PLAIN, True): Style("pair", _MIXED),
    ("order 2", True): Style("fem", _DOTS, 1.9),
    ("order 3", True): Style("fem", _DASHES, 1.9),
    ("order 4", True): Style("fem"),
}
_UNKNOWN = Style("ink", (5.0, 1.5, 1.0, 1.5))


def semianalytic_section(material: Material) -> Section | None:
    """Errors of the semi-analytical method over its grid; None where they were not measured."""
    study = material.evidence.accuracy
    if study is None:
        return None
    grids = [one for one in study.refinements if one.method == "semianalytic"]
    parts = _grid_parts(grids) if any(one.levels for one in grids) else []
    if study.conversions:
        parts.append(conversion_part(study.conversions))
    failures = tuple(f for f in study.failures if not f.startswith("fem_reference"))
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


def _grid_parts(studies: Sequence[Refinement]) -> list[Part]:
    caption = (
        "Error against the integral equation over N, the number of patches along a side of the grid, which "
        "is 1.12 times as wide as the contact. Beside each curve its observed slope, as far as the error "
        "falls; a dash where it falls less than threefold, or over less than a doubling of N."
    )
    first, *others = _grid_summary([one for one in studies if one.levels])
    return [
        Part(f"{PROBLEM[0].upper()}{PROBLEM[1:]}. {first}"),
        *(Part(sentence) for sentence in others),
        Part(
            "",
            [_refinement_table(studies, "patches per side")],
            _refinement_gallery(studies, "semi", "N", (33, 49, 65, 97, 129, 257), caption),
        ),
    ]


def _element_parts(studies: Sequence[Refinement]) -> list[Part]:
    caption = (
        "Error against the integral equation over the square root of the number of degrees of freedom, which "
        "grows as the elements shrink: its slope is the order in the size of the elements."
    )
    return [
        Part(
            _element_summary([one for one in studies if one.levels]),
            [_refinement_table(studies, "mesh")],
            _refinement_gallery(
                studies, "fem", "√(degrees of freedom)", (50, 70, 100, 150, 200, 300), caption
            ),
        )
    ]


def _grid_summary(studies: Sequence[Refinement]) -> list[str]:
    found = [_errors_summary(one) for one in studies if one.setting == CORRECTED]
    by_setting = {one.setting: one for one in studies if one.solid == studies[0].solid}
    best, stairs, paper = (by_setting.get(setting) for setting in (CORRECTED, STAIRCASE, PLAIN))
    if best and stairs:
        here, there = best.levels[-1].errors["pressure"], stairs.levels[-1].errors["pressure"]
        order = stairs.order("pressure")
        speed = "converges" if stairs.falls("pressure") else "does not converge"
        speed += "" if order is None else f" at order {order:.1f}"
        found.append(
            "Without correction of the contact edge, a staircase of patches, the pressure on the "
            f"{stairs.solid} solid {speed}, to {scientific(there)} at {stairs.levels[-1].name}; the "
            f"error with the corrected edge is {scientific(here)} at {best.levels[-1].name}, a factor of "
            f"{factor(there, here)}."
        )
    if paper and stairs:
        first, last = paper.levels[0], paper.levels[-1]
        stuck = [q for q in QUANTITIES if stairs.falls(q) and not paper.falls(q)]
        text = (
            f"With the plain conversion of the source paper, from {first.name} to {last.name}, the "
            f"error of the approach is {scientific(first.errors['approach'])} → "
            f"{scientific(last.errors['approach'])} that of p0 "
            f"{scientific(first.errors['p0'])} → {scientific(last.errors['p0'])}"
        )
        if stuck:
            text += (
                f"; a finer grid does not reduce {_listed(stuck)}, dominated by the error of the conversion"
            )
        found.append(text + ".")
    return found or ["No refinement study has more than one level."]


def _errors_summary(one: Refinement) -> str:
    first, last = one.levels[0], one.levels[-1]
    numbers = ", ".join(
        f"{q} {scientific(first.errors[q])} → {scientific(last.errors[q])}" for q in QUANTITIES
    )
    solid = one.solid[:1].upper() + one.solid[1:]
    text = (
        f"{solid}, {one.setting}, the default: from {first.name} to {last.name} the errors change as "
        f"{numbers}."
    )
    ended: dict[str, list[str]] = {}
    for q in QUANTITIES:
        at = settled([level.errors[q] for level in one.levels])
        if at is not None and at < len(one.levels) - 1:
            ended.setdefault(one.levels[at].name, []).append(q)
    if ended:
        where = "; ".join(f"{_listed(qs)} from {name} on" for name, qs in ended.items())
        text += f" A finer grid no longer reduces {where}: another numerical parameter dominates there."
    return text


def _element_summary(studies: Sequence[Refinement]) -> str:
    found = []
    for one in studies:
        last = one.levels[-1]
        found.append(
            f"{one.setting} gives p0 {scientific(last.errors['p0'])}, pressure "
            f"{scientific(last.errors['pressure'])}, stress {scientific(last.errors['stress'])} with "
            f"{plain(last.resolution * last.resolution, 6)} degrees of freedom in {seconds(last.seconds)}"
        )
    text = f"On the {studies[0].solid} solid and the {studies[0].levels[-1].name} mesh {'; '.join(found)}."
    if len(studies) > 1:
        low, high = studies[0], studies[-1]
        worse, better = low.levels[-1].errors, high.levels[-1].errors
        gains = [f"{factor(worse[q], better[q])} in {q}" for q in ("p0", "pressure", "stress")]
        text += f" {high.setting.capitalize()} gains over {low.setting} factors of {_listed(gains)}."
    return text


def _refinement_gallery(
    studies: Sequence[Refinement], key: str, coordinate: str, ticks: Sequence[float], caption: str
) -> Gallery:
    first = studies[0].solid

    def trail(one: Refinement, quantity: str) -> Trail:
        order = one.order(quantity)
        return Trail(
            tuple(level.resolution for level in one.levels),
            tuple(level.errors[quantity] for level in one.levels),
            _SETTINGS.get((one.setting, one.solid == first), _UNKNOWN),
            "–" if order is None else f"−{order:.1f}",
        )

    trails = {q: [trail(one, q) for one in studies if one.levels] for q in QUANTITIES}
    height = decades([one for some in trails.values() for one in some])
    panels = [
        Panel(
            f"{_TITLES[q]}",
            draw_loglog(
                some,
                label=f"error of {_TITLES[q]} over {coordinate}, logarithmic",
                coordinate=coordinate,
                height=height,
                ticks=ticks,
            ),
            f"error, {_SCALES[q]}",
            "",
        )
        for q, some in trails.items()
    ]
    legend = [
        (swatch(_SETTINGS.get((one.setting, one.solid == first), _UNKNOWN)), f"{one.solid}: {one.setting}")
        for one in studies
    ]
    return Gallery(legend, panels, caption)


def _refinement_table(studies: Sequence[Refinement], level_name: str) -> Table:
    rows = []
    for one in studies:
        name = f"{one.solid}: {one.setting}"
        for level in one.levels:
            cells = [Cell(level.name)]
            cells += [number(level.errors[q]) for q in QUANTITIES]
            rows.append(Row(Cell(name), [*cells, number(level.seconds, seconds)]))
        orders = [one.order(q) for q in QUANTITIES]
        cells = [Cell("–" if o is None else f"{o:.1f}", -1.0 if o is None else o) for o in orders]
        rows.append(Row(Cell(name), [Cell("observed order"), *cells, Cell("")], "order"))
    return Table(
        "Errors against the integral equation: p0, a and approach relative, pressure in L2 over the contact "
        "over p0, stress the largest on the axis and on both sides of each interface over p_h.",
        ["solid and setting", level_name, *QUANTITIES, "time"],
        rows,
    )


def _listed(names: Sequence[str]) -> str:
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"
