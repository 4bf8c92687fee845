"""Contour maps of sigma_xx, sigma_xz, von Mises in the x-z plane for a few thicknesses."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.ticker import MaxNLocator

from verification.problem.arrays import Array
from verification.problem.contact import CoatedContact
from verification.problem.quantity import IN_PLANE, QUANTITIES, von_mises
from verification.report.study.figures import Drawn, drawn, sheet
from verification.sources.registry import METHODS, solvers
from verification.study.curves import Curve
from verification.study.plan import Study

LEVELS = 18
COLUMNS, ROWS, FEWEST = 81, 28, 6
WIDEST, DEEPEST = 2.0, 1.6  # of the largest contact radius, what is drawn
FIELDS = (
    *(f"${QUANTITIES[name].tex} / p_h$" for name in ("sigma_xx", "sigma_xz")),
    "von Mises stress $/ p_h$",
)


def nearest(curve: Curve, wanted: Sequence[float]) -> tuple[float, ...]:
    """The solved thicknesses over a_h nearest to those ``wanted``, each once, in increasing order."""
    return tuple(sorted({float(curve.h[np.abs(np.log(curve.h / h)).argmin()]) for h in wanted if h > 0}))


def contour_figure(study: Study, curve: Curve, thicknesses: Sequence[float]) -> Drawn:
    """Three maps a row, a row for each of ``thicknesses`` over a_h, of the coating and friction of ``curve``.

    Solved anew by the semi-analytical method. Raises what it raises.
    """
    a_h = curve.a_h
    solutions = [_solved(study, curve, h) for h in thicknesses]
    radius = max(s.contact_radius for s in solutions) / a_h
    half, deep = WIDEST * radius, DEEPEST * radius
    x = np.linspace(-half, half, COLUMNS)
    depths = [_depths(h, deep) for h in thicknesses]
    fields = [
        [_fields(s, x * a_h, z * a_h, layer, curve.p_h) for layer, z in enumerate(levels)]
        for s, levels in zip(solutions, depths, strict=True)
    ]
    rows = [["h / a_h", "x / a_h", "z / a_h", "layer", "sigma_xx / p_h", "sigma_xz / p_h", "von Mises / p_h"]]
    with sheet(180, 12 + 48 * len(thicknesses)) as figure:
        panels = figure.subplots(len(thicknesses), 3, sharex=True, sharey=True, squeeze=False)
        for column, name in enumerate(FIELDS):
            low, high = _range([field[column] for row in fields for field in row])
            levels = np.asarray(MaxNLocator(LEVELS, steps=[1, 2, 2.5, 5, 10]).tick_values(low, high))
            for h, solution, layers_z, field, axes in zip(
                thicknesses, solutions, depths, fields, panels[:, column], strict=True
            ):
                for z, values in zip(layers_z, (layer[column] for layer in field), strict=True):
                    filled = axes.contourf(
                        x, z, values, levels=levels, cmap="RdBu_r" if column < 2 else "viridis", extend="both"
                    )
                    axes.contour(x, z, values, levels=levels, colors="#333333", linewidths=0.25)
                axes.axhline(h, color="black", linewidth=0.9, linestyle=(0, (4, 2)))
                axes.plot(
                    np.array([-1, 1]) * solution.contact_radius / a_h, [0, 0], color="black", linewidth=3
                )
                axes.set_xlim(-half, half)
                axes.set_ylim(deep, 0)
                axes.set_title(f"{name}, h = {h:.3g} $a_h$", fontsize=7.5)
            bar = figure.colorbar(filled, ax=panels[:, column], location="bottom", shrink=0.9, aspect=28)
            ticks = MaxNLocator(4).tick_values(levels[0], levels[-1])
            bar.set_ticks(ticks[(ticks >= levels[0]) & (ticks <= levels[-1])].tolist())
        for axes in panels[-1]:
            axes.set_xlabel("$x / a_h$")
        for axes in panels[:, 0]:
            axes.set_ylabel("$z / a_h$")
        for h, layers_z, field in zip(thicknesses, depths, fields, strict=True):
            rows += _numbers(h, x, layers_z, field)
        name = f"contours_{curve.ratio:.4g}_f{curve.friction:g}".replace(".", "_")
        return drawn(
            figure,
            name,
            f"Stresses in the x-z plane, {curve.label}",
            "Sliding in +x. Thick bar: the contact; dashed: the interface. One scale a column.",
            rows,
        )


def _solved(study: Study, curve: Curve, h: float) -> Any:
    E, nu = study.substrate
    coating = (curve.ratio * E, study.coating_nu, h * curve.a_h)
    problem = CoatedContact(study.radius, study.load, (coating,), (E, nu), curve.friction, study.ball)
    numerics = study.numerics.get(METHODS[0], {}) | {"estimate_uncertainty": False}
    return solvers()[METHODS[0]](problem, numerics)


def _depths(h: float, deep: float) -> list[Array]:
    """Depths over a_h in each layer in sight, both sides of the interface, crowded below the surface."""
    every = deep * np.linspace(0, 1, ROWS) ** 1.5
    if h >= deep:
        return [every]
    within = h * np.linspace(0, 1, max(FEWEST, int((every < h).sum()) + 1)) ** 1.5
    return [within, np.append(h, every[every > 1.02 * h])]


def _fields(solution: Any, x: Array, z: Array, layer: int, p_h: float) -> tuple[Array, Array, Array]:
    sigma = solution.stress(x[None, :], 0.0, z[:, None], layer=layer)
    s = np.array([sigma[component] for component in IN_PLANE.values()]) / p_h
    names = list(IN_PLANE)
    return s[names.index("sigma_xx")], s[names.index("sigma_xz")], von_mises(s)


def _range(values: Sequence[Array]) -> tuple[float, float]:
    """What a scale spans: nearly all of the values, about zero for stresses of either sign."""
    low, high = np.percentile(np.concatenate([v.ravel() for v in values]), [1, 99.5])
    if low < 0:
        reach = max(-low, high)
        return -float(reach), float(reach)
    return 0.0, float(high)


def _numbers(
    h: float, x: Array, layers_z: Sequence[Array], field: Sequence[tuple[Array, Array, Array]]
) -> list[list[str]]:
    return [
        [f"{h:.6g}", f"{at:.5g}", f"{z:.5g}", str(layer), *(f"{values[i, j]:.5g}" for values in fields)]
        for layer, (depths, fields) in enumerate(zip(layers_z, field, strict=True))
        for i, z in enumerate(depths)
        for j, at in enumerate(x)
    ]
