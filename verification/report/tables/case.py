"""The tables of one case: contact, verdicts, uncertainty budget, run times."""

from collections.abc import Callable, Sequence
from functools import partial
from math import isfinite
from typing import Any

import numpy as np

from verification.judging.verdict import Claim, Verdict
from verification.problem.contact import FLAT
from verification.problem.quantity import QUANTITIES, SCALARS, unit_of
from verification.report.tables.cells import Cell, Table, number, row
from verification.report.tables.labels import OUTCOMES, pair_label, row_css, source_label
from verification.report.tables.lookup import coordinate, divisor, layers, reference_source, scalar, scale
from verification.report.tables.matrix import outcome_cell
from verification.report.tables.numbers import engineering, plain, scientific, with_uncertainty
from verification.running.result import CaseResult

_FACTS = {
    "pressure": ("uniform pressure q", "Pa"),
    "load_radius": ("radius of the disc a", "m"),
    "radius": ("sphere radius R", "m"),
    "load": ("load W", "N"),
    "friction": ("friction f", ""),
    "a_h": ("a_h, Hertz contact radius", "m"),
    "p_h": ("p_h, Hertz peak pressure", "Pa"),
    "delta_h": ("delta_h, Hertz approach", "m"),
    "dundurs_beta": ("Dundurs' beta of the surfaces", ""),
    "S_h": ("S_h, Hertz stiffness dW/d delta", "N/m"),
}


def facts(result: CaseResult) -> list[tuple[str, str]]:
    """(name, value) of each parameter and each Hertz scale of a problem."""
    given = {"friction": 0.0} | result.problem
    return [
        (text, engineering(given[name], unit) if unit else plain(given[name]))
        for name, (text, unit) in _FACTS.items()
        if name in given
    ]


def layer_table(result: CaseResult, body: str = FLAT) -> Table:
    """The layers of a body from its surface inwards, in real units and against its bare substrate.

    Thicknesses are over a_h, or over the radius of a prescribed load.
    """
    length = "a" if "load_radius" in result.problem else "a_h"
    a_h = scale(result, "load_radius" if length == "a" else "a_h")
    found = layers(result, body)
    rows = []
    for layer, (E, nu, thickness) in enumerate(found, start=1):
        below = layer == len(found)
        rows.append(
            row(
                "substrate" if below else f"coating {layer}",
                Cell(engineering(E, "Pa"), E),
                Cell(plain(E / found[-1][0], 3), E),
                number(nu, plain),
                Cell("∞" if below else engineering(thickness, "m"), thickness),
                Cell("∞" if below else plain(thickness / a_h, 3) if a_h > 0 else "–", thickness),
            )
        )
    caption = (
        "Layers from the surface down." if body == FLAT else "Layers of the ball, from its surface inwards."
    )
    return Table(caption, ["layer", "E", "E / E_s", "nu", "h", f"h / {length}"], rows)


def contact_table(result: CaseResult, quantities: Sequence[str] = SCALARS) -> Table:
    """``quantities``, one number each, of every source with uncertainty and difference."""
    base = reference_source(result)
    against = f"vs {source_label(base)}" if base else "difference"
    rows = []
    for source in result.sources:
        cells: list[Cell] = []
        for quantity in quantities:
            cells += _scalar_cells(result, quantity, source.source, base)
        css = "" if source.failure is None else "failed"
        rows.append(row(source_label(source.source), *cells, css=css))
    columns = ["source"]
    groups = [("", 1)]
    for quantity in quantities:
        columns += [QUANTITIES[quantity].symbol, f"/ {QUANTITIES[quantity].scale}", against]
        groups.append((quantity.replace("_", " "), 3))
    return Table(
        "Numbers of the contact with the numerical uncertainty each source states (±), made dimensionless "
        "with the Hertz scales of the bare substrate, of both bodies where the ball is elastic, and the "
        "difference over the value, of the largest tension over the smaller of p_h and p0, of "
        "its place over a.",
        columns,
        rows,
        groups,
    )


def _scalar_cells(result: CaseResult, quantity: str, source: str, base: str | None) -> list[Cell]:
    found = scalar(result, quantity, source)
    if found is None:
        return [Cell("no result", css="no-result"), Cell("–"), Cell("–")]
    value, uncertainty = found
    note = "" if uncertainty else "uncertainty not stated" if uncertainty is None else "exact"
    shown = Cell(with_uncertainty(value, uncertainty, unit_of(quantity)), value, note=note)
    relative = value / scale(result, QUANTITIES[quantity].scale)
    ratio = Cell(f"{relative:.6f}", relative)
    reference = scalar(result, quantity, base) if base else None
    reach = divisor(result, quantity, reference[0]) if reference else None
    if reference is None or source == base or not reach:
        return [shown, ratio, Cell("–")]
    gap = (value - reference[0]) / reach
    return [shown, ratio, Cell(scientific(gap, sign=True), abs(gap))]


