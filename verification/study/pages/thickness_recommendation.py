"""The answer of a study in words: which thicknesses are good, which failure modes limit them.

No number has more digits than its uncertainty supports; limits are rounded to the safe side.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from verification.cases.unit_numbers import Units
from verification.page.source_labels import source_label
from verification.study.choice.failure_criteria import MODES, Judged
from verification.study.choice.thickness_choice import Choice, End, Range

__all__ = ["Near", "answers", "between", "checked_messages", "near", "rounded"]

DIGITS = 2  # of a thickness, at most


@dataclass(frozen=True)
class Near:
    """How far ``source`` is from the semi-analytical curve in ``mode`` at a checked thickness.

    h : over a_h.   difference : |difference| over p_h.
    """

    source: str
    mode: str
    h: float
    difference: float


def near(judgement: Judged, h: float, mode: str) -> tuple[Near, ...]:
    """The cross-checks of ``mode`` nearest to ``h`` over a_h, one for each source that has any."""
    curve = judgement.curve
    found = []
    for source, marks in curve.marks.items():
        at, value = marks[mode]
        known = np.isin(at, curve.h) & np.isfinite(value)
        if not known.any():
            continue
        i = int(np.flatnonzero(known)[np.abs(np.log(at[known] / h)).argmin()])
        here = float(curve.stress[mode][np.flatnonzero(curve.h == at[i])[0]])
        found.append(Near(source, mode, float(at[i]), abs(float(value[i]) - here)))
    return tuple(found)


def rounded(value: float, uncertainty: float, upwards: bool | None = None) -> str:
    """A positive ``value`` in at most ``DIGITS`` digits, the last no finer than its ``uncertainty``.

    upwards : whether it is rounded up or down; to the nearest for None.
    """
    last = math.floor(math.log10(value)) - DIGITS + 1
    if uncertainty > 0 and math.isfinite(uncertainty):
        last = max(last, math.ceil(math.log10(uncertainty)))
    last = min(last, math.floor(math.log10(value)))
    step = 10.0**last
    # 1e-9: a value that is round already stays
    shift = 0.0 if upwards is None else (-1e-9 if upwards else 1e-9)
    steps = value / step + shift
    count = round(steps) if upwards is None else math.ceil(steps) if upwards else math.floor(steps)
    return f"{(count or 1) * step:.{max(-last, 0)}f}"


def answers(choices: Sequence[Choice], units: Units) -> list[str]:
    """The answer for each modulus in a line."""
    return [_answer(one, units, several=len(choices) > 1) for one in choices]


def _answer(found: Choice, units: Units, *, several: bool) -> str:
    frictions = [j.curve.friction for j in found.judgements]
    at = f"f = {frictions[0]:g}" + (f" to {frictions[-1]:g}" if len(frictions) > 1 else "")
    name = f"E1/E2 = {found.judgements[0].curve.ratio:.3g}: " if several else ""
    if not found.judgements[0].limited:
        return f"{name}{_even(found, units)} at {at}{_limits(found, found.even)}."
    if not found.ranges:
        judgement, mode = found.governing(found.best)
        use = rounded(found.least, found.error)
        return (
            f"{name}no thickness of the sweep keeps every stress below its strength at {at}; even the best, "
            f"{_length(found, found.best, units)}, uses {use} of it: {MODES[mode]} "
            f"(f = {judgement.curve.friction:g})."
        )
    parts = []
    for pair in found.ranges:
        parts.append(
            f"{between(found, pair, units, safe=True)} keeps every stress below its strength at {at}"
            f"{_limits(found, pair)}"
        )
    use = rounded(found.least, found.error)
    return f"{name}{'. '.join(parts)}. {_even(found, units)}, at {use} of the strength."


def _even(found: Choice, units: Units) -> str:
    percent = math.ceil(100 * found.tolerance - 1e-9)
    verb = f"are within {percent} % of each other"
    return f"{between(found, found.even, units)} {verb}"


def between(found: Choice, pair: Range, units: Units, *, safe: bool = False) -> str:
    """ "2 to 10 µm"; inwards where ``safe``, with the ends of the sweep named."""
    low, high = pair
    scale = found.judgements[0].curve.a_h / units.metre
    ends = []
    for end, edge, upwards in ((low, found.h[0], True), (high, found.h[-1], False)):
        value, U = (float(edge), 0.0) if end is None else (end.h, end.uncertainty)
        ends.append(rounded(value * scale, U * scale, upwards if safe and end else None))
    swept = [word for word, end in (("thinnest", low), ("thickest", high)) if end is None]
    beyond = f" (the {' and the '.join(swept)} of the sweep)" if swept else ""
    if ends[0] == ends[1] or float(ends[0]) > float(ends[1]):
        return f"about {_length(found, found.best, units)}{beyond}"
    return f"{ends[0]} to {ends[1]} {units.length}{beyond}"


def _length(found: Choice, h: float, units: Units) -> str:
    return f"{rounded(h * found.judgements[0].curve.a_h / units.metre, 0.0)} {units.length}"


def _limits(found: Choice, pair: Range) -> str:
    """What sets each limit, with its share of the samples in which the coating fails there."""
    said = []
    words = (
        ("the limit below is set where", "above where") if pair[0] else ("", "the limit above is set where")
    )
    for word, end in zip(words, pair, strict=True):
        if end is not None:
            said.append(f"{word} {MODES[end.mode]} ({_share(found, end)}f = {end.friction:g})")
    return f"; {', '.join(said)}" if said else ""


def _share(found: Choice, end: End) -> str:
    if not found.criteria.scatters:
        return ""
    chances = found.chances(np.array([end.h]))
    if not chances.fails[0]:
        return ""
    share = chances.breaks[found.judgements[0].modes.index(end.mode), 0] / chances.fails[0]
    return f"{100 * share:.0f} % of the failures there, "


def checked_messages(choices: Sequence[Choice], units: Units) -> list[str]:
    """For each modulus the cross-checks nearest to what is recommended, every source with its worst."""
    return [message for one in choices if (message := _checked(one, units))]


def _checked(choice: Choice, units: Units) -> str:
    pairs = [*choice.ranges, choice.even]
    places = [(end.h, end.mode, end.friction) for pair in pairs for end in pair if end is not None]
    judgement, mode = choice.governing(choice.best)
    places.append((choice.best, mode, judgement.curve.friction))
    by_friction = {j.curve.friction: j for j in choice.judgements}
    found = [(by_friction[f], one) for h, mode, f in places for one in near(by_friction[f], h, mode)]
    if not found:
        return ""
    parts = []
    for source in dict.fromkeys(one.source for _, one in found):
        j, one = max(
            ((j, one) for j, one in found if one.source == source), key=lambda item: item[1].difference
        )
        stress = one.difference * j.curve.p_h / units.pascal
        parts.append(
            f"at most {stress:.1g} {units.stress} off the {source_label(source)} ({one.mode}, "
            f"{_length(choice, one.h, units)}, f = {j.curve.friction:g})"
        )
    return (
        f"E1/E2 = {judgement.curve.ratio:.3g}: at the checked thicknesses nearest to these the governing "
        f"stresses are {' and '.join(parts)}."
    )
