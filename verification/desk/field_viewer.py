"""Fields of a case in a window or as a picture off screen; in a process of its own.

VTK without a working OpenGL may end its process beyond recovery, so that of the command line asks this one:

python -m verification.desk.field_viewer RUN_DIRECTORY NAME FIELD [PICTURE.png]
"""

import sys
from pathlib import Path
from typing import Any

import numpy as np

from verification.running.stored_fields import Fields, read_fields

DEPTH = 1.6  # of the part of the finite element mesh shown, over the contact radius; wider by half a radius
MICRO, MEGA = 1e6, 1e6
FILM, MOST = 0.15, 10.0  # of the depth in view: the thinnest layer; the largest factor
SIZE = [1500, 760]
ROOM = 0.84  # of the picture, the rest left to axes and bar
BAR = {
    "vertical": False,
    "position_x": 0.2,
    "position_y": 0.015,
    "width": 0.6,
    "height": 0.1,
    "n_labels": 5,
    "fmt": "%.0f",
}


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
    depth = max(float(block.bounds[5]) for block in blocks)
    stretch = _stretch([found for _, found in shown], depth)
    label = name.replace("[Pa]", "[MPa]")
    # Both methods are shown to the same depth and width, in one scale, by one camera.
    extent = min(max(float(block.bounds[1]) for block in found) for _, found in shown)
    shown = [(title, _cut(found, extent, depth / stretch)) for title, found in shown]
    values = [np.asarray(b.point_data[name]) / MEGA for _, found in shown for b in found]
    limits = [float(min(np.nanmin(v) for v in values)), float(max(np.nanmax(v) for v in values))]
    if limits[0] < 0 < limits[1] or limits[1] <= 0:
        limits = [-max(np.abs(limits)), max(np.abs(limits))]
        colours = "RdBu_r"
    else:
        colours = "viridis"
    width, deep = MICRO * extent, MICRO * depth / stretch
    window: Any = pv.Plotter(off_screen=off_screen, shape=(1, len(shown)), window_size=SIZE)
    for number, (title, found) in enumerate(shown):
        window.subplot(0, number)
        for block in found:
            micro = block.scale([MICRO, MICRO, stretch * MICRO])
            micro.point_data[label] = np.asarray(micro.point_data[name]) / MEGA
            window.add_mesh(
                micro,
                lighting=False,
                scalars=label,
                cmap=colours,
                clim=limits,
                # Bars with one title are one bar; the second picture would have none.
                scalar_bar_args=BAR | {"title": label + number * " "},
            )
            window.add_mesh(micro.outline(), color="black", line_width=1)
        window.add_text(title, font_size=11, color="black")
        window.show_bounds(
            bounds=(-width, width, -width, 0.0, 0.0, stretch * deep),
            axes_ranges=[-width, width, -width, 0.0, 0.0, deep],
            xtitle="x [um]",
            ytitle="y [um]",
            ztitle="z [um]" + (f", stretched {stretch:.1f} times" if stretch > 1 else ""),
            n_ylabels=2,
            fmt="%.0f" if deep > 20 else "%.1f",
            font_size=9,
            location="outer",
            color="black",
        )
        window.set_background("white")
        # z runs into the solid: the surface is up.
        window.view_vector((-0.25, 1.0, -0.3), viewup=(0.0, 0.0, -1.0))
        window.camera.zoom(ROOM)
    window.link_views()
    return window


def _stretch(shown: list[Any], depth: float) -> float:
    """Factor of the depth axis with which the thinnest layer fills ``FILM`` of the depth left in view."""
    blocks = [block for found in shown for block in found]
    layers = [float(b.bounds[5] - b.bounds[4]) for b in blocks if b.bounds[5] < depth * (1 - 1e-6)]
    return float(np.clip(FILM * depth / min(layers), 1.0, MOST)) if layers else 1.0


def _cut(found: Any, half: float, depth: float) -> Any:
    """The blocks within |x|, |y| <= ``half``, z <= ``depth``."""
    import pyvista as pv

    kept = pv.MultiBlock()
    for block in found:
        part = block
        for normal, origin in (("x", half), ("-x", -half), ("-y", -half), ("z", depth)):
            place = {"x": (origin, 0.0, 0.0), "y": (0.0, origin, 0.0), "z": (0.0, 0.0, origin)}[normal[-1]]
            part = part.clip(normal=normal, origin=place) if part.n_cells else part
        if part.n_cells:
            kept.append(part)
    return kept


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
