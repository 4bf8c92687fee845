"""Comparisons as strips: |A − B| as a dot beside its U as a bar, the cap as a line, on one logarithmic axis.

A strip holds the comparisons of a case, or of a line of it. Each has a lane of its own, in the order of caps,
then of U: the bars of a strip make a tinted area, and a dot outside that area disagrees.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import groupby
from math import ceil, floor, isfinite, log10
from typing import Any

from markupsafe import Markup

from verification.judging.verdict import Claim, Outcome, Verdict
from verification.page.html_page import environment
from verification.page.source_labels import OUTCOMES
from verification.page.symbol_text import drawn
from verification.report.report_words import HTML

WIDTH, HEIGHT = 560.0, 22.0
INSET = 2.0  # of the lanes from the edges of a strip
LOWEST = 1e-12  # a smaller difference is drawn at the left edge
FEWEST = 4  # decades of the axis
# A dot where it agrees, a cross where it disagrees, an open square where it is inconclusive.
SHAPES, SQUARE = {Outcome.AGREES: "h0", Outcome.DISAGREES: "m-3-3l6 6m0-6l-6 6"}, "m-2.5-2.5h5v5h-5z"


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
    tops = [INSET + lane * n for n in range(len(lanes))]
    places = [
        None if item.difference is None else (axis.place(item.difference), top + lane / 2)
        for item, top in zip(lanes, tops, strict=True)
    ]
    numbered = list(zip(lanes, tops, places, strict=True))
    first = worst(lanes)
    runs = [list(run) for _, run in groupby(numbered, key=lambda one: one[0].claim.cap)]
    content = {
        "label": label,
        "anchor": anchor,
        "axis": axis,
        "lane": lane,
        "bars": [(axis.place(one.uncertainty) if one.uncertainty else 0.0, top) for one, top, _ in numbered],
        # (x, y, height) of each cap over the lanes that share it
        "caps": [
            (axis.place(cap), run[0][1], lane * len(run)) for run in runs if (cap := run[0][0].claim.cap) > 0
        ],
        "marks": [
            (OUTCOMES[kind].css, SHAPES.get(kind, SQUARE), of)
            for kind in reversed(OUTCOMES)
            if (of := [at for one, _, at in numbered if one.verdict.outcome is kind and at])
        ],
        "ring": places[lanes.index(first)] if first else None,
    }
    template = environment(HTML).get_template("strip.html")
    return Markup(template.render(content, width=WIDTH, height=HEIGHT, inset=INSET))


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
