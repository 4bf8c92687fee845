"""Effective-modulus formulas, simple limits: their accuracy against the exact reference."""

from collections.abc import Sequence
from functools import partial
from itertools import pairwise
from math import ceil, floor, log10

import numpy as np
from markupsafe import Markup

from verification.page.embedded_csv import written
from verification.page.number_text import plain, scientific
from verification.page.page_parts import Gallery, Panel, Part, Row, Section, Table, number, row
from verification.page.svg_plot import Axes, drawing, power_of_ten
from verification.problem.array_types import Array
from verification.report.figures.line_panels import swatch
from verification.report.report_material import Material
from verification.report.sections.family_section import family_section as section_of_family
from verification.sources.references.effective_modulus import PERRIOT_BARTHEL_N
from verification.sources.source_record import Style
from verification.study.formula_errors import EffectiveStudy, Limit
from verification.study.usual_correction import FRICTION, BallCurve

WIDTH, HEIGHT = 320, 250
BOX = (48.0, 5.0, 266.0, 207.5)  # left, top, width, height
LEVELS = (0.01, 0.05, 0.1, 0.2, 0.5)
# One shade more for each level passed; two colours for too stiff and too compliant.
SHADES = (0.12, 0.26, 0.42, 0.6, 0.85)
STIFF, SOFT = "fem", "semi"
_CURVES = (
    Style("semi"),
    Style("fem", (3.6, 3.0), 1.9),
    Style("hertz", (1.0, 1.4), 1.9),
    Style("pair", (4.5, 1.4, 1.0, 1.4)),
)


def family_section(material: Material) -> Section | None:
    """Contacts of the exact reference side by side; None where they were not solved."""
    study = material.evidence.formulas
    return section_of_family(study.family, "exact-family") if study and not study.failure else None


def section(material: Material) -> Section | None:
    """Maps of the formulas with the limits; None where they were not measured."""
    study = material.evidence.formulas
    if study is None:
        return None
    if study.failure:
        return Section("effective-modulus", "Effective-modulus formulas", [], [study.failure])
    parts = [_map_part(study), _confirmation(study), *_limit_parts(study.limits)]
    parts += [_ball_part(study.balls)] if study.balls else []
    return Section("effective-modulus", "Effective-modulus formulas and simple limits", parts)


