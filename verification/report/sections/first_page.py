"""First page of a report: problem, sources, outcome, its credibility, limits of the claim."""

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from math import isfinite
from statistics import median
from typing import Any

from markupsafe import Markup

from verification.credibility.faults.first_notice import kinds, method_score, of_method
from verification.judging.verdict import Claim, Outcome
from verification.page.number_text import plain, scientific
from verification.page.source_labels import OUTCOMES, OutcomeStyle, source_label, symbol_of
from verification.problem.coated_contact import BALL
from verification.problem.quantity import QUANTITIES
from verification.regression.baseline_change import State, baseline_message
from verification.regression.manifest import manifest_message
from verification.report.figures.field_pictures import plane_difference
from verification.report.figures.verdict_strips import Axis, Item, axis_of, draw_axis, draw_strip, worst
from verification.report.report_material import Material, made_with
from verification.report.sections.accuracy_section import accuracies
from verification.report.tables.case_lookup import divisor, layers
from verification.running.case_result import CaseResult
from verification.running.published_counts import counts
from verification.sources.source_record import Independence
from verification.sources.source_registry import SOURCES, independence

MOST_ROWS = 28  # strips of the first page; of more cases the worst have their own, the others share some
OWN_ROWS = 12
_CLOSED = "closed forms of uncoated contacts."
_METHODS = {
    "semianalytic": "influence coefficients of surface patches, conjugate gradients, DC-FFT; stresses "
    "are sums of point forces.",
    "fem_reference": "axisymmetric, fourth order, mesh fitted to the contact edge; sliding as a harmonic.",
    "integral_equation": "exact Fredholm equation of the layered contact.",
    "hertz": _CLOSED,
    "hamilton": _CLOSED,
    "published": "tables of the literature.",
}
_ASSUMED = (
    "All sources assume a parabolic sphere, small strains, linear elastic layers, perfect bonds, a "
    "half-space; friction q = f p leaves p unchanged."
)
# What a difference is divided by, in words, by the kind of its quantity.
_SCALES = {"scalar": "of its value", "slope": "of its value", "displacement": "of the approach"}


@dataclass(frozen=True)
class StripRow:
    """One row of the chart: cases of one strip, the comparison that a reader looks at first, the verdict."""

    title: str
    href: str
    strip: Markup
    first: str
    count: str
    style: OutcomeStyle


@dataclass(frozen=True)
class Worth:
    """One figure of what the verdicts are worth; ``good`` is None where it is neither good nor bad.

    note : what else is known of it; of a record its date and commit.   older : a record older than the code.
    """

    name: str
    value: str
    href: str
    good: bool | None
    note: str = ""
    older: bool = False


@dataclass(frozen=True)
class Chart:
    """The strips of all cases over one axis; ``only`` names the outcome where all strips have the same."""

    rows: Sequence[StripRow]
    scale: Markup
    grouped: int


def answered(material: Material) -> list[tuple[str, str]]:
    """(labels, sentence) of the sources of the run, in the order of the registry."""
    results = material.results
    found = {name for result in results for claim, _ in result.verdicts for name in claim.between}
    known = [name for name in SOURCES if name in found]
    texts: dict[str, list[str]] = {}
    for name in (*known, *sorted(found - set(known))):
        texts.setdefault(_METHODS.get(name, ""), []).append(source_label(name))
    return [(", ".join(labels), text) for text, labels in texts.items()]


def headline(material: Material) -> str:
    """The outcome of the run."""
    results = material.results
    if not results:
        return "No case was run."
    total = sum(len(result.verdicts) for result in results)
    agreeing = sum(v.outcome is Outcome.AGREES for result in results for _, v in result.verdicts)
    bad = sum(result.outcome is not Outcome.AGREES for result in results)
    cases = _counted(len(results), "case")
    if not bad:
        return f"All {total} comparisons of {cases} agree within their numerical uncertainty"
    return f"{bad} of {cases} do not agree: {total - agreeing} of {total} comparisons"


def asked(material: Material) -> str:
    """What was compared, in one sentence."""
    results = material.results
    contacts = sum(not result.published for result in results)
    published = len(results) - contacts
    texts = [f"{_counted(contacts, 'contact')} of a sphere with a coated solid"] if contacts else []
    texts += [_counted(published, "published source")] if published else []
    solved = ", each solved" if len(results) > 1 else ", solved"
    return f"{' and '.join(texts)}{solved} by independent methods." if texts else ""


def _counted(count: int, noun: str) -> str:
    return f"{count} {noun}" if count == 1 else f"{count} {noun}s"


