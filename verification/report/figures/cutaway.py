"""Cut-aways of sphere, coatings and substrate, rendered in a process of its own or else drawn flat."""

import base64
import io
import json
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
from markupsafe import Markup
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Rectangle
from PIL import Image

from verification.problem.quantity import von_mises
from verification.report.figures.raster import Frame, Scale, coloured, rasterised
from verification.report.figures.scene import ABOVE, BLOCK, SOFT, SPHERE, STIFF, Scene
from verification.report.tables.lookup import layers
from verification.report.tables.lookup import scale as scale_of
from verification.running.result import CaseResult
from verification.sampling.plane import Plane
from verification.sources.registry import METHODS

__all__ = ["COMMAND", "Cutaway", "cutaways"]

COMMAND = (sys.executable, "-m", "verification.report.figures.scene")
TIME_LIMIT = 60.0  # s, for all pictures of a report
WIDEST = 620  # pixels
# The finite element model is drawn where there is one: its stresses reach wherever its mesh does.
PREFERRED = METHODS[::-1]


@dataclass(frozen=True)
class Cutaway:
    """A picture as an <img> that carries itself, with its caption."""

    image: Markup
    caption: str


def cutaways(
    results: Sequence[CaseResult],
    planes: Mapping[str, Plane],
    *,
    command: Sequence[str] = COMMAND,
    time_limit: float = TIME_LIMIT,
) -> dict[str, Cutaway]:
    """A cut-away with the von Mises stress on the cut for every case with a plane, by name of the case.

    command : what renders scenes, see ``scene``.   time_limit : [s], beyond which it is ended.
    Whatever becomes of the rendering, each gets its picture: one that is missing is drawn flat, and says so.
    """
    scenes = {
        result.name: scene
        for result in results
        if result.name in planes and (scene := _scene(result, planes[result.name])) is not None
    }
    if not scenes:
        return {}
    pictures, why = _rendered(list(scenes.values()), command, time_limit)
    found = {}
    for (name, scene), picture in zip(scenes.items(), pictures, strict=True):
        text = (
            "Cut-away along y = 0: von Mises stress on the cut where it was sampled, from dark (least) to "
            "bright (most); a stiffer layer is darker, the contact red, the sphere's curvature not to scale."
        )
        if picture is None:
            picture = _flat(scene)
            text = f"{text} Drawn flat with matplotlib, for VTK could not render: {why}."
        found[name] = Cutaway(_element(picture), text)
    return found


def _scene(result: CaseResult, plane: Plane) -> Scene | None:
    solid = layers(result)
    source = next((s for s in PREFERRED if s in plane.stress), None)
    p_h = float(scale_of(result, "p_h"))
    if source is None or not solid or not plane.radius > 0 or not p_h > 0:
        return None
    lengths = [z / plane.radius for z in plane.depths]
    bottoms = [float(z[-1]) for z in lengths]
    frame = Frame(float(plane.x[-1]) / plane.radius, bottoms[-1], tuple(bottoms[:-1]), 1.0)
    values = [von_mises(sigma) / p_h for sigma in plane.stress[source]]
    raster = rasterised(plane.x / plane.radius, lengths, values, frame)
    largest = float(np.nanmax(raster, initial=0.0)) or 1.0
    moduli = np.log([E for E, _, _ in solid])
    span = float(np.ptp(moduli)) or 1.0
    return Scene(
        bottoms,
        ((moduli - moduli.min()) / span).tolist()[: len(bottoms)],
        frame.half,
        len(raster),
        base64.b64encode(coloured(raster, Scale(0.0, largest, "viridis")).tobytes()).decode(),
    )


def _rendered(
    scenes: Sequence[Scene], command: Sequence[str], time_limit: float
) -> tuple[list[Image.Image | None], str]:
    """The pictures there are, and in a few words why one is missing."""
    question = json.dumps([asdict(scene) for scene in scenes]).encode()
    with tempfile.TemporaryDirectory() as folder:
        try:
            done = subprocess.run(
                [*command, folder], input=question, capture_output=True, timeout=time_limit, check=False
            )
            why = f"its process ended with {_death(done.returncode)}"
        except subprocess.TimeoutExpired:
            why = f"not finished after {time_limit:g} s"
        except OSError as error:
            why = f"its process could not be started ({error.strerror or error})"
        return [_read(Path(folder) / f"{number}.png") for number in range(len(scenes))], why


def _death(code: int) -> str:
    return f"signal {-code}" if code < 0 else f"code {code}"


def _read(path: Path) -> Image.Image | None:
    try:
        with Image.open(path) as image:
            image.load()
            box = image.convert("RGBA").getbbox()
            return image.convert("RGBA").crop(box) if box else None
    except (OSError, SyntaxError, ValueError):  # what a killed process left half written
        return None


def _flat(scene: Scene) -> Image.Image:
    """The cut alone, to the same scales."""
    depth = scene.bottoms[-1]
    figure = Figure(figsize=(6.0, 6.0 * (depth + ABOVE) / (2 * BLOCK)), dpi=WIDEST / 6.0)
    canvas = FigureCanvasAgg(figure)
    figure.patch.set_alpha(0.0)
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.set_axis_off()
    height = float(np.sqrt(SPHERE**2 - 1))
    axes.add_patch(Circle((0.0, height), SPHERE, facecolor="#aab1bb", edgecolor="#1b232d"))
    top = 0.0
    for bottom, stiffness in zip(scene.bottoms, scene.stiffness, strict=True):
        colour = tuple(SOFT + stiffness * (STIFF - SOFT))
        axes.add_patch(
            Rectangle((-BLOCK, -bottom), 2 * BLOCK, bottom - top, facecolor=colour, edgecolor="#1b232d")
        )
        top = bottom
    axes.imshow(scene.image, extent=(-scene.half, scene.half, -depth, 0.0), zorder=2)
    for bottom in scene.bottoms[:-1]:
        axes.plot([-scene.half, scene.half], [-bottom, -bottom], color="white", linewidth=1.2, zorder=3)
    axes.plot([-1, 1], [0, 0], color="#d62728", linewidth=4, zorder=4)
    axes.set_xlim(-BLOCK, BLOCK)
    axes.set_ylim(-depth, ABOVE)
    canvas.draw()
    return Image.fromarray(np.asarray(canvas.buffer_rgba()).copy())


def _element(picture: Image.Image) -> Markup:
    picture.thumbnail((WIDEST, WIDEST))
    written = io.BytesIO()
    picture.save(written, "WEBP", quality=80, method=4)
    return Markup(
        '<img class="cutaway" alt="{}" width="{}" height="{}" src="data:image/webp;base64,{}">'
    ).format(
        "cut-away of sphere, coatings and substrate, von Mises stress on the cut",
        picture.width,
        picture.height,
        base64.b64encode(written.getvalue()).decode(),
    )