def _map_part(study: EffectiveStudy) -> Part:
    errors = {name: np.array(table) / np.array(study.exact) - 1 for name, table in study.formulas}
    panels = [
        Panel(name, _draw_map(study, e, name), f"from {_percent(e.min())} to {_percent(e.max())}", "")
        for name, e in errors.items()
    ]
    text = (
        "Formulas that correct the contact stiffness of nanoindentation for the substrate, each compared "
        "with the exact solution over E1/E2 and h/a: S = 2 a E_eff at contact radius a, which of a "
        "sphere is that of a flat punch, from the integral equation. nu = 0.3 in film and substrate. "
        "Perriot and Barthel's exponent is fitted to each ratio of moduli, between "
        f"{PERRIOT_BARTHEL_N[0]:g} and {PERRIOT_BARTHEL_N[1]:g}; drawn is the best one. Formulas "
        "with a coefficient that each experiment fits anew (Doerner and Nix, King, Saha and Nix, Hu and "
        "Lawn, Jung) are not predictive and have no map."
    )
    legend = [
        (_tint(colour, shade), f"{word} {_percent(level)[1:]}")
        for colour, word in ((STIFF, "too stiff by more than"), (SOFT, "too compliant by more than"))
        for level, shade in zip(LEVELS, SHADES, strict=True)
    ]
    caption = (
        "E_eff by the formula over the exact one, less 1. White: within 1 %. To the right thick films, "
        "upwards stiff ones."
    )
    numbers = Table(
        "Departure from the exact solution over the whole map, E1/E2 from 0.01 to 100 and h/a from 0.05 to "
        "20, and over its middle, E1/E2 from 0.1 to 10; the share of either that is within 10 %.",
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


def _confirmation(study: EffectiveStudy) -> Part:
    first, second = study.weights
    apart = max(abs(log10(theirs / fitted)) for _, theirs, fitted, _ in study.refitted)
    n = [row[3] for row in study.refitted]
    text = (
        "No primary source was available. Gao's weights are confirmed by computation: I0 and I1 are within "
        f"{scientific(first, 1)} and {scientific(second, 1)} of the exact first derivatives of the "
        "stiffness with the film's shear modulus and Poisson's ratio. Perriot and Barthel's x0 is within "
        f"{plain(apart, 2)} in its logarithm of what a least-squares fit to the exact solution gives, with n "
        f"from {plain(min(n), 3)} to {plain(max(n), 3)}."
    )
    rows = [row(*(number(value, partial(plain, digits=3)) for value in values)) for values in study.refitted]
    table = Table(
        "x0 of Perriot and Barthel, and x0 with n fitted to the exact solution at nu = 0.3.",
        ["E1/E2", "x0, published", "x0, fitted", "n, fitted"],
        rows,
    )
    return Part(text, [table])


def _limit_parts(limits: Sequence[Limit]) -> list[Part]:
    thin = [limit for limit in limits if "thin" in limit.panel]
    thick = [limit for limit in limits if "thick" in limit.panel]
    return [
        _limit_part(
            thin,
            "Thin layer on a rigid base: a bed of springs where it is compressible, S = pi M a^2/h and W "
            "= pi M a^4/(4 R h) with the oedometric modulus M; a film squeezed out sideways where nu = "
            "1/2, S = 3 pi G a^4/(8 h^3) and W = pi G a^6/(32 R h^3). Johnson (1985, section 5.8), Jaffar "
            "(1989), Barber (2018). Near nu = 1/2 neither holds before a is many times h.",
        ),
        _limit_part(
            thick,
            "Thick coating, nu = 0.3: Hertz of the coating, kappa = 1, and with its first correction, "
            "kappa = 1/(1 + (2/pi) a int (M - 1) dk), M the compliance of the layers: what the interface "
            "adds when the contact is small.",
        ),
    ]


def _limit_part(limits: Sequence[Limit], text: str) -> Part:
    panels = list(dict.fromkeys(limit.panel for limit in limits))
    names = list(dict.fromkeys(limit.name for limit in limits))
    styles = dict(zip(names, _CURVES, strict=False))
    drawn = []
    for panel in panels:
        figure = _draw_limit([one for one in limits if one.panel == panel], styles, panel)
        drawn.append(Panel(panel, figure, "|exact over limit − 1|", ""))
    legend = [(swatch(styles[name]), name) for name in names]
    a = limits[0].a_over_h
    shown = (0, len(a) // 2, -1)
    rows = [row(f"{x.panel}, {x.name}", *(number(x.excess[i], _percent) for i in shown)) for x in limits]
    heads = [f"a/h = {plain(a[i], 2)}" for i in shown]
    table = Table("Exact over limit, less 1, at three contact radii.", ["limit", *heads], rows)
    caption = "Over a/h, both logarithmic: a straight line is a power of the thickness left out."
    return Part(text, [table], Gallery(legend, drawn, caption, _limit_csv(limits)))


def _ball_part(balls: Sequence[BallCurve]) -> Part:
    coatings, quantities, thicknesses = (
        list(dict.fromkeys(getattr(one, name) for one in balls))
        for name in ("coating", "quantity", "thickness")
    )
    styles = dict(zip(thicknesses, _CURVES, strict=False))
    drawn = []
    for coating in coatings:
        for quantity in quantities:
            shown = [one for one in balls if (one.coating, one.quantity) == (coating, quantity)]
            name = f"{quantity}, E1/E2 = {coating:g}"
            drawn.append(Panel(name, _draw_ball(shown, styles, name), "over E_ball/E_flat", ""))
    failing = [(_first_beyond(one, 0.01), one) for one in balls]
    reach = max((ratio for ratio, _ in failing if ratio), default=0.0)
    worst = max(balls, key=lambda one: abs(one.usual / one.value[0] - 1))
    text = (
        "An elastic, uncoated ball on a coated flat by the integral equation, "
        f"f = {FRICTION:g}, nu = 0.3, over the scales of both bodies uncoated. The usual correction, dashed, "
        "puts E* of the substrates into the scales, keeping the numbers of the rigid ball: it is exact where "
        "a body is rigid or no coating is present. It takes the coating for as important as under a rigid "
        "ball, though the ball's own compliance lessens its part. At E_ball = E_flat/10 its largest error is "
        f"{_percent(worst.usual / worst.value[0] - 1)}, of {worst.quantity} with E1/E2 = {worst.coating:g}, "
        f"h = {worst.thickness:g} a_h; more than 1 % remains up to E_ball = {plain(reach, 2)} E_flat."
    )
    at = [min(range(len(balls[0].ratio)), key=lambda i: abs(balls[0].ratio[i] - r)) for r in (0.1, 1.0, 10.0)]
    rows = []
    for beyond, one in failing:
        errors = (number(one.usual / one.value[i] - 1, _percent) for i in at)
        label = f"{one.quantity}, E1/E2 = {one.coating:g}, h = {one.thickness:g} a_h"
        rows.append(row(label, *errors, number(beyond, partial(plain, digits=2))))
    heads = [f"E_ball/E_flat = {plain(balls[0].ratio[i], 2)}" for i in at]
    table = Table(
        "Usual correction over exact, less 1; the largest E_ball/E_flat at which it is off by more than 1 %.",
        ["quantity", *heads, "off by 1 % up to"],
        rows,
    )
    legend = [(swatch(styles[h]), f"h = {h:g} a_h") for h in thicknesses]
    legend.append((swatch(Style("ink", (2.0, 2.0), 0.9)), "usual correction"))
    caption = "Full: both bodies elastic. Dashed: rigid ball, scales with E* of the substrates."
    return Part(text, [table], Gallery(legend, drawn, caption, _ball_csv(balls)))


def _first_beyond(curve: BallCurve, share: float) -> float | None:
    """The largest E_ball/E_flat at which the usual correction is off by more than ``share``."""
    off = [r for r, v in zip(curve.ratio, curve.value, strict=True) if abs(curve.usual / v - 1) > share]
    return max(off) if off else None


def _draw_ball(balls: Sequence[BallCurve], styles: dict[float, Style], label: str) -> Markup:
    x = np.log10(balls[0].ratio)
    low, high = _widened(np.array([v for one in balls for v in (*one.value, one.usual)]), 0.06)
    axes = Axes(BOX, (x[0], x[-1]), (low, high))
    steps = np.linspace(low, high, 6)[1:-1]
    axes.ticks(_decades(x[0], x[-1]), [(float(v), plain(float(v), 2)) for v in steps], "E_ball / E_flat")
    for one in balls:
        style = styles[one.thickness]
        axes.level(one.usual, Style(style.colour, (2.0, 2.0), 0.9))
        axes.line(x, np.array(one.value), Style(style.colour, width=style.width))
    return drawing(WIDTH, HEIGHT, f"{label} over E_ball/E_flat, with the usual correction", axes)


def _ball_csv(balls: Sequence[BallCurve]) -> str:
    rows = [["quantity", "E1/E2", "h/a_h", "E_ball/E_flat", "both elastic", "usual correction"]]
    for one in balls:
        for r, v in zip(one.ratio, one.value, strict=True):
            numbers = (one.coating, one.thickness, r, v, one.usual)
            rows.append([one.quantity, *(f"{value:.9g}" for value in numbers)])
    return written(rows)


def _draw_map(study: EffectiveStudy, error: Array, name: str) -> Markup:
    x, y = np.log10(study.thickness), np.log10(study.ratio)
    axes = Axes(BOX, (x[0], x[-1]), (y[0], y[-1]))
    for sign, colour in ((1, STIFF), (-1, SOFT)):
        for (level, above), shade in zip(pairwise([*LEVELS, 1e9]), SHADES, strict=True):
            if (sign * error > level).any():
                axes.filled(x, y, sign * error, level, above, colour, shade)
    for level in (0.1, -0.1):
        if error.min() < level < error.max():
            axes.contour(x, y, error, level, _percent(level))
    axes.ticks(_decades(x[0], x[-1]), _decades(y[0], y[-1]), "h / a")
    axes.text(x[0], y[-1], "E1/E2", by=(4, 13))
    label = f"{name}: departure from the exact effective modulus over h/a and E1/E2"
    return drawing(WIDTH, HEIGHT, label, axes)


def _draw_limit(limits: Sequence[Limit], styles: dict[str, Style], label: str) -> Markup:
    x = [np.log10(limit.a_over_h) for limit in limits]
    y = [np.log10(np.maximum(np.abs(limit.excess), 1e-12)) for limit in limits]
    (left, right), (low, high) = (_widened(np.concatenate(some), by) for some, by in ((x, 0.02), (y, 0.06)))
    axes = Axes(BOX, (left, right), (low, high))
    axes.ticks(_decades(left, right), _decades(low, high), "a / h")
    for limit, along, excess in zip(limits, x, y, strict=True):
        axes.line(along, excess, styles[limit.name])
    return drawing(WIDTH, HEIGHT, f"{label}: departure of the limit from the exact solution", axes)


def _widened(values: Array, share: float) -> tuple[float, float]:
    margin = share * max(float(np.ptp(values)), 1e-9)
    return float(values.min()) - margin, float(values.max()) + margin


def _decades(low: float, high: float) -> list[tuple[float, str]]:
    """Ticks at whole powers of ten between two exponents, seven of them at most."""
    step = max(1, ceil((high - low) / 6))
    exponents = range(ceil(low), floor(high) + 1, step)
    return [(m, f"{10.0**m:g}" if -3 < m < 4 else power_of_ten(m)) for m in exponents]


def _tint(colour: str, shade: float) -> Markup:
    return Markup(
        '<svg class="swatch" viewBox="0 0 36 10" aria-hidden="true"><rect x="1" y="0" width="34" height="10" '
        'class="f-{}" fill-opacity="{}"/></svg>'
    ).format(colour, shade)


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


def _limit_csv(limits: Sequence[Limit]) -> str:
    rows = [["limit", "solid", "a/h", "exact over limit less 1"]]
    for one in limits:
        pairs = zip(one.a_over_h, one.excess, strict=True)
        rows += [[one.panel, one.name, f"{a:.9g}", f"{excess:.9g}"] for a, excess in pairs]
    return written(rows)
