"""The cut-away of sphere, coatings and substrate, rendered without a display.

A process of its own renders, since VTK without a working OpenGL may crash beyond recovery:

python -m verification.report.figures.scene FOLDER < scenes.json

``scenes.json`` is a list of Scene as dictionaries; FOLDER/0.png, 1.png ... are written in their order.
"""

import base64
import json
import os
import sys
import threading
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["Scene", "render"]

SPHERE = 2.6  # drawn radius of the sphere over the contact radius; the real one would look flat
ABOVE = 0.75  # how far above the surface the sphere is cut off
BLOCK = 1.9  # half width of the solid drawn
SIZE = [640, 500]
STIFF, SOFT = np.array([0.30, 0.42, 0.55]), np.array([0.86, 0.89, 0.92])


@dataclass(frozen=True)
class Scene:
    """What is drawn, lengths over the contact radius.

    bottoms : depth of the lower side of each layer, the substrate's where the drawing ends.
    stiffness : of each layer from 0 (softest) to 1.   half : the field reaches from -half to half.
    pixels : the field on the cut as base64 of RGB bytes, ``rows`` of them from the surface down.
    """

    bottoms: list[float]
    stiffness: list[float]
    half: float
    rows: int
    pixels: str

    @property
    def image(self) -> NDArray[np.uint8]:
        """The field on the cut, (rows, columns, 3)."""
        return np.frombuffer(base64.b64decode(self.pixels), dtype=np.uint8).reshape(self.rows, -1, 3)


def half_sphere() -> list[tuple[Any, dict[str, Any]]]:
    """The half y > 0 of the sphere between the surface and ``ABOVE``, with its edges: (mesh, look)."""
    import pyvista as pv

    # A solid of revolution: its profile from the axis along the contact, up the sphere, back to the axis.
    height = float(np.sqrt(SPHERE**2 - 1))
    z = np.linspace(0.0, ABOVE, 12)
    r = np.sqrt(SPHERE**2 - (height - z) ** 2)
    angle = np.linspace(0.0, np.pi, 49)
    side = pv.StructuredGrid(r[:, None] * np.cos(angle), r[:, None] * np.sin(angle), z[:, None] + 0 * angle)
    share = np.array([[0.0], [1.0]])
    lid = pv.StructuredGrid(
        share * r[-1] * np.cos(angle), share * r[-1] * np.sin(angle), 0 * share * angle + ABOVE
    )
    cut = pv.StructuredGrid(np.stack([-r, r]), np.zeros((2, z.size)), np.stack([z, z]))
    rims = [
        pv.MultipleLines(np.stack([r[-1] * np.cos(angle), r[-1] * np.sin(angle), 0 * angle + ABOVE], axis=1)),
        *(pv.MultipleLines(np.stack([sign * r, 0 * r - 0.004, z], axis=1)) for sign in (-1, 1)),
        pv.Line((-r[-1], -0.004, ABOVE), (r[-1], -0.004, ABOVE)),
    ]
    metal = {"color": "#c9ced6", "ambient": 0.45, "diffuse": 0.6}
    looks = [(side, metal | {"smooth_shading": True}), (lid, metal), (cut, metal | {"color": "#aab1bb"})]
    return looks + [(rim, {"color": "#1b232d", "line_width": 2}) for rim in rims]


def render(scene: Scene, sphere: list[tuple[Any, dict[str, Any]]], path: Path) -> None:
    """Write one picture with a transparent ground."""
    import pyvista as pv

    plotter: Any = pv.Plotter(off_screen=True, window_size=SIZE)
    top = 0.0
    for bottom, stiffness in zip(scene.bottoms, scene.stiffness, strict=True):
        box = pv.Box(bounds=(-BLOCK, BLOCK, 0.0, BLOCK, -bottom, -top))
        colour = SOFT + stiffness * (STIFF - SOFT)
        plotter.add_mesh(box, color=colour, ambient=0.35, diffuse=0.7)
        plotter.add_mesh(box.extract_feature_edges(), color="#1b232d", line_width=2)
        top = bottom
    face = pv.Plane(
        center=(0.0, -0.004, -top / 2), direction=(0.0, -1.0, 0.0), i_size=top, j_size=2 * scene.half
    )
    # Corners by hand: the orientation of a plane's own texture coordinates is nobody's promise.
    x, z = face.points[:, 0], face.points[:, 2]
    face.active_texture_coordinates = np.stack([(x + scene.half) / (2 * scene.half), 1 + z / top], axis=1)
    texture = pv.Texture(np.ascontiguousarray(scene.image))
    texture.InterpolateOn()
    plotter.add_mesh(face, texture=texture, lighting=False)
    for bottom in scene.bottoms[:-1]:
        line = pv.Line((-scene.half, -0.008, -bottom), (scene.half, -0.008, -bottom))
        plotter.add_mesh(line, color="white", line_width=2)

    for mesh, look in sphere:
        plotter.add_mesh(mesh, **look)
    contact = pv.Line((-1.0, -0.012, 0.004), (1.0, -0.012, 0.004))
    plotter.add_mesh(contact, color="#d62728", line_width=7)

    plotter.view_vector((0.33, -0.88, 0.34), viewup=(0.0, 0.0, 1.0))
    plotter.camera.zoom(1.2)
    plotter.screenshot(str(path), transparent_background=True)
    plotter.close()


def main(folder: str) -> None:
    """Render every scene on standard input into ``folder``; end where the process that asked for it does."""
    threading.Thread(target=_end_with, args=(os.getppid(),), daemon=True).start()
    sphere = half_sphere()
    for number, scene in enumerate(json.load(sys.stdin)):
        render(Scene(**scene), sphere, Path(folder) / f"{number}.png")


def _end_with(parent: int) -> None:
    while os.getppid() == parent:
        time.sleep(0.5)
    os._exit(1)


if __name__ == "__main__":
    main(*sys.argv[1:])
