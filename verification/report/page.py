"""The report page: from case results to one HTML text that needs nothing else."""

from collections import Counter
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

import numpy as np

from verification.judging.verdict import Outcome
from verification.problem.contact import BALL
from verification.problem.quantity import BALL_PEAKS, PEAKS, SCALARS, SLOPES
from verification.regression.manifest import manifest_message
from verification.report.credibility import faults, mutants, self_tests, statement
from verification.report.figures.fields import pictures
from verification.report.figures.panels import line_figures
from verification.report.figures.sketch import sketch
from verification.report.html.templates import rendered
from verification.report.material import Material, rerun_command
from verification.report.sections import (
    accuracy,
    baseline,
    effective,
    family,
    invariants,
    parameters,
    published,
    refinement,
    times,
)
from verification.report.tables.case import (
    budget_table,
    contact_table,
    diagnostics_table,
    dominating_parameter,
    facts,
    layer_table,
    verdict_table,
)
from verification.report.tables.cells import Cell, Section, Table
from verification.report.tables.csv import embedded, line_csv
from verification.report.tables.labels import OUTCOMES, OutcomeStyle, source_label
from verification.report.tables.lookup import layers, lines, scale, slug, title_of
from verification.report.tables.matrix import verdict_matrix
from verification.report.tables.numbers import scientific, seconds
from verification.running.result import CaseResult

# Sections of the page between the verdicts and the cases, in their order; None is left out.
SECTIONS: tuple[Callable[[Material], Section | None], ...] = (
    published.section,
    family.section,
    accuracy.section,
    invariants.section,
    refinement.semianalytic_section,
    refinement.finite_element_section,
    parameters.section,
    times.section,
    baseline.section,
    self_tests.section,
    statement.section,
    faults.section,
    mutants.section,
    effective.family_section,
    effective.section,
)
# A failed source fails every comparison; the list before the figures stays short.
MOST_FAILING = 6


def render(material: Material) -> str:
    """The whole page as text. Every string of a result is escaped: a title "<script>" stays text."""
    # Results may hold numbers that overflow or are not finite; the page shows them as they are.
    with np.errstate(all="ignore"):
        return rendered(
            "page.html",
            info=material.info,
            summary=_summary(material.results),
            counts=_counts(material.results),
            failures=_failures(material),
            matrix=_matrix(material) if material.contacts else None,
            published=[_published(material, result) for result in material.published],
            outcomes=OUTCOMES.values(),
            sections=[section for make in SECTIONS if (section := make(material)) is not None],
            cases=[_contact(material, result) for result in material.contacts],
            seconds=seconds,
        )


def _matrix(material: Material) -> Table:
    columns: list[tuple[str, Callable[[CaseResult], Cell]]] = []
    found = material.evidence.baseline
    states = {case.name: baseline.state_cell(case, short=True) for case in found.cases} if found else {}
    if states:
        missing = Cell("", None, "nothing", "not in the baseline")
        columns.append(("base\u00adline", lambda result: states.get(result.name, missing)))
    if any(result.invariants for result in material.contacts):
        columns.append(
            (
                "invari\u00adants",
                lambda result: invariants.invariant_cell(result, f"#{material.anchors[result]}-invariants"),
            )
        )
    return verdict_matrix(material.contacts, material.anchors, columns)


def _counts(results: Sequence[CaseResult]) -> list[tuple[OutcomeStyle, int]]:
    counted = Counter(verdict.outcome for result in results for _, verdict in result.verdicts)
    shown = [
        outcome for outcome in reversed(OUTCOMES) if counted[outcome] or outcome is not Outcome.UNSUPPORTED
    ]
    return [(OUTCOMES[outcome], counted[outcome]) for outcome in shown]


def _failures(material: Material) -> list[str]:
    """What fails although every verdict may agree: self-tests, the manifest, the baseline."""
    failed = [test.name for test in material.evidence.self_tests if not test.passed]
    messages = [f"self-tests of the harness: {', '.join(failed)}"] if failed else []
    found = material.evidence.baseline
    if found is not None and found.less:
        messages.append(manifest_message(found.less))
    if found is not None and found.unexplained:
        messages.append(f"numbers differ from the baseline: {baseline.baseline_message(found)}")
    return messages


