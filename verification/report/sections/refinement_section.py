"""Convergence of both methods: errors against the exact reference over resolution."""

from collections.abc import Sequence

from verification.credibility.accuracy_study import CORRECTED, PLAIN, PROBLEM, STAIRCASE, AccuracyStudy
from verification.credibility.refinement_studies import QUANTITIES, Refinement
from verification.judging.invariants import Invariant
from verification.judging.outcome import Outcome
from verification.page.number_text import seconds
from verification.page.page_parts import Cell, Gallery, Part, Section, Table, number, row
from verification.page.plots import DASHES, DOTS, MIXED, UNKNOWN, Plot, Trail, panels
from verification.page.source_labels import OUTCOMES, row_css
from verification.report.figures.line_panels import swatch
from verification.report.report_words import stated
from verification.sources.source_record import Style

# Of quantities that are no scalars.
_TITLES = {"pressure": "pressure, L2 over the contact", "stress": "stress, axis and interfaces"}
_SCALES = {"pressure": "over p0", "stress": "largest, over p_h"}
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


def semianalytic_section(study: AccuracyStudy | None) -> Section | None:
    """Errors of the semi-analytical method over its grid; None where they were not measured."""
    if study is None:
        return None
    grids = [one for one in study.refinements if one.method == "semianalytic"]
    parts = [_judged(study.verdicts)] if study.verdicts else []
    if any(one.levels for one in grids):
        caption = stated("grid_caption")
        gallery = _gallery(grids, "N", (33, 49, 65, 97, 129, 257), caption)
        parts.append(Part(stated("grids", problem=PROBLEM), [_table(grids, "patches per side")], gallery))
    failures = [one for one in study.failures if not one.startswith("fem_reference")]
    if over := [one.name for one in study.verdicts if one.outcome is Outcome.DISAGREES]:
        failures.append(f"{len(over)} parts exceed their limits, listed first below; {over[0]} among them")
    return Section("semi-analytical-accuracy", "Semi-analytical accuracy", parts, tuple(failures))


def finite_element_section(study: AccuracyStudy | None) -> Section | None:
    """Errors of the finite elements over their mesh; None where they were not measured."""
    elements = [one for one in study.refinements if one.method == "fem_reference"] if study else []
    if study is None or not elements:
        return None
    parts = []
    if any(one.levels for one in elements):
        ticks = (50, 70, 100, 150, 200, 300)
        gallery = _gallery(elements, "√(degrees of freedom)", ticks, stated("mesh_caption"))
        parts = [Part("", [_table(elements, "mesh")], gallery)]
    failures = tuple(one for one in study.failures if one.startswith("fem_reference"))
    return Section("finite-element-accuracy", "Finite element accuracy", parts, failures)


def _judged(found: Sequence[Invariant]) -> Part:
    """Each part of the method beside its limit, which counts for the exit code of the run."""
    held = sum(one.outcome is Outcome.AGREES for one in found)
    rows = []
    for one in sorted(found, key=lambda one: OUTCOMES[one.outcome].rank):
        style = OUTCOMES[one.outcome]
        mark = Cell(style.mark, one.share, f"verdict {style.css}")
        rows.append(row(one.name, Cell(one.message, css="reason"), mark, css=row_css(one.outcome)))
    heads, caption = ["part", "error", "verdict"], "The parts of the method beside their limits."
    text = stated("judged_studies", held=held, total=len(found))
    return Part(text, [Table(caption, heads, rows, css="verdicts")])


def _gallery(studies: Sequence[Refinement], coordinate: str, ticks: Sequence[float], caption: str) -> Gallery:
    styles = [_SETTINGS.get((one.setting, one.solid == studies[0].solid), UNKNOWN) for one in studies]
    styled = list(zip(studies, styles, strict=True))
    plots = []
    for q in QUANTITIES:
        title = _TITLES.get(q, q)
        trails = [
            Trail(
                tuple(level.resolution for level in one.levels),
                tuple(level.errors[q] for level in one.levels),
                style,
                "–" if (order := one.order(q)) is None else f"−{order:.1f}",
            )
            for one, style in styled
            if one.levels
        ]
        label = f"error of {title} over {coordinate}, logarithmic"
        plots.append(Plot(title, label, f"error, {_SCALES.get(q, 'relative')}", coordinate, ticks, trails))
    legend = [(swatch(style), f"{one.solid}: {one.setting}") for one, style in styled]
    return Gallery(legend, panels(plots), caption)


def _table(studies: Sequence[Refinement], level_name: str) -> Table:
    rows = []
    for one in studies:
        name = f"{one.solid}: {one.setting}"
        rows += [
            row(name, level.name, *(level.errors[q] for q in QUANTITIES), number(level.seconds, seconds))
            for level in one.levels
        ]
        orders = [number(one.order(q), "{:.1f}".format) for q in QUANTITIES]
        rows.append(row(name, "observed order", *orders, "", css="order"))
    return Table(stated("refinement_table"), ["solid and setting", level_name, *QUANTITIES, "time"], rows)
