"""Effective-modulus formulas: their accuracy against the exact reference."""

from collections.abc import Sequence
from functools import partial
from itertools import pairwise
from math import ceil, floor

import numpy as np
from markupsafe import Markup

from verification.page.number_text import plain
from verification.page.page_parts import (
    Cell,
    Gallery,
    Panel,
    Part,
    Row,
    Section,
    Table,
    number,
    row,
    table_of,
    written,
)
from verification.page.svg_plot import level_map, power_of_ten, tint
from verification.problem.array_types import Array
from verification.report.report_material import Material
from verification.report.report_words import stated
from verification.sources.references.effective_modulus import PERRIOT_BARTHEL_N
from verification.study.formula_errors import FRICTION, BallCurve, EffectiveStudy

LEVELS = (0.01, 0.05, 0.1, 0.2, 0.5)
# One shade more for each level passed; two colours for too stiff and too compliant.
SHADES = (0.12, 0.26, 0.42, 0.6, 0.85)
STIFF, SOFT = "fem", "semi"


def section(material: Material) -> Section | None:
    """Maps of the formulas with the limits; None where they were not measured."""
    study = material.evidence.formulas
    if study is None:
        return None
    if study.failure:
        return Section("effective-modulus", "Effective-modulus formulas", [], [study.failure])
    parts = [_map_part(study), *([_ball_part(study.balls)] if study.balls else [])]
    return Section("effective-modulus", "Effective-modulus formulas", parts)


def _map_part(study: EffectiveStudy) -> Part:
    errors = {name: np.array(table) / np.array(study.exact) - 1 for name, table in study.formulas}
    panels = [
        Panel(name, _draw_map(study, e, name), f"from {_percent(e.min())} to {_percent(e.max())}", "")
        for name, e in errors.items()
    ]
    low, high = PERRIOT_BARTHEL_N
    text = stated("formulas", low=f"{low:g}", high=f"{high:g}")
    legend = [
        (tint(colour, shade), f"{word} {_percent(level)[1:]}")
        for colour, word in ((STIFF, "too stiff by more than"), (SOFT, "too compliant by more than"))
        for level, shade in zip(LEVELS, SHADES, strict=True)
    ]
    caption = (
        "E_eff by the formula over the exact one, less 1. White: within 1 %. To the right thick films, "
        "upwards stiff ones."
    )
    numbers = Table(
        stated("formula_table"),
        ["formula", *["most compliant", "stiffest", "median", "within 10 %"] * 2],
        [_formula_row(study, name, error) for name, error in errors.items()],
        [("", 1), ("whole map", 4), ("E1/E2 from 0.1 to 10", 4)],
    )
    return Part(text, [numbers], Gallery(legend, panels, caption, _map_csv(study)))


def _formula_row(study: EffectiveStudy, name: str, error: Array) -> Row:
    middle = np.abs(np.log10(study.ratio)) <= 1 + 1e-9
    cells = []
    for part in (error, error[middle]):
        for value in (part.min(), part.max(), np.median(np.abs(part))):
            cells.append(number(float(value), _percent))
        cells.append(number(float((np.abs(part) <= 0.1).mean()), lambda share: f"{100 * share:.0f} %"))
    return row(name, *cells)


def _ball_part(balls: Sequence[BallCurve]) -> Part:
    reach = max((ratio for one in balls if (ratio := _first_beyond(one, 0.01))), default=0.0)
    worst = max(balls, key=lambda one: abs(one.usual / one.value[0] - 1))
    text = stated(
        "usual_correction",
        friction=f"{FRICTION:g}",
        error=_percent(worst.usual / worst.value[0] - 1),
        worst=f"{worst.quantity} with E1/E2 = {worst.coating:g}, h = {worst.thickness:g} a_h",
        reach=plain(reach, 2),
    )
    ratios = balls[0].ratio
    at = [min(range(len(ratios)), key=lambda i: abs(ratios[i] - r)) for r in (0.1, 1.0, 10.0)]
    table = table_of(
        "Usual correction over exact, less 1; the largest E_ball/E_flat at which it is off by more than 1 %.",
        balls,
        [
            ("quantity", lambda one: f"{one.quantity}, E1/E2 = {one.coating:g}, h = {one.thickness:g} a_h"),
            *((f"E_ball/E_flat = {plain(ratios[i], 2)}", partial(_usual, i=i)) for i in at),
            ("off by 1 % up to", lambda one: number(_first_beyond(one, 0.01), partial(plain, digits=2))),
        ],
    )
    return Part(text, [table])


def _usual(one: BallCurve, i: int) -> Cell:
    return number(one.usual / one.value[i] - 1, _percent)


def _first_beyond(curve: BallCurve, share: float) -> float | None:
    """The largest E_ball/E_flat at which the usual correction is off by more than ``share``."""
    off = [r for r, v in zip(curve.ratio, curve.value, strict=True) if abs(curve.usual / v - 1) > share]
    return max(off) if off else None


def _draw_map(study: EffectiveStudy, error: Array, name: str) -> Markup:
    x, y = np.log10(study.thickness), np.log10(study.ratio)
    areas = [
        (sign * error, level, above, colour, shade)
        for sign, colour in ((1, STIFF), (-1, SOFT))
        for (level, above), shade in zip(pairwise([*LEVELS, 1e9]), SHADES, strict=True)
    ]
    contours = [(error, level, _percent(level)) for level in (0.1, -0.1)]
    label = f"{name}: departure from the exact effective modulus"
    ticks = (_decades(x[0], x[-1]), _decades(y[0], y[-1]))
    return level_map(label, x, y, areas, contours, ticks, ("h / a", "E1/E2"))


def _decades(low: float, high: float) -> list[tuple[float, str]]:
    """Ticks at whole powers of ten between two exponents, seven of them at most."""
    step = max(1, ceil((high - low) / 6))
    exponents = range(ceil(low), floor(high) + 1, step)
    return [(m, f"{10.0**m:g}" if -3 < m < 4 else power_of_ten(m)) for m in exponents]


def _percent(value: float) -> str:
    if abs(value) < 5e-6:
        return "0 %"
    return f"{100 * value:{'+.0f' if abs(value) >= 1 else '+.2g'}} %".replace("-", "−")


def _map_csv(study: EffectiveStudy) -> str:
    names = ["exact", *(name for name, _ in study.formulas)]
    tables = [study.exact, *(table for _, table in study.formulas)]
    rows = [["E1/E2", "h/a", *(f"E_eff/E2* {name}" for name in names)]]
    for i, ratio in enumerate(study.ratio):
        for j, thickness in enumerate(study.thickness):
            rows.append([f"{v:.9g}" for v in (ratio, thickness, *(table[i][j] for table in tables))])
    return written(rows)
