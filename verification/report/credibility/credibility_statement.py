"""Credibility of the verdicts: ranges, code and solution verification, independence, false alarms.

Terms and order after ASME V&V 10-2019, Standard for Verification and Validation in Computational Solid
Mechanics, ASME V&V 20-2009 for validation, and NASA-STD-7009B (2024), Standard for Models and Simulations.
"""

from collections.abc import Sequence
from functools import partial

from verification.cases.drawn_ranges import FRICTION, MOST_COATINGS, POISSON, RATIO, THICKNESS, THINNEST
from verification.credibility.self_tests.known_verdicts import TEST
from verification.evidence.alarm_record import DECADES, Campaign, wrong_first
from verification.evidence.code_record import shared
from verification.judging.verdict import Outcome, Verdict
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
from verification.page.source_labels import pair_label, source_label, symbol_of
from verification.report.report_material import Evidence, ReportMaterial
from verification.report.report_words import stated
from verification.report.tables.case_lookup import layers, scale
from verification.running.case_result import CaseResult
from verification.sources.source_registry import METHODS

MOST = 30
NO_RECORD = "Not measured: there is no record of {}; make one in a checkout with: {} --record"


def section(material: ReportMaterial, coverage: Table) -> Section | None:
    """Evidence from the intended use to the false alarms; None where no evidence was collected.

    coverage : as ``coverage_table``.
    """
    results, evidence = material.results, material.evidence
    if evidence == Evidence():
        return None
    made = _when(evidence, "code") if evidence.code else "at no time"
    compared = "" if material.published else "Published results are compared by coatcheck run published."
    parts = [
        Part(stated("evidence")),
        Part(stated("intended"), [_range_table(material.contacts)], title="Intended use and limits"),
        Part(stated("code", made=made), [_design_table(evidence)], title="Code verification"),
        Part(stated("solution"), [coverage], title="Solution verification"),
        Part(
            f"{compared} {_enclosed(evidence)}",
            [_pair_table(results)],
            title="Comparison with references and between methods",
        ),
        Part(
            _independent(evidence),
            [_import_table(evidence)],
            title="Independence of the two methods",
            anchor="independence",
        ),
        Part(
            stated("shared_equation"),
            folded="What the semi-analytical method and the integral equation share",
        ),
        Part(stated("tested_patches"), folded="What comparisons of a sphere test of the patches"),
        *_alarms(evidence),
    ]
    if evidence.faults is None:
        text = NO_RECORD.format("planted faults", "python tests/tools faults")
        parts.append(Part(text, title="Planted faults"))
    return Section("credibility", "Credibility", parts, evidence.failures)


def _range_table(results: Sequence[CaseResult]) -> Table:
    solids = [(layers(one.problem), scale(one.problem, "a_h"), one.problem) for one in results]
    ratios = [E / s[-1][0] for s, _, _ in solids for E, *_ in s[:-1]]
    depths = [float(h / a) for s, a, _ in solids for *_, h in s[:-1]]
    friction = [float(problem.get("friction", 0.0)) for *_, problem in solids]
    found: dict[str, tuple[Sequence[float], Sequence[float]]] = {
        "E of a coating over E of the substrate": (ratios, RATIO),
        "h / a_h of a coating": (depths, (min(THINNEST, *THICKNESS), max(THICKNESS))),
        "Poisson's ratio": ([nu for s, _, _ in solids for _, nu, _ in s], POISSON),
        "friction f": (friction, FRICTION),
        "coatings": ([len(s) - 1.0 for s, _, _ in solids if s], (1.0, float(MOST_COATINGS))),
    }
    rows = [row(name, _range(run), _range(drawn)) for name, (run, drawn) in found.items()]
    return Table("Ranges of the problems solved.", ["quantity", "this run", "random problems"], rows)


def _range(found: Sequence[float]) -> str:
    ends = dict.fromkeys(plain(end, 3) for end in (min(found), max(found))) if found else ["–"]
    return " to ".join(ends)


def _design_table(evidence: Evidence) -> Table:
    def observed(value: float, good: bool) -> Cell:
        return number(value, "{:.2f}".format, f"flag {'agrees' if good else 'disagrees'}")

    return table_of(
        "Finite element operator on manufactured solutions: order in the L2 norm from a mesh to one twice as "
        "fine.",
        evidence.orders,
        [
            ("elements", lambda one: Cell(f"order {one.order}", one.order)),
            ("harmonic", lambda one: one.harmonic),
            ("design, u", lambda one: one.order + 1),
            ("observed, u", lambda one: observed(one.displacement, one.as_designed)),
            ("design, ∇u", lambda one: one.order),
            ("observed, ∇u", lambda one: observed(one.gradient, one.as_designed)),
            ("error, finer mesh", lambda one: one.errors[1]),
        ],
    )


def _pair_table(results: Sequence[CaseResult]) -> Table:
    by_pair: dict[tuple[str, str], list[Verdict]] = {}
    for claim, verdict in (pair for result in results for pair in result.verdicts):
        by_pair.setdefault(claim.between, []).append(verdict)
    rows = [
        row(
            pair_label(pair),
            tally(sum(one.outcome is Outcome.AGREES for one in of), len(of)),
            max(one.difference or 0.0 for one in of),
            max(one.uncertainty or 0.0 for one in of),
        )
        for pair, of in by_pair.items()
    ]
    caption = "All comparisons by pair of sources; differences and U as fractions of their scale."
    return Table(caption, ["between", "agree", "largest difference", "largest U"], rows)


