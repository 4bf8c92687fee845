"""Generated blocks of pages: ``{generated} name`` is replaced by what ``BLOCKS[name]`` returns.

Every number comes from the baseline, a record of this version, or a solve when the manual is built.
"""

import re
from collections.abc import Callable
from datetime import datetime
from importlib.metadata import version
from pathlib import Path

from verification.cases.case_file import default_cases
from verification.cases.published_file import published_cases, read_published
from verification.evidence import alarm_record
from verification.evidence.assumption_maps import read_maps
from verification.evidence.enclosure_record import read_record as read_enclosures
from verification.evidence.fault_record import read_record
from verification.guests.pages import guests_section
from verification.manual.baseline_numbers import FOLDER, baseline, largest, points, stored
from verification.manual.line_limit import line_limit
from verification.manual.markdown_text import paragraphs, shown, symbol, table, text
from verification.manual.tour_output import QUESTIONS, solved
from verification.page.number_text import scientific
from verification.problem.quantity import PEAKS, QUANTITIES
from verification.report.credibility import model_section
from verification.report.credibility.detection_sections import faults_section
from verification.report.sections.first_page import left_out
from verification.running.case_result import CaseResult
from verification.sources.source_registry import METHODS, SOURCES

SOURCE = Path(__file__).parent / "source"
RECORDS = FOLDER.parents[1] / "evidence" / "shipped"
FIELDS = ("stress", "pressure", "displacement")


def headline() -> str:
    """The largest differences of every case of the default run."""
    rows = []
    for name in default_cases():
        result = stored(name)
        scalars = ("peak_pressure", "contact_radius", "approach")
        cells = [scientific(difference(result, quantity), 1) for quantity in scalars]
        exact = [largest(name, (method, "integral_equation"), *FIELDS) for method in METHODS]
        fields = [scientific(value, 1) for value in (largest(name, METHODS, *FIELDS), *exact)]
        rows.append([f"[{text(result.title)}](/cases/{name}.md)", *cells, *fields, str(len(result.verdicts))])
    head = ["case", "$p_0$", "$a$", r"$\delta$", "lines, both methods", "semi-analytical, exact"]
    last = baseline().last
    made = f"Baseline of {_day(last.when)}, commit {last.commit or 'unknown'}, on {last.machine}."
    return f"{made}\n\n{table([*head, 'finite elements, exact', 'comparisons'], rows, 1)}\n{HEADLINE}"


def difference(result: CaseResult, quantity: str) -> float | None:
    """The relative difference of both methods in a number of the contact; None where it is not compared."""
    found = {claim.quantity: one.difference for claim, one in result.verdicts if claim.between == METHODS}
    return found.get(quantity)


HEADLINE = r"""
$p_0$, $a$, $\delta$: relative difference between both methods; a dash where they are not compared. Lines: the
largest difference of stresses and pressures over the smaller of $p_h$ and $p_0$, of displacements
over the smaller of $\delta_h$ and $\delta$.
"""


def totals() -> str:
    """Counts of the default run, in one sentence."""
    known = baseline()
    contacts = {name: case.manifest for name, case in known.cases.items() if not case.published}
    comparisons = sum(len(c.pairs) for manifest in contacts.values() for c in manifest.comparisons)
    invariants = sum(len(manifest.invariants) for manifest in contacts.values())
    return (
        f"The default run solves {len(contacts)} cases. It judges {comparisons} comparisons at "
        f"{sum(map(points, contacts))} points and {invariants} invariants; the baseline holds "
        f"{known.last.numbers} numbers, those of the published cases included."
    )


def zones() -> str:
    """Comparisons that leave out a zone at the contact edge; cases that compare no largest tension."""
    results = [stored(name) for name in default_cases()]
    share, count = left_out(results)
    total = sum(len(result.verdicts) for result in results)
    without = [
        f"[{text(result.title)}](/cases/{result.name}.md)"
        for result in results
        if not {claim.quantity for claim, _ in result.verdicts} & set(PEAKS)
    ]
    return (
        f"{count} of {total} comparisons, all of contacts that are not round, have no points within "
        f"{share:.0f} % of $a$ of the contact edge. {len(results) - len(without)} of {len(results)} cases "
        "also compare the largest tension of the surface and its place, which each source finds in its own "
        f"solution; these do not: {'; '.join(without)}."
    )


def published_counts() -> str:
    """Number of values of each published case, with what departs."""
    rows = []
    for path in published_cases().values():
        case = read_published(path)
        values = sum(len(item.text) for item in case.columns)
        counted = sum(item.counted.sum() for item in case.columns)
        departed = sum((item.departure != 0).sum() for item in case.columns)
        name = f"[{text(case.title)}](/published/{case.name}.md)"
        rows.append([name, *map(str, (case.citation["year"], values, counted, departed))])
    total = ["all", "", *(str(sum(int(row[i]) for row in rows)) for i in (2, 3, 4))]
    head = ["case", "year", "values", "counted", "departures"]
    return table(head, [*rows, total], 1)


def quantities() -> str:
    """Every quantity with name in files, unit, scale, cap."""
    rows = [
        [f"`{q.name}`", symbol(q.name), text(q.meaning), q.kind, q.unit, scientific(q.cap, 1)]
        for q in QUANTITIES.values()
    ]
    return table(["name in files", "symbol", "meaning", "kind", "unit", "cap"], rows, 5)