def _summary(results: Sequence[CaseResult]) -> str:
    """The outcome of the run in one sentence."""
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
    invariant = [one for result in results for one in result.invariants]
    if invariant:
        text += (
            f"; {sum(one.outcome is Outcome.AGREES for one in invariant)} of {len(invariant)} invariants hold"
        )
    stated = [(v.difference, c, r) for c, v, r in verdicts if v.difference is not None]
    if stated:
        largest, claim, result = max(stated, key=lambda item: item[0])
        where = "" if claim.line == "contact" else f" on {claim.line}"
        quantity = claim.quantity.replace("_", " ") if claim.line == "contact" else claim.quantity
        text += f"; the largest difference is {scientific(largest)}, {quantity}{where} in “{result.title}”"
    return text + "."


def _common(material: Material, result: CaseResult) -> dict[str, Any]:
    """What the templates of contacts and of published sources have in common."""
    bad = sum(verdict.outcome is not Outcome.AGREES for _, verdict in result.verdicts)
    broken = sum(one.outcome is not Outcome.AGREES for one in result.invariants)
    total, count = len(result.verdicts), len(result.invariants)
    text = f"{bad} of {total} comparisons do not agree" if bad else f"All {total} comparisons agree"
    if count:
        text += (
            f", {broken} of {count} invariants do not hold" if broken else f", all {count} invariants hold"
        )
    return {
        "anchor": material.anchors[result],
        "result": result,
        "outcome": OUTCOMES[result.outcome],
        "summary": f"{text}." if total else "No comparison was possible.",
        "command": rerun_command(result.name, material.info.command),
        "facts": facts(result),
        "failures": [(source_label(s.source), s.failure) for s in result.sources if s.failure is not None],
        "layers": [layer_table(result), *([layer_table(result, BALL)] if layers(result, BALL) else [])],
        "budget": budget_table(result),
        "diagnostics": diagnostics_table(result),
    }


def _scalars(result: CaseResult) -> list[tuple[str, ...]]:
    """The quantities of each table of numbers of the contact."""
    return [SCALARS, SLOPES + PEAKS, *([BALL_PEAKS] if layers(result, BALL) else [])]


def _published(material: Material, result: CaseResult) -> dict[str, Any]:
    tables, verdicts = published.tables(result), verdict_table(result.verdicts, 0.0)
    return _common(material, result) | {"tables": tables, "verdicts": verdicts}


def _contact(material: Material, result: CaseResult) -> dict[str, Any]:
    anchor, file, a_h = material.anchors[result], slug(result.name), scale(result, "a_h")
    bad = [item for item in result.verdicts if item[1].outcome is not Outcome.AGREES]
    return _common(material, result) | {
        "sketch": sketch(result),
        "contact": [contact_table(result, quantities) for quantities in _scalars(result)],
        "contact_csv": embedded(line_csv(result, "contact")),
        "contact_file": f"{file}-contact.csv",
        "pictures": pictures(result, material.planes.get(result.name)),
        "lines": [
            {
                "anchor": f"{anchor}-{slug(line)}",
                "title": title_of(line),
                "figures": line_figures(result, line),
                "csv": embedded(line_csv(result, line)),
                "file": f"{file}-{slug(line)}.csv",
            }
            for line in lines(result)
        ],
        "accuracy": accuracy.accuracy_table(result),
        "broken": invariants.invariant_table(
            [one for one in result.invariants if one.outcome is not Outcome.AGREES]
        ),
        "failing": verdict_table(bad, a_h, MOST_FAILING),
        "more": max(len(bad) - MOST_FAILING, 0),
        "verdicts": verdict_table(result.verdicts, a_h, parameter=partial(dominating_parameter, result)),
        "invariants": invariants.invariant_table(result.invariants),
    }
