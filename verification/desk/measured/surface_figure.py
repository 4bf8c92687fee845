"""Picture of a measured surface in contact: its heights as they are pressed, and the pressure."""

from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure

from verification.desk.measured.surface_contact import SurfaceContact
from verification.desk.measured.surface_map import SurfaceMap
from verification.page.figures import save
from verification.problem.display_units import Units


def write(surface: SurfaceMap, found: SurfaceContact, title: str, units: Units, path: Path) -> None:
    """Write the picture as PNG, PDF or SVG, by the suffix of ``path``. Raises StoreError."""
    with mpl.rc_context({"font.size": 9}):
        figure = Figure(figsize=(9.0, 4.2), layout="constrained")
        left, right = figure.subplots(1, 2)
        x, y, nodes = (one / units.metre for one in (surface.x, surface.y, found.solution.nodes))
        heights = left.pcolormesh(x, y, surface.heights.T / units.metre, cmap="cividis", rasterized=True)
        figure.colorbar(heights, ax=left, label=f"height out of the body [{units.length}]")
        left.set_title("measured surface, levelled\nits highest points touch first", fontsize=9)
        p = found.solution.patch_pressure / units.pascal
        shown = right.pcolormesh(nodes, nodes, np.where(p > 0, p, np.nan).T, cmap="viridis", rasterized=True)
        figure.colorbar(shown, ax=right, label=f"pressure [{units.stress}]")
        right.set_title("pressure; white: no contact", fontsize=9)
        for axes in (left, right):
            axes.set(xlabel=f"x [{units.length}]", ylabel=f"y [{units.length}]", aspect="equal")
        figure.suptitle(title, fontsize=9, wrap=True)
        save(figure, path)
