"""First page of a report: problem, sources, outcome, its credibility, limits of the claim."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from math import isfinite
from statistics import median
from typing import Any

from verification.credibility.faults.first_notice import (
    COUNTED,
    Noticed,
    kinds,
    method_score,
    noticed,
    of_method,
)
from verification.judging.verdict import Claim, Outcome
from verification.page.number_text import plain, scientific
from verification.page.source_labels import OUTCOMES, OutcomeStyle, source_label, symbol_of
from verification.problem.coated_contact import BALL
from verification.problem.line_profile import EDGE_LINE
from verification.problem.quantity import QUANTITIES
from verification.regression.baseline_change import State, baseline_message
from verification.regression.manifest import manifest_message
from verification.report.figures.field_pictures import plane_difference
from verification.report.figures.verdict_strips import Axis, axis_of, draw_axis, draw_strip, items_of, worst
from verification.report.report_material import Material, made_with
from verification.report.sections.accuracy_section import accuracies
from verification.report.tables.case_lookup import divisor, layers
from verification.running.case_result import CaseResult
from verification.running.published_counts import counts
from verification.sampling.line_sampling import CLEAR
from verification.sources.source_record import Independence
from verification.sources.source_registry import CLOSED, SOURCES, independence

MOST_ROWS = 20  # strips of the first page; of more cases the worst have their own, the others share some
OWN_ROWS = 6  # with them the page of the shipped cases has less than 600 words
# What a difference is divided by, in words, by the kind of its quantity.
_SCALES = {"scalar": "of its value", "slope": "of its value", "displacement": "of the approach"}


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


def contents(material: Material) -> dict[str, Any]:
    """What the template of the first page shows."""
    return {
        "asked": _asked(material),
        "headline": _headline(material),
        "largest": _largest(material),
        "tallies": _tallies(material),
        "alarms": _alarms(material),
        "answered": _answered(material),
        "chart": chart(material),
        "worth": worth(material),
        "left_out": left_out(material.results),
        "shaped": any(result.problem.get("indenter") for result in material.contacts),
    }


def _answered(material: Material) -> list[tuple[str, str]]:
    """(key of a text in the template, labels) of the sources of the run, in the order of the registry."""
    found = {name for result in material.results for claim, _ in result.verdicts for name in claim.between}
    texts: dict[str, list[str]] = {}
    for name in sorted(found, key=lambda name: (list(SOURCES).index(name) if name in SOURCES else 99, name)):
        texts.setdefault("closed" if name in CLOSED else name, []).append(source_label(name))
    return [(key, ", ".join(labels)) for key, labels in texts.items()]


def _headline(material: Material) -> str:
    results = material.results
    if not results:
        return "No case was run."
    total = sum(len(result.verdicts) for result in results)
    agreeing = sum(v.outcome is Outcome.AGREES for result in results for _, v in result.verdicts)
    bad = sum(result.outcome is not Outcome.AGREES for result in results)
    cases = _counted(results, "case")
    if not bad:
        return f"All {total} comparisons of {cases} agree within their numerical uncertainty"
    return f"{bad} of {cases} do not agree: {total - agreeing} of {total} comparisons"


def _asked(material: Material) -> str:
    """What was compared, in one sentence."""
    contacts, published = material.contacts, material.published
    texts = [f"{_counted(contacts, 'contact')} with a coated solid"] if contacts else []
    texts += [_counted(published, "published source")] if published else []
    return f"{' and '.join(texts)}, solved by independent methods." if texts else ""


def _counted(results: Sequence[CaseResult], noun: str) -> str:
    return f"{len(results)} {noun}{'' if len(results) == 1 else 's'}"


def _largest(material: Material) -> list[str]:
    """The largest difference, that next to edges that are not round, and that in planes, unjudged."""
    found = [
        (item.difference, item.claim, result)
        for result in material.results
        for item in items_of(result.verdicts)
        if item.difference is not None
    ]
    found.sort(key=lambda one: one[0])
    texts = []
    if away := [one for one in found if one[1].line != EDGE_LINE]:
        difference, claim, result = away[-1]
        texts.append(
            f"The largest difference is {scientific(difference)} {_scale(claim)}: "
            f"{_place(claim)}, {result.title}."
        )
    if edge := [one for one in found if one[1].line == EDGE_LINE]:
        worst = f"{scientific(edge[-1][0])}, cap {edge[-1][1].cap:g}"
        texts.append(f"Beside edges not round, in {len(edge)} comparisons: {worst}.")
    gaps = [
        (plane_difference(material.planes[result.name], float(divisor(result, "sigma_xx", 0.0))), result.name)
        for result in material.contacts
        if result.name in material.planes
    ]
    if known := [(gap, name) for gap, name in gaps if gap is not None]:
        gap, name = max(known)
        texts.append(f"In the pictures of sigma_xx, which are not judged: {scientific(gap)} ({name}).")
    return texts


def left_out(results: Sequence[CaseResult]) -> tuple[float, int]:
    """The widest zone at the edge that is not judged [% of a], the number of comparisons with one."""
    zones = [
        CLEAR
        if result.problem.get("indenter") and claim.line.startswith(("off plane", "oblique", "interface"))
        else claim.edge
        for result in results
        for claim, _ in result.verdicts
    ]
    return 100 * max(zones, default=0.0), sum(zone > 0 for zone in zones)


def _scale(claim: Claim) -> str:
    quantity = QUANTITIES.get(claim.quantity)
    if quantity is None:
        return "of the peak pressure"
    return _SCALES.get(
        quantity.kind, "of the contact radius" if quantity.unit == "m" else "of the peak pressure"
    )


def chart(material: Material) -> dict[str, Any] | None:
    """All comparisons of the run, a row for each strip over one axis; None where there are none."""
    results, anchors = list(material.results), material.anchors
    items = [item for result in results for item in items_of(result.verdicts)]
    if not items:
        return None
    axis = axis_of(items)
    own, others = results, []
    if len(results) > MOST_ROWS:
        results.sort(key=_badness)
        own, others = results[:OWN_ROWS], results[OWN_ROWS:]
    rows = [_strip_row(result.title, anchors[result], axis, [result]) for result in own]
    groups: dict[str, list[CaseResult]] = {}
    for result in others:
        groups.setdefault(_kind(result), []).append(result)
    rows += [_strip_row(f"{len(some)} more: {kind}", "", axis, some) for kind, some in groups.items()]
    return {"rows": rows, "scale": draw_axis(axis), "grouped": len(others)}


def _strip_row(title: str, anchor: str, axis: Axis, members: Sequence[CaseResult]) -> dict[str, Any]:
    """Cases of one strip, the comparison that a reader looks at first, the verdict.

    anchor : of a case on its own.
    """
    items = [item for result in members for item in items_of(result.verdicts)]
    first = worst(items)
    agreeing = sum(item.verdict.outcome is Outcome.AGREES for item in items)
    outcome = min((result.outcome for result in members), key=lambda o: OUTCOMES[o].rank)
    label, text = f"{title}: {agreeing} of {len(items)} comparisons agree", ""
    if first is not None:
        shown = scientific(first.difference) if first.difference is not None else "no result"
        text = f"{shown} {_place(first.claim)}"
        label += f"; look first at {text}"
    count = str(len(items)) if agreeing == len(items) else f"{agreeing} of {len(items)}"
    return {
        "title": title,
        "href": f"#{anchor or 'cases'}",
        "strip": draw_strip(items, axis, label, anchor),
        "first": text,
        "count": count,
        "style": OUTCOMES[outcome],
    }


def _place(claim: Claim) -> str:
    """Quantity and line in few words."""
    line = claim.line.replace(", upper side", " upper").replace(", lower side", " lower")
    return symbol_of(claim.quantity) + ("" if claim.line == "contact" else f", {line}")


def _badness(result: CaseResult) -> tuple[int, float]:
    largest = max((item.difference or 0.0 for item in items_of(result.verdicts)), default=0.0)
    return OUTCOMES[result.outcome].rank, -largest


def _kind(result: CaseResult) -> str:
    """The group of cases that one belongs to."""
    if result.published:
        return "published"
    count = len(layers(result.problem)) - 1
    parts = ["uncoated" if count < 1 else "one coating" if count == 1 else "several coatings"]
    parts += ["elastic ball"] if layers(result.problem, BALL) else []
    parts += ["sliding"] if result.problem.get("friction") else []
    return ", ".join(parts)


def _tallies(material: Material) -> list[tuple[OutcomeStyle, int]]:
    """How many comparisons have each verdict, the agreeing ones first."""
    counted = Counter(verdict.outcome for result in material.results for _, verdict in result.verdicts)
    return [(OUTCOMES[o], counted[o]) for o in reversed(OUTCOMES) if counted[o] or o is Outcome.AGREES]


def worth(material: Material) -> list[Worth]:
    """What is known about the verdicts besides the comparisons: each figure with the page it is on."""
    evidence, found = material.evidence, _independent(material)

    def share(name: str, held: Sequence[bool], href: str, note: str = "") -> None:
        if held:
            found.append(Worth(name, _share(held), href, all(held), note))

    def recorded(
        name: str, value: str, href: str, key: str, started: str, commit: str | None, also: str = ""
    ) -> None:
        older = key in evidence.older
        note = f"{also}{started[:10]}, {(commit or 'no commit')[:8]}{', older than code' if older else ''}"
        found.append(Worth(name, value, href, None, note, older))

    invariants = [one for result in material.results for one in result.invariants]
    share("invariants hold", [one.outcome is Outcome.AGREES for one in invariants], "#invariants")
    studies = evidence.accuracy.verdicts if evidence.accuracy is not None else ()
    held = [one.outcome is Outcome.AGREES for one in studies]
    share("judged studies agree", held, "#semi-analytical-accuracy")
    known = [item for result in material.contacts for item in accuracies(result)]
    ratios = [item.ratio for item in known if item.ratio is not None and isfinite(item.ratio)]
    note = f"median U / error {plain(median(ratios), 2)}" if ratios else ""
    share("true error within U", [item.covered for item in known], "#accuracy", note)
    if material.published:
        count = str(counts(material.published)[0])
        found.append(Worth("published values counted", count, "#published", None))
    if faults := evidence.faults:
        value = f"{faults.caught} of {len(faults.tried)}"
        recorded("planted faults detected", value, "#faults", "faults", faults.started, faults.commit)
        if of_method(faults):
            seen, total = method_score(faults)
            apart = (*COUNTED, Noticed.EQUIVALENT, Noticed.NOT_TRIED)
            left = ", ".join(row.name for row in of_method(faults) if noticed(row) not in apart)
            note = "; ".join(filter(None, (kinds(faults), left and f"by none of these: {left}")))
            found.append(Worth("of these, semi-analytical", f"{seen} of {total}", "#faults", None, note))
        if faults.alarms:
            silent = [row not in faults.alarms for row in faults.controls]
            share("negative controls left alone", silent, "#faults")
    if alarms := evidence.alarms:
        value = f"{len(alarms.false_alarms)} of {alarms.comparisons + alarms.invariants}"
        vague = f"{len(alarms.inconclusive)} inconclusive, " if alarms.inconclusive else ""
        recorded("false alarms", value, "#credibility", "alarms", alarms.started, alarms.commit, vague)
    if evidence.maps is not None and evidence.maps.maps:
        count = str(len(evidence.maps.maps))
        recorded("assumptions mapped", count, "#model", "maps", *made_with(evidence.maps))
    regression = evidence.baseline
    if regression is not None and regression.update is not None:
        same = sum(case.count(State.SAME) for case in regression.cases)
        total = sum(case.count(state) for case in regression.cases for state in State)
        good = False if regression.unexplained else True if same == total else None
        value = f"all {total}" if same == total else f"{same} of {total}"
        found.append(Worth("numbers of the baseline", value, "#baseline", good))
    share("self-tests passed", [test.passed for test in evidence.self_tests], "#self-tests")
    return found


def _independent(material: Material) -> list[Worth]:
    """Comparisons that agree, by what their two sources have in common."""
    agreed: dict[Independence, list[bool]] = {}
    for result in material.results:
        shaped = result.problem.get("indenter") is not None
        for claim, verdict in result.verdicts:
            kind = independence(claim.between, shaped=shaped)
            agreed.setdefault(kind, []).append(verdict.outcome is Outcome.AGREES)
    return [
        Worth(f"{kind}", _share(agreed[kind]), "#cases", all(agreed[kind]))
        for kind in Independence
        if kind in agreed
    ]


def _share(held: Sequence[bool]) -> str:
    return f"all {len(held)}" if all(held) else f"{sum(held)} of {len(held)}"


def _alarms(material: Material) -> list[str]:
    """What fails although every verdict may agree: self-tests, the manifest, the baseline."""
    failed = [test.name for test in material.evidence.self_tests if not test.passed]
    messages = [f"self-tests of the harness: {', '.join(failed)}"] if failed else []
    found = material.evidence.baseline
    if found is not None and found.less:
        messages.append(manifest_message(found.less))
    if found is not None and found.unexplained:
        messages.append(f"numbers differ from the baseline: {baseline_message(found)}")
    return messages
