"""Figure of one answer: stresses along x, on the surface, at each interface."""

from collections.abc import Iterator, Sequence
from pathlib import Path
from textwrap import wrap
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure

from verification.cases.case_file import Case
from verification.desk.answer_stresses import StressCourse
from verification.desk.contact_answer import ContactAnswer, Names, with_name
from verification.desk.stack_text import conditions, stack, units_of
from verification.page.figures import save
from verification.problem.display_units import Units
from verification.problem.point_answers import FLAT
from verification.problem.quantity import first_principal, von_mises
from verification.sources.source_registry import METHODS, solvers
from verification.study.largest_stresses import Measure
from verification.study.pages.study_figures import COLOURS
from verification.study.stress_section import StressSection, section

WIDTH, BELOW, MOST = 2.0, 0.5, 7  # extents of the section over a; courses of a panel
STYLES = ("-", "--", "-.", ":", (0, (6, 1)), (0, (3, 1, 1, 1, 1, 1)), (0, (1, 3)))
_SETTINGS: Any = {"font.size": 9, "axes.grid": True, "grid.alpha": 0.3}


def write(case: Case, answer: ContactAnswer, path: Path) -> None:
    """Write the figure of the ``answer`` to ``case`` as PNG, PDF or SVG, by the suffix of ``path``.

    Solved again for its section by the semi-analytical method. Raises what it raises, and StoreError.
    """
    title = f"{stack(case)}\n{conditions(case.problem)}"
    with mpl.rc_context(_SETTINGS):
        save(_drawn(answer, title, _seen(case), case.names, units_of(case.problem)), path)


def _seen(case: Case) -> tuple[StressSection, StressSection]:
    """A section of the films, and one as deep as the largest von Mises stress below the contact."""
    problem = case.problem
    solution = solvers()[METHODS[0]](problem, {"estimate_uncertainty": False})
    a = float(solution.contact_radius)
    stack = problem.interfaces[-1] if problem.coatings else 0.0
    films = min(max(3 * stack, 0.02 * a), stack + BELOW * a) if stack else BELOW * a
    shown = [
        section(solution, problem, WIDTH * a, z, case.residual.get(FLAT, ())) for z in (films, stack + a)
    ]
    return shown[0], shown[1]


def _drawn(
    answer: ContactAnswer, title: str, seen: tuple[StressSection, StressSection], names: Names, units: Units
) -> Figure:
    """Two sections; stresses along x: sigma_xx with its largest values as dots, sigma_xz, sigma_zz.

    Of more courses than ``MOST`` those with the largest stresses. For an uncoated body those of the surface,
    sigma_zz = -p.
    """
    figure = Figure(figsize=(8.5, 9.0), layout="constrained")
    above, below = figure.subfigures(2, 1, height_ratios=(1, 2), squeeze=False)[:, 0]
    maps = above.subplots(1, 2)
    panels = below.subplots(2, 2, sharex="col", width_ratios=(3, 1))
    upper, lower = panels[:, 0]
    for beside in panels[:, 1]:  # room for the legends
        beside.set_visible(False)
    a = answer.reach / units.metre
    _section(above, maps[0], seen[0], first_principal, "largest tension $σ_1$; line: 0", a, units)
    _section(above, maps[1], seen[1], von_mises, "von Mises stress", a, units)
    for course, colour, style in _cycle(_chosen(answer.courses, 0)):
        x, y = course.x / units.metre, course.stress[0] / units.pascal
        upper.plot(x, y, linestyle=style, color=colour, label=_name(course, names))
        for at in answer.extremes:
            if (at.body, at.where, at.quantity) == (course.body, course.where, "sigma_xx"):
                upper.plot(at.x / units.metre, at.value / units.pascal, "o", color=colour, markersize=4)
    upper.plot([], [], "o", color="#777777", markersize=4, label="largest")
    bases = [c for c in answer.courses if c.where.startswith("base")] or answer.courses
    for number, name in ((3, "$σ_{xz}$"), (2, "$σ_{zz}$")):
        for course, colour, style in _cycle(_chosen(bases, 3, MOST // 2)):
            width = 1.8 if number == 3 else 0.9
            label = f"{name}, {_name(course, names)}"
            y = course.stress[number] / units.pascal
            lower.plot(course.x / units.metre, y, linestyle=style, color=colour, label=label, linewidth=width)
    figure.suptitle("\n".join(line for part in title.split("\n") for line in wrap(part, 100)), fontsize=10)
    upper.set_ylabel(f"$σ_{{xx}}$ [{units.stress}], tension positive")
    lower.set_ylabel(f"stress [{units.stress}]")
    lower.set_xlabel(f"x [{units.length}], along sliding")
    for axes in (upper, lower):
        for edge in (-a, a):
            axes.axvline(edge, color="#777777", linewidth=0.8, linestyle=":")
        axes.axvspan(-a, a, color="#000000", alpha=0.05, linewidth=0, label="contact")
        legend = axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False, fontsize=8)
        legend.set_in_layout(False)  # in the room beside the panel
    return figure


def _chosen(courses: Sequence[StressCourse], component: int, most: int = MOST) -> list[StressCourse]:
    """The courses with the largest stress of a component, at most so many, in their order."""
    ranked = sorted(courses, key=lambda one: -float(np.abs(one.stress[component]).max()))
    chosen = [*courses[:1], *(one for one in ranked if one is not courses[0])][:most]
    return [one for one in courses if any(one is other for other in chosen)]


def _section(
    figure: SubFigure, axes: Axes, seen: StressSection, measure: Measure, title: str, a: float, units: Units
) -> None:
    """A stress of each layer as a field with the largest marked, the boundaries of layers, the contact."""
    fields = [measure(s) / units.pascal for s in seen.stress]
    depths, x = [z / units.metre for z in seen.z], seen.x / units.metre
    least, most = min(float(s.min()) for s in fields), max(float(s.max()) for s in fields)
    layer = int(np.argmax([s.max() for s in fields]))
    row, column = np.unravel_index(int(fields[layer].argmax()), fields[layer].shape)
    for z, stress in zip(depths, fields, strict=True):
        scale: Any = {"cmap": "cividis", "vmin": least, "vmax": most}  # from dark to bright in grey too
        field = axes.pcolormesh(x, z, stress, shading="gouraud", rasterized=True, **scale)
        if least < 0 < most:
            axes.contour(x, z, stress, levels=[0.0], colors="white", linewidths=1.0)
        if z[-1] - z[0] > 0.01 * depths[-1][-1]:  # thinner layers would be one black bar
            axes.axhline(z[0], color="black", linewidth=0.8 if len(depths) <= MOST else 0.3)
    axes.plot(x[column], depths[layer][row], "k^", markersize=6, clip_on=False)
    axes.plot([-a, a], [0, 0], color="black", linewidth=4, solid_capstyle="butt", clip_on=False)
    axes.set(ylim=(float(depths[-1][-1]), 0.0), xlabel=f"x [{units.length}]", ylabel=f"z [{units.length}]")
    axes.grid(visible=False)
    axes.set_title(f"{title}; triangle: largest", fontsize=8)
    figure.colorbar(field, ax=axes, label=units.stress)


def _name(course: StressCourse, names: Names) -> str:
    where = with_name(course.body, course.where, names)
    return where if course.body == FLAT else f"{course.body}, {where}"


def _cycle(courses: Sequence[StressCourse]) -> Iterator[tuple[StressCourse, str, Any]]:
    """Each course with its colour and line style, which differ without colour too."""
    for i, course in enumerate(courses):
        yield course, COLOURS[i % len(COLOURS)], STYLES[i % len(STYLES)]
