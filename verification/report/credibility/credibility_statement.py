"""Credibility of the verdicts: ranges, code and solution verification, independence, false alarms.

Terms and order after ASME V&V 10-2019, Standard for Verification and Validation in Computational Solid
Mechanics, ASME V&V 20-2009 for validation, and NASA-STD-7009B (2024), Standard for Models and Simulations.
"""

from collections.abc import Sequence
from math import isfinite
from statistics import median

from verification.cases.random_problems import FRICTION, MOST_COATINGS, POISSON, RATIO, THICKNESS, THINNEST
from verification.credibility.self_tests.known_verdicts import TEST
from verification.evidence.alarm_record import DECADES, AlarmRecord
from verification.evidence.code_record import DesignOrder, Imports, shared
from verification.judging.verdict import Outcome
from verification.page.number_text import plain
from verification.page.page_parts import (
    Cell,
    Gallery,
    Panel,
    Part,
    Section,
    Table,
    number,
    outcome_cell,
    row,
    table_of,
    tally,
    words,
)
from verification.page.plots import draw_histogram
from verification.page.source_labels import pair_label, source_label
from verification.report.report_material import Evidence, Material
from verification.report.report_words import stated
from verification.report.sections.accuracy_section import accuracies
from verification.report.tables.case_lookup import layers, scale
from verification.running.case_result import CaseResult

MOST = 30


def _range_table(results: Sequence[CaseResult]) -> Table:
    solids = [(layers(result.problem), scale(result.problem, "a_h"), result.problem) for result in results]
    found: dict[str, tuple[list[float], Sequence[float]]] = {
        "E of a coating over E of the substrate": (
            [E / layers[-1][0] for layers, _, _ in solids for E, _, _ in layers[:-1]],
            RATIO,
        ),
        "h / a_h of a coating": (
            [float(h / a) for layers, a, _ in solids for _, _, h in layers[:-1]],
            (min(THINNEST, *THICKNESS), max(THICKNESS)),
        ),
        "Poisson's ratio": ([nu for layers, _, _ in solids for _, nu, _ in layers], POISSON),
        "friction f": ([float(problem.get("friction", 0.0)) for _, _, problem in solids], FRICTION),
        "coatings": ([len(layers) - 1.0 for layers, _, _ in solids if layers], (1.0, float(MOST_COATINGS))),
    }
    return table_of(
        "Ranges of the problems solved.",
        found.items(),
        [
            ("quantity", lambda item: item[0]),
            ("this run", lambda item: _range(item[1][0])),
            ("random problems", lambda item: _range(item[1][1])),
        ],
    )


def _design_table(orders: Sequence[DesignOrder]) -> Table:
    def observed(value: float, one: DesignOrder) -> Cell:
        return number(value, "{:.2f}".format, "flag agrees" if one.as_designed else "flag disagrees")

    return table_of(
        "Finite element operator on manufactured solutions: order in the L2 norm from a mesh to one twice as "
        "fine.",
        orders,
        [
            ("elements", lambda one: Cell(f"order {one.order}", one.order)),
            ("harmonic", lambda one: one.harmonic),
            ("design, u", lambda one: one.order + 1),
            ("observed, u", lambda one: observed(one.displacement, one)),
            ("design, ∇u", lambda one: one.order),
            ("observed, ∇u", lambda one: observed(one.gradient, one)),
            ("error, finer mesh", lambda one: one.errors[1]),
        ],
    )


def _pair_table(results: Sequence[CaseResult]) -> Table:
    verdicts = [(c, v) for result in results for c, v in result.verdicts]
    rows = []
    for pair in dict.fromkeys(claim.between for claim, _ in verdicts):
        mine = [v for c, v in verdicts if c.between == pair]
        good = sum(v.outcome is Outcome.AGREES for v in mine)
        largest = max((v.difference for v in mine if v.difference is not None), default=None)
        widest = max((v.uncertainty for v in mine if v.uncertainty is not None), default=None)
        rows.append(row(pair_label(pair), tally(good, len(mine)), largest, widest))
    return Table(
        "All comparisons by pair of sources; differences and U as fractions of their scale.",
        ["between", "agree", "largest difference", "largest U"],
        rows,
    )


def _import_table(parts: Sequence[Imports]) -> Table:
    def forbidden(part: Imports) -> Cell:
        bad = [*part.forbidden, *part.hidden]
        return Cell("; ".join(bad) or "none", css=f"words flag {'disagrees' if bad else 'agrees'}")

    return table_of(
        "Imports of each part, without its own and the standard library.",
        parts,
        [
            ("part", lambda part: part.name),
            ("files", lambda part: part.files),
            ("imports", lambda part: part.statements),
            ("modules from outside", lambda part: words(", ".join(part.modules))),
            ("forbidden imports", forbidden),
        ],
    )


def _alarm_table(record: AlarmRecord | None) -> Table:
    alarms = record.alarms if record else ()
    more = f" The first {MOST} of {len(alarms)}." if len(alarms) > MOST else ""
    return table_of(
        f"Verdicts of clean problems that are not AGREES.{more}",
        alarms[:MOST],
        [
            ("problem", lambda alarm: Cell(alarm.title, note=alarm.case, css="words")),
            ("verdict", lambda alarm: outcome_cell(alarm.outcome)),
            ("quantity", lambda alarm: alarm.quantity),
            ("line", lambda alarm: alarm.line),
            ("between", lambda alarm: " – ".join(map(source_label, alarm.between))),
            ("reason", lambda alarm: words(alarm.reason)),
        ],
    )


