"""Figure of one answer: stresses along x, on the surface, at each interface."""

import io
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from verification.cases.case_file import Case
from verification.desk.answer_stresses import StressCourse, first_principal
from verification.desk.contact_answer import ContactAnswer, Names, with_name
from verification.desk.stack_text import conditions, stack, units_of
from verification.problem.display_units import Units
from verification.problem.point_answers import FLAT
from verification.running.checked_files import write_atomically
from verification.sources.source_registry import METHODS, solvers
from verification.study.pages.study_figures import COLOURS
from verification.study.stress_section import StressSection, section

WIDTH, BELOW = 2.0, 0.5  # extents of the section over a
FORMATS = (".png", ".pdf", ".svg")
STYLES = ("-", "--", "-.", ":", (0, (6, 1)), (0, (3, 1, 1, 1, 1, 1)), (0, (1, 3)))
_SETTINGS: Any = {"font.size": 9, "axes.grid": True, "grid.alpha": 0.3, "savefig.facecolor": "white"}


def write(case: Case, answer: ContactAnswer, path: Path) -> None:
    """Write the figure of the ``answer`` to ``case`` as PNG, PDF or SVG, by the suffix of ``path``.

    Solved again for its section by the semi-analytical method. Raises what it raises, and StoreError.
    """
    content, units = io.BytesIO(), units_of(case.problem)
    title = f"{stack(case)}\n{conditions(case.problem)}"
    with mpl.rc_context(_SETTINGS):
        drawn = _drawn(answer, title, _seen(case), case.names, units)
        drawn.savefig(content, format=path.suffix.lower()[1:], dpi=200)
    write_atomically(path, content.getvalue())


def _seen(case: Case) -> StressSection:
    """The section from the surface to half a contact radius below the deepest interface in sight."""
    problem = case.problem
    solution = solvers()[METHODS[0]](problem, {"estimate_uncertainty": False})
    a = float(solution.contact_radius)
    # A film is seen by itself: the view is no deeper than three times the stack.
    stack = problem.interfaces[-1] if problem.coatings else 0.0
    deepest = min(max(3 * stack, 0.02 * a), stack + BELOW * a) if stack else BELOW * a
    return section(solution, problem, WIDTH * a, deepest, case.residual.get(FLAT, ()))


def _drawn(answer: ContactAnswer, title: str, below: StressSection, names: Names, units: Units) -> Figure:
    """Stresses along x: sigma_xx with its largest values as dots; sigma_xz, sigma_zz at each interface.

    For an uncoated body those of the surface, sigma_zz = -p.
    """
    figure = Figure(figsize=(8.5, 9.0), layout="constrained")
    panels = figure.subplots(3, 2, sharex="col", width_ratios=(3, 1))
    upper, lower = panels[1:, 0]
    for beside in panels[1:, 1]:  # room for the legends
        beside.set_visible(False)
    a = answer.numbers["contact_radius"][0] / units.metre
    _section(figure, panels[0, 0], panels[0, 1], below, a, units)
    for course, colour, style in _cycle(answer.courses):
        upper.plot(
            course.x / units.metre,
            course.stress[0] / units.pascal,
            linestyle=style,
            color=colour,
            label=_name(course, names),
        )
        for at in answer.extremes:
            if (at.body, at.where, at.quantity) == (course.body, course.where, "sigma_xx"):
                upper.plot(at.x / units.metre, at.value / units.pascal, "o", color=colour, markersize=4)
    upper.plot([], [], "o", color="#777777", markersize=4, label="largest")
    bases = [c for c in answer.courses if c.where.startswith("base")] or answer.courses
    for number, name in ((3, "$σ_{xz}$"), (2, "$σ_{zz}$")):
        for course, colour, style in _cycle(bases):
            width = 1.8 if number == 3 else 0.9
            label = f"{name}, {_name(course, names)}"
            y = course.stress[number] / units.pascal
            lower.plot(course.x / units.metre, y, linestyle=style, color=colour, label=label, linewidth=width)
    figure.suptitle(title, fontsize=10)
    upper.set_ylabel(f"$σ_{{xx}}$ [{units.stress}], tension positive")
    lower.set_ylabel(f"stress [{units.stress}]")
    lower.set_xlabel(f"x [{units.length}], along sliding")
    for axes in (upper, lower):
        for edge in (-a, a):
            axes.axvline(edge, color="#777777", linewidth=0.8, linestyle=":")
        axes.axvspan(-a, a, color="#000000", alpha=0.05, linewidth=0, label="contact")
        legend = axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
        legend.set_in_layout(False)  # in the room beside the panel
    return figure


def _section(figure: Figure, axes: Axes, beside: Axes, below: StressSection, a: float, units: Units) -> None:
    """First principal stress of each layer as a field, with its boundaries and the contact.

    beside : axes of the same stress along the depth at the largest tension.
    """
    fields = [first_principal(s) / units.pascal for s in below.stress]
    depths, x = [z / units.metre for z in below.z], below.x / units.metre
    least, most = min(float(s.min()) for s in fields), max(float(s.max()) for s in fields)
    layer = int(np.argmax([s.max() for s in fields]))
    row, column = np.unravel_index(int(fields[layer].argmax()), fields[layer].shape)
    highest, x_at, z_at = fields[layer][row, column], float(x[column]), float(depths[layer][row])
    for z, stress in zip(depths, fields, strict=True):
        scale: Any = {"cmap": "cividis", "vmin": least, "vmax": most}  # from dark to bright in grey too
        field = axes.pcolormesh(x, z, stress, shading="gouraud", rasterized=True, **scale)
        axes.contour(x, z, stress, levels=[0.0], colors="white", linewidths=1.0)
        beside.plot(stress[:, column], z, color=COLOURS[0])
        for one in (axes, beside):
            one.axhline(z[0], color="black", linewidth=0.8)
    axes.plot(x_at, z_at, "k^", markersize=6, clip_on=False)
    beside.plot(highest, z_at, "k^", markersize=6, clip_on=False)
    beside.set_title(f"σ$_1$ [{units.stress}] at x = {x_at:.2f} {units.length}", fontsize=8)
    beside.tick_params(labelbottom=True, labelleft=False)
    axes.plot([-a, a], [0, 0], color="black", linewidth=4, solid_capstyle="butt", clip_on=False)
    for one in (axes, beside):
        one.set_ylim(float(depths[-1][-1]), 0.0)
    axes.set_ylabel(f"z [{units.length}]")
    axes.grid(visible=False)
    axes.set_title(
        "section of the flat: bar = contact, white = no tension, triangle = largest tension", fontsize=8
    )
    figure.colorbar(field, ax=beside, label=f"$σ_1$ [{units.stress}]", fraction=0.1)


def _name(course: StressCourse, names: Names) -> str:
    where = with_name(course.body, course.where, names)
    return where if course.body == FLAT else f"{course.body}, {where}"


def _cycle(courses: Sequence[StressCourse]) -> Iterator[tuple[StressCourse, str, Any]]:
    """Each course with its colour and line style, which differ without colour too."""
    for i, course in enumerate(courses):
        yield course, COLOURS[i % len(COLOURS)], STYLES[i % len(STYLES)]
