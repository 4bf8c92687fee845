"""Contour maps of sigma_xx, sigma_xz, von Mises in the x-z plane for a few thicknesses."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from matplotlib.ticker import MaxNLocator

from verification.problem.array_types import Array
from verification.problem.display_units import Units
from verification.problem.quantity import QUANTITIES, von_mises
from verification.sources.source_registry import METHODS, solvers
from verification.study.friction_planes import XX, XZ
from verification.study.largest_stresses import Measure
from verification.study.pages.study_figures import Drawn, drawn, sheet
from verification.study.stress_section import StressSection, section
from verification.study.study_plan import Study
from verification.study.thickness_curves import ThicknessCurve

LEVELS, EVERY = 14, 3  # contours of a map; columns and rows of a section that its CSV skips
WIDEST, DEEPEST = 2.0, 1.6  # of the largest contact radius, what is drawn
FIELDS: dict[str, Measure] = {
    f"${QUANTITIES['sigma_xx'].tex}$": lambda s: s[XX],
    f"${QUANTITIES['sigma_xz'].tex}$": lambda s: s[XZ],
    "von Mises stress": von_mises,
}


def nearest(curve: ThicknessCurve, wanted: Sequence[float]) -> tuple[float, ...]:
    """The solved thicknesses over a_h nearest to those ``wanted``, each once, in increasing order."""
    return tuple(sorted({float(curve.h[np.abs(np.log(curve.h / h)).argmin()]) for h in wanted if h > 0}))


def contour_figures(study: Study, curve: ThicknessCurve, thicknesses: Sequence[float]) -> list[Drawn]:
    """Three maps above each other for each of ``thicknesses`` over a_h, of the coating of ``curve``.

    Every figure has the same extent and the same scales. Solved anew by the semi-analytical method, with the
    residual stress of the coating. Raises what it raises.
    """
    E = min(study.moduli, key=lambda E: abs(E / study.substrate[0] - curve.ratio))
    bare = replace(study.bare, friction=curve.friction)
    problems = [replace(bare, coatings=((E, study.coating_nu, h * curve.a_h),)) for h in thicknesses]
    numerics = study.numerics.get(METHODS[0], {}) | {"estimate_uncertainty": False}
    solutions = [solvers()[METHODS[0]](problem, numerics) for problem in problems]
    radius = max(solution.contact_radius for solution in solutions)
    residual = [study.residual[study.moduli.index(E)]] if study.residual else []
    sections = [
        section(solution, problem, WIDEST * radius, DEEPEST * radius, residual)
        for solution, problem in zip(solutions, problems, strict=True)
    ]
    scales = []
    for measure in FIELDS.values():
        values = np.concatenate([measure(s).ravel() for one in sections for s in one.stress])
        low, high = np.percentile(values / study.units.pascal, [1, 99.5])
        # about zero where they have either sign
        reach = (-max(-low, high), max(-low, high)) if low < 0 else (0.0, high)
        scales.append(np.asarray(MaxNLocator(LEVELS, steps=[1, 2, 2.5, 5, 10]).tick_values(*reach)))
    return [
        _map(curve, study.units, h, float(solution.contact_radius), one, scales)
        for h, solution, one in zip(thicknesses, solutions, sections, strict=True)
    ]


def _map(
    curve: ThicknessCurve, units: Units, h: float, a: float, shown: StressSection, scales: list[Array]
) -> Drawn:
    x, depths = shown.x / units.metre, [z / units.metre for z in shown.z]
    fields = [[measure(s) / units.pascal for s in shown.stress] for measure in FIELDS.values()]
    size = curve.a_h / units.metre
    with sheet(150, right=21) as figure:
        panels = figure.subplots(3, 1, sharex=True)
        for axes, name, layers, levels in zip(panels, FIELDS, fields, scales, strict=True):
            axes.grid(visible=False)
            cmap = "viridis" if levels[0] >= 0 else "RdBu_r"
            for z, values in zip(depths, layers, strict=True):
                filled = axes.contourf(x, z, values, levels=levels, cmap=cmap, extend="both")
                filled.set_rasterized(True)
                axes.contour(x, z, values, levels=levels, colors="#333333", linewidths=0.25)
            axes.axhline(h * size, color="#777777", linewidth=0.9, linestyle=(0, (4, 2)))
            edge = a / units.metre
            axes.plot([-edge, edge], [0, 0], color="#c02a2a", linewidth=3, solid_capstyle="butt")
            axes.set(xlim=(x[0], x[-1]), ylim=(depths[-1][-1], 0), ylabel=f"z [{units.length}]")
            at = axes.get_position()
            bar = figure.colorbar(filled, cax=figure.add_axes((at.x1 + 0.02, at.y0, 0.03, at.height)))
            bar.set_label(f"{name} [{units.stress}]")
            bar.locator = MaxNLocator(6)
            bar.update_ticks()
        panels[-1].set_xlabel(f"x [{units.length}], along sliding")
        over = panels[0].secondary_xaxis("top", functions=(lambda v: v / size, lambda v: v * size))
        over.set_xlabel("$x / a_h$")
        heads = ["h / a_h", f"x [{units.length}]", f"z [{units.length}]", "layer"]
        heads += [f"{name} [{units.stress}]" for name in ("sigma_xx", "sigma_xz", "von Mises")]
        rows = [
            [h, x[j], z[i], str(layer), *(values[layer][i, j] for values in fields)]
            for layer, z in enumerate(depths)
            for i in range(0, z.size, EVERY)
            for j in range(0, x.size, EVERY)
        ]
        name = f"contours_{curve.ratio:.4g}_f{curve.friction:g}_h{h:.3g}"
        title = f"Stresses in the x-z plane, {curve.label}, h = {h * size:.3g} {units.length}"
        return drawn(figure, name, title, "", [heads, *rows])
