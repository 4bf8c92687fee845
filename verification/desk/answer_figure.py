"""Figure of one answer: stresses along x, on the surface, at each interface."""

import io
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from verification.desk.answer_stresses import Course
from verification.desk.contact_answer import Answer, Names, with_name
from verification.desk.section_field import Section
from verification.problem.display_units import Units
from verification.problem.point_answers import FLAT
from verification.running.checked_files import write_atomically
from verification.study.pages.study_figures import COLOURS

FORMATS = (".png", ".pdf", ".svg")
STYLES = ("-", "--", "-.", ":", (0, (6, 1)), (0, (3, 1, 1, 1, 1, 1)), (0, (1, 3)))
_SETTINGS: Any = {"font.size": 9, "axes.grid": True, "grid.alpha": 0.3, "savefig.facecolor": "white"}


def write(answer: Answer, title: str, path: Path, below: Section, names: Names, units: Units) -> None:
    """Write the figure as PNG, PDF or SVG, by the suffix of ``path``; whole or not at all.

    below : the section on top.   names : of the coatings, see ``Case``.
    """
    content = io.BytesIO()
    with mpl.rc_context(_SETTINGS):
        _drawn(answer, title, below, names, units).savefig(content, format=path.suffix.lower()[1:], dpi=200)
    write_atomically(path, content.getvalue())


def _drawn(answer: Answer, title: str, below: Section, names: Names, units: Units) -> Figure:
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


def _section(figure: Figure, axes: Axes, beside: Axes, below: Section, a: float, units: Units) -> None:
    """First principal stress of each layer as a field, with its boundaries and the contact.

    beside : axes of the same stress along the depth at the largest tension.
    """
    least, most = (float(end([end(s) for s in below.stress])) / units.pascal for end in (np.min, np.max))
    for z, stress in zip(below.z, below.stress, strict=True):
        field = axes.pcolormesh(
            below.x / units.metre,
            z / units.metre,
            stress / units.pascal,
            cmap="cividis",  # from dark to bright in grey too
            vmin=least,
            vmax=most,
            shading="gouraud",
            rasterized=True,
        )
        axes.contour(
            below.x / units.metre, z / units.metre, stress, levels=[0.0], colors="white", linewidths=1.0
        )
        axes.axhline(z[0] / units.metre, color="black", linewidth=0.8)
    highest = max(
        (float(s.max()), float(below.x[s.max(axis=0).argmax()]), float(z[s.max(axis=1).argmax()]))
        for z, s in zip(below.z, below.stress, strict=True)
    )
    axes.plot(highest[1] / units.metre, highest[2] / units.metre, "k^", markersize=6, clip_on=False)
    column = int(np.argmin(np.abs(below.x - highest[1])))
    for z, stress in zip(below.z, below.stress, strict=True):
        beside.plot(stress[:, column] / units.pascal, z / units.metre, color=COLOURS[0])
        beside.axhline(z[0] / units.metre, color="black", linewidth=0.8)
    beside.plot(highest[0] / units.pascal, highest[2] / units.metre, "k^", markersize=6, clip_on=False)
    beside.set_ylim(float(below.z[-1][-1]) / units.metre, 0.0)
    beside.set_title(
        f"σ$_1$ [{units.stress}] at x = {highest[1] / units.metre:.2f} {units.length}", fontsize=8
    )
    beside.tick_params(labelbottom=True, labelleft=False)
    axes.plot([-a, a], [0, 0], color="black", linewidth=4, solid_capstyle="butt", clip_on=False)
    axes.set_ylim(float(below.z[-1][-1]) / units.metre, 0.0)
    axes.set_ylabel(f"z [{units.length}]")
    axes.grid(visible=False)
    axes.set_title(
        "section of the flat: bar = contact, white = no tension, triangle = largest tension", fontsize=8
    )
    figure.colorbar(field, ax=beside, label=f"$σ_1$ [{units.stress}]", fraction=0.1)


def _name(course: Course, names: Names) -> str:
    where = with_name(course.body, course.where, names)
    return where if course.body == FLAT else f"{course.body}, {where}"


def _cycle(courses: Sequence[Course]) -> Iterator[tuple[Course, str, Any]]:
    """Each course with its colour and line style, which differ without colour too."""
    for i, course in enumerate(courses):
        yield course, COLOURS[i % len(COLOURS)], STYLES[i % len(STYLES)]
