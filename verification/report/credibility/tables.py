"""The tables of the credibility page."""

from collections import Counter
from collections.abc import Sequence
from math import isfinite

from verification.cases.random_problems import FRICTION, MOST_COATINGS, POISSON, RATIO, THICKNESS, THINNEST
from verification.credibility.accuracy import AccuracyStudy
from verification.credibility.alarms import AlarmRecord
from verification.credibility.faults.record import Record
from verification.credibility.independence import Part
from verification.credibility.manufactured import DesignOrder
from verification.credibility.refinement import QUANTITIES
from verification.judging.verdict import Outcome
from verification.problem.quantity import SCALARS
from verification.report.sections.accuracy import accuracies
from verification.report.tables.cells import Cell, Row, Table
from verification.report.tables.labels import pair_label, source_label
from verification.report.tables.lookup import layers, scale
from verification.report.tables.matrix import outcome_cell
from verification.report.tables.numbers import factor, plain, scientific
from verification.running.result import CaseResult
from verification.sources.registry import METHODS

__all__ = [
    "alarm_table",
    "bracket_table",
    "design_table",
    "import_table",
    "knob_table",
    "order_table",
    "pair_table",
    "range_table",
    "survivor_table",
]

MOST = 30


def range_table(results: Sequence[CaseResult]) -> Table:
    """Between which numbers the problems of this run lie, beside those of random draws."""
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
        "Ranges of what was solved.",
        ["quantity", "this run", "random problems"],
        [Row(Cell(name), [Cell(_range(found)), Cell(_range(drawn))]) for name, found, drawn in rows],
    )


def design_table(orders: Sequence[DesignOrder]) -> Table | None:
    """Observed against design order of the finite element operator; None where nothing was measured."""
    if not orders:
        return None
    rows = []
    for one in orders:
        css = "flag agrees" if one.as_designed else "flag disagrees"
        cells = [
            Cell(str(one.harmonic), float(one.harmonic)),
            Cell(str(one.order + 1), float(one.order + 1)),
            Cell(f"{one.displacement:.2f}", one.displacement, css),
            Cell(str(one.order), float(one.order)),
            Cell(f"{one.gradient:.2f}", one.gradient, css),
            Cell(scientific(one.errors[1]), one.errors[1]),
        ]
        rows.append(Row(Cell(f"order {one.order}", float(one.order)), cells))
    return Table(
        "Finite element operator on manufactured solutions, L2 orders from a mesh to one twice as fine.",
        [
            "elements",
            "harmonic",
            "design, u",
            "observed, u",
            "design, ∇u",
            "observed, ∇u",
            "error on the finer",
        ],
        rows,
    )


def order_table(study: AccuracyStudy | None) -> Table | None:
    """Observed order of each quantity on each ladder of exact solutions."""
    if study is None or not study.ladders:
        return None
    rows = []
    for one in study.ladders:
        if not one.levels:
            continue
        cells = [Cell(one.solid), Cell(one.setting)]
        for quantity in QUANTITIES:
            order = one.order(quantity)
            least = min(level.errors[quantity] for level in one.levels)
            text = "–" if order is None else f"{order:.1f}"
            cells.append(Cell(f"{text} | {scientific(least)}", order, note="observed order | least error"))
        rows.append(Row(Cell(source_label(one.method)), cells))
    return Table(
        "Contact against the exact solution: observed order | least error of each ladder, a dash where the "
        "error has no slope to speak of. The figures are under the accuracy of each method.",
        ["method", "solid", "setting", *QUANTITIES],
        rows,
    )


