"""Sketch of the layered solid under its sphere, to scale except the sphere."""

from collections.abc import Mapping
from math import isfinite, log, sqrt
from typing import Any

from markupsafe import Markup

from verification.page.html_page import rendered
from verification.page.number_text import engineering, plain
from verification.problem.point_answers import BALL
from verification.report.report_words import HTML
from verification.report.tables.case_lookup import INDENTERS, layers, scale

HEIGHT, BLOCK, SURFACE = 250.0, 216.0, 92.0  # of the drawing; width of the solid, its top; drawing units
THINNEST, STEP = 4.0, 44.0  # a layer at least, a label
SHALLOWEST, DEEPEST = 1.6, 4.0  # over a_h


def sketch(problem: Mapping[str, Any], a: float | None) -> Markup:
    """The layers with depth and contact width on one scale; a layer too thin to see is drawn 4 units thick.

    The darker a layer, the stiffer. The sphere's radius is not to scale; its own layers are not drawn.
    a : contact radius [m].
    """
    a_h = float(scale(problem, "a_h"))
    found = [(E, nu, thickness / a_h) for E, nu, thickness in layers(problem)]
    total = sum(thickness for _, _, thickness in found[:-1])
    if not found or not isfinite(total) or not 0 < a_h < float("inf"):
        return Markup("")
    unit = (HEIGHT - 12 - SURFACE) / min(max(1.35 * total + 0.6, SHALLOWEST), DEEPEST)
    moduli = [log(E) for E, _, _ in found]
    extent = max(moduli) - min(moduli)
    bars, labels, top, at = [], [], SURFACE, 0.0
    for n, (E, nu, thickness) in enumerate(found):
        below = n == len(found) - 1
        height = max(min(HEIGHT - top if below else max(thickness * unit, THINNEST), HEIGHT - top), 0.0)
        if height > 0:
            bars.append((top, height, 0.12 + 0.5 * (log(E) - min(moduli)) / extent if extent else 0.18))
        name = "substrate" if below else f"coating {n + 1}" if len(found) > 2 else "coating"
        size = "" if below else f"h = {engineering(thickness * a_h, 'm', 3)} = {plain(thickness, 3)} a_h"
        depth = min(top + min(height / 2, 24.0), HEIGHT - 6.0)
        # Labels to the right of the block are pushed apart where layers are thin.
        at = max(min(depth - 12, HEIGHT - STEP * (len(found) - n) + 6), at, 42.0)
        lines = (name, f"E = {engineering(E, 'Pa', 3)}, nu = {plain(nu, 3)}", size)
        labels.append((depth, at, [line for line in lines if line]))
        top, at = top + height, at + STEP
    stretched = any(float(thickness * unit) < THINNEST for _, _, thickness in found[:-1])
    # A radius of a few contact radii keeps the arc readable at any real ratio a_h/R.
    radius = 3.2 * unit
    half = min(sqrt(max(radius**2 - (radius - SURFACE + 4) ** 2, 0.0)), BLOCK / 2)
    note = "thin layers drawn thicker" if stretched else "depth and width to one scale"
    content = {
        "label": f"Sphere on {len(found) - 1} coating(s) on a substrate, {note}.",
        "tall": max(HEIGHT, at),  # room for the label of each of many layers
        "surface": SURFACE,
        "middle": BLOCK / 2,
        "radius": radius,
        "half": half,
        "rise": radius - sqrt(radius**2 - half**2),
        "contact": None if a is None else min(a / a_h * unit, BLOCK / 2),
        "ball": _ball(problem),
        "bars": bars,
        "labels": labels,
    }
    return Markup(rendered("sketch.html", HTML, **content))


def _ball(problem: Mapping[str, Any]) -> tuple[str, str]:
    """The sphere or other indenter in two lines."""
    found = layers(problem, BALL)
    if indenter := problem.get("indenter"):
        return f"rigid {INDENTERS[indenter[0]]}, its", "radius not to scale"
    if not found:
        return "rigid sphere, its", "radius not to scale"
    coats, (E, nu, _) = len(found) - 1, found[-1]
    coated = f", {coats} coating{'s' if coats > 1 else ''}" if coats else ""
    return f"elastic ball{coated},", f"E = {engineering(E, 'Pa', 3)}, nu = {plain(nu, 3)}"