def _import_table(evidence: Evidence) -> Table:
    return table_of(
        "Imports of each part, without its own and the standard library.",
        evidence.parts,
        [
            ("part", lambda part: part.name),
            ("files", lambda part: part.files),
            ("imports", lambda part: part.statements),
            ("modules from outside", lambda part: words(", ".join(part.modules))),
            (
                "forbidden imports",
                lambda part: Cell(
                    "; ".join(part.wrong) or "none",
                    css=f"words flag {'agrees' if part.passed else 'disagrees'}",
                ),
            ),
        ],
    )


def _when(evidence: Evidence, name: str) -> str:
    """Date and commit of the record ``name``, marked where the code that it judges has changed since."""
    made = getattr(evidence, name)
    older = ", older than the code" if name in evidence.older else ""
    return f"{made.started[:10]}, {made.commit or 'no commit'}{older}"


def _enclosed(evidence: Evidence) -> str:
    """Proven bounds on the exact reference, with what this run found of it."""
    record = evidence.enclosures
    if record is None:
        return NO_RECORD.format("enclosures", "python tests/tools certify")
    values = [bounds for one in record.enclosures for bounds in one.bounds]
    return stated(
        "enclosed",
        values=len(values),
        problems=len(record.enclosures),
        width=plain(max(bounds.width for bounds in values), 2),
        made=_when(evidence, "enclosures"),
        flint=record.versions.get("python-flint", "unknown"),
        found=next((test.found for test in evidence.self_tests if test.name == TEST), ""),
    )


def _independent(evidence: Evidence) -> str:
    if not evidence.parts:
        return NO_RECORD.format("imports", "python tests/tools code")
    first, second = evidence.parts[:2]
    return stated(
        "independent",
        made=_when(evidence, "code"),
        imports=sum(part.statements for part in evidence.parts),
        files=sum(part.files for part in evidence.parts),
        bad=[message for part in evidence.parts for message in part.wrong],
        both=", ".join(sorted(set(first.packages) & set(second.packages))) or "none",
        common=", ".join(shared(first, second)) or "none",
    )


def _alarms(evidence: Evidence) -> list[Part]:
    """False alarms with error over uncertainty of each method, then the verdicts that do not agree."""
    record = evidence.alarms
    if record is None:
        text = NO_RECORD.format("false alarms", "python tests/tools alarms")
        return [Part(text, title="False alarms", anchor="alarms")]
    panels = []
    for source in METHODS:
        found = [r.counts for one in record.campaigns for r in one.ratios if r.source == source and r.values]
        if counts := [sum(column) for column in zip(*found, strict=True)]:
            figure = draw_histogram(DECADES, counts, f"Error over uncertainty of {source_label(source)}")
            panels.append(Panel(source_label(source), figure, f"{sum(counts)} values"))
    histograms = Gallery((), panels, stated("ratios")) if panels else None
    drawn = table_of(
        "Each kind and seed.",
        record.campaigns,
        [
            ("random", lambda one: Cell(one.kind, css="words")),
            ("seed", lambda one: str(one.seed)),
            ("problems", lambda one: one.problems),
            ("agree throughout", lambda one: one.agreeing),
            ("inconclusive", lambda one: len(one.vague)),
            ("comparisons", lambda one: one.comparisons),
            ("with a false alarm", lambda one: len(one.wrong)),
            ("largest difference / U", lambda one: f"{one.largest:.2f}"),
            *((f"within U, {source_label(name)}", partial(_within, source=name)) for name in METHODS),
            ("made", lambda one: f"{one.started[:10]}, {(one.commit or 'no commit')[:8]}"),
        ],
    )
    alarms = wrong_first(alarm for one in record.campaigns for alarm in one.alarms)
    table = table_of(
        f"The first {MOST} of {len(alarms)}." if len(alarms) > MOST else f"All {len(alarms)}.",
        alarms[:MOST],
        [
            ("problem", lambda alarm: Cell(alarm.title, note=alarm.case, css="words")),
            ("verdict", lambda alarm: outcome_cell(alarm.outcome)),
            ("quantity", lambda alarm: symbol_of(alarm.quantity)),
            ("line", lambda alarm: alarm.line),
            ("between", lambda alarm: " – ".join(map(source_label, alarm.between))),
            ("reason", lambda alarm: words(alarm.reason)),
        ],
    )
    said = stated("false_alarms", record=record, older="alarms" in evidence.older)
    folded = Part("", [table], folded="Verdicts of clean problems that are not AGREES")
    return [Part(said, [drawn], histograms, "False alarms", anchor="alarms"), folded]


def _within(one: Campaign, source: str) -> str:
    """Share of the values of ``source`` whose error is at most U, with the largest error over U."""
    found = next((r for r in one.ratios if r.source == source and r.values), None)
    return f"{100 * found.within:.4g} % of {found.values}, at most {found.largest:.2f}" if found else "–"
