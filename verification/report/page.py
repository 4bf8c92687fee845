"""The report page: from case results to one HTML text that needs nothing else."""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
from markupsafe import Markup

from verification.credibility.accuracy import AccuracyStudy
from verification.judging.verdict import Outcome
from verification.regression.baseline import Regression
from verification.report.figures.fields import Pictures, pictures
from verification.report.figures.panels import LineFigures, line_figures
from verification.report.figures.sketch import sketch
from verification.report.rerun import again
from verification.report.sections.accuracy import (
    accuracy_overview,
    accuracy_sentence,
    accuracy_table,
    coverage_table,
)
from verification.report.sections.baseline import baseline_section, state_cell
from verification.report.sections.family import family_section
from verification.report.sections.invariants import invariant_cell, invariant_section, invariant_table
from verification.report.sections.published import published_overview, published_view
from verification.report.sections.refinement import convergence_sections
from verification.report.tables.case import (
    budget_table,
    contact_table,
    diagnostics_table,
    dominating_knob,
    layer_table,
    time_table,
    verdict_table,
)
from verification.report.tables.cells import Part, Section, Table
from verification.report.tables.csv import embedded, line_csv
from verification.report.tables.labels import OUTCOMES, OutcomeStyle, source_label
from verification.report.tables.lookup import lines, scale, slug
from verification.report.tables.matrix import verdict_matrix
from verification.report.tables.numbers import engineering, plain, scientific, seconds
from verification.report.templates import rendered
from verification.running.result import CaseResult, RunInfo
from verification.sampling.plane import Plane
from verification.sources.registry import METHODS

__all__ = ["render"]

# A failed source fails every comparison; the figures should still be within reach.
MOST_FAILING = 6


@dataclass(frozen=True)
class LineView:
    """One line of a case: its anchor, figures, and numbers."""

    anchor: str
    title: str
    figures: LineFigures
    csv: str
    file: str


@dataclass(frozen=True)
class CaseView:
    """All that the page says of one case."""

    anchor: str
    result: CaseResult
    outcome: OutcomeStyle
    sentence: str
    command: str
    facts: tuple[tuple[str, str], ...]
    sketch: Markup
    failures: tuple[tuple[str, str], ...]
    layers: Table
    contact: Table
    contact_csv: str
    contact_file: str
    pictures: Pictures | None
    lines: tuple[LineView, ...]
    accuracy: Table | None
    broken: Table | None
    failing: Table | None
    more: int
    verdicts: Table
    invariants: Table | None
    budget: Table | None
    diagnostics: Table | None


def render(
    results: Sequence[CaseResult],
    info: RunInfo,
    study: AccuracyStudy | None = None,
    extra: Sequence[Section] = (),
    planes: Mapping[str, Plane] | None = None,
    baseline: Regression | None = None,
) -> str:
    """The whole page as text. Every string of a result is escaped: a title "<script>" stays text.

    planes : what to draw of the plane below the contact, by name of the case.
    baseline : what became of each number since the baseline.
    """
    # A report tells of numbers that overflow or are not finite; it must not stumble over them.
    with np.errstate(all="ignore"):
        return _render(results, info, study, extra, planes or {}, baseline)


def _render(
    results: Sequence[CaseResult],
    info: RunInfo,
    study: AccuracyStudy | None,
    extra: Sequence[Section],
    planes: Mapping[str, Plane],
    baseline: Regression | None,
) -> str:
    anchors = _anchors(results)
    sections = _sections(results, anchors, study)
    if baseline is not None:
        places = {result.name: anchors[number] for number, result in enumerate(results)}
        sections.append(baseline_section(baseline, places))
    drifts = baseline.cases if baseline is not None else ()
    contacts = [result for result in results if not result.published]
    contact_anchors = dict(enumerate(anchors[n] for n, result in enumerate(results) if not result.published))
    return rendered(
        "page.html",
        info=info,
        summary=_summary(results),
        counts=_counts(results),
        matrix=verdict_matrix(
            contacts,
            contact_anchors,
            {c.name: state_cell(c, short=True) for c in drifts},
            invariant_cell if any(result.invariants for result in contacts) else None,
        )
        if contacts
        else None,
        printed=[
            published_view(result, anchors[n], again(result.name, info.command))
            for n, result in enumerate(results)
            if result.published
        ],
        outcomes=OUTCOMES.values(),
        sections=[*sections, *extra],
        cases=[
            _case(result, anchor, info, planes.get(result.name))
            for result, anchor in zip(contacts, contact_anchors.values(), strict=True)
        ],
        seconds=seconds,
    )


def _anchors(results: Sequence[CaseResult]) -> Mapping[int, str]:
    """A readable anchor for each case; two cases with one name get different ones."""
    taken: Counter[str] = Counter()
    anchors = {}
    for number, result in enumerate(results):
        name = f"case-{slug(result.name)}"
        taken[name] += 1
        anchors[number] = name if taken[name] == 1 else f"{name}--{taken[name]}"
    return anchors


