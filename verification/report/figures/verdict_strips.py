"""Comparisons as strips: |A − B| as a dot beside its U as a bar, the cap as a line, on one logarithmic axis.

A strip holds the comparisons of a case, or of a line of it. Each has a lane of its own, in the order of caps,
then of U: the bars of a strip make a tinted area, and a dot outside that area disagrees.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from math import ceil, floor, isfinite, log10
from typing import Any

from markupsafe import Markup, escape

from verification.judging.verdict import Claim, Outcome, Verdict
from verification.page.source_labels import OUTCOMES
from verification.page.symbol_text import drawn, unicode

WIDTH, HEIGHT = 560.0, 22.0
INSET = 2.0  # of the lanes from the edges of a strip
LOWEST = 1e-12  # a smaller difference is drawn at the left edge
FEWEST = 4  # decades of the axis


@dataclass(frozen=True)
class Item:
    """One comparison of a strip."""

    claim: Claim
    verdict: Verdict

    @property
    def difference(self) -> float | None:
        """|A − B| over its scale; None where there is no finite one."""
        found = self.verdict.difference
        return found if found is not None and isfinite(found) else None

    @property
    def uncertainty(self) -> float | None:
        """U over the same scale; None where none is stated."""
        found = self.verdict.uncertainty
        return found if found is not None and isfinite(found) and found >= 0 else None


def items_of(compared: Iterable[tuple[Claim, Verdict]]) -> list[Item]:
    """The comparisons of a case."""
    return [Item(claim, verdict) for claim, verdict in compared]


@dataclass(frozen=True)
class Axis:
    """A logarithmic axis from ``low`` to ``high``, exponents of ten, over the width of a strip."""

    low: int
    high: int

    def place(self, value: float) -> float:
        """Place of ``value`` in the strip, in units of the drawing."""
        exponent = log10(value) if value > 0 else self.low
        return WIDTH * min(max((exponent - self.low) / (self.high - self.low), 0.0), 1.0)


def axis_of(items: Sequence[Item]) -> Axis:
    """Whole decades that hold differences, uncertainties and caps of ``items``."""
    values = [v for item in items for v in (item.difference, item.uncertainty, item.claim.cap) if v]
    values = [v for v in values if LOWEST < v < 1e12]
    low, high = floor(log10(min(values, default=1e-9))), ceil(log10(max(values, default=1e-3)) + 1e-9)
    return Axis(min(low, high - FEWEST), high)


def ordered(items: Sequence[Item]) -> list[Item]:
    """In the order of their lanes, from the top."""
    return sorted(items, key=lambda item: (item.claim.cap, item.uncertainty or 0.0, item.difference or 0.0))


def worst(items: Sequence[Item]) -> Item | None:
    """The comparison a reader looks at first: the worst verdict, then the largest difference."""
    return min(
        items,
        key=lambda item: (
            OUTCOMES[item.verdict.outcome].rank,
            -(item.difference or 0.0) if item.verdict.outcome is not Outcome.NO_RESULT else 0.0,
        ),
        default=None,
    )


def case_strips(items: Sequence[Item], anchor: str) -> dict[str, Any] | None:
    """All comparisons of a case, a strip for each line."""
    if not items:
        return None
    axis = axis_of(items)
    rows = []
    for line in dict.fromkeys(item.claim.line for item in items):
        mine = [item for item in items if item.claim.line == line]
        bad = sum(item.verdict.outcome is not Outcome.AGREES for item in mine)
        rows.append((line, draw_strip(mine, axis, f"comparisons on {line}", anchor), bad, len(mine)))
    return {"rows": rows, "scale": draw_axis(axis)}


def draw_strip(items: Sequence[Item], axis: Axis, label: str, anchor: str = "") -> Markup:
    """One strip as inline SVG; ``items`` are drawn from the top in the order of ``ordered``.

    anchor : of the case whose comparisons they are, for the script that names the one under the pointer.
    """
    lanes = ordered(items)
    lane = (HEIGHT - 2 * INSET) / max(len(lanes), 1)
    middles = [INSET + lane * (n + 0.5) for n in range(len(lanes))]
    decades = "".join(f"M{axis.place(10.0**n):.1f} 0v{HEIGHT:g}" for n in range(axis.low, axis.high + 1))
    parts = [f'<path d="{decades}" class="s-grid" stroke-width=".8"/>', _bars(lanes, lane, axis)]
    parts.append(f'<path d="{_caps(lanes, lane, axis)}" class="s-cap" stroke-width="1.3"/>')
    for outcome in reversed(OUTCOMES):
        found = [
            (axis.place(item.difference), y)
            for item, y in zip(lanes, middles, strict=True)
            if item.verdict.outcome is outcome and item.difference is not None
        ]
        parts.append(_marks(outcome, found))
    first = worst(lanes)
    if first is not None and first.difference is not None:
        x, y = axis.place(first.difference), middles[lanes.index(first)]
        parts.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="4" class="ring s-ink" stroke-width="1.1"/>')
    of = f' data-of="{escape(anchor)}"' if anchor else ""
    return Markup(
        f'<svg class="strip" viewBox="-3 0 {WIDTH + 6:g} {HEIGHT:g}" role="img" '
        f'aria-label="{escape(unicode(label))}" data-low="{axis.low}" data-high="{axis.high}"{of}>'
        f"{''.join(parts)}</svg>"
    )


def draw_axis(axis: Axis) -> Markup:
    """The decades below the last strip."""
    step = max(1, ceil((axis.high - axis.low) / 10))
    shown = range(axis.high - (axis.high - axis.low) // step * step, axis.high + 1, step)
    texts = "".join(
        f'<text x="{axis.place(10.0**n):.1f}" y="12" text-anchor="middle" class="f-ink">'
        f"{drawn(f'1e{n}') if n else '1'}</text>"
        for n in shown
    )
    return Markup(
        f'<svg class="strip scale" viewBox="-14 0 {WIDTH + 28:g} 16" aria-hidden="true">{texts}</svg>'
    )


def _bars(lanes: Sequence[Item], lane: float, axis: Axis) -> str:
    """The area of all bars of U, from the left edge."""
    corners = []
    for n, item in enumerate(lanes):
        x = axis.place(item.uncertainty) if item.uncertainty else 0.0
        corners += [(x, INSET + lane * n), (x, INSET + lane * (n + 1))]
    if not corners:
        return ""
    outline = "L".join(f"{x:.1f} {y:.2f}" for x, y in corners)
    return f'<path d="M0 {INSET:g}L{outline}L0 {HEIGHT - INSET:g}z" class="bars"/>'


def _caps(lanes: Sequence[Item], lane: float, axis: Axis) -> str:
    caps = [item.claim.cap for item in lanes]
    starts = [n for n, cap in enumerate(caps) if n == 0 or cap != caps[n - 1]]
    ends = [*starts[1:], len(caps)]
    return "".join(
        f"M{axis.place(caps[start]):.1f} {INSET + lane * start:.1f}v{lane * (end - start):.2f}"
        for start, end in zip(starts, ends, strict=True)
        if caps[start] > 0
    )


def _marks(outcome: Outcome, places: Sequence[tuple[float, float]]) -> str:
    """A dot where it agrees, a cross where it disagrees, an open square where it is inconclusive."""
    distinct = dict.fromkeys((f"{x:.1f}", f"{y:.1f}") for x, y in places)
    if not distinct:
        return ""
    shape = {Outcome.AGREES: "h0", Outcome.DISAGREES: "m-3-3l6 6m0-6l-6 6"}.get(outcome, "m-2.5-2.5h5v5h-5z")
    path = "".join(f"M{x} {y}{shape}" for x, y in distinct)
    return f'<path d="{path}" class="mark {OUTCOMES[outcome].css}-mark"/>'
