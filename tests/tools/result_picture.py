"""The picture of the README as SVG, drawn from the numbers of the baseline."""

from operator import attrgetter
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from verification.manual.baseline_numbers import stored
from verification.manual.generated_blocks import SOURCE
from verification.page.number_text import engineering, plain
from verification.running.case_result import CaseResult
from verification.sources.source_registry import EXACT, SOURCES

# Okabe and Ito's colours, distinct for the colour-blind; markers tell the sources apart in grey too.
COLOURS = {"semianalytic": "#0072B2", "fem_reference": "#D55E00", "integral_equation": "#222222"}
MARKERS = {"semianalytic": "o", "fem_reference": "x"}
LEAST = 1e-14  # a smaller difference is drawn here
SETTINGS: Any = {
    "font.size": 8.5,
    "font.family": "sans-serif",
    "axes.grid": True,
    "grid.alpha": 0.25,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "svg.fonttype": "none",
    "svg.hashsalt": "coatcheck",
    "savefig.facecolor": "white",
}
GROUPS = (
    ("$p_0$", ("peak_pressure",), ""),
    ("$a$", ("contact_radius",), ""),
    ("$\\delta$", ("approach",), ""),
    ("d$W$/d$\\delta$", ("stiffness",), ""),
    ("max $\\sigma_{xx}$, its place", ("largest_tension", "tension_place"), ""),
    ("$p$", ("pressure",), ""),
    ("$\\sigma$, surface", ("sigma_",), "surface"),
    ("$\\sigma$, axis", ("sigma_",), "axis"),
    ("$\\sigma$, interfaces", ("sigma_",), "interface"),
    ("$\\sigma$, off the plane", ("sigma_",), "o"),
    ("$u$", ("u_",), ""),
)


def picture() -> int:
    """Section, pressure and sigma_xx of the surface, sigma_xx of the interface, differences of a case."""
    result = stored("14_ratio_4_sliding")
    with mpl.rc_context(SETTINGS):
        figure = Figure(figsize=(8.6, 6.8))
        (section, surface), (below, distances) = figure.subplots(2, 2)
        figure.subplots_adjust(0.075, 0.12, 0.985, 0.955, wspace=0.34, hspace=0.3)
        _section(section, result)
        _curve(surface, result, "pressure", "surface", "#009E73", "$p$")
        _curve(surface, result, "sigma_xx", "surface", "#222222", "$\\sigma_{xx}$")
        surface.set(xlim=(-2, 2), xlabel="$x / a_h$", ylabel="over $p_h$")
        surface.set_title("Surface: exact —, semi-analytical ○, elements ×", fontsize=9, loc="left")
        surface.legend(frameon=False, loc="best")
        _curve(below, result, "sigma_xx", "interface 1, upper side", "#222222", "interface 1")
        _curve(below, result, "sigma_xx", "interface 1, lower side", "#222222", "", "--")
        below.set(xlim=(-2, 2), xlabel="$x / a_h$", ylabel="$\\sigma_{xx} / p_h$")
        title = "$\\sigma_{xx}$ at each interface: above it (full), below it (dashed)"
        below.set_title(title, fontsize=9, loc="left")
        below.legend(frameon=False, fontsize=7, loc="best")
        _distances(distances, result)
        path = SOURCE / "_static" / "result.svg"
        figure.savefig(path, format="svg", metadata={"Date": None, "Creator": None})
    return 0


def _section(axes: Any, result: CaseResult) -> None:
    """Coating and substrate to scale in z/a_h; the contact above them."""
    problem, a_h = result.problem, result.problem["a_h"]
    a = result.profile_of["contact_radius", "contact", "integral_equation"].value[0] / a_h
    ((E, nu, h),) = problem["coatings"]
    deepest = max(1.8, 1.35 * h / a_h)
    axes.set(xlim=(-2, 2), ylim=(deepest, -0.42 * deepest), ylabel="$z / a_h$", xlabel="$x / a_h$")
    axes.grid(visible=False)
    coating = f"$E$ {engineering(E, 'Pa', 3)}, $\\nu$ {plain(nu, 3)}, $h$ {engineering(h, 'm', 3)}"
    E, nu = problem["substrate"]
    substrate = f"$E$ {engineering(E, 'Pa', 3)}, $\\nu$ {plain(nu, 3)}"
    layers = (0.0, h / a_h, "0.55", coating), (h / a_h, deepest - h / a_h, "0.9", substrate)
    for top, height, shade, text in layers:
        axes.add_patch(Rectangle((-2, top), 4, height, facecolor=shade, edgecolor="#444", lw=0.6))
        axes.annotate(text, (-1.93, top + min(height / 2, 0.11 * deepest)), va="center", fontsize=7.5)
    x = np.linspace(-2, 2, 200)
    ball = np.where(np.abs(x) < a, 0.0, -0.11 * deepest * (x**2 - a**2))
    inside = ball > -0.4 * deepest
    axes.plot(x[inside], ball[inside], color="#444", lw=1.4)
    axes.plot([-a, a], [0, 0], color="#b03a2e", lw=3, solid_capstyle="butt")
    axes.text(0, -0.36 * deepest, f"rigid sphere, $R$ {engineering(problem['radius'], 'm', 3)}", ha="center")
    axes.text(0, -0.26 * deepest, f"$W$ {engineering(problem['load'], 'N', 3)}", ha="center")
    axes.text(0, -0.05 * deepest, f"$2a$ = {2 * a:.3g} $a_h$", ha="center", color="#b03a2e", fontsize=7.5)
    axes.set_title("The problem (sphere not to scale)", fontsize=9, loc="left")


