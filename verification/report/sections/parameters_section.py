"""Solution verification: stated uncertainty, refinement of each numerical parameter, true error."""

from collections.abc import Sequence
from functools import partial

from verification.credibility.parameter_sweeps import Stated, Sweep
from verification.page.number_text import plain
from verification.page.page_parts import Cell, Part, Section, Table, number, row
from verification.page.source_labels import source_label
from verification.report.report_material import Material
from verification.report.report_words import stated


def section(material: Material) -> Section | None:
    """The parameter sweeps of the accuracy study; None where there are none."""
    study = material.evidence.accuracy
    return parameter_section(study.sweeps, study.stated) if study is not None and study.stated else None


def parameter_section(sweeps: Sequence[Sweep], stated: Sequence[Stated]) -> Section:
    """Stated uncertainty, fitted uncertainty, true error of each method; then every parameter by itself."""
    parts = []
    for one in stated:
        mine = [sweep for sweep in sweeps if sweep.method == one.method]
        parts.append(Part(_summary(one, mine), [_totals(one, mine), *([_orders(mine)] if mine else [])]))
    return Section("parameters", "Uncertainty by numerical parameter", parts)


def _summary(one: Stated, sweeps: Sequence[Sweep]) -> str:
    names = list(one.uncertainty)
    held = sum(one.uncertainty[name] >= one.error[name] for name in names)
    text = (
        f"{source_label(one.method).capitalize()}, {one.solid} solid: the uncertainty that the solution "
        f"states covers the true error in {held} of {len(names)} quantities"
    )
    if not sweeps:
        return f"{text}. Its patches alone are refined in the convergence study."
    fitted = [_sum(sweeps, name) for name in names]
    by_fit = sum(U is not None and one.error[name] <= U for name, U in zip(names, fitted, strict=True))
    return f"{text}, the sum of the fitted uncertainties in {by_fit}."


def _totals(one: Stated, sweeps: Sequence[Sweep]) -> Table:
    rows = []
    for name, U in one.uncertainty.items():
        error = one.error[name]
        found = [sweep.estimate(name) for sweep in sweeps]
        fitted = [number(None if fit is None else fit.uncertainty) for fit in found]
        total = [_held(_sum(sweeps, name), error)] if sweeps else []
        rows.append(row(name, number(error), _held(U, error), *total, *fitted))
    caption = stated("fitted", sweeps=bool(sweeps))
    head = ["quantity", "true error", "stated U", *(["fitted U"] if sweeps else [])]
    return Table(caption, [*head, *(sweep.parameter for sweep in sweeps)], rows, css="overview")


def _orders(sweeps: Sequence[Sweep]) -> Table:
    names = list(dict.fromkeys(name for sweep in sweeps for name in sweep.values))
    rows = []
    for name in names:
        found = [sweep.estimate(name) for sweep in sweeps]
        orders = [None if one is None else one.order for one in found]
        rows.append(row(name, *(number(p, partial(plain, digits=2)) for p in orders)))
    levels = "; ".join(f"{sweep.parameter}: {', '.join(sweep.levels)}" for sweep in sweeps)
    return Table(
        "Observed order in the step of each parameter; a dash where the values are constant, are noise or "
        f"fall too fast for a power of the step. Levels: {levels}.",
        ["quantity", *(sweep.parameter for sweep in sweeps)],
        rows,
    )


def _sum(sweeps: Sequence[Sweep], name: str) -> float | None:
    found = [sweep.estimate(name) for sweep in sweeps if sweep.parameter != "element order"]
    values = [one.uncertainty for one in found if one is not None]
    return sum(values) if values else None


def _held(U: float | None, error: float) -> Cell:
    return number(U, css="" if U is None else f"flag {'agrees' if error <= U else 'disagrees'}")
