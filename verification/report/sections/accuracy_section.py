"""Error of each method against the exact reference beside the uncertainty it states."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache, partial

import numpy as np
from numpy.typing import NDArray

from verification.judging.verdict import Claim
from verification.page.number_text import plain, scientific
from verification.page.page_parts import Cell, Part, Section, Table, number, row, tally, words
from verification.page.source_labels import source_label, symbol_of
from verification.problem.line_profile import ON_BALL, coordinate_of
from verification.problem.quantity import PEAKS, QUANTITIES, SCALARS, SLOPES
from verification.report.report_words import stated
from verification.report.tables.case_lookup import case_cell, contact_radius, difference, reference_source
from verification.running.case_result import CaseResult
from verification.sources.source_registry import METHODS, REFERENCES

# Columns of lines in the overview.
GROUPS = ("surface", "axis", "interfaces", "off plane")
# Ratio of stated to true error below which an estimate counts as wrong.
TOO_SMALL = 0.5
# Share of quantities whose true error an uncertainty must cover, the level at which it is usually stated.
COVERED = 0.95


@dataclass(frozen=True)
class Accuracy:
    """One quantity on one line: the largest ``error``, the ``estimate`` at that point, as fractions.

    ratio : smallest (U_method + U_reference) / |error| over the judged points; 1 or more covered the
            error everywhere.   None where the method states no uncertainty.
    """

    source: str
    quantity: str
    line: str
    error: float
    estimate: float | None
    ratio: float | None

    @property
    def covered(self) -> bool:
        """True where the stated uncertainty covers the error at every judged point."""
        return self.ratio is not None and self.ratio >= 1

    @property
    def weakness(self) -> float:
        """The ratio, by which the worst comes first; below all others without an uncertainty."""
        return -1.0 if self.ratio is None else self.ratio

    @property
    def css(self) -> str:
        """Class of a cell: by the ratio of the stated to the true error."""
        return "agrees" if self.covered else "disagrees" if self.weakness < TOO_SMALL else "inconclusive"


def section(results: Sequence[CaseResult], anchors: Mapping[CaseResult, str]) -> Section | None:
    """The errors of each method against the exact reference; None where none is known."""
    parts = [
        Part("", [overview], folded=f"Errors of {source_label(source)}, case by case")
        for source in METHODS
        if (overview := _overview(results, anchors, source))
    ]
    return Section("accuracy", "Accuracy against the exact reference", parts) if parts else None


@lru_cache(maxsize=256)
def accuracies(result: CaseResult) -> tuple[Accuracy, ...]:
    """Every quantity of every method with an exact counterpart; () where the case has no exact reference."""
    exact = reference_source(result)
    if exact not in REFERENCES:
        return ()
    claims = {(claim.quantity, claim.line): claim for claim, _ in result.verdicts}
    found = [
        _accuracy(result, claim, source, exact)
        for source in METHODS
        for (quantity, line), claim in claims.items()
        if (quantity, line, source) in result.profile_of
    ]
    return tuple(item for item in found if item is not None)


def _accuracy(result: CaseResult, claim: Claim, source: str, exact: str) -> Accuracy | None:
    mine, theirs = (result.profile_of.get((claim.quantity, claim.line, one)) for one in (source, exact))
    found = difference(result, mine, theirs)
    if mine is None or found is None:
        return None
    error, uncertainty = found
    here = judged(result, claim, mine.position) & np.isfinite(error)
    if not here.any():
        return None
    worst = int(np.argmax(np.where(here, error, -1.0)))
    estimate = smallest = None
    if uncertainty is not None:
        ratio = np.where(error > 0, uncertainty / np.where(error > 0, error, 1.0), np.inf)
        smallest = float(np.min(np.where(np.isfinite(uncertainty), ratio, 0.0)[here]))
        estimate = float(uncertainty[worst])
    return Accuracy(source, claim.quantity, claim.line, float(error[worst]), estimate, smallest)


def judged(result: CaseResult, claim: Claim, position: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Marks the points of ``position`` judged by ``claim``: those outside its zone around the edge."""
    a = contact_radius(result)
    if not claim.edge or a is None or coordinate_of(claim.line) == "z":
        return np.ones(position.shape, dtype=bool)
    return np.abs(np.abs(position) - a) >= claim.edge * a


def _overview(results: Sequence[CaseResult], anchors: Mapping[CaseResult, str], source: str) -> Table:
    """The errors of one method over all cases, the worst quantity of each group."""
    columns = [*SCALARS, *SLOPES, *PEAKS, *GROUPS]
    rows = []
    for result in results:
        if found := [item for item in accuracies(result) if item.source == source]:
            cells = [
                _overview_cell([i for i in found if name in (i.quantity, _group_of(i.line))])
                for name in columns
            ]
            rows.append(row(case_cell(result, f"#{anchors[result]}-comparisons"), *cells))
    return Table(
        stated("overview_errors", method=source_label(source)),
        ["case", *(QUANTITIES[name].symbol if name in QUANTITIES else name for name in columns)],
        rows,
        css="overview",
    )


def _group_of(line: str) -> str:
    line = line.removeprefix(ON_BALL)
    if line.startswith("interface"):
        return "interfaces"
    return "off plane" if line.startswith("oblique") else line


def _overview_cell(found: Sequence[Accuracy]) -> Cell:
    if not found:
        return Cell("", css="nothing")
    worst, weakest = max(found, key=lambda one: one.error), min(found, key=lambda one: one.weakness)
    mark = {"agrees": "", "inconclusive": " ▼", "disagrees": " ▼▼"}[weakest.css]
    note = f"largest error: {symbol_of(worst.quantity)} on {worst.line}"
    if weakest.ratio is not None:
        note += f"; smallest ratio {plain(weakest.ratio, 2)}: {symbol_of(weakest.quantity)} on {weakest.line}"
    text = f"{scientific(worst.error)} | {scientific(worst.estimate)}{mark}"
    return Cell(text, worst.error, f"flag {weakest.css}", note)


def coverage_table(results: Sequence[CaseResult]) -> Table:
    """How often the uncertainty that a method states covers its true error, scalars and lines apart."""
    rows = []
    scalars = SCALARS + SLOPES
    groups = {", ".join(QUANTITIES[name].symbol for name in scalars): True}
    groups["stresses, pressure, displacements"] = False
    known = [(result, item) for result in results for item in accuracies(result)]
    for source, name in ((source, name) for source in METHODS for name in groups):
        found = [
            one for one in known if one[1].source == source and (one[1].quantity in scalars) is groups[name]
        ]
        if not found:
            continue
        covered = sum(item.covered for _, item in found)
        share = covered / len(found)
        case, worst = min(found, key=lambda one: one[1].weakness)
        ratios = [item.ratio for _, item in found if item.ratio is not None and np.isfinite(item.ratio)]
        rows.append(
            row(
                source_label(source),
                name,
                tally(covered, len(found)),
                Cell(f"{100 * share:.1f} %", share, f"flag {'agrees' if share >= COVERED else 'disagrees'}"),
                number(1 / worst.ratio, partial(plain, digits=2)) if worst.ratio else "not stated",
                words(f"{symbol_of(worst.quantity)} on {worst.line}, {case.title}"),
                number(float(np.median(ratios)) if ratios else None, partial(plain, digits=3)),
                number(max(item.error for _, item in found)),
            )
        )
    heads = ["method", "quantities", "covered", "share", "largest error / U", "there"]
    heads += ["median U / error", "largest error"]
    return Table(stated("coverage", share=f"{100 * COVERED:.0f}"), heads, rows, css="overview")