def largest(material: Material) -> list[str]:
    """The largest difference among the comparisons; the largest in the planes, which are not judged."""
    found = [
        (Item(claim, verdict), result)
        for result in material.results
        for claim, verdict in result.verdicts
        if Item(claim, verdict).difference is not None
    ]
    texts = []
    if found:
        item, result = max(found, key=lambda pair: pair[0].difference or 0.0)
        texts.append(
            f"The largest difference is {scientific(item.difference)} {_scale(item.claim)}: "
            f"{_place(item.claim)}, {result.title}."
        )
    gaps = [
        gap[0]
        for result in material.contacts
        if (plane := material.planes.get(result.name)) is not None
        and (gap := plane_difference(plane, float(divisor(result, "sigma_xx", 0.0)))) is not None
    ]
    if gaps:
        texts.append(f"In the pictures, which are not judged, it is {scientific(max(gaps))}.")
    return texts


def not_claimed(material: Material) -> list[str]:
    """The limits of the claim."""
    texts = ["Validation: nothing is compared with an experiment.", _ASSUMED]
    edges = [claim.edge for result in material.results for claim, _ in result.verdicts if claim.edge]
    if edges:
        texts.append(
            f"Points within {100 * max(edges):.0f} % of the contact edge are not judged in {len(edges)} "
            "comparisons."
        )
    elif material.contacts:
        texts.append("No point is left out, the contact edge included.")
    texts.append("U is an estimate, no bound; other problems and faults may fare worse.")
    return texts


def _scale(claim: Claim) -> str:
    quantity = QUANTITIES.get(claim.quantity)
    if quantity is None:
        return "of the peak pressure"
    return _SCALES.get(
        quantity.kind, "of the contact radius" if quantity.unit == "m" else "of the peak pressure"
    )


def chart(material: Material) -> Chart | None:
    """All comparisons of the run; None where there are none."""
    results = material.results
    items = {result: [Item(claim, verdict) for claim, verdict in result.verdicts] for result in results}
    axis = axis_of([item for some in items.values() for item in some])
    if not any(items.values()):
        return None
    if len(results) <= MOST_ROWS:
        rows = [_row(material, result, items[result], axis) for result in results]
        return Chart(rows, draw_axis(axis), 0)
    order = sorted(results, key=lambda result: _badness(result, items[result]))
    rows = [_row(material, result, items[result], axis) for result in order[:OWN_ROWS]]
    groups: dict[str, list[CaseResult]] = {}
    for result in order[OWN_ROWS:]:
        groups.setdefault(_kind(result), []).append(result)
    for kind, members in sorted(groups.items(), key=lambda pair: _badness(pair[1][0], items[pair[1][0]])):
        title = f"{len(members)} more: {kind}"
        rows.append(
            _strip_row(title, "#cases", [item for r in members for item in items[r]], axis, members, "")
        )
    return Chart(rows, draw_axis(axis), len(results) - OWN_ROWS)


def _row(material: Material, result: CaseResult, items: Sequence[Item], axis: Axis) -> StripRow:
    anchor = material.anchors[result]
    return _strip_row(result.title, f"#{anchor}", items, axis, [result], anchor)


def _strip_row(
    title: str,
    href: str,
    items: Sequence[Item],
    axis: Axis,
    members: Sequence[CaseResult],
    anchor: str,
) -> StripRow:
    first = worst(items)
    agreeing = sum(item.verdict.outcome is Outcome.AGREES for item in items)
    outcome = min((result.outcome for result in members), key=lambda o: OUTCOMES[o].rank)
    label = f"{title}: {agreeing} of {len(items)} comparisons agree"
    text = ""
    if first is not None:
        shown = scientific(first.difference) if first.difference is not None else "no result"
        text = f"{shown} {_place(first.claim)}"
        label += f"; look first at {text}"
    return StripRow(
        title,
        href,
        draw_strip(items, axis, label, anchor),
        text,
        str(len(items)) if agreeing == len(items) else f"{agreeing} of {len(items)}",
        OUTCOMES[outcome],
    )


def _place(claim: Claim) -> str:
    """Quantity and line in few words."""
    line = claim.line.replace(", upper side", " upper").replace(", lower side", " lower")
    return symbol_of(claim.quantity) + ("" if claim.line == "contact" else f", {line}")


def _badness(result: CaseResult, items: Sequence[Item]) -> tuple[int, float]:
    return OUTCOMES[result.outcome].rank, -max((item.difference or 0.0 for item in items), default=0.0)


def _kind(result: CaseResult) -> str:
    """The group of cases that one belongs to."""
    if result.published:
        return "published"
    count = len(layers(result)) - 1
    parts = ["uncoated" if count < 1 else "one coating" if count == 1 else "several coatings"]
    parts += ["elastic ball"] if layers(result, BALL) else []
    parts += ["sliding"] if result.problem.get("friction") else []
    return ", ".join(parts)


def tallies(material: Material) -> list[tuple[OutcomeStyle, int]]:
    """How many comparisons have each verdict, the agreeing ones first."""
    results = material.results
    counted = Counter(verdict.outcome for result in results for _, verdict in result.verdicts)
    return [(OUTCOMES[o], counted[o]) for o in reversed(OUTCOMES) if counted[o] or o is Outcome.AGREES]


