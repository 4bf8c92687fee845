"""Fields of a case in a window or as a picture off screen; in a process of its own.

VTK without a working OpenGL may end its process beyond recovery, so that of the command line asks this one:

python -m verification.report.figures.viewer RUN_DIRECTORY NAME FIELD [PICTURE.png]
"""

import sys
from pathlib import Path
from typing import Any

import numpy as np

from verification.running.fields import Fields, read_fields

DEPTH = 1.6  # of the part of the finite element mesh shown, over the contact radius; wider by half a radius
MICRO = 1e6
SIZE = [1500, 760]
ROOM = 0.84  # of the picture, the rest left to axes and bar
BAR = {"vertical": False, "position_x": 0.2, "position_y": 0.015, "width": 0.6, "height": 0.1, "n_labels": 5}


def plotter(fields: Fields, name: str, *, off_screen: bool) -> Any:
    """A plotter with the finite elements beside the semi-analytical box, in one scale of colours.

    name : of a field, "von_mises [Pa]" for instance.   Raises ValueError where the files have no such field.
    """
    import pyvista as pv

    shown = []
    if fields.mesh is not None:
        shown.append(("finite elements, plane y = 0", _near(pv.read(fields.mesh))))
    if fields.boxes:
        # One looks from y > 0, where x runs to the right and z down, at the half behind y = 0.
        halves = [pv.read(path).clip(normal="y", origin=(0, 0, 0), invert=True) for path in fields.boxes]
        shown.append(("semi-analytical", pv.MultiBlock(halves)))
    if not shown:
        raise ValueError("no method has fields of this case")
    blocks = [block for _, found in shown for block in found]
    known = [n for n in blocks[0].point_data if not n.startswith("displacement")]
    if name not in known:
        raise ValueError(f"field = {name!r}; there are {', '.join(known)}")
    ends = np.array([(np.nanmin(b.point_data[name]), np.nanmax(b.point_data[name])) for b in blocks])
    limits = [float(ends[:, 0].min()), float(ends[:, 1].max())]
    if limits[0] < 0 < limits[1] or limits[1] <= 0:
        limits = [-max(np.abs(limits)), max(np.abs(limits))]
        colours = "RdBu_r"
    else:
        colours = "viridis"
    window: Any = pv.Plotter(off_screen=off_screen, shape=(1, len(shown)), window_size=SIZE)
    for number, (title, found) in enumerate(shown):
        window.subplot(0, number)
        for block in found:
            micro = block.scale(MICRO)
            window.add_mesh(
                micro,
                lighting=False,
                scalars=name,
                cmap=colours,
                clim=limits,
                # Bars with one title are one bar; the second picture would have none.
                scalar_bar_args=BAR | {"title": name + number * " "},
            )
            window.add_mesh(micro.outline(), color="black", line_width=1)
        window.add_text(title, font_size=11, color="black")
        window.show_bounds(
            xtitle="x [um]",
            ytitle="y [um]",
            ztitle="z [um]",
            n_ylabels=2,
            fmt="%.0f",
            font_size=9,
            location="outer",
            color="black",
        )
        window.set_background("white")
        # z runs into the solid: the surface is up.
        window.view_vector((-0.25, 1.0, -0.3), viewup=(0.0, 0.0, -1.0))
        window.camera.zoom(ROOM)
    return window


def _near(mesh: Any) -> Any:
    """The mesh below the contact, layer by layer; all of it reaches thousands of contact radii."""
    import pyvista as pv

    a = float(mesh.field_data["contact radius [m]"][0])
    depth = max(DEPTH * a, 1.3 * _deepest(mesh))
    half = DEPTH * a
    x, _, z = mesh.cell_centers().points.T
    layers = pv.MultiBlock()
    for layer in np.unique(mesh.cell_data["layer"]):
        # One at a time: filters merge points at one place and smear a jump.
        mine = (mesh.cell_data["layer"] == layer) & (np.abs(x) < 2 * half) & (z < 2 * depth)
        part = mesh.extract_cells(np.flatnonzero(mine))
        for normal, origin in (("x", half), ("-x", -half), ("z", depth)):
            at = (origin, 0.0, 0.0) if normal != "z" else (0.0, 0.0, origin)
            part = part.clip(normal=normal, origin=at) if part.n_cells else part
        if part.n_cells:
            layers.append(part)
    return layers


def _deepest(mesh: Any) -> float:
    """Depth of the deepest interface [m], 0 without one."""
    layer = mesh.cell_data["layer"]
    last = mesh.extract_cells(np.flatnonzero(layer == layer.max()))
    return float(last.bounds[4])


def main(folder: str, name: str, field: str, picture: str | None = None) -> None:
    """Open the window, or write ``picture``."""
    window = plotter(read_fields(Path(folder), name), field, off_screen=picture is not None)
    if picture is None:
        window.show(title=f"coatcheck view {name}")
    else:
        window.screenshot(picture)
        window.close()


if __name__ == "__main__":
    main(*sys.argv[1:])
