"""First page of a report: what agrees, what that is worth, what is left out, what is not verified."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from math import isfinite
from statistics import median
from typing import Any

from verification.cases.drawn_ranges import MOST_COATINGS
from verification.credibility.model_error import ASSUMPTIONS
from verification.evidence.code_record import shared_functions
from verification.evidence.first_notice import by_place, score
from verification.judging.verdict import Claim, Outcome, Verdict
from verification.page.number_text import plain, scientific
from verification.page.source_labels import OUTCOMES, source_label, symbol_of
from verification.problem.line_profile import EDGE_LINE
from verification.problem.quantity import QUANTITIES, SCALARS, SLOPES
from verification.regression.baseline_change import State, baseline_message
from verification.regression.manifest import manifest_message
from verification.report.figures.field_pictures import plane_difference
from verification.report.figures.verdict_strips import Axis, axis_of, draw_axis, draw_strip, items_of, worst
from verification.report.report_material import ReportMaterial
from verification.report.sections.accuracy_section import accuracies
from verification.report.tables.case_lookup import divisor, layers
from verification.running.case_result import CaseResult
from verification.running.published_counts import counts
from verification.sampling.line_sampling import CLEAR
from verification.sources.source_record import Independence
from verification.sources.source_registry import CLOSED, METHODS, SOURCES, independence

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


def contents(material: ReportMaterial) -> dict[str, Any]:
    """Content of the template of the first page."""
    outcomes = Counter(verdict.outcome for result in material.results for _, verdict in result.verdicts)
    return {
        "contacts": material.contacts,
        "sources": material.published,
        "results": material.results,
        "bad": sum(result.outcome is not Outcome.AGREES for result in material.results),
        "agreeing": outcomes[Outcome.AGREES],
        "total": outcomes.total(),
        "largest": _largest(material),
        # the agreeing ones first
        "tallies": [
            (OUTCOMES[one], outcomes[one])
            for one in reversed(OUTCOMES)
            if outcomes[one] or one is Outcome.AGREES
        ],
        "alarms": _alarms(material),
        "answered": _answered(material),
        "agreements": agreements(material),
        "shared": shared(material),
        "imports": bool(material.evidence.parts),
        "chart": chart(material),
        "worth": worth(material),
        "model": model_costs(material),
        "left_out": left_out(material.results),
        "most_coatings": max([MOST_COATINGS, *(len(layers(one.problem)) - 1 for one in material.contacts)]),
        "validated": material.evidence.validation is not None,
        "shaped": any(result.problem.get("indenter") for result in material.contacts),
    }


def _answered(material: ReportMaterial) -> list[tuple[str, str]]:
    """(key of a text in the template, labels) of the sources of the run, in the order of the registry."""
    found = {name for result in material.results for claim, _ in result.verdicts for name in claim.between}
    texts: dict[str, list[str]] = {}
    for name in sorted(found, key=lambda name: (list(SOURCES).index(name) if name in SOURCES else 99, name)):
        texts.setdefault("closed" if name in CLOSED else name, []).append(source_label(name))
    return [(key, ", ".join(labels)) for key, labels in texts.items()]


def _largest(material: ReportMaterial) -> list[str]:
    """The largest difference, that next to edges that are not round, and that in planes, unjudged."""
    found = [
        (item.difference, item.claim, result.title)
        for result in material.results
        for item in items_of(result.verdicts)
        if item.difference is not None
    ]
    edge, away = ([one for one in found if (one[1].line == EDGE_LINE) is beside] for beside in (True, False))
    texts = []
    if away:
        gap, claim, title = max(away, key=lambda one: one[0])
        where = " away from edges that are not round" if edge else ""
        size = f"{scientific(gap)} {_scale(claim)}"
        texts.append(f"The largest difference{where} is {size}: {_place(claim)}, {title}.")
    if edge:
        gap, claim, _ = max(edge, key=lambda one: one[0])
        texts.append(
            f"Beside them it is {scientific(gap)}, in {len(edge)} comparisons with cap {claim.cap:g}."
        )
    gaps = [
        (apart, result.name)
        for result in material.contacts
        if (plane := material.planes.get(result.name)) is not None
        and (apart := plane_difference(plane, float(divisor(result, "sigma_xx", 0.0)))) is not None
    ]
    if gaps:
        gap, name = max(gaps)
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


def chart(material: ReportMaterial) -> dict[str, Any] | None:
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
    rows += [_strip_row(f"{len(others)} more", "", axis, others)] if others else []
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


def repeated(material: ReportMaterial) -> set[tuple[str, int]]:
    """The comparisons (case, number) that repeat those of another case: friction leaves the contact as it is.

    They compare the same numbers of a contact, or the pressure, of the same sources with the same result.
    """
    seen: set[tuple[Any, ...]] = set()
    again = set()
    for result in material.contacts:
        solved = {k: v for k, v in result.problem.items() if k != "friction"}
        for number, (claim, _) in enumerate(result.verdicts):
            if claim.quantity not in (*SCALARS, *SLOPES, "pressure"):
                continue
            found = (result.profile_of.get(("contact_radius", "contact", one)) for one in claim.between)
            radii = [f"{one.value[0]:.10g}" for one in found if one is not None]
            key = (str(solved), claim.quantity, claim.line, claim.between, *radii)
            if key in seen:
                again.add((result.name, number))
            seen.add(key)
    return again


def agreements(material: ReportMaterial) -> list[Worth]:
    """Agreement by what the sources share, and how well they agree.

    Comparisons that repeat another case's are not counted again.
    """
    again = repeated(material)
    found: dict[Independence, list[Verdict]] = {}
    for result in material.results:
        for number, (claim, verdict) in enumerate(result.verdicts):
            if (result.name, number) not in again:
                found.setdefault(independence(claim.between), []).append(verdict)
    rows = []
    for kind in (kind for kind in Independence if kind in found):
        held = [one.outcome is Outcome.AGREES for one in found[kind]]
        gaps = [one.difference for one in found[kind] if one.difference is not None]
        note = f"largest difference {scientific(max(gaps))}" if gaps else ""
        rows.append(Worth(f"{kind}", _share(held), "#cases", all(held), note))
    if again:
        text = "friction leaves the contact as it is"
        rows.append(Worth("not counted again", str(len(again)), "#cases", None, text))
    return rows


def shared(material: ReportMaterial) -> list[tuple[str, str]]:
    """Common parts of both methods, part by part, from the imports and the registry of sources."""
    parts = material.evidence.parts
    if not parts:
        return [("code", "not measured: the source of the packages could not be read")]
    first, second = parts[:2]
    forbidden = [text for part in parts for text in (*part.forbidden, *part.hidden)]
    counted = sum(part.statements for part in parts)
    common = shared_functions(first, second)
    special = [name for name in common if name.startswith("scipy.special")]
    nodes = [name for name in common if "gauss" in name or "roots_" in name]
    packages = ", ".join(sorted(set(first.packages) & set(second.packages)))
    equations = {SOURCES[name].equation for name in METHODS}
    one_equation = len(equations) == 1 and equations != {""}
    with_method = [one.label for one in SOURCES.values() if one.equation and one.name not in METHODS]
    return [
        ("code", "; ".join(forbidden[:3]) or f"none, by {counted} imports; both use {packages}"),
        (
            "equation",
            ", ".join(sorted(equations))
            if one_equation
            else f"none; the {', '.join(with_method)} has that of the semi-analytical method, coded twice",
        ),
        ("special functions", ", ".join(special) or "none"),
        ("quadrature nodes", ", ".join(nodes) or "none"),
    ]


def model_costs(material: ReportMaterial) -> list[Worth]:
    """The largest cost of each assumption among the cases of the run, as far as it is known."""
    rows = []
    titles = {result.name: result for result in material.contacts}
    for title in (one.title for one in ASSUMPTIONS.values()):
        found = [
            (cost, titles[name])
            for name, model in material.evidence.models.items()
            if name in titles and (cost := model.largest(assumption=title))
        ]
        if found:
            cost, result = max(found, key=lambda one: one[0].size)
            rows.append(Worth(title, cost.words, f"#{material.anchors[result]}", None, result.title))
    return rows


def worth(material: ReportMaterial) -> list[Worth]:
    """Evidence on the verdicts besides the comparisons: each figure with the page it is on."""
    evidence, found = material.evidence, list[Worth]()

    def share(name: str, held: Sequence[bool], href: str, note: str = "") -> None:
        if held:
            found.append(Worth(name, _share(held), href, all(held), note))

    def recorded(name: str, good: int, total: int, href: str, record: Any, also: str = "") -> None:
        older = href.removeprefix("#") in evidence.older
        dated = f"{record.started[:10]}, {(record.commit or 'no commit')[:8]}"
        note = f"{also}{dated}{', older than code' if older else ''}"
        found.append(Worth(name, f"{good} of {total}", href, None, note, older))

    known = [item for result in material.contacts for item in accuracies(result)]
    ratios = [item.ratio for item in known if item.ratio is not None and isfinite(item.ratio)]
    note = f"median U / error {plain(median(ratios), 2)}" if ratios else ""
    share("true error within U", [item.covered for item in known], "#accuracy", note)
    for kind, of in evidence.alarms.kinds.items() if evidence.alarms else ():
        seeds = ", ".join(str(one.seed) for one in of.campaigns)
        vague = sum(len(one.vague) for one in of.campaigns)
        note = f"{vague} inconclusive; seeds {seeds}; rate below {plain(100 * of.rate, 2)} % (95 % sure); "
        name = f"random {kind} with a false alarm"
        recorded(name, of.wrong, of.problems, "#alarms", of.campaigns[-1], note)
    if faults := evidence.faults:
        for place, rows in by_place(faults).items():
            # what judges a method shows in self-tests, published tables and the manifest, too
            anyhow = place in ("harness", "references")
            good, total = (sum(row.caught for row in rows), len(rows)) if anyhow else score(rows)
            if total:
                also = "by any check; " if anyhow else ""
                recorded(f"faults planted in the {place} noticed", good, total, "#faults", faults, also)
        silent = [row not in faults.alarms for row in faults.controls]
        share("runs without a fault left alone", silent if not all(silent) else (), "#faults")
    if measured := evidence.validation:
        compared = [one for one in measured.sets if not one.measured.reason]
        if compared:
            mean = max((one.mean for one in compared), key=abs)
            value = f"{100 * mean:+.1f} %".replace("-", "−")
            older = "validation" in evidence.older
            note = f"u_val {plain(100 * float(compared[0].u_val.mean()), 2)} %; compliance alone"
            note += ", older than code" if older else ""
            found.append(Worth("computed less measured modulus", value, "#validation", None, note, older))
    invariants = [one for result in material.results for one in result.invariants]
    held = [one.outcome is Outcome.AGREES for one in invariants]
    share("laws that every solution obeys", held, "#invariants")
    studies = evidence.accuracy.verdicts if evidence.accuracy is not None else ()
    held = [one.outcome is Outcome.AGREES for one in studies]
    share("parts of the method within limits", held, "#semi-analytical-accuracy")
    if material.published:
        count = str(counts(material.published)[0])
        found.append(Worth("published values counted", count, "#published", None))
    regression = evidence.baseline
    if regression is not None and regression.update is not None:
        same = sum(case.count(State.SAME) for case in regression.cases)
        total = sum(case.count(state) for case in regression.cases for state in State)
        as_before = False if regression.unexplained else True if same == total else None
        value = f"all {total}" if same == total else f"{same} of {total}"
        found.append(Worth("numbers as in the baseline", value, "#baseline", as_before))
    share("self-tests passed", [test.passed for test in evidence.self_tests], "#self-tests")
    return found


def _share(held: Sequence[bool]) -> str:
    return f"all {len(held)}" if all(held) else f"{sum(held)} of {len(held)}"


def _alarms(material: ReportMaterial) -> list[str]:
    """Failures although every verdict may agree: self-tests, the manifest, the baseline."""
    failed = [test.name for test in material.evidence.self_tests if not test.passed]
    messages = [f"self-tests of the harness: {', '.join(failed)}"] if failed else []
    found = material.evidence.baseline
    if found is not None and found.less:
        messages.append(manifest_message(found.less))
    if found is not None and found.unexplained:
        messages.append(f"numbers differ from the baseline: {baseline_message(found)}")
    return messages
