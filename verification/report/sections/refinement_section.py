"""Convergence of both methods: errors against the exact reference over resolution."""

from collections.abc import Sequence

from verification.credibility.accuracy_study import CORRECTED, PLAIN, PROBLEM, STAIRCASE, AccuracyStudy
from verification.credibility.refinement_studies import QUANTITIES, Refinement
from verification.judging.invariants import Invariant
from verification.judging.invariants.influence_error import ConversionError
from verification.judging.outcome import Outcome
from verification.page.number_text import seconds
from verification.page.page_parts import Cell, Gallery, Part, Section, Table, number, row, table_of
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
        text = stated("grids", problem=f"{PROBLEM[0].upper()}{PROBLEM[1:]}")
        caption = stated("grid_caption")
        gallery = _refinement_gallery(grids, "N", (33, 49, 65, 97, 129, 257), caption)
        parts.append(Part(text, [_refinement_table(grids, "patches per side")], gallery))
    if study.conversions:
        parts.append(Part("", [_conversion_table(study.conversions)], folded="Influence coefficients"))
    failures = [f for f in study.failures if not f.startswith("fem_reference")]
    failures += [one.message for one in study.verdicts if one.outcome is Outcome.DISAGREES]
    return Section("semi-analytical-accuracy", "Semi-analytical accuracy", parts, tuple(failures))


def finite_element_section(study: AccuracyStudy | None) -> Section | None:
    """Errors of the finite elements over their mesh; None where they were not measured."""
    elements = [one for one in study.refinements if one.method == "fem_reference"] if study else []
    if study is None or not elements:
        return None
    parts = []
    if any(one.levels for one in elements):
        caption = stated("mesh_caption")
        ticks = (50, 70, 100, 150, 200, 300)
        gallery = _refinement_gallery(elements, "√(degrees of freedom)", ticks, caption)
        parts = [Part("", [_refinement_table(elements, "mesh")], gallery)]
    failures = tuple(f for f in study.failures if f.startswith("fem_reference"))
    return Section("finite-element-accuracy", "Finite element accuracy", parts, failures)


def _judged(found: Sequence[Invariant]) -> Part:
    """Each part of the method beside its limit, which counts for the exit code of the run."""
    rows = []
    for one in sorted(found, key=lambda one: OUTCOMES[one.outcome].rank):
        style = OUTCOMES[one.outcome]
        verdict = Cell(style.mark, one.share, f"verdict {style.css}")
        rows.append(row(one.name, Cell(one.message, css="reason"), verdict, css=row_css(one.outcome)))
    caption = "The parts of the method beside their limits."
    held = sum(one.outcome is Outcome.AGREES for one in found)
    text = stated("judged_studies", held=held, total=len(found))
    return Part(text, [Table(caption, ["part", "error", "verdict"], rows, css="verdicts")])


def _conversion_table(found: Sequence[ConversionError]) -> Table:
    return table_of(
        stated("conversions"),
        found,
        [
            ("conversion", lambda one: one.conversion),
            ("aliases a side", lambda one: one.aliases),
            ("domain / grid", lambda one: Cell(f"{one.enlarge or '–'}", float(one.enlarge))),
            ("loaded patch", lambda one: one.error[0]),
            ("next patch", lambda one: one.error[1]),
            ("worst patch", lambda one: max(one.error)),
            ("of the largest", lambda one: one.largest),
            ("time", lambda one: number(one.seconds, seconds)),
        ],
    )


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

    plots = []
    for q in QUANTITIES:
        title = _TITLES.get(q, q)
        label, note = (
            f"error of {title} over {coordinate}, logarithmic",
            f"error, {_SCALES.get(q, 'relative')}",
        )
        trails = [trail(one, q, style) for one, style in zip(studies, styles, strict=True) if one.levels]
        plots.append(Plot(title, label, note, coordinate, ticks, trails))
    legend = [
        (swatch(style), f"{one.solid}: {one.setting}") for one, style in zip(studies, styles, strict=True)
    ]
    return Gallery(legend, panels(plots), caption)


def _refinement_table(studies: Sequence[Refinement], level_name: str) -> Table:
    rows = []
    for one in studies:
        name = f"{one.solid}: {one.setting}"
        rows += [
            row(name, level.name, *(level.errors[q] for q in QUANTITIES), number(level.seconds, seconds))
            for level in one.levels
        ]
        orders = [one.order(q) for q in QUANTITIES]
        cells = [Cell("–" if o is None else f"{o:.1f}", -1.0 if o is None else o) for o in orders]
        rows.append(row(name, "observed order", *cells, "", css="order"))
    return Table(stated("refinement_table"), ["solid and setting", level_name, *QUANTITIES, "time"], rows)