def _curve(
    axes: Any, result: CaseResult, quantity: str, line: str, colour: str, label: str, style: str = "-"
) -> None:
    """A quantity over p_h along a line: a curve of the exact solution, a few markers of both methods."""
    for i, source in enumerate(("integral_equation", *MARKERS)):
        found = result.profile_of[quantity, line, source]
        order = np.argsort(found.position)
        if i:
            order = order[np.linspace(0, len(order) - 1, 25).astype(int)[i - 1 :: 2]]
        x, y = found.position[order] / result.problem["a_h"], found.value[order] / result.problem["p_h"]
        if i == 0:
            axes.plot(x, y, style, color=colour, lw=1.1, label=label)
        else:
            open_ = {"markersize": 4.2, "markerfacecolor": "none", "markeredgewidth": 1.0}
            axes.plot(x, y, MARKERS[source], color=COLOURS[source], **open_)


def _distances(axes: Any, result: CaseResult) -> None:
    """The largest |A - B| of each pair in each group as a dot, its U as a bar, the cap as a line."""
    groups = [
        [
            pair
            for pair in result.verdicts
            if pair[0].quantity.startswith(names) and pair[0].line.startswith(line)
        ]
        for _, names, line in GROUPS
    ]
    for y, found in enumerate(groups):
        sets = list(dict.fromkeys(claim.between for claim, _ in found))
        for i, between in enumerate(sets):
            of_set = [verdict for claim, verdict in found if claim.between == between]
            worst = max(of_set, key=attrgetter("difference"))
            offset = y + 0.26 * ((i + 0.5) / len(sets) - 0.5) * 2
            colour, U = _colour(between), max(worst.uncertainty, LEAST)
            axes.plot([LEAST, U], [offset, offset], color=colour, lw=2.2, alpha=0.25, solid_capstyle="butt")
            axes.plot(max(worst.difference, LEAST), offset, "o", color=colour, markersize=3.6)
        cap = min(claim.cap for claim, _ in found)
        axes.plot([cap, cap], [y - 0.4, y + 0.4], color="#c02a2a", lw=1.2, ls=(0, (3, 1.5)))
    axes.set_xscale("log")
    axes.set(xlim=(LEAST, 3e-2), ylim=(len(groups) - 0.4, -0.6), xlabel="over the scale of the comparison")
    axes.set_yticks(range(len(groups)), [label for label, *_ in GROUPS])
    axes.grid(visible=False, axis="y")
    axes.set_title("Largest difference (dot), $U$ (bar), cap (dashed)", fontsize=9, loc="left")
    shown = dict.fromkeys(claim.between for found in groups for claim, _ in found)
    handles = [mpl.lines.Line2D([], [], marker="o", ls="", ms=3.6, color=_colour(pair)) for pair in shown]
    axes.legend(
        handles,
        [_name(pair) for pair in shown],
        fontsize=6.5,
        frameon=False,
        loc="upper right",
        bbox_to_anchor=(1.0, -0.55 / axes.get_position().height / axes.figure.get_figheight()),
        borderaxespad=0,
        handletextpad=0.1,
        columnspacing=0.8,
        ncols=4,
    )


def _colour(between: tuple[str, str]) -> str:
    if set(between) == {"semianalytic", "fem_reference"}:
        return "#CC79A7"
    return COLOURS.get(between[0], "#009E73")


def _name(between: tuple[str, str]) -> str:
    return " – ".join("exact" if name in EXACT else SOURCES[name].label for name in between)