def _sections(
    results: Sequence[CaseResult], anchors: Mapping[int, str], study: AccuracyStudy | None
) -> list[Section]:
    """What is said of the run as a whole, between the verdicts and the cases."""
    sections = []
    if any(result.published for result in results):
        table = published_overview(results, anchors)
        sections.append(Section("published", "Published results", [Part("", [table])]))
    contacts = [(n, result) for n, result in enumerate(results) if not result.published]
    found = [result for _, result in contacts]
    places = dict(enumerate(anchors[n] for n, _ in contacts))
    if (family := family_section(found)) is not None:
        sections.append(family)
    accuracy = [
        Part(accuracy_sentence(found, source), [overview])
        for source in METHODS
        if (overview := accuracy_overview(found, places, source)) is not None
    ]
    if (coverage := coverage_table(found)) is not None:
        accuracy.insert(0, Part("", [coverage]))
    if accuracy:
        sections.append(Section("accuracy", "Accuracy against the exact reference", accuracy))
    if (laws := invariant_section(found, places)) is not None:
        sections.append(laws)
    if study is not None:
        sections += convergence_sections(study)
    if results:
        times = time_table(results, [f"#{anchors[number]}" for number in range(len(results))])
        sections.append(Section("times", "Run times", [Part("", [times])]))
    return sections


def _counts(results: Sequence[CaseResult]) -> list[tuple[OutcomeStyle, int]]:
    counted = Counter(verdict.outcome for result in results for _, verdict in result.verdicts)
    return [(style, counted[outcome]) for outcome, style in reversed(OUTCOMES.items())]


def _summary(results: Sequence[CaseResult]) -> str:
    """What the run came to, in one sentence."""
    if not results:
        return "No case was run."
    verdicts = [(c, v, result) for result in results for c, v in result.verdicts]
    passed = [result for result in results if result.outcome is Outcome.AGREES]
    number = "1 case" if len(results) == 1 else f"{len(results)} cases"
    agreeing = sum(v.outcome is Outcome.AGREES for _, v, _ in verdicts)
    if len(passed) == len(results):
        text = f"Every comparison of {number} agrees within its numerical uncertainty, {agreeing} in all"
    else:
        text = (
            f"{len(passed)} of {number} agree throughout; of {len(verdicts)} comparisons {agreeing} agree "
            "within their numerical uncertainty"
        )
    laws = [one for result in results for one in result.invariants]
    if laws:
        text += f"; {sum(one.outcome is Outcome.AGREES for one in laws)} of {len(laws)} invariants hold"
    stated = [(v.difference, c, r) for c, v, r in verdicts if v.difference is not None]
    if stated:
        largest, claim, result = max(stated, key=lambda item: item[0])
        where = "" if claim.line == "contact" else f" on {claim.line}"
        quantity = claim.quantity.replace("_", " ") if claim.line == "contact" else claim.quantity
        text += f"; the largest difference is {scientific(largest)}, {quantity}{where} in “{result.title}”"
    return text + "."


def _case(result: CaseResult, anchor: str, info: RunInfo, plane: Plane | None) -> CaseView:
    style = OUTCOMES[result.outcome]
    bad = [item for item in result.verdicts if item[1].outcome is not Outcome.AGREES]
    broken = [one for one in result.invariants if one.outcome is not Outcome.AGREES]
    file = slug(result.name)
    a_h = scale(result, "a_h")
    return CaseView(
        anchor=anchor,
        result=result,
        outcome=style,
        sentence=_case_sentence(result, len(bad), len(broken)),
        command=again(result.name, info.command),
        facts=_facts(result),
        sketch=sketch(result),
        failures=tuple((source_label(s.source), s.failure) for s in result.sources if s.failure is not None),
        layers=layer_table(result),
        contact=contact_table(result),
        contact_csv=embedded(line_csv(result, "contact")),
        contact_file=f"{file}-contact.csv",
        pictures=pictures(result, plane),
        lines=tuple(_line(result, line, anchor, file) for line in lines(result)),
        accuracy=accuracy_table(result),
        broken=invariant_table(broken),
        failing=verdict_table(bad, a_h, MOST_FAILING) if bad else None,
        more=max(len(bad) - MOST_FAILING, 0),
        verdicts=verdict_table(result.verdicts, a_h, knob=partial(dominating_knob, result)),
        invariants=invariant_table(result.invariants),
        budget=budget_table(result),
        diagnostics=diagnostics_table(result),
    )


def _line(result: CaseResult, line: str, anchor: str, file: str) -> LineView:
    return LineView(
        anchor=f"{anchor}-{slug(line)}",
        title=f"Along the {line}" if line in ("surface", "axis") else line.capitalize(),
        figures=line_figures(result, line),
        csv=embedded(line_csv(result, line)),
        file=f"{file}-{slug(line)}.csv",
    )


def _case_sentence(result: CaseResult, bad: int, broken: int) -> str:
    total, laws = len(result.verdicts), len(result.invariants)
    if not total:
        return "Nothing could be compared."
    text = f"{bad} of {total} comparisons do not agree" if bad else f"All {total} comparisons agree"
    if laws:
        text += f", {broken} of {laws} invariants do not hold" if broken else f", all {laws} invariants hold"
    return text + "."


def _facts(result: CaseResult) -> tuple[tuple[str, str], ...]:
    problem = result.problem
    return (
        ("sphere radius R", engineering(problem.get("radius"), "m")),
        ("load W", engineering(problem.get("load"), "N")),
        ("friction f", plain(problem.get("friction", 0.0))),
        ("a_h, Hertz contact radius", engineering(scale(result, "a_h"), "m")),
        ("p_h, Hertz peak pressure", engineering(scale(result, "p_h"), "Pa")),
        ("delta_h, Hertz approach", engineering(scale(result, "delta_h"), "m")),
    )
