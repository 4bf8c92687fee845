"""Contour maps of sigma_xx, sigma_xz, von Mises in the x-z plane for a few thicknesses."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from matplotlib.ticker import MaxNLocator

from verification.cases.unit_numbers import Units
from verification.problem.array_types import Array
from verification.problem.quantity import QUANTITIES, von_mises
from verification.sources.source_registry import METHODS, solvers
from verification.study.friction_planes import XX, XZ, in_plane
from verification.study.largest_stresses import with_residual
from verification.study.pages.study_figures import Drawn, drawn, sheet
from verification.study.study_plan import Study
from verification.study.thickness_curves import Curve

LEVELS = 14
COLUMNS, ROWS, FEWEST = 81, 28, 6
WIDEST, DEEPEST = 2.0, 1.6  # of the largest contact radius, what is drawn
FIELDS = (*(f"${QUANTITIES[name].tex}$" for name in ("sigma_xx", "sigma_xz")), "von Mises stress")


def nearest(curve: Curve, wanted: Sequence[float]) -> tuple[float, ...]:
    """The solved thicknesses over a_h nearest to those ``wanted``, each once, in increasing order."""
    return tuple(sorted({float(curve.h[np.abs(np.log(curve.h / h)).argmin()]) for h in wanted if h > 0}))


def contour_figures(study: Study, curve: Curve, thicknesses: Sequence[float]) -> list[Drawn]:
    """Three maps above each other for each of ``thicknesses`` over a_h, of the coating of ``curve``.

    Every figure has the same extent and the same scales. Solved anew by the semi-analytical method, with the
    residual stress of the coating. Raises what it raises.
    """
    a_h, units = curve.a_h, study.units
    E = min(study.moduli, key=lambda E: abs(E / study.substrate[0] - curve.ratio))
    coatings = [(E, study.coating_nu, h * a_h) for h in thicknesses]
    bare = replace(study.bare, friction=curve.friction)
    numerics = study.numerics.get(METHODS[0], {}) | {"estimate_uncertainty": False}
    solutions = [solvers()[METHODS[0]](replace(bare, coatings=(one,)), numerics) for one in coatings]
    radius = max(s.contact_radius for s in solutions) / a_h
    x = np.linspace(-WIDEST * radius, WIDEST * radius, COLUMNS)
    depths = [_depths(h, DEEPEST * radius) for h in thicknesses]
    residual = study.residual[study.moduli.index(E)] if study.residual else 0.0
    fields = [
        [
            _fields(s, x * a_h, z * a_h, layer, 0.0 if layer else residual, units)
            for layer, z in enumerate(levels)
        ]
        for s, levels in zip(solutions, depths, strict=True)
    ]
    scales = []
    for column in range(3):
        low, high = _range([layer[column] for row in fields for layer in row])
        scales.append(np.asarray(MaxNLocator(LEVELS, steps=[1, 2, 2.5, 5, 10]).tick_values(low, high)))
    return [
        _one(curve, units, x, *one, scales)
        for one in zip(thicknesses, solutions, depths, fields, strict=True)
    ]


def _one(
    curve: Curve,
    units: Units,
    x: Array,
    h: float,
    solution: Any,
    levels_z: list[Array],
    field: list[tuple[Array, Array, Array]],
    scales: list[Array],
) -> Drawn:
    size = curve.a_h / units.metre
    with sheet(150, right=17) as figure:
        panels = figure.subplots(3, 1, sharex=True, squeeze=False)[:, 0]
        for column, (axes, name, levels) in enumerate(zip(panels, FIELDS, scales, strict=True)):
            for z, values in zip(levels_z, (layer[column] for layer in field), strict=True):
                filled = axes.contourf(
                    x * size, z * size, values, levels=levels, cmap="RdBu_r" if column < 2 else "viridis",
                    extend="both",
                )  # fmt: skip
                filled.set_rasterized(True)
                axes.contour(x * size, z * size, values, levels=levels, colors="#333333", linewidths=0.25)
            axes.axhline(h * size, color="black", linewidth=0.9, linestyle=(0, (4, 2)))
            edge = solution.contact_radius / units.metre
            axes.plot([-edge, edge], [0, 0], color="black", linewidth=3, solid_capstyle="butt")
            axes.set_xlim(x[0] * size, x[-1] * size)
            axes.set_ylim(levels_z[-1][-1] * size, 0)
            axes.set_ylabel(f"z [{units.length}]")
            place = axes.get_position()
            bar = figure.colorbar(
                filled, cax=figure.add_axes((place.x1 + 0.02, place.y0, 0.03, place.height))
            )
            bar.set_label(f"{name} [{units.stress}]")
            bar.locator = MaxNLocator(6)
            bar.update_ticks()
        panels[-1].set_xlabel(f"x [{units.length}], along sliding")
        over = panels[0].secondary_xaxis("top", functions=(lambda v: v / size, lambda v: v * size))
        over.set_xlabel("$x / a_h$")
        heads = ["h / a_h", f"x [{units.length}]", f"z [{units.length}]", "layer"]
        heads += [f"{name} [{units.stress}]" for name in ("sigma_xx", "sigma_xz", "von Mises")]
        rows = [heads, *_numbers(h, x * size, [z * size for z in levels_z], field)]
        name = f"contours_{curve.ratio:.4g}_f{curve.friction:g}_h{h:.3g}".replace(".", "_")
        return drawn(
            figure,
            name,
            f"Stresses in the x-z plane, {curve.label}, h = {h * size:.3g} {units.length}",
            "",
            rows,
        )


def _depths(h: float, deep: float) -> list[Array]:
    """Depths over a_h in each layer in sight, both sides of the interface, crowded below the surface."""
    every = deep * np.linspace(0, 1, ROWS) ** 1.5
    if h >= deep:
        return [every]
    within = h * np.linspace(0, 1, max(FEWEST, int((every < h).sum()) + 1)) ** 1.5
    return [within, np.append(h, every[every > 1.02 * h])]


def _fields(
    solution: Any, x: Array, z: Array, layer: int, residual: float, units: Units
) -> tuple[Array, Array, Array]:
    sigma = solution.stress(x[None, :], 0.0, z[:, None], layer=layer)
    s, added = in_plane(sigma) / units.pascal, residual / units.pascal
    return s[XX] + added, s[XZ], np.asarray(with_residual(von_mises, added)(s))


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