def sources() -> str:
    """Every source of numbers."""
    rows = [
        [f"`{s.name}`", s.label, s.kind.value, f"`{s.package}`" * bool(s.package)] for s in SOURCES.values()
    ]
    return table(["name in files", "label", "kind", "code"], rows)


def invariants() -> str:
    """Every invariant of the default run: how often judged, at how many points, largest bound."""
    found: dict[str, list[tuple[int, float]]] = {}
    for case in baseline().cases.values():
        if not case.published:
            for law, _, _, points, widest in case.manifest.invariants:
                plain = re.sub(r"^ball, |, (coating|interface) \d+|, substrate", "", law)
                found.setdefault(plain, []).append((points, widest))
    rows = [
        [law, str(len(all_)), str(sum(n for n, _ in all_)), scientific(max(U for _, U in all_))]
        for law, all_ in sorted(found.items())
    ]
    return table(["invariant", "judged", "residuals", "largest bound"], rows, 1)


def fault_score() -> str:
    """Planted faults: how many are caught, by group, and those that are not."""
    record = read_record(RECORDS)
    assert record is not None
    return paragraphs(part for part in faults_section(record).parts if not part.title)


def false_alarms() -> str:
    """Verdicts other than AGREES on random problems without an error."""
    record = alarm_record.read_record(RECORDS)
    assert record is not None
    drawn, of_values = [], []
    for one in record.campaigns:
        counts = one.problems, one.agreeing, len(one.vague), one.comparisons, len(one.wrong)
        drawn.append([one.kind, str(one.seed), *map(str, counts), f"{one.largest:.2f}"])
        for r in one.ratios:
            if r.values:
                figures = str(r.values), f"{r.within:.4%}", f"{r.largest:.2f}", f"{r.median:.3g}"
                of_values.append([f"{one.kind}, {one.seed}", SOURCES[r.source].label, *figures])
    bounds = "; ".join(
        f"{of.wrong} of {of.problems} {kind} raised a false alarm (at 95 %: at most {100 * of.rate:.2g} %)"
        for kind, of in record.kinds.items()
    )
    head = [
        "random",
        "seed",
        "problems",
        "agree",
        "inconclusive",
        "comparisons",
        "with a false alarm",
        "largest difference/$U$",
    ]
    of_value = ["random", "method", "values", "error within $U$", "largest error/$U$", "median of $U$/error"]
    tables = table(head, drawn, 2), table(of_value, of_values, 2)
    return "\n\n".join((f"Drawn last on {_day(record.campaigns[-1].started)}: {bounds}.", *tables))


def citation() -> str:
    """An entry of BibTeX for this version."""
    fields = {
        "author": "{the coatcheck developers}",
        "title": "coatcheck: verification of coated point contact by two independent methods and exact "
        "references",
        "version": version("coatcheck"),
        "doi": "",
    }
    lines = (f"  {name} = {{{value}}}," for name, value in fields.items())
    return "\n".join(["```bibtex", "@software{coatcheck,", *lines, "}", "```"])


def real_guests() -> str:
    """Codes of others examined: largest differences, time, memory; how errors fall; what to know."""
    tables = (guests_section.differences(), guests_section.refinement(), guests_section.notes())
    return "\n\n".join(shown(one) for one in tables)


def history() -> str:
    """Updates of the baseline with their reasons, the last first."""
    rows = [[_day(u.when), str(u.numbers), text(u.why)] for u in reversed(baseline().history)]
    return table(["date", "numbers", "reason"], rows)


def enclosures() -> str:
    """Every enclosed problem with the middle of its bounds, rounded to twelve digits."""
    record = read_enclosures(RECORDS)
    assert record is not None
    rows = []
    for one in record.enclosures:
        problem = one.problem
        layers = ", ".join(
            f"({E / one.substrate[0]:g}, {nu:g}, {h / problem.a_h:g})" for E, nu, h in one.coatings
        )
        scales = (problem.a_h, problem.delta_h, problem.p_h)
        values = [f"{b.middle / scale:.12f}" for b, scale in zip(one.bounds, scales, strict=False)]
        width = scientific(max(b.width for b in one.bounds), 1)
        rows.append([f"`{one.name}`", layers or "none", f"{one.substrate[1]:g}", *values, width])
    head = ["problem", r"layers $(E/E_s, \nu, h/a_h)$", r"$\nu_s$"]
    head += ["$a/a_h$", r"$\delta/\delta_h$", "$p/p_h$", "width"]
    return (
        f"Made {_day(record.started)}, commit {record.commit or 'unknown'}, on {record.machine}, in "
        f"{record.seconds:.0f} s with python-flint {record.versions.get('python-flint', 'unknown')}. "
        "$E_s$, $\\nu_s$ of the substrate; $p$ on the axis; the largest relative width of all values of the "
        "problem, $\\sigma_{xx}$ included.\n\n" + table(head, rows, 1)
    )


def assumption_costs() -> str:
    """Places at which each measured assumption costs 0.1, 1 and 5 %, and the largest change of its map."""
    maps = read_maps(RECORDS)
    assert maps is not None
    return paragraphs(model_section.parts(maps.maps))


def _day(when: str) -> str:
    return datetime.fromisoformat(when).date().isoformat()


_COUNTS = (headline, totals, zones, published_counts, invariants, fault_score, false_alarms, enclosures)
_TEXTS = (quantities, sources, real_guests, citation, history, solved, line_limit, assumption_costs)
BLOCKS: dict[str, Callable[[], str]] = {one.__name__: one for one in _COUNTS + _TEXTS} | QUESTIONS