def verdict_table(
    verdicts: Sequence[tuple[Claim, Verdict]],
    a_h: float,
    most: int | None = None,
    parameter: Callable[[Claim, Verdict], str] | None = None,
) -> Table:
    """The comparisons, the worst first; ``most`` keeps as many of them.

    parameter : gives what dominates the uncertainty of a comparison; no such column without.
    """
    rows = []
    for claim, verdict in sorted(verdicts, key=lambda item: _badness(item[1]))[:most]:
        where = ""
        if verdict.worst is not None and claim.line != "contact" and a_h:
            where = f"{coordinate(claim.line)} = {plain(verdict.worst / a_h, 3)} a_h"
        rows.append(
            row(
                outcome_cell(verdict.outcome),
                Cell(claim.quantity, note=claim.why),
                claim.line,
                pair_label(claim.between),
                number(verdict.difference),
                number(verdict.uncertainty),
                number(claim.cap),
                number(verdict.margin, partial(scientific, sign=True)),
                *([parameter(claim, verdict)] if parameter is not None else []),
                Cell(where, verdict.worst),
                Cell(verdict.reason, css="reason"),
                css=row_css(verdict.outcome),
            )
        )
    columns = ["verdict", "quantity", "line", "between", "max |A − B|", "max U", "cap", "margin"]
    columns += ["largest part of U"] if parameter is not None else []
    part = "the source and the numerical parameter with the largest part of U; " if parameter else ""
    return Table(
        "Largest difference and largest uncertainty U = U_A + U_B over the judged points, the cap on U, the "
        "smallest margin U − |A − B|, all as fractions of the value (p0, a, approach, dW/d delta), of a "
        "(places), of the smaller of delta_h and approach (displacements) or of the smaller of p_h and p0; "
        f"{part}the deciding point.",
        [*columns, "at", "reason"],
        rows,
        css="verdicts",
    )


def _badness(verdict: Verdict) -> tuple[int, float]:
    margin = verdict.margin if verdict.margin is not None else 0.0
    return OUTCOMES[verdict.outcome].rank, margin if isfinite(margin) else 0.0


def dominating_parameter(result: CaseResult, claim: Claim, verdict: Verdict) -> str:
    """The source with the larger uncertainty at the deciding point, with its dominating parameter.

    U of a stress or pressure is that of p0, of a displacement or the stiffness that of the approach, with its
    own part due to the first parameter, the edge terms or the size of patches or elements: the excess of U
    over the other parts belongs to the first.
    """
    sides = []
    for source in claim.between:
        profile = result.profile_of.get((claim.quantity, claim.line, source))
        if profile is not None and profile.uncertainty is not None and profile.position.size:
            at = 0 if verdict.worst is None else int(np.argmin(np.abs(profile.position - verdict.worst)))
            sides.append((float(profile.uncertainty[at]), source))
    if not sides or not max(sides)[0] > 0:
        return ""
    U, source = max(sides)
    budget = next((s.budget for s in result.sources if s.source == source), ())
    scalar_claim = any(q == claim.quantity for q, _, _ in budget)
    like = "approach" if QUANTITIES[claim.quantity].kind in ("slope", "displacement") else "peak_pressure"
    quantity = claim.quantity if scalar_claim else like
    parts = [(name, value) for q, name, value in budget if q == quantity]
    if not parts:
        return source_label(source)
    if not scalar_claim:
        others = sum(value for _, value in parts[1:])
        parts[0] = (parts[0][0], max(U - others, 0.0))
    return f"{source_label(source)}: {max(parts, key=lambda item: item[1])[0]}"


def budget_table(result: CaseResult) -> Table | None:
    """Uncertainty budget: a row for each numerical parameter of each method."""
    rows = []
    for source in result.sources:
        for quantity in dict.fromkeys(quantity for quantity, _, _ in source.budget):
            parts = [(name, value) for q, name, value in source.budget if q == quantity]
            largest = max((value for _, value in parts if isfinite(value)), default=0.0)
            for name, value in parts:
                dominant = value == largest > 0 and len(parts) > 1
                rows.append(
                    row(
                        source_label(source.source),
                        quantity,
                        Cell(name, css="dominant" if dominant else ""),
                        Cell(engineering(value, unit_of(quantity), 2), value),
                        Cell(scientific(_relative(result, source.source, quantity, value)), value),
                        Cell("◀ dominates" if dominant else "", css="dominant"),
                    )
                )
    return Table(
        "Uncertainty of each method by numerical parameter, from its own refinement; relative to the value, "
        "to p_h for stresses.",
        ["source", "quantity", "parameter", "uncertainty", "relative", ""],
        rows,
    )


def _relative(result: CaseResult, source: str, quantity: str, value: float) -> float | None:
    found = scalar(result, quantity, source)
    size = abs(found[0]) if found else scale(result, "p_h")
    return value / size if size else None


def diagnostics_table(result: CaseResult) -> Table | None:
    """Diagnostics of each source: iterations, residuals, unknowns."""
    rows = [
        row(source_label(source.source), name.replace("_", " "), _shown(value))
        for source in result.sources
        for name, value in source.diagnostics.items()
    ]
    return Table("Diagnostics reported by each source.", ["source", "diagnostic", "value"], rows)


def _shown(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.4g}"
    if isinstance(value, list | tuple):
        if len(value) > 6:
            return f"{len(value)} values, first {_shown(value[0])}, last {_shown(value[-1])}"
        return ", ".join(_shown(item) for item in value)
    if isinstance(value, dict):
        return ", ".join(f"{key} {_shown(item)}" for key, item in value.items())
    text = str(value)
    return text if len(text) <= 300 else text[:297] + "..."