def worth(material: Material) -> list[Worth]:
    """What is known about the verdicts besides the comparisons: each figure with the page it is on."""
    results, evidence, found = material.results, material.evidence, [*_independent(material)]
    invariants = [one for result in results for one in result.invariants]
    if invariants:
        holding = sum(one.outcome is Outcome.AGREES for one in invariants)
        found.append(_share("invariants hold", holding, len(invariants), "#invariants"))
    studies = evidence.accuracy.verdicts if evidence.accuracy is not None else ()
    if studies:
        agreeing = sum(one.outcome is Outcome.AGREES for one in studies)
        found.append(_share("judged studies agree", agreeing, len(studies), "#semi-analytical-accuracy"))
    known = [item for result in material.contacts for item in accuracies(result)]
    if known:
        ratios = [item.ratio for item in known if item.ratio is not None and isfinite(item.ratio)]
        note = f"median U / error {plain(median(ratios), 2)}" if ratios else ""
        covered = sum(item.covered for item in known)
        found.append(replace(_share("true error within U", covered, len(known), "#accuracy"), note=note))
    if material.published:
        counted, _, _ = counts(material.published)
        found.append(Worth("published values counted", str(counted), "#published", None))
    record = evidence.faults
    if record is not None:
        made = _made(material, "faults", record.started, record.commit)
        value = f"{record.caught} of {len(record.rows)}"
        found.append(Worth("planted faults detected", value, "#faults", None, *made))
        if of_method(record):
            noticed, count = method_score(record)
            name = "of these, in the semi-analytical method, noticed by comparison, invariant or study"
            found.append(Worth(name, f"{noticed} of {count}", "#faults", None, kinds(record)))
        if record.alarms:
            count = len(record.controls)
            found.append(_share("negative controls left alone", count - len(record.alarms), count, "#faults"))
    if evidence.mutants is not None:
        caught, count = evidence.mutants.score()
        info = evidence.mutants.info
        made = _made(material, "mutants", info.started, info.commit)
        found.append(Worth("mutants detected", f"{caught} of {count}", "#mutants", None, *made))
    if evidence.alarms is not None:
        judged = evidence.alarms.comparisons + evidence.alarms.invariants
        value = f"{len(evidence.alarms.alarms)} of {judged}"
        made = _made(material, "alarms", evidence.alarms.started, evidence.alarms.commit)
        found.append(Worth("false alarms, random problems", value, "#credibility", None, *made))
    if evidence.maps is not None and evidence.maps.maps:
        made = _made(material, "maps", *made_with(evidence.maps))
        found.append(Worth("assumptions with a map", str(len(evidence.maps.maps)), "#model", None, *made))
    regression = evidence.baseline
    if regression is not None and regression.update is not None:
        same = sum(case.count(State.SAME) for case in regression.cases)
        total = sum(case.count(state) for case in regression.cases for state in State)
        found.append(
            Worth(
                "numbers as in the baseline",
                f"{same} of {total}",
                "#baseline",
                False if regression.unexplained else True if same == total else None,
            )
        )
    tests = evidence.self_tests
    if tests:
        found.append(
            _share("self-tests passed", sum(test.passed for test in tests), len(tests), "#self-tests")
        )
    return found


def _independent(material: Material) -> list[Worth]:
    """Comparisons that agree, by what their two sources have in common."""
    agreed: dict[Independence, list[bool]] = {}
    for result in material.results:
        for claim, verdict in result.verdicts:
            of_kind = agreed.setdefault(independence(claim.between), [])
            of_kind.append(verdict.outcome is Outcome.AGREES)
    kinds = [kind for kind in Independence if kind in agreed]
    return [_share(f"{kind}", sum(agreed[kind]), len(agreed[kind]), "#cases") for kind in kinds]


def _made(material: Material, name: str, started: str, commit: str | None) -> tuple[str, bool]:
    """Date and commit of a record, and whether the code that it judges has changed since."""
    older = name in material.evidence.older
    return f"{started[:10]}, {(commit or 'no commit')[:8]}{', older than code' if older else ''}", older


def _share(name: str, good: int, total: int, href: str) -> Worth:
    return Worth(name, f"{good} of {total}" if total else "none", href, bool(total) and good == total)


def alarms(material: Material) -> list[str]:
    """What fails although every verdict may agree: self-tests, the manifest, the baseline."""
    failed = [test.name for test in material.evidence.self_tests if not test.passed]
    messages = [f"self-tests of the harness: {', '.join(failed)}"] if failed else []
    found = material.evidence.baseline
    if found is not None and found.less:
        messages.append(manifest_message(found.less))
    if found is not None and found.unexplained:
        messages.append(f"numbers differ from the baseline: {baseline_message(found)}")
    return messages


# By the name that the template knows a block of the page by.
FIRST_PAGE: Mapping[str, Callable[[Material], Any]] = {
    "asked": asked,
    "headline": headline,
    "largest": largest,
    "tallies": tallies,
    "alarms": alarms,
    "answered": answered,
    "chart": chart,
    "worth": worth,
    "not_claimed": not_claimed,
}
