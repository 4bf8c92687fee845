"""Recommended thickness of a study, the failure modes that bound it, the cross-checks near it.

One coating at several frictions is recommended where it is admissible at all of them. Each end of that range
is where some stress of some friction meets its strength: the failure mode beyond.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from verification.report.tables.labels import source_label
from verification.study.criteria import MODES, Judged


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


def recommendation_messages(judgements: Sequence[Judged]) -> list[str]:
    """For each modulus what is recommended, which failure bounds it, the cross-checks nearest to it.

    Without strengths, or with none of them judged, a single message: where the preferable thicknesses lie.
    """
    limited = [j for j in judgements if j.limited]
    if not limited:
        return _preferable_range(judgements)
    found = []
    for ratio in sorted({j.curve.ratio for j in limited}):
        members = sorted((j for j in limited if j.curve.ratio == ratio), key=lambda j: j.curve.friction)
        found += _of_modulus(members)
    return found


def _preferable_range(judgements: Sequence[Judged]) -> list[str]:
    if not judgements:
        return []
    thin = min(judgements, key=lambda j: j.preferable[0])
    thick = max(judgements, key=lambda j: j.preferable[0])
    ends = [
        f"h = {j.preferable[0]:.3g} a_h ({j.curve.label}; {j.preferable[2]} governs)" for j in (thin, thick)
    ]
    return [
        f"Over the {len(judgements)} curves the preferable thickness lies between {ends[0]} and {ends[1]}."
    ]


def _of_modulus(members: Sequence[Judged]) -> list[str]:
    curve = members[0].curve
    frictions = [j.curve.friction for j in members]
    every = f"f = {frictions[0]:g}" + (f" to {frictions[-1]:g}" if len(members) > 1 else "")
    name = f"E1/E2 = {curve.ratio:.3g}"
    ranges = members[0].admissible
    for j in members[1:]:
        ranges = _overlap(ranges, j.admissible)
    if not ranges:
        j = min(members, key=lambda j: -j.preferable[1])
        h, use, mode = j.preferable
        return [
            f"{name}: no thickness of the sweep is admissible at every friction ({every}); with "
            f"f = {j.curve.friction:g} even the preferable h = {_micrometres(j, h)} uses {use:.2f} of the "
            f"strength in {mode}: {MODES[mode]}. {_checked([(j, h, mode)])}"
        ]
    found = []
    for low, high in ranges:
        ends = [_bound(members, low, thinner=True), _bound(members, high, thinner=False)]
        at = members[0].h
        inside = np.flatnonzero((at >= low) & (at <= high))
        used = np.array([np.interp(at[inside], j.h, j.largest) for j in members])
        best = int(used.max(axis=0).argmin())
        worst = members[int(used[:, best].argmax())]
        h = float(at[inside[best]])
        mode = worst.modes[worst.governing[int(np.abs(worst.h - h).argmin())]]
        beyond = "; ".join(
            f"{side}, {_beyond(end)}" for side, end in zip(("thinner", "thicker"), ends, strict=True)
        )
        places = [(*end[:1], place, end[1]) for place, end in zip((low, high), ends, strict=True) if end]
        found.append(
            f"{name}: h = {low * curve.a_h * 1e6:.3g} to {_micrometres(worst, high)} is admissible at every "
            f"friction ({every}). {beyond[0].upper()}{beyond[1:]}. "
            f"Within it h = {_micrometres(worst, h)} uses least, {used[:, best].max():.2f} of the strength "
            f"in {mode} with f = {worst.curve.friction:g}. {_checked([*places, (worst, h, mode)])}"
        )
    return found


def _overlap(
    a: Sequence[tuple[float, float]], b: Sequence[tuple[float, float]]
) -> tuple[tuple[float, float], ...]:
    both = [(max(p, r), min(q, s)) for p, q in a for r, s in b]
    return tuple((low, high) for low, high in both if low < high)


def _bound(members: Sequence[Judged], h: float, *, thinner: bool) -> tuple[Judged, str] | None:
    """The curve whose range ends at ``h`` with the mode that governs there; None at a sweep's end."""
    if h in (members[0].h[0], members[0].h[-1]):
        return None
    j = next(j for j in members if h in [r[0 if thinner else 1] for r in j.admissible])
    return j, j.modes[j.governing[int(np.abs(np.log(j.h / h)).argmin())]]


def _beyond(end: tuple[Judged, str] | None) -> str:
    if end is None:
        return "the sweep ends"
    j, mode = end
    return f"{MODES[mode]} ({mode}, f = {j.curve.friction:g})"


def _micrometres(j: Judged, h: float) -> str:
    return f"{h * j.curve.a_h * 1e6:.3g} µm"


def _checked(places: Sequence[tuple[Judged, float, str]]) -> str:
    """The cross-checks nearest to each (curve, thickness, mode), every source with its worst difference."""
    found = [(j, one) for j, h, mode in places for one in near(j, h, mode)]
    if not found:
        return "No point near it was cross-checked."
    parts = []
    for source in dict.fromkeys(one.source for _, one in found):
        j, one = max(
            ((j, one) for j, one in found if one.source == source), key=lambda item: item[1].difference
        )
        parts.append(
            f"at most {one.difference:.1e} p_h off the {source_label(source)} ({one.mode}, "
            f"h = {_micrometres(j, one.h)}, f = {j.curve.friction:g})"
        )
    return f"At the checked thicknesses nearest to it these stresses are {' and '.join(parts)}."
