"""Sketch of the layered solid under its sphere, to scale except the sphere."""

from math import isfinite, log, sqrt

from markupsafe import Markup

from verification.page.number_text import engineering, plain
from verification.page.symbol_text import drawn
from verification.problem.coated_contact import BALL
from verification.report.tables.case_lookup import contact_radius, layers, scale
from verification.running.case_result import CaseResult

WIDTH, HEIGHT = 400, 250
BLOCK = 216
SURFACE = 92
THINNEST = 4.0
SHALLOWEST, DEEPEST = 1.6, 4.0


def sketch(result: CaseResult) -> Markup:
    """The layers with depth and contact width on one scale; a layer too thin to see is drawn 4 units thick.

    The darker a layer, the stiffer. The sphere's radius is not to scale; its own layers are not drawn.
    """
    a_h = scale(result, "a_h")
    found = [(E, nu, thickness / a_h) for E, nu, thickness in layers(result)]
    total = sum(thickness for _, _, thickness in found[:-1])
    if not found or not isfinite(total) or not a_h > 0:
        return Markup("")
    depth = min(max(1.35 * total + 0.6, SHALLOWEST), DEEPEST)
    unit = (HEIGHT - 12 - SURFACE) / depth
    parts = [_sphere(unit, _ball(result))]
    labels = []
    top = float(SURFACE)
    stretched = False
    moduli = [E for E, _, _ in found]
    for number, (E, nu, thickness) in enumerate(found):
        below = number == len(found) - 1
        height = HEIGHT - top if below else max(thickness * unit, THINNEST)
        stretched = stretched or (not below and float(thickness * unit) < THINNEST)
        height = max(min(height, HEIGHT - top), 0.0)
        if height > 0:
            parts.append(_layer(top, height, _shade(E, moduli)))
        name = "substrate" if below else f"coating {number + 1}" if len(found) > 2 else "coating"
        what = f"E = {engineering(E, 'Pa', 3)}, nu = {plain(nu, 3)}"
        size = "" if below else f"h = {engineering(thickness * a_h, 'm', 3)} = {plain(thickness, 3)} a_h"
        labels.append((min(top + min(height / 2, 24.0), HEIGHT - 6.0), name, what, size))
        top += height
    parts += [_contact(result, a_h, unit), *_labels(labels)]
    note = "thin layers drawn thicker" if stretched else "depth and width to one scale"
    text = f"Sphere on {len(found) - 1} coating(s) on a substrate, {note}."
    inner = Markup("".join(parts))
    return Markup(
        '<svg class="figure sketch" viewBox="0 0 {} {}" role="img" aria-label="{}"><title>{}</title>{}</svg>'
    ).format(WIDTH, HEIGHT, text, text, inner)


def _shade(E: float, moduli: list[float]) -> float:
    low, high = log(min(moduli)), log(max(moduli))
    return 0.18 if high == low else 0.12 + 0.5 * (log(E) - low) / (high - low)


def _layer(top: float, height: float, shade: float) -> str:
    return (
        f'<rect x="0" y="{top:.1f}" width="{BLOCK}" height="{height:.1f}" class="layer" '
        f'fill-opacity="{shade:.2f}"/><path d="M0 {top:.1f}h{BLOCK}" class="s-ink" '
        f'stroke-width="{1.4 if top == SURFACE else 0.8}"/>'
    )


def _ball(result: CaseResult) -> tuple[str, str]:
    """What the sphere is, in two lines."""
    found = layers(result, BALL)
    if not found:
        return "rigid sphere, its", "radius not to scale"
    coats, (E, nu, _) = len(found) - 1, found[-1]
    coated = f", {coats} coating{'s' if coats > 1 else ''}" if coats else ""
    return f"elastic ball{coated},", f"E = {engineering(E, 'Pa', 3)}, nu = {plain(nu, 3)}"


def _sphere(unit: float, ball: tuple[str, str]) -> str:
    # A radius of a few contact radii keeps the arc readable at any real ratio a_h/R.
    radius = 3.2 * unit
    half = min(sqrt(max(radius**2 - (radius - SURFACE + 4) ** 2, 0.0)), BLOCK / 2)
    rise = radius - sqrt(radius**2 - half**2)
    middle, left, right = BLOCK / 2, BLOCK / 2 - half, BLOCK / 2 + half
    at = SURFACE - rise
    return (
        f'<path d="M{left:.1f} 4V{at:.1f}A{radius:.1f} {radius:.1f} 0 0 0 {right:.1f} {at:.1f}V4" '
        f'class="sphere"/><path d="M{middle:.1f} 10v36m-5-9l5 9 5-9" class="s-ink arrow"/>'
        f'<text x="{middle + 10:.1f}" y="30" class="f-ink it">W</text>'
        f'<text x="{BLOCK + 26}" y="22" class="f-muted small">{drawn(ball[0])}</text>'
        f'<text x="{BLOCK + 26}" y="35" class="f-muted small">{drawn(ball[1])}</text>'
    )


def _contact(result: CaseResult, a_h: float, unit: float) -> str:
    a = contact_radius(result)
    if a is None or not isfinite(a_h):
        return ""
    half, middle = min(a / a_h * unit, BLOCK / 2), BLOCK / 2
    return (
        f'<path d="M{middle - half:.1f} {SURFACE}h{2 * half:.1f}" class="s-cap" stroke-width="3.5"/>'
        f'<text x="{middle:.1f}" y="{SURFACE - 6}" class="f-ink small" text-anchor="middle">'
        '2<tspan class="it">a</tspan></text>'
    )


def _labels(labels: list[tuple[float, str, str, str]]) -> list[str]:
    """Labels to the right of the block, pushed apart where layers are thin, each with a leader."""
    step = 44.0
    written = []
    at = 0.0
    spare = HEIGHT - step * len(labels)
    for number, (depth, name, what, size) in enumerate(labels):
        latest = spare + step * number + 6
        at = max(min(depth - 12, latest), at, 42.0)
        lines = [
            f'<tspan x="{BLOCK + 26}" dy="{0 if i == 0 else 13}" class="{"strong" if i == 0 else ""}">'
            f"{drawn(line)}</tspan>"
            for i, line in enumerate((name, what, size))
            if line
        ]
        written.append(
            f'<path d="M{BLOCK} {depth:.1f}l22 {at + 8 - depth:.1f}" class="s-muted" stroke-width=".8"/>'
            f'<text x="{BLOCK + 26}" y="{at + 12:.1f}" class="f-ink small">{"".join(lines)}</text>'
        )
        at += step
    return written
