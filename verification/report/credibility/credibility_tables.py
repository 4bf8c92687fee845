"""The tables of the credibility page."""

from collections import Counter
from collections.abc import Sequence

from verification.cases.random_problems import FRICTION, MOST_COATINGS, POISSON, RATIO, THICKNESS, THINNEST
from verification.credibility.import_independence import Part
from verification.credibility.manufactured_solutions import DesignOrder
from verification.evidence.alarm_record import AlarmRecord
from verification.evidence.enclosure_record import EnclosureRecord
from verification.judging.verdict import Outcome
from verification.page.number_text import plain
from verification.page.page_parts import Cell, Table, number, outcome_cell, row, tally, words
from verification.page.source_labels import pair_label, source_label
from verification.problem.quantity import SCALARS
from verification.report.tables.case_lookup import layers, scale
from verification.running.case_result import CaseResult

MOST = 30


def range_table(results: Sequence[CaseResult]) -> Table:
    """Ranges of the problems of this run beside those of the random problems."""
    solids = [(layers(result), scale(result, "a_h"), result.problem) for result in results]
    ratios = [E / found[-1][0] for found, _, _ in solids for E, _, _ in found[:-1]]
    depths = [h / a for found, a, _ in solids for _, _, h in found[:-1]]
    poisson = [nu for found, _, _ in solids for _, nu, _ in found]
    friction = [float(problem.get("friction", 0.0)) for _, _, problem in solids]
    counts = [float(len(found) - 1) for found, _, _ in solids if found]
    rows: list[tuple[str, Sequence[float], Sequence[float]]] = [
        ("E of a coating over E of the substrate", ratios, RATIO),
        ("h / a_h of a coating", depths, (min(THINNEST, *THICKNESS), max(THICKNESS))),
        ("Poisson's ratio", poisson, POISSON),
        ("friction f", friction, FRICTION),
        ("coatings", counts, (1.0, float(MOST_COATINGS))),
    ]
    return Table(
        "Ranges of the problems solved.",
        ["quantity", "this run", "random problems"],
        [row(name, _range(found), _range(drawn)) for name, found, drawn in rows],
    )


def design_table(orders: Sequence[DesignOrder]) -> Table:
    """Observed order of convergence of the finite element operator beside its design order."""
    rows = []
    for one in orders:
        css = "flag agrees" if one.as_designed else "flag disagrees"
        rows.append(
            row(
                Cell(f"order {one.order}", one.order),
                number(one.harmonic, str),
                number(one.order + 1, str),
                number(one.displacement, "{:.2f}".format, css),
                number(one.order, str),
                number(one.gradient, "{:.2f}".format, css),
                number(one.errors[1]),
            )
        )
    columns = ["elements", "harmonic", "design, u", "observed, u", "design, ∇u", "observed, ∇u"]
    return Table(
        "Finite element operator on manufactured solutions: order in the L2 norm from a mesh to one twice as "
        "fine.",
        [*columns, "error, finer mesh"],
        rows,
    )


def parameter_table(results: Sequence[CaseResult]) -> Table:
    """The numerical parameter that dominates the uncertainty of each scalar, counted over the cases."""
    counts: dict[tuple[str, str], Counter[str]] = {}
    for result in results:
        for source in result.sources:
            for quantity in SCALARS:
                rows = [(value, parameter) for q, parameter, value in source.budget if q == quantity]
                if rows:
                    counts.setdefault((source.source, quantity), Counter())[max(rows)[1]] += 1
    found = []
    for (name, quantity), counter in sorted(counts.items()):
        text = ", ".join(f"{parameter} ({count})" for parameter, count in counter.most_common())
        found.append(row(source_label(name), quantity.replace("_", " "), words(text)))
    return Table(
        "Numerical parameter with the largest share of U, with the number of cases.",
        ["method", "quantity", "dominating parameter"],
        found,
    )


def pair_table(results: Sequence[CaseResult]) -> Table:
    """Comparisons of each pair of sources: how many agree, the largest difference, the least margin."""
    verdicts = [(c, v) for result in results for c, v in result.verdicts]
    rows = []
    for pair in dict.fromkeys(claim.between for claim, _ in verdicts):
        mine = [v for c, v in verdicts if c.between == pair]
        good = sum(v.outcome is Outcome.AGREES for v in mine)
        largest = max((v.difference for v in mine if v.difference is not None), default=None)
        widest = max((v.uncertainty for v in mine if v.uncertainty is not None), default=None)
        rows.append(row(pair_label(pair), tally(good, len(mine)), number(largest), number(widest)))
    return Table(
        "All comparisons by pair of sources; differences and U as fractions of their scale.",
        ["between", "agree", "largest difference", "largest U"],
        rows,
    )


def two_sided_table(record: EnclosureRecord | None) -> Table:
    """Energy bounds by finite elements: ends relative to the enclosed values, effectivity."""
    rows = []
    for one in record.enclosures if record else ():
        if (two := one.two_sided) is not None:
            cells = []
            for (low, high), exact, effectivity in two.compared:
                cells += [
                    number(1 - low / exact),
                    number(high / exact - 1),
                    number(effectivity, "{:.1f}".format),
                ]
            rows.append(row(one.name, *cells))
    return Table(
        "Bounds by finite elements at the enclosed contact radius: distance of either end from the enclosed "
        "value, relative; effectivity, the proven error of the displacements over the true one.",
        ["problem", "below", "above", "effectivity", "below", "above", "effectivity"],
        rows,
        [("", 1), ("stiffness of a flat punch", 3), ("approach", 3)],
    )


def import_table(parts: Sequence[Part]) -> Table:
    """Imports of each part from outside, with those that are forbidden."""
    rows = []
    for part in parts:
        bad = [*part.forbidden, *part.hidden]
        modules = words(", ".join(part.modules))
        forbidden = Cell("; ".join(bad) or "none", css=f"words flag {'disagrees' if bad else 'agrees'}")
        rows.append(row(part.name, number(part.files, str), number(part.statements, str), modules, forbidden))
    return Table(
        "Imports of each part, without its own and the standard library.",
        ["part", "files", "imports", "modules from outside", "forbidden imports"],
        rows,
    )


def alarm_table(record: AlarmRecord | None) -> Table:
    """The false alarms on record."""
    alarms = record.alarms if record is not None else ()
    rows = [
        row(
            Cell(alarm.title, note=alarm.case, css="words"),
            outcome_cell(alarm.outcome),
            alarm.quantity,
            alarm.line,
            " – ".join(source_label(source) for source in alarm.between),
            words(alarm.reason),
        )
        for alarm in alarms[:MOST]
    ]
    more = f" The first {MOST} of {len(alarms)}." if len(alarms) > MOST else ""
    return Table(
        f"Verdicts of clean problems that are not AGREES.{more}",
        ["problem", "verdict", "quantity", "line", "between", "reason"],
        rows,
    )


def _range(found: Sequence[float]) -> str:
    if not found:
        return "–"
    low, high = min(found), max(found)
    return plain(low, 3) if low == high else f"{plain(low, 3)} to {plain(high, 3)}"