def bracket_table(results: Sequence[CaseResult]) -> Table | None:
    """How often the stated uncertainty of each method holds the true error, scalars and lines apart."""
    found = [item for result in results for item in accuracies(result)]
    rows = []
    for method in METHODS:
        for name, here in (("p0, a, approach", True), ("stresses and pressure", False)):
            mine = [i for i in found if i.source == method and (i.quantity in SCALARS) is here]
            if not mine:
                continue
            good = sum(item.brackets for item in mine)
            ratios = sorted(i.estimate / i.error for i in mine if i.estimate is not None and i.error > 0)
            middle = ratios[len(ratios) // 2] if ratios else float("nan")
            worst = max(item.error for item in mine)
            cells = [
                Cell(name),
                Cell(f"{good} of {len(mine)}", good / len(mine)),
                Cell(f"{plain(100 * good / len(mine), 3)} %", good / len(mine)),
                Cell(factor(middle, 1.0), middle if isfinite(middle) else None),
                Cell(scientific(worst), worst),
            ]
            rows.append(Row(Cell(source_label(method)), cells))
    if not rows:
        return None
    return Table(
        "Where U holds the true error against the exact reference at every judged point, counted over "
        "quantities and cases; the middle ratio of U to the error tells how generous it is.",
        ["method", "quantities", "held", "share", "U over error, median", "largest error"],
        rows,
    )


def knob_table(results: Sequence[CaseResult]) -> Table | None:
    """Which knob dominates the uncertainty of each scalar, counted over the cases."""
    counts: dict[tuple[str, str], Counter[str]] = {}
    for result in results:
        for source in result.sources:
            for quantity in SCALARS:
                rows = [(value, knob) for q, knob, value in source.budget if q == quantity]
                if rows:
                    counts.setdefault((source.source, quantity), Counter())[max(rows)[1]] += 1
    if not counts:
        return None
    found = []
    for (name, quantity), counter in sorted(counts.items()):
        said = ", ".join(f"{knob} ({number})" for knob, number in counter.most_common())
        cells = [Cell(quantity.replace("_", " ")), Cell(said, css="words")]
        found.append(Row(Cell(source_label(name)), cells))
    return Table(
        "The knob with the largest share of U, with the number of cases in which it has it.",
        ["method", "quantity", "dominating knob"],
        found,
    )


def pair_table(results: Sequence[CaseResult]) -> Table | None:
    """Comparisons of each pair of sources: how many agree, the largest difference, the least margin."""
    verdicts = [(c, v) for result in results for c, v in result.verdicts]
    rows = []
    for pair in dict.fromkeys(claim.between for claim, _ in verdicts):
        mine = [v for c, v in verdicts if c.between == pair]
        good = sum(v.outcome is Outcome.AGREES for v in mine)
        largest = max((v.difference for v in mine if v.difference is not None), default=None)
        widest = max((v.uncertainty for v in mine if v.uncertainty is not None), default=None)
        cells = [
            Cell(f"{good} of {len(mine)}", good / len(mine)),
            Cell(scientific(largest), largest),
            Cell(scientific(widest), widest),
        ]
        rows.append(Row(Cell(pair_label(pair)), cells))
    if not rows:
        return None
    return Table(
        "All comparisons by pair of sources; differences and U as fractions of their scale.",
        ["between", "agree", "largest difference", "largest U"],
        rows,
    )


def import_table(parts: Sequence[Part]) -> Table | None:
    """What each part imports from outside, and what it must not."""
    rows = []
    for part in parts:
        bad = [*part.forbidden, *part.hidden]
        cells = [
            Cell(str(part.files), float(part.files)),
            Cell(str(part.statements), float(part.statements)),
            Cell(", ".join(part.modules), css="words"),
            Cell("; ".join(bad) or "none", css="words flag " + ("disagrees" if bad else "agrees")),
        ]
        rows.append(Row(Cell(part.name), cells))
    if not rows:
        return None
    return Table(
        "Imports of each part, its own and the standard library left out.",
        ["part", "files", "imports", "modules from outside", "breaches of the contract"],
        rows,
    )


def survivor_table(record: Record | None) -> Table | None:
    """The planted faults that nothing caught."""
    if record is None or not record.survivors:
        return None
    rows = [
        Row(
            Cell(row.name),
            [Cell(text, css="words") for text in (row.sentence, row.catch, row.reason, row.cure)],
        )
        for row in record.survivors
    ]
    return Table(
        "Planted faults that were not caught.",
        ["fault", "what was planted", "came to", "why it survives", "what would catch it"],
        rows,
    )


def alarm_table(record: AlarmRecord | None) -> Table | None:
    """The false alarms on record."""
    if record is None or not record.alarms:
        return None
    rows = [
        Row(
            Cell(alarm.title, note=alarm.case, css="words"),
            [
                outcome_cell(alarm.outcome),
                Cell(alarm.quantity),
                Cell(alarm.line),
                Cell(" – ".join(source_label(source) for source in alarm.between)),
                Cell(alarm.reason, css="words"),
            ],
        )
        for alarm in record.alarms[:MOST]
    ]
    more = f" The first {MOST} of {len(record.alarms)}." if len(record.alarms) > MOST else ""
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
