"""The picture of the manual of a contact of three lobes, drawn from new solutions by both methods."""

from collections.abc import Sequence
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure

from verification.cases.case_file import read_case, shaped_cases
from verification.manual.generated_blocks import SOURCE
from verification.problem.array_types import Array
from verification.problem.coated_contact import CoatedContact, ContactSolution
from verification.problem.indenter_shape import height_of
from verification.sources.source_registry import METHODS, SOURCES

CASE = "25_three_lobes"
WIDTH, POINTS = 1.5, 45  # half the side of a picture over the contact radius; points along a side
# title, factor to its unit, colours, of values and of differences
COLUMNS = (
    ("pressure [MPa]", 1e-6, "viridis"),
    ("gap [nm]", 1e9, "cividis"),
    (r"$\sigma_{xx}$, base of coating [MPa]", 1e-6, "viridis"),
)


def lobes() -> int:
    """Pressure, gap and stress of the contact of three lobes by both methods, with their difference."""
    problem = read_case(shaped_cases()[CASE]).problem
    solutions = {}
    for name in METHODS:
        solve = SOURCES[name].solve
        assert solve is not None
        solutions[SOURCES[name].label] = solve(problem, {"estimate_uncertainty": False})
    a = float(next(iter(solutions.values())).contact_radius)
    side = WIDTH * a * np.linspace(-1, 1, POINTS)
    x, y = np.meshgrid(side, side)
    half = POINTS // 2  # all fields are even in y
    fields = [_fields(solution, problem, x[half:], y[half:]) for solution in solutions.values()]
    fields = [np.concatenate([one[:, :0:-1], one], axis=1) for one in fields]
    rows = [*zip(solutions, fields, strict=True), ("difference", fields[1] - fields[0])]
    path = SOURCE / "_static" / "lobes.svg"
    with mpl.rc_context({"svg.hashsalt": CASE, "font.size": 8}):
        _drawn(rows, x * 1e6, y * 1e6).savefig(path, format="svg", dpi=160, metadata={"Date": None})
    return 0


def _drawn(rows: Sequence[tuple[str, Array]], x: Array, y: Array) -> Figure:
    """Panels of the ``rows``, (label, values), over x, y [um]; the contact is outlined."""
    figure = Figure(figsize=(8.5, 7.4), layout="constrained")
    panels = figure.subplots(len(rows), len(COLUMNS), sharex=True, sharey=True)
    pressure = rows[0][1][0]
    for panel, (title, *_) in zip(panels[0], COLUMNS, strict=True):
        panel.set_title(title)
    for axes, (label, values) in zip(panels, rows, strict=True):
        axes[0].set_ylabel(f"{label}\ny [um]")
        for panel, field, (_, unit, colours) in zip(axes, values, COLUMNS, strict=True):
            style: dict[str, Any] = {"cmap": colours}
            if label == "difference":
                largest = np.abs(field).max() * unit
                style = {"cmap": "RdBu_r", "vmin": -largest, "vmax": largest}
            shown = panel.pcolormesh(x, y, field * unit, rasterized=True, **style)
            panel.contour(x, y, pressure, levels=[1e-3 * pressure.max()], colors="black", linewidths=0.8)
            panel.set_aspect("equal")
            figure.colorbar(shown, ax=panel, shrink=0.9)
    for panel in panels[-1]:
        panel.set_xlabel("x [um]")
    return figure


def _fields(solution: ContactSolution, problem: CoatedContact, x: Array, y: Array) -> Array:
    """Pressure [Pa], gap [m], sigma_xx [Pa] at the base of the coating."""
    height = height_of(problem.indenter, problem.radius)(x, y)
    gap = height + solution.displacement(x, y, 0.0)[2] - solution.approach
    base = solution.stress(x, y, problem.interfaces[0], layer=0)[0, 0]
    return np.array([solution.pressure(x, y), gap, base])
