"""Figure of a measured indentation curve with its fit, the residuals below."""

from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure

from verification.desk.indented.film_modulus import KINDS, FilmFit
from verification.page.figures import save
from verification.study.pages.study_figures import COLOURS

UNITS = {"load": ("load [mN]", 1e-3), "depth": ("depth [nm]", 1e-9), "stiffness": ("stiffness [N/m]", 1.0)}
UNITS["radius"] = ("contact radius [nm]", 1e-9)


def write(fit: FilmFit, title: str, path: Path) -> None:
    """Write the figure as PNG, PDF or SVG, by the suffix of ``path``. Raises StoreError."""
    (y_name, y_unit), (x_name, x_unit) = (UNITS[one] for one in KINDS[fit.kind])
    with mpl.rc_context({"font.size": 9, "axes.grid": True, "grid.alpha": 0.3}):
        figure = Figure(figsize=(6.4, 5.2), layout="constrained")
        upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=(3, 1))
        order = np.argsort(fit.x, kind="stable")
        x, y, fitted = (values[order] for values in (fit.x / x_unit, fit.y / y_unit, fit.fitted / y_unit))
        low, high = (one[order] / y_unit for one in fit.band)
        upper.plot(x, y, "o", color="#555555", markersize=3, label="measured")
        upper.plot(x, fitted, color=COLOURS[0], label="fit")
        upper.fill_between(x, low, high, color=COLOURS[0], alpha=0.3, linewidth=0, label="95 % interval of E")
        lower.plot(x, y - fitted, "o", color="#555555", markersize=3)
        lower.fill_between(x, low - fitted, high - fitted, color=COLOURS[0], alpha=0.3, linewidth=0)
        lower.axhline(0.0, color=COLOURS[0])
        upper.set_ylabel(y_name)
        lower.set(xlabel=x_name, ylabel="measured − fit")
        upper.legend(frameon=False)
        figure.suptitle(title, fontsize=9, wrap=True)
        save(figure, path)
