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
from verification.page.page_parts import Cell, Table, number, outcome_cell, row, table_of, tally, words
from verification.page.source_labels import pair_label, source_label
from verification.problem.quantity import SCALARS
from verification.report.tables.case_lookup import layers, scale
from verification.running.case_result import CaseResult

MOST = 30


def range_table(results: Sequence[CaseResult]) -> Table:
    """Ranges of the problems of this run beside those of the random problems."""
    solids = [(layers(result), scale(result, "a_h"), result.problem) for result in results]
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


def design_table(orders: Sequence[DesignOrder]) -> Table:
    """Observed order of convergence of the finite element operator beside its design order."""

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
        rows.append(row(pair_label(pair), tally(good, len(mine)), largest, widest))
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
            cells: list[Cell | float] = []
            for (low, high), exact, effectivity in two.compared:
                cells += [1 - low / exact, high / exact - 1, number(effectivity, "{:.1f}".format)]
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

    def forbidden(part: Part) -> Cell:
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


def alarm_table(record: AlarmRecord | None) -> Table:
    """The false alarms on record."""
    alarms = record.alarms if record is not None else ()
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