def _range(found: Sequence[float]) -> str:
    if not found:
        return "–"
    low, high = min(found), max(found)
    return plain(low, 3) if low == high else f"{plain(low, 3)} to {plain(high, 3)}"


NO_RECORD = "Not measured: there is no record of {}; make one in a checkout with: {} --record"


def section(material: Material, coverage: Table) -> Section | None:
    """Evidence from the intended use to the false alarms; None where no evidence was collected.

    coverage : as ``coverage_table``.
    """
    results, evidence = material.results, material.evidence
    if evidence == Evidence():
        return None
    contacts = material.contacts
    parts = [
        Part(stated("evidence")),
        Part(stated("intended"), [_range_table(contacts)], title="Intended use and limits"),
        Part(_code(evidence), [_design_table(evidence.orders)], title="Code verification"),
        Part(stated("solution", found=_bracketed(contacts)), [coverage], title="Solution verification"),
        Part(
            f"{_compared(results)} {_enclosed(evidence)}",
            [_pair_table(results)],
            title="Comparison with references and between methods",
        ),
        Part(
            _independent(evidence),
            [_import_table(evidence.parts)],
            title="Independence of the two methods",
            anchor="independence",
        ),
        Part(
            stated("shared_equation"),
            folded="What the semi-analytical method and the integral equation share",
        ),
        Part(stated("tested_patches"), folded="What comparisons of a sphere test of the patches"),
        Part(_alarms(evidence), [], _histograms(evidence), "False alarms", anchor="alarms"),
        Part("", [_alarm_table(evidence.alarms)], folded="Verdicts of clean problems that are not AGREES"),
    ]
    if evidence.faults is None:
        parts.append(
            Part(NO_RECORD.format("planted faults", "python tests/tools faults"), title="Planted faults")
        )
    return Section("credibility", "Credibility", parts, evidence.failures)


def _when(evidence: Evidence, name: str) -> str:
    """Date and commit of the record ``name``, marked where the code that it judges has changed since."""
    made = getattr(evidence, name)
    older = ", older than the code" if name in evidence.older else ""
    return f"{made.started[:10]}, {made.commit or 'no commit'}{older}"


def _bracketed(results: Sequence[CaseResult]) -> str:
    found = [item for result in results for item in accuracies(result)]
    if not found:
        return "not measured: no case of this run has an exact reference."
    good = sum(item.covered for item in found)
    ratios = [item.ratio for item in found if item.ratio is not None and isfinite(item.ratio)]
    wide = f"; the median of U over the error is {plain(median(ratios), 2)}" if ratios else ""
    return (
        f"U covers the true error at every judged point in {good} of {len(found)} quantities "
        f"({plain(100 * good / len(found), 3)} %){wide}."
    )


def _compared(results: Sequence[CaseResult]) -> str:
    verdicts = [verdict for result in results for _, verdict in result.verdicts]
    if not verdicts:
        return "Nothing was compared in this run."
    agreeing = sum(verdict.outcome is Outcome.AGREES for verdict in verdicts)
    text = f"{agreeing} of {len(verdicts)} comparisons of this run agree."
    if not any(result.published for result in results):
        text += " Published results were not part of it: coatcheck run published."
    return text


def _enclosed(evidence: Evidence) -> str:
    """What is proven of the exact reference, with what this run found of it."""
    record = evidence.enclosures
    if record is None:
        return NO_RECORD.format("enclosures", "python tests/tools certify")
    values = [bounds for one in record.enclosures for bounds in one.bounds]
    held = next((test for test in evidence.self_tests if test.name == TEST), None)
    return stated(
        "enclosed",
        values=len(values),
        problems=len(record.enclosures),
        width=plain(max(bounds.width for bounds in values), 2),
        made=_when(evidence, "enclosures"),
        flint=record.versions.get("python-flint", "unknown"),
        found=held and held.found,
    )


def _code(evidence: Evidence) -> str:
    return stated("code", made=_when(evidence, "code") if evidence.code else "at no time")


def _independent(evidence: Evidence) -> str:
    if not evidence.parts:
        return NO_RECORD.format("imports", "python tests/tools code")
    first, second = evidence.parts[:2]
    common = ", ".join(shared(first, second)) or "none"
    both = ", ".join(sorted(set(first.packages) & set(second.packages))) or "none"
    bad = [message for part in evidence.parts for message in (*part.forbidden, *part.hidden)]
    counted = sum(part.statements for part in evidence.parts)
    files = sum(part.files for part in evidence.parts)
    found = f"None of {counted} imports in {files} files of both methods and the references is forbidden."
    if bad:
        found = f"{len(bad)} imports are forbidden: {'; '.join(bad[:5])}."
    return stated("independent", made=_when(evidence, "code"), found=found, both=both, common=common)


def _histograms(evidence: Evidence) -> Gallery | None:
    """Error over uncertainty of each method in the random problems of the false alarms."""
    record = evidence.alarms
    if record is None or not any(one.values for one in record.ratios):
        return None
    panels = [
        Panel(
            source_label(one.source),
            draw_histogram(DECADES, one.counts, f"Error over uncertainty of {source_label(one.source)}"),
            f"{one.values} values, {100 * one.within:.4g} % within U, largest error over U "
            f"{one.largest:.3g}; median of U over the error {one.median:.3g}",
            "",
        )
        for one in record.ratios
    ]
    return Gallery((), panels, stated("ratios"))


def _alarms(evidence: Evidence) -> str:
    record = evidence.alarms
    if record is None:
        return NO_RECORD.format("false alarms", "python tests/tools alarms")
    return stated("false_alarms", record=record, made=_when(evidence, "alarms"))
