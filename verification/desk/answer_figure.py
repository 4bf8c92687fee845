"""Figure of one answer: stresses along x in MPa over um, on the surface, at each interface."""

import io
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import matplotlib as mpl
from matplotlib.figure import Figure

from verification.desk.answer_stresses import Course
from verification.desk.contact_answer import Answer
from verification.problem.coated_contact import FLAT
from verification.running.checked_files import write_atomically

__all__ = ["COLOURS", "FORMATS", "draw", "save", "write"]

FORMATS = (".png", ".pdf", ".svg")
# Okabe and Ito's colours, distinct for the colour-blind.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00", "#000000")
_SETTINGS: Any = {"font.size": 9, "axes.grid": True, "grid.alpha": 0.3, "savefig.facecolor": "white"}


def write(answer: Answer, title: str, path: Path) -> None:
    """Write the figure; see ``save``."""
    save(lambda: draw(answer, title), path)


def save(drawn: Callable[[], Figure], path: Path) -> None:
    """Write a figure as PNG, PDF or SVG, by the suffix of ``path``; whole or not at all.

    Raises ValueError for another suffix.
    """
    suffix = path.suffix.lower()
    if suffix not in FORMATS:
        raise ValueError(f"{path}: the name has to end in {', '.join(FORMATS)}")
    content = io.BytesIO()
    with mpl.rc_context(_SETTINGS):
        drawn().savefig(content, format=suffix[1:], dpi=200)
    write_atomically(path, content.getvalue())


def draw(answer: Answer, title: str) -> Figure:
    """sigma_xx with its largest values as dots; below it sigma_xz and sigma_zz at each interface.

    Of an uncoated body those of the surface, sigma_zz = -p.
    """
    figure = Figure(figsize=(8.0, 6.4), layout="constrained")
    upper, lower = figure.subplots(2, 1, sharex=True)
    for course, colour in zip(answer.courses, _cycle(len(answer.courses)), strict=True):
        upper.plot(course.x * 1e6, course.stress[0] / 1e6, color=colour, label=_name(course))
        for at in answer.extremes:
            if (at.body, at.where, at.quantity) == (course.body, course.where, "sigma_xx"):
                upper.plot(at.x * 1e6, at.value / 1e6, "o", color=colour, markersize=4)
    below = [c for c in answer.courses if c.where.startswith("base")] or answer.courses
    for course, colour in zip(below, _cycle(len(below)), strict=True):
        lower.plot(course.x * 1e6, course.stress[3] / 1e6, color=colour, label=f"$σ_{{xz}}$, {_name(course)}")
        lower.plot(
            course.x * 1e6, course.stress[2] / 1e6, "--", color=colour, label=f"$σ_{{zz}}$, {_name(course)}"
        )
    upper.set_title(title)
    upper.set_ylabel("$σ_{xx}$ [MPa], tension positive")
    lower.set_ylabel("stress [MPa]")
    lower.set_xlabel("x [µm], along sliding")
    a = answer.numbers["contact_radius"][0] * 1e6
    for axes in (upper, lower):
        for edge in (-a, a):
            axes.axvline(edge, color="#777777", linewidth=0.8, linestyle=":")
        axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    return figure


def _name(course: Course) -> str:
    return course.where if course.body == FLAT else f"{course.body}, {course.where}"


def _cycle(count: int) -> Sequence[str]:
    return [COLOURS[i % len(COLOURS)] for i in range(count)]
