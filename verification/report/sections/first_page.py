"""First page of a report: problem, sources, outcome, its credibility, limits of the claim."""

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from math import isfinite
from statistics import median
from typing import Any

from markupsafe import Markup

from verification.credibility.faults.first_notice import kinds, method_score, of_method
from verification.judging.verdict import Claim, Outcome
from verification.page.number_text import plain, scientific
from verification.page.source_labels import OUTCOMES, OutcomeStyle, source_label, symbol_of
from verification.problem.coated_contact import BALL
from verification.problem.line_profile import EDGE_LINE
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
from verification.sampling.line_sampling import CLEAR
from verification.sources.source_record import Independence
from verification.sources.source_registry import CLOSED, SOURCES, independence

MOST_ROWS = 20  # strips of the first page; of more cases the worst have their own, the others share some
OWN_ROWS = 6  # with them the page of the shipped cases has less than 600 words
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
    """(key of a text in the template, labels) of the sources of the run, in the order of the registry."""
    found = {name for result in material.results for claim, _ in result.verdicts for name in claim.between}
    texts: dict[str, list[str]] = {}
    for name in sorted(found, key=lambda name: (list(SOURCES).index(name) if name in SOURCES else 99, name)):
        texts.setdefault("closed" if name in CLOSED else name, []).append(source_label(name))
    return [(key, ", ".join(labels)) for key, labels in texts.items()]


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
    texts = [f"{_counted(contacts, 'contact')} with a coated solid"] if contacts else []
    texts += [_counted(published, "published source")] if published else []
    return f"{' and '.join(texts)}, solved by independent methods." if texts else ""


def _counted(count: int, noun: str) -> str:
    return f"{count} {noun}" if count == 1 else f"{count} {noun}s"


def largest(material: Material) -> list[str]:
    """The largest difference, that next to edges that are not round, and that in planes, unjudged."""
    found = [
        (Item(claim, verdict), result)
        for result in material.results
        for claim, verdict in result.verdicts
        if Item(claim, verdict).difference is not None
    ]
    found.sort(key=lambda pair: pair[0].difference or 0.0)
    texts = []
    if away := [pair for pair in found if pair[0].claim.line != EDGE_LINE]:
        item, result = away[-1]
        texts.append(
            f"The largest difference is {scientific(item.difference)} {_scale(item.claim)}: "
            f"{_place(item.claim)}, {result.title}."
        )
    if edge := [item for item, _ in found if item.claim.line == EDGE_LINE]:
        worst = f"{scientific(edge[-1].difference)}, cap {edge[-1].claim.cap:g}"
        texts.append(f"Beside edges not round, in {len(edge)} comparisons: {worst}.")
    gaps = [
        gap[0]
        for result in material.contacts
        if (plane := material.planes.get(result.name)) is not None
        and (gap := plane_difference(plane, float(divisor(result, "sigma_xx", 0.0)))) is not None
    ]
    if gaps:
        texts.append(f"In the pictures of sigma_xx, which are not judged: {scientific(max(gaps))}.")
    return texts


def left_out(material: Material) -> tuple[float, int]:
    """The widest zone at the contact edge that is not judged [% of a], and the number of comparisons with
    one."""
    zones = [
        CLEAR
        if result.problem.get("indenter") and claim.line.startswith(("off plane", "oblique", "interface"))
        else claim.edge
        for result in material.results
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


def chart(material: Material) -> Chart | None:
    """All comparisons of the run; None where there are none."""
    results, anchors = material.results, material.anchors
    items = {result: [Item(claim, verdict) for claim, verdict in result.verdicts] for result in results}
    axis = axis_of([item for some in items.values() for item in some])
    if not any(items.values()):
        return None
    order = list(results)
    if len(results) > MOST_ROWS:
        order = sorted(results, key=lambda result: _badness(result, items[result]))
    own = order[: MOST_ROWS if len(results) <= MOST_ROWS else OWN_ROWS]
    rows = [_strip_row(r.title, f"#{anchors[r]}", items[r], axis, [r], anchors[r]) for r in own]
    groups: dict[str, list[CaseResult]] = {}
    for result in order[len(own) :]:
        groups.setdefault(_kind(result), []).append(result)
    for kind, members in groups.items():
        every = [item for result in members for item in items[result]]
        rows.append(_strip_row(f"{len(members)} more: {kind}", "#cases", every, axis, members, ""))
    return Chart(rows, draw_axis(axis), len(results) - len(own))


def _strip_row(
    title: str, href: str, items: Sequence[Item], axis: Axis, members: Sequence[CaseResult], anchor: str
) -> StripRow:
    first = worst(items)
    agreeing = sum(item.verdict.outcome is Outcome.AGREES for item in items)
    outcome = min((result.outcome for result in members), key=lambda o: OUTCOMES[o].rank)
    label, text = f"{title}: {agreeing} of {len(items)} comparisons agree", ""
    if first is not None:
        shown = scientific(first.difference) if first.difference is not None else "no result"
        text = f"{shown} {_place(first.claim)}"
        label += f"; look first at {text}"
    count = str(len(items)) if agreeing == len(items) else f"{agreeing} of {len(items)}"
    return StripRow(title, href, draw_strip(items, axis, label, anchor), text, count, OUTCOMES[outcome])


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
    evidence, found = material.evidence, _independent(material)

    def share(name: str, held: Sequence[bool], href: str, note: str = "") -> None:
        if held:
            found.append(Worth(name, _share(held), href, all(held), note))

    def recorded(name: str, value: str, href: str, key: str, started: str, commit: str | None) -> None:
        older = key in evidence.older
        note = f"{started[:10]}, {(commit or 'no commit')[:8]}{', older than code' if older else ''}"
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
            noticed, total = method_score(faults)
            name = "of these, semi-analytical"
            found.append(Worth(name, f"{noticed} of {total}", "#faults", None, kinds(faults)))
        if faults.alarms:
            silent = [row not in faults.alarms for row in faults.controls]
            share("negative controls left alone", silent, "#faults")
    if alarms := evidence.alarms:
        value = f"{len(alarms.alarms)} of {alarms.comparisons + alarms.invariants}"
        recorded("false alarms", value, "#credibility", "alarms", alarms.started, alarms.commit)
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
    "left_out": left_out,
    "shaped": lambda material: any(result.problem.get("indenter") for result in material.contacts),
}
